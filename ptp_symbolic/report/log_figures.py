"""Figures of a log before any fit: its signals over time, and their spectra; inline SVG."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy import signal

from ptp_symbolic.report.figures import (
    AFTER,
    BEFORE,
    INPUT,
    STYLE,
    plot_unit,
    set_margins,
    svg_of,
    thinned,
)
from ptp_symbolic.report.plotting import own_style

FloatArray = NDArray[np.float64]

POINTS = 1200  # of a line
SEGMENT = 512  # samples of a periodogram
ROW = 1.5  # height of a signal, inches


class Shown(NamedTuple):
    """One signal of a log: `values` [n] in `unit`, its role, and its white noise (rms)."""

    name: str
    unit: str
    role: str
    values: FloatArray
    noise: float


def log_figure(time: FloatArray, shown: Sequence[Shown]) -> str:
    """Every signal over `time` [n] in s, and beside it its amplitude density over frequency.

    Averaged periodograms of Hann windows (Welch, 1967); the dashed line is that of the white noise
    which differences of the samples show: a spectrum that bends up from it has coloured noise, or
    motion. A gap in the sampling is left open.
    """
    period = float(np.median(np.diff(time)))
    style: dict[Any, Any] = {**STYLE, "axes.titlesize": 8.0}
    with own_style(style):
        figure = Figure(figsize=(10.4, 0.7 + (ROW + 0.33) * len(shown)))
        grid = figure.subplots(
            len(shown), 2, squeeze=False, gridspec_kw={"width_ratios": (2.2, 1.0)}
        )
        set_margins(figure, len(shown), 2)
        figure.subplots_adjust(wspace=0.2)  # room for powers of ten
        for (over_time, over_frequency), s in zip(grid, shown, strict=True):
            scale, unit = plot_unit(s.unit)
            steps = "steps-post" if s.role == "input" else "default"
            over_time.plot(
                *thinned(*_with_gaps(time, s.values * scale, period), POINTS),
                color=INPUT if s.role == "input" else AFTER,
                linewidth=0.9,
                drawstyle=steps,
            )
            over_time.set_title(f"{s.name} [{unit}]")
            frequency, power = signal.welch(
                s.values * scale, 1.0 / period, nperseg=min(SEGMENT, len(time)), detrend="linear"
            )
            seen = (frequency > 0.0) & (power > 0.0)
            if seen.any():
                over_frequency.loglog(
                    frequency[seen], np.sqrt(power[seen]), color=AFTER, linewidth=0.9
                )
            white = scale * s.noise * np.sqrt(2.0 * period)
            if white > 0.0:
                over_frequency.axhline(white, color=BEFORE, linewidth=1.0, linestyle="--")
            over_frequency.set_title(f"{unit} per root Hz")
        for axes in grid[:-1].flat:
            axes.tick_params(labelbottom=False)
        grid[-1, 0].set_xlabel("time [s]")
        grid[-1, 1].set_xlabel("frequency [Hz]")
        return svg_of(figure)


def _with_gaps(
    time: FloatArray, values: FloatArray, period: float
) -> tuple[FloatArray, FloatArray]:
    """The line with a NaN in every pause of more than ten periods."""
    pauses = np.flatnonzero(np.diff(time) > 10.0 * period) + 1
    return np.insert(time, pauses, time[pauses - 1] + period), np.insert(values, pauses, np.nan)
