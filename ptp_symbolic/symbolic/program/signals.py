"""Kernels of what is read of the state and set in it: outputs, energies, bounds, samplers."""

import sympy as sp

from ptp_symbolic.symbolic.derivation.differentiation import derivative
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program import dynamics
from ptp_symbolic.symbolic.program.kernel import (
    MODE_ARGUMENTS,
    Kernel,
    Vectors,
    kernel,
    shared_lines,
    variables,
)
from ptp_symbolic.symbolic.program.sharing import Line, share
from ptp_symbolic.symbolic.program.term_names import vocabulary
from ptp_symbolic.symbolic.symbols import ZERO


def outputs_kernel(grouped: Equations, solve: dynamics.Solve, vectors: Vectors) -> Kernel:
    """Kernel `outputs`; what depends on accelerations is of the modes that the state implies."""
    outputs = [(f"y[{i}]", e) for i, (_, _, e) in enumerate(grouped.outputs)]
    lines = share(solve.definitions, outputs, vocabulary(grouped))
    doc = "Write the measured signals into y."
    return kernel("outputs", "t, x, u, p, y", doc, vectors, lines)


def output_jacobian_kernel(
    equations: Equations, grouped: Equations, solve: dynamics.Solve, vectors: Vectors
) -> Kernel:
    """Kernel `output_jacobian`: by the chain rule through accelerations where outputs have any."""
    doc = "Write the non-zero derivatives of outputs by state and parameter."
    lines = _output_slopes(equations, grouped, solve, "xp")
    return kernel("output_jacobian", "t, x, u, p, yx, yp", doc, vectors, lines)


def output_input_jacobian_kernel(
    equations: Equations, grouped: Equations, solve: dynamics.Solve, vectors: Vectors
) -> Kernel:
    """Kernel `output_input_jacobian`: inputs act on outputs through accelerations."""
    doc = "Write the non-zero derivatives of outputs by input."
    lines = _output_slopes(equations, grouped, solve, "u")
    return kernel("output_input_jacobian", "t, x, u, p, yu", doc, vectors, lines)


def _output_slopes(
    equations: Equations, grouped: Equations, solve: dynamics.Solve, by: str
) -> list[Line]:
    """The lines that compute the derivatives of outputs by the variables of the arrays `by`."""
    accelerated = any(e.has(*solve.accelerations) for _, _, e in equations.outputs)
    columns = [(letter, own) for letter, own in variables(equations) if letter in by]
    every = [symbol for _, own in columns for symbol in own]
    slopes = dynamics.acceleration_slopes(grouped, solve, every) if accelerated else None
    outputs = [
        (
            f"y{letter}[{i}, {j}]",
            dynamics.derivative_of(solve, slopes, expression, variable)
            if slopes
            else derivative(equations.written_out(expression), variable),
        )
        for letter, own in columns
        for j, variable in enumerate(own)
        for i, (_, _, expression) in enumerate(equations.outputs)
    ]
    definitions = (*solve.definitions, *slopes.lines) if slopes else ()
    return shared_lines(grouped if slopes else equations, definitions, outputs)


def energies(equations: Equations, solve: dynamics.Solve) -> list[sp.Expr]:
    """Stored energy, power in and dissipated power; the kinetic energy in terms of `solve` where it
    is the quadratic form of the mass matrix.
    """
    ledger, rates = equations.ledger, sp.Matrix(equations.rates)
    stored = ledger.stored
    at_rest = stored.xreplace(dict.fromkeys(rates, ZERO))
    kinetic = (rates.T * equations.mass_matrix * rates)[0] / 2
    if sp.expand(stored - at_rest - kinetic) == 0:
        stored = at_rest + sp.expand((rates.T * solve.mass * rates)[0] / 2)
    return [stored, ledger.power_in, ledger.dissipated]


def domain_kernel(equations: Equations, vectors: Vectors) -> Kernel:
    """Kernel `domain`."""
    outputs = [
        (f"bounds[{k}, {side}]", bound)
        for k, own in enumerate(equations.limits)
        for side, bound in enumerate((own.lower, own.upper))
    ]
    doc = "Write lower and upper bound of the state of every row of DOMAIN into bounds."
    return kernel("domain", "p, bounds", doc, vectors, share((), outputs, vocabulary(equations)))


def sampler_kernels(equations: Equations, vectors: Vectors) -> list[Kernel]:
    """What samplers do, and its derivatives; nothing in a machine that has none."""
    if not equations.samplers:
        return []
    values = [e for s in equations.samplers for e in (s.period, s.offset, s.phase)]
    values += [value for _, _, value in equations.updates]
    terms = {symbol: term for s in equations.samplers for symbol, term in s.terms.items()}
    outputs = [(f"z[{i}]", e) for i, e in enumerate(values)]
    doc = "Write period, offset and phase of every sampler, then what SAMPLED states become into z."
    named = [(str(symbol), term) for symbol, term in (*equations.terms, *terms.items())]
    lines = share(named, outputs, vocabulary(equations))
    for symbol, term in reversed(terms.items()):
        values = [value.xreplace({symbol: term}) for value in values]
    slopes = [
        (f"z{letter}[{i}, {j}]", derivative(equations.written_out(value), variable))
        for letter, symbols in variables(equations)
        for j, variable in enumerate(symbols)
        for i, value in enumerate(values)
    ]
    derived = shared_lines(equations, (), slopes)
    by = "Write the non-zero derivatives of sample by state, input and parameter."
    arguments = f"{MODE_ARGUMENTS}, zx, zu, zp"
    return [
        kernel("sample", f"{MODE_ARGUMENTS}, z", doc, vectors, lines),
        kernel("sample_jacobian", arguments, by, vectors, derived),
    ]


def margins_kernel(equations: Equations, vectors: Vectors) -> Kernel:
    """Kernel `margins`."""
    outputs = [
        (f"margin[{k}]", own.holds.gts - own.holds.lts)
        for k, own in enumerate(equations.requirements)
    ]
    doc = "Write by how much the parameters meet every row of REQUIREMENTS into margin."
    return kernel("margins", "p, margin", doc, vectors, share((), outputs, vocabulary(equations)))
