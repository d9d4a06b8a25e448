"""The designed experiment as a picture: inputs, what the machine shows, and what tells."""

import io
from collections.abc import Mapping
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ptp_symbolic.report.figures import AFTER, BEFORE, FLOOR, MEASURED, STYLE, plot_unit
from ptp_symbolic.report.plotting import own_style

COLOURS = (AFTER, BEFORE, "#3f7d4e", MEASURED)
NOISE = 2.0  # sigmas either side of zero that are drawn as the noise of one sample


def experiment_figure(curves: Mapping[str, Any]) -> bytes:
    """A PNG of `curves`: "time" [k] in s, "inputs" and "outputs" (unit, values [k]) by name, and by
    output what "tells": lines [k] in sigmas by label.
    """
    inputs, outputs, tells = curves["inputs"], curves["outputs"], curves["tells"]
    rows = len(inputs) + 2 * len(outputs)
    with own_style(STYLE):
        figure = Figure(figsize=(7.5, 0.5 + 1.35 * rows), layout="constrained")
        panels = iter(figure.subplots(rows, 1, sharex=True, squeeze=False)[:, 0])
        for name, (unit, values) in inputs.items():
            scale, shown = plot_unit(unit)
            axes = next(panels)
            axes.plot(curves["time"], scale * values, color=AFTER, drawstyle="steps-post")
            axes.set_title(f"input {name} [{shown}], held from sample to sample")
        for name, (unit, values) in outputs.items():
            scale, shown = plot_unit(unit)
            axes = next(panels)
            axes.plot(curves["time"], scale * values, color=AFTER, linewidth=1.1)
            axes.set_title(f"{name} [{shown}], predicted")
            axes = next(panels)
            axes.axhspan(-NOISE, NOISE, color=FLOOR, linewidth=0)
            for colour, (label, line) in zip(COLOURS, tells[name].items(), strict=False):
                axes.plot(curves["time"], line, color=colour, linewidth=0.9, label=label)
            labels = list(tells[name])
            if len(labels) > 1:
                axes.legend(loc="upper left", fontsize=7, framealpha=0.8, ncols=len(labels))
            what = labels[0] if len(labels) == 1 else "change by"
            axes.set_title(f"{name}: {what} [sigmas; band: noise of a sample, 95 %]")
        axes.set_xlabel("time [s]")
        FigureCanvasAgg(figure)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="png", dpi=120, metadata={"Software": None})
    return buffer.getvalue()
