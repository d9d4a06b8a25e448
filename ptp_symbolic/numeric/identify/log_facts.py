"""What a log holds, before any model is fitted: its clock, its signals, how the machine moved."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from ptp_symbolic.numeric.identify.constants import FAR, LEAST_START, START_SPAN
from ptp_symbolic.numeric.identify.noise import Correlation, neighbour_correlation, white_noise
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]


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
