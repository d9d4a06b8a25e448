"""Confidence intervals that allow for residuals correlated in time.

The residuals of a simulation error fit are never white: the noise of an input, propagated to an
angle, may last for a whole run. The covariance is that of a jackknife over a few long blocks of
time, the unknown initial states projected out. Intervals never get narrower than those of white
noise, as large as declared or as the residual, or of noise with the autocorrelation of the
residual, beside the propagated noise of the inputs: of what few samples show, as those about one
breakaway, no block of time can be left out to judge it.

Blocks of time within logs show how well one value suits them all, not how far the machine of
another day is from it, whose friction is that of another temperature: where logs differ by more
than blocks within each make likely, every log counts as one observation.

Finite differences replace the derivatives of a finished fit that miss what these see: friction that
holds, or breaks away a sample later, makes the residual a staircase of a parameter.
"""

from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, signal, stats

from ptp_symbolic.numeric.data.remarks import FEW_COUNTS
from ptp_symbolic.numeric.identify.blocks import (
    ELSEWHERE,
    autocovariance,
    block_labels,
    degrees_of_freedom,
    inverse_root,
    jackknife_covariance,
    leave_blocks_out,
    long_blocks,
    longest_block,
)
from ptp_symbolic.numeric.identify.constants import (
    FALSE_ALARM,
    FEWEST_BLOCKS,
    MISLEADING,
    MOST,
    NOTHING,
    ROUGH,
    SAME,
    STEP,
    TEST_ALARM,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, slopes, to_search, wrapped
from ptp_symbolic.numeric.identify.evaluate import Evaluation, mean_squares
from ptp_symbolic.numeric.identify.evidence import derived, is_recording, recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.least_squares import (
    POLISH,
    Effort,
    problem_of,
    simulations_of,
)
from ptp_symbolic.numeric.identify.run import by_log

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def coloured_variances(
    residuals: Sequence[FloatArray], influences: Sequence[FloatArray]
) -> FloatArray:
    """Variances [nf] of sums of the samples of `residuals` [n, ny], by log, each sample times its
    `influences` [n * ny, nf], where every signal is stationary: w' R w, summed over logs and
    signals, with w a column of influences and R the matrix of `autocovariance` by distance in time.
    """
    ny = residuals[0].shape[1]
    total = np.zeros(influences[0].shape[1])
    for column in range(ny):
        half = autocovariance([log[:, column] for log in residuals])
        kernel = np.concatenate([half[:0:-1], half])[:, None]
        for influence in influences:
            own = influence[column::ny]
            total += np.sum(own * signal.oaconvolve(own, kernel, "same", axes=0), axis=0)
    return total


def reach_between_logs(logs: Sequence[tuple[FloatArray, FloatArray]], signals: int) -> FloatArray:
    """Half widths [nf] of 95 % intervals of the mean over `logs`, by a jackknife over these (Bell
    and McCaffrey, 2002) with Student's distribution; from the residual [k * signals] of every log
    and its derivatives [k * signals, nf] by the parameters, at their common optimum.

    Zero where logs do not differ significantly (see `chance_of_scatter`), and for all parameters
    where there are fewer than three, or where one of them alone identifies some combination of
    parameters: without it, the errors of all others would show.
    """
    nothing = np.zeros(logs[0][1].shape[1])
    if len(logs) < 3:
        return nothing
    label = np.repeat(np.arange(len(logs)), [len(r) for r, _ in logs])
    residual, columns = (np.concatenate(parts) for parts in zip(*logs, strict=True))
    left_out = leave_blocks_out(residual, columns, label)
    if np.max(left_out.leverage, initial=0.0) > 1.0 - ELSEWHERE:
        return nothing
    quantile = stats.t.ppf(0.975, degrees_of_freedom(left_out.shifts))
    reach = quantile * np.sqrt(np.diag(jackknife_covariance(left_out.shifts)))
    return np.where(chance_of_scatter(logs, signals) < FALSE_ALARM, reach, 0.0)


def chance_of_scatter(logs: Sequence[tuple[FloatArray, FloatArray]], signals: int) -> FloatArray:
    """The chance [nf] that logs differ so much, or more, in every parameter where they are alike.

    How much each sample moves a parameter is summed over every log, and, once each log has a value
    of its own, over blocks within: an analysis of variance (Fisher, 1925). A sum of white noise has
    a variance in proportion to the information in its log, or block, less its part in the value
    that was taken out. Blocks are long enough to be independent; unequal ones have the degrees of
    freedom of so many equal ones (Satterthwaite, 1946).
    """
    root = inverse_root(np.vstack([c for _, c in logs]))
    inverse = root @ root.T
    lengths = [len(r) // signals for r, _ in logs]
    labels = block_labels(lengths, sum(lengths) / (2 * FEWEST_BLOCKS))
    between, sums, expected = np.zeros(len(inverse)), [], []
    for (residual, columns), label in zip(logs, labels, strict=True):
        influence = columns @ inverse
        moved, known = residual @ influence, np.maximum(np.sum(influence**2, axis=0), 1e-300)
        rest = influence * (residual[:, None] - influence * moved / known)
        parts = np.repeat(label - label[0], signals)
        of_block = _sums(influence**2, parts)
        between += moved**2 / known
        sums.append(_sums(rest, parts))
        expected.append(of_block * (1.0 - of_block / known))
    variances = np.maximum(np.concatenate(expected), 0.0)
    whole = np.maximum(np.sum(variances, axis=0), 1e-300)
    equal = whole**2 / np.maximum(np.sum(variances**2, axis=0), 1e-300)
    free = len(logs) - 1, equal - len(logs)
    variance = np.sum(np.concatenate(sums) ** 2, axis=0) / whole
    ratio = between / free[0] / np.maximum(variance, 1e-300)
    return np.where(free[1] < 1.0, 1.0, stats.f.sf(ratio, free[0], np.maximum(free[1], 1.0)))


def _sums(columns: FloatArray, parts: IntArray) -> FloatArray:
    """Sums [parts, nf] of the rows of `columns` [k, nf] in each of the `parts` [k]."""
    return np.array([np.bincount(parts, column) for column in columns.T]).T


@recorded()
def joint_region(fit: Fit) -> FloatArray:
    """The ellipsoid [nf, seen] that holds the true search coordinates of a finished fit with a
    chance of 99 %: the fitted ones plus this matrix times any vector of length one at most
    (Scheffe, 1953). An axis of which few blocks tell is widened as Student's t is at 99 %.
    Directions that the data do not see are left out.

    Axes count as uncorrelated, as they are beside white noise. Were all k of them the same normal
    number z, as where one slow mode remains that all follow, the truth would be held where k z^2 is
    below the 99 % quantile of chi squared with k degrees: in 97 % for two, in 87 % for ten.
    """
    axes, variances, degrees = axes_of(fit)
    tail = 0.5 * TEST_ALARM
    wider = stats.t.isf(tail, degrees) / stats.norm.isf(tail)
    radius = np.sqrt(stats.chi2.isf(TEST_ALARM, max(axes.shape[1], 1)))
    return np.asarray(radius * axes * wider * np.sqrt(variances))


def closest_in_ball(matrix: FloatArray, target: FloatArray) -> FloatArray:
    """The vector [n] of length one at most whose image by `matrix` [k, n] is closest to `target`
    [k]: least squares with a quadratic constraint (Golub and Van Loan, 2013, 6.2.1).
    """
    left, sizes, right = np.linalg.svd(matrix, full_matrices=False)
    largest = max(sizes.max(initial=0.0), 1e-300)
    seen = sizes > 1e-14 * largest  # below is the rounding of equal columns
    along, right = (left.T @ target)[seen] / largest, right[seen]
    sizes = sizes[seen] / largest

    def solution(multiplier: float) -> FloatArray:
        return sizes * along / (sizes**2 + multiplier)

    def excess(multiplier: float) -> float:
        return float(np.linalg.norm(solution(multiplier))) - 1.0

    multiplier = 0.0
    if seen.any() and excess(0.0) > 0.0:
        enough = 2.0 * float(np.linalg.norm(sizes * along))  # the length is below one half there
        multiplier = float(optimize.brentq(excess, 0.0, enough, xtol=1e-300, rtol=1e-12))
    return np.asarray(right.T @ solution(multiplier))


@dataclass(frozen=True)
class Estimate:
    """A fitted value with its 95 % confidence interval; SI. `identified` is False where the
    interval reaches further from the value than its size, or the data do not see the parameter at
    all: then it has no interval, `lower` and `upper` are its bounds. `only_with` names parameters
    of which the data see a combination alone, such as the sum of two viscous frictions in a joint.
    """

    name: str
    value: float
    lower: float
    upper: float
    at_bound: bool
    identified: bool
    only_with: tuple[str, ...] = ()
    has_interval: bool = True


@recorded(Estimate)
def estimates(fit: Fit) -> tuple[Estimate, ...]:
    """Values of the free parameters of `fit` with 95 % confidence intervals (Student's t), of the
    mean over logs where these differ significantly.
    """
    if not fit.free:
        return ()
    spreads, involved = _spreads(fit)
    spreads = np.maximum(spreads, reach_between_logs(_by_log(fit), fit.runs[0].measured.shape[1]))
    units = np.abs(slopes(fit.free, to_search(fit.free, fit.values)))
    result = []
    for index, free in enumerate(fit.free):
        value = wrapped(free, fit.values[free.name])
        partners: tuple[str, ...] = ()
        if involved[index].any():
            others = np.flatnonzero(involved[:, involved[index]].any(axis=1))
            partners = tuple(fit.free[i].name for i in others if i != index)
        low, high, width = _interval(free, value, float(spreads[index]), float(units[index]))
        near = 1e-4 * max(abs(free.start), abs(value))
        at_bound = value - free.lower <= near or free.upper - value <= near
        seen = bool(np.isfinite(width) and width < 1.0)
        told = bool(np.isfinite(spreads[index]))
        result.append(Estimate(free.name, value, low, high, bool(at_bound), seen, partners, told))
    return tuple(result)


@recorded()
def reaches(fit: Fit) -> FloatArray:
    """Half widths [nf] of the 95 % intervals in search coordinates, infinite where the data see a
    parameter only in combination with others, or not at all.
    """
    return _spreads(fit)[0]


def _spreads(fit: Fit) -> tuple[FloatArray, BoolArray]:
    """See `reaches`; and which of them take part [nf, lost] in what is not seen."""
    covariance, degrees, lost = covariance_of(fit)
    spreads = stats.t.ppf(0.975, degrees) * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    involved = np.any(lost**2 > SAME, axis=0)
    return np.where(involved.any(axis=1), np.inf, spreads), involved


def _interval(
    free: FreeParameter, value: float, spread: float, unit: float
) -> tuple[float, float, float]:
    """Ends of the interval of `spread` search coordinates about `value`, `unit` each, within the
    bounds and one period; and its half width as a share of the value.
    """
    half = spread * unit if np.isfinite(spread) else np.inf
    low, high = value - half, value + half
    if free.logarithmic and spread < -np.log(np.finfo(float).eps):  # else it has no end
        low, high = value * np.exp(-spread), value * np.exp(spread)
    width = spread if free.logarithmic else half / max(abs(value), 1e-300)
    if free.period is None:
        return float(max(low, free.lower)), float(min(high, free.upper)), width
    ends = max(low, value - free.period / 2), min(high, value + free.period / 2)
    return float(ends[0]), float(ends[1]), width


@recorded()
def chance_of_zero(fit: Fit, zero: Mapping[str, float], shape: Collection[str] = ()) -> float:
    """Probability that the parameters in `zero` are found as far from their values there as they
    are, or further, where the truth is there (see `chance_of`), with the covariance of the
    intervals. Those named in `shape` stay as they are, all others are free. 1 where the data see
    them only in combination with others.
    """
    away = to_search(fit.free, fit.values) - to_search(fit.free, {**fit.values, **zero})
    own = np.array([f.name in zero for f in fit.free])
    others = np.array([f.name not in zero and f.name not in shape for f in fit.free])
    columns = np.vstack(_columns(fit))
    covariance, degrees, lost = _covariance(fit, np.hstack([columns[:, others], columns[:, own]]))
    first = int(others.sum())
    mixed = [np.any(part**2 > SAME, axis=(0, 1)) for part in (lost[:, :first], lost[:, first:])]
    if np.any(mixed[0] & mixed[1]):
        return 1.0
    seen = ~np.any(lost[:, first:] ** 2 > SAME, axis=(0, 2))
    return chance_of(away[own], covariance[first:, first:], degrees[first:], seen)


def chance_of(
    away: FloatArray, covariance: FloatArray, degrees: FloatArray, seen: BoolArray | None = None
) -> float:
    """Probability that k coordinates are found so far `away` [k] from their truth, or further, with
    a `covariance` [k, k] that has `degrees` [k] of freedom: twice the smaller of two (Bonferroni).

    One is Hotelling's T^2 (1931) with the fewest degrees: coordinates that trade for each other are
    significant together. The other is Student's t of the most significant coordinate with its own
    degrees, times k: where one block alone identifies one of them, the others may be beyond doubt.
    Coordinates that are not `seen` [k] alone, only in combination, have no t. One without any error
    is not identified and left out; 1 where all are.
    """
    error = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    told = error > NOTHING * np.abs(away)
    if not told.any():
        return 1.0
    away, covariance, degrees = away[told], covariance[np.ix_(told, told)], degrees[told]
    k, left = len(away), float(degrees.min()) - len(away) + 1.0
    chances = np.minimum(1.0, 2.0 * k * stats.t.sf(np.abs(away) / error[told], degrees))
    alone = float(np.min(chances if seen is None else np.where(seen[told], chances, 1.0)))
    if k == 1:
        return alone
    square = float(away @ np.linalg.pinv(covariance, rcond=NOTHING, hermitian=True) @ away)
    together = 1.0
    if np.isinf(left):
        together = float(stats.chi2.sf(square, k))
    elif left > 0.0:
        together = float(stats.f.sf(square * left / (k * (left + k - 1.0)), k, left))
    return min(1.0, 2.0 * min(together, alone))


def covariance_of(fit: Fit) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Covariance [nf, nf] of the search coordinates, the degrees of freedom [nf] behind each, and
    the null space [2, nf, lost] that the data do not see, in coordinates scaled by what the data
    see of each alone, and in those of the search; the covariance leaves it out. Angles that never
    move are no data.
    """
    columns = np.vstack(_columns(fit))
    signals = fit.runs[0].measured.shape[1]
    columns[np.isin(np.arange(len(columns)) % signals, _at_rest(fit))] = 0.0
    return _covariance(fit, columns)


def _at_rest(fit: Fit) -> list[int]:
    """The measured angles that stay within a few counts of their encoder in all runs. They tell
    nothing: what they rest on may be any friction above a torque that was never reached.
    """
    still = []
    for k, name in enumerate(fit.runs[0].signals):
        span = max(float(np.ptp(run.measured[:, k])) for run in fit.runs)
        if name.startswith("theta_") and span <= FEW_COUNTS * fit.runs[0].counts[k]:
            still.append(k)
    return still


def axes_of(fit: Fit) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Directions [nf, seen] of the search coordinates, along which white noise of one moves a fit
    independently and by one each; the variance [seen] along each by the jackknife of the intervals;
    and the degrees of freedom [seen] behind it. Few blocks tell these variances, but not the
    correlations of many coordinates.
    """
    columns = np.vstack(_columns(fit))
    axes, _ = _axes(columns.T @ columns)
    covariance, degrees, _ = _covariance(fit, columns @ axes)
    return axes, np.diag(covariance), degrees


def _columns(fit: Fit) -> list[FloatArray]:
    """Derivatives [k, nf] of the residuals of every run by the search coordinates, without what the
    unknown starts can explain.
    """
    return [project_out(_usable(e.by_parameter), _usable(e.by_start)) for e in fit.evaluations]


def _usable(table: FloatArray) -> FloatArray:
    """Derivatives [k, n], zero where those by a coordinate have no finite sum of squares: tangents
    of a motion that multiplies errors without bound tell nothing of it.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        told = np.isfinite(np.sum(np.square(table, dtype=np.float64), axis=0))
    return table if np.all(told) else np.where(told, table, 0.0)


def _by_log(fit: Fit) -> list[tuple[FloatArray, FloatArray]]:
    """Residual [k] and derivatives [k, nf] of every log, its windows one after the other."""
    parts = by_log(fit.runs, _residuals(fit)), by_log(fit.runs, _columns(fit))
    return list(zip(*parts, strict=True))


def _residuals(fit: Fit) -> list[FloatArray]:
    """Residuals [k] of every run, without what the unknown starts can explain."""
    return [project_out(e.residual[:, None], _usable(e.by_start))[:, 0] for e in fit.evaluations]


def _covariance(fit: Fit, columns: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """See `covariance_of`, of the coordinates by which `columns` are the derivatives."""
    signals = fit.runs[0].measured.shape[1]
    residuals = _residuals(fit)
    logs = by_log(fit.runs, [r.reshape(-1, signals) for r in residuals])
    label = long_blocks([len(log) for log in logs], longest_block(logs), columns, signals)
    residual = np.concatenate(residuals)
    inverse, lost = _inverse(columns.T @ columns)
    white = np.diag(inverse) * max(1.0, float(np.mean(residual**2)))
    ends = np.cumsum([log.size for log in logs])[:-1]
    coloured = coloured_variances(logs, np.split(columns @ inverse, ends))
    normal = stats.norm.ppf(0.975)
    own = np.maximum(white, coloured) * normal**2
    known = own + _squared_reach_of_inputs(fit, inverse, columns)
    shifts = leave_blocks_out(residual, columns, label).shifts
    robust, degrees = jackknife_covariance(shifts), degrees_of_freedom(shifts)
    spread = np.maximum(np.diag(robust), 1e-300)
    wider = known > spread * stats.t.ppf(0.975, degrees) ** 2
    variance = np.where(wider, known / normal**2, spread)
    scale = np.sqrt(variance / spread)
    covariance = robust * np.outer(scale, scale)
    np.fill_diagonal(covariance, variance)
    return covariance, np.where(wider, np.inf, degrees), lost


def _squared_reach_of_inputs(fit: Fit, inverse: FloatArray, columns: FloatArray) -> FloatArray:
    """Squared half width [nf] of the 95 % intervals that the noise of the inputs alone makes: every
    replay of every run shifts the coordinates, each run independently.
    """
    if not fit.by_input_noise:
        return np.zeros(len(inverse))
    ends = np.cumsum([len(changes) for changes in fit.by_input_noise])
    parts = zip(np.split(columns, ends[:-1]), fit.by_input_noise, strict=True)
    every = [(c.T @ changes, max(changes.shape[1], 1)) for c, changes in parts]
    shifts = np.column_stack([inverse @ moved / np.sqrt(count) for moved, count in every]).T
    reach = stats.t.ppf(0.975, degrees_of_freedom(shifts, centred=False))
    return np.asarray(reach**2 * np.sum(shifts**2, axis=0))


def _inverse(information: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Inverse [nf, nf] where there is information, and the directions [2, nf, lost] without (see
    `_axes`).
    """
    axes, lost = _axes(information)
    return axes @ axes.T, lost


def _axes(information: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Directions [nf, seen] that make a unit matrix of the information; and those [2, nf, lost]
    without any.

    A parameter that the data hardly see takes part in a lost direction by little once it is scaled
    by that, and by much as it is.
    """
    size = np.sqrt(np.diag(information))
    unit = np.where(size > 0.0, size, 1.0)
    shares, directions = np.linalg.eigh(information / np.outer(unit, unit))
    kept = shares > NOTHING * max(shares.max(initial=0.0), 1e-300)
    axes = directions[:, kept] / unit[:, None] / np.sqrt(shares[kept])
    lost = directions[:, ~kept] / unit[:, None]
    lost /= np.maximum(np.linalg.norm(lost, axis=0), 1e-300)
    return axes, np.stack([directions[:, ~kept], lost])


def project_out(jacobian: FloatArray, nuisance: FloatArray) -> FloatArray:
    """Projection of `jacobian` [k, nf] onto the orthogonal complement of `nuisance` [k, nz]."""
    if nuisance.shape[1] == 0:
        return jacobian
    basis, triangle = np.linalg.qr(nuisance)
    kept = np.abs(np.diag(triangle)) > NOTHING * max(np.max(np.abs(triangle)), 1e-300)
    basis = basis[:, kept]
    return jacobian - basis @ (basis.T @ jacobian)


def with_finite_differences(
    fit: Fit, executor: Executor | None = None, reach: FloatArray | None = None
) -> Fit:
    """`fit` with finite differences in its Jacobians where the tangents at the optimum miss what
    these see: friction that holds, or breaks away a sample later, makes the residual a staircase of
    a parameter.

    The differences go over a usual step, or as far as the parameters may be off where that `reach`
    [nf] in search coordinates is given. Where they replace tangents and give a parameter far better
    than their step, that is too long: one jump somewhere in it says that the parameter is no
    further off, but not where it is. So it is shortened until the interval is about as long; where
    it never is, the tangents stay.
    """
    if not fit.free or fit.failed:
        return fit
    if not is_recording():
        return _with_finite_differences(fit, executor, reach)

    def changed() -> Sequence[Evaluation]:
        return _with_finite_differences(fit, executor, reach).evaluations

    squares = mean_squares(fit.evaluations, fit.runs)
    return replace(fit, evaluations=derived("finite differences", (fit, reach), changed, squares))


def _with_finite_differences(fit: Fit, executor: Executor | None, reach: FloatArray | None) -> Fit:
    """See `with_finite_differences`, of a fit that has free parameters and has not failed."""
    effort = Effort(tolerance=fit.tolerance, secants=STEP)
    simulations = simulations_of(fit.model, fit.runs, fit.free, fit.values, effort, executor)
    problem = problem_of(simulations, effort)
    assert problem.refine is not None
    phi = to_search(fit.free, fit.values)
    here = problem.evaluate(phi, fit.z, True)
    fit = replace(fit, evaluations=tuple(here))
    steps = np.full(len(phi), STEP) if reach is None else np.minimum(reach, STEP)
    steps = np.where(steps > 0.0, steps, STEP)
    wanted = np.ones(len(phi), dtype=np.bool_)
    for _ in range(POLISH):
        shifts = [(run, int(c)) for run in range(len(here)) for c in np.flatnonzero(wanted)]
        finite = replace(problem.refine, step=steps, chosen=shifts)(phi, fit.z, here)
        blind = [_is_blind(*pair, steps) for pair in zip(here, finite, strict=True)]
        parts = zip(blind, here, finite, strict=True)
        columns = [np.where(b, f.by_parameter, e.by_parameter) for b, e, f in parts]
        fit = _with_columns(fit, columns, wanted)
        if reach is not None:
            return fit
        found = reaches(fit)
        wanted &= np.any(blind, axis=0) & (found < MOST * steps)
        if not wanted.any():
            return fit
        steps = np.where(wanted, np.maximum(found, MOST**2 * steps), steps)
    return _with_columns(fit, [e.by_parameter for e in here], wanted)


def _with_columns(fit: Fit, columns: Sequence[FloatArray], wanted: BoolArray) -> Fit:
    """`fit` with the `wanted` [nf] columns of other Jacobians, one per run."""
    parts = zip(fit.evaluations, columns, strict=True)
    every = [replace(e, by_parameter=np.where(wanted, c, e.by_parameter)) for e, c in parts]
    return replace(fit, evaluations=tuple(every))


def _is_blind(at_point: Evaluation, finite: Evaluation, steps: FloatArray) -> BoolArray:
    """Which tangents [nf] of a run miss what differences over `steps` [nf] see, beyond what errors
    of the simulation may change.
    """
    seen, size = (np.linalg.norm(e.by_parameter, axis=0) for e in (at_point, finite))
    by_errors = ROUGH * np.sqrt(len(at_point.residual)) / steps
    return np.asarray((size > by_errors) & (seen < MISLEADING * size))
