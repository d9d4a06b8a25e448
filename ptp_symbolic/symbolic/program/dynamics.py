"""The functions of a model as named assignments: accelerations, Jacobians, guards, outputs.

Nothing is inverted symbolically: the coupled joints are solved as in `simplify.solve`, and
derivatives of accelerations are taken implicitly from M a = F. Where rigid contact joins a gear
output to its joint, the gear's row is added to the joint's, and the gear follows.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.contributions import slope_symbol
from ptp_symbolic.symbolic.derivation.differentiation import derivative
from ptp_symbolic.symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.program.chain import ChainRule, chain_rule
from ptp_symbolic.symbolic.program.sharing import Line, if_shared
from ptp_symbolic.symbolic.simplify.solve import inverse_values, partner_of, solved
from ptp_symbolic.symbolic.symbols import ZERO, real

DEAD_BAND = sp.Rational(1, 10**12)  # rad/s, above the rounding of rates that are equal
FACE_DEPTH = sp.Rational(1, 10**12)  # rad, above the rounding of angles
GRAVITY = "gravity"  # the parameter


@dataclass(frozen=True)
class Lock:
    """Rows of a gear output and a joint that turn as one where `active` is 1, else apart."""

    gear: int
    joint: int
    active: sp.Expr


@dataclass(frozen=True)
class Solve:
    """Accelerations of a model, solved row by row or pairwise where two joints are coupled.

    `definitions` start with the named functions of the equations; `chain` differentiates them.
    `inertias` is the inertia of every row with what is locked to it, `free` 0 where it is locked.
    """

    definitions: tuple[Line, ...]
    accelerations: tuple[sp.Expr, ...]
    mass: sp.Matrix
    force: sp.Matrix
    free: tuple[sp.Expr, ...]
    inverses: tuple[sp.Expr, ...]
    chain: ChainRule
    inertias: tuple[sp.Expr, ...]
    locks: tuple[Lock, ...]

    def solve(self, right: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return a in M a = `right` for the rows that are free to move."""
        right = list(right)
        for lock in self.locks:
            right[lock.joint] += lock.active * right[lock.gear]
        result = solved(self.mass, self.inertias, self.free, self.inverses, right)
        for lock in self.locks:
            apart = (1 - lock.active) * result[lock.gear]
            result[lock.gear] = apart + lock.active * result[lock.joint]
        return result


def solve_accelerations(equations: Equations) -> Solve:
    """Name the mass matrix, forces and accelerations of `equations`."""
    places = [kinematics.place_of(coordinate) for coordinate in equations.coordinates]
    n = len(places)
    slides = {friction.rate: friction for friction in equations.frictions}
    definitions: list[Line] = [(str(symbol), term) for symbol, term in equations.terms]
    chain = chain_rule(equations)
    mass, force = sp.zeros(n, n), sp.zeros(n, 1)
    free: list[sp.Expr] = []
    for i, rate in enumerate(equations.rates):
        for j in range(i, n):
            if equations.mass_matrix[i, j] == 0:
                continue
            name = f"mass_{places[i]}" if i == j else f"mass_{places[i]}_{places[j]}"
            definitions.append((name, equations.mass_matrix[i, j]))
            mass[i, j] = mass[j, i] = real(name)
        total = equations.forcing[i]
        friction = slides.get(rate)
        direction = slide(friction.axis) if friction else sp.Integer(1)
        free.append(direction**2 if friction else sp.Integer(1))
        if friction:
            total = total - direction * friction.level
        definitions.append((f"force_{places[i]}", total))
        force[i] = real(f"force_{places[i]}")
    locks = _locks(equations, free)
    inertias = locked_inertias(mass, locks)
    inverses = _named_inverses(mass, inverse_values(mass, inertias, free), places, definitions)
    solve = Solve(
        tuple(definitions),
        (ZERO,) * n,
        mass,
        force,
        tuple(free),
        tuple(inverses),
        chain,
        inertias,
        locks,
    )
    accelerations = solve.solve(list(force))
    names = [real(f"accel_{place}") for place in places]
    lines = [(str(name), a) for name, a in zip(names, accelerations, strict=True)]
    return replace(solve, definitions=(*definitions, *lines), accelerations=tuple(names))


