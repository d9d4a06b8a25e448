"""What a finite amount of a candidate would change in the simulated outputs of a trial.

Breakaways, gaps and delays do not show in the torque along the motion, or have no derivative where
they vanish: their response to a finite amount, the free parameters following, tells what a refit
could gain, and where it should start.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from ptp_symbolic.numeric.diagnose.candidates import Candidate, with_what_it_brings
from ptp_symbolic.numeric.diagnose.linear import stacked, stacked_jacobian, stacked_residual
from ptp_symbolic.numeric.diagnose.proposals import Proposal
from ptp_symbolic.numeric.diagnose.signatures import brought
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, simulated
from ptp_symbolic.numeric.identify.constants import (
    DECLARED_AMOUNT,
    ITERATIONS,
    LARGEST_STEP,
    MOST,
    REACH,
    SAME,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, to_search
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.simulations import all_values

FloatArray = NDArray[np.float64]
# By the parameters that go together, their start, and the values that shape the candidate.
SeenColumns = dict[
    tuple[tuple[str, ...], float, tuple[tuple[str, float], ...]], tuple[float, FloatArray] | None
]


@dataclass(frozen=True, eq=False)
class Columns:
    """Responses `table` [n, k] of a candidate, sigmas per unit of each of its `free` parameters,
    the others at `base` (shaping values, and candidates that it brings along). `limits` are the
    values of parameters that nothing reaches where they vanish, whatever their amounts.
    """

    candidate: Candidate
    free: tuple[FreeParameter, ...]
    table: FloatArray
    base: Mapping[str, float]
    limits: Mapping[str, float]

    def values(self, amounts: FloatArray) -> dict[str, float]:
        """Values of the parameters of the candidate, at `amounts` [k] from where it vanishes."""
        found = dict(self.base)
        for f, amount in zip(self.free, amounts, strict=True):
            value = float(np.clip(self.candidate.vanishing[f.name] + amount, f.lower, f.upper))
            value = self.limits.get(f.name, value)
            found.update(dict.fromkeys(f.names, value))
        return found


@dataclass(frozen=True, eq=False)
class Response:
    """A candidate added to a trial: the share of the squared residual that is predicted to be left,
    where a refit should start, and the values that shape it.
    """

    candidate: Candidate
    left: float
    proposal: Proposal
    shape: Mapping[str, float]


def responses(task: Task, trial: Trial, candidates: Sequence[Candidate]) -> list[Response]:
    """Responses of `candidates` that the trial does not have, the most promising first, each in the
    form that promises most.

    A candidate that needs another brings it along.
    """
    have = set(trial.keys)
    wanted: dict[str, list[Candidate]] = {}
    for c in candidates:
        if c.key not in have:
            wanted.setdefault(c.key, []).append(c)
    at = _Linear(trial.fit)

    def best_form(forms: Sequence[Candidate]) -> Response | None:
        wholes = [with_what_it_brings(trial.candidates, c, task.candidates) for c in forms]
        found = _best_form(task, trial, forms, wholes, lambda: at)
        if found is None:
            return None
        number, shape, left, moved = found
        candidate = forms[number]
        proposal = Proposal(wholes[number], {**trial.values, **moved})
        return Response(candidate, left, proposal, candidate.shapes[shape])

    jobs = task.executor.map(best_form, wanted.values())
    return sorted((r for r in jobs if r is not None), key=lambda r: r.left)


@dataclass(frozen=True, eq=False)
class _Linear:
    """Residual [n] and Jacobian [n, nf] of a fit, projected off the starts of its runs."""

    fit: Fit

    @cached_property
    def residual(self) -> FloatArray:
        return stacked_residual(self.fit)

    @cached_property
    def jacobian(self) -> FloatArray:
        return stacked_jacobian(self.fit)


@recorded()
def _best_form(
    task: Task,
    trial: Trial,
    forms: Sequence[Candidate],
    wholes: Sequence[Sequence[Candidate]],
    linear: Callable[[], _Linear],
) -> tuple[int, int, float, dict[str, float]] | None:
    """The number of the form of a candidate that promises most and of its shape, what is left by
    it, and the values that it changes; `wholes` are the sets that the forms make of the trial's.
    """
    fit, at, seen = trial.fit, linear(), SeenColumns()
    most = REACH * float(np.linalg.norm(at.residual))
    best = None
    for number, candidate in enumerate(forms):
        for place, shape in enumerate(candidate.shapes):
            found = response_columns(task, trial, candidate, shape, most, seen)
            if found is None:
                continue
            amounts, left = least(at.residual, at.jacobian, found)
            if best is not None and left >= best[2]:
                continue
            nf = at.jacobian.shape[1]
            phi = to_search(fit.free, fit.values) + amounts[:nf]
            moved = {**all_values(fit.free, phi), **found.values(amounts[nf:])}
            best = number, place, left, moved
    return best


def response_columns(
    task: Task,
    trial: Trial,
    candidate: Candidate,
    shape: Mapping[str, float],
    most: float,
    seen: SeenColumns | None = None,
) -> Columns | None:
    """Responses of `candidate` at the fit of `trial`, shaped by `shape`, to amounts that change the
    residuals by at most the norm `most`; None where nothing changes or can be simulated. Columns
    that other forms of the candidate have `seen` are not simulated again.
    """
    by_key = {c.key: c for c in reversed(task.candidates)}
    brings = any(key not in trial.keys for key in candidate.brings)
    base = {**(brought(candidate, by_key) if brings else {}), **shape}
    residual = [e.residual for e in trial.fit.evaluations]
    without = residual
    if brings:
        plain = simulated(task, trial.fit, base, None)
        if any(e.failed for e in plain):
            return None
        without = [e.residual for e in plain]
    seen = {} if seen is None else seen
    kept = []
    for f in candidate.defining:
        key = f.names, f.start, tuple(sorted(base.items()))
        if key not in seen:
            seen[key] = _column(task, trial, without, base, f, candidate, most)
        if (column := seen[key]) is not None:
            kept.append((f, *column))
    if not kept:
        return None
    table = np.column_stack([change / amount for _, amount, change in kept])
    limits = {
        f.name: candidate.vanishing[f.name] + amount
        for f, amount, _ in kept
        if candidate.is_limit(f)
    }
    return Columns(candidate, tuple(f for f, _, _ in kept), table, base, limits)


def _column(
    task: Task,
    trial: Trial,
    without: Sequence[FloatArray],
    base: Mapping[str, float],
    f: FreeParameter,
    candidate: Candidate,
    most: float,
) -> tuple[float, FloatArray] | None:
    """An amount of a defining parameter whose response [n] stays below `most`, with a margin where
    the first is too large: an encoder may show a thousandth of what is usual. None where nothing
    can be simulated or nothing changes. A limit comes closer to the largest value that it meets.
    """
    zero = candidate.vanishing[f.name]
    largest = candidate.met_at(f) if candidate.is_limit(f) else 0.0
    amount = f.start - zero
    if candidate.is_declared_value:
        amount = min(DECLARED_AMOUNT * abs(f.start), 0.5 * (f.upper - f.start))
    for _ in range(ITERATIONS):
        values = {**base, **dict.fromkeys(f.names, zero + amount)}
        changed = simulated(task, trial.fit, values, None)
        if not any(e.failed for e in changed):
            differences = [(e.residual - r)[:, None] for e, r in zip(changed, without, strict=True)]
            change = stacked(trial.fit, differences)[:, 0]
            size = float(np.linalg.norm(change))
            if size == 0.0:
                return None
            if size <= most:
                return amount, change
            shrink = MOST * most / size
        else:
            shrink = MOST**2
        if candidate.is_limit(f):
            amount += (1.0 - shrink) * (largest - zero - amount)
        else:
            amount *= shrink
    return None


def least(here: FloatArray, declared: FloatArray, found: Columns) -> tuple[FloatArray, float]:
    """Amounts [nf + k] of the declared search coordinates and of the candidate's parameters that
    make the residual `here` [n] least within bounds (ridge regression; `declared` [n, nf] is its
    Jacobian), and the share of its square that is left.
    """
    zero = [found.candidate.vanishing[f.name] for f in found.free]
    reach = np.full(declared.shape[1], MOST * LARGEST_STEP)
    lower = np.concatenate([-reach, [f.lower - z for f, z in zip(found.free, zero, strict=True)]])
    upper = np.concatenate([reach, [f.upper - z for f, z in zip(found.free, zero, strict=True)]])
    table = np.column_stack([declared, found.table])
    size = np.maximum(np.linalg.norm(table, axis=0), 1e-300)
    triangle = np.asarray(np.linalg.qr(np.column_stack([table / size, here]), mode="r"))
    k = int(table.shape[1])
    ridge = SAME**2 * np.linalg.norm(triangle[:, k]) * np.eye(k)
    solved = lsq_linear(
        np.vstack([triangle[:, :k], ridge]),
        -np.concatenate([triangle[:, k], np.zeros(k)]),
        ((lower - 1e-12) * size, (upper + 1e-12) * size),
    )
    left = 2.0 * solved.cost / max(float(here @ here), 1e-300)
    return solved.x / size, float(left)
