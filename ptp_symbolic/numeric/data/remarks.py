"""Checks of logs before any fit: wrapped angles, excitation, saturation, gaps and jitter."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.latency import (
    BESIDE,
    LONE,
    LONG_PAUSE,
    Wraps,
    after_lost,
    jumps,
)
from ptp_symbolic.numeric.data.log import Log
from ptp_symbolic.platform import Platform, SignalDeclaration

FloatArray = NDArray[np.float64]

HALF_TURN = np.pi  # rad: no platform turns further from one sample to the next
FEW_COUNTS = 3.0  # of an encoder: an angle that stays within them did not move
SATURATED = 0.5  # share of the samples at the largest or smallest value of a signal that changes
FEW_LEVELS = 5  # of a signal that is switched
FASTEST = 50.0  # rad/s, 480 rpm: no joint of a platform turns as fast for long
OFTEN = 0.95  # share of the samples below the rate that is compared with it
WHOLE, MOST_WHOLE = 0.02, 0.99  # of a count: rounding of a written number; share of such samples
PLAIN = (2, 3, 4, 5, 8, 10)  # ratios of a count to the declared one that are looked for
JITTER = 0.2  # of the sampling period, rms


def refuse_wrapped_angles(logs: Sequence[Log], platform: Platform) -> None:
    """Raise InputError for an angle that jumps by over half a turn (pi rad) between samples."""
    for log in logs:
        for k, signal in enumerate(_outputs(platform)):
            step = np.diff(log.outputs[:, k])
            if signal.unit == "rad" and np.any(np.abs(step) > HALF_TURN):
                row = int(np.argmax(np.abs(step) > HALF_TURN)) + 1
                raise InputError(
                    f"{log.name}: '{signal.column}' jumps by {step[row - 1]:.4g} rad at"
                    f" {log.time[row]:.6g} s; at most half a turn is allowed from one sample to the"
                    " next: unwrap the angle, so that it goes on beyond a turn."
                )


def refuse_motionless(logs: Sequence[Log], platform: Platform) -> None:
    """Raise InputError where no angle or position of any log moves, peak to peak, by more than 3
    counts of its encoder and 6 standard deviations of its declared noise.
    """
    angles = [(k, s) for k, s in enumerate(_outputs(platform)) if s.is_position]
    if angles and not any(_moves(logs, k, s) for k, s in angles):
        names = " and ".join(f"'{s.column}'" for _, s in angles)
        verb = "stays" if len(angles) == 1 else "stay"
        raise InputError(
            f"{names} {verb} within {FEW_COUNTS:.0f} counts in all logs to be fitted; without"
            " motion nothing can be identified: give logs in which the machine moves."
        )


def remarks(logs: Sequence[Log], platform: Platform) -> tuple[str, ...]:
    """Warnings about the logs, one sentence each: motionless angles, constant inputs, saturated
    signals, gaps and jitter of the sampling, signals that were interpolated or thinned.
    """
    found = []
    outputs = _outputs(platform)
    inputs = [s for s in platform.signals if s.role == "input"]
    for k, signal in enumerate(outputs):
        if signal.is_position and not _moves(logs, k, signal):
            found.append(f"'{signal.column}' never moves: nothing can be identified of that axis.")
    if inputs and all(np.ptp(log.inputs[:, k]) == 0.0 for log in logs for k in range(len(inputs))):
        found.append(
            "No input changes within a run: what depends on the inputs is hardly identifiable."
        )
    for signal, columns in (
        *((s, [log.outputs[:, k] for log in logs]) for k, s in enumerate(outputs)),
        *((s, [log.inputs[:, k] for log in logs]) for k, s in enumerate(inputs)),
    ):
        share = _at_ends(np.concatenate(columns))
        if share > SATURATED:
            found.append(
                f"'{signal.column}' is at its largest or smallest value in {100 * share:.0f} % of"
                " the samples: it may be saturated, and the rest carries little information."
            )
    for log in logs:
        found += [_wrap_remark(log.name, wraps) for wraps in log.wraps]
        found += _clock_remarks(log)
        found += [t for k, s in enumerate(outputs) for t in _jump_remarks(log, k, s)]
        found += [t for k, s in enumerate(outputs) for t in _unit_remarks(log, k, s)]
        found += [t for k, s in enumerate(outputs) for t in _count_remarks(log, k, s)]
        found += [t for s in outputs for t in _interpolation_remarks(log, s)]
        found += [_thinning_remark(log.name, *thinned) for thinned in log.thinned.items()]
    return tuple(found)


def _outputs(platform: Platform) -> list[SignalDeclaration]:
    return [s for s in platform.signals if s.role == "output"]


def _moves(logs: Sequence[Log], column: int, signal: SignalDeclaration) -> bool:
    """Whether an angle or a position leaves its first values by more than rounding and noise."""
    still = max(FEW_COUNTS * (signal.count or 0.0), 2.0 * FEW_COUNTS * (signal.noise or 0.0))
    return any(float(np.ptp(log.outputs[:, column])) > still for log in logs)


def _at_ends(values: FloatArray) -> float:
    """Share of the samples at the largest or smallest value; none of a signal that only switches
    between a few levels, which is no saturation.
    """
    levels = np.unique(values)
    if len(levels) <= FEW_LEVELS:
        return 0.0
    return float(np.mean((values == levels[0]) | (values == levels[-1])))


def _jump_remarks(log: Log, column: int, signal: SignalDeclaration) -> list[str]:
    """Jumps of an encoder, after which a new window begins; else lone steps that stay: it was set
    anew, at an index mark, or lost counts.
    """
    if signal.count is None:
        return []
    cut = jumps(log.outputs[:, column], log.time, signal.count)
    if cut.size:
        size = abs(log.outputs[cut[0], column] - log.outputs[cut[0] - 1, column]) / signal.count
        more = f" and {cut.size - 1} more times" if cut.size > 1 else ""
        return [
            f"{log.name}: '{signal.column}' jumps by {size:.6g} counts at {log.time[cut[0]]:.6g} s"
            f"{more}; a new window begins there. Was the encoder reset, at an index?"
        ]
    step, period = np.abs(np.diff(log.outputs[:, column])), np.diff(log.time)
    rate = np.maximum(step, signal.count) / period
    beside = np.r_[np.ones(BESIDE), 0.0, np.ones(BESIDE)] > 0.0
    around = maximum_filter(rate, footprint=beside, mode="nearest")
    lone = np.flatnonzero(rate > LONE * around) + 1
    if not len(lone):
        return []
    size, time = step[lone[0] - 1] / signal.count, log.time[lone[0]]
    more = f" and {len(lone) - 1} more" if len(lone) > 1 else ""
    return [
        f"{log.name}: '{signal.column}' jumps by {size:.6g} counts at {time:.6g} s{more},"
        " between samples that hardly move: was the encoder reset, at an index?"
    ]


def _unit_remarks(log: Log, column: int, signal: SignalDeclaration) -> list[str]:
    """An angle said to be in rad that steps by the counts of its encoder in degrees, or turns as no
    joint does; or one said to be in deg that steps by its counts in rad.
    """
    if signal.unit != "rad" or not signal.is_position:
        return []
    angle = log.outputs[:, column]
    rate = float(np.quantile(np.abs(np.diff(angle) / np.diff(log.time)), OFTEN))
    span = float(np.ptp(angle))
    is_fast = rate > FASTEST and span > 2.0 * HALF_TURN
    if is_fast or _steps_by(angle, signal.count, np.degrees(1.0)):
        return [
            f"{log.name}: '{signal.column}' looks like degrees under the name of rad: it goes over"
            f" {span:.3g} rad, at up to {rate:.3g} rad/s. Write '{signal.column} [deg]' in the"
            ' heading, or column_unit = "deg" in the platform file where it has no unit.'
        ]
    if _steps_by(angle, signal.count, np.radians(1.0)):
        return [
            f"{log.name}: '{signal.column}' looks like rad under the name of deg: it steps by the"
            f" counts of its encoder in rad, {signal.count:.3g}. Write '{signal.column} [rad]' in"
            ' the heading, or column_unit = "rad" in the platform file where it has no unit.'
        ]
    return []


def _count_remarks(log: Log, column: int, signal: SignalDeclaration) -> list[str]:
    """A position that steps by another count than the declared one: lines for quadrature counts, or
    the encoder before a gear.
    """
    angle, count = log.outputs[:, column], signal.count
    finer = () if _steps_by(angle, count, 1.0) else (1.0 / n for n in PLAIN)
    factors = (*finer, *(float(n) for n in reversed(PLAIN) if not finer))
    found = next((f for f in factors if _steps_by(angle, count, f)), None)
    if found is None or count is None:
        return []
    step, word = count * found, "revolution" if signal.unit == "rad" else "metre"
    whole = 2.0 * np.pi if signal.unit == "rad" else 1.0
    return [
        f"{log.name}: '{signal.column}' moves in steps of {step:.6g} {signal.unit},"
        f" {whole / step:.6g} per {word}; counts_per_{word} says {whole / count:.6g}."
    ]


def _steps_by(angle: FloatArray, count: float | None, factor: float) -> bool:
    """Whether all values are whole numbers of a count times a factor, and some are far apart."""
    if count is None:
        return False
    steps = (angle - angle[0]) / (count * factor)
    whole = np.rint(steps)
    return bool(np.ptp(whole) >= FEW_LEVELS and np.mean(np.abs(steps - whole) < WHOLE) > MOST_WHOLE)


def _interpolation_remarks(log: Log, signal: SignalDeclaration) -> list[str]:
    """An encoder between whose samples its motion changes too suddenly for its counts."""
    off = log.interpolated.get(signal.column, 0.0) / (signal.count or np.inf)
    if off <= 1.0:
        return []
    return [
        f"{log.name}: '{signal.column}' is interpolated onto the clock of another encoder, where it"
        f" may be off by some {off:.2g} counts as the motion changes suddenly: log at a higher"
        " rate."
    ]


def _thinning_remark(name: str, column: str, faster: float) -> str:
    return (
        f"{name}: '{column}' is logged {faster:.3g} times as fast as the slowest encoder, whose"
        " clock counts: the samples between are left out. Log the encoders at one rate to use them."
    )


def _wrap_remark(name: str, wraps: Wraps) -> str:
    times = "once" if wraps.count == 1 else f"{wraps.count} times"
    return (
        f"{name}: '{wraps.column}' jumps {times} by {np.degrees(wraps.span):.6g} deg, where it"
        " wraps or its counter runs over; it is taken to go on."
    )


def _clock_remarks(log: Log) -> list[str]:
    step = np.diff(log.time)
    period = float(np.median(step))
    found = []
    if float(step.max()) > LONG_PAUSE * period:
        row = int(np.argmax(step))
        found.append(
            f"{log.name}: no samples from {log.time[row]:.6g} s to {log.time[row + 1]:.6g} s;"
            " the parts before and after it are fitted as runs of their own."
        )
    gaps = after_lost(log.time)
    lost = step[gaps - 1]
    lost = lost[lost <= LONG_PAUSE * period]
    if lost.size:
        places = f"at {lost.size} places" if lost.size > 1 else "at one place"
        found.append(
            f"{log.name}: samples are missing {places}, for up to {lost.max():.3g} s; inputs"
            " are held meanwhile, unless the logs fit far better where a new window begins there."
        )
    usual = np.delete(step, gaps - 1)
    jitter = float(np.std(usual)) / period
    if jitter > JITTER:
        found.append(f"{log.name}: the sampling period varies by {100 * jitter:.0f} % rms.")
    return found
