"""Objects as people read them: tables in a terminal and in a notebook, and what `dir` lists."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape


@dataclass(frozen=True)
class Table:
    """Rows of cells under `headings`, with a title; cells are texts or numbers."""

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[object, ...], ...]


class Displayed:
    """An object that is read as a heading and tables, and lists nothing private."""

    def _heading(self) -> str:
        raise NotImplementedError

    def _tables(self) -> Sequence[Table]:
        return ()

    def __dir__(self) -> list[str]:
        return sorted(n for n in object.__dir__(self) if not n.startswith("_") or n[:2] == "__")

    def __repr__(self) -> str:
        return "\n".join([self._heading(), *(_as_text(t) for t in self._tables() if t.rows)])

    def _repr_html_(self) -> str:
        tables = "".join(_as_html(table) for table in self._tables() if table.rows)
        return f"<div><strong>{escape(self._heading())}</strong>{tables}</div>"


def written(value: object) -> str:
    """`value` as the text of a cell: a number with six digits, nothing for None."""
    if value is None:
        return ""
    return f"{value + 0.0:.6g}" if isinstance(value, float) else str(value)


def _as_text(table: Table) -> str:
    body = [(table.title, *table.headings[1:]), *(tuple(map(written, r)) for r in table.rows)]
    widths = [max(len(row[k]) for row in body) for k in range(len(table.headings))]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in body
    )


def _as_html(table: Table) -> str:
    def line(cells: Iterable[object], tag: str) -> str:
        return "".join(f"<{tag}>{escape(written(cell))}</{tag}>" for cell in cells)

    rows = "".join(f"<tr>{line(row, 'td')}</tr>" for row in table.rows)
    return (
        f"<table><caption>{escape(table.title)}</caption>"
        f"<thead><tr>{line(table.headings, 'th')}</tr></thead><tbody>{rows}</tbody></table>"
    )
