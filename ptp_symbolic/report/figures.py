"""Figures of the diagnosis page: inline SVG, the same bytes for the same curves."""

import io
import re
from collections.abc import Mapping
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

MEASURED, BEFORE, AFTER, FLOOR = "#a9b1ba", "#c65d21", "#0d6a92", "#d3e4d8"
COLOURS = {"measured": MEASURED, "before": BEFORE, "after": AFTER, "floor": FLOOR}
STYLE: dict[Any, Any] = {
    "svg.fonttype": "none",
    "svg.hashsalt": "ptp-symbolic",
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.5,
    "text.color": "#4a525b",
    "axes.labelcolor": "#4a525b",
    "axes.edgecolor": "#c9cfd6",
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#eceff2",
    "grid.linewidth": 0.8,
    "axes.axisbelow": True,
    "axes.titlesize": 8.5,
    "axes.titlelocation": "left",
    "axes.titlepad": 4.0,
    "axes.formatter.useoffset": False,
    "xtick.color": "#6b747e",
    "ytick.color": "#6b747e",
    "xtick.major.size": 0.0,
    "ytick.major.size": 0.0,
    "path.simplify": True,
    "path.simplify_threshold": 0.2,
}
DOTS, BINS = 700, 30


def residual(signal: Mapping[str, Any], stage: str) -> FloatArray | None:
    """Measured minus simulated [n] of stage "before" or "after", in encoder counts if it has any.

    None when that stage was not simulated.
    """
    if signal.get(stage) is None:
        return None
    difference = np.asarray(signal["measured"], float) - np.asarray(signal[stage], float)
    return difference / (signal.get("counts") or 1.0)


def residual_unit(signal: Mapping[str, Any]) -> str:
    """The unit of `residual`: counts, or that of the signal."""
    return "counts" if signal.get("counts") else str(signal.get("unit") or "")


def motion_figure(curve: Mapping[str, Any], floor: float | None, points: int = 800) -> str:
    """One run as SVG: every signal measured and simulated, and under it what is left over.

    `floor` in counts: rms noise floor, drawn as a band of twice its height either side of zero.
    Each line is thinned to `points`, keeping its extremes.
    """
    time = np.asarray(curve["time"], float)
    panels = [
        (name, signal, kind)
        for name, signal in curve["signals"].items()
        for kind in ("motion", "residual", "after")
        if kind != "after" or signal.get("after") is not None
    ]
    heights = [{"motion": 1.7, "residual": 1.1, "after": 1.0}[kind] for _, _, kind in panels]
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(6.0, 0.5 + 1.22 * sum(heights)), layout="constrained")
        grid = figure.subplots(
            len(panels), 1, sharex=True, squeeze=False, gridspec_kw={"height_ratios": heights}
        )[:, 0]
        for axes, (name, signal, kind) in zip(grid, panels, strict=True):
            if kind == "motion":
                _draw_motion(axes, name, signal, time, points)
            else:
                _draw_residual(axes, signal, time, floor, points, zoomed=kind == "after")
        grid[-1].set_xlabel("time [s]")
        figure.align_ylabels()
        return _svg(figure)


def _draw_motion(
    axes: Axes, name: str, signal: Mapping[str, Any], time: FloatArray, points: int
) -> None:
    scale, unit = _plot_unit(str(signal.get("unit") or ""))
    styles = (("measured", MEASURED, 3.2), ("before", BEFORE, 1.1), ("after", AFTER, 1.1))
    for stage, colour, width in styles:
        if signal.get(stage) is not None:
            values = np.asarray(signal[stage], float) * scale
            axes.plot(*_thinned(time, values, points), color=colour, linewidth=width)
    axes.set_title(f"{name} [{unit}]")


def _draw_residual(
    axes: Axes,
    signal: Mapping[str, Any],
    time: FloatArray,
    floor: float | None,
    points: int,
    zoomed: bool,
) -> None:
    limit = 0.0
    _draw_floor(axes, floor if signal.get("counts") else None)
    for stage, colour in (("before", BEFORE), ("after", AFTER)):
        values = residual(signal, stage)
        if values is None or (zoomed and stage == "before"):
            continue
        axes.plot(*_thinned(time, values, points), color=colour, linewidth=0.9)
        limit = max(limit, float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values))))
    if floor and signal.get("counts"):
        limit = max(limit, 2.5 * floor)
    if limit:
        axes.set_ylim(-1.1 * limit, 1.1 * limit)
    what = "the same, after alone" if zoomed else "measured − simulated"
    axes.set_title(f"{what} [{residual_unit(signal)}]")


def _draw_floor(axes: Axes, floor: float | None) -> None:
    if floor:
        axes.axhspan(-2.0 * floor, 2.0 * floor, color=FLOOR, linewidth=0)
    axes.axhline(0.0, color="#c9cfd6", linewidth=0.8)


