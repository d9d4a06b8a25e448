"""How a figure of the thesis is described and drawn, as PDF and PNG."""

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
Panel = Callable[[Axes], None]

BLUE, ORANGE, GREEN, GREY = "#0d6a92", "#c65d21", "#4a8f5c", "#8a939c"
COLOURS = (BLUE, ORANGE, GREEN, GREY)
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
    """A figure: file name without ending, caption, and its panels from top to bottom."""

    name: str
    caption: str
    panels: tuple[Panel, ...]


@dataclass(frozen=True, eq=False)
class Line:
    """One line of a panel: its legend, x [k] and y [k]."""

    label: str
    x: FloatArray
    y: FloatArray


def panel(x_label: str, y_label: str, make: Callable[[], Sequence[Line]]) -> Panel:
    """A panel that draws the lines of `make`, with a legend where there are several."""

    def draw(axes: Axes) -> None:
        lines = make()
        for number, line in enumerate(lines):
            style = "--" if number and number % 2 else "-"
            axes.plot(line.x, line.y, style, color=COLOURS[number % 4], label=line.label)
        axes.set_xlabel(x_label)
        axes.set_ylabel(y_label)
        if len(lines) > 1:
            columns = 4 if sum(len(line.label) for line in lines) < 70 else 2
            axes.legend(ncols=columns, borderpad=0.1, loc="lower left", bbox_to_anchor=(0.0, 1.0))

    return draw


def rendered(figure: ThesisFigure) -> dict[str, bytes]:
    """The figure as PDF and PNG, by file name."""
    files = {}
    with matplotlib.rc_context(STYLE):
        height = PANEL_HEIGHTS[len(figure.panels)] * len(figure.panels)
        page = Figure(figsize=(150.0 / INCH, height / INCH), layout="constrained")
        FigureCanvasAgg(page)
        for place, draw in enumerate(figure.panels, start=1):
            draw(page.add_subplot(len(figure.panels), 1, place))
        for kind, metadata in (("pdf", {"CreationDate": None}), ("png", {})):
            buffer = io.BytesIO()
            page.savefig(buffer, format=kind, dpi=150, metadata=metadata)
            files[f"{figure.name}.{kind}"] = buffer.getvalue()
    return files
