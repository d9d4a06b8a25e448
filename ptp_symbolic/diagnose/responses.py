"""Near the floor: candidates ranked by what a finite amount of each would gain.

There the declared parameters have bent as far as they can to stand in for what is missing, and an
effect that acts through breakaways or bounces has no usable derivative: its response to its finite
start, the declared parameters following, tells more than any search from that start.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.optimize import lsq_linear

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.trial import (
    Task,
    Trial,
    fixed_values,
    moved,
    restarted,
    simulated,
    squares,
)
from ptp_symbolic.identify.coordinates import FreeParameter, limits, to_search
from ptp_symbolic.identify.fit import Fit, all_values, all_values_at_start
from ptp_symbolic.identify.intervals import project_out

FloatArray = NDArray[np.float64]

AMOUNT = 0.02  # of a parameter that is free or declared already
SHARE = 0.1  # of the scale of a parameter that begins at zero, less where that changes
REACH, SHRINKS = 3.0, 6  # more than so many times the residual; a tenth each time
DAMPING, FARTHEST, LEAST, MOST = 1e-3, 0.5, 0.05, 5.0


@dataclass(frozen=True, eq=False)
class _Response:
    """A candidate at one start: what makes the residual least, and the sum of squares left.

    `amounts` are that of the whole start, under "", and values of its parameters that begin at
    zero; `shift` moves the declared parameters.
    """

    base: Trial
    candidate: Candidate
    start: tuple[FreeParameter, ...]
    amounts: Mapping[str, float]
    shift: FloatArray
    left: float


def most_promising(
    task: Task, bases: Sequence[Trial], candidates: Sequence[Candidate], count: int
) -> tuple[list[Trial], list[Trial]]:
    """The `count` best candidates as trials, each begun where its response promises most, and the
    others begun likewise.
    """
    best: dict[tuple[str, ...], _Response] = {}
    for base in bases:
        for response in _responses(task, base, candidates):
            key = tuple(sorted((*base.keys, response.candidate.key)))
            if key not in best or response.left < best[key].left:
                best[key] = response
    ordered = sorted(best.values(), key=lambda response: response.left)
    tried = [_begun(task, response) for response in ordered]
    begun = [trial for trial in tried if np.isfinite(trial.train.cost)]
    return begun[:count], begun[count:]


def _responses(task: Task, base: Trial, candidates: Sequence[Candidate]) -> list[_Response]:
    """The response of `base` to every start of every candidate that it does not have."""
    fit, free = base.train, restarted(base.train)
    phi, residual = to_search(free, fit.values), [e.residual for e in fit.evaluations]
    steps = np.where(phi + AMOUNT <= limits(free)[1], AMOUNT, -AMOUNT)
    columns = [
        _change(task, base, residual, all_values(free, phi + step)) for step in np.diag(steps)
    ]
    here = _projected(base, residual)
    seen = np.array([c is not None for c in columns], dtype=np.bool_)
    known = np.zeros((len(here), 0))
    for step, column in zip(steps, columns, strict=True):
        if column is not None:
            known = np.column_stack([known, column / step])
    found = []
    for candidate in candidates:
        for start in candidate.starts if candidate.key not in base.keys else ():
            changes = _changes(task, base, residual, candidate, start)
            columns_of = [column for _, column in changes.values()]
            if not any(map(np.any, columns_of)):
                continue
            added = np.column_stack([known, *columns_of])
            most = np.repeat([FARTHEST, MOST], [known.shape[1], len(changes)])
            x, left = _least(here, added, most)
            shift = np.zeros(len(free))
            shift[seen] = x[: known.shape[1]]
            sizes = zip(changes.items(), x[known.shape[1] :], strict=True)
            amounts = {name: float(amount * step) for (name, (step, _)), amount in sizes}
            found.append(_Response(base, candidate, start, amounts, shift, left))
    return found


def _changes(
    task: Task,
    base: Trial,
    residual: Sequence[FloatArray],
    candidate: Candidate,
    start: Sequence[FreeParameter],
) -> dict[str, tuple[float, FloatArray]]:
    """What `start` changes as a whole (name "", step 1), and per parameter that begins at zero a
    step and what it adds to that; empty where the whole cannot be simulated.
    """
    given = all_values_at_start(start)
    if candidate.is_declared_value:
        given = {f.name: min(f.start * (1.0 + AMOUNT), f.upper) for f in start}
    whole = _change(task, base, residual, given)
    if whole is None:
        return {}
    changes = {"": (1.0, whole)}
    most = REACH * float(np.sqrt(base.train.cost))
    for f in start:
        step = SHARE * f.scale
        for _ in range(SHRINKS if f.start == 0.0 else 0):
            more = _change(task, base, residual, {**given, f.name: step})
            if more is not None and np.linalg.norm(more - whole) <= most:
                changes[f.name] = step, more - whole
                break
            step *= 0.1
    return {name: change for name, change in changes.items() if not name or np.any(change[1])}


def _change(
    task: Task, base: Trial, residual: Sequence[FloatArray], values: Mapping[str, float]
) -> FloatArray | None:
    """How the residual of all runs changes with `values`, the starts following; None: it failed."""
    changed = simulated(task, base.train, values)
    if any(e.failed for e in changed):
        return None
    return _projected(base, [e.residual - r for e, r in zip(changed, residual, strict=True)])


def _projected(base: Trial, columns: Sequence[FloatArray]) -> FloatArray:
    """One column over all runs, without what the unknown starts can explain."""
    parts = zip(columns, base.train.evaluations, strict=True)
    return np.concatenate([project_out(c[:, None], e.by_start)[:, 0] for c, e in parts])


def _least(residual: FloatArray, columns: FloatArray, most: FloatArray) -> tuple[FloatArray, float]:
    """Amounts [n] of `columns`, at most `most` either way, that make the residual least, and the
    sum of squares left.
    """
    information, gradient = columns.T @ columns, columns.T @ residual
    damped = information + DAMPING * np.diag(np.diag(information) + 1e-12)
    factor = np.linalg.cholesky(damped)
    target = -solve_triangular(factor, gradient, lower=True)
    x = np.asarray(lsq_linear(factor.T, target, (-most, most)).x, dtype=np.float64)
    return x, float(residual @ residual + 2.0 * gradient @ x + x @ information @ x)


def _begun(task: Task, response: _Response) -> Trial:
    """The trial at the amounts of `response`: what switches the effect on grows, the rest stays."""
    base = response.base
    begun = moved(base.train, response.shift)
    vanishes = {p.name: p.vanishes for p in task.model.parameters}
    whole = response.amounts[""]
    for f in response.start:
        zero = f.start if response.candidate.is_declared_value else vanishes[f.name]
        if response.candidate.is_declared_value:
            start = f.start * (1.0 + AMOUNT * whole)
        elif f.name in response.amounts:
            start = response.amounts[f.name]
        elif zero is None or f.start == zero:
            start = f.start
        else:
            least = LEAST if f.logarithmic else -MOST
            start = zero + max(whole, least) * (f.start - zero)
        begun.append(replace(f, start=float(np.clip(start, f.lower, f.upper))))
    fixed = fixed_values(task, begun)
    return Trial((*base.candidates, response.candidate), _unfitted(task, base, begun, fixed))


def _unfitted(
    task: Task, base: Trial, free: Sequence[FreeParameter], fixed: Mapping[str, float]
) -> Fit:
    """The residuals at the starts of `free`."""
    values = {**fixed, **all_values_at_start(free)}
    evaluations = tuple(simulated(task, base.train, values))
    failed = next((e.failed for e in evaluations if e.failed), None)
    z, cost = base.train.z, squares(evaluations)
    return Fit(task.model, task.train, tuple(free), values, z, cost, evaluations, failed)