def residual_map_figure(
    signal_name: str, axis: str, curves: Mapping[str, Mapping[str, Any]], floor: float | None
) -> str:
    """What one signal leaves over against angle, rate of `axis` and time, runs pooled, as SVG.

    Dots are samples, the line is the median of each of 30 equal bins, the band the noise floor.
    """
    runs = [run for run in curves.values() if signal_name in run["signals"]]
    against = [
        (f"angle of {axis} [deg]", [np.degrees(run["angle"][axis]) for run in runs]),
        (f"rate of {axis} [deg/s]", [np.degrees(run["rate"][axis]) for run in runs]),
        ("time [s]", [np.asarray(run["time"], float) for run in runs]),
    ]
    signals = [run["signals"][signal_name] for run in runs]
    stages = [s for s in ("before", "after") if all(x.get(s) is not None for x in signals)]
    unit = residual_unit(signals[0])
    with matplotlib.rc_context(STYLE):
        figure = Figure(figsize=(10.4, 0.5 + 1.9 * len(stages)), layout="constrained")
        grid = figure.subplots(len(stages), 3, sharey="row", sharex="col", squeeze=False)
        for row, stage in zip(grid, stages, strict=True):
            left_over = [residual(signal, stage) for signal in signals]
            values = np.concatenate([part for part in left_over if part is not None])
            for axes, (_, coordinates) in zip(row, against, strict=True):
                _draw_floor(axes, floor if unit == "counts" else None)
                _draw_cloud(axes, np.concatenate(coordinates), values, stage)
            row[0].set_ylabel(f"{stage} [{unit}]")
        for axes, (label, _) in zip(grid[-1], against, strict=True):
            axes.set_xlabel(label)
        return _svg(figure)


def _draw_cloud(axes: Axes, x: FloatArray, y: FloatArray, stage: str) -> None:
    """Draw about 700 samples as dots in one path, and the median of each bin."""
    colour = BEFORE if stage == "before" else AFTER
    finite = np.isfinite(x) & np.isfinite(y)
    x, y = x[finite], y[finite]
    if not x.size:
        return
    # a stride without a common factor with anything periodic in the log
    chosen = np.unique(np.linspace(0.0, 1.0, DOTS) ** 1.0001 * (x.size - 1)).astype(int)
    dots = np.repeat(np.column_stack([x[chosen], y[chosen]]), 2, axis=0)
    codes = np.tile([Path.MOVETO, Path.LINETO], len(chosen))
    patch = PathPatch(
        Path(dots, codes), edgecolor=colour, alpha=0.45, linewidth=1.7, capstyle="round"
    )
    axes.add_patch(patch)
    edges = np.linspace(x.min(), x.max(), BINS + 1)
    place = np.clip(np.digitize(x, edges) - 1, 0, BINS - 1)
    full = [b for b in range(BINS) if np.count_nonzero(place == b) >= 8]
    medians = [float(np.median(y[place == b])) for b in full]
    axes.plot((edges[full] + edges[np.add(full, 1)]) / 2 if full else [], medians, color="#20262c")
    limit = 1.08 * float(np.abs(y).max())
    if limit:
        axes.set_ylim(-limit, limit)
    axes.autoscale(axis="x")


def _plot_unit(unit: str) -> tuple[float, str]:
    """Angles and rates are drawn in degrees, everything else as it is."""
    if unit in ("rad", "rad/s"):
        return 180.0 / np.pi, unit.replace("rad", "deg")
    return 1.0, unit


def _thinned(time: FloatArray, values: FloatArray, points: int) -> tuple[FloatArray, FloatArray]:
    """Keep the smallest and the largest value of each of points/2 stretches; NaN stays a gap."""
    length = -(-2 * len(values) // max(points, 2))
    if length <= 2:
        return time, values
    starts = np.arange(0, len(values), length)
    padded = np.append(values, np.repeat(values[-1:], starts.size * length - len(values)))
    stretches = padded.reshape(starts.size, length)
    kept = np.concatenate([starts + stretches.argmin(axis=1), starts + stretches.argmax(axis=1)])
    kept = np.unique(np.clip(np.append(kept, [0, len(values) - 1]), 0, len(values) - 1))
    return time[kept], values[kept]


def _svg(figure: Figure) -> str:
    """The figure as SVG to put into a page: no prologue, size, metadata or group names."""
    FigureCanvasSVG(figure)
    buffer = io.StringIO()
    nothing = dict.fromkeys(("Creator", "Date", "Format", "Type"))
    figure.savefig(buffer, format="svg", transparent=True, metadata=nothing)
    text = buffer.getvalue()
    text = re.sub(r"<!--.*?-->|<style.*?</style>", "", text[text.index("<svg") :], flags=re.DOTALL)
    text = re.sub(r'<g id="[^"]*"', "<g", text)
    text = re.sub(r'(<svg[^>]*?) (?:width|height)="[^"]*"', r"\1", text)
    text = re.sub(r'(<svg[^>]*?) (?:width|height)="[^"]*"', r"\1", text)
    text = re.sub(r'\bd="[^"]*"', lambda found: _shorter(found.group()), text)
    return re.sub(r"\s*\n\s*", "\n", text)


def _shorter(path: str) -> str:
    """Path data to a hundredth of a point: nobody sees more, and the page gets half as long."""
    return re.sub(r"(\.\d\d)\d+", r"\1", path).replace("\n", " ").replace(' "', '"')
