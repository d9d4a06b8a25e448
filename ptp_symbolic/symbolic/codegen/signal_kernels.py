"""Kernels of what is read of the state and set in it: outputs, energies, bounds, samplers."""

from collections.abc import Sequence

from ptp_symbolic.symbolic.codegen import dynamics
from ptp_symbolic.symbolic.codegen.kernel import MODE_ARGUMENTS, Vectors, kernel_text
from ptp_symbolic.symbolic.codegen.kernel_lines import shared_lines, used_names, variables
from ptp_symbolic.symbolic.codegen.sharing import Line, share
from ptp_symbolic.symbolic.codegen.term_names import vocabulary
from ptp_symbolic.symbolic.derivation.contributions import slope_symbol
from ptp_symbolic.symbolic.derivation.differentiation import derivative
from ptp_symbolic.symbolic.derivation.equations import Equations

IMPLIED_MODES = ("m = np.empty(len(MODE_NAMES))", "initial_modes(t, x, u, p, m)")


def outputs_text(grouped: Equations, solve: dynamics.Solve, vectors: Vectors) -> str:
    """Text of `outputs`; what depends on accelerations is of the modes that the state implies."""
    outputs = [(f"y[{i}]", e) for i, (_, _, e) in enumerate(grouped.outputs)]
    lines = share(solve.definitions, outputs, vocabulary(grouped))
    doc = "Write the measured signals into y."
    first = _modes_first(lines, vectors)
    return kernel_text("outputs", "t, x, u, p, y", doc, vectors, lines, first)


def output_jacobian_text(
    equations: Equations, grouped: Equations, solve: dynamics.Solve, vectors: Vectors
) -> str:
    """Text of `output_jacobian`: by the chain rule through accelerations where outputs have any."""
    accelerated = any(e.has(*solve.accelerations) for _, _, e in equations.outputs)
    outputs, slopes = [], []
    for letter, symbols in variables(equations):
        for j, variable in enumerate(symbols if letter != "u" else ()):
            named = [slope_symbol(a, variable) for a in solve.accelerations]
            if accelerated:
                values = dynamics.acceleration_derivative(grouped, solve, variable)
                slopes += [(str(name), value) for name, value in zip(named, values, strict=True)]
            for i, (_, _, expression) in enumerate(equations.outputs):
                value = (
                    dynamics.derivative_of(grouped, solve, expression, variable, named)
                    if accelerated
                    else derivative(equations.written_out(expression), variable)
                )
                outputs.append((f"y{letter}[{i}, {j}]", value))
    doc = "Write the non-zero derivatives of outputs by state and parameter."
    definitions = (*solve.definitions, *solve.chain.lines, *slopes) if accelerated else ()
    lines = shared_lines(grouped if accelerated else equations, definitions, outputs)
    first = _modes_first(lines, vectors)
    return kernel_text("output_jacobian", "t, x, u, p, yx, yp", doc, vectors, lines, first)


def _modes_first(lines: Sequence[Line], vectors: Vectors) -> tuple[str, ...]:
    """Statements that find the modes of the state, where `lines` depend on any."""
    return IMPLIED_MODES if used_names(lines) & set(vectors.m) else ()


def energy_text(equations: Equations, vectors: Vectors) -> str:
    """Text of `energy`."""
    ledger = equations.ledger
    outputs = [("e[0]", ledger.stored), ("e[1]", ledger.power_in), ("e[2]", ledger.dissipated)]
    doc = "Write stored energy in J, power in and dissipated power in W into e."
    terms = [(str(symbol), term) for symbol, term in equations.terms]
    lines = share(terms, outputs, vocabulary(equations))
    return kernel_text("energy", f"{MODE_ARGUMENTS}, e", doc, vectors, lines)


def domain_text(equations: Equations, vectors: Vectors) -> str:
    """Text of `domain`."""
    outputs = [
        (f"bounds[{k}, {side}]", bound)
        for k, own in enumerate(equations.limits)
        for side, bound in enumerate((own.lower, own.upper))
    ]
    doc = "Write lower and upper bound of the state of every row of DOMAIN into bounds."
    return kernel_text(
        "domain", "p, bounds", doc, vectors, share((), outputs, vocabulary(equations))
    )


def sampler_texts(equations: Equations, vectors: Vectors) -> list[str]:
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
        kernel_text("sample", f"{MODE_ARGUMENTS}, z", doc, vectors, lines),
        kernel_text("sample_jacobian", arguments, by, vectors, derived),
    ]


def margins_text(equations: Equations, vectors: Vectors) -> str:
    """Text of `margins`."""
    outputs = [
        (f"margin[{k}]", own.holds.gts - own.holds.lts)
        for k, own in enumerate(equations.requirements)
    ]
    doc = "Write by how much the parameters meet every row of REQUIREMENTS into margin."
    return kernel_text(
        "margins", "p, margin", doc, vectors, share((), outputs, vocabulary(equations))
    )
