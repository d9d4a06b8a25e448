"""Templates of HTML pages, and how they write numbers."""

from pathlib import Path

import jinja2

from ptp_symbolic.report import quantities

TEMPLATES = Path(__file__).parent / "templates"


def environment() -> jinja2.Environment:
    """The templates, with filters that write quantities."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES, encoding="utf-8"),
        autoescape=True,
        undefined=jinja2.ChainableUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        number=quantities.number,
        unit=quantities.unit,
        estimate=quantities.estimate,
        interval=quantities.interval,
        in_degrees=quantities.in_degrees,
        travel=quantities.travel,
        gain=quantities.gain,
    )
    return environment
