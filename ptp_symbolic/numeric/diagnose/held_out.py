"""The validation runs: held to their own noise, and whether they bear out what was named."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.diagnose.floor import Floor
from ptp_symbolic.numeric.diagnose.gain import Gain, compared
from ptp_symbolic.numeric.diagnose.trial import (
    SHARP,
    Task,
    Trial,
    tolerance_for,
)
from ptp_symbolic.numeric.identify.blocks import block_length, huber_root
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    CYCLES,
    MATERIAL,
    MOST,
    NEARBY,
    REPEATS,
    ROUGH,
    SEED,
    TUNING,
    UNALIKE,
)
from ptp_symbolic.numeric.identify.evaluate import mean_squares
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters
from ptp_symbolic.numeric.identify.intervals import (
    closest_in_ball,
    joint_region,
    project_out,
    reaches,
)
from ptp_symbolic.numeric.identify.least_squares import BIGGEST
from ptp_symbolic.numeric.identify.replays import with_finite_differences
from ptp_symbolic.numeric.identify.robust_loss import (
    MANY_RUNS,
    huber_loss,
    trimmed_mean,
    weighted_median,
)
from ptp_symbolic.numeric.identify.run import Run, by_source, sizes
from ptp_symbolic.numeric.identify.simulations import POLISH, Effort

FloatArray = NDArray[np.float64]


def is_borne_out(held_out: Gain, quiet: bool, unusual: bool, material: float) -> bool:
    """Whether the validation runs bear out what the training runs named: they gain a `material`
    share by it. Where they show more than noise (not `quiet`), a wrong effect may imitate what is
    missing, so that it has to take away more than it leaves, as on training runs.

    Where all may be noise, but training runs leave an `unusual` amount of it, the noise is large by
    chance, or an effect is missing. Any effect follows a part of either, for seconds, in blocks
    left out as well; the validation runs have noise of their own, and must gain clearly.
    """
    if not quiet:
        return held_out.share >= MOST
    return held_out.share >= material and (not unusual or held_out.is_clear(1))


@recorded()
def left_by_best_values(
    after: Fit, estimated: Fit, level: FloatArray, executor: Executor | None = None
) -> FloatArray:
    """Mean squares [runs, ny], in units of the noise, that the validation runs `after` leave with
    other values: those in the joint confidence region of the `estimated` ones that suit all runs
    together best, to first order. Starts are free. Signals count by their noise `level` [ny], runs
    that are far worse than usual count less (Huber).

    A model that lacks nothing leaves noise with its true values, and the region holds those. What
    a lacking model leaves is seldom of the form of a change of its values.
    """
    squares = mean_squares(after.evaluations, after.runs)
    moved = replace(after, free=estimated.free)
    if estimated.free and not after.failed:
        moved = with_finite_differences(moved, executor, reaches(estimated))
    if moved.failed or not all(np.all(np.isfinite(e.by_parameter)) for e in moved.evaluations):
        return squares
    region = joint_region(estimated) if estimated.free else np.zeros((0, 0))
    size = sizes(after.runs)
    scaled = []  # residuals and what the region carries there, over the noise of their signals
    for run, e in moved.pairs():
        noise = np.tile(level, len(run.time))[:, None]
        residual = project_out(e.residual[:, None], e.by_start) / noise
        scaled.append((residual[:, 0], project_out(e.by_parameter, e.by_start) @ region / noise))
    left = [residual for residual, _ in scaled]
    for _ in range(2 * CYCLES):
        square = np.array([np.mean(r**2) for r in left])
        usual = max(float(weighted_median(square[:, None], size)[0]), 1.0)
        weighted = list(zip(huber_root(square, usual), scaled, strict=True))
        columns = np.vstack([root * carried for root, (_, carried) in weighted])
        target = -np.concatenate([root * residual for root, (residual, _) in weighted])
        shift = closest_in_ball(columns, target)
        left = [residual + carried @ shift for residual, carried in scaled]
    tables = [r.reshape(run.measured.shape) for r, run in zip(left, after.runs, strict=True)]
    return np.array([np.mean((table * level) ** 2, axis=0) for table in tables])


def is_quiet(left: FloatArray, size: FloatArray, floor: Floor, trained: Fit) -> bool:
    """Whether validation runs of `size` [runs] samples show no more than noise, by what they have
    `left` [runs, ny] (see `left_by_best_values`). The median of the runs counts, for one that
    sticks at another sample than it did is off by counts, but none may be further off than what is
    near the floor. Of many windows all count but the worst, a MATERIAL share of the samples, and
    they may not leave more than the windows of the training runs. Windows that leave no more than
    the usual noise count alike in that: those at rest, rounded to a count that they stay at, leave
    less, and show no lack in those that move.
    """
    squares = left / (ABOVE_NOISE * floor.most) ** 2
    many = len(left) >= MANY_RUNS
    usual = trimmed_mean(squares, size, MATERIAL) if many else weighted_median(squares, size)
    if not (np.all(usual <= 1.0) and (many or np.all(squares <= NEARBY**2))):
        return False
    own = mean_squares(trained.evaluations, trained.runs)
    if not many or len(own) < MANY_RUNS:
        return True
    quiet = (ABOVE_NOISE * floor.level) ** 2
    pairs = zip(np.maximum(left, quiet).T, np.maximum(own, quiet).T, strict=True)
    return all(chance_of_larger(ours, theirs) > UNALIKE for ours, theirs in pairs)


def chance_of_larger(ours: FloatArray, theirs: FloatArray) -> float:
    """The chance of ranks as high as those of `ours` [m] among `theirs` [n] if all are alike (Mann
    and Whitney, 1947), by permutation: where most are the same, their sum is far from normal. Of
    the draws, eight go as far where the chance is UNALIKE.
    """
    ranks = stats.rankdata(np.concatenate([ours, theirs]))
    rng, count = np.random.default_rng(SEED), round(REPEATS / UNALIKE)
    sums = [rng.permutation(ranks)[: len(ours)].sum() for _ in range(count)]
    return (1.0 + np.count_nonzero(sums >= ranks[: len(ours)].sum())) / (1.0 + count)


def held_out_fit(task: Task, trial: Trial) -> Fit:
    """The validation runs by the model of a trial, nothing but their start unknowns fitted."""
    return simulated_freely(task, task.validate, trial.values)


def simulated_freely(task: Task, runs: Sequence[Run], values: Mapping[str, float]) -> Fit:
    """Runs simulated with `values` of all parameters, nothing but their start unknowns fitted."""
    effort = Effort(POLISH, MATERIAL * ROUGH, tolerance_for(task, SHARP))
    return fit_parameters(task.model, runs, (), dict(values), None, effort, task.executor)


def held_out_gain(after: Fit, before: Fit) -> Gain:
    """The share of the mean square error of validation runs or windows that is taken away (Huber's
    loss: those far worse than usual count linearly). Windows of one log count together as long as
    what they gain is correlated (see `block_length`).
    """
    size = sizes(after.runs)
    squares = [mean_squares(fit.evaluations, fit.runs) for fit in (after, before)]
    usual = np.min([weighted_median(s, size) for s in squares], axis=0)
    tuning = TUNING**2 * np.maximum(usual, 1.0)
    losses = [size * huber_loss(np.minimum(s, BIGGEST), tuning).sum(axis=1) for s in squares]
    blocks = _independent(after.runs, losses[1] - losses[0])
    return compared(*[np.asarray(np.bincount(blocks, loss), dtype=np.float64) for loss in losses])


def _independent(runs: Sequence[Run], taken: FloatArray) -> NDArray[np.int64]:
    """The block [runs] of every run or window: those of one log together as long as what is `taken`
    [runs] from them is correlated, however few blocks that leaves.
    """
    groups = by_source(runs)
    mean = taken / sizes(runs)
    length = block_length([mean[group] for group in groups])
    label, first = np.zeros(len(runs), dtype=np.int64), 0
    for group in groups:
        count = max(1, round(len(group) / length))
        label[group] = first + np.arange(len(group)) * count // len(group)
        first += count
    return label
