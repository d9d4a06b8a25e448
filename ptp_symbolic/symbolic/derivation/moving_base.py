"""What a base whose motion is measured exerts on the joints, written in the axes of the pan body.

There the pan angle appears nowhere but in the motion of the base itself, whose components become
named functions; in the axes of the base every term would carry it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics.bodies import NO_SPIN, RigidConfiguration
from ptp_symbolic.symbolic.symbols import ZERO, real

VECTORS = ("base_rate", "base_slope", "base_pull")  # rad/s, rad/s^2 and m/s^2


@dataclass(frozen=True)
class MovingBase:
    """A base that moves as inputs say: named functions `terms`, the `torques` in N m that it exerts
    by the rates of the joints, and the machine as it is `seen` with the terms in it. `at_rest` is
    zero for each of the inputs. Where none moves the base, there are no terms and torques.
    """

    seen: RigidConfiguration
    at_rest: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    terms: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    torques: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def written_out(self, expression: sp.Expr) -> sp.Expr:
        """`expression` with the terms put in."""
        return expression.xreplace(dict(self.terms))


def moving_base(rigid: RigidConfiguration, at_rest: Mapping[sp.Symbol, sp.Expr]) -> MovingBase:
    """The moving base of `rigid`; `at_rest` gives zero for each of its inputs.

    Torques are those of Newton and Euler, less the ones on the base at rest.
    """
    if not at_rest:
        return MovingBase(rigid)
    still = rigid.gravity.xreplace(at_rest)
    into_pan = rigid.rotation_to_base("pan").T
    terms: dict[sp.Symbol, sp.Expr] = {}
    vectors = []
    for name, given in zip(
        VECTORS, (rigid.base_spin, rigid.base_spin_rate, rigid.gravity - still), strict=True
    ):
        components = []
        for k, value in zip("xyz", into_pan * given, strict=True):
            named = value if value.is_Symbol or value == 0 else real(f"{name}_{k}_pan")
            terms |= {named: value} if named != value else {}
            components.append(named)
        vectors.append(into_pan.T * sp.Matrix(components))
    spin, spin_rate, pull = (v.as_immutable() for v in vectors)
    seen = replace(rigid, gravity=still + pull, base_spin=spin, base_spin_rate=spin_rate)
    alone = replace(seen, gravity=pull)
    quiet = replace(rigid, gravity=NO_SPIN, base_spin=NO_SPIN, base_spin_rate=NO_SPIN)
    moved, unmoved = newton_euler(alone), newton_euler(quiet)
    torques = {
        rate: _collected(with_it - without, [*terms, *at_rest])
        for rate, with_it, without in zip(moved.rates, moved.forcing, unmoved.forcing, strict=True)
    }
    return MovingBase(seen, at_rest, terms, {rate: t for rate, t in torques.items() if t != 0})


def _collected(torque: sp.Expr, motion: list[sp.Symbol]) -> sp.Expr:
    """`torque` as products of the base's `motion`, each with what it is multiplied by."""
    reduced = normal_form(torque)
    present = [symbol for symbol in motion if symbol in reduced.free_symbols]
    if not present:
        return ZERO
    polynomial = sp.Poly(reduced, *present)
    return sp.Add(
        *(
            sp.Mul(*(s**n for s, n in zip(present, powers, strict=True))) * normal_form(factor)
            for powers, factor in polynomial.terms()
        )
    )
