"""A change of one log at an unknown time: a step, or another way to follow motion or inputs."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.diagnose.linear import projected_off
from ptp_symbolic.numeric.identify.constants import FALSE_ALARM

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Looked:
    """Where a change is looked for: outside the share `trim` at either end, at so many `times`,
    where at least the share `shown` of its square is not explained by what stands beside it; a
    variance has `degrees` of freedom at least.
    """

    trim: float
    times: int
    shown: float
    degrees: float


def trimmed(time: FloatArray, trim: float) -> tuple[float, float]:
    """The times in s between which a change of a log is looked for: without a share at its ends."""
    first, last = float(time[0]), float(time[-1])
    return first + trim * (last - first), last - trim * (last - first)


def change_of(
    time: FloatArray, left: FloatArray, beside: FloatArray, looked: Looked
) -> tuple[float, float, int] | None:
    """Time in s of the change of one residual [n] beside columns [n, m], its size, and the column
    whose coefficient changes; None where the largest statistic of all is below its level.
    """
    if len(left) < 4 * (beside.shape[1] + 2) or not np.ptp(left) > 0.0:
        return None
    found = [(*_step_in(time, left, beside, looked), 0)]
    pole = pole_of(projected_off(left[:, None], beside)[:, 0], beside.shape[1])
    for column in range(1, beside.shape[1]):
        found.append((*_change_in(time, left, beside, column, pole, looked), column))
    chance, at, size, column = min(found)
    return (at, size, column) if chance * beside.shape[1] <= FALSE_ALARM else None


def _step_in(
    time: FloatArray, left: FloatArray, beside: FloatArray, looked: Looked
) -> tuple[float, float, float]:
    """The chance of the largest statistic for a step, its time in s and its size. Its distribution
    is that of the largest square of a normalised Brownian bridge (Miller and Siegmund, 1982, eq.
    8), the residual an AR(1).
    """
    times = np.linspace(*trimmed(time, looked.trim), looked.times)
    steps = (time[:, None] >= times).astype(np.float64)
    best, size, square, rest = _best_change(left, steps, np.ones(len(time)), beside, looked.shown)
    noise, independent = long_run(rest, beside.shape[1] + 2)  # size and time of the step too
    degrees, at = independent - beside.shape[1] - 1.0, float(times[best])
    if degrees < looked.degrees or noise == 0.0:
        return 1.0, at, 0.0
    b = abs(size) * float(np.sqrt(square / noise * degrees / independent))
    odds = 2.0 * np.log((1.0 - looked.trim) / looked.trim)
    density = float(stats.norm.pdf(b))
    return density * (4.0 / b + (b - 1.0 / b) * odds) if b > 1.0 else 1.0, at, size


def _change_in(
    time: FloatArray, left: FloatArray, beside: FloatArray, column: int, pole: float, looked: Looked
) -> tuple[float, float, float]:
    """As `_step_in`, of how the residual follows a column: Student's t over all times at once
    (Bonferroni), the residual an AR(1) of a `pole` that all columns are freed of (Prais and
    Winsten, 1954), for what drifts slowly hardly weighs on a column that does not.
    """
    times, along = np.linspace(*trimmed(time, looked.trim), looked.times), beside[:, column]
    changes = (time[:, None] >= times) * along[:, None]
    table = _whitened(np.column_stack([left, along, changes, beside]), pole)
    changes, beside = table[:, 2 : looked.times + 2], table[:, looked.times + 2 :]
    best, size, square, rest = _best_change(table[:, 0], changes, table[:, 1], beside, looked.shown)
    degrees = len(rest) - beside.shape[1] - 2.0
    noise = max(float(rest @ rest) / degrees, 1e-300)
    statistic = abs(size) * float(np.sqrt(square / noise))
    chance = 2.0 * looked.times * float(stats.t.sf(statistic, degrees))
    return min(chance, 1.0), float(times[best]), size


def _best_change(
    left: FloatArray, changes: FloatArray, along: FloatArray, beside: FloatArray, shown: float
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
    size = np.where(square > shown * raw, size, 0.0)
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
