"""The functions of a model as named assignments: accelerations, Jacobians, guards, outputs.

Nothing is inverted symbolically: the coupled joints are solved by Cramer's rule with one division,
and derivatives of accelerations are taken implicitly from M a = F.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.codegen.chain import ChainRule, chain_rule
from ptp_symbolic.codegen.sharing import Line
from ptp_symbolic.derivation.equations import Equations

ZERO = sp.Integer(0)


@dataclass(frozen=True)
class Solve:
    """Accelerations of a model, solved row by row or pairwise where two joints are coupled.

    `definitions` start with the named functions of the equations; `chain` differentiates them.
    """

    definitions: tuple[Line, ...]
    accelerations: tuple[sp.Expr, ...]
    mass: sp.Matrix
    force: sp.Matrix
    free: tuple[sp.Expr, ...]
    inverses: tuple[sp.Expr, ...]
    chain: ChainRule

    def solve(self, right: Sequence[sp.Expr]) -> list[sp.Expr]:
        """Return a in M a = `right` for the rows that are free to move."""
        n = len(self.accelerations)
        result = [ZERO] * n
        for k in range(n):
            partner = self._partner(k)
            if partner is None:
                result[k] = self.free[k] * right[k] * self.inverses[k]
            else:
                coupling = self.mass[k, partner] * self.free[k] * self.free[partner]
                top = self.mass[partner, partner] * right[k] - coupling * right[partner]
                result[k] = self.free[k] * top * self.inverses[k]
        return result

    def _partner(self, row: int) -> int | None:
        others = [j for j in range(self.mass.rows) if j != row and self.mass[row, j] != 0]
        return others[0] if others else None


def solve_accelerations(equations: Equations) -> Solve:
    """Name the mass matrix, forces and accelerations of `equations`."""
    places = [str(symbol).removeprefix("theta_") for symbol in equations.coordinates]
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
            mass[i, j] = mass[j, i] = sp.Symbol(name, real=True)
        total = equations.forcing[i]
        friction = slides.get(rate)
        direction = _slide(friction.axis) if friction else sp.Integer(1)
        free.append(direction**2 if friction else sp.Integer(1))
        if friction:
            total = total - direction * friction.level
        definitions.append((f"force_{places[i]}", total))
        force[i] = sp.Symbol(f"force_{places[i]}", real=True)
    inverses = _inverses(mass, free, places, definitions)
    solve = Solve(tuple(definitions), (ZERO,) * n, mass, force, tuple(free), tuple(inverses), chain)
    accelerations = solve.solve(list(force))
    names = [sp.Symbol(f"accel_{place}", real=True) for place in places]
    lines = [(str(name), a) for name, a in zip(names, accelerations, strict=True)]
    return replace(solve, definitions=(*definitions, *lines), accelerations=tuple(names))


def _inverses(
    mass: sp.Matrix, free: list[sp.Expr], places: list[str], definitions: list[Line]
) -> list[sp.Expr]:
    inverses = []
    for i, place in enumerate(places):
        partners = [j for j in range(mass.rows) if j != i and mass[i, j] != 0]
        if not partners:
            name = f"inverse_mass_{place}"
            value = 1 / mass[i, i]
        else:
            j = partners[0]
            name = "inverse_determinant"
            coupling = mass[i, j] * free[i] * free[j]
            value = 1 / (mass[i, i] * mass[j, j] - coupling**2)
        if name not in dict(definitions):
            definitions.append((name, value))
        inverses.append(sp.Symbol(name, real=True))
    return inverses


def _slide(axis: str) -> sp.Symbol:
    return sp.Symbol(f"slide_{axis}", real=True)


def state_rates(equations: Equations, solve: Solve) -> list[sp.Expr]:
    """Time derivative of every state, in the order of `Equations.state_symbols`."""
    by_state = dict(zip(equations.coordinates, equations.rates, strict=True))
    by_state.update(zip(equations.rates, solve.accelerations, strict=True))
    for state in equations.extra_states:
        by_state[sp.Symbol(state.name, real=True)] = state.derivative
    return [by_state[symbol] for symbol in equations.state_symbols]


def acceleration_derivative(
    equations: Equations, solve: Solve, variable: sp.Symbol
) -> list[sp.Expr]:
    """Derivative of every acceleration by `variable`, from M a = F without inverting M."""
    values = dict(solve.definitions)
    right = []
    for i in range(len(equations.rates)):
        term = solve.chain.derivative(values[str(solve.force[i])], variable)
        for j, acceleration in enumerate(solve.accelerations):
            term -= solve.chain.derivative(equations.mass_matrix[i, j], variable) * acceleration
        right.append(term)
    return solve.solve(right)


def derivative_of(
    equations: Equations,
    solve: Solve,
    expression: sp.Expr,
    variable: sp.Symbol,
    acceleration_by: Sequence[sp.Expr],
) -> sp.Expr:
    """Total derivative of an expression that may hold accelerations and mass matrix entries."""
    values = dict(solve.definitions)
    result = solve.chain.derivative(expression, variable)
    for acceleration, by in zip(solve.accelerations, acceleration_by, strict=True):
        result += sp.diff(expression, acceleration) * by
    for symbol in sorted(expression.free_symbols, key=str):
        if str(symbol).startswith("mass_"):
            slope = solve.chain.derivative(values[str(symbol)], variable)
            result += sp.diff(expression, symbol) * slope
    return result


def guard_expressions(equations: Equations, solve: Solve) -> list[sp.Expr]:
    """Per friction: holding torque, breakaway forward and backward; per contact: separation,
    half gap, torque at the upper and at the lower face.
    """
    expressions: list[sp.Expr] = []
    for friction in equations.frictions:
        row = equations.rates.index(friction.rate)
        hold = equations.forcing[row]
        for j, acceleration in enumerate(solve.accelerations):
            if j != row:
                hold -= solve.mass[row, j] * acceleration
        direction = _slide(friction.axis)
        forward, backward = (friction.breakaway.subs(direction, s) for s in (1, -1))
        expressions += [hold, forward, backward]
    for contact in equations.contacts:
        upper, lower = (contact.torque.subs(contact.side, s) for s in (1, -1))
        expressions += [contact.separation, contact.half_gap, upper, lower]
    return expressions
