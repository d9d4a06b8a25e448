"""The head of an emitted module: what it is, names, units, bounds, effects and equations."""

import json
import textwrap
from collections.abc import Iterable

import sympy as sp

from ptp_symbolic import kinematics
from ptp_symbolic.derivation.equations import Equations, PlacedEffect
from ptp_symbolic.parameters import Parameter

TEXT_WIDTH = 80


def metadata_text(equations: Equations, digest: str, operations: tuple[int, int]) -> str:
    """Return docstring, imports and constants of the module of `equations`."""
    constants = [
        f'MODEL_HASH = "{digest}"',
        f"NAME = {repr_text(equations.name)}",
        f"TITLE = {repr_text(equations.title)}",
        *_signal_lines(equations),
        *_motion_lines(equations),
        *_parameter_lines(equations),
    ]
    return "\n\n".join(
        [_docstring(equations, operations), _imports(equations), "\n".join(constants)]
    )


def _signal_lines(equations: Equations) -> list[str]:
    """Names and units of what goes in, what moves and what comes out."""
    return [
        _tuple("AXES", map(repr_text, equations.axes)),
        _tuple("STATE_NAMES", (f'"{s}"' for s in equations.state_symbols)),
        _tuple("STATE_UNITS", map(repr_text, _state_units(equations))),
        _tuple("STATE_INITIAL", map(repr, _state_initial(equations))),
        _tuple("INPUT_NAMES", (f'"{i.name}"' for i in equations.inputs)),
        _tuple("INPUT_UNITS", (f'"{i.unit}"' for i in equations.inputs)),
        "# Per input: index of the parameter by which it is late, or -1.",
        _tuple("INPUT_DELAYS", map(str, _delays(equations))),
        "# Per input: whether motion depends on it, and not samplers alone.",
        _tuple("INPUT_ACTS", map(str, _acting(equations))),
        _tuple("OUTPUT_NAMES", (f'"{name}"' for name, _, _ in equations.outputs)),
        _tuple("OUTPUT_UNITS", (f'"{unit}"' for _, unit, _ in equations.outputs)),
    ]


def _motion_lines(equations: Equations) -> list[str]:
    """Modes, samplers, contacts and limits: what a simulation must watch."""
    return [
        _tuple("MODE_NAMES", (f'"{m}"' for m in equations.mode_symbols)),
        *_friction_rates(equations),
        "# Per state: the friction that sets it to zero when it comes to rest, or -1.",
        _tuple("ZERO_AT_REST", map(str, _zero_at_rest(equations))),
        "# Samplers: parameters of the period. Sampled: sampler and state of each update.",
        _tuple("SAMPLERS", _samplers(equations)),
        _tuple("SAMPLED", _sampled(equations)),
        "# Per contact: state index of the angle at the gear output and at the joint.",
        _tuple("CONTACT_ANGLES", _contact_states(equations)),
        *_rigid_contacts(equations),
        "# Limits of the equations: state, meaning; `domain` gives the bounds.",
        _tuple("DOMAIN", _domain(equations)),
    ]


def _parameter_lines(equations: Equations) -> list[str]:
    """Parameters, what relates them, how they are searched, and the effects that they belong to."""
    parameters = equations.parameters
    return [
        "# Relations: parameters, rule, strict; `margins` gives what is at least zero.",
        _tuple("REQUIREMENTS", _requirements(equations)),
        "# Parameters: name, unit, default, lower and upper bound, meaning.",
        _tuple("PARAMETERS", map(_parameter, parameters)),
        "# Searching them: name, value at which the effect vanishes (None: any), starts,",
        "# period, what a frequency is locked to.",
        _tuple("SEARCH", [_search(p) for p in parameters if _is_searched(p)]),
        "# Effects: id, axis, parameters, nested members (title, parameters, tied ones), keys of"
        " the",
        "# effects that it acts on, title, reference, separating experiment.",
        _tuple("EFFECTS", _effects(equations)),
    ]


def _imports(equations: Equations) -> str:
    arrays = "import numpy as np\n" if equations.mode_symbols else ""
    return f"import math\n\n{arrays}from numba import njit"


def _long_text(value: str) -> str:
    """A literal over as many lines as it needs."""
    lines = textwrap.wrap(value, TEXT_WIDTH, drop_whitespace=False) or [""]
    return "\n        ".join(repr_text(line) for line in lines)


def repr_text(value: str) -> str:
    """Return `value` as a double-quoted literal, whatever it holds: titles come from files."""
    return json.dumps(value, ensure_ascii=False)


