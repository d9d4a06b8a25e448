"""Write a model as a self-contained numba module."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from ptp_symbolic.symbolic.codegen import dynamics
from ptp_symbolic.symbolic.codegen.grouped import in_base_parameters
from ptp_symbolic.symbolic.codegen.impacts import impact_expressions
from ptp_symbolic.symbolic.codegen.kernel import MODE_ARGUMENTS, Vectors, kernel_text
from ptp_symbolic.symbolic.codegen.metadata import metadata_text
from ptp_symbolic.symbolic.codegen.mode_functions import mode_functions_text
from ptp_symbolic.symbolic.codegen.sharing import Line, share
from ptp_symbolic.symbolic.codegen.term_names import vocabulary
from ptp_symbolic.symbolic.derivation.differentiation import derivative
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.symbols import real

SEAL = "# END sha256 "


def module_text(equations: Equations) -> str:
    """Return the source of the module that computes `equations`.

    The text depends on the mathematics alone: the same bytes on every machine. It ends with the
    SHA-256 of everything above, which the loader verifies.
    """
    grouped = in_base_parameters(equations)
    solve = dynamics.solve_accelerations(grouped)
    rates, guards = _state_lines(grouped, solve), dynamics.guard_expressions(grouped, solve)
    vectors = Vectors(
        tuple(map(str, equations.state_symbols)),
        tuple(i.name for i in equations.inputs),
        tuple(p.name for p in equations.parameters),
        tuple(map(str, equations.mode_symbols)),
        (),
        _rows(equations, len(guards)),
    )
    once, each = dynamics.prepared(rates, vectors.p)
    vectors = replace(vectors, c=tuple(name for name, _ in once if name in _used(each)))
    body = "\n\n\n".join(
        [
            _mode_derivative(rates, vectors),
            _prepare(once, vectors),
            _prepared_derivative(each, vectors),
            _jacobian(grouped, solve, vectors),
            _guards(grouped, solve, guards, vectors),
            _guard_jacobian(grouped, solve, guards, vectors),
            *_impacts(grouped, solve, vectors),
            _outputs(equations, vectors),
            _output_jacobian(equations, vectors),
            _energy(equations, vectors),
            _equation_error(grouped, solve, vectors),
            _domain(equations, vectors),
            _margins(equations, vectors),
            *_samplers(equations, vectors),
            mode_functions_text(bool(vectors.m), any(c.rigid for c in equations.contacts)),
        ]
    )
    digest = hashlib.sha256(body.encode()).hexdigest()[:16]
    operations = _operations(equations, rates, each)
    return sealed(f"{metadata_text(equations, digest, operations, len(vectors.c))}\n\n\n{body}\n")


def _rows(equations: Equations, guards: int) -> dict[str, tuple[str, str]]:
    """Shape of the arrays that kernels write, and their units."""
    states, contacts = len(equations.state_symbols), len(equations.contacts)
    rates = "STATE_UNITS per s"
    further = len(equations.extra_states)
    samples = 3 * len(equations.samplers) + len(equations.updates)
    return {
        "dx": (f"{states}", rates),
        "f": (f"{states}", rates),
        "g": (f"{guards}", "N m and rad"),
        "strike": (f"{contacts * (states + 2)}", "STATE_UNITS, 1 and J"),
        "y": (f"{len(equations.outputs)}", "OUTPUT_UNITS"),
        "e": ("3", "J, W and W"),
        "r": (f"{len(equations.rates) + further}", f"N m, then {rates}"),
        "z": (f"{samples}", "s, s and 1 per sampler, then STATE_UNITS"),
        "bounds": (f"{len(equations.limits)}, 2", "STATE_UNITS: lower, upper"),
        "margin": (f"{len(equations.requirements)}", "units of what is compared"),
    }


def sealed(text: str) -> str:
    """`text` with its SHA-256 as the last line, in place of an earlier one."""
    text = text.partition(SEAL)[0]
    return f"{text}{SEAL}{hashlib.sha256(text.encode()).hexdigest()}\n"


def _operations(
    equations: Equations, lines: Sequence[Line], each: Sequence[Line]
) -> tuple[int, int, int]:
    """Operations of the state derivative as derived, as written with shared terms, and of `each`
    call where the others are done once.
    """
    derived = [e for _, e in dynamics.solve_accelerations(equations).definitions]
    derived += [state.derivative for state in equations.extra_states]
    before, written, left = (
        sum(int(sp.count_ops(e)) for e in es)
        for es in (derived, (e for _, e in lines), (e for _, e in each))
    )
    return before, written, left


def _used(lines: Sequence[Line]) -> set[str]:
    return {str(symbol) for _, expression in lines for symbol in expression.free_symbols}


def _shared(
    equations: Equations, definitions: Sequence[Line], outputs: Sequence[Line]
) -> list[Line]:
    present = [(t, e) for t, e in outputs if e != 0]
    return share(definitions, present, vocabulary(equations))


def _mode_derivative(lines: Sequence[Line], vectors: Vectors) -> str:
    doc = "Write the time derivative of the state into dx in the modes m."
    return kernel_text("mode_derivative", f"{MODE_ARGUMENTS}, dx", doc, vectors, lines)


def _prepare(once: Sequence[Line], vectors: Vectors) -> str:
    entry = {name: f"c[{k}]" for k, name in enumerate(vectors.c)}
    inner = _used(once)
    lines = [(name if name in inner else entry[name], e) for name, e in once]
    lines += [(target, real(name)) for name, target in entry.items() if name in inner]
    doc = "Write into c what prepared_derivative takes from the parameters alone."
    return kernel_text("prepare", "p, c", doc, vectors, lines)


def _prepared_derivative(each: Sequence[Line], vectors: Vectors) -> str:
    doc = "Write the time derivative of the state into dx in the modes m, c being prepared."
    return kernel_text("prepared_derivative", f"{MODE_ARGUMENTS}, c, dx", doc, vectors, each)


def _state_lines(equations: Equations, solve: dynamics.Solve) -> list[Line]:
    rates = dynamics.state_rates(equations, solve)
    outputs = [(f"dx[{i}]", rate) for i, rate in enumerate(rates)]
    return share(solve.definitions, outputs, vocabulary(equations))


def _columns(
    equations: Equations,
) -> list[tuple[str, tuple[sp.Symbol, ...]]]:
    parameters = tuple(p.symbol for p in equations.parameters)
    inputs = tuple(i.symbol for i in equations.inputs)
    return [("x", equations.state_symbols), ("u", inputs), ("p", parameters)]


def _jacobian(equations: Equations, solve: dynamics.Solve, vectors: Vectors) -> str:
    outputs: list[Line] = []
    extra = {s.symbol: s.derivative for s in equations.extra_states}
    for letter, symbols in _columns(equations):
        for j, variable in enumerate(symbols):
            by = dynamics.acceleration_derivative(equations, solve, variable)
            rows = dict(zip(equations.rates, by, strict=True))
            rows.update({s: solve.chain.derivative(e, variable) for s, e in extra.items()})
            rate_of = zip(equations.coordinates, equations.rates, strict=True)
            rows.update({q: sp.Integer(int(w == variable)) for q, w in rate_of})
            for i, state in enumerate(equations.state_symbols):
                outputs.append((f"f{letter}[{i}, {j}]", rows[state]))
    doc = "Write the non-zero derivatives of mode_derivative by state, input and parameter."
    lines = _shared(equations, (*solve.definitions, *solve.chain.lines), outputs)
    return kernel_text("jacobian", f"{MODE_ARGUMENTS}, fx, fu, fp", doc, vectors, lines)


def _guards(
    equations: Equations, solve: dynamics.Solve, guards: Sequence[sp.Expr], vectors: Vectors
) -> str:
    outputs = [(f"g[{i}]", e) for i, e in enumerate(guards)]
    doc = "Write holding and breakaway torques, gap separations and contact torques into g."
    lines = share(solve.definitions, outputs, vocabulary(equations)) if outputs else []
    return kernel_text("guards", f"{MODE_ARGUMENTS}, g", doc, vectors, lines)


def _guard_jacobian(
    equations: Equations, solve: dynamics.Solve, guards: Sequence[sp.Expr], vectors: Vectors
) -> str:
    outputs = _derivatives(equations, solve, "g", guards)
    doc = "Write the non-zero derivatives of guards by state and parameter."
    lines = _shared(equations, (*solve.definitions, *solve.chain.lines), outputs)
    return kernel_text("guard_jacobian", f"{MODE_ARGUMENTS}, gx, gp", doc, vectors, lines)


def _derivatives(
    equations: Equations, solve: dynamics.Solve, word: str, expressions: Sequence[sp.Expr]
) -> list[Line]:
    """Derivatives of `expressions` by state and parameter, into the arrays `word`x and `word`p."""
    outputs: list[Line] = []
    for letter, symbols in _columns(equations):
        if letter == "u":
            continue
        for j, variable in enumerate(symbols):
            by = dynamics.acceleration_derivative(equations, solve, variable)
            for i, expression in enumerate(expressions):
                value = dynamics.derivative_of(equations, solve, expression, variable, by)
                outputs.append((f"{word}{letter}[{i}, {j}]", value))
    return outputs


def _impacts(equations: Equations, solve: dynamics.Solve, vectors: Vectors) -> list[str]:
    """Two kernels where rigid bodies strike each other, none elsewhere."""
    if not any(contact.rigid for contact in equations.contacts):
        return []
    expressions = impact_expressions(equations, solve)
    definitions = (*solve.definitions, *solve.chain.lines)
    outputs = [(f"strike[{i}]", e) for i, e in enumerate(expressions)]
    doc = "Write what a strike changes in the state, restitution and energy, per contact."
    lines = _shared(equations, definitions, outputs)
    kernel = kernel_text("impacts", f"{MODE_ARGUMENTS}, strike", doc, vectors, lines)
    outputs = _derivatives(equations, solve, "strike", expressions)
    doc = "Write the non-zero derivatives of impacts by state and parameter."
    lines = _shared(equations, definitions, outputs)
    arguments = f"{MODE_ARGUMENTS}, strikex, strikep"
    return [kernel, kernel_text("impact_jacobian", arguments, doc, vectors, lines)]


def _outputs(equations: Equations, vectors: Vectors) -> str:
    outputs = [(f"y[{i}]", e) for i, (_, _, e) in enumerate(equations.outputs)]
    lines = share((), outputs, vocabulary(equations))
    return kernel_text(
        "outputs", "t, x, u, p, y", "Write the measured signals into y.", vectors, lines
    )


def _output_jacobian(equations: Equations, vectors: Vectors) -> str:
    outputs = [
        (f"y{letter}[{i}, {j}]", derivative(expression, variable))
        for letter, symbols in _columns(equations)
        if letter != "u"
        for j, variable in enumerate(symbols)
        for i, (_, _, expression) in enumerate(equations.outputs)
    ]
    doc = "Write the non-zero derivatives of outputs by state and parameter."
    lines = _shared(equations, (), outputs)
    return kernel_text("output_jacobian", "t, x, u, p, yx, yp", doc, vectors, lines)


def _energy(equations: Equations, vectors: Vectors) -> str:
    ledger = equations.ledger
    outputs = [("e[0]", ledger.stored), ("e[1]", ledger.power_in), ("e[2]", ledger.dissipated)]
    doc = "Write stored energy in J, power in and dissipated power in W into e."
    terms = [(str(symbol), term) for symbol, term in equations.terms]
    lines = share(terms, outputs, vocabulary(equations))
    return kernel_text("energy", f"{MODE_ARGUMENTS}, e", doc, vectors, lines)


def _equation_error(equations: Equations, solve: dynamics.Solve, vectors: Vectors) -> str:
    """What a measured motion leaves of the equations of motion: M a - forcing + sliding friction.

    The accelerations, which follow the states in x, are given and not solved for.
    """
    given = [str(acceleration) for acceleration in solve.accelerations]
    definitions = [(name, e) for name, e in solve.definitions if name not in given]
    torques = solve.mass * sp.Matrix(solve.accelerations) - solve.force
    moving = {s.symbol: s.derivative for s in equations.extra_states}
    others = [moving[s] for s in equations.state_symbols if s in moving]
    outputs = [(f"r[{i}]", e) for i, e in enumerate([*torques, *others])]
    lines = share(definitions, outputs, vocabulary(equations))
    extended = replace(vectors, x=(*vectors.x, *given))
    doc = (
        "Write the torque that every row lacks, then rates of other states into r; x ends in accel."
    )
    return kernel_text("equation_error", f"{MODE_ARGUMENTS}, r", doc, extended, lines)


def _domain(equations: Equations, vectors: Vectors) -> str:
    outputs = [
        (f"bounds[{k}, {side}]", bound)
        for k, own in enumerate(equations.limits)
        for side, bound in enumerate((own.lower, own.upper))
    ]
    doc = "Write lower and upper bound of the state of every row of DOMAIN into bounds."
    return kernel_text(
        "domain", "p, bounds", doc, vectors, share((), outputs, vocabulary(equations))
    )


def _samplers(equations: Equations, vectors: Vectors) -> list[str]:
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
        for letter, symbols in _columns(equations)
        for j, variable in enumerate(symbols)
        for i, value in enumerate(values)
    ]
    derived = _shared(equations, (), slopes)
    by = "Write the non-zero derivatives of sample by state, input and parameter."
    arguments = f"{MODE_ARGUMENTS}, zx, zu, zp"
    return [
        kernel_text("sample", f"{MODE_ARGUMENTS}, z", doc, vectors, lines),
        kernel_text("sample_jacobian", arguments, by, vectors, derived),
    ]


def _margins(equations: Equations, vectors: Vectors) -> str:
    outputs = [
        (f"margin[{k}]", own.holds.gts - own.holds.lts)
        for k, own in enumerate(equations.requirements)
    ]
    doc = "Write by how much the parameters meet every row of REQUIREMENTS into margin."
    return kernel_text(
        "margins", "p, margin", doc, vectors, share((), outputs, vocabulary(equations))
    )
