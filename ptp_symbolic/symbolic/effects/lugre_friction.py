"""LuGre friction: bristles that bend before they slip."""

import sympy as sp

from ptp_symbolic.platform import SITES
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Structure
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import real

PARAMETERS = (
    Parameter("sigma0_{axis}", "N m/rad", 1e3, 1e-6, 1e9, "stiffness of the bristles"),
    Parameter("sigma1_{axis}", "N m s/rad", 1.0, 0.0, 1e6, "damping of the bristles"),
    Parameter("sigma2_{axis}", "N m s/rad", 0.1, 0.0, 1e4, "viscous friction"),
    Parameter("F_c_{axis}", "N m", 0.24, 1e-9, 1e4, "Coulomb friction torque"),
    Parameter("F_s_{axis}", "N m", 0.65, 1e-9, 1e4, "static friction torque"),
    Parameter("v_s_{axis}", "rad/s", 0.016, 1e-6, 1e3, "Stribeck speed"),
)


def _contribute(place: Place) -> Contribution:
    stiffness, damping, viscous, coulomb, static, speed = place.symbols(PARAMETERS)
    rate = place.friction_rate
    bend = real(f"bristle_{place.axis}")
    level = coulomb + (static - coulomb) * sp.exp(-((rate / speed) ** 2))
    bending = rate - stiffness * sp.Abs(rate) / level * bend
    return Contribution(
        torques={rate: -(stiffness * bend + damping * bending + viscous * rate)},
        stored=stiffness * bend**2 / 2,
        states=(State(str(bend), "rad", f"bend of the {place.axis} bristles", bending),),
    )


LUGRE_FRICTION = Effect(
    id="lugre_friction",
    title="LuGre friction",
    reference="Canudas de Wit, Olsson, Astrom and Lischinsky (1995), Eq. 1-4",
    parameters=PARAMETERS,
    contribute=_contribute,
    sites=SITES,
    structural=True,
    structure=Structure(in_place_of=("csvs_friction",)),
    separating_experiment="Swing below breakaway: bristles return elastically, dry friction stays.",
)
