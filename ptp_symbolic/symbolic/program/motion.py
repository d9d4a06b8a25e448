"""Kernels of the motion: rates, Jacobians, guards of modes, impacts, what a motion lacks."""

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program import dynamics
from ptp_symbolic.symbolic.program.impacts import impact_expressions
from ptp_symbolic.symbolic.program.kernel import (
    MODE_ARGUMENTS,
    Kernel,
    Vectors,
    kernel,
    shared_lines,
    used_names,
    variables,
)
from ptp_symbolic.symbolic.program.sharing import Line, share
from ptp_symbolic.symbolic.program.term_names import vocabulary
from ptp_symbolic.symbolic.symbols import real


def mode_derivative_kernel(lines: Sequence[Line], vectors: Vectors) -> Kernel:
    """Kernel `mode_derivative`, which `lines` compute."""
    doc = "Write the time derivative of the state into dx in the modes m."
    return kernel("mode_derivative", f"{MODE_ARGUMENTS}, dx", doc, vectors, lines)


def prepare_kernel(once: Sequence[Line], vectors: Vectors) -> Kernel:
    """Kernel `prepare`: the lines that are done `once` per parameter set."""
    entry = {name: f"c[{k}]" for k, name in enumerate(vectors.c)}
    inner = used_names(once)
    lines = [(name if name in inner else entry[name], e) for name, e in once]
    lines += [(target, real(name)) for name, target in entry.items() if name in inner]
    doc = "Write into c what prepared_derivative takes from the parameters alone."
    return kernel("prepare", "p, c", doc, vectors, lines)


def prepared_derivative_kernel(each: Sequence[Line], vectors: Vectors) -> Kernel:
    """Kernel `prepared_derivative`: the lines of `each` call."""
    doc = "Write the time derivative of the state into dx in the modes m, c being prepared."
    return kernel("prepared_derivative", f"{MODE_ARGUMENTS}, c, dx", doc, vectors, each)


def linearize_kernel(
    equations: Equations, solve: dynamics.Solve, guards: Sequence[sp.Expr], vectors: Vectors
) -> Kernel:
    """Kernel `linearize`: derivatives of the vector field, then of the guards."""
    slopes = _slopes(equations, solve)
    outputs: list[Line] = []
    extra = {s.symbol: s.derivative for s in equations.extra_states}
    for letter, symbols in variables(equations):
        for j, variable in enumerate(symbols):
            rows = dict(zip(equations.rates, slopes.by[variable], strict=True))
            rows.update({s: solve.chain.derivative(e, variable) for s, e in extra.items()})
            rate_of = zip(equations.coordinates, equations.rates, strict=True)
            rows.update({q: sp.Integer(int(w == variable)) for q, w in rate_of})
            for i, state in enumerate(equations.state_symbols):
                outputs.append((f"f{letter}[{i}, {j}]", rows[state]))
    outputs += _derivatives(equations, solve, slopes, "g", guards)
    doc = "Write the non-zero derivatives of dx into fx, fu, fp and those of guards into gx, gp."
    lines = shared_lines(equations, (*solve.definitions, *slopes.lines), outputs)
    arguments = f"{MODE_ARGUMENTS}, fx, fu, fp, gx, gp"
    return replace(kernel("linearize", arguments, doc, vectors, lines), optional=("fp", "gx"))


def guards_kernel(
    equations: Equations, solve: dynamics.Solve, guards: Sequence[sp.Expr], vectors: Vectors
) -> Kernel:
    """Kernel `guards`."""
    outputs = [(f"g[{i}]", e) for i, e in enumerate(guards)]
    doc = "Write holding and breakaway torques, gap separations and contact torques into g."
    lines = share(solve.definitions, outputs, vocabulary(equations)) if outputs else []
    return kernel("guards", f"{MODE_ARGUMENTS}, g", doc, vectors, lines)


def impact_kernels(equations: Equations, solve: dynamics.Solve, vectors: Vectors) -> list[Kernel]:
    """Two kernels where rigid bodies strike each other, none elsewhere."""
    if not any(contact.rigid for contact in equations.contacts):
        return []
    expressions = impact_expressions(equations, solve)
    slopes = _slopes(equations, solve)
    definitions = (*solve.definitions, *slopes.lines)
    outputs = [(f"strike[{i}]", e) for i, e in enumerate(expressions)]
    doc = "Write what a strike changes in the state, restitution and energy, per contact."
    lines = shared_lines(equations, definitions, outputs)
    first = kernel("impacts", f"{MODE_ARGUMENTS}, strike", doc, vectors, lines)
    outputs = _derivatives(equations, solve, slopes, "strike", expressions)
    doc = "Write the non-zero derivatives of impacts by state and parameter."
    lines = shared_lines(equations, definitions, outputs)
    arguments = f"{MODE_ARGUMENTS}, strikex, strikep"
    return [first, kernel("impact_jacobian", arguments, doc, vectors, lines)]


def equation_error_kernel(equations: Equations, solve: dynamics.Solve, vectors: Vectors) -> Kernel:
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
    return kernel("equation_error", f"{MODE_ARGUMENTS}, r", doc, extended, lines)


def _slopes(equations: Equations, solve: dynamics.Solve) -> dynamics.Slopes:
    """Derivatives of the accelerations by state, input and parameter."""
    every = [symbol for _, symbols in variables(equations) for symbol in symbols]
    return dynamics.acceleration_slopes(equations, solve, every)


def _derivatives(
    equations: Equations,
    solve: dynamics.Solve,
    slopes: dynamics.Slopes,
    word: str,
    expressions: Sequence[sp.Expr],
) -> list[Line]:
    """Derivatives of `expressions` by state and parameter, into the arrays `word`x and `word`p."""
    return [
        (
            f"{word}{letter}[{i}, {j}]",
            dynamics.derivative_of(solve, slopes, expression, variable),
        )
        for letter, symbols in variables(equations)
        if letter != "u"
        for j, variable in enumerate(symbols)
        for i, expression in enumerate(expressions)
    ]
