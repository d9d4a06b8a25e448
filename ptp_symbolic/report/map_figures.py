"""Figures of what is left against angle, rate, time and inputs: inline SVG."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from ptp_symbolic.report.figures import (
    AFTER,
    BEFORE,
    STYLE,
    FloatArray,
    draw_floor,
    plot_unit,
    residual,
    residual_unit,
    set_limit,
    set_margins,
    svg_of,
)
from ptp_symbolic.report.quantities import joint_words
from ptp_symbolic.report.style import drawn_in

DOTS = 700


def residual_map_figure(
    signal_name: str, axis: str, curves: Mapping[str, Mapping[str, Any]], floor: float | None
) -> str:
    """Residual of one signal against angle or position of `axis`, its rate, and time, runs pooled,
    as SVG.

    Dots are samples, the line their median in equal bins, the band twice the noise floor (rms),
    given in the unit of the residual.
    """
    runs = [run for run in curves.values() if signal_name in run["signals"]]
    words = joint_words(runs[0], axis)
    scale, unit = plot_unit(words.unit)
    against = [
        (f"{words.angle} of {axis} [{unit}]", [scale * run["angle"][axis] for run in runs], 30),
        (f"{words.rate} of {axis} [{unit}/s]", [scale * run["rate"][axis] for run in runs], 30),
        ("time [s]", [np.asarray(run["time"], float) for run in runs], 8),
    ]
    signals = [run["signals"][signal_name] for run in runs]
    stages = [s for s in ("before", "after") if all(x.get(s) is not None for x in signals)]
    unit = residual_unit(signals[0])
    with drawn_in(STYLE):
        figure = Figure(figsize=(10.4, 0.5 + 1.9 * len(stages)))
        grid = figure.subplots(len(stages), 3, sharey="row", sharex="col", squeeze=False)
        set_margins(figure, len(stages), 3)
        for row, stage in zip(grid, stages, strict=True):
            normalised_residual = [residual(signal, stage) for signal in signals]
            values = np.concatenate([part for part in normalised_residual if part is not None])
            for axes, (_, coordinates, bins) in zip(row, against, strict=True):
                draw_floor(axes, floor)
                _draw_cloud(axes, np.concatenate(coordinates), values, stage, bins)
            set_limit(row[0], values, floor)
            row[0].set_ylabel(f"{stage} [{unit}]")
        for axes, (label, _, _) in zip(grid[-1], against, strict=True):
            axes.set_xlabel(label)
        return svg_of(figure)


def torque_map_figure(maps: Sequence[Mapping[str, Any]], unit: str) -> str:
    """Means of the residual torque of one axis, in `unit`, in bins of every side of `maps`, with
    bars of twice their standard error, as SVG; the share of its variance stands above.
    """
    with drawn_in(STYLE):
        figure = Figure(figsize=(10.4, 2.4))
        grid = figure.subplots(1, len(maps), sharey="row", squeeze=False)[0]
        set_margins(figure, 1, len(maps))
        for axes, found in zip(grid, maps, strict=True):
            scale, shown = plot_unit(str(found["unit"]))
            axes.axhline(0.0, color="#c9cfd6", linewidth=0.8)
            bars = 2.0 * np.asarray(found["error"])
            x = scale * np.asarray(found["at"])
            axes.errorbar(x, found["mean"], bars, color=AFTER, marker=".", elinewidth=0.9)
            axes.set_xlabel(f"{found['against']} [{shown}]")
            axes.set_title(f"{100.0 * found['share']:.0f} % of the variance")
        grid[0].set_ylabel(f"residual {'force' if unit == 'N' else 'torque'} [{unit}]")
        return svg_of(figure)


def _draw_cloud(axes: Axes, x: FloatArray, y: FloatArray, stage: str, bins: int) -> None:
    """Draw about 700 samples as dots in one path, and the median of each bin."""
    finite = np.isfinite(x) & np.isfinite(y)
    x, y = x[finite], y[finite]
    if not x.size:
        return
    # strides that grow slowly have no factor in common with anything periodic in the log
    chosen = np.unique((np.linspace(0.0, 1.0, DOTS) ** 1.01 * (x.size - 1)).astype(int))
    dots = Path(
        np.repeat(np.column_stack([x[chosen], y[chosen]]), 2, axis=0),
        np.tile([Path.MOVETO, Path.LINETO], len(chosen)),
    )
    colour = BEFORE if stage == "before" else AFTER
    look = {"edgecolor": colour, "alpha": 0.45, "linewidth": 1.7, "capstyle": "round"}
    axes.add_patch(PathPatch(dots, **look))
    edges = np.linspace(x.min(), x.max(), bins + 1)
    place = np.clip(np.digitize(x, edges) - 1, 0, bins - 1)
    full = np.flatnonzero(np.bincount(place, minlength=bins) >= 8)
    medians = [float(np.median(y[place == each])) for each in full]
    axes.plot((edges[full] + edges[full + 1]) / 2.0, medians, color="#20262c")
    axes.autoscale(axis="x")
