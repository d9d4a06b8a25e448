"""A run prepared for fitting: inputs as tables, measured signals with weights, unknown initial
states.

The rate of a joint at the first sample of a run or window is estimated from the angles around it.
Runs have variants with other inputs or fewer samples, and inputs averages over parts of samples.
"""

import itertools
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.latency import input_averages
from ptp_symbolic.numeric.identify.constants import (
    ANYWHERE,
    DEVIATIONS,
    FAR,
    LEAST_START,
    LITTLE,
    ROUNDING,
    SAME,
    START_SPAN,
)
from ptp_symbolic.numeric.identify.evidence import Work
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import (
    InputSignal,
    InputTable,
    delayed,
    sampled_signals,
    stack,
    table,
    values_at,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def has_angle(signals: Collection[str], rate: str) -> bool:
    """Whether the angle of a joint is among the `signals` beside its `rate`, omega_<axis>."""
    return rate.replace("omega_", "theta_", 1) in signals


def refuse_unseen_angles(model: Model, signals: Collection[str]) -> None:
    """Raise InputError where an axis of `model` has its rate among `signals` and not its angle,
    though the angle acts on the motion at the default parameters: a run could begin anywhere.
    """
    states = list(model.state_names)
    at_zero, still = np.zeros(len(states)), np.zeros(len(model.input_names))
    p = model.parameter_vector()
    for axis in model.module.AXES:
        if f"omega_{axis}" not in signals or has_angle(signals, f"omega_{axis}"):
            continue
        turned = at_zero.copy()
        for name in (f"theta_{axis}", f"theta_gear_{axis}"):
            if name in states:
                turned[states.index(name)] = 1.0
        before, after = (model.rhs(0.0, x, still, p) for x in (at_zero, turned))
        if not np.allclose(before, after, rtol=1e-9, atol=1e-12):
            raise InputError(
                f"Axis '{axis}' has a rate and no angle among its signals, and its motion depends"
                f" on the angle; measure the angle too and declare [signals.theta_{axis}]."
            )


@dataclass(frozen=True, eq=False)
class Around:
    """The whole log of a window: time [n] in s and measured [n, ny], and its `first` sample; of a
    run the log is the run itself.
    """

    time: FloatArray
    measured: FloatArray
    first: int


def first_rate(around: Around, column: int, sigma: float, count: float) -> tuple[float, float]:
    """Rate at the first sample and its standard deviation (rad/s or m/s), from an angle whose noise
    is `sigma`, rounding of a `count` (nan: none) included.

    A local parabola gives it, over the longest span up to a tenth of a second that agrees with all
    shorter ones: where friction breaks away, a longer one bends the wrong way (intersection of
    confidence intervals: Goldenshluger and Nemirovski, 1997). Its error is that of the noise, and
    the difference to a cubic.
    """
    time = around.time - around.time[around.first]
    low, high, found = -np.inf, np.inf, (0.0, np.inf)
    for part in _spans(time, around.first):
        values = around.measured[part, column]
        rate, noise = _rate_over(time[part], values, 2, sigma, count)
        other, _ = _rate_over(time[part], values, 3, sigma, count)
        error = float(np.hypot(noise, other - rate))
        low = max(low, rate - DEVIATIONS * error)
        high = min(high, rate + DEVIATIONS * error)
        if low > high:
            break
        found = rate, error
    return found


def _spans(time: FloatArray, first: int) -> list[slice]:
    """Samples around the first one, or after it where nothing comes before; each span is twice as
    long as the one before it, the last one START_SPAN.
    """
    ahead = int(np.searchsorted(time, START_SPAN if first == 0 else 0.5 * START_SPAN)) - first
    least = LEAST_START if first == 0 else LEAST_START // 2
    doubled = itertools.takewhile(lambda n: n < ahead, (least * 2**k for k in itertools.count()))
    lengths = [*doubled, max(least, ahead)]
    if first == 0:
        return [slice(0, n) for n in lengths]
    return [slice(max(0, first - n), first + n + 1) for n in lengths]


def _rate_over(
    time: FloatArray, values: FloatArray, degree: int, sigma: float, count: float
) -> tuple[float, float]:
    """Rate at time zero by a polynomial, and its standard deviation: noise as if white, rounding as
    if it were the same in half of the samples.
    """
    longest = float(np.max(np.abs(time)))
    even = (time / longest).round(9)  # stamps are not even to the last bit
    slope = _slope(even.tobytes(), degree)
    rate = float(slope @ values) / longest
    rounding = float(np.nan_to_num(count)) * ROUNDING
    white = np.sqrt(max(sigma**2 - rounding**2, 0.0)) * float(np.linalg.norm(slope))
    return rate, float(np.hypot(white, 2.0 * rounding)) / longest


@lru_cache(maxsize=4096)
def _slope(times: bytes, degree: int) -> FloatArray:
    """The functional [n] that gives the slope at zero of the polynomial through values at `times`,
    the bytes of n numbers; windows of an evenly sampled log share it.
    """
    columns = np.vander(np.frombuffer(times), degree + 1, increasing=True)
    slope: FloatArray = np.linalg.pinv(columns)[1]
    return slope


WINDOW = "#"  # in the name of a window, between that of its log and its number


@dataclass(frozen=True)
class StartUnknown:
    """One unknown of the state at the start of a run.

    `tangent` [n] is the derivative of the start by the unknown; a `contact` index says that the
    unknown is the place in that gap, from -1 (lower face) to 1 (upper face), and beyond where the
    shaft is wound up; `column` is the measured angle of the joint behind it. `sigma` is that of its
    prior. A search begins at `guess`, and may begin at other values `instead`: at rest, or turning
    back. All are in rad or rad/s (m or m/s of a linear joint), places in half gaps.
    """

    name: str
    tangent: FloatArray
    lower: float
    upper: float
    sigma: float
    contact: int | None = None
    column: int | None = None
    instead: tuple[float, ...] = ()
    guess: float = 0.0


class ActingInputs(NamedTuple):
    """Inputs as a run takes them: their `table`, the times in s at which steps end, and the values
    [k, nu] at its samples.
    """

    table: InputTable
    stops: FloatArray
    values: FloatArray


@dataclass(frozen=True, eq=False)
class Run:
    """One run or window: time [k] in s, inputs [k, nu], measured [k, ny], `weight` [ny] (1/sigma).

    `source` is the name of the log that it is of, its own `name` that or one for the window alone.
    `outputs` [ny] gives the model output of every measured column, `counts` [ny] the size of one
    encoder count in rad or m (nan for analog signals); `start` [n] guesses the state at the first
    sample. `held_inputs` are the inputs at the samples, and `interpolations` [nu] tell what they
    are from one to the next: "hold" or "linear" (empty: all are held). In a window, `before` [nu]
    is what the inputs were until then.
    `work` counts what is simulated of it and of its windows.
    """

    name: str
    source: str
    time: FloatArray
    inputs: InputTable
    held_inputs: FloatArray
    measured: FloatArray
    outputs: NDArray[np.int64]
    weight: FloatArray
    counts: FloatArray
    signals: tuple[str, ...]
    start: FloatArray
    unknowns: tuple[StartUnknown, ...]
    before: FloatArray | None = None
    interpolations: tuple[str, ...] = ()
    work: Work = field(default_factory=Work)

    @property
    def evidence_parts(self) -> tuple[Any, ...]:
        """All that a simulation of it depends on, and what it is compared with."""
        return tuple(getattr(self, f.name) for f in fields(self) if f.name != "work")

    def interpolation(self, column: int) -> str:
        """What the input of that `column` is between its samples."""
        return self.interpolations[column] if self.interpolations else "hold"

    @cached_property
    def stops(self) -> FloatArray:
        """Times [s] in s of the samples, and of the jumps of delayed inputs in between."""
        return self.inputs.with_stops(self.time)

    def acting_inputs(self, delays: FloatArray) -> "ActingInputs":
        """The inputs, each late by its own of `delays` [nu] in s; the last ones are kept, for a fit
        seldom changes them.
        """
        if not delays.any():
            return ActingInputs(self.inputs, self.stops, self.held_inputs)
        key = delays.tobytes()
        known: tuple[bytes, ActingInputs] | None = vars(self).get("_acting_inputs")
        if known is None or known[0] != key:
            table = delayed(self.inputs, delays)
            late = ActingInputs(table, table.with_stops(self.time), values_at(table, self.time))
            vars(self)["_acting_inputs"] = known = key, late
        return known[1]

    @property
    def size(self) -> int:
        """Number of residuals, k * ny."""
        return int(self.measured.size)

    @property
    def guess(self) -> FloatArray:
        """Values of the unknowns [nz] at which a search begins."""
        return np.array([unknown.guess for unknown in self.unknowns])

    @property
    def guesses(self) -> list[FloatArray]:
        """The guess, and the others, each [nz], at which a search may begin."""
        starts = [self.guess]
        for index, unknown in enumerate(self.unknowns):
            for value in unknown.instead:
                shifted = self.guess
                shifted[index] = value
                starts.append(shifted)
        return starts


def with_start(
    model: Model, run: Run, around: Around | None = None, *, underway: bool = False
) -> Run:
    """`run` with a guess of the state at its first sample, and what is unknown of it.

    A joint with dry friction whose rate is within its noise is taken to be at rest where a log
    begins, and may be where it is near that. A moving joint is driven: its gear touches the face
    ahead and has wound up the shaft, nobody knows by how much; or it crosses its gap, at anything
    between standstill and twice the rate of the joint. In a window (`around` it is the rest of a
    log), and of one that is `underway` after a gap in the log, the shaft may be wound up at rest
    too, and the joint may move or turn back within its noise. A whole run may begin with a shaft
    that friction holds twisted (see `_twists`).
    """
    wound = underway or around is not None
    states = list(model.state_names)
    start = np.array(model.module.STATE_INITIAL, dtype=np.float64)
    friction_rates = {states[i] for i in model.friction_rates}
    unknowns: list[StartUnknown] = []
    spread: dict[str, float] = {}  # of the rate of a joint that is not taken to be at rest
    for column, signal in enumerate(run.signals):
        if f"shown_{signal}" in states:
            start[states.index(f"shown_{signal}")] = run.measured[0, column]
        if signal not in states:
            continue
        axis = signal.removeprefix("theta_")
        if signal.startswith("omega_"):
            if not has_angle(run.signals, signal):
                rates = [n for n in (signal, f"omega_gear{signal[5:]}") if n in states]
                start[[states.index(name) for name in rates]] = run.measured[0, column]
                sigma = 1.0 / run.weight[column]
                spread[signal] = float(np.hypot(run.measured[0, column], sigma))
                unknowns.append(_unknown(states, signal, rates, ANYWHERE, sigma))
            continue
        if axis == signal or f"omega_{axis}" not in states:
            start[states.index(signal)] = run.measured[0, column]
            continue
        sigma = 1.0 / run.weight[column]
        log = around or Around(run.time, run.measured, 0)
        rate, error = first_rate(log, column, sigma, float(run.counts[column]))
        angles = [name for name in (signal, f"theta_gear_{axis}") if name in states]
        rates = [name for name in (f"omega_{axis}", f"omega_gear_{axis}") if name in states]
        start[[states.index(name) for name in angles]] = run.measured[0, column]
        limit = 10.0 * sigma
        unknowns.append(_unknown(states, signal, angles, limit, sigma))
        may_rest = bool(friction_rates & set(rates))
        if may_rest and not wound and _stays(run, column):
            continue
        start[[states.index(name) for name in rates]] = rate
        spread[rates[0]] = float(np.hypot(rate, error))
        instead = (-rate, -2.0 * rate) if may_rest and abs(rate) <= 3.0 * FAR * error else ()
        unknowns.append(_unknown(states, rates[0], rates, ANYWHERE, error, instead))
    for contact, (gear, joint) in enumerate(model.module.CONTACT_ANGLES):
        tangent = np.zeros(len(states))
        tangent[gear] = 1.0
        joint_rate = states[joint].replace("theta_", "omega_", 1)
        rate = start[states.index(joint_rate)]
        seen = run.signals.index(states[joint]) if states[joint] in run.signals else None
        winds_up = (wound or rate != 0.0) and model.contacts[contact, 0] == 0
        reach = ANYWHERE if winds_up else 1.0
        if joint_rate in spread:
            turning = states[gear].replace("theta_", "omega_", 1)
            unknowns.append(_unknown(states, turning, [turning], ANYWHERE, spread[joint_rate]))
        unknowns.append(
            StartUnknown(
                f"gap_place_{contact}",
                tangent,
                -reach,
                reach,
                reach,
                contact,
                seen,
                guess=float(np.sign(rate)),
            )
        )
    if around is None:
        unknowns += _twists(model, run)
    if around is not None:
        for state, signal in _memories_of_rest(model):
            if signal in run.signals:
                start[state] = _rest_so_far(run, run.signals.index(signal), around)
    return replace(run, start=start, unknowns=tuple(unknowns))


def _twists(model: Model, run: Run) -> list[StartUnknown]:
    """The angles of gears ahead of joints that are measured, where dry friction behind a shaft can
    hold it twisted: by a small share of the range of the joint. Free to be more, it takes up what
    else is missing, and leads a fit astray. A shaft with a gap may have none: a place in that holds
    no twist then.
    """
    states, found = list(model.state_names), []
    apart = {
        states[gear]
        for contact, (gear, _) in enumerate(model.module.CONTACT_ANGLES)
        if model.contacts[contact, 0] != 0
    }
    held = {states[rate].replace("omega_", "theta_gear_", 1) for rate in model.friction_rates}
    for column, signal in enumerate(run.signals):
        gear = signal.replace("theta_", "theta_gear_", 1)
        if signal.startswith("theta_") and gear in states and gear in held - apart:
            share = SAME * float(np.ptp(run.measured[:, column]))
            twist = max(share, 10.0 / float(run.weight[column]))
            found.append(_unknown(states, gear, [gear], 100.0 * twist, twist))
    return found


def _memories_of_rest(model: Model) -> list[tuple[int, str]]:
    """States that friction sets to zero as its joint comes to rest, and the angle of that."""
    names = model.state_names
    rates = {k: names[rate] for k, rate in enumerate(model.friction_rates)}
    return [
        (state, rates[friction].replace("omega_", "theta_", 1).replace("_gear_", "_", 1))
        for state, friction in enumerate(model.zero_at_rest)
        if friction >= 0
    ]


def _rest_so_far(run: Run, column: int, around: Around) -> float:
    """Time in s for which a signal has stayed within its noise before the window begins."""
    values = around.measured[: around.first + 1, column]
    away = np.flatnonzero(np.abs(values - values[-1]) > FAR / run.weight[column])
    since = int(away[-1]) + 1 if away.size else 0
    return float(around.time[around.first] - around.time[since])


def _start_samples(run: Run) -> int:
    """How many samples at the beginning of a run its start is guessed from."""
    return max(LEAST_START, int(np.searchsorted(run.time, run.time[0] + START_SPAN)))


def _stays(run: Run, column: int) -> bool:
    """Whether a signal stays within its noise at the start of a run."""
    return (
        float(np.ptp(run.measured[: _start_samples(run), column])) <= 2.0 * FAR / run.weight[column]
    )


def _unknown(
    states: list[str],
    name: str,
    carried: list[str],
    limit: float,
    sigma: float,
    instead: tuple[float, ...] = (),
) -> StartUnknown:
    tangent = np.zeros(len(states))
    tangent[[states.index(c) for c in carried]] = 1.0
    return StartUnknown(name, tangent, -limit, limit, sigma, instead=instead)


def with_inputs(run: Run, values: NDArray[np.float64]) -> Run:
    """`run` with the inputs `values` [k, nu] at its samples."""
    held = np.ascontiguousarray(values)
    signals = [table(run.time, c, run.interpolation(k)) for k, c in enumerate(held.T)]
    return replace(run, inputs=stack(signals), held_inputs=held)


def by_source(runs: Sequence[Run]) -> list[list[int]]:
    """Indices of the runs, the windows of one run together."""
    grouped: dict[str, list[int]] = {}
    for index, run in enumerate(runs):
        grouped.setdefault(run.source, []).append(index)
    return list(grouped.values())


def by_log(runs: Sequence[Run], parts: Sequence[FloatArray]) -> list[FloatArray]:
    """What belongs to every run, rows [k, ...], one after the other for the runs of each log."""
    return [np.concatenate([parts[k] for k in group]) for group in by_source(runs)]


def sizes(runs: Sequence[Run]) -> FloatArray:
    """Number of samples of every run [runs]."""
    return np.array([len(run.time) for run in runs], dtype=np.float64)


def cell_averages(run: Run, column: int, delay: float, grid: IntArray) -> FloatArray:
    """An input [g], delayed by `delay` s, averaged over the cell around every sample of a `grid`
    [g].
    """
    return _averages(run, column, _cell_edges(run.time[grid]) - delay)


def _cell_edges(time: FloatArray) -> FloatArray:
    """Edges [n + 1] in s of the cells around every one of the times [n] in s."""
    middle = 0.5 * (time[1:] + time[:-1])
    return np.concatenate(
        [[1.5 * time[0] - 0.5 * time[1]], middle, [1.5 * time[-1] - 0.5 * time[-2]]]
    )


def part_averages(run: Run, column: int, delay: float, parts: int) -> FloatArray:
    """An input, delayed by `delay` s, averaged over equal parts of every sample [k - 1, parts]."""
    shares = np.arange(parts) / parts
    edges = run.time[:-1, None] + np.diff(run.time)[:, None] * shares
    flat = np.append(edges.ravel(), run.time[-1])
    return _averages(run, column, flat - delay).reshape(-1, parts)


def _averages(run: Run, column: int, edges: FloatArray) -> FloatArray:
    """Averages [m] of an input between neighbouring `edges` [m + 1] in s."""
    between = run.interpolation(column)
    return input_averages(run.time, run.held_inputs[:, column], edges, between)


def usual_period(runs: Sequence[Run]) -> float:
    """Sampling period in s of most samples of some runs."""
    return float(np.median(np.concatenate([np.diff(run.time) for run in runs])))


def samples_within(run: Run, period: float) -> int:
    """How many samples of `run` come within `period` s, at least one."""
    return max(1, int(period / usual_period((run,)) + 1e-6))


def thinned(run: Run, every: int) -> Run:
    """`run` with the first of `every` so many samples, the inputs averaged in between. Inputs that
    are held jump where they did: a step that comes half a sample late moves an angle by counts.
    """
    if every < 2:
        return run
    kept = np.arange(0, len(run.time), every)
    time = np.ascontiguousarray(run.time[kept])
    return replace(
        run,
        time=time,
        measured=np.ascontiguousarray(run.measured[kept]),
        held_inputs=np.ascontiguousarray(run.held_inputs[kept]),
        inputs=stack(
            [
                _fewer(
                    signal.breaks[:-1], signal.coefficients[:, 0], time, run.interpolation(column)
                )
                for column, signal in enumerate(sampled_signals(run.inputs))
            ]
        ),
    )


def _fewer(
    times: FloatArray, values: FloatArray, edges: FloatArray, interpolation: str
) -> InputSignal:
    """An input averaged around `edges` in s, or, where it is held, between them and the jumps that
    stand out: beyond noise and slope, and a material share of its range.
    """
    if interpolation == "linear":
        means = input_averages(times, values, _cell_edges(edges), interpolation)
        return table(edges, means, interpolation)
    rise = np.abs(np.diff(values))
    usual = float(np.median(rise) / stats.norm.ppf(0.75)) if rise.size else 0.0
    jumps = times[1:][rise > max(FAR * usual, LITTLE * float(np.ptp(values)))]
    at = np.union1d(edges, jumps[(jumps > edges[0]) & (jumps < edges[-1])])
    last = values[max(0, int(np.searchsorted(times, edges[-1], side="right")) - 1)]
    return table(at, np.append(input_averages(times, values, at), last))


def grid_averages(values: FloatArray, grid: IntArray) -> FloatArray:
    """Averages [g, v] of `values` [k, v] over the samples nearest to every one of the grid."""
    edges = np.concatenate([[0], (grid[1:] + grid[:-1] + 1) // 2, [len(values)]])
    return np.add.reduceat(values, edges[:-1], axis=0) / np.diff(edges)[:, None]
