"""Figures of runs, logs and fits, for a notebook or a file."""

import io
import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ptp_symbolic.report.figures import AFTER, BEFORE, BORDER, MEASURED, STYLE

FloatArray = NDArray[np.float64]

DOTS_PER_INCH = 150
WIDTH, PANEL, EDGE = 9.0, 1.8, 0.6  # inches
IN_A_ROW = 3  # runs


def panels_by_unit(
    time: FloatArray,
    signals: Mapping[str, FloatArray],
    units: Mapping[str, str],
    marks: Iterable[float] = (),
) -> Figure:
    """The `signals` [k] over `time` [k] in s, those of one unit in one panel, `marks` in s."""
    groups: dict[str, list[str]] = {}
    for name in signals:
        groups.setdefault(units[name], []).append(name)
    with matplotlib.rc_context(STYLE):
        figure, grid = _sheet(len(groups))
        for axes, (unit, names) in zip(grid, groups.items(), strict=True):
            for name in names:
                axes.plot(time, signals[name], linewidth=1.0, label=name)
            for mark in marks:
                axes.axvline(mark, color=BORDER, linewidth=0.5)
            axes.set_ylabel(unit)
            axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=6, frameon=False)
        grid[-1].set_xlabel("time [s]")
    return figure


def measured_and_simulated(
    curves: Mapping[str, Mapping[str, Any]], hidden: Sequence[str] = ()
) -> Figure:
    """Every run of `curves` in a column of its own, IN_A_ROW beside each other: signals as
    measured, and as simulated before and after the fit, but for stages that are `hidden`.
    """
    rows = max(len(curve["signals"]) for curve in curves.values())
    blocks, columns = math.ceil(len(curves) / IN_A_ROW), min(len(curves), IN_A_ROW)
    with matplotlib.rc_context(STYLE):
        size = (max(WIDTH, 3.5 * columns), (EDGE + PANEL * rows) * blocks)
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(rows * blocks, columns, squeeze=False)
        for k, curve in enumerate(curves.values()):
            first = k // IN_A_ROW * rows
            column = grid[first : first + rows, k % IN_A_ROW]
            column[0].set_title(f"{curve['run']} ({curve['set']})")
            for axes, (name, signal) in zip(column, curve["signals"].items(), strict=False):
                _draw(axes, curve["time"], signal, hidden)
                axes.set_ylabel(f"{name} [{signal['unit']}]")
            column[-1].set_xlabel("time [s]")
        for axes in grid[-rows:, (len(curves) - 1) % IN_A_ROW + 1 :].flat:
            axes.remove()
        grid[0, 0].legend(loc="upper right", frameon=False)
    return figure


def bands_figure(
    time: FloatArray, bands: Mapping[str, FloatArray], units: Mapping[str, str]
) -> Figure:
    """A panel per signal with its median and the ranges of 50 % and 90 % of the runs, of quantiles
    [5, k] (5, 25, 50, 75, 95 %) over `time` [k] in s.
    """
    with matplotlib.rc_context(STYLE):
        figure, grid = _sheet(len(bands))
        for axes, (name, (p5, p25, median, p75, p95)) in zip(grid, bands.items(), strict=True):
            axes.fill_between(time, p5, p95, color=AFTER, alpha=0.2, linewidth=0, label="90 %")
            axes.fill_between(time, p25, p75, color=AFTER, alpha=0.35, linewidth=0, label="50 %")
            axes.plot(time, median, color=AFTER, linewidth=1.0, label="median")
            axes.set_ylabel(f"{name} [{units[name]}]")
        grid[0].legend(loc="upper right", frameon=False)
        grid[-1].set_xlabel("time [s]")
    return figure


def png_of(figure: Figure) -> bytes:
    """A figure as a PNG file."""
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    return file.getvalue()


def _draw(axes: Axes, time: FloatArray, signal: Mapping[str, Any], hidden: Sequence[str]) -> None:
    for stage, colour in (("measured", MEASURED), ("before", BEFORE), ("after", AFTER)):
        if signal.get(stage) is not None and stage not in hidden:
            axes.plot(time, signal[stage], color=colour, linewidth=1.0, label=stage)


def _sheet(rows: int) -> tuple[Figure, Sequence[Axes]]:
    figure = Figure(figsize=(WIDTH, EDGE + PANEL * rows), layout="constrained")
    return figure, list(figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0])