def _locks(equations: Equations, free: list[sp.Expr]) -> tuple[Lock, ...]:
    """The locks of rigid contacts; what holds one of their bodies holds the other in `free` too."""
    locks = []
    for contact in equations.contacts:
        if contact.rigid:
            gear = equations.rates.index(kinematics.gear_rate(contact.axis))
            joint = equations.rates.index(kinematics.rate(contact.axis))
            free[joint] *= 1 - contact.active * (1 - free[gear])
            if contact.holds:
                free[joint] *= contact.active
            locks.append(Lock(gear, joint, contact.active))
    return tuple(locks)


def locked_inertias(mass: sp.Matrix, locks: Sequence[Lock]) -> tuple[sp.Expr, ...]:
    """The diagonal of `mass`, with the gear outputs that are locked to a joint."""
    inertias = [mass[k, k] for k in range(mass.rows)]
    for lock in locks:
        inertias[lock.joint] += lock.active * mass[lock.gear, lock.gear]
    return tuple(inertias)


def _named_inverses(
    mass: sp.Matrix, values: Sequence[sp.Expr], places: Sequence[str], definitions: list[Line]
) -> list[sp.Expr]:
    """Symbols for `values`, which join `definitions`; partners share theirs."""
    inverses = []
    for row, value in enumerate(values):
        coupled = partner_of(mass, row) != row
        name = "inverse_determinant" if coupled else f"inverse_mass_{places[row]}"
        if name not in dict(definitions):
            definitions.append((name, value))
        inverses.append(real(name))
    return inverses


def state_rates(equations: Equations, solve: Solve) -> list[sp.Expr]:
    """Time derivative of every state, in the order of `Equations.state_symbols`."""
    by_state = dict(zip(equations.coordinates, equations.rates, strict=True))
    by_state.update(zip(equations.rates, solve.accelerations, strict=True))
    for state in equations.extra_states:
        by_state[state.symbol] = state.derivative
    return [by_state[symbol] for symbol in equations.state_symbols]


def gravity_torques(equations: Equations) -> list[sp.Expr]:
    """The torque on every row that holds it against its weight: g in M a + c + g = torques, the
    gradient of the potential energy of gravity. It is what `forcing` loses without gravity.
    """
    weightless: dict[sp.Expr, sp.Expr] = {
        p.symbol: ZERO for p in equations.parameters if p.name == GRAVITY
    }
    for symbol, term in equations.terms:
        value = term.xreplace(weightless)
        if value != term:
            weightless[symbol] = value
    return [row.xreplace(weightless) - row for row in equations.forcing]


def prepared(lines: Sequence[Line], parameters: Sequence[str]) -> tuple[list[Line], list[Line]]:
    """Split `lines`: named terms of the `parameters` alone, then all others."""
    known, once, each = set(parameters), [], []
    for name, expression in lines:
        if name.isidentifier() and {str(s) for s in expression.free_symbols} <= known:
            known.add(name)
            once.append((name, expression))
        else:
            each.append((name, expression))
    return once, each


@dataclass(frozen=True)
class Slopes:
    """Derivatives of the accelerations: `by` variable, which `lines` define with those that are not
    zero.
    """

    lines: tuple[Line, ...]
    by: dict[sp.Symbol, list[sp.Expr]]


def acceleration_slopes(
    equations: Equations, solve: Solve, variables: Iterable[sp.Symbol]
) -> Slopes:
    """Derivatives of every acceleration by `variables`, from M a = F without inverting M."""
    chain = solve.chain
    lines: list[Line] = []
    by: dict[sp.Symbol, list[sp.Expr]] = {}
    for variable in (*chain.constants, *variables):
        values = _acceleration_partials(equations, solve, variable, lines)
        for constant, weight in chain.weights.get(variable, {}).items():
            values = [v + weight * b for v, b in zip(values, by[constant], strict=True)]
        by[variable] = []
        for acceleration, value in zip(solve.accelerations, values, strict=True):
            name = slope_symbol(acceleration, variable)
            by[variable].append(name if value != 0 else ZERO)
            lines += [(str(name), value)] if value != 0 else []
    return Slopes((*chain.lines, *lines), by)


