"""What a strike of rigid bodies does: momentum is kept, the speed between the faces turns round.

The strike acts through the mass matrix, so that a coupled joint is struck too. Dry friction, which
is finite, does not take part; a joint that friction holds for as long as it is in a gap does.
"""

from dataclasses import replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.program.dynamics import Lock, Solve, locked_inertias
from ptp_symbolic.symbolic.simplify.solve import inverse_values
from ptp_symbolic.symbolic.symbols import ZERO

ONE = sp.Integer(1)


def impact_expressions(equations: Equations, solve: Solve) -> list[sp.Expr]:
    """Per contact: change of every state where the bodies stay together, restitution, energy.

    A strike that reverses e times the speed changes the state 1 + e times as much. The energy is
    what a strike without restitution takes, in J. A sprung contact has zeros.
    """
    expressions: list[sp.Expr] = []
    for contact in equations.contacts:
        if contact.restitution is None:
            expressions += [ZERO] * (len(equations.state_symbols) + 2)
        else:
            changes, energy = _strike(equations, solve, contact)
            by_rate = dict(zip(equations.rates, changes, strict=True))
            expressions += [by_rate.get(state, ZERO) for state in equations.state_symbols]
            expressions += [contact.restitution, energy]
    return expressions


def _strike(equations: Equations, solve: Solve, contact: Contact) -> tuple[list[sp.Expr], sp.Expr]:
    """Change of every rate, and energy lost, where the faces of `contact` stay together."""
    gear = equations.rates.index(kinematics.gear_rate(contact.axis))
    joint = equations.rates.index(kinematics.rate(contact.axis))
    response = _without_friction(equations, solve, contact).solve(
        [ONE if row == joint else -ONE if row == gear else ZERO for row in range(solve.mass.rows)]
    )
    speed = equations.rates[gear] - equations.rates[joint]
    impulse = speed / (response[joint] - response[gear])
    return [each * impulse for each in response], impulse * speed / 2


def _without_friction(equations: Equations, solve: Solve, own: Contact) -> Solve:
    """`solve` with every row free but those that other rigid contacts hold."""
    mass, free = solve.mass, [ONE] * solve.mass.rows
    locks: list[Lock] = []
    others = [c for c in equations.contacts if c.rigid and c is not own]
    for contact in others:
        joint = equations.rates.index(kinematics.rate(contact.axis))
        locks += [lock for lock in solve.locks if lock.joint == joint]
        free[joint] = contact.active if contact.holds else ONE
    inertias = locked_inertias(mass, locks)
    inverses = tuple(inverse_values(mass, inertias, free))
    return replace(
        solve, free=tuple(free), locks=tuple(locks), inertias=inertias, inverses=inverses
    )
