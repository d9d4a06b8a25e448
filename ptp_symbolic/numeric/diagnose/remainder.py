"""The residual of a model along the measured motion and on validation runs: observations, no names.

The residual torque of every axis is averaged in bins of the angle, of the rate, of the input and of
the time since the joint turned back, and searched for lines in time and in angle. The share of its
variance that a side accounts for says where to look for what is missing. Residuals of every signal
are tested for whiteness and for independence of the inputs, and each log for a change at an unknown
time.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats
from scipy.signal import lombscargle

from ptp_symbolic.numeric.diagnose.responses import projected_off
from ptp_symbolic.numeric.identify.constants import (
    BINS,
    CYCLES_APART,
    FALSE_ALARM,
    LAGS,
    LEAST_CYCLES,
    MATERIAL,
    NOTHING,
    ROWS_PER_WINDOW,
    TEST_ALARM,
)
from ptp_symbolic.numeric.identify.equation_space import EquationSpace, RowMotion, row_motion
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit

FloatArray = NDArray[np.float64]


WHITE = (
    "residuals should not be autocorrelated; rounding and noise of the inputs correlate them a"
    " little where nothing is missing, so that this test alone proves nothing"
)
INDEPENDENT = (
    "the residual should be uncorrelated with {name}; where it is not, an effect is missing, or the"
    " log of {name} is noisy"
)


@recorded()
def residual_tests(fit: Fit, inputs: tuple[str, ...]) -> list[dict[str, Any]]:
    """Per measured signal: whiteness of its residual (autocorrelation), and independence of each of
    the `inputs` (cross-correlation).

    The statistic is the largest correlation over `LAGS` lags; of independent residuals it stays
    below the threshold in 99 of 100 cases, whatever the colour of residual and input. A residual
    that never changes, as of an axis at rest, and such an input, correlate with nothing: there is
    no test of them.
    """
    pairs = [(r, e) for r, e in fit.pairs() if len(r.time) > 4 * LAGS]
    rows: list[dict[str, Any]] = []
    for column, signal in enumerate(fit.runs[0].signals if pairs else ()):
        left = [e.residual.reshape(run.measured.shape)[:, column] for run, e in pairs]
        if _is_constant(left):
            continue
        white, size = correlations(left, left)
        rows.append(_row("whiteness", signal, white[1:], size, WHITE))
        for k, name in enumerate(inputs):
            given = [run.held_inputs[:, k] for run, _ in pairs]
            if _is_constant(given):
                continue
            crossed, size = correlations(left, given)
            row = f"independence of {name}", signal, crossed, size, INDEPENDENT.format(name=name)
            rows.append(_row(*row, spread(left, given)))
    return rows


def _is_constant(series: Sequence[FloatArray]) -> bool:
    """Whether no run changes by more than rounding does."""
    return all(float(np.ptp(s)) <= NOTHING * max(1.0, float(np.max(np.abs(s)))) for s in series)


def correlations(
    first: Sequence[FloatArray], other: Sequence[FloatArray]
) -> tuple[FloatArray, int]:
    """Correlations [LAGS + 1] of series over runs of any lengths, and the number of samples.

    Each run is scaled by itself and counts by its samples, so that the standard deviation of
    independent series of which one is white is 1 / sqrt(samples).
    """
    total, size = np.zeros(LAGS + 1), 0
    for a, b in zip(first, other, strict=True):
        a, b = a - a.mean(), b - b.mean()
        norm = max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-300)
        total += [a.size * float(a[k:] @ b[: b.size - k]) / norm for k in range(LAGS + 1)]
        size += a.size
    return total / max(size, 1), size


def spread(first: Sequence[FloatArray], other: Sequence[FloatArray]) -> float:
    """Standard deviation of the correlations of independent series over runs, beside that of white
    ones: the root of the sum over all lags of the product of their autocorrelations (Bartlett,
    1946; Ljung, 1999, 16.6), by their periodograms.
    """
    total, size = 0.0, 0
    for a, b in zip(first, other, strict=True):
        a, b = a - a.mean(), b - b.mean()
        powers = [np.abs(np.fft.fft(part, 2 * part.size)) ** 2 for part in (a, b)]
        product = float(np.mean(powers[0] * powers[1]))
        total += a.size * product / max(float((a @ a) * (b @ b)), 1e-300)
        size += a.size
    return float(np.sqrt(total / max(size, 1)))


def _row(
    name: str, signal: str, values: FloatArray, size: int, meaning: str, deviation: float = 1.0
) -> dict[str, Any]:
    largest = float(np.max(np.abs(values)))
    quantile = stats.norm.ppf(1.0 - 0.5 * TEST_ALARM / values.size)
    threshold = float(quantile * deviation / np.sqrt(size))
    return {
        "name": name,
        "signal": signal,
        "statistic": largest,
        "threshold": threshold,
        "passed": largest <= threshold,
        "meaning": meaning,
    }


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
    """Which of the `changes` [n, k] of a column `along` [n] reduces most the residual `left` [n]
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


