"""Figures of a run in the diagnosis page: inline SVG, the same bytes for the same curves."""

import io
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from ptp_symbolic.report.plotting import own_style

FloatArray = NDArray[np.float64]

MEASURED, BEFORE, AFTER, FLOOR = "#a9b1ba", "#c65d21", "#0d6a92", "#d3e4d8"
BORDER, INPUT = "#c3b8d6", "#6b5b95"
HEIGHTS = {"motion": 1.7, "residual": 0.95, "after": 0.85, "input": 0.7}  # of panels, inches
COLOURS = {
    "measured": MEASURED,
    "before": BEFORE,
    "after": AFTER,
    "floor": FLOOR,
    "border": BORDER,
}
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
    "axes.xmargin": 0.01,
    "axes.titlesize": 8.5,
    "axes.titlelocation": "left",
    "axes.titley": 1.0,  # found by measuring every label otherwise, a third of the drawing
    "axes.titlepad": 4.0,
    "axes.formatter.useoffset": False,
    "xtick.color": "#6b747e",
    "ytick.color": "#6b747e",
    "xtick.major.size": 0.0,
    "ytick.major.size": 0.0,
    "path.simplify": True,
    "path.simplify_threshold": 0.2,
}


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


Sheets = dict[tuple[float, ...], tuple[Figure, list[Axes]]]  # by the heights of their panels


def motion_figure(
    curve: Mapping[str, Any],
    floors: Mapping[str, float],
    points: int = 800,
    sheets: Sheets | None = None,
) -> str:
    """One run as SVG: every signal measured and simulated, under it the residual, then the inputs.

    Its attributes `data-time` (s) and `data-span` (shares of the width) say where the time axis
    begins and ends.

    `floors`: rms noise floor of signals, in the unit of their residual, drawn as a band of twice
    its height either side of zero. Each line is thinned to `points`, keeping its extremes. Where
    the run was cut into windows, a thin line marks every start of a new one. `sheets` keep what was
    drawn on, for the next run: axes and ticks cost more than the lines.
    """
    time = np.asarray(curve["time"], float)
    panels = [
        (name, signal, kind)
        for name, signal in curve["signals"].items()
        for kind in ("motion", "residual", "after")
        if kind != "after" or signal.get("after") is not None
    ]
    panels += [(name, given, "input") for name, given in (curve.get("inputs") or {}).items()]
    heights = tuple(HEIGHTS[kind] for _, _, kind in panels)
    sheets = {} if sheets is None else sheets
    with own_style(STYLE):
        if heights not in sheets:
            sheets[heights] = _blank(heights)
        figure, grid = sheets[heights]
        _wipe(grid)
        for axes, (name, signal, kind) in zip(grid, panels, strict=True):
            _draw_borders(axes, curve.get("borders"))
            if kind == "input":
                _draw_input(axes, name, signal, time, points)
            elif kind == "motion":
                _draw_motion(axes, name, signal, time, points)
            else:
                floor = floors.get(name)
                _draw_residual(axes, signal, time, floor, points, zoomed=kind == "after")
        grid[-1].set_xlabel("time [s]")
        first, last = grid[-1].get_xlim()
        frame = grid[-1].get_position()
        where = f'data-time="{first:.6g} {last:.6g}" data-span="{frame.x0:.5f} {frame.x1:.5f}"'
        return svg_of(figure).replace("<svg", f"<svg {where}", 1)


def _blank(heights: Sequence[float]) -> tuple[Figure, list[Axes]]:
    """A figure with a panel of every one of `heights`, in inches, above one time axis."""
    figure = Figure(figsize=(6.0, 0.75 + sum(heights) + 0.33 * (len(heights) - 1)))
    grid = figure.subplots(
        len(heights), 1, sharex=True, squeeze=False, gridspec_kw={"height_ratios": heights}
    )[:, 0]
    set_margins(figure, len(heights), 1)
    return figure, list(grid)


def _wipe(grid: Sequence[Axes]) -> None:
    """Take all lines and patches out of the panels, and let both axes follow what comes next."""
    for axes in grid:
        for drawn in (*axes.lines, *axes.patches):
            drawn.remove()
        axes.relim()
    for axes in grid:
        axes.autoscale()


