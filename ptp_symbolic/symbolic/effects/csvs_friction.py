"""Coulomb, static, viscous and Stribeck friction, set-valued at rest."""

import sympy as sp

from ptp_symbolic.platform import SITES
from ptp_symbolic.symbolic.effect_interface.conditions import Requirement
from ptp_symbolic.symbolic.effect_interface.contribution import Contribution, Friction
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Member
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place, quantity

PARAMETERS = (
    Parameter("F_c_{axis}", "N m", 0.2401, 0.0, 1e4, "Coulomb friction torque", 0.0, (0.05,)),
    Parameter(
        "F_s_{axis}", "N m", 0.675, 0.0, 1e4, "static (breakaway) friction torque", 0.0, (0.05,)
    ),
    Parameter("v_s_{axis}", "rad/s", 0.016, 1e-6, 1e3, "Stribeck speed", None, (0.05,)),
    Parameter("F_v_{axis}", "N m s/rad", 13.9424, 0.0, 1e4, "viscous part", 0.0, (0.0,)),
)
QUANTITIES = ("coulomb_torque", "static_torque", "stribeck_speed", "viscous_coefficient")
COULOMB, STATIC, STRIBECK, VISCOUS = (p.name for p in PARAMETERS)
MEMBERS = (
    Member("Coulomb friction", (COULOMB,), {STATIC: COULOMB}),
    Member("Coulomb and viscous friction", (COULOMB, VISCOUS), {STATIC: COULOMB}),
    Member("Coulomb and static friction, Stribeck curve", (COULOMB, STATIC, STRIBECK)),
    Member("Coulomb, static, viscous and Stribeck friction", (COULOMB, STATIC, STRIBECK, VISCOUS)),
)


def _contribute(place: Place) -> Contribution:
    rate = place.friction_rate
    names = [f"{word}_{place.axis}" for word in QUANTITIES]
    coulomb, static, speed, viscous = map(quantity, names)
    stribeck = f"stribeck_square_{place.axis}"
    fallen = sp.exp(-quantity(stribeck))
    sliding = coulomb + (static - coulomb) * fallen + viscous * place.slide * rate
    defined = dict(zip(names, place.symbols(PARAMETERS), strict=True))
    breakaway = f"breakaway_torque_{place.axis}"
    return Contribution(
        quantities=defined | {stribeck: (rate / speed) ** 2, breakaway: static},
        frictions=(Friction(place.own_axis, rate, sliding, quantity(breakaway)),),
    )


def _requires(place: Place) -> tuple[Requirement, ...]:
    coulomb, static = place.symbols(PARAMETERS[:2])
    return (Requirement(static >= coulomb, "F_s is at least F_c; raise F_s or lower F_c"),)


CSVS_FRICTION = Effect(
    id="csvs_friction",
    title="Coulomb, static, viscous and Stribeck friction",
    reference="thesis Eq. 2.10, 2.11 with errata 2 and 3, Eq. 4.1, exponent 2",
    parameters=PARAMETERS,
    contribute=_contribute,
    sites=SITES,
    dissipative=True,
    requires=_requires,
    members=MEMBERS,
    separating_experiment="Crawl through standstill in both directions at several slow speeds.",
)
