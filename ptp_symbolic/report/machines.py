"""The results of real machines as one page that works without a network."""

from collections.abc import Mapping
from typing import Any

from ptp_symbolic.report import figures
from ptp_symbolic.report.pages import environment


def render_machines(results: Mapping[str, Any]) -> str:
    """The page of `results`, the content of machines.json."""
    page = environment().get_template("machines.html.j2")
    return page.render(colours=figures.COLOURS, **results)
