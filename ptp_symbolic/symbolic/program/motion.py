"""Kernels of the motion: rates, Jacobians, guards of modes, impacts, what a motion lacks."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program import dynamics
from ptp_symbolic.symbolic.program.impacts import impact_expressions
from ptp_symbolic.symbolic.program.kernel import (
    GIVEN,
    MODE_ARGUMENTS,
    Kernel,
    Part,
    Vectors,
    kernel,
    needed,
    shared_lines,
    used_names,
    variables,
    with_needed,
)
from ptp_symbolic.symbolic.program.sharing import Line, share
from ptp_symbolic.symbolic.program.term_names import vocabulary
from ptp_symbolic.symbolic.symbols import real

DOCS = {
    "dx": ("mode_derivative", "Write the time derivative of the state into dx in the modes m."),
    "g": (
        "guards",
        "Write holding and breakaway torques, gap separations and contact torques into g.",
    ),
    "e": ("energy", "Write stored energy in J, power in and dissipated power in W into e."),
    "r": (
        "equation_error",
        "Write torques that rows lack, then other states' rates, into r; x ends in accelerations.",
    ),
    "M": ("mass_matrix", "Write the mass matrix of the joints, then of gear outputs, into M."),
    "G": ("gravity_torque", "Write the torques that hold the machine against its weight into G."),
}


@dataclass(frozen=True)
class Motion:
    """The kernels of the motion, and what they have in common: what is `prepared` of the parameters
    alone, and `forces`.
    """

    prepared: Part
    forces: Part
    kernels: tuple[Kernel, ...]


def motion(
    equations: Equations,
    solve: dynamics.Solve,
    guards: Sequence[sp.Expr],
    stored_and_powers: Sequence[sp.Expr],
    vectors: Vectors,
) -> Motion:
    """Vector field, guards, energy, residual, mass matrix and weight, their terms shared: those of
    the parameters alone are `constants`; those that the residual has in common with others,
    `mass_and_forces`.
    """
    given = [real(f"{GIVEN}{acceleration}") for acceleration in solve.accelerations]
    written = {
        "dx": dynamics.state_rates(equations, solve),
        "g": guards,
        "r": _residual(equations, solve, given),
        "e": stored_and_powers,
        "G": dynamics.gravity_torques(equations),
    }
    outputs = [(f"{array}[{i}]", e) for array, own in written.items() for i, e in enumerate(own)]
    n = solve.mass.rows
    outputs += [(f"M[{i}, {j}]", solve.mass[i, j]) for i in range(n) for j in range(n)]
    lines = share(solve.definitions, outputs, vocabulary(equations))
    prepared, forces, own = _divided(lines, vectors)
    extended = replace(prepared.vectors, x=(*vectors.x, *map(str, given)))
    kernels = {
        array: Kernel(
            name,
            (*MODE_ARGUMENTS.split(", "), array),
            doc,
            extended if array == "r" else prepared.vectors,
            own[array],
            parts=(prepared, forces),
        )
        for array, (name, doc) in DOCS.items()
    }
    first = (_prepare_kernel(prepared), _prepared_derivative(kernels["dx"], forces))
    return Motion(prepared, forces, (*first, *kernels.values()))


def _divided(
    lines: Sequence[Line], vectors: Vectors
) -> tuple[Part, Part, dict[str, tuple[Line, ...]]]:
    """The parts `constants` and `mass_and_forces` of `lines`, and the other lines, by array."""
    once, each = dynamics.prepared(lines, vectors.p)
    entries = {a: [line for line in each if line[0].startswith(f"{a}[")] for a in DOCS}
    needs = {a: {name for name, _ in needed(each, own)} for a, own in entries.items()}
    common = needs["r"] & (needs["dx"] | needs["g"] | needs["e"])
    block = tuple(line for line in each if line[0] in common)
    others = [line for line in each if line[0] not in common]
    own = {a: tuple(with_needed(others, lines)) for a, lines in entries.items()}
    used = used_names([line for rest in own.values() for line in rest])
    results = tuple(name for name, _ in block if name in used)
    used |= used_names(block)
    vectors = replace(vectors, c=tuple(name for name, _ in once if name in used))
    doc = "Return what depends on the parameters alone."
    prepared = Part("constants", ("p",), doc, vectors, tuple(once), vectors.c)
    doc = "Return mass matrix, forces and what else the functions below have in common."
    return prepared, Part("mass_and_forces", tuple("txupmc"), doc, vectors, block, results), own


def _residual(
    equations: Equations, solve: dynamics.Solve, given: Sequence[sp.Symbol]
) -> list[sp.Expr]:
    """What a measured motion leaves of the equations of motion: M a - forcing + sliding friction,
    with the `given` accelerations, then the rates of the other states.
    """
    moving = {s.symbol: s.derivative for s in equations.extra_states}
    others = [moving[s] for s in equations.state_symbols if s in moving]
    return [*(solve.mass * sp.Matrix(given) - solve.force), *others]


def _prepare_kernel(prepared: Part) -> Kernel:
    """Kernel `prepare`, which writes what is prepared into c."""
    once = prepared.lines
    entry = {name: f"c[{k}]" for k, name in enumerate(prepared.results)}
    inner = used_names(once)
    lines = [(name if name in inner else entry[name], e) for name, e in once]
    lines += [(target, real(name)) for name, target in entry.items() if name in inner]
    doc = "Write into c what prepared_derivative takes from the parameters alone."
    return kernel("prepare", "p, c", doc, prepared.vectors, lines)


def _prepared_derivative(whole: Kernel, forces: Part) -> Kernel:
    """Kernel `prepared_derivative`: `whole`, with what is prepared as an argument."""
    doc = "Write the time derivative of the state into dx in the modes m, c being prepared."
    arguments = (*MODE_ARGUMENTS.split(", "), "c", "dx")
    return Kernel("prepared_derivative", arguments, doc, whole.vectors, whole.own, parts=(forces,))


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
