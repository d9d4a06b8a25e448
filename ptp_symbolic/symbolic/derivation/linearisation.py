"""The equations linearised about an operating point, in one mode of friction and contact.

Derivatives are exact: they are carried forward through the named functions, and those of the
accelerations follow from M a = f without inverting M symbolically.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from ptp_symbolic.symbolic.derivation.differentiation import derivative
from ptp_symbolic.symbolic.derivation.equations import Contact, Equations
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.symbols import real

Array = NDArray[np.float64]
Values = dict[sp.Symbol, float]

MOST_STEPS = 50  # of Newton's method
SMALL = 1e-9  # largest derivative left, relative to the one that the steps began with
RANK = 1e-13  # singular values below it, relative to the largest, count as zero


@dataclass(frozen=True)
class OperatingPoint:
    """Joint angles and rates by axis, in rad and rad/s (m and m/s of linear joints).

    With `sliding` dry friction slides forwards, else it is left out. Gaps are closed at their upper
    face, switches are off, and the time is zero.
    """

    angles: Mapping[str, float]
    rates: Mapping[str, float]
    sliding: bool = False


@dataclass(frozen=True)
class LinearModel:
    """dx/dt = A x + B u of deviations x, u from `values`: A [n, n], B [n, m], in SI units.

    `values` are those of all states and inputs at the operating point. `unbalanced` is the largest
    rate of change left there beside those of the angles: not zero where no input holds the point.
    """

    states: tuple[sp.Symbol, ...]
    inputs: tuple[sp.Symbol, ...]
    A: Array
    B: Array
    values: Values
    unbalanced: float


@dataclass(frozen=True)
class _Line:
    """A named function: what gives its value and its derivatives by the `moving` symbols in it."""

    name: sp.Symbol
    used: tuple[sp.Symbol, ...]
    moving: tuple[sp.Symbol, ...]
    compute: Callable[..., Sequence[float]]


def linear_model(equations: Equations, point: OperatingPoint) -> LinearModel:
    """Linearise `equations` about `point`, with the default of every parameter.

    Inputs, currents and the angles of gear outputs are those that hold the rates, by Newton's
    method. States on which no acceleration depends are left out; what samplers set is an input.
    """
    return linear_models(equations, [point])[0]


def linear_models(equations: Equations, points: Sequence[OperatingPoint]) -> list[LinearModel]:
    """The linear model about each of `points`; see `linear_model`."""
    modes = {point.sliding for point in points}
    fields = {sliding: vector_field(equations, sliding) for sliding in modes}
    return [_about(point, fields[point.sliding]) for point in points]


def vector_field(equations: Equations, sliding: bool = False) -> "VectorField":
    """The rates of change of all states that move the machine, dry friction left out or sliding."""
    return VectorField(_in_mode(equations, sliding))


def _about(point: OperatingPoint, field: "VectorField") -> LinearModel:
    """The linear model of `field` about `point`."""
    own, states, inputs = field.equations, field.states, field.inputs
    values = _start(own, point, states, inputs)
    joints = {kinematics.angle(a) for a in own.axes} | {*own.rates}
    unknown = [k for k, s in enumerate((*states, *inputs)) if s not in joints]
    kept = [k for k, s in enumerate(states) if s not in own.coordinates]
    rates, slopes = field.at(values)
    first = max(float(np.max(np.abs(rates[kept]), initial=0.0)), 1.0)
    for _ in range(MOST_STEPS):
        if np.max(np.abs(rates[kept]), initial=0.0) <= SMALL * first or not unknown:
            break
        step, *_ = np.linalg.lstsq(slopes[np.ix_(kept, unknown)], -rates[kept], rcond=RANK)
        for k, change in zip(unknown, step, strict=True):
            values[(*states, *inputs)[k]] += float(change)
        rates, slopes = field.at(values)
    n = len(states)
    return LinearModel(
        states,
        inputs,
        slopes[:, :n],
        slopes[:, n:],
        {s: values[s] for s in (*states, *inputs)},
        float(np.max(np.abs(rates[kept]), initial=0.0)),
    )


def _start(
    equations: Equations,
    point: OperatingPoint,
    states: Sequence[sp.Symbol],
    inputs: Sequence[sp.Symbol],
) -> Values:
    """Values of parameters, states and inputs before the first step; gear outputs go along."""
    values: Values = dict.fromkeys((*states, *inputs), 0.0)
    values |= {i.symbol: 0.0 for i in equations.inputs}
    values |= {state.symbol: state.initial for state in equations.extra_states}
    values |= {p.symbol: p.default for p in equations.parameters} | {kinematics.TIME: 0.0}
    for axis in equations.axes:
        angle, rate = point.angles.get(axis, 0.0), point.rates.get(axis, 0.0)
        values |= {kinematics.angle(axis): angle, kinematics.gear_angle(axis): angle}
        values |= {kinematics.rate(axis): rate, kinematics.gear_rate(axis): rate}
    return values


def _in_mode(equations: Equations, sliding: bool) -> Equations:
    """`equations` in one mode: friction a torque or none, bodies in rigid contact one body."""
    modes: dict[sp.Basic, sp.Expr] = dict.fromkeys(equations.mode_symbols, sp.Integer(0))
    for contact in equations.contacts:
        modes |= {contact.side: sp.Integer(1), contact.active: sp.Integer(1)}
    forcing, terms = list(equations.forcing), dict(equations.terms)
    for friction in equations.frictions if sliding else ():
        modes[slide(friction.axis)] = sp.Integer(1)
        forcing[equations.rates.index(friction.rate)] -= friction.level
        terms |= friction.terms
    found = replace(
        equations, forcing=sp.ImmutableMatrix(forcing), terms=tuple(terms.items()), frictions=()
    )
    found = _replaced(found, modes)
    for contact in equations.contacts:
        if contact.rigid:
            found = _joined(found, contact)
    return found


def _replaced(equations: Equations, new: Mapping[sp.Basic, sp.Expr]) -> Equations:
    """`equations` with `new` put in for symbols, in all that moves the machine."""
    return replace(
        equations,
        mass_matrix=equations.mass_matrix.xreplace(new),
        forcing=equations.forcing.xreplace(new),
        terms=tuple((symbol, term.xreplace(new)) for symbol, term in equations.terms),
        extra_states=tuple(
            replace(s, derivative=s.derivative.xreplace(new)) for s in equations.extra_states
        ),
    )


def _joined(equations: Equations, contact: Contact) -> Equations:
    """`equations` in which gear output and joint of a rigid `contact` turn as one body."""
    axis = contact.axis
    gear, joint = (equations.rates.index(r(axis)) for r in (kinematics.gear_rate, kinematics.rate))
    together = {
        kinematics.gear_angle(axis): kinematics.angle(axis) + contact.half_gap,
        kinematics.gear_rate(axis): kinematics.rate(axis),
    }
    turned = _replaced(equations, together)
    rows = sp.eye(len(equations.rates))
    rows[gear, joint] = 1
    rows.col_del(gear)
    left = [k for k in range(len(equations.rates)) if k != gear]
    return replace(
        turned,
        coordinates=tuple(turned.coordinates[k] for k in left),
        rates=tuple(turned.rates[k] for k in left),
        mass_matrix=sp.ImmutableMatrix(rows.T * turned.mass_matrix * rows),
        forcing=sp.ImmutableMatrix(rows.T * turned.forcing),
    )


def _states(equations: Equations) -> tuple[sp.Symbol, ...]:
    """Coordinates, rates, and the other states on which accelerations depend."""
    sampled = {symbol for _, symbol, _ in equations.updates}
    others = {s.symbol: s.derivative for s in equations.extra_states if s.symbol not in sampled}
    needed = _symbols(equations, [*equations.mass_matrix, *equations.forcing])
    found: set[sp.Symbol] = set()
    while new := (needed & others.keys()) - found:
        found |= new
        needed |= _symbols(equations, [others[s] for s in new])
    return (*equations.coordinates, *equations.rates, *(s for s in others if s in found))


def _inputs(equations: Equations) -> tuple[sp.Symbol, ...]:
    """What brings power into the machine: its inputs, and what samplers set, on which it depends.

    A temperature, say, is not among them.
    """
    states = _states(equations)
    derivatives = [s.derivative for s in equations.extra_states if s.symbol in states]
    used = _symbols(equations, [*equations.mass_matrix, *equations.forcing, *derivatives])
    driving = _symbols(equations, [equations.ledger.power_in])
    given = [i.symbol for i in equations.inputs]
    given += dict.fromkeys(symbol for _, symbol, _ in equations.updates)
    return tuple(symbol for symbol in given if symbol in used & driving)


def _symbols(equations: Equations, expressions: Sequence[sp.Expr]) -> set[sp.Symbol]:
    """The symbols of `expressions`, also inside the named functions."""
    found = {s for e in expressions for s in e.free_symbols}
    for symbol, term in reversed(equations.terms):
        if symbol in found:
            found |= term.free_symbols
    return found


class VectorField:
    """dx/dt of `states` and its derivatives by `states` and `inputs`, at given values."""

    def __init__(self, equations: Equations) -> None:
        self.equations = equations
        self.states, self.inputs = states, inputs = _states(equations), _inputs(equations)
        self._variables = (*states, *inputs)
        n = len(equations.rates)
        self._mass = [[real(f"mass_{i}_{j}") for j in range(n)] for i in range(n)]
        self._force = [real(f"force_{i}") for i in range(n)]
        self._others = {
            s.symbol: real(f"rate_of_{s.name}")
            for s in equations.extra_states
            if s.symbol in states
        }
        given = list(equations.terms)
        given += [
            (self._mass[i][j], equations.mass_matrix[i, j]) for i in range(n) for j in range(n)
        ]
        given += zip(self._force, equations.forcing, strict=True)
        given += [
            (self._others[s.symbol], s.derivative)
            for s in equations.extra_states
            if s.symbol in states
        ]
        moving = {*self._variables} | {name for name, _ in given}
        self._lines = [_line(name, expression, moving) for name, expression in given]

    def at(self, values: Mapping[sp.Symbol, float]) -> tuple[Array, Array]:
        """dx/dt [n], and its derivatives [n, n + m] by states and inputs."""
        known = dict(values)
        units = np.eye(len(self._variables))
        slopes: dict[sp.Symbol, Array] = dict(zip(self._variables, units, strict=True))
        for line in self._lines:
            value, *partial = line.compute(*(known[s] for s in line.used))
            known[line.name] = float(value)
            slopes[line.name] = sum(
                (float(p) * slopes[s] for p, s in zip(partial, line.moving, strict=True)),
                np.zeros(len(self._variables)),
            )
        mass = np.array([[known[m] for m in row] for row in self._mass])
        force = np.array([known[f] for f in self._force])
        accelerations = np.linalg.solve(mass, force)
        right = np.array([slopes[f] for f in self._force])
        for i, row in enumerate(self._mass):
            right[i] -= sum(a * slopes[m] for a, m in zip(accelerations, row, strict=True))
        turned = np.linalg.solve(mass, right)
        rates = dict(zip(self.equations.coordinates, self.equations.rates, strict=True))
        found = {q: (known[w], slopes[w]) for q, w in rates.items()}
        found |= dict(
            zip(self.equations.rates, zip(accelerations, turned, strict=True), strict=True)
        )
        found |= {s: (known[r], slopes[r]) for s, r in self._others.items()}
        return (
            np.array([found[s][0] for s in self.states]),
            np.array([found[s][1] for s in self.states]),
        )


def _line(name: sp.Symbol, expression: sp.Expr, moving: set[sp.Symbol]) -> _Line:
    used = sorted(expression.free_symbols, key=str)
    own = [s for s in used if s in moving]
    partial = [derivative(expression, s) for s in own]
    compute = sp.lambdify(used, [expression, *partial], "numpy", cse=True)
    return _Line(name, tuple(used), tuple(own), compute)
