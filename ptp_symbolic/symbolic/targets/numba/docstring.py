"""The docstring of an emitted module: its equations, what they cost, the effects in them."""

import textwrap

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.latex import plain_text_of
from ptp_symbolic.symbolic.program.program import Operations
from ptp_symbolic.symbolic.simplify.readable import readable
from ptp_symbolic.symbolic.symbols import real
from ptp_symbolic.symbolic.targets.printing import Language
from ptp_symbolic.symbolic.targets.target import literal


def docstring(equations: Equations, operations: Operations, language: Language) -> str:
    """The docstring of the module that computes `equations`: these in the form in which it does,
    the `operations` of the state derivative (as derived, as written, at every call), its effects.
    """
    title = literal(equations.title)[1:-1]
    precision = " in single precision" if language.single else ""
    lines = [f'"""{title}: equations of motion{precision}, emitted; do not edit.', ""]
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
    if equations.terms:
        lines += ["", "with the functions named above, in order of use:", ""]
    for symbol, term in equations.terms:
        lines += _wrapped(str(symbol), term)
    lines += [""] if equations.terms else []
    for friction in equations.frictions:
        lines += _wrapped(f"sliding friction[{friction.rate}]", friction.level)
    sampled = {symbol for _, symbol, _ in equations.updates}
    for state in equations.extra_states:
        if state.symbol not in sampled:
            lines += _wrapped(f"{state.name}'", state.derivative)
    for sampler in equations.samplers:
        start = real("k") + sampler.phase
        lines += _wrapped("instants", sampler.offset + start * sampler.period)
        for symbol, term in sampler.terms.items():
            lines += _wrapped(str(symbol), term)
        for symbol, value in sampler.updates.items():
            lines += _wrapped(f"{symbol} from there", value)
    lines += [
        "",
        f"Operations of the state derivative: {operations.derived} as derived,"
        f" {operations.written} as written, {operations.each} of"
        " them at every",
        "call where `prepare` does the others once per parameter set.",
    ]
    lines += ["", "Effects:"]
    for placed in equations.effects:
        where = f" ({placed.axis})" if placed.axis else ""
        lines.append(f"- {placed.effect.id}{where}: {literal(placed.effect.reference)[1:-1]}")
    lines.append('"""')
    return "\n".join(lines)


def _wrapped(name: str, expression: sp.Expr) -> list[str]:
    text = f"{name} = {plain_text_of(readable(expression))}"
    return textwrap.wrap(text, 96, initial_indent="  ", subsequent_indent="      ")
