"""A change at one time in all logs: something is switched on or off, taken off or put on.

The residual of a log steps, or follows the motion or an input differently from some time on; where
the times of nearly all logs agree, and their inputs do not change, no law of motion is what lacks.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.diagnose.linear import projected_off
from ptp_symbolic.numeric.identify.constants import (
    CHANGE_TIMES,
    FALSE_ALARM,
    LEAST_DEGREES,
    MOST,
    NEARLY_ALL,
    SHOWN_OF_CHANGE,
    TEST_ALARM,
    TIMES_APART,
    TRIM,
)

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LogRows:
    """What is left of one log: `time` [n] in s, `left` [n] in N m (or output units), `beside`
    [n, m] what else it may follow (a constant first, then motion, inputs), and the `input` [n, nu].
    """

    time: FloatArray
    left: FloatArray
    beside: FloatArray
    input: FloatArray


@dataclass(frozen=True)
class Change:
    """A change at `time` in s, within `interval` s in `shown` of `logs` logs: of how the residual
    follows the `column` of what stands beside it, by `size` (median) in the unit of the residual
    over that of the column; a step where that is the constant, 0.
    """

    time: float
    interval: float
    shown: int
    logs: int
    size: float
    column: int = 0


def change_at_one_time(logs: Sequence[LogRows]) -> Change | None:
    """The time at which the residual of nearly all logs steps, or follows motion or inputs
    differently from then on (a payload that is taken off), where their inputs do not change.

    Every log has its own test for one change of one coefficient at an unknown time (Andrews, 1993),
    at 5 % over all of them; the times have to agree more closely than 1 % of
    independent ones would (binomial). Blind where fewer than three logs reach the time.
    """
    duration = max((float(np.ptp(log.time)) for log in logs), default=0.0)
    near = TIMES_APART * duration
    found = [_change_of(log.time, log.left, log.beside) for log in logs]
    times = [each for each in found if each is not None]
    best: Change | None = None
    for centre, _, _ in times:
        reach = [log for log in logs if _trimmed(log.time)[0] <= centre <= _trimmed(log.time)[1]]
        close = [each for each in times if abs(each[0] - centre) <= near]
        share = np.mean(
            [min(2.0 * near / max(np.ptp(_trimmed(r.time)), 1e-300), 1.0) for r in reach]
        )
        chance = len(times) * float(stats.binom.sf(len(close) - 1, len(reach), share))
        enough = len(close) >= max(3, NEARLY_ALL * len(reach))
        if not enough or chance > TEST_ALARM or _inputs_change(reach, centre, near):
            continue
        if best is None or len(close) > best.shown:
            time = float(np.median([t for t, _, _ in close]))
            column = Counter(c for _, _, c in close).most_common(1)[0][0]
            size = float(np.median([abs(size) for _, size, c in close if c == column]))
            best = Change(time, near, len(close), len(reach), size, column)
    return best


def _trimmed(time: FloatArray) -> tuple[float, float]:
    """The times in s between which a step of a log is looked for."""
    first, last = float(time[0]), float(time[-1])
    return first + TRIM * (last - first), last - TRIM * (last - first)


def _inputs_change(logs: Sequence[LogRows], centre: float, near: float) -> bool:
    """Whether the size of an input steps at the time in more than half of the logs."""
    for column in range(logs[0].input.shape[1]):
        sizes = [np.abs(log.input[:, column]) for log in logs]
        steps = [
            _change_of(log.time, size, np.ones((len(size), 1)))
            for log, size in zip(logs, sizes, strict=True)
        ]
        if np.mean([s is not None and abs(s[0] - centre) <= near for s in steps]) > MOST:
            return True
    return False


def _change_of(
    time: FloatArray, left: FloatArray, beside: FloatArray
) -> tuple[float, float, int] | None:
    """Time in s of the change of one residual [n] beside columns [n, m], its size, and the column
    whose coefficient changes; None where the largest statistic of all is below its level.
    """
    if len(left) < 4 * (beside.shape[1] + 2) or not np.ptp(left) > 0.0:
        return None
    found = [(*_step_in(time, left, beside), 0)]
    pole = pole_of(projected_off(left[:, None], beside)[:, 0], beside.shape[1])
    for column in range(1, beside.shape[1]):
        found.append((*_change_in(time, left, beside, column, pole), column))
    chance, at, size, column = min(found)
    return (at, size, column) if chance * beside.shape[1] <= FALSE_ALARM else None


def _step_in(time: FloatArray, left: FloatArray, beside: FloatArray) -> tuple[float, float, float]:
    """The chance of the largest statistic for a step, its time in s and its size. Its distribution
    is that of the largest square of a normalised Brownian bridge (Miller and Siegmund, 1982, eq.
    8), the residual an AR(1).
    """
    times = np.linspace(*_trimmed(time), CHANGE_TIMES)
    steps = (time[:, None] >= times).astype(np.float64)
    best, size, square, rest = _best_change(left, steps, np.ones(len(time)), beside)
    noise, independent = long_run(rest, beside.shape[1] + 2)  # size and time of the step too
    degrees, at = independent - beside.shape[1] - 1.0, float(times[best])
    if degrees < LEAST_DEGREES or noise == 0.0:
        return 1.0, at, 0.0
    b = abs(size) * float(np.sqrt(square / noise * degrees / independent))
    odds = 2.0 * np.log((1.0 - TRIM) / TRIM)
    density = float(stats.norm.pdf(b))
    return density * (4.0 / b + (b - 1.0 / b) * odds) if b > 1.0 else 1.0, at, size


def _change_in(
    time: FloatArray, left: FloatArray, beside: FloatArray, column: int, pole: float
) -> tuple[float, float, float]:
    """As `_step_in`, of how the residual follows a column: Student's t over all times at once
    (Bonferroni), the residual an AR(1) of a `pole` that all columns are freed of (Prais and
    Winsten, 1954), for what drifts slowly hardly weighs on a column that does not.
    """
    times, along = np.linspace(*_trimmed(time), CHANGE_TIMES), beside[:, column]
    changes = (time[:, None] >= times) * along[:, None]
    table = _whitened(np.column_stack([left, along, changes, beside]), pole)
    changes, beside = table[:, 2 : CHANGE_TIMES + 2], table[:, CHANGE_TIMES + 2 :]
    best, size, square, rest = _best_change(table[:, 0], changes, table[:, 1], beside)
    degrees = len(rest) - beside.shape[1] - 2.0
    noise = max(float(rest @ rest) / degrees, 1e-300)
    statistic = abs(size) * float(np.sqrt(square / noise))
    chance = 2.0 * CHANGE_TIMES * float(stats.t.sf(statistic, degrees))
    return min(chance, 1.0), float(times[best]), size


def _best_change(
    left: FloatArray, changes: FloatArray, along: FloatArray, beside: FloatArray
) -> tuple[int, float, float, FloatArray]:
    """Which of the `changes` [n, k] of a column `along` [n] takes most away from what is `left` [n]
    beside columns [n, m], its size (zero where these hide them all), its square beside them, and
    what stays [n].
    """
    part = along @ changes / max(float(along @ along), 1e-300)
    raw = np.sum((changes - np.outer(along, part)) ** 2, axis=0)
    table = projected_off(np.column_stack([left, changes]), beside)
    rest, changes = table[:, 0], table[:, 1:]
    square = np.sum(changes**2, axis=0)
    size = changes.T @ rest / np.maximum(square, 1e-300)
    size = np.where(square > SHOWN_OF_CHANGE * raw, size, 0.0)
    best = int(np.argmax(size**2 * square))
    stays = rest - size[best] * changes[:, best]
    return best, float(size[best]), float(square[best]), stays


def _whitened(table: FloatArray, pole: float) -> FloatArray:
    """Columns [n, c] of an AR(1) freed of its `pole`."""
    first = np.sqrt(1.0 - pole**2) * table[:1]
    return np.vstack([first, table[1:] - pole * table[:-1]])


def pole_of(rest: FloatArray, columns: int = 1) -> float:
    """The pole of a residual [n] as an AR(1), corrected for its bias (Kendall, 1954), to which
    every one of the `columns` beside which it is left adds as the mean does.
    """
    n = len(rest)
    pole = float(rest[1:] @ rest[:-1]) / max(float(rest @ rest), 1e-300)
    return float(np.clip(pole + (1.0 + pole + 2.0 * columns * pole) / n, 0.0, 1.0 - 1.0 / n))


def long_run(rest: FloatArray, columns: int = 1) -> tuple[float, float]:
    """Variance at frequency zero of a residual [n] as an AR(1), and how many independent values it
    has; `columns` as in `pole_of`.
    """
    square, n, pole = float(rest @ rest), len(rest), pole_of(rest, columns)
    inflation = (1.0 + pole) / (1.0 - pole)
    return inflation * square / n, n / inflation