def pole_of(rest: FloatArray, columns: int) -> float:
    """The pole of a residual [n] as an AR(1), corrected for its bias (Kendall, 1954), to which
    every one of the `columns` that were projected out adds as the mean does.
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


Side = tuple[str, str, FloatArray]


def remainder(space: EquationSpace | None, values: Mapping[str, float]) -> dict[str, Any] | None:
    """Maps and lines of the residual torque of every axis at the parameter `values`, with the share
    of its variance that each accounts for (adjusted for the bins); None without an equation space.
    """
    if space is None:
        return None
    rows = space.rows(space.model.parameter_vector(dict(values)))
    equation, number, time = space.labels()
    maps: list[dict[str, Any]] = []
    lines: list[dict[str, Any]] = []
    for axis, name in enumerate(space.model.module.AXES):
        own = equation == axis
        if int(own.sum()) < BINS * ROWS_PER_WINDOW:
            continue
        left, motion = rows[own], row_motion(space, axis)
        linear = space.model.is_linear(name)
        angle, turn = ("position", "m") if linear else ("angle", "turn")
        inputs = list(_inputs(space, number[own], time[own]))
        for against, unit, x in (*_sides(motion, linear), *inputs):
            if np.isfinite(x).any() and np.nanmin(x) < np.nanmax(x):
                maps.append({"axis": name, "against": against, "unit": unit, **binned(x, left)})
        in_time, once = number[own], np.zeros(len(left), dtype=np.int64)
        cycle = 1.0 if linear else 2.0 * np.pi
        for place, unit, x, speed, runs in (
            ("time", "Hz", time[own], np.ones(len(left)), in_time),
            (angle, f"1/{turn}", motion.angle / cycle, motion.rate / cycle, once),
        ):
            found = strongest_line(x, left, runs, space.half_width, speed)
            if found is not None:
                frequency, share = found
                line = {"axis": name, "against": place, "unit": unit}
                lines.append({**line, "frequency": frequency, "share": share})
    sliding = any(space.model.is_linear(name) for name in space.model.module.AXES)
    return {"unit": "N" if sliding else "N m", "maps": maps, "lines": lines}


def hints(found: Mapping[str, Any] | None) -> list[str]:
    """What the residual torque depends on most, in plain words, the largest share first."""
    if found is None:
        return []
    unit = found["unit"]
    what = "force" if unit == "N" else "torque"
    sides = [(m["share"], _said(m, what, unit)) for m in found["maps"] if m["share"] >= MATERIAL]
    sides += [
        (
            line["share"],
            f"The residual {what} on {line['axis']} has a spectral line at {line['frequency']:.3g}"
            f" {line['unit']} ({100.0 * line['share']:.0f} % of its variance).",
        )
        for line in found["lines"]
    ]
    return [text for share, text in sorted(sides, reverse=True) if share >= MATERIAL]


def _said(m: Mapping[str, Any], what: str, unit: str) -> str:
    largest = float(np.max(np.abs(m["mean"])))
    return (
        f"The residual {what} on {m['axis']} follows the {m['against']}"
        f" ({100.0 * m['share']:.0f} % of its variance, up to {largest:.3g} {unit})."
    )


def _sides(motion: RowMotion, linear: bool) -> Iterator[Side]:
    yield ("position", "m", motion.angle) if linear else ("angle", "rad", motion.angle)
    yield ("speed", "m/s", motion.rate) if linear else ("rate", "rad/s", motion.rate)
    yield "time since reversal", "s", motion.since_reversal


def _inputs(space: EquationSpace, number: NDArray[np.int64], time: FloatArray) -> Iterator[Side]:
    """What drives the machine at the rows: torques, voltages."""
    model = space.model
    for column, name in enumerate(model.input_names):
        x = np.zeros(len(time))
        for k, run in enumerate(space.runs):
            here = number == k
            x[here] = np.interp(time[here], run.time, run.held_inputs[:, column])
        yield f"input {name}", model.units[name], x


def binned(x: FloatArray, left: FloatArray) -> dict[str, Any]:
    """Means of `left` [n] in N m in equally full bins of `x` [n] (equal values share one), their
    standard errors (rows whose windows overlap count as one), and the share of the variance between
    bins.
    """
    usable = np.isfinite(x)
    if not usable.any():
        return {"at": [], "mean": [], "error": [], "share": 0.0}
    x, left = x[usable], left[usable]
    edges = np.unique(np.quantile(x, np.linspace(0.0, 1.0, BINS + 1)[1:-1]))
    place = np.searchsorted(edges, x, side="right")
    parts = [np.flatnonzero(place == k) for k in np.unique(place)]
    mean = np.array([left[part].mean() for part in parts])
    error = [
        float(left[part].std() / np.sqrt(max(part.size / ROWS_PER_WINDOW, 1.0))) for part in parts
    ]
    within = sum(float(np.sum((left[p] - m) ** 2)) for p, m in zip(parts, mean, strict=True))
    whole = float(np.sum((left - left.mean()) ** 2)) if left.size else 0.0
    independent = max(left.size / ROWS_PER_WINDOW, len(parts) + 2.0)
    excess = (independent - 1.0) / (independent - len(parts))
    share = 1.0 - excess * within / whole if whole > 0.0 else 0.0
    return {
        "at": [float(np.median(x[part])) for part in parts],
        "mean": mean.tolist(),
        "error": error,
        "share": max(share, 0.0),
    }


def strongest_line(
    place: FloatArray,
    left: FloatArray,
    runs: NDArray[np.int64],
    half_width: float,
    speed: FloatArray,
) -> tuple[float, float] | None:
    """The strongest line of `left` [n] over a `place` [n] (time in s run by run, turns or m), in
    Hz, 1/turn or 1/m, and the share of the variance in it (Lomb, 1976; Scargle, 1982), beyond that
    of the strongest of white noise (Fisher, 1929); None where the range holds too few cycles.
    Frequencies end where a window of `half_width` s averages two cycles away at the `speed` [n] of
    the place per s, or at two rows in a cycle.
    """
    span = max(float(np.ptp(place[runs == k])) for k in np.unique(runs))
    moving = np.abs(speed[speed != 0.0])
    slow = float(np.quantile(moving, 0.1)) if moving.size else 1.0
    lowest = LEAST_CYCLES / max(span, 1e-12)
    highest = min(1.0 / max(half_width * slow, 1e-12), 0.5 * left.size / max(span, 1e-12))
    if not lowest < highest:
        return None
    count = int((highest - lowest) * span / CYCLES_APART) + 2
    frequency = np.linspace(lowest, highest, count)
    power, whole = np.zeros(len(frequency)), 0.0
    for k in np.unique(runs):
        own = left[runs == k] - left[runs == k].mean()
        square = float(own @ own)
        if own.size < 2 * ROWS_PER_WINDOW or square == 0.0:
            continue
        found = lombscargle(place[runs == k], own, 2.0 * np.pi * frequency, normalize=True)
        power += square * np.asarray(found)
        whole += square
    if whole == 0.0:
        return None
    best = int(np.argmax(power))
    independent = max(left.size / ROWS_PER_WINDOW, 3.0)
    chance = min(2.0 * np.log(independent) / independent, 1.0 - 1e-9)
    share = (float(power[best] / whole) - chance) / (1.0 - chance)
    return float(frequency[best]), max(share, 0.0)