def _docstring(equations: Equations, operations: tuple[int, int]) -> str:
    title = repr_text(equations.title)[1:-1]
    lines = [f'"""{title}: equations of motion, emitted; do not edit.', ""]
    lines.append("M(q) q'' = forcing - friction, with the lower triangle of M by symmetry:")
    lines.append("")
    n = len(equations.coordinates)
    for i in range(n):
        for j in range(i, n):
            entry = equations.mass_matrix[i, j]
            if entry != 0:
                lines += _wrapped(f"M[{i}, {j}]", entry)
    for i, rate in enumerate(equations.rates):
        lines += _wrapped(f"forcing[{rate}]", equations.forcing[i])
    for symbol, term in equations.terms:
        lines += _wrapped(str(symbol), term)
    for friction in equations.frictions:
        lines += _wrapped(f"sliding friction[{friction.rate}]", friction.level)
    held = {symbol for _, symbol, _ in equations.updates}
    for state in equations.extra_states:
        if sp.Symbol(state.name, real=True) not in held:
            lines += _wrapped(f"{state.name}'", state.derivative)
    for sampler in equations.samplers:
        start = sp.Symbol("k", real=True) + sampler.phase
        lines += _wrapped("instants", sampler.offset + start * sampler.period)
        for symbol, term in sampler.terms.items():
            lines += _wrapped(str(symbol), term)
        for symbol, value in sampler.updates.items():
            lines += _wrapped(f"{symbol} from there", value)
    before, after = operations
    lines += ["", f"Operations of the state derivative: {before} as derived, {after} as written."]
    lines += ["", "Effects:"]
    for placed in equations.effects:
        where = f" ({placed.axis})" if placed.axis else ""
        lines.append(f"- {placed.effect.id}{where}: {placed.effect.reference}")
    lines.append('"""')
    return "\n".join(lines)


def _wrapped(name: str, expression: sp.Expr) -> list[str]:
    text = f"{name} = {sp.sstr(expression, order='lex')}"
    return textwrap.wrap(text, 96, initial_indent="  ", subsequent_indent="      ")


def _tuple(name: str, items: Iterable[str]) -> str:
    items = list(items)
    line = f"{name} = ({', '.join(items)}{',' if len(items) == 1 else ''})"
    if len(line) <= 100:
        return line
    return f"{name} = (\n" + "".join(f"    {item},\n" for item in items) + ")"


def _parameter(parameter: Parameter) -> str:
    p = parameter
    fields = [repr_text(p.name), repr_text(p.unit)]
    fields += [repr(float(value)) for value in (p.default, p.lower, p.upper)]
    return f"({', '.join([*fields, repr_text(p.meaning)])})"


def _is_searched(p: Parameter) -> bool:
    return (p.vanishes, p.starts, p.period, p.locked_to) != (None, (), None, None)


def _search(p: Parameter) -> str:
    lock = "None" if p.locked_to is None else repr_text(p.locked_to)
    fields = [repr_text(p.name), _number(p.vanishes), _floats(p.starts), _number(p.period), lock]
    return f"({', '.join(fields)})"


def _number(value: float | None) -> str:
    return "None" if value is None else repr(float(value))


def _floats(values: tuple[float, ...]) -> str:
    items = ", ".join(repr(float(v)) for v in values)
    return f"({items}{',' if len(values) == 1 else ''})"


def _state_units(equations: Equations) -> list[str]:
    units = {str(q): "rad" for q in equations.coordinates}
    units.update({str(w): "rad/s" for w in equations.rates})
    units.update({state.name: state.unit for state in equations.extra_states})
    return [units[str(symbol)] for symbol in equations.state_symbols]


def _state_initial(equations: Equations) -> list[float]:
    initial = {state.name: float(state.initial) for state in equations.extra_states}
    return [initial.get(str(symbol), 0.0) for symbol in equations.state_symbols]


def _contact_states(equations: Equations) -> list[str]:
    states = list(equations.state_symbols)
    pairs = []
    for contact in equations.contacts:
        gear, joint = (
            states.index(symbol)
            for symbol in (kinematics.gear_angle(contact.axis), kinematics.angle(contact.axis))
        )
        pairs.append(f"({gear}, {joint})")
    return pairs


def _samplers(equations: Equations) -> list[str]:
    rows = []
    for sampler in equations.samplers:
        symbols = {str(symbol) for symbol in sampler.period.free_symbols}
        names = [repr_text(p.name) for p in equations.parameters if p.name in symbols]
        rows.append(f"({', '.join(names)}{',' if len(names) == 1 else ''})")
    return rows


