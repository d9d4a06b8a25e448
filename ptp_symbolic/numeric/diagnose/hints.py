"""Observations on the residual that no single effect accounts for, in plain words.

A change at one time in all logs, a resonance, lost motion at reversals, a ceiling of the input.
Each has a test with a stated level; none is an accepted effect, all are places to look.
"""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import signal, stats

from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.remainder import Looked, change_of, long_run, trimmed
from ptp_symbolic.numeric.diagnose.responses import projected_off
from ptp_symbolic.numeric.identify.constants import (
    CYCLES,
    FAR,
    LEAST_CYCLES,
    MATERIAL,
    MOST,
    ROUNDING,
    ROWS_PER_WINDOW,
    TEST_ALARM,
)
from ptp_symbolic.numeric.identify.equation_space import EquationSpace, row_motion
from ptp_symbolic.numeric.identify.weak_form import averages

FloatArray = NDArray[np.float64]

TRIM = 0.1  # 1; share of a log at either end in which no change is looked for; usual (Andrews 1993)
TIMES = 81  # 1; of a log at which a change is looked for: steps of 1 % of it; derived
NEARLY_ALL = 0.7  # 1; share of the logs that are nearly all; stated
APART = 0.04  # 1; of the duration of a log: times of a change that agree; stated
LEAST_DEGREES = 4.0  # 1; of freedom: the variance is then good to a factor of two; derived
SHOWN = 0.1  # 1; square of a change that the motion leaves unexplained, so that it shows; stated
SEGMENT_TIME = 2.0  # s; of a periodogram, resolves 0.5 Hz; halved for windows below twice; stated
BACKGROUND = 2.0  # 1; factor of frequency on either side of a line, its background; stated
CORE = 1.15  # 1; factor of frequency on either side that belongs to the line; stated
HANN_WIDTH = 1.5  # segments^-1; noise bandwidth of a Hann window; derived (Welch, 1967)
DOUBLED = float(np.log(2.0))  # 1; log power of a line over its background, at least; stated
ABOVE_FLOOR = 4.0  # 1; power of a line over that of white noise, at least; stated
SPEEDS_APART = 1.25  # 1; ratio of speeds that moves a line locked to the angle; stated
LEG = 0.5  # s; of motion before and after a reversal that places the residual there; stated
LEG_SAMPLES = 15  # samples; of such a leg: two values of a line are then good to 50 %; derived
LEAST_REVERSALS = 6  # 1; whose median has an interval at 97 %; derived
REVERSAL_ALARM = 1e-3  # 1; false alarms of the test of lost motion; stated level
LEVELS = 40  # 1; of |input| where a ceiling may begin, from its median to its largest; stated
SHOWS_ALONE = 1e-3  # 1; share of the excess of an input that nothing else explains; stated


LOOKED = Looked(TRIM, TIMES, SHOWN, LEAST_DEGREES)


