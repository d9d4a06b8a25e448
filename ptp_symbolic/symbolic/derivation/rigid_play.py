"""Gaps between a gear output and a joint that are both rigid."""

from collections.abc import Iterable

import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.symbolic.derivation.contributions import Contributions
from ptp_symbolic.symbolic.derivation.equations import Contact
from ptp_symbolic.symbolic.derivation.friction import Mechanics, is_loaded
from ptp_symbolic.symbolic.effect_interface.contribution import Friction, Play
from ptp_symbolic.symbolic.effect_interface.place import active, quantity, side
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import ZERO


def rigid_contact(play: Play, contributions: Contributions, mechanics: Mechanics) -> Contact:
    """The contact of `play`; its torque is no function of the state but follows from the motion.

    Raises InputError where a shaft lies beside it, nothing turns at the gear output, both sides
    have dry friction, or friction depends on the torque that the contact transmits.
    """
    axis = play.axis
    gear, joint = kinematics.gear_rate(axis), kinematics.rate(axis)
    row = mechanics.rates.index(gear)
    if any(shaft.axis == axis for shaft in contributions.shafts):
        raise InputError(
            f"Backlash on axis '{axis}' joins gear output and joint rigidly beside a shaft; remove"
            " shaft_compliance, or choose the kind dead_zone."
        )
    if mechanics.mass[row, row] == 0:
        raise InputError(
            f"Backlash on axis '{axis}' is struck by a gear output without inertia; declare a"
            " motor, such as dc_motor."
        )
    _refuse_frictions(axis, gear, joint, contributions.frictions, contributions)
    return Contact(
        axis=axis,
        separation=kinematics.gear_angle(axis) - kinematics.angle(axis),
        half_gap=contributions.resolve(play.half_gap),
        torque=ZERO,
        side=side(axis),
        active=active(axis),
        restitution=contributions.resolve(play.restitution),
        holds=play.holds,
    )


def _refuse_frictions(
    axis: str,
    gear: sp.Symbol,
    joint: sp.Symbol,
    frictions: Iterable[Friction],
    contributions: Contributions,
) -> None:
    own = [f for f in frictions if f.rate in (gear, joint)]
    if len({f.rate for f in own}) > 1:
        raise InputError(
            f"Axis '{axis}' has dry friction on both sides of rigid backlash, which cannot tell"
            " them apart at rest; declare it at one site."
        )
    carried = quantity(f"shaft_torque_{axis}")
    for friction in own:
        level = contributions.resolve(friction.level) + contributions.resolve(friction.breakaway)
        if carried in level.free_symbols or is_loaded(friction):
            raise InputError(
                f"Friction on axis '{axis}' depends on the torque that it carries, which rigid"
                " backlash leaves open; declare shaft_compliance and the kind dead_zone."
            )
