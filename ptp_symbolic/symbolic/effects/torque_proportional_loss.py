"""A gear that loses a share of the torque that it transmits, another one where the load drives it.

The losses come up over a small angle after a reversal, as teeth and seals bend before they slip: a
state between -1 and 1 says how far. What has bent gives back a part of the work: the ledger takes
that off what is dissipated, for a stiffness that goes with the load has no energy of its own. The
torque is that of the shaft, of a motor without one at the gear output, or the torque input.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.conditions import Requirement
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Member
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import real

MEAN, DIFFERENCE = "mu_avg_{axis}", "mu_dif_{axis}"
PARAMETERS = (
    Parameter(MEAN, "1", 0.0, 0.0, 0.9, "share of the torque lost, mean of both ways", 0.0, (0.1,)),
    Parameter(
        DIFFERENCE,
        "1",
        0.0,
        -0.9,
        0.9,
        "share lost by the driving gear, above that mean (below it where the load drives)",
        vanishes=0.0,
        starts=(0.0,),
    ),
    Parameter(
        "h_loss_{axis}",
        "rad",
        3e-3,
        1e-7,
        1.0,
        "angle over which the losses come up after a reversal",
        starts=(1e-3, 1e-2),
    ),
)


def _contribute(place: Place) -> Contribution:
    mean, difference, angle = place.symbols(PARAMETERS)
    rate, slip = place.gear_rate, real(f"z_loss_{place.axis}")
    carried = place.quantity("transmitted_torque_{axis}")
    torque = mean * sp.Abs(carried) * slip + difference * carried * slip**2
    meaning = f"share of the {place.axis} gear's losses that has come up"
    return Contribution(
        torques={rate: -torque},
        states=(State(slip.name, "1", meaning, (rate - sp.Abs(rate) * slip) / angle),),
    )


def _requires(place: Place) -> tuple[Requirement, ...]:
    mean, difference, _ = place.symbols(PARAMETERS)
    rule = "mu_dif lies within -mu_avg and mu_avg; change one of them"
    return (Requirement(sp.Abs(difference) <= mean, rule),)


TORQUE_PROPORTIONAL_LOSS = Effect(
    id="torque_proportional_loss",
    title="gear that loses a share of the torque that it transmits",
    reference="Dohring, Lee and Newman (1993): load-dependent losses, driven and back-driven; Dahl"
    " (1968), exponent 1: how they come up",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("transmitted_torque_{axis}",),
    requires=_requires,
    members=(
        Member("the same share both ways", (MEAN, "h_loss_{axis}")),
        Member("a share of its own each way", (MEAN, DIFFERENCE, "h_loss_{axis}")),
    ),
    separating_experiment="Lift and lower a known weight at the same slow speeds, and reverse by"
    " less than a degree: losses of the gear grow with the weight and come up over an angle.",
)
