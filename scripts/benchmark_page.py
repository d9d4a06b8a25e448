"""The page of a benchmark: its tables and pictures in one HTML file that loads nothing."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

from timing import Row, columns_of, written

STYLE = """
body { font: 15px/1.5 sans-serif; margin: 2em auto; max-width: 75em; padding: 0 1em; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin: 1em 0; }
th, td { padding: .2em .7em; text-align: left; border-bottom: 1px solid #ddd; }
img { max-width: 100%; } pre { white-space: pre-wrap; font: inherit; }
"""


def page(
    facts: Mapping[str, Any],
    explained: str,
    tables: Mapping[str, list[Row]],
    pictures: Mapping[str, Path],
) -> str:
    """The page: `facts` of the computer, how to read it, `tables` and PNG `pictures` by heading."""
    computer = "; ".join(f"{name}: {value}" for name, value in facts.items())
    parts = [f"<h1>Speed</h1><p>{escape(computer)}</p><pre>{escape(explained)}</pre>"]
    for heading, path in pictures.items():
        data = base64.b64encode(path.read_bytes()).decode()
        image = f'<img alt="{escape(heading)}" src="data:image/png;base64,{data}">'
        parts.append(f"<h2>{escape(heading)}</h2>{image}")
    parts += [f"<h2>{escape(heading)}</h2>{_table(rows)}" for heading, rows in tables.items()]
    head = f'<meta charset="utf-8"><title>Speed</title><style>{STYLE}</style>'
    return f"<!doctype html><html lang=en><head>{head}</head><body>{''.join(parts)}</body></html>\n"


def _table(rows: list[Row]) -> str:
    columns = columns_of(rows)
    head = "".join(f"<th>{escape(name)}</th>" for name in columns)
    lines = (
        "".join(f"<td>{escape(written(row.get(name, '')))}</td>" for name in columns)
        for row in rows
    )
    body = "".join(f"<tr>{line}</tr>" for line in lines)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
