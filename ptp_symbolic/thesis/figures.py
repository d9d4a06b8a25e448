"""How a figure of the thesis is described and drawn, as PDF and PNG."""

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ptp_symbolic.report.plotting import own_style
from ptp_symbolic.thesis.items import Kind

FloatArray = NDArray[np.float64]
Panel = Callable[[Axes], None]

BLUE, ORANGE, GREEN, GREY = "#0d6a92", "#c65d21", "#4a8f5c", "#8a939c"
# Colour, line and marker of the curves of a panel, which can be told apart without colour too.
CURVES = ((BLUE, "-", "o"), (ORANGE, "--", "s"), (GREEN, "-.", "^"), (GREY, ":", "D"))
# Width in points of the first curve beside others, so that one that covers it leaves an edge.
UNDERNEATH = 2.0
# Share of the panel's diagonal between two markers of a curve.
MARKER_SPACING = 0.16
MARKED: dict[str, Any] = {"markersize": 3.6, "markerfacecolor": "white", "markeredgewidth": 0.8}
# Letters that fit into one row of a legend, and how many of them a handle takes.
LEGEND_ROW, LEGEND_HANDLE = 95, 9
STYLE: dict[Any, Any] = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 8.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.7,
    "axes.grid": True,
    "grid.color": "#e6e9ec",
    "grid.linewidth": 0.7,
    "axes.axisbelow": True,
    "axes.xmargin": 0.01,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "legend.fontsize": 7.5,
    "pdf.fonttype": 42,
    "axes.formatter.useoffset": False,
}
INCH = 25.4
# in mm by the number of panels: four figures of one panel fill a page, or two of three
PANEL_HEIGHTS = {1: 47.0, 2: 40.0, 3: 35.0}


@dataclass(frozen=True)
class ThesisFigure:
    """A figure: file name without ending, caption, and its panels from top to bottom.

    `kind` says whether its curves are COMPUTED or a ROUND_TRIP (see `Kind`); the printed curves are
    pictures, which nothing is compared with.
    """

    name: str
    caption: str
    panels: tuple[Panel, ...]
    kind: Kind = Kind.COMPUTED


@dataclass(frozen=True, eq=False)
class Line:
    """One line of a panel: its legend, x [k] and y [k]; `samples` marks every one of them."""

    label: str
    x: FloatArray
    y: FloatArray
    samples: bool = False


def draw_lines(axes: Axes, lines: Sequence[Line]) -> None:
    """Draw up to four lines, each with a colour, a dash and, beside others, a marker of its own."""
    for number, line in enumerate(lines):
        colour, dash, marker = CURVES[number]
        first = MARKER_SPACING * (0.5 + number) / len(lines)
        style: dict[str, Any] = {}
        if line.samples or len(lines) > 1:
            style = MARKED | {
                "marker": marker,
                "markevery": 1 if line.samples else (first, MARKER_SPACING),
            }
        if number == 0 and len(lines) > 1:
            style["linewidth"] = UNDERNEATH
        axes.plot(line.x, line.y, dash, color=colour, label=line.label, **style)
    if len(lines) > 1:
        letters = sum(len(line.label) + LEGEND_HANDLE for line in lines)
        columns = 4 if letters < LEGEND_ROW else 2
        axes.legend(
            ncols=columns,
            borderpad=0.1,
            handlelength=3.2,
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
        )


def panel(
    x_label: str, y_label: str, make: Callable[[], Sequence[Line]], logarithmic: bool = False
) -> Panel:
    """A panel that draws the lines of `make`, with a legend where there are several.

    `logarithmic` is the horizontal axis.
    """

    def draw(axes: Axes) -> None:
        if logarithmic:
            axes.set_xscale("log")
        draw_lines(axes, make())
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)

    return draw


def drawn(figure: ThesisFigure) -> Figure:
    """The figure with its panels, as wide as the text of the report."""
    height = PANEL_HEIGHTS[len(figure.panels)] * len(figure.panels)
    page = Figure(figsize=(150.0 / INCH, height / INCH), layout="constrained")
    FigureCanvasAgg(page)
    for place, draw in enumerate(figure.panels, start=1):
        draw(page.add_subplot(len(figure.panels), 1, place))
    return page


def rendered(figure: ThesisFigure) -> dict[str, bytes]:
    """The figure as PDF and PNG, by file name."""
    files = {}
    with own_style(STYLE):
        page = drawn(figure)
        for kind, metadata in (("pdf", {"CreationDate": None}), ("png", {})):
            buffer = io.BytesIO()
            page.savefig(buffer, format=kind, dpi=150, metadata=metadata)
            files[f"{figure.name}.{kind}"] = buffer.getvalue()
    return files
