"""Shafts between gear output and joint: torques, dead zones, energy."""

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.derivation.contributions import Contributions
from ptp_symbolic.symbolic.derivation.equations import Contact, Ledger
from ptp_symbolic.symbolic.effect_interface.contribution import Shaft
from ptp_symbolic.symbolic.effect_interface.place import active, quantity, side
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import ZERO


@dataclass(frozen=True)
class Transmission:
    """One shaft: torques in N m on the gear output and on the joint, its contact if it has play,
    and the quantities that effects find on its axis. `measured` is its torque in N m as a function
    of the state alone, whatever the modes. It twists at `speed` in rad/s, before which the rate of
    the gear output is multiplied by `ratio`; `spring` and `loss` are the parts of its torque that
    store and that take energy.
    """

    axis: str
    ratio: sp.Expr
    speed: sp.Expr
    spring: sp.Expr
    loss: sp.Expr
    torques: tuple[tuple[sp.Symbol, sp.Expr], ...]
    measured: sp.Expr
    quantities: Mapping[sp.Symbol, sp.Expr]
    contact: Contact | None
    ledger: Ledger


def transmission(shaft: Shaft, contributions: Contributions) -> Transmission:
    """The torques of `shaft`, whose twist a transmission error of the gear may modulate."""
    axis = shaft.axis
    gear, joint = kinematics.gear_rate(axis), kinematics.rate(axis)
    error = contributions.resolve(quantity(f"transmission_error_{axis}"))
    ratio = 1 + sp.diff(error, kinematics.gear_angle(axis))
    separation = kinematics.gear_angle(axis) + error - kinematics.angle(axis)
    speed = gear * ratio - joint
    gap = quantity(f"half_gap_{axis}")
    half_gap = contributions.resolve(contributions.values.get(gap, ZERO))
    touching: sp.Expr = side(axis) ** 2
    face: sp.Expr = side(axis)
    pushing: sp.Expr = active(axis)
    if half_gap == 0:
        face, pushing, touching = ZERO, sp.Integer(1), sp.Integer(1)
    twist, twist_rate = (quantity(f"{word}_{axis}") for word in ("twist", "twist_rate"))
    here = {twist: separation - face * half_gap, twist_rate: speed}
    spring, losses = (e.subs(here) for e in (sp.diff(shaft.energy, twist), shaft.losses))
    torque = spring + losses
    transmitted = pushing * torque
    lost = touching * (pushing * losses - (1 - pushing) * spring)
    total = sp.diff(shaft.energy, twist) + shaft.losses
    return Transmission(
        axis=axis,
        ratio=ratio,
        speed=speed,
        spring=touching * spring,
        loss=lost,
        measured=_pressed(total.subs(twist_rate, speed), twist, separation, half_gap),
        torques=((gear, -transmitted * ratio), (joint, transmitted)),
        quantities={quantity(f"shaft_torque_{axis}"): transmitted}
        | {symbol: touching * value for symbol, value in here.items()},
        contact=None
        if half_gap == 0
        else Contact(axis, separation, half_gap, torque, side(axis), active(axis)),
        ledger=Ledger(
            stored=touching * shaft.energy.subs(here),
            power_in=ZERO,
            dissipated=lost * speed,
        ),
    )


def _pressed(torque: sp.Expr, twist: sp.Symbol, separation: sp.Expr, half_gap: sp.Expr) -> sp.Expr:
    """The `torque` of a twist, at a `separation` of gear output and joint in rad: none within the
    gap, and none that pulls at a face.
    """
    if half_gap == 0:
        return torque.subs(twist, separation)
    ahead, behind = (torque.subs(twist, separation + end) for end in (-half_gap, half_gap))
    return sp.Piecewise(
        (sp.Max(ahead, 0), separation > half_gap),
        (sp.Min(behind, 0), separation < -half_gap),
        (ZERO, True),
    )
