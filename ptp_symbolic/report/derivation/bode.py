"""Bode plots of linear models, as PDF."""

import io
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ptp_symbolic.report.figures import AFTER, BEFORE, INPUT, STYLE
from ptp_symbolic.report.plotting import own_style

FloatArray = NDArray[np.float64]
LINES = (("-", AFTER), ("--", BEFORE), (":", INPUT), ("-.", "#4a8f5c"))
IN_PRINT: dict[Any, Any] = {"pdf.fonttype": 42, "axes.xmargin": 0.0, "legend.frameon": False}
POINTS = 400
WIDTH, HEIGHT = 6.3, 3.3  # inches


@dataclass(frozen=True)
class BodeLine:
    """A frequency response [POINTS] and what tells it from others."""

    label: str
    response: NDArray[np.complex128]


def frequencies(poles: Sequence[complex], smallest: float, largest: float) -> FloatArray:
    """Frequencies [POINTS] in Hz from a tenth of the slowest of the `poles` that are not zero to
    ten times the fastest, within `smallest` and `largest`.
    """
    sizes = np.abs([p for p in poles if p != 0.0]) / (2.0 * np.pi)
    ends = (sizes.min() / 10.0, sizes.max() * 10.0) if sizes.size else (smallest, largest)
    low, high = np.clip(ends, smallest, largest)
    if high <= low:
        low, high = smallest, largest
    return np.geomspace(low, high, POINTS)


def frequency_response(
    A: FloatArray, column: FloatArray, row: int, at: FloatArray, delay: float
) -> NDArray[np.complex128]:
    """State `row` per input `column` [n] at the frequencies `at` [k] in Hz, the input late by
    `delay` in s.
    """
    s = 2j * np.pi * at
    found = np.linalg.solve(s[:, None, None] * np.eye(len(A)) - A, column[:, None])
    return found[:, row, 0] * np.exp(-s * delay)


def bode_figure(title: str, unit: str, at: FloatArray, lines: Sequence[BodeLine]) -> bytes:
    """Magnitude in dB re 1 `unit` and phase in degrees over the frequency in Hz, as PDF."""
    with own_style(STYLE | IN_PRINT):
        figure = Figure(figsize=(WIDTH, HEIGHT), layout="constrained")
        FigureCanvasAgg(figure)
        upper, lower = figure.subplots(2, 1, sharex=True)
        for number, line in enumerate(lines):
            style, colour = LINES[number % len(LINES)]
            kind = {"linestyle": style, "color": colour, "linewidth": 1.2}
            size = np.maximum(np.abs(line.response), np.finfo(float).tiny)
            upper.semilogx(at, 20.0 * np.log10(size), label=line.label, **kind)
            lower.semilogx(at, np.degrees(np.unwrap(np.angle(line.response))), **kind)
        upper.set_title(title)
        upper.set_ylabel(f"dB re 1 {unit}")
        lower.set_ylabel("phase [deg]")
        lower.set_xlabel("frequency [Hz]")
        if len(lines) > 1:
            upper.legend(fontsize=7.0, loc="lower left")
        buffer = io.BytesIO()
        figure.savefig(buffer, format="pdf", metadata={"CreationDate": None})
        return buffer.getvalue()