def _acceleration_partials(
    equations: Equations, solve: Solve, variable: sp.Symbol, lines: list[Line]
) -> list[sp.Expr]:
    """Derivative of every acceleration by `variable`, the other constants held. That of the balance
    F - M a of every row joins `lines`.
    """
    values = dict(solve.definitions)
    right = []
    for i, rate in enumerate(equations.rates):
        force = str(solve.force[i])
        term = solve.chain.partial(values[force], variable, force)
        for j, acceleration in enumerate(solve.accelerations):
            term -= solve.chain.partial(equations.mass_matrix[i, j], variable) * acceleration
        if not term.is_Atom:
            name = if_shared(f"balance_{kinematics.place_of(rate)}_by_{variable}")
            lines.append((str(name), term))
            term = name
        right.append(term)
    return solve.solve(right)


def derivative_of(
    solve: Solve, slopes: Slopes, expression: sp.Expr, variable: sp.Symbol
) -> sp.Expr:
    """Total derivative of an expression that may hold accelerations and mass matrix entries."""
    values = dict(solve.definitions)
    result = solve.chain.derivative(expression, variable)
    for acceleration, by in zip(solve.accelerations, slopes.by[variable], strict=True):
        result += derivative(expression, acceleration) * by
    for symbol in sorted(solve.mass.free_symbols & expression.free_symbols, key=str):
        slope = solve.chain.derivative(values[str(symbol)], variable)
        result += derivative(expression, symbol) * slope
    return result


def guard_expressions(equations: Equations, solve: Solve) -> list[sp.Expr]:
    """Per friction: holding torque, breakaway forward and backward; per contact: separation,
    half gap, torque at the upper and at the lower face; per switch deviation, threshold, and twice
    what drives it.

    A rigid face has the speed of approach as its torque until it is active; a body that has let go
    of it has left it when it is FACE_DEPTH away.
    """
    expressions: list[sp.Expr] = []
    for friction in equations.frictions:
        row = equations.rates.index(friction.rate)
        hold = _torque_at_rest(equations, solve, row)
        for lock in solve.locks:
            if row in (lock.gear, lock.joint):
                other = lock.gear + lock.joint - row
                hold += lock.active * _torque_at_rest(equations, solve, other)
        direction = slide(friction.axis)
        forward, backward = (friction.breakaway.subs(direction, s) for s in (1, -1))
        expressions += [hold, forward, backward]
    for contact in equations.contacts:
        upper, lower = (
            _push(equations, solve, contact, s)
            if contact.rigid
            else contact.torque.subs(contact.side, s)
            for s in (1, -1)
        )
        depth = FACE_DEPTH * contact.side**2 if contact.rigid else ZERO
        expressions += [contact.separation, contact.half_gap - depth, upper, lower]
    for switch in equations.switches:
        expressions += [switch.deviation, switch.threshold, switch.drive, switch.drive]
    return expressions


def _torque_at_rest(equations: Equations, solve: Solve, row: int) -> sp.Expr:
    """Torque on a row that does not turn, its friction apart."""
    torque = equations.forcing[row]
    for j, acceleration in enumerate(solve.accelerations):
        if j != row:
            torque -= solve.mass[row, j] * acceleration
    return torque


def _push(equations: Equations, solve: Solve, contact: Contact, side: int) -> sp.Expr:
    """What must be positive times `side` for a rigid contact to begin, and while active to last.

    It begins with a speed of approach. It lasts while it transmits a torque that pushes, or where
    friction holds the joint, while the gear output has not turned back.
    """
    gear, joint = kinematics.gear_rate(contact.axis), kinematics.rate(contact.axis)
    approach = gear - joint - side * DEAD_BAND
    if contact.holds:
        lasting: sp.Expr = gear + side * DEAD_BAND
    else:
        friction_rates = {f.rate for f in equations.frictions}
        row, sign = (gear, 1) if joint in friction_rates else (joint, -1)
        index = equations.rates.index(row)
        lasting = sign * _torque_at_rest(equations, solve, index)
        lasting -= sign * solve.mass[index, index] * solve.accelerations[index]
    return contact.active * lasting + (1 - contact.active) * approach
