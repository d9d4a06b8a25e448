"""Lines of kernels: by what they are differentiated, how they share terms, what they use."""

from collections.abc import Sequence

import sympy as sp

from ptp_symbolic.symbolic.codegen.sharing import Line, share
from ptp_symbolic.symbolic.codegen.term_names import vocabulary
from ptp_symbolic.symbolic.derivation.equations import Equations


def variables(
    equations: Equations,
) -> list[tuple[str, tuple[sp.Symbol, ...]]]:
    """The symbols by which kernels are differentiated, by the letter of their array."""
    parameters = tuple(p.symbol for p in equations.parameters)
    inputs = tuple(i.symbol for i in equations.inputs)
    return [("x", equations.state_symbols), ("u", inputs), ("p", parameters)]


def shared_lines(
    equations: Equations, definitions: Sequence[Line], outputs: Sequence[Line]
) -> list[Line]:
    """The lines that compute those of `outputs` that are not zero, with terms in common."""
    present = [(t, e) for t, e in outputs if e != 0]
    return share(definitions, present, vocabulary(equations))


def used_names(lines: Sequence[Line]) -> set[str]:
    """Names of the symbols that `lines` use."""
    return {str(symbol) for _, expression in lines for symbol in expression.free_symbols}
