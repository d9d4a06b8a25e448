"""The named effect beside black-box models: a figure and words for the page."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from ptp_symbolic.report import tables
from ptp_symbolic.report.figures import AFTER, BEFORE, INPUT, STYLE, svg_of
from ptp_symbolic.report.style import drawn_in

MODELS = {
    "declared": "declared model",
    "named": "with the named effect",
    "sparse": "with sparse regression",
    "network": "with a neural network",
}
LOOKS = {
    "declared": (BEFORE, "o"),
    "named": (AFTER, "D"),
    "sparse": (INPUT, "s"),
    "network": ("#7fb394", "^"),
}
ROW = 0.24  # height of a run, inches
LEFT = 1.9  # room for the names of runs, inches


def rival_parts(found: Mapping[str, Any] | None) -> list[dict[str, Any]]:
    """One table and figure per axis, from the key `black_box` of a diagnosis."""
    axes = found["axes"] if found else {}
    return [
        {"axis": axis, **part, "svg": Markup(rival_figure(part))} for axis, part in axes.items()
    ]


def free_errors(diagnosis: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Errors of every model in free simulation of the validation runs, by model."""
    beside = (diagnosis.get("black_box") or {}).get("free") or {}
    known = {"declared": "before", "named": "after"}
    own = {model: tables.error_of(diagnosis, "validate", stage) for model, stage in known.items()}
    return own | {model: error or {} for model, error in beside.items()}


def said(model: Mapping[str, Any]) -> str:
    """Rms on the validation runs, and the share of the mean square that is explained."""
    figures = model["validate"]
    share = f" ({100.0 * figures['share']:.1f} % explained)" if figures["share"] else ""
    return f"{figures['rms']:.3g}{share}"


def rival_figure(part: Mapping[str, Any]) -> str:
    """The torque (rms) that every model leaves on every validation run, as SVG."""
    runs = sorted({run for model in part["models"].values() for run in model["by_run"]})
    height = 0.75 + ROW * len(runs)
    with drawn_in(STYLE):
        figure = Figure(figsize=(10.4, height))
        axes = figure.subplots()
        figure.subplots_adjust(LEFT / 10.4, 0.42 / height, 0.99, 1.0 - 0.3 / height)
        for key, model in part["models"].items():
            colour, marker = LOOKS[key]
            values = [model["by_run"].get(run, np.nan) for run in runs]
            axes.plot(values, range(len(runs)), marker, color=colour, alpha=0.85, label=MODELS[key])
        axes.set_xlim(left=0.0)
        axes.set_yticks(range(len(runs)), runs)
        axes.set_ylim(len(runs) - 0.5, -0.5)
        axes.set_xlabel(
            f"residual {'force' if part['unit'] == 'N' else 'torque'}, rms [{part['unit']}]"
        )
        axes.legend(
            loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4, frameon=False, borderpad=0.0
        )
        return svg_of(figure)