def _sampled(equations: Equations) -> list[str]:
    states = list(equations.state_symbols)
    return [f"({owner}, {states.index(symbol)})" for owner, symbol, _ in equations.updates]


def _rigid_contacts(equations: Equations) -> list[str]:
    """Nothing where every contact is sprung."""
    if not any(contact.rigid for contact in equations.contacts):
        return []
    states, rows = list(equations.state_symbols), []
    for contact in equations.contacts:
        rates = (kinematics.gear_rate(contact.axis), kinematics.rate(contact.axis))
        rule = "2" if contact.holds else "1" if contact.rigid else "0"
        rows.append(f"[{', '.join([*(str(states.index(rate)) for rate in rates), rule])}]")
    return [
        "# Per contact: state index of both rates; 0 sprung, 1 rigid, 2 rigid and held in the gap.",
        f"RIGID_CONTACTS = np.array([{', '.join(rows)}], dtype=np.int64)",
    ]


def _domain(equations: Equations) -> list[str]:
    return [f"({repr_text(str(own.state))}, {repr_text(own.meaning)})" for own in equations.limits]


def _requirements(equations: Equations) -> list[str]:
    rows = []
    for own in equations.requirements:
        symbols = {str(symbol) for symbol in own.holds.free_symbols}
        names = [repr_text(p.name) for p in equations.parameters if p.name in symbols]
        inner = f"({', '.join(names)}{',' if len(names) == 1 else ''})"
        strict = isinstance(own.holds, sp.StrictGreaterThan | sp.StrictLessThan)
        rows.append(f"({inner}, {repr_text(own.rule)}, {strict})")
    return rows


def _friction_rates(equations: Equations) -> list[str]:
    """An array where the module has modes: compiled code cannot index an empty tuple."""
    states = list(equations.state_symbols)
    indices = [str(states.index(friction.rate)) for friction in equations.frictions]
    if not equations.mode_symbols:
        return [_tuple("FRICTION_RATES", indices)]
    return [f"FRICTION_RATES = np.array([{', '.join(indices)}], dtype=np.int64)"]


def _acting(equations: Equations) -> list[bool]:
    motion = {str(symbol) for symbol in equations.motion_symbols}
    return [given.name in motion for given in equations.inputs]


def _delays(equations: Equations) -> list[int]:
    names = [p.name for p in equations.parameters]
    return [-1 if delay is None else names.index(str(delay)) for delay in equations.delays]


def _zero_at_rest(equations: Equations) -> list[int]:
    axes = [friction.axis for friction in equations.frictions]
    zeroed = {
        state.name: axes.index(state.zero_at_rest_of)
        for state in equations.extra_states
        if state.zero_at_rest_of in axes
    }
    return [zeroed.get(str(symbol), -1) for symbol in equations.state_symbols]


def _effects(equations: Equations) -> list[str]:
    used = {p.name for p in equations.parameters}
    rows = []
    for placed in equations.effects:
        names = [f'"{name}"' for name in placed.parameters if name in used]
        inner = f"({', '.join(names)}{',' if len(names) == 1 else ''})"
        effect = placed.effect
        axis = "None" if placed.axis is None else f'"{placed.axis}"'
        texts = (effect.title, effect.reference, effect.separating_experiment)
        members, acted_on = _members(placed, used), f"({_listed(map(repr_text, placed.acts_on))})"
        fields = [f'"{effect.id}"', axis, inner, members, acted_on, *map(_long_text, texts)]
        rows.append("(\n" + "".join(f"        {f},\n" for f in fields) + "    )")
    return rows


def _members(placed: PlacedEffect, used: set[str]) -> str:
    """The nested members of an effect, those that lack a parameter here left out."""
    rows = []
    for member in placed.effect.members:
        own = [name.format(axis=placed.axis) for name in member.parameters]
        tied = [tuple(n.format(axis=placed.axis) for n in pair) for pair in member.tied.items()]
        if set(own) <= used:
            pairs = _listed(f"({repr_text(a)}, {repr_text(b)})" for a, b in tied)
            rows.append(f"({repr_text(member.title)}, ({_listed(map(repr_text, own))}), ({pairs}))")
    return f"({_listed(rows)})"


def _listed(items: Iterable[str]) -> str:
    """Items of a tuple, without its parentheses."""
    found = list(items)
    return f"{found[0]}," if len(found) == 1 else ", ".join(found)
