"""Logs made into runs: matched to the model, parted at gaps, with the noise of every signal; and
what a log holds before any model is fitted: its clock, its signals, how the machine moved.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.data.latency import jumps, parted, pauses
from ptp_symbolic.numeric.identify.constants import FAR, LEAST_START, ROUNDING, START_SPAN
from ptp_symbolic.numeric.identify.evidence import Work
from ptp_symbolic.numeric.identify.noise import Correlation, neighbour_correlation, white_noise
from ptp_symbolic.numeric.identify.run import WINDOW, Run, refuse_unseen_angles, with_start
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import stack, table
from ptp_symbolic.platform import Platform, SignalDeclaration

FloatArray = NDArray[np.float64]


def prepare_runs(
    model: Model, platform: Platform, logs: Sequence[Log], work: Work | None = None
) -> tuple[Run, ...]:
    """Match the columns of `logs` to `model` and guess the start of every run; a gap in a log ends
    one run and begins another. What is simulated of them is counted in `work`.

    Raises InputError when the platform's signals do not fit the model or one has no noise.
    """
    given = [s for s in platform.signals if s.role == "input"]
    outputs = [s for s in platform.signals if s.role == "output"]
    for wanted, found, what in (
        (model.input_names, {s.signal for s in given}, "input"),
        ({s.signal for s in outputs}, set(model.output_names), "output"),
    ):
        missing = [name for name in wanted if name not in found]
        if missing:
            raise InputError(
                f"No {what} signal '{missing[0]}' to pair with; "
                f"the model has inputs {', '.join(model.input_names)} and outputs"
                f" {', '.join(model.output_names)}; declare it under [signals.{missing[0]}]."
            )
    refuse_unseen_angles(model, [s.signal for s in outputs])
    order = [[s.signal for s in given].index(name) for name in model.input_names]
    between = tuple(given[k].between_samples for k in order)
    counts = np.array([np.nan if s.count is None else s.count for s in outputs])
    sigma = np.array(
        [
            _sigma(s, q, [white_noise(log.outputs[:, k], log.time) for log in logs])
            for k, (s, q) in enumerate(zip(outputs, counts, strict=True))
        ]
    )
    work = Work() if work is None else work
    return tuple(
        _prepare(
            model,
            outputs,
            piece,
            order,
            between,
            counts,
            sigma,
            log.name,
            work,
            underway=number > 0,
        )
        for log in logs
        for number, piece in enumerate(_pieces(log, counts))
    )


def _pieces(log: Log, counts: FloatArray) -> list[Log]:
    """The parts of a log between its gaps, and the jumps of its encoders, named as windows of it.
    `counts` [ny] are the resolutions of the encoders.
    """
    jumped = [
        jumps(column, log.time, count)
        for column, count in zip(log.outputs.T, counts, strict=True)
        if np.isfinite(count)
    ]
    parts = parted(log.time, np.unique(np.concatenate([pauses(log.time), *jumped])))
    if len(parts) == 1:
        return [log]
    return [
        replace(
            log,
            name=f"{log.name}{WINDOW}{number}",
            time=log.time[part],
            inputs=log.inputs[part],
            outputs=log.outputs[part],
        )
        for number, part in enumerate(parts, start=1)
    ]


def _prepare(
    model: Model,
    outputs: Sequence[SignalDeclaration],
    log: Log,
    order: list[int],
    between: tuple[str, ...],
    counts: FloatArray,
    sigma: FloatArray,
    source: str,
    work: Work,
    *,
    underway: bool,
) -> Run:
    steps = log.steps or [(log.time, column) for column in log.inputs.T]
    run = Run(
        name=log.name,
        source=source,
        time=np.ascontiguousarray(log.time),
        inputs=stack(
            [table(steps[k][0], steps[k][1], b) for k, b in zip(order, between, strict=True)]
        ),
        held_inputs=np.ascontiguousarray(log.inputs[:, order]),
        measured=np.ascontiguousarray(log.outputs),
        outputs=np.array([model.output_names.index(s.signal) for s in outputs], dtype=np.int64),
        weight=1.0 / sigma,
        counts=counts,
        signals=tuple(s.signal for s in outputs),
        start=np.empty(0),
        unknowns=(),
        interpolations=between,
        work=work,
    )
    return with_start(model, run, underway=underway)


def _sigma(signal: SignalDeclaration, count: float, in_logs: Sequence[float]) -> float:
    """Standard deviation of a signal: rounding, and the declared noise or else that `in_logs`."""
    rounding = 0.0 if np.isnan(count) else count * ROUNDING
    noise = signal.noise
    if noise is None and rounding > 0.0:
        seen = float(np.median(in_logs))
        noise = float(np.sqrt(max(seen**2 - rounding**2, 0.0)))
    sigma = float(np.hypot(rounding, noise or 0.0))
    if sigma == 0.0:
        raise InputError(
            f"Signal '{signal.signal}' has neither {_resolution(signal.unit)} nor noise;"
            f" give its noise (rms) in {signal.unit}."
        )
    return sigma


def _resolution(unit: str) -> str:
    """What gives the resolution of an encoder whose signal has this unit."""
    return "counts_per_metre" if unit == "m" else "counts_per_revolution"


@dataclass(frozen=True)
class SignalFacts:
    """One signal of a log, in its unit: range, white noise (rms, of rounding too), the step between
    its levels (None where it has no few levels), and the share of samples at its ends.

    Of an angle or a position `resting` is the share of the time in which it stays within its noise
    for a tenth of a second, and `fastest` its largest rate per second over that span. Of an output
    `correlation` is that of its noise from sample to sample (None: too few samples).
    """

    name: str
    role: str
    lowest: float
    highest: float
    noise: float
    step: float | None
    at_ends: float
    correlation: Correlation | None = None
    resting: float | None = None
    fastest: float | None = None


@dataclass(frozen=True)
class LogFacts:
    """One log: samples, duration in s, rate in Hz by the median period, the periods' scatter as a
    share of it (rms), the longest period in s, and its signals.
    """

    name: str
    samples: int
    duration: float
    rate: float
    jitter: float
    longest_period: float
    signals: tuple[SignalFacts, ...]

    def as_dict(self) -> dict[str, Any]:
        """The facts as plain data."""
        return asdict(self)


def facts_of(run: Run, units: Mapping[str, str]) -> LogFacts:
    """What a whole run holds; `units` names its inputs [nu] in their order, and its signals."""
    periods = np.diff(run.time)
    period = float(np.median(periods))
    inputs = [name for name in units if name not in run.signals]
    signals = [
        _signal(name, "input", run.time, column)
        for name, column in zip(inputs, run.held_inputs.T, strict=True)
    ]
    span = max(LEAST_START, int(np.ceil(START_SPAN / period)))
    for name, column, weight in zip(run.signals, run.measured.T, run.weight, strict=True):
        if units[name] not in ("rad", "m"):
            signals.append(_signal(name, "output", run.time, column))
            continue
        reach = maximum_filter1d(column, span) - minimum_filter1d(column, span)
        resting = float(np.mean(reach <= 2.0 * FAR / weight))
        moved = np.abs(column[span:] - column[:-span]) / (run.time[span:] - run.time[:-span])
        fastest = float(np.max(moved)) if len(moved) else None
        signals.append(_signal(name, "output", run.time, column, resting, fastest))
    return LogFacts(
        run.name,
        len(run.time),
        float(run.time[-1] - run.time[0]),
        1.0 / period,
        float(np.sqrt(np.mean((periods / period - 1.0) ** 2))),
        float(np.max(periods)),
        tuple(signals),
    )


def _signal(
    name: str,
    role: str,
    time: FloatArray,
    column: FloatArray,
    resting: float | None = None,
    fastest: float | None = None,
) -> SignalFacts:
    low, high = float(column.min()), float(column.max())
    ends = float(np.mean((column == low) | (column == high))) if high > low else 1.0
    levels = np.unique(column)
    step = float(np.median(np.diff(levels))) if 1 < len(levels) <= len(column) // 2 else None
    noise = white_noise(column, time)
    colour = neighbour_correlation(column, time) if role == "output" else None
    return SignalFacts(name, role, low, high, noise, step, ends, colour, resting, fastest)
