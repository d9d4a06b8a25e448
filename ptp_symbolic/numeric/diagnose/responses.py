"""What a finite amount of a candidate would change in the simulated outputs of a trial.

Breakaways, gaps and delays do not show in the torque along the motion, or have no derivative where
they vanish: their response to a finite amount, the free parameters following, predicts what a refit
could gain, and where it should start. Responses, and linear predictions from a Jacobian, are
projected off what other parameters follow.

Where a machine rests, or lies in a gap, most of the time, there are few rows, and no line stands
out in them. It does in the outputs: waves of all frequencies are simulated in turn.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from ptp_symbolic.numeric.diagnose.candidates import Candidate, with_what_it_brings
from ptp_symbolic.numeric.diagnose.fitted_model import (
    FittedModel,
    SearchProblem,
    simulated,
)
from ptp_symbolic.numeric.diagnose.proposals import (
    ProposedSet,
)
from ptp_symbolic.numeric.diagnose.signatures import at_line, axes_of, band, brought
from ptp_symbolic.numeric.identify.blocks import SINGULAR
from ptp_symbolic.numeric.identify.constants import (
    CYCLES_APART,
    DECLARED_AMOUNT,
    ITERATIONS,
    LARGEST_STEP,
    MOST,
    REACH,
    ROWS_PER_WINDOW,
    SAME,
    SCANNED,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, slopes, to_search
from ptp_symbolic.numeric.identify.equation_space import EquationSpace, row_motion
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import project_out
from ptp_symbolic.numeric.identify.least_squares import all_values

FloatArray = NDArray[np.float64]


def stacked(fit: Fit, columns: Sequence[FloatArray]) -> FloatArray:
    """Columns [k, c] of every run below one another [n, c], projected off its start unknowns."""
    pairs = zip(columns, fit.evaluations, strict=True)
    return np.vstack([project_out(c, e.by_start) for c, e in pairs])


def stacked_residual(fit: Fit) -> FloatArray:
    """The weighted residual [n] of all runs, projected off their starts."""
    return stacked(fit, [e.residual[:, None] for e in fit.evaluations])[:, 0]


def stacked_jacobian(fit: Fit) -> FloatArray:
    """Its derivatives by the search coordinates [n, nf], projected likewise."""
    return stacked(fit, [e.by_parameter for e in fit.evaluations])


def effect_of(fit: Fit, vanishing: Mapping[str, float], table: FloatArray) -> FloatArray:
    """Linear prediction of what parameters change in the residuals [n] at the fit against their
    values in `vanishing`: `table` [n, nf] is the Jacobian by the search coordinates.
    """
    unit = slopes(fit.free, to_search(fit.free, fit.values))
    effect = np.zeros(len(table))
    for k, f in enumerate(fit.free):
        if f.name in vanishing:
            effect += table[:, k] / unit[k] * (fit.values[f.name] - vanishing[f.name])
    return effect


def compensated(
    fit: Fit, vanishing: Mapping[str, float], kept: Collection[str], table: FloatArray
) -> dict[str, float]:
    """Values of the fit with parameters at their values in `vanishing`, and with others, `kept`,
    where they compensate for that, by linear prediction; `table` is that of `effect_of`.

    They move by what that predicts in their units, not in search coordinates: what an effect adds
    to an inertia is a sum. Parameters that the logs hardly distinguish move together.
    """
    own = [k for k, f in enumerate(fit.free) if f.name in kept]
    columns, unit = table[:, own], slopes(fit.free, to_search(fit.free, fit.values))
    size = np.linalg.norm(columns, axis=0)
    size[size == 0.0] = 1.0
    steps, *_ = np.linalg.lstsq(columns / size, effect_of(fit, vanishing, table), SAME)
    values = {**fit.values, **vanishing}
    for k, step in zip(own, steps / size, strict=True):
        f = fit.free[k]
        moved = float(np.clip(fit.values[f.name] + unit[k] * step, f.lower, f.upper))
        values.update(dict.fromkeys(f.names, moved))
    return values


def residual_beside(
    fit: Fit, effect: FloatArray, kept: Collection[str], table: FloatArray
) -> float:
    """Sum of squares of the part of an `effect` [n] that parameters `kept` cannot reproduce within
    their bounds, by linear prediction; `table` is that of `effect_of`.
    """
    own = [k for k, f in enumerate(fit.free) if f.name in kept]
    whole = float(effect @ effect)
    if not own or whole == 0.0:
        return whole
    unit = slopes(fit.free, to_search(fit.free, fit.values))
    size = np.linalg.norm(table[:, own], axis=0)
    size[size == 0.0] = 1.0
    room = [(fit.free[k], fit.values[fit.free[k].name], unit[k]) for k in own]
    lower = np.array([min((f.lower - v) / u, 0.0) for f, v, u in room]) * size
    upper = np.array([max((f.upper - v) / u, 0.0) for f, v, u in room]) * size
    slack = SINGULAR * np.sqrt(whole)
    basis, triangle = np.linalg.qr(table[:, own] / size)
    steps = lsq_linear(triangle, basis.T @ effect, (lower - slack, upper + slack)).x
    return float(np.sum((effect - basis @ (triangle @ steps)) ** 2))


def projected_off(columns: FloatArray, away: FloatArray) -> FloatArray:
    """Projection of `columns` [n, k] onto the orthogonal complement of those of `away` [n, m]."""
    size = np.linalg.norm(away, axis=0)
    kept = away[:, size > 0.0] / size[size > 0.0]
    if not kept.shape[1]:
        return columns
    left, values, _ = np.linalg.svd(kept, full_matrices=False)
    basis = left[:, values > SINGULAR * values[0]]
    return np.asarray(columns - basis @ (basis.T @ columns))


def canonical_correlation(target: FloatArray, columns: FloatArray) -> float:
    """Largest correlation, 0 to 1, of `target` [n] with any combination of `columns` [n, k]."""
    size = np.linalg.norm(columns, axis=0)
    kept = columns[:, size > 0.0] / size[size > 0.0]
    if not kept.shape[1] or not np.any(target):
        return 0.0
    left, values, _ = np.linalg.svd(kept, full_matrices=False)
    basis = left[:, values > SINGULAR * values[0]]
    return float(np.linalg.norm(basis.T @ target) / np.linalg.norm(target))


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
    """A candidate added to a trial: the predicted share of the squared residual with it (`left`),
    where a refit should start, and the values that shape it.
    """

    candidate: Candidate
    left: float
    proposal: ProposedSet
    shape: Mapping[str, float]


def responses(
    problem: SearchProblem, trial: FittedModel, candidates: Sequence[Candidate]
) -> list[Response]:
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
        wholes = [with_what_it_brings(trial.candidates, c, problem.candidates) for c in forms]
        found = _best_form(problem, trial, forms, wholes, lambda: at)
        if found is None:
            return None
        number, shape, left, moved = found
        candidate = forms[number]
        proposal = ProposedSet(wholes[number], {**trial.values, **moved})
        return Response(candidate, left, proposal, candidate.shapes[shape])

    jobs = problem.executor.map(best_form, wanted.values())
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
    problem: SearchProblem,
    trial: FittedModel,
    forms: Sequence[Candidate],
    wholes: Sequence[Sequence[Candidate]],
    linear: Callable[[], _Linear],
) -> tuple[int, int, float, dict[str, float]] | None:
    """The number of the form of a candidate that promises most and of its shape, the share of the
    squared residual with it, and the values that it changes; `wholes` are the sets that the forms
    make of the trial's.
    """
    fit, at, seen = trial.fit, linear(), SeenColumns()
    most = REACH * float(np.linalg.norm(at.residual))
    best = None
    for number, candidate in enumerate(forms):
        for place, shape in enumerate(candidate.shapes):
            found = response_columns(problem, trial, candidate, shape, most, seen)
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
    problem: SearchProblem,
    trial: FittedModel,
    candidate: Candidate,
    shape: Mapping[str, float],
    most: float,
    seen: SeenColumns | None = None,
) -> Columns | None:
    """Responses of `candidate` at the fit of `trial`, shaped by `shape`, to amounts that change the
    residuals by at most the norm `most`; None where nothing changes or can be simulated. Columns
    that other forms of the candidate have `seen` are not simulated again.
    """
    by_key = {c.key: c for c in reversed(problem.candidates)}
    brings = any(key not in trial.keys for key in candidate.brings)
    base = {**(brought(candidate, by_key) if brings else {}), **shape}
    residual = [e.residual for e in trial.fit.evaluations]
    without = residual
    if brings:
        plain = simulated(problem, trial.fit, base, None)
        if any(e.failed for e in plain):
            return None
        without = [e.residual for e in plain]
    seen = {} if seen is None else seen
    kept = []
    for f in candidate.defining:
        key = f.names, f.start, tuple(sorted(base.items()))
        if key not in seen:
            seen[key] = _column(problem, trial, without, base, f, candidate, most)
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
    problem: SearchProblem,
    trial: FittedModel,
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
        changed = simulated(problem, trial.fit, values, None)
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
    Jacobian), and the remaining share of its square.
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


def at_lines_of_outputs(
    problem: SearchProblem,
    space: EquationSpace | None,
    trial: FittedModel,
    waves: Sequence[Candidate],
) -> tuple[Candidate, ...]:
    """Those of the candidates `waves` of which a line stands out in the residual of the outputs, by
    linear prediction; at that line, in all their forms. None without the `space` of rows, which
    bounds the frequencies; and none of a wave of which the rows resolve all frequencies.
    """
    found: list[Candidate] = []
    if space is None:
        return ()
    for key in dict.fromkeys(c.key for c in waves):
        forms = [c for c in waves if c.key == key]
        line = None if key in trial.keys else _line(problem, space, trial, forms[0])
        placed = [at_line(form, *line) for form in forms] if line is not None else []
        found += [c for c in placed if c is not None]
    return tuple(found)


def _line(
    problem: SearchProblem, space: EquationSpace, trial: FittedModel, candidate: Candidate
) -> tuple[float, float, int] | None:
    """The frequency of the strongest line of a candidate, in Hz or cycles per turn, the lowest that
    is a line, and how many can be resolved; None where none reduces the sum of squares by a
    material share, and twice as much as any other: what drifts looks like many slow waves. And
    where there are more rows, those that overlap counted once, than frequencies, or too many to
    simulate.

    A step of half the resolution attenuates a line between by a fifth; the neighbourhood of the
    strongest is scanned again.
    """
    span, usual, rows = _place(space, trial, candidate)
    lowest, highest = band(space, candidate, span, usual)
    apart = int((highest - lowest) * span)
    if not rows / ROWS_PER_WINDOW < apart <= SCANNED:
        return None
    problem.progress(
        f"simulating {candidate.key} at all frequencies, {apart} of which are resolved"
    )
    best = _strongest(problem, trial, candidate, span, lowest, highest, problem.material)
    return None if best is None else (best, 0.9 * lowest, apart)


@recorded()
def _strongest(
    problem: SearchProblem,
    trial: FittedModel,
    candidate: Candidate,
    span: float,
    lowest: float,
    highest: float,
    material: float,
) -> float | None:
    """The frequency of the strongest line of `_line`, from the lowest to the highest, where it
    reduces the sum of squares by a `material` share.
    """
    away = stacked_jacobian(trial.fit)
    residual = projected_off(stacked_residual(trial.fit)[:, None], away)[:, 0]

    def left(frequency: float) -> float:
        return _left(problem, trial, candidate, frequency, residual, away)

    steps = np.arange(lowest, highest, MOST / span)
    shares = np.array(list(problem.executor.map(left, steps)))
    best = float(steps[int(np.argmin(shares))])
    others = shares[np.abs(steps - best) > 1.0 / span]
    close = np.clip(best + CYCLES_APART / span * np.array([-1.0, 0.0, 1.0]), lowest, highest)
    shares = np.array(list(problem.executor.map(left, close)))
    taken, by_others = 1.0 - shares.min(), 1.0 - others.min(initial=1.0)
    if taken < material or by_others > MOST * taken:
        return None
    return float(close[int(np.argmin(shares))])


def _place(
    space: EquationSpace, trial: FittedModel, candidate: Candidate
) -> tuple[float, float, int]:
    """How far the place goes that a wave is locked to, in s or turns, how fast it usually goes as
    it moves, per s (an axis without rows: 1 rad/s), and how many rows there are of it.
    """
    assert candidate.locked is not None
    runs, own = trial.fit.runs, axes_of(space, candidate)
    rows = int(np.isin(space.labels()[0], own).sum())
    if candidate.locked[1] == "time":
        return max(run.time[-1] for run in runs) - min(run.time[0] for run in runs), 1.0, rows
    columns = [run.measured[:, run.signals.index(f"theta_{candidate.axis}")] for run in runs]
    rate = np.abs(row_motion(space, own[0]).rate) if rows else np.ones(1)
    turns = float(np.ptp(np.concatenate(columns))) / (2.0 * np.pi)
    return turns, float(np.median(rate)) / (2.0 * np.pi), rows


def _left(
    problem: SearchProblem,
    trial: FittedModel,
    candidate: Candidate,
    frequency: float,
    residual: FloatArray,
    away: FloatArray,
) -> float:
    """Share of the square of a `residual` [n] that remains beside a wave of some frequency in any
    of its shapes; both projected off the columns `away` [n, nf].
    """
    assert candidate.locked is not None
    most = REACH * float(np.linalg.norm(residual))
    shapes = [{**shape, candidate.locked[0]: frequency} for shape in candidate.shapes]
    found = [response_columns(problem, trial, candidate, shape, most) for shape in shapes]
    tables = [columns.table for columns in found if columns is not None]
    if not tables:
        return 1.0
    wave = projected_off(np.column_stack(tables), away)
    rest = projected_off(residual[:, None], wave)
    return float(np.sum(rest**2) / max(np.sum(residual**2), 1e-300))


@recorded()
def expected_gain(trial: FittedModel, vanishing: Mapping[str, float]) -> float:
    """The share by which the fitted parameters in `vanishing` reduce the squared residual, against
    their values there, by linear prediction from the Jacobian.
    """
    fit = trial.fit
    residual = stacked_residual(fit)
    columns = stacked_jacobian(fit)
    others = [k for k, f in enumerate(fit.free) if f.name not in vanishing]
    effect = projected_off(effect_of(fit, vanishing, columns)[:, None], columns[:, others])[:, 0]
    taken = float(effect @ effect)
    return taken / max(taken + float(residual @ residual), 1e-300)
