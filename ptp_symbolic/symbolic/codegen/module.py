"""Write a model as a self-contained numba module."""

import hashlib
from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from ptp_symbolic.symbolic.codegen import dynamics
from ptp_symbolic.symbolic.codegen.docstring import docstring
from ptp_symbolic.symbolic.codegen.grouped import in_base_parameters
from ptp_symbolic.symbolic.codegen.kernel import Vectors
from ptp_symbolic.symbolic.codegen.kernel_lines import used_names
from ptp_symbolic.symbolic.codegen.metadata import metadata_text
from ptp_symbolic.symbolic.codegen.mode_functions import mode_functions_text
from ptp_symbolic.symbolic.codegen.motion_kernels import (
    equation_error_text,
    guard_jacobian_text,
    guards_text,
    impact_texts,
    jacobian_text,
    mode_derivative_text,
    prepare_text,
    prepared_derivative_text,
)
from ptp_symbolic.symbolic.codegen.sharing import Line, share
from ptp_symbolic.symbolic.codegen.signal_kernels import (
    domain_text,
    energy_text,
    margins_text,
    output_jacobian_text,
    outputs_text,
    sampler_texts,
)
from ptp_symbolic.symbolic.codegen.term_names import vocabulary
from ptp_symbolic.symbolic.derivation.equations import Equations

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
    vectors = replace(vectors, c=tuple(name for name, _ in once if name in used_names(each)))
    body = "\n\n\n".join(
        [
            mode_derivative_text(rates, vectors),
            prepare_text(once, vectors),
            prepared_derivative_text(each, vectors),
            jacobian_text(grouped, solve, vectors),
            guards_text(grouped, solve, guards, vectors),
            guard_jacobian_text(grouped, solve, guards, vectors),
            *impact_texts(grouped, solve, vectors),
            outputs_text(grouped, solve, vectors),
            output_jacobian_text(equations, grouped, solve, vectors),
            energy_text(equations, vectors),
            equation_error_text(grouped, solve, vectors),
            domain_text(equations, vectors),
            margins_text(equations, vectors),
            *sampler_texts(equations, vectors),
            mode_functions_text(bool(vectors.m), any(c.rigid for c in equations.contacts)),
        ]
    )
    digest = hashlib.sha256(body.encode()).hexdigest()[:16]
    operations = _operations(equations, rates, each)
    opening = docstring(grouped, operations)
    return sealed(f"{metadata_text(equations, digest, opening, len(vectors.c))}\n\n\n{body}\n")


def _rows(equations: Equations, guards: int) -> dict[str, tuple[str, str]]:
    """Shape of the arrays that kernels write, and their units."""
    states, contacts = len(equations.state_symbols), len(equations.contacts)
    rates = "STATE_UNITS per s"
    further = len(equations.extra_states)
    samples = 3 * len(equations.samplers) + len(equations.updates)
    return {
        "dx": (f"{states}", rates),
        "f": (f"{states}", rates),
        "g": (f"{guards}", equations.unit("N m and rad")),
        "strike": (f"{contacts * (states + 2)}", "STATE_UNITS, 1 and J"),
        "y": (f"{len(equations.outputs)}", "OUTPUT_UNITS"),
        "e": ("3", "J, W and W"),
        "r": (f"{len(equations.rates) + further}", f"{equations.unit('N m')}, then {rates}"),
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


def _state_lines(equations: Equations, solve: dynamics.Solve) -> list[Line]:
    rates = dynamics.state_rates(equations, solve)
    outputs = [(f"dx[{i}]", rate) for i, rate in enumerate(rates)]
    return share(solve.definitions, outputs, vocabulary(equations))
