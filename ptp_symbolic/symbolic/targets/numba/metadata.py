"""The head of an emitted module: what it is, names, units, bounds, effects and equations."""

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations, PlacedEffect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.program.program import Layout, layout
from ptp_symbolic.symbolic.targets.numba.literals import (
    listed,
    long_text,
    named_tuple_text,
    number_text,
    numbers_text,
)
from ptp_symbolic.symbolic.targets.printing import Language
from ptp_symbolic.symbolic.targets.target import literal, state_units


def metadata_text(
    equations: Equations, digest: str, opening: str, prepared: int, language: Language
) -> str:
    """Return docstring, imports and constants of the module of `equations`, of which `prepared`
    numbers are computed once.
    """
    constants = [
        f'MODEL_HASH = "{digest}"',
        f"NAME = {literal(equations.name)}",
        f"TITLE = {literal(equations.title)}",
        "# How many numbers `prepare` writes.",
        f"PREPARED = {prepared}",
        *_signal_lines(equations),
        *_motion_lines(equations),
        *_parameter_lines(equations),
    ]
    return "\n\n".join([opening, _imports(equations, language), "\n".join(constants)])


def search_text(equations: Equations) -> str:
    """Return what a fit and a diagnosis need to know beside the numbers: constants at the end."""
    lines = [
        "# What follows is for fits and diagnoses; no function above uses it.",
        "# States without influence while these parameters are at their vanishing values.",
        named_tuple_text("IDLE_STATES", _idle_states(equations)),
        "# Relations: parameters, rule, strict; `margins` gives what is at least zero.",
        named_tuple_text("REQUIREMENTS", _requirements(equations)),
        "# Searching them: name, value at which the effect vanishes (None: any), starts,",
        "# period, what a frequency is locked to.",
        named_tuple_text("SEARCH", [_search(p) for p in equations.parameters if _is_searched(p)]),
        "# Effects: id, axis, parameters, nested members (title, parameters, tied ones),"
        " keys of the",
        "# effects that it acts on, title, reference, separating experiment, first member leads.",
        named_tuple_text("EFFECTS", _effects(equations)),
    ]
    return "\n".join(lines)


def _signal_lines(equations: Equations) -> list[str]:
    """Names and units of what goes in, what moves and what comes out."""
    return [
        named_tuple_text("AXES", map(literal, equations.axes)),
        named_tuple_text("STATE_NAMES", (f'"{s}"' for s in equations.state_symbols)),
        named_tuple_text("STATE_UNITS", map(literal, state_units(equations).values())),
        named_tuple_text("STATE_INITIAL", map(repr, _state_initial(equations))),
        named_tuple_text("INPUT_NAMES", (f'"{i.name}"' for i in equations.inputs)),
        named_tuple_text("INPUT_UNITS", (f'"{i.unit}"' for i in equations.inputs)),
        "# Per input: index of the parameter by which it is late, or -1.",
        named_tuple_text("INPUT_DELAYS", map(str, _delays(equations))),
        "# Per input: whether motion depends on it, and not samplers alone.",
        named_tuple_text("INPUT_ACTS", map(str, _acting(equations))),
        named_tuple_text("OUTPUT_NAMES", (f'"{name}"' for name, _, _ in equations.outputs)),
        named_tuple_text("OUTPUT_UNITS", (f'"{unit}"' for _, unit, _ in equations.outputs)),
    ]


def _motion_lines(equations: Equations) -> list[str]:
    """Modes, samplers, contacts and limits: what a simulation must watch."""
    own = layout(equations)
    return [
        named_tuple_text("MODE_NAMES", (f'"{m}"' for m in equations.mode_symbols)),
        *_friction_rates(equations, own),
        "# Per state: the friction that sets it to zero when it comes to rest, or -1.",
        named_tuple_text("ZERO_AT_REST", map(str, own.zero_at_rest)),
        "# Samplers: parameters of the period. Sampled: sampler and state of each update.",
        named_tuple_text("SAMPLERS", _samplers(equations)),
        named_tuple_text("SAMPLED", _sampled(equations)),
        "# Per contact: state index of the angle at the gear output and at the joint.",
        named_tuple_text("CONTACT_ANGLES", (f"({a}, {b})" for a, b in own.contact_angles)),
        *_rigid_contacts(own),
        "# Limits of the equations: state, meaning; `domain` gives the bounds.",
        named_tuple_text("DOMAIN", _domain(equations)),
    ]


def _parameter_lines(equations: Equations) -> list[str]:
    return [
        "# Parameters: name, unit, default, lower and upper bound, meaning.",
        named_tuple_text("PARAMETERS", map(_parameter, equations.parameters)),
    ]


def _imports(equations: Equations, language: Language) -> str:
    arrays = "import numpy as np\n" if equations.mode_symbols else ""
    numbers = "\nfrom numpy import float32" if language.single else ""
    return f"import math\n\n{arrays}from numba import njit{numbers}"


