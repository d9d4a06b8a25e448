"""Shafts between gear output and joint: torques, dead zones, energy."""

from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.derivation.contributions import Contributions
from ptp_symbolic.symbolic.derivation.equations import Contact, Ledger
from ptp_symbolic.symbolic.effects.effect import Shaft
from ptp_symbolic.symbolic.effects.effect import quantity as quantity_symbol
from ptp_symbolic.symbolic.mechanics import kinematics


@dataclass(frozen=True)
class Transmission:
    """One shaft: torque on the gear output and on the joint, its contact if it has play."""

    torques: tuple[tuple[sp.Symbol, sp.Expr], ...]
    transmitted: sp.Expr
    contact: Contact | None
    ledger: Ledger


def transmission(shaft: Shaft, contributions: Contributions) -> Transmission:
    """The torques of `shaft`, whose twist a transmission error of the gear may modulate."""
    axis = shaft.axis
    gear, joint = kinematics.gear_rate(axis), kinematics.rate(axis)
    error = contributions.resolve(quantity_symbol(f"transmission_error_{axis}"))
    lead = 1 + sp.diff(error, kinematics.gear_angle(axis))
    separation = kinematics.gear_angle(axis) + error - kinematics.angle(axis)
    speed = gear * lead - joint
    half_gap = contributions.resolve(quantity_symbol(f"half_gap_{axis}"))
    side, active = (sp.Symbol(f"{word}_{axis}", real=True) for word in ("side", "active"))
    touching: sp.Expr = side**2
    face: sp.Expr = side
    pushing: sp.Expr = active
    if half_gap == 0:
        face, pushing, touching = sp.Integer(0), sp.Integer(1), sp.Integer(1)
    twist = separation - face * half_gap
    spring, damper = shaft.stiffness * twist, shaft.damping * speed
    torque = spring + damper
    transmitted = pushing * torque
    lost = pushing * damper - (1 - pushing) * spring
    return Transmission(
        torques=((gear, -transmitted * lead), (joint, transmitted)),
        transmitted=transmitted,
        contact=None
        if half_gap == 0
        else Contact(axis, separation, half_gap, torque, side, active),
        ledger=Ledger(
            stored=touching * shaft.stiffness * twist**2 / 2,
            power_in=sp.Integer(0),
            dissipated=touching * lost * speed,
        ),
    )
