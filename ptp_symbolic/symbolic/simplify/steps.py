"""Simplify rigid equations in named steps, each counted and each checked against the one before."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics.bodies import RigidEquations
from ptp_symbolic.symbolic.simplify.base_parameters import BaseForm, base_form
from ptp_symbolic.symbolic.simplify.operations import (
    Line,
    operation_count,
    share_subexpressions,
    written_operations,
)
from ptp_symbolic.symbolic.simplify.reduction import factor_entry, reduce_trigonometry
from ptp_symbolic.symbolic.simplify.solve import accelerations

STATES = 500

AS_DERIVED = "the entries of mass matrix and forcing as the derivation leaves them, multiplied out"
BASE_PARAMETERS = "parameters regrouped in the fewest combinations, functions of the state nested"
SHARING = "what appears twice computed once, jointly over mass matrix, forcing and accelerations"
EntryStep = tuple[str, str, Callable[[sp.Expr, set[sp.Symbol]], sp.Expr]]
ENTRY_STEPS: tuple[EntryStep, ...] = (
    (
        "trigonometric reduction",
        "sin^2 + cos^2 = 1 in every entry, wherever it leaves fewer terms",
        lambda entry, state: reduce_trigonometry(entry),
    ),
    (
        "factor element by element",
        "what multiplies the same function of the state collected, common factors pulled out",
        factor_entry,
    ),
)


@dataclass(frozen=True)
class Step:
    """A step of the simplification, with the operations of the accelerations around it.

    The counts are those of the written lines; `shared_operations` is what the result would need
    with common subexpressions shared. `proved` says that the result equals the one before
    symbolically, `worst_difference` how far it is from it at random states and parameters,
    relative.
    """

    name: str
    explanation: str
    operations_before: int
    operations_after: int
    shared_operations: int
    proved: bool
    worst_difference: float


@dataclass(frozen=True)
class SimplifiedEquations:
    """The result of all steps: base form, and lines that compute the accelerations [n].

    `lines` are in order of use; they and `accelerations` (rad/s^2) are in base parameters.
    """

    base_form: BaseForm
    lines: tuple[Line, ...]
    accelerations: tuple[sp.Expr, ...]
    steps: tuple[Step, ...]


@dataclass(frozen=True)
class _Stage:
    """Mass matrix and forcing of the joints in the course of simplification."""

    mass_matrix: sp.ImmutableMatrix
    forcing: sp.ImmutableMatrix
    shared_terms: tuple[Line, ...] = ()

    def solved(self, additions: sp.ImmutableMatrix) -> tuple[list[Line], list[sp.Expr]]:
        """Lines and accelerations, with the torques of the machine added to the forcing."""
        lines, outputs = accelerations(self.mass_matrix, self.forcing + additions)
        return [*self.shared_terms, *lines], outputs

    def counts(self, additions: sp.ImmutableMatrix) -> tuple[int, int]:
        """Operations as written, and with common subexpressions shared."""
        lines, outputs = self.solved(additions)
        written = sum(written_operations(e) for e in (*(e for _, e in lines), *outputs))
        return written, operation_count(outputs, lines)

    def entries(self) -> list[sp.Expr]:
        return [*self.mass_matrix, *self.forcing]


def simplify_rigid(
    rigid: RigidEquations,
    mass_matrix: sp.MatrixBase | None = None,
    forcing: sp.MatrixBase | None = None,
) -> SimplifiedEquations:
    """Simplify the joint rows of M q'' = f in named steps.

    `mass_matrix` and `forcing` are those of the whole machine as for `base_form`; the torques that
    it adds to `rigid` are counted but left alone. Raises ArithmeticError when a step changes the
    equations, which would be an error in this program.
    """
    n = len(rigid.coordinates)
    mass = sp.ImmutableMatrix(rigid.mass_matrix if mass_matrix is None else mass_matrix)
    total = sp.ImmutableMatrix(rigid.forcing if forcing is None else forcing)
    additions = sp.ImmutableMatrix(total[:n, :]) - rigid.forcing
    state = {*rigid.coordinates, *rigid.rates}
    stage = _Stage(sp.ImmutableMatrix(mass[:n, :n]), rigid.forcing)
    written, shared = stage.counts(additions)
    steps = [Step("as derived", AS_DERIVED, written, written, shared, True, 0.0)]
    for name, explanation, shorten in ENTRY_STEPS:
        after = _Stage(
            stage.mass_matrix.applyfunc(lambda entry, shorten=shorten: shorten(entry, state)),
            stage.forcing.applyfunc(lambda entry, shorten=shorten: shorten(entry, state)),
        )
        steps.append(_step(name, explanation, stage, after, after, additions))
        stage = after
    base = base_form(rigid, mass, total)
    final = _joint_rows(base.mass_matrix, base.forcing, additions, base.shared_terms)
    physical = _joint_rows(*base.physical(), additions)
    written_out = _joint_rows(*base.expanded(), additions)
    steps.append(_step("base parameters", BASE_PARAMETERS, stage, written_out, physical, additions))
    plain, accelerated = final.solved(additions)
    lines, outputs = share_subexpressions(accelerated, plain)
    steps.append(_sharing_step(written_out, additions, lines, outputs))
    return SimplifiedEquations(base, tuple(lines), tuple(outputs), tuple(steps))


def _joint_rows(
    mass_matrix: sp.MatrixBase,
    forcing: sp.MatrixBase,
    additions: sp.ImmutableMatrix,
    shared_terms: tuple[Line, ...] = (),
) -> _Stage:
    n = additions.rows
    rows = sp.ImmutableMatrix(forcing[:n, :]) - additions
    return _Stage(sp.ImmutableMatrix(mass_matrix[:n, :n]), rows, shared_terms)


def _step(
    name: str,
    explanation: str,
    before: _Stage,
    after: _Stage,
    physical: _Stage,
    additions: sp.ImmutableMatrix,
) -> Step:
    """The step from `before` to `after`, which reads `physical` in the physical parameters."""
    old, new = before.entries(), physical.entries()
    proved = all(normal_form(a - b) == 0 for a, b in zip(old, new, strict=True))
    written, _ = before.counts(additions)
    step = Step(
        name,
        explanation,
        written,
        *after.counts(additions),
        proved,
        _worst_difference(old, new),
    )
    return _require_proof(step)


def _sharing_step(
    stage: _Stage,
    additions: sp.ImmutableMatrix,
    lines: Sequence[Line],
    outputs: Sequence[sp.Expr],
) -> Step:
    """Common subexpressions: put back into each other, the lines give the same expressions."""
    before = _put_together(*stage.solved(additions))
    after = _put_together(lines, outputs)
    proved = all(sp.expand(a - b) == 0 for a, b in zip(before, after, strict=True))
    written, _ = stage.counts(additions)
    shared = sum(written_operations(e) for e in (*(term for _, term in lines), *outputs))
    worst = _worst_difference(before, after)
    return _require_proof(
        Step("common subexpressions", SHARING, written, shared, shared, proved, worst)
    )


def _require_proof(step: Step) -> Step:
    if not step.proved:
        raise ArithmeticError(f"The step '{step.name}' changes the equations.")
    return step


def _put_together(lines: Sequence[Line], outputs: Sequence[sp.Expr]) -> list[sp.Expr]:
    result = list(outputs)
    for symbol, term in reversed(lines):
        result = [expression.xreplace({symbol: term}) for expression in result]
    return result


def _worst_difference(before: Sequence[sp.Expr], after: Sequence[sp.Expr]) -> float:
    """Largest difference at random values of all symbols over the largest entry there."""
    symbols = sorted({s for e in (*before, *after) for s in e.free_symbols}, key=str)
    values = np.random.default_rng(0).uniform(0.1, 2.0, (len(symbols), STATES))
    old, new = (
        np.array(
            [
                np.broadcast_to(value, (STATES,))
                for value in sp.lambdify(symbols, list(entries), modules="numpy", cse=True)(*values)
            ]
        )
        for entries in (before, after)
    )
    scale = np.maximum(np.max(np.abs(old), axis=0), np.finfo(float).tiny)
    return float(np.max(np.abs(old - new) / scale))