def _parameter(parameter: Parameter) -> str:
    p = parameter
    fields = [literal(p.name), literal(p.unit)]
    fields += [repr(float(value)) for value in (p.default, p.lower, p.upper)]
    return f"({', '.join([*fields, literal(p.meaning)])})"


def _is_searched(p: Parameter) -> bool:
    return (p.vanishes, p.starts, p.period, p.locked_to) != (None, (), None, None)


def _search(p: Parameter) -> str:
    lock = "None" if p.locked_to is None else literal(p.locked_to)
    fields = [
        literal(p.name),
        number_text(p.vanishes),
        numbers_text(p.starts),
        number_text(p.period),
        lock,
    ]
    return f"({', '.join(fields)})"


def _state_initial(equations: Equations) -> list[float]:
    initial = {state.name: float(state.initial) for state in equations.extra_states}
    return [initial.get(str(symbol), 0.0) for symbol in equations.state_symbols]


def _idle_states(equations: Equations) -> list[str]:
    return [
        f"({literal(name)}, ({listed(map(literal, off))}))"
        for name, off in equations.idle_states.items()
    ]


def _samplers(equations: Equations) -> list[str]:
    rows = []
    for sampler in equations.samplers:
        symbols = {str(symbol) for symbol in sampler.period.free_symbols}
        names = [literal(p.name) for p in equations.parameters if p.name in symbols]
        rows.append(f"({listed(names)})")
    return rows


def _sampled(equations: Equations) -> list[str]:
    states = list(equations.state_symbols)
    return [f"({owner}, {states.index(symbol)})" for owner, symbol, _ in equations.updates]


def _domain(equations: Equations) -> list[str]:
    return [f"({literal(str(own.state))}, {literal(own.meaning)})" for own in equations.limits]


def _requirements(equations: Equations) -> list[str]:
    rows = []
    for own in equations.requirements:
        symbols = {str(symbol) for symbol in own.holds.free_symbols}
        names = [literal(p.name) for p in equations.parameters if p.name in symbols]
        inner = f"({listed(names)})"
        strict = isinstance(own.holds, sp.StrictGreaterThan | sp.StrictLessThan)
        rows.append(f"({inner}, {literal(own.rule)}, {strict})")
    return rows


def _acting(equations: Equations) -> list[bool]:
    motion = {str(symbol) for symbol in equations.motion_symbols}
    return [given.name in motion for given in equations.inputs]


def _delays(equations: Equations) -> list[int]:
    names = [p.name for p in equations.parameters]
    return [-1 if delay is None else names.index(str(delay)) for delay in equations.delays]


def _effects(equations: Equations) -> list[str]:
    used = {p.name for p in equations.parameters}
    rows = []
    for placed in equations.effects:
        names = [f'"{name}"' for name in placed.parameters if name in used]
        inner = f"({listed(names)})"
        effect = placed.effect
        axis = "None" if placed.axis is None else f'"{placed.axis}"'
        texts = (effect.title, effect.reference, effect.separating_experiment)
        members, acted_on = _members(placed, used), f"({listed(map(literal, placed.acts_on))})"
        fields = [f'"{effect.id}"', axis, inner, members, acted_on, *map(long_text, texts)]
        fields += [str(effect.first_leads)]
        rows.append(f"({', '.join(fields)})")
    return rows


def _members(placed: PlacedEffect, used: set[str]) -> str:
    """The nested members of an effect, those that lack a parameter here left out."""
    rows = []
    for member in placed.effect.members:
        named = [name.format(axis=placed.axis) for name in member.parameters]
        own = [name for name in named if name in placed.parameters]
        tied = [tuple(n.format(axis=placed.axis) for n in pair) for pair in member.tied.items()]
        if set(own) <= used:
            pairs = listed(f"({literal(a)}, {literal(b)})" for a, b in tied)
            rows.append(f"({literal(member.title)}, ({listed(map(literal, own))}), ({pairs}))")
    return f"({listed(rows)})"


def _friction_rates(equations: Equations, own: Layout) -> list[str]:
    """An array where the module has modes: compiled code cannot index an empty tuple."""
    indices = [str(index) for index in own.friction_rates]
    if not equations.mode_symbols:
        return [named_tuple_text("FRICTION_RATES", indices)]
    return [f"FRICTION_RATES = np.array([{', '.join(indices)}], dtype=np.int64)"]


def _rigid_contacts(own: Layout) -> list[str]:
    """Nothing where every contact is sprung."""
    if not own.rigid_contacts:
        return []
    rows = ", ".join(f"[{a}, {b}, {rule}]" for a, b, rule in own.rigid_contacts)
    return [
        "# Per contact: state index of both rates; 0 sprung, 1 rigid, 2 rigid and held in the gap.",
        f"RIGID_CONTACTS = np.array([{rows}], dtype=np.int64)",
    ]
