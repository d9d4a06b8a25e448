"""The variables of an FMU: names, units and bounds, in the order of their value references."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.effect_interface.place import slide
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.program.kernel import Entry
from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.targets.target import state_meanings, state_units

FIXED, TUNABLE, CONTINUOUS, DISCRETE = "fixed", "tunable", "continuous", "discrete"
# Enumerations of the modes: values and what they mean.
ENUMERATIONS = {
    "Sliding": ((-1, "backward"), (0, "sticking"), (1, "forward")),
    "Side": ((-1, "lower face"), (0, "between the faces"), (1, "upper face")),
    "Activity": ((0, "no force"), (1, "force")),
}


@dataclass(frozen=True)
class Variable:
    """A variable: `reference` is its value reference, `of` that of the state of a derivative;
    `depends` are the references of what a derivative or output depends on.
    """

    name: str
    reference: int
    causality: str
    variability: str
    meaning: str
    unit: str = ""
    start: float | None = None
    lower: float | None = None
    upper: float | None = None
    nominal: float | None = None
    enumeration: str | None = None
    of: int | None = None
    jumps: bool = False
    depends: tuple[int, ...] = field(default=())


@dataclass(frozen=True)
class Variables:
    """All variables by kind; `outputs` are those that are no states, `seen` the references of all
    outputs.
    """

    states: tuple[Variable, ...]
    derivatives: tuple[Variable, ...]
    inputs: tuple[Variable, ...]
    outputs: tuple[Variable, ...]
    parameters: tuple[Variable, ...]
    indicators: tuple[Variable, ...]
    modes: tuple[Variable, ...]
    seen: tuple[int, ...]

    @property
    def all(self) -> tuple[Variable, ...]:
        """All of them, in the order of their value references."""
        moving = (*self.states, *self.derivatives, *self.inputs, *self.outputs)
        return (*moving, *self.parameters, *self.indicators, *self.modes)

    @property
    def units(self) -> list[str]:
        """Units in use, each once."""
        return list(dict.fromkeys(v.unit for v in self.all if v.unit))


def variables(program: Program) -> Variables:
    """The variables of a program, with value references as the C of an instance counts them."""
    equations = program.equations
    names = [str(symbol) for symbol in equations.state_symbols]
    sampled = {str(symbol) for _, symbol, _ in equations.updates}
    free = [name for name in names if name not in sampled]
    at_derivatives = 1 + len(names)
    at_inputs = at_derivatives + len(free)
    at_outputs = at_inputs + len(equations.inputs)
    at_parameters = at_outputs + len(equations.outputs)
    at_indicators = at_parameters + len(equations.parameters)
    needs_field, needs_outputs = _dependencies(program, at_inputs)
    same = {str(e) for _, _, e in equations.outputs}
    units, meanings = state_units(equations), state_meanings(equations)
    nominal, nominal_outputs = nominals(equations)
    initial = {state.name: float(state.initial) for state in equations.extra_states}
    states = tuple(
        Variable(
            name,
            1 + i,
            "output" if name in same else "local",
            DISCRETE if name in sampled else CONTINUOUS,
            meanings[name],
            units[name],
            initial.get(name, 0.0),
            nominal=nominal.get(name),
            jumps=program.has_modes and name not in sampled,
            depends=(1 + i,),
        )
        for i, name in enumerate(names)
    )
    derivatives = tuple(
        Variable(
            f"der({name})",
            at_derivatives + i,
            "local",
            CONTINUOUS,
            f"time derivative of {name}",
            per_second(units[name]),
            of=1 + i,
            depends=needs_field.get(i, ()),
        )
        for i, name in enumerate(free)
    )
    inputs = tuple(
        Variable(g.name, at_inputs + i, "input", CONTINUOUS, g.meaning, g.unit, 0.0)
        for i, g in enumerate(equations.inputs)
    )
    taken = {*names, *(g.name for g in equations.inputs), *(p.name for p in equations.parameters)}
    outputs = tuple(
        Variable(
            f"measured_{name}" if name in taken else name,
            at_outputs + i,
            "output",
            CONTINUOUS,
            f"measured {name}",
            unit,
            nominal=nominal_outputs.get(name),
            depends=needs_outputs.get(i, ()),
        )
        for i, (name, unit, expression) in enumerate(equations.outputs)
        if str(expression) not in names
    )
    seen = [
        1 + names.index(str(e)) if str(e) in names else at_outputs + i
        for i, (_, _, e) in enumerate(equations.outputs)
    ]
    return Variables(
        states,
        derivatives,
        inputs,
        outputs,
        _parameters(equations, at_parameters),
        *_event_variables(equations, at_indicators),
        tuple(dict.fromkeys(seen)),
    )


def nominals(equations: Equations) -> tuple[dict[str, float], dict[str, float]]:
    """Sizes to be expected of states and outputs, in their units, to two digits; of those of which
    the platform tells it.

    A state that has a domain may go to its farther bound. A state of an effect settles while joints
    turn at 1 rad/s (m/s) in one direction at angle 0 and inputs are 1: bristles at the bend at
    which they slip, a current at that of 1 V less the voltage of the motor. Outputs follow.
    """
    usual: dict[sp.Expr, sp.Expr] = {p.symbol: sp.Float(p.default) for p in equations.parameters}
    bounds: dict[str, list[float]] = {}
    for limit in equations.limits:
        ends = [_number(end, usual) for end in (limit.lower, limit.upper)]
        bounds.setdefault(str(limit.state), []).append(max(abs(end) for end in ends))
    ones = (*equations.rates, *(i.symbol for i in equations.inputs), *equations.mode_symbols)
    usual |= dict.fromkeys(ones, sp.Float(1)) | {TIME: sp.Float(0)}
    at_rest = usual | dict.fromkeys(equations.coordinates, sp.Float(0))
    at_rest |= {state.symbol: sp.Float(0) for state in equations.extra_states}
    states = {name: min(own) for name, own in bounds.items()}
    for state in equations.extra_states:
        at = [
            _number(equations.written_out(state.derivative), at_rest | {state.symbol: sp.Float(z)})
            for z in (0, 1, 2)
        ]
        slope = at[1] - at[0]
        if slope < 0.0 and math.isclose(at[2] - at[1], slope, rel_tol=1e-9):
            states[state.name] = abs(at[0] / slope)
    symbols = (*equations.coordinates, *(state.symbol for state in equations.extra_states))
    moved = usual | {symbol: sp.Float(states.get(str(symbol)) or 1) for symbol in symbols}
    outputs = {
        name: abs(_number(equations.written_out(expression), moved))
        for name, _, expression in equations.outputs
    }
    return _to_two_digits(states), _to_two_digits(outputs)


def _number(expression: sp.Expr, values: Mapping[sp.Expr, sp.Expr]) -> float:
    """The value of an expression; no number where something in it has none."""
    try:
        return float(expression.xreplace(values))
    except TypeError:
        return math.nan


def _to_two_digits(sizes: Mapping[str, float]) -> dict[str, float]:
    """The sizes that are numbers above zero: alike on every machine."""
    sure = {name: size for name, size in sizes.items() if size > 0.0 and math.isfinite(size)}
    return {name: float(f"{size:.1e}") for name, size in sure.items()}


def _parameters(equations: Equations, first: int) -> tuple[Variable, ...]:
    """Parameters; those of the instants of samplers are fixed."""
    timing = {
        str(symbol)
        for s in equations.samplers
        for e in (s.period, s.offset)
        for symbol in e.free_symbols
    }
    return tuple(
        Variable(
            p.name,
            first + i,
            "parameter",
            FIXED if p.name in timing else TUNABLE,
            p.meaning,
            p.unit,
            float(p.default),
            float(p.lower),
            float(p.upper),
        )
        for i, p in enumerate(equations.parameters)
    )


def _event_variables(
    equations: Equations, first: int
) -> tuple[tuple[Variable, ...], tuple[Variable, ...]]:
    """Event indicators and modes."""
    slides = [str(slide(f.axis)) for f in equations.frictions]
    modes = list(map(str, equations.mode_symbols))
    elements = [*slides, *modes[len(slides) :: 2]]
    watched = [f"event({name})" for name in elements]
    watched += [f"event({own.state}, {i + 1})" for i, own in enumerate(equations.limits)]
    indicators = tuple(
        Variable(name, first + i, "local", CONTINUOUS, "above zero: the mode or domain has ended")
        for i, name in enumerate(watched)
    )
    after = first + len(indicators)
    kinds = ["Sliding"] * len(slides) + ["Side", "Activity"] * len(modes)
    return indicators, tuple(
        Variable(
            name,
            after + i,
            "local",
            DISCRETE,
            _mode_meaning(name, kind),
            enumeration=kind,
        )
        for i, (name, kind) in enumerate(zip(modes, kinds, strict=False))
    )


def _mode_meaning(name: str, kind: str) -> str:
    what = {
        "Sliding": "direction in which the friction slides",
        "Side": "face that is touched",
        "Activity": "whether the face that is touched transmits force",
    }[kind]
    return f"{name.partition('_')[2]}: {what}"


def _dependencies(
    program: Program, at_inputs: int
) -> tuple[dict[int, tuple[int, ...]], dict[int, tuple[int, ...]]]:
    """By row of dx/dt and of the outputs, the value references of states and inputs in it."""

    def by_row(kernel: str, first_of: dict[str, int]) -> dict[int, tuple[int, ...]]:
        found: dict[int, set[int]] = {}
        own = program.kernel(kernel)
        for target, _ in own.body if own is not None else ():
            if isinstance(target, Entry) and target.array in first_of:
                row, column = target.indices
                found.setdefault(row, set()).add(first_of[target.array] + column)
        return {row: tuple(sorted(columns)) for row, columns in found.items()}

    field = by_row("linearize", {"fx": 1, "fu": at_inputs})
    outputs = by_row("output_jacobian", {"yx": 1})
    direct = by_row("output_input_jacobian", {"yu": at_inputs})
    for row, own in direct.items():
        outputs[row] = (*outputs.get(row, ()), *own)
    return field, outputs


def per_second(unit: str) -> str:
    """The unit of a time derivative."""
    known = {"1": "1/s", "rad": "rad/s", "rad/s": "rad/s^2", "m": "m/s", "m/s": "m/s^2"}
    if unit in known:
        return known[unit]
    above, stroke, below = unit.partition("/")
    return f"{above}/({below.strip('()')} s)" if stroke else f"{unit}/s"
