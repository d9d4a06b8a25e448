"""What logs hold and can show, as one page that works without a network."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from ptp_symbolic.report import figures
from ptp_symbolic.report.log_figures import Shown, log_figure
from ptp_symbolic.report.pages import environment
from ptp_symbolic.report.tables import log_axis, usable


def render_log_check(
    summary: Mapping[str, Any], curves: Mapping[str, tuple[Any, Sequence[Shown]]]
) -> str:
    """The page of a `summary`, the content of check.json; `curves` are by log its times [n] in s
    and what to show of it.
    """
    logs = [
        {**log, "svg": Markup(log_figure(*curves[log["name"]]))}
        for log in summary["logs"]
        if log["name"] in curves
    ]
    declared = [_share(row) for row in summary["visible"] if row["effect"] is None]
    axis = log_axis(row["percent"] for row in declared)
    for row in declared:
        row["place"] = axis.place(row["percent"])
    effects = sorted((r for r in summary["visible"] if r["effect"]), key=lambda r: r["effect"])
    page = environment().get_template("check.html.j2")
    return page.render(
        summary=summary, logs=logs, declared=declared, effects=effects, colours=figures.COLOURS
    )


def _share(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row with its smallest change in percent of the start value, where that is not zero."""
    known = usable(row["smallest"]) and usable(row["start"]) and row["start"] != 0.0
    percent = 100.0 * row["smallest"] / math.fabs(row["start"]) if known else None
    return {**row, "percent": percent}
