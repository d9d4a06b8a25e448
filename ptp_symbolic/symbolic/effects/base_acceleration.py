"""A base that is accelerated, as an accelerometer on it measures, in the axes of the base.

The kind ``acceleration`` takes the acceleration of a point of the base, without gravity, which
keeps the direction that the platform and ``base_tilt`` give it. The kind ``specific_force`` takes
what an accelerometer reads, acceleration less gravity (level and at rest: 9.81 m/s^2 along z). It
has gravity in it, however the base rolls and pitches, so that no attitude need be known. On a base
that turns (``base_rotation``) the point is where the sensor sits, measured from the point where the
axes cross, or where the pan axis is level with the tilt axis.
"""

from dataclasses import replace

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, Input
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import ZERO

PLACE = tuple(
    Parameter(f"{k}_base", "m", 0.0, -100.0, 100.0, f"{k} of the accelerometer on the base")
    for k in "xyz"
)


def _has(place: Place, parameter: Parameter) -> bool:
    return place.base_turns


def _contribute(place: Place, measured: str = "acceleration") -> Contribution:
    words = measured.replace("_", " ")
    inputs = tuple(
        Input(f"{measured}_{k}_base", "m/s^2", f"{words} of the base along its {k}") for k in "xyz"
    )
    found = sp.Matrix([given.symbol for given in inputs])
    if place.base_turns:
        back = -sp.Matrix([p.symbol for p in PLACE])
        spin, spin_rate = (
            sp.Matrix([place.quantity(f"{name}_{k}") for k in "xyz"])
            for name in ("base_spin", "base_spin_rate")
        )
        found += spin_rate.cross(back) + spin.cross(spin.cross(back))
    changes = {
        f"base_acceleration_{k}": Change(addition=e) for k, e in zip("xyz", found, strict=True)
    }
    if measured == "specific_force":
        changes["gravity_share"] = Change(factor=ZERO)
    return Contribution(changes=changes, inputs=inputs)


def _of_specific_force(place: Place) -> Contribution:
    return _contribute(place, "specific_force")


BASE_ACCELERATION = Effect(
    id="base_acceleration",
    kind="acceleration",
    title="base that is accelerated as measured",
    reference="inertial force in an accelerated frame; Landau and Lifshitz (1976), section 39",
    parameters=PLACE,
    has=_has,
    contribute=_contribute,
    on_axis=False,
    structural=True,
    separating_experiment="Hold the axes and log an accelerometer on the base beside them.",
    instead_on_linear="it acts on a mass that turns",
)
SPECIFIC_FORCE = replace(BASE_ACCELERATION, kind="specific_force", contribute=_of_specific_force)
BASE_ACCELERATION = replace(BASE_ACCELERATION, kinds=(SPECIFIC_FORCE,))
