"""The picture of a friction map: points, the law, and what is left."""

import io
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ptp_symbolic.report.figures import AFTER, BEFORE, STYLE
from ptp_symbolic.report.style import drawn_in


def friction_map_picture(summary: Mapping[str, Any]) -> bytes:
    """A PNG of torque over rate with the law, and below it measured minus fitted torque.

    `summary` is that of `friction_map`; small torques are in thousandths of their unit.
    """
    points = {name: np.asarray(values) for name, values in summary["points"].items()}
    curve = {name: np.asarray(values) for name, values in summary["curve"].items()}
    small = np.abs(points["torque"]).max() < 0.1
    si, rate = summary["units"]["torque"], summary["units"]["rate"]
    scale, unit = (1e3, f"m{si}") if small else (1.0, si)
    left = scale * (points["torque"] - points["fitted"])
    with drawn_in({**STYLE, "font.size": 10.0, "axes.titlesize": 10.0, "axes.xmargin": 0.03}):
        figure = Figure(figsize=(8.0, 5.6), layout="constrained")
        FigureCanvasAgg(figure)
        above, below = figure.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": (2.2, 1.0)})
        for direction in (1, -1):
            at = curve["rate"] * direction > 0
            label = "law" if direction > 0 or not (curve["rate"] > 0).any() else None
            above.plot(curve["rate"][at], scale * curve["torque"][at], color=AFTER, label=label)
        above.plot(
            points["rate"], scale * points["torque"], ".", color=BEFORE, ms=7, label="measured"
        )
        above.axhline(0.0, color="#c9cfd6", linewidth=0.8)
        above.set_ylabel(f"{summary['quantity']} [{unit}]")
        above.set_title(f"{summary['source']}, {summary['axis']}: {summary['member']}")
        above.legend(frameon=False, loc="lower right")
        below.axhline(0.0, color="#c9cfd6", linewidth=0.8)
        below.plot(points["rate"], left, ".", color=AFTER, ms=7)
        below.set_ylabel(f"residual [{unit}]")
        below.set_title(f"measured − law, rms {scale * summary['rms']['law']:.3g} {unit}")
        below.set_xlabel(f"rate [{rate}]")
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=120, metadata={"Software": None})
    return buffer.getvalue()
