"""Coulomb, static, viscous and Stribeck friction, set-valued at rest."""

import sympy as sp

from ptp_symbolic.symbolic.effects.conditions import Requirement
from ptp_symbolic.symbolic.effects.effect import Contribution, Effect, Friction, Member, Place
from ptp_symbolic.symbolic.parameters import Parameter

PARAMETERS = (
    Parameter("F_c_{axis}", "N m", 0.2401, 0.0, 1e4, "Coulomb friction torque", 0.0, (0.05,)),
    Parameter(
        "F_s_{axis}", "N m", 0.675, 0.0, 1e4, "static (breakaway) friction torque", 0.0, (0.05,)
    ),
    Parameter("v_s_{axis}", "rad/s", 0.016, 1e-6, 1e3, "Stribeck speed", None, (0.05,)),
    Parameter("F_v_{axis}", "N m s/rad", 13.9424, 0.0, 1e4, "viscous part", 0.0, (0.0,)),
)
COULOMB, STATIC, STRIBECK, VISCOUS = (p.name for p in PARAMETERS)
MEMBERS = (
    Member("Coulomb friction", (COULOMB,), {STATIC: COULOMB}),
    Member("Coulomb and viscous friction", (COULOMB, VISCOUS), {STATIC: COULOMB}),
    Member("Coulomb and static friction, Stribeck curve", (COULOMB, STATIC, STRIBECK)),
    Member("Coulomb, static, viscous and Stribeck friction", (COULOMB, STATIC, STRIBECK, VISCOUS)),
)


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return tuple(p.at_axis(place.axis) for p in PARAMETERS)


def _contribute(place: Place) -> Contribution:
    rate = place.rate if place.site == "joint" else place.gear_rate
    coulomb, static, speed, viscous = (
        place.quantity(f"{name}_{{axis}}")
        for name in ("coulomb_torque", "static_torque", "stribeck_speed", "viscous_coefficient")
    )
    stribeck = sp.exp(-((rate / speed) ** 2))
    sliding = coulomb + (static - coulomb) * stribeck + viscous * place.slide * rate
    names = [str(q).removeprefix("quantity:") for q in (coulomb, static, speed, viscous)]
    symbols = [place.parameter(p.name) for p in PARAMETERS]
    breakaway = place.quantity("breakaway_torque_{axis}")
    return Contribution(
        quantities={
            **dict(zip(names, symbols, strict=True)),
            f"breakaway_torque_{place.axis}": static,
        },
        frictions=(Friction(place.own_axis, rate, sliding, breakaway),),
    )


def _requires(place: Place) -> tuple[Requirement, ...]:
    coulomb, static = (place.parameter(p.name) for p in PARAMETERS[:2])
    return (Requirement(static >= coulomb, "F_s is at least F_c; raise F_s or lower F_c"),)


CSVS_FRICTION = Effect(
    id="csvs_friction",
    title="Coulomb, static, viscous and Stribeck friction",
    reference="thesis Eq. 2.10, 2.11 with errata 2 and 3, Eq. 4.1, exponent 2",
    parameters=_parameters,
    contribute=_contribute,
    dissipative=True,
    requires=_requires,
    members=MEMBERS,
    separating_experiment="Crawl through standstill in both directions at several slow speeds.",
)