@dataclass(frozen=True, eq=False)
class LogRows:
    """The residual of one log: `time` [n] in s, `left` [n] in N m (or output units), `beside`
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


@dataclass(frozen=True, eq=False)
class Recorded:
    """One run: `period` s, `measured` [n] angle and `left` [n] its residual in rad, `noise` in rad,
    `input` [n, nu], and the `count` of the encoder in rad (nan without one).
    """

    log: str
    period: float
    measured: FloatArray
    left: FloatArray
    noise: float
    count: float
    input: FloatArray


@dataclass(frozen=True)
class Resonance:
    """A peak at `frequency` in Hz in `shown` of `logs` logs, `excess` times its background."""

    frequency: float
    excess: float
    shown: int
    logs: int


@dataclass(frozen=True)
class LostMotion:
    """Median lag after `reversals` reversals, with its standard error, both in rad."""

    lag: float
    error: float
    reversals: int


@dataclass(frozen=True)
class Ceiling:
    """A `level` of |input|, and by how much the input `exceeds` it at most, both in its unit."""

    level: float
    exceeds: float


def further_hints(trial: FittedModel, space: EquationSpace | None) -> list[str]:
    """All observations of this module on what a trial leaves, as sentences with units: of the rows
    of its equation `space` (None: of its outputs), and of its simulated angles.
    """
    found: list[str] = []
    if space is None and not trial.fit.failed:
        found += _said_of_outputs(trial)
    if space is not None:
        found += _said_of_rows(trial, space)
    if trial.fit.failed:
        return found
    for column, name in enumerate(trial.fit.runs[0].signals):
        if name.startswith("theta_"):
            found += _said_of_angle(trial, column, name.removeprefix("theta_"))
    return found


def _said_of_rows(trial: FittedModel, space: EquationSpace) -> list[str]:
    """A change at one time and ceilings of inputs, by the rows of every axis."""
    model = space.model
    p = model.parameter_vector(trial.values)
    left, (equation, _, _) = space.rows(p), space.labels()
    found: list[str] = []
    for axis, name in enumerate(model.module.AXES):
        own = equation == axis
        if not own.any():
            continue
        unit = "N" if model.is_linear(name) else "N m"
        beside, given = _beside(space, axis)
        logs = _by_log(space, axis, left[own], beside, given)
        what = f"residual {'force' if unit == 'N' else 'torque'} of {name}"
        moved = "position" if unit == "N" else "angle"
        follows = ("", moved, "rate", "direction of travel", "square of the rate")
        names = (*follows, *model.input_names, *(f"square of {n}" for n in model.input_names))
        found += _said_change(change_at_one_time(logs), what, unit, names)
        for column, signal_name in enumerate(model.input_names):
            levels, beyond = _beyond(space, axis, column)
            acts = float(np.mean(_response(space, p, column)[own] - left[own]))
            ceiling = input_ceiling(left[own], beside, levels, beyond, acts)
            if ceiling is not None:
                found.append(
                    f"Beyond |{signal_name}| = {ceiling.level:.3g} {model.units[signal_name]} the"
                    f" input does less than the model says (it goes up to"
                    f" {np.max(_sizes(space, column)):.3g} {model.units[signal_name]}; F test at"
                    " 1 %): a ceiling of the drive would do that."
                )
    return found


def _said_of_outputs(trial: FittedModel) -> list[str]:
    """A change at one time, by the outputs of a machine without rows."""
    runs, found = trial.fit.pairs(), []
    for column, name in enumerate(trial.fit.runs[0].signals):
        by_log: dict[str, list[LogRows]] = {}
        for run, evaluation in runs:
            left = evaluation.residual.reshape(run.measured.shape)[:, column] / run.weight[column]
            beside = np.column_stack(
                [np.ones(len(left)), run.measured, run.held_inputs, np.abs(run.held_inputs)]
            )
            rows = LogRows(run.time, left, beside, run.held_inputs)
            by_log.setdefault(run.source, []).append(rows)
        change = change_at_one_time([_joined(parts) for parts in by_log.values()])
        inputs = trial.fit.model.input_names
        names = ("", *runs[0][0].signals, *inputs, *(f"size of {n}" for n in inputs))
        found += _said_change(change, f"residual of {name}", trial.fit.model.units[name], names)
    return found


def _joined(parts: Sequence[LogRows]) -> LogRows:
    """The windows of one log, one after the other."""
    return LogRows(
        np.concatenate([part.time for part in parts]),
        np.concatenate([part.left for part in parts]),
        np.concatenate([part.beside for part in parts]),
        np.concatenate([part.input for part in parts]),
    )


def _said_change(change: Change | None, what: str, unit: str, names: Sequence[str]) -> list[str]:
    """A change as a sentence; `names` are those of the columns that the residual may follow."""
    if change is None:
        return []
    name = names[change.column]
    how = "steps" if not name else f"follows the {name} differently from then on, beginning"
    by = "" if name else f", by {change.size:.3g} {unit}"
    return [
        f"The {what} {how} at {change.time:.3g} s (within {change.interval:.2g} s) in"
        f" {change.shown} of {change.logs} logs{by} (one change per log at 5 %, their agreement at"
        " 1 %): something is switched on or off, put on or taken off there."
    ]


def _said_of_angle(trial: FittedModel, column: int, axis: str) -> list[str]:
    """A resonance and lost motion, by one simulated angle."""
    runs = [
        Recorded(
            run.source,
            float(np.median(np.diff(run.time))),
            run.measured[:, column],
            evaluation.residual.reshape(run.measured.shape)[:, column] / run.weight[column],
            float(1.0 / run.weight[column]),
            float(run.counts[column]),
            run.held_inputs,
        )
        for run, evaluation in trial.fit.pairs()
    ]
    found, line, lost = [], resonance(runs), lost_motion(runs)
    if line is not None:
        found.append(
            f"The residual of {axis} rings at {line.frequency:.3g} Hz in {line.shown} of"
            f" {line.logs} logs that show it ({line.excess:.2g} times the power around it, binomial"
            " test at 1 %): a flexible shaft or mount would do that."
        )
    if lost is not None:
        linear = trial.fit.model.is_linear(axis)
        lag, error = (lost.lag, lost.error) if linear else np.degrees([lost.lag, lost.error])
        unit, count = "m" if linear else "deg", float(runs[0].count)
        counts = f", {lost.lag / count:.3g} counts" if np.isfinite(count) else ""
        found.append(
            f"After {axis} turns back, its motion lags by {lag:.3g} +- {error:.1g} {unit}{counts}"
            f" (median of {lost.reversals} reversals, t test at 0.1 %): a gap, or a soft shaft that"
            " winds up, would do that."
        )
    return found


def _beside(space: EquationSpace, axis: int) -> tuple[FloatArray, FloatArray]:
    """What the rows of an axis may follow otherwise [n, m]: a constant, angle, rate, its sign and
    square, inputs and their squares; and the inputs [n, nu] alone.
    """
    motion, inputs = row_motion(space, axis), len(space.model.input_names)
    tables = [
        np.column_stack([run.held_inputs, run.held_inputs * np.abs(run.held_inputs)])
        for run in space.runs
    ]
    given = _averaged(space, axis, tables)
    rate = motion.rate
    moving = [np.ones(len(rate)), motion.angle, rate, np.sign(rate), rate * np.abs(rate)]
    return np.column_stack([*moving, given]), given[:, :inputs]


def _averaged(space: EquationSpace, axis: int, tables: Sequence[FloatArray]) -> FloatArray:
    """Averages [n, c] of what is given for every sample of every run [k, c] in the windows of the
    rows of an axis.
    """
    found = [
        averages(rows.on_grid, np.ascontiguousarray(table[rows.grid]))[rows.kept[:, axis]]
        for rows, table in zip(space.rows_of, tables, strict=True)
    ]
    return np.concatenate(found)


def _by_log(
    space: EquationSpace, axis: int, left: FloatArray, beside: FloatArray, given: FloatArray
) -> list[LogRows]:
    """The rows of an axis, those of every log together."""
    equation, number, time = space.labels()
    own = equation == axis
    source = np.array([run.source for run in space.runs])[number[own]]
    return [
        LogRows(time[own][here], left[here], beside[here], given[here])
        for here in (source == name for name in dict.fromkeys(source.tolist()))
    ]


def _sizes(space: EquationSpace, column: int) -> FloatArray:
    return np.abs(np.concatenate([run.held_inputs[:, column] for run in space.runs]))


def _beyond(space: EquationSpace, axis: int, column: int) -> tuple[FloatArray, FloatArray]:
    """Levels [c] of an input between its median size and its largest, and by how much it exceeds
    them at the rows of an axis [n, c], with its sign.
    """
    sizes = _sizes(space, column)
    levels = np.linspace(float(np.median(sizes)), float(sizes.max()), LEVELS + 1)[:-1]
    tables = []
    for run in space.runs:
        x = run.held_inputs[:, [column]]
        tables.append(np.sign(x) * np.maximum(np.abs(x) - levels, 0.0))
    return levels, _averaged(space, axis, tables)


def _response(space: EquationSpace, p: FloatArray, column: int) -> FloatArray:
    """All rows [n] at p [np] with one unit more of an input."""
    added = []
    for rows in space.rows_of:
        table = np.zeros((len(rows.grid), len(space.model.input_names) + len(space.layout.further)))
        table[:, column] = 1.0
        added.append(table)
    return space.rows(p, added)


def change_at_one_time(logs: Sequence[LogRows]) -> Change | None:
    """The time at which the residual of nearly all logs steps, or follows motion or inputs
    differently from then on (a payload that is taken off), where their inputs do not change.

    Every log has its own test for one change of one coefficient at an unknown time (Andrews, 1993),
    at 5 % over all of them; the times have to agree more closely than 1 % of
    independent ones would (binomial). Blind where fewer than three logs reach the time.
    """
    duration = max((float(np.ptp(log.time)) for log in logs), default=0.0)
    near = APART * duration
    found = [change_of(log.time, log.left, log.beside, LOOKED) for log in logs]
    times = [each for each in found if each is not None]
    best: Change | None = None
    for centre, _, _ in times:
        reach = [
            log
            for log in logs
            if trimmed(log.time, TRIM)[0] <= centre <= trimmed(log.time, TRIM)[1]
        ]
        close = [each for each in times if abs(each[0] - centre) <= near]
        share = np.mean(
            [min(2.0 * near / max(np.ptp(trimmed(r.time, TRIM)), 1e-300), 1.0) for r in reach]
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


def _inputs_change(logs: Sequence[LogRows], centre: float, near: float) -> bool:
    """Whether the size of an input steps at the time in more than half of the logs."""
    for column in range(logs[0].input.shape[1]):
        sizes = [np.abs(log.input[:, column]) for log in logs]
        steps = [
            change_of(log.time, size, np.ones((len(size), 1)), LOOKED)
            for log, size in zip(logs, sizes, strict=True)
        ]
        if np.mean([s is not None and abs(s[0] - centre) <= near for s in steps]) > MOST:
            return True
    return False


def resonance(runs: Sequence[Recorded]) -> Resonance | None:
    """The frequency of a peak in the residual spectra of most logs that their inputs do not have.

    Log power over a straight line through its surroundings in log frequency, minus what the input
    has of the same, exceeds its 95 % quantile (Welch, 1967) and a factor of two; the number of logs
    is tested by the binomial law at 1 % over all frequencies. Blind where all logs move at one
    speed: a line locked to the angle would look the same.
    """
    durations = [len(r.left) * r.period for r in runs]
    if not durations:
        return None
    length = SEGMENT_TIME if np.median(durations) >= 2.0 * SEGMENT_TIME else 0.5 * SEGMENT_TIME
    logs = list(dict.fromkeys(r.log for r in runs))
    found = [_spectrum([r for r in runs if r.log == log], length) for log in logs]
    spectra = [f for f in found if f is not None]
    if len(spectra) < 3:
        return None
    shared = min(len(s[0]) for s in spectra)  # up to the coarsest sampling
    frequency = spectra[0][0][:shared]
    excess = np.array(
        [s[1][:shared] for s in spectra]
    )  # nan where noise or an input covers the residual
    quantile = np.array([s[2] for s in spectra])
    shown = excess > np.maximum(quantile, DOUBLED)[:, None]
    count, seen = shown.sum(axis=0), np.isfinite(excess).sum(axis=0)
    chance = stats.binom.sf(count - 1, seen, 1.0 - 0.95) * np.sum(seen >= 3)
    usable = (count >= 3) & (count > MOST * seen) & (chance <= TEST_ALARM)
    if not usable.any():
        return None
    middle = np.nanmedian(np.where(usable, excess, 0.0), axis=0)
    best = int(np.argmax(np.where(usable, middle, 0.0)))
    speeds = np.array([s[3] for s, own in zip(spectra, shown[:, best], strict=True) if own])
    if not speeds.max() > SPEEDS_APART * speeds.min():
        return None
    power = float(np.exp(middle[best]))
    return Resonance(float(frequency[best]), power, int(count[best]), int(seen[best]))


def _spectrum(
    runs: Sequence[Recorded], length: float
) -> tuple[FloatArray, FloatArray, float, float] | None:
    """Frequencies [f] in Hz, excess [f] in log power of the residual of one log over its
    background and its inputs, the 95 % quantile of that of noise, and the usual speed in rad/s;
    None without a segment of `length` s.
    """
    period = runs[0].period
    samples = round(length / period)
    own = [r for r in runs if len(r.left) >= samples]
    if not own:
        return None
    weight = np.array([2 * len(r.left) // samples - 1 for r in own], dtype=np.float64)
    tables = [np.column_stack([r.left, r.input]) for r in own]
    every = [signal.welch(t, 1.0 / period, "hann", samples, axis=0)[1] for t in tables]
    frequency = np.asarray(np.fft.rfftfreq(samples, period), dtype=np.float64)
    power = np.einsum("k,kfc->fc", weight / weight.sum(), np.array(every))
    noise = float(np.mean([r.noise**2 for r in own]))
    over = _over_background(frequency, np.log(np.maximum(power, 1e-300)))
    residual, given = over[:, 0], over[:, 1:]
    covered = power[:, 0] < ABOVE_FLOOR * 2.0 * period * noise
    count = float(np.nan_to_num(runs[0].count))  # at one speed, all rounding is in one line
    covered |= power[:, 0] * HANN_WIDTH / length < (ROUNDING * count) ** 2
    covered |= np.any(given > DOUBLED, axis=1)
    degrees = 2.0 * weight.sum() / (1.0 + 2.0 / 36.0)  # halves of Hann windows share a sixth
    quantile = float(np.log(stats.chi2.ppf(0.95, degrees) / stats.chi2.median(degrees)))
    inside = np.isfinite(residual)
    excess = np.where(covered, np.nan, residual)
    moved = [np.std(np.diff(r.measured[:: max(samples // 20, 1)])) for r in own]
    speed = float(np.median(moved) / (max(samples // 20, 1) * period))
    return frequency[inside], excess[inside], quantile, speed


def _over_background(frequency: FloatArray, power: FloatArray) -> FloatArray:
    """Log power [f, c] minus a straight line in log frequency through what lies within a factor of
    BACKGROUND, without the line itself (least absolute deviations, by weights in turn; an octave
    counts alike at all frequencies); nan at the ends.
    """
    result = np.full(power.shape, np.nan)
    place = np.log(np.maximum(frequency, 1e-300))
    lowest = BACKGROUND * max(LEAST_CYCLES - 1, 1) * frequency[1]
    for k in np.flatnonzero((frequency >= lowest) & (BACKGROUND * frequency <= frequency[-1])):
        far = np.abs(place - place[k])
        near = (far < 1.001 * np.log(BACKGROUND)) & (far > np.log(CORE))
        x, y = (place[near] - place[k])[:, None], power[near]
        octave = 1.0 / frequency[near][:, None]
        weight = octave * np.ones_like(y)
        for _ in range(CYCLES):
            weight = weight / weight.sum(axis=0)
            middle, mean = np.sum(weight * x, axis=0), np.sum(weight * y, axis=0)
            apart = x - middle
            slope = np.sum(weight * apart * y, axis=0) / np.sum(weight * apart**2, axis=0)
            away = np.abs(y - mean - slope * apart)
            weight = octave / np.maximum(away, MATERIAL)
        result[k] = power[k] - (mean - slope * middle)
    return result


def lost_motion(runs: Sequence[Recorded]) -> LostMotion | None:
    """How far the measured angle stays behind the model after every reversal.

    The residual is a line in the angle before the joint turns back and another after it moves
    again; their distance at the turning point is the lag. Friction that is wrong by direction
    bends the residual there and has no such distance. Significant by Student's one-sided test at
    0.1 % where half of all lags lie within half the median: a shaft or stiction lags by the torque.
    """
    every = [(run.log, lag) for run in runs for lag in _lags(run)]
    lags = np.array([lag for _, lag in every])
    if len(lags) < LEAST_REVERSALS or len({log for log, _ in every}) < 2:
        return None
    middle = float(np.median(lags))
    lower, upper = np.quantile(lags, [0.25, 0.75])
    error = float((upper - lower) / 1.349 * np.sqrt(0.5 * np.pi / len(lags)))
    statistic = float(np.mean(lags) / max(np.std(lags, ddof=1), 1e-300) * np.sqrt(len(lags)))
    significant = statistic > float(stats.t.ppf(1.0 - REVERSAL_ALARM, len(lags) - 1))
    clear = max(_clear(r) for r in runs)
    if not significant or upper - lower >= MOST * middle or middle < clear:
        return None
    return LostMotion(middle, error, len(lags))


def _clear(run: Recorded) -> float:
    """The distance in rad that no noise and no rounding of two samples of an angle reaches."""
    return 2.0 * FAR * max(run.noise, ROUNDING * float(np.nan_to_num(run.count)))


def _lags(run: Recorded) -> list[float]:
    """Lag in rad of the measured motion at every reversal of a run with enough motion about it."""
    angle, span = run.measured, round(LEG / run.period)
    clear = _clear(run)
    turns = _turning_points(angle, clear)
    ends = [0, *(turn for turn, _, _ in turns), len(angle) - 1]
    found = []
    for k, (turn, moving, way) in enumerate(turns):
        apart = np.flatnonzero(np.abs(angle[ends[k] : turn] - angle[turn]) > clear)
        if not apart.size:
            continue
        stopped = ends[k] + int(apart[-1])
        legs = [
            slice(max(ends[k], stopped - span), stopped + 1),
            slice(moving, min(ends[k + 2], moving + span) + 1),
        ]
        at = [_at_turn(angle[leg] - angle[turn], run.left[leg], clear) for leg in legs]
        if np.all(np.isfinite(at)):
            found.append(-way * (at[1] - at[0]))
    return found


def _at_turn(travel: FloatArray, left: FloatArray, clear: float) -> float:
    """Residual of a leg at the turning point, by a straight line in its `travel` [n] in rad; nan
    where the leg is short.
    """
    if len(travel) < LEG_SAMPLES or np.ptp(travel) < LEAST_CYCLES * clear:
        return float("nan")
    slope = np.cov(travel, left)[0, 1] / np.var(travel, ddof=1)
    return float(left.mean() - slope * travel.mean())


def _turning_points(angle: FloatArray, clear: float) -> list[tuple[int, int, float]]:
    """Sample of every turning point of an angle [n], that by which the joint is `clear` rad away
    from it, and the direction of travel after it.
    """
    found: list[tuple[int, int, float]] = []
    way, furthest = 0.0, 0
    for k, x in enumerate(angle):
        if way == 0.0:
            if abs(x - angle[0]) > clear:
                way, furthest = float(np.sign(x - angle[0])), k
        elif way * (x - angle[furthest]) > 0.0:
            furthest = k
        elif way * (angle[furthest] - x) > clear:
            found.append((furthest, k, -way))
            way, furthest = -way, k
    return found


def input_ceiling(
    left: FloatArray, beside: FloatArray, levels: FloatArray, beyond: FloatArray, acts: float
) -> Ceiling | None:
    """The level of |input| beyond which the input adds nothing to the rows, whose residual is
    `left` [n]; an input of one unit changes a row by `acts`.

    `beyond` [n, c] is by how much the input exceeds each of the `levels` [c], with its sign. Its
    coefficient beside columns [n, m] (input, its square, motion) is that of a ceiling within a
    factor of two (of such levels, the closest), significant by F at 1 % over all levels, the
    residual an AR(1), and it reduces the sum of squares beyond the level by half.
    """
    table = projected_off(np.column_stack([left, beyond]), beside)
    rest = table[:, 0]
    best, closest = None, np.inf
    for level, step, excess in zip(levels, table[:, 1:].T, beyond.T, strict=True):
        over, square = np.abs(excess) > 0.0, float(step @ step)
        if over.sum() < ROWS_PER_WINDOW or square <= SHOWS_ALONE * float(excess @ excess):
            continue
        size = float(step @ rest) / square
        after = rest - size * step
        noise, independent = long_run(after)
        degrees = independent - beside.shape[1] - 2.0
        if size * acts <= 0.0 or degrees < 1.0:
            continue
        off = abs(float(np.log(size / acts)))
        statistic = size**2 * square / max(noise, 1e-300)
        reduced = 1.0 - float(np.sum(after[over] ** 2) / np.sum(rest[over] ** 2))
        chance = len(levels) * float(stats.f.sf(statistic, 1.0, degrees))
        if off < min(closest, DOUBLED) and chance <= TEST_ALARM and reduced >= MOST:
            closest = off
            best = Ceiling(float(level), float(np.max(np.abs(excess))))
    return best