def _draw_input(
    axes: Axes, name: str, given: Mapping[str, Any], time: FloatArray, points: int
) -> None:
    values = np.asarray(given["values"], float)
    axes.plot(*thinned(time, values, points), color=INPUT, linewidth=0.9, drawstyle="steps-post")
    axes.set_title(f"{name} [{given['unit']}]")


def set_margins(figure: Figure, rows: int, columns: int) -> None:
    """Leave fixed room, in inches, for labels; a layout engine would draw every figure twice."""
    width, height = figure.get_size_inches()
    left, right, bottom, top = 0.68, 0.08, 0.44, 0.26
    gap_across, gap_down = 0.2, 0.33
    figure.subplots_adjust(
        left=left / width,
        right=1.0 - right / width,
        bottom=bottom / height,
        top=1.0 - top / height,
        wspace=gap_across * columns / (width - left - right - gap_across * (columns - 1)),
        hspace=gap_down * rows / (height - bottom - top - gap_down * (rows - 1)),
    )


def _draw_motion(
    axes: Axes, name: str, signal: Mapping[str, Any], time: FloatArray, points: int
) -> None:
    scale, unit = plot_unit(str(signal.get("unit") or ""))
    styles = (("measured", MEASURED, 3.2), ("before", BEFORE, 1.1), ("after", AFTER, 1.1))
    for stage, colour, width in styles:
        if signal.get(stage) is not None:
            values = np.asarray(signal[stage], float) * scale
            axes.plot(*thinned(time, values, points), color=colour, linewidth=width)
    axes.set_title(f"{name} [{unit}]")


def _draw_residual(
    axes: Axes,
    signal: Mapping[str, Any],
    time: FloatArray,
    floor: float | None,
    points: int,
    zoomed: bool,
) -> None:
    drawn = []
    draw_floor(axes, floor)
    for stage, colour in (("before", BEFORE), ("after", AFTER)):
        values = residual(signal, stage)
        if values is None or (zoomed and stage == "before"):
            continue
        axes.plot(*thinned(time, values, points), color=colour, linewidth=0.9)
        drawn.append(values)
    set_limit(axes, np.concatenate(drawn), floor)
    what = "measured − simulated" + (" with the added effect, enlarged" if zoomed else "")
    axes.set_title(f"{what} [{residual_unit(signal)}]")


def _draw_borders(axes: Axes, borders: Any) -> None:
    """Mark where a new window starts, over the whole height, as one path."""
    if borders is None or not len(borders):
        return
    ends = [(time, height) for time in borders for height in (0.0, 1.0)]
    lines = Path(np.array(ends), np.tile([Path.MOVETO, Path.LINETO], len(borders)))
    across = axes.get_xaxis_transform()
    axes.add_patch(PathPatch(lines, edgecolor=BORDER, linewidth=0.5, fill=False, transform=across))


def draw_floor(axes: Axes, floor: float | None) -> None:
    """The zero line, and a band of twice the noise floor either side of it."""
    if floor:
        axes.axhspan(-2.0 * floor, 2.0 * floor, color=FLOOR, linewidth=0)
    axes.axhline(0.0, color="#c9cfd6", linewidth=0.8)


def set_limit(axes: Axes, values: FloatArray, floor: float | None) -> None:
    """Show all values and the whole floor, zero in the middle."""
    largest = float(np.max(np.abs(values), initial=0.0, where=np.isfinite(values)))
    limit = 1.1 * max(largest, 2.3 * (floor or 0.0))
    if limit:
        axes.set_ylim(-limit, limit)


def plot_unit(unit: str) -> tuple[float, str]:
    """Angles and rates are drawn in degrees, everything else as it is."""
    if unit in ("rad", "rad/s"):
        return 180.0 / np.pi, unit.replace("rad", "deg")
    return 1.0, unit


def thinned(time: FloatArray, values: FloatArray, points: int) -> tuple[FloatArray, FloatArray]:
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


def svg_of(figure: Figure) -> str:
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
