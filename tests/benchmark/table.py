"""The figures of a run: answers per kind and per effect, times, memory, intervals."""

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from tests.benchmark.entry import KINDS, OF_STRUCTURES, Entry
from tests.benchmark.runner import read_set
from tests.benchmark.score import Score, clopper_pearson, intervals, read_key, same, score
from tests.benchmark.structures import VISIBLE_FLOORS

Row = dict[str, Any]
ORDERED_LAST = ("all ", "too faint", "null")  # of the rows of structures


@dataclass(frozen=True)
class Result:
    """A finished set: truth, diagnosis (None without an answer), outcome and score."""

    truth: dict[str, Any]
    diagnosis: dict[str, Any] | None
    outcome: dict[str, Any]
    score: Score


def read_results(entries: Iterable[Entry], out: Path) -> list[Result]:
    """All entries that have an outcome, scored anew."""
    results = []
    for entry in entries:
        folder = out / entry.id
        if (folder / "outcome.json").exists():
            truth, diagnosis = read_set(folder)
            outcome = json.loads((folder / "outcome.json").read_text())
            results.append(Result(truth, diagnosis, outcome, score(truth, diagnosis)))
    return results


def share(hits: int, count: int) -> dict[str, Any]:
    """A count with the share that it is and its 95 % bounds."""
    low, high = clopper_pearson(hits, count) if count else (0.0, 1.0)
    return {"hits": hits, "count": count, "share": hits / max(count, 1), "low": low, "high": high}


def _row(name: str, answers: Sequence[str], groups: int, results: Sequence[Result]) -> Row:
    """Counts of answers, and times and memory of the sets that they come from."""
    count = len(answers)
    row: Row = {"name": name, "count": count, "group": groups}
    for answer in ("right", "missed", "wrong"):
        row[answer] = share(answers.count(answer), count)
    row["no_answer"] = sum(result.diagnosis is None for result in results)
    walls = [result.outcome["wall_s"] for result in results] or [0.0]
    row["median_s"], row["p95_s"] = (float(np.percentile(walls, q)) for q in (50, 95))
    row["peak_mb"] = max((result.outcome["peak_mb"] for result in results), default=0.0)
    return row


def kind_rows(results: Sequence[Result]) -> list[Row]:
    """A row per kind, then one for all."""
    rows = []
    for kind in (*KINDS, "all"):
        chosen = [result for result in results if kind in ("all", result.truth["kind"])]
        if chosen:
            answers = [result.score.answer for result in chosen]
            groups = sum(result.score.group for result in chosen)
            rows.append(_row(kind, answers, groups, chosen))
    return rows


def answer_for(result: Result, number: int) -> tuple[str, bool]:
    """What became of one planted effect: its answer, and whether only a group holds it."""
    key = (result.truth["effects"][number], result.truth["axes"][number])
    if result.score.dishonest:
        return "wrong", False
    covered = any(same(read_key(text), key) for text in result.score.covered)
    by_group = any(same(read_key(text), key) for text in result.score.by_group)
    return ("right" if covered else "missed"), by_group


def effect_rows(results: Sequence[Result]) -> list[Row]:
    """A row per listed effect and declared value, over every set in which it is planted."""
    planted: dict[str, list[tuple[Result, int]]] = {}
    for result in results:
        for number, name in enumerate(result.truth["effects"]):
            planted.setdefault(name.partition(":")[0], []).append((result, number))
    rows = []
    for effect in sorted(planted):
        answers = [answer_for(*one) for one in planted[effect]]
        chosen = [result for result, _ in planted[effect]]
        groups = sum(group and answer == "right" for answer, group in answers)
        rows.append(_row(effect, [answer for answer, _ in answers], groups, chosen))
    return rows


def structure_rows(results: Sequence[Result]) -> list[Row]:
    """A row per hidden structure that is visible, alone or beside a term; then all that are alone,
    beside a term or too faint, and the machines that lack nothing, by what little they hide.
    """
    groups: dict[str, list[Result]] = {}
    for result in results:
        kind, planted = result.truth["kind"], result.truth["planted"]
        if kind == "structure_null":
            if result.truth["small_deviations"]:
                names = ["null, small deviations"]
            else:
                names = ["null, stiff shaft" if planted else "null, perfect"]
        elif kind in OF_STRUCTURES:
            if planted[0]["response_floors"] < VISIBLE_FLOORS:
                names = ["too faint"]
            elif kind == "structure":
                names = [planted[0]["effect"], "all alone"]
            else:
                names = [f"{planted[0]['effect']} and a term", "all with a term"]
        else:
            continue
        for name in names:
            groups.setdefault(name, []).append(result)
    rows = []
    for name in sorted(groups, key=lambda one: (one.startswith(ORDERED_LAST), one)):
        chosen = groups[name]
        answers = [result.score.answer for result in chosen]
        rows.append(_row(name, answers, sum(one.score.group for one in chosen), chosen))
    return rows


def coverage(results: Sequence[Result]) -> dict[str, Any]:
    """Share of the 95 % intervals of right answers that hold the true value, and what misses."""
    found = [
        (result.truth["id"], interval)
        for result in results
        if result.score.answer == "right" and result.diagnosis is not None
        for interval in intervals(result.truth, result.diagnosis)
    ]
    tables: dict[str, Any] = {}
    choices: dict[str, Callable[[bool], bool]] = {
        "all": lambda added: True,
        "fitted": lambda added: not added,
        "added": lambda added: added,
    }
    for name, chosen in choices.items():
        holds = [interval.holds for _, interval in found if chosen(interval.added)]
        tables[name] = share(sum(holds), len(holds))
    tables["outside"] = [
        f"{identity}: {one.parameter} = {one.true:.5g} outside [{one.low:.5g}, {one.high:.5g}]"
        for identity, one in found
        if not one.holds
    ]
    return tables


def failures(results: Sequence[Result]) -> list[Row]:
    """Sets that were answered wrongly, then those that were missed."""
    rows = []
    for answer in ("wrong", "missed"):
        for result in results:
            if result.score.answer == answer:
                levels = ", ".join(f"{level:.2g}" for level in result.truth["level"])
                rows.append(
                    {
                        "answer": answer,
                        "id": result.truth["id"],
                        "levels": levels,
                        "floors": result.truth["response_floors"],
                        "verdict": result.score.verdict,
                        "named": ", ".join(result.score.named) or "-",
                        "small": result.score.small,
                        "status": result.outcome["status"],
                    }
                )
    return rows


def figures(results: Sequence[Result]) -> dict[str, Any]:
    """Everything that the tables show, as plain data."""
    return {
        "kinds": kind_rows(results),
        "effects": effect_rows(results),
        "structures": structure_rows(results),
        "coverage": coverage(results),
        "failures": failures(results),
    }


TERMINAL_COLUMNS = 130
HEADINGS = ("", "sets", "right", "95 %", "group", "missed", "wrong", "95 %", "no answer")
HEADINGS += ("median s", "95 % s", "peak MB")


def _cells(row: Row) -> list[str]:
    """A row of the tables as text."""
    right, wrong = row["right"], row["wrong"]
    return [
        row["name"].replace("_", " "),
        str(row["count"]),
        f"{right['hits']} ({right['share']:.0%})",
        f"{right['low']:.0%} to {right['high']:.0%}",
        str(row["group"]),
        str(row["missed"]["hits"]),
        f"{wrong['hits']} ({wrong['share']:.0%})",
        f"{wrong['low']:.0%} to {wrong['high']:.0%}",
        str(row["no_answer"]),
        f"{row['median_s']:.0f}",
        f"{row['p95_s']:.0f}",
        f"{row['peak_mb']:.0f}",
    ]


def _coverage_lines(data: dict[str, Any]) -> list[str]:
    """Shares of intervals as text."""
    names = {"all": "all", "fitted": "fitted parameters", "added": "parameters of named effects"}
    return [
        f"{names[name]}: {one['hits']} of {one['count']} intervals hold the true value "
        f"({one['share']:.1%}, 95 % bounds {one['low']:.1%} to {one['high']:.1%})"
        for name, one in data.items()
        if name in names
    ]


def show(data: dict[str, Any], title: str) -> None:
    """Print the tables on the terminal."""
    console = Console(width=max(TERMINAL_COLUMNS, Console().width))
    for name in filter(data.get, ("kinds", "effects", "structures")):
        table = Table(*HEADINGS, title=f"{title}: {name}")
        for row in data[name]:
            table.add_row(*_cells(row))
        console.print(table)
    for line in _coverage_lines(data["coverage"]):
        console.print(line)
    for row in data["failures"]:
        console.print(_failure_line(row), soft_wrap=True, highlight=False)


def _failure_line(row: Row) -> str:
    """A wrong or missed set as text."""
    size = f"level {row['levels']}, " if row["levels"] else ""
    status = "" if row["status"] == "done" else f" [{row['status']}]"
    if row["small"]:
        status += f" (deviations of this machine: {', '.join(row['small'])})"
    return (
        f"{row['answer']}: {row['id']} ({size}{row['floors']:.1f} floors): "
        f"{row['verdict']}, {row['named']}{status}"
    )


def markdown(data: dict[str, Any], title: str) -> str:
    """The tables as markdown."""
    lines = [f"# {title}", ""]
    for name in filter(data.get, ("kinds", "effects", "structures")):
        lines += [f"## {name}", "", "| " + " | ".join(HEADINGS) + " |"]
        lines.append("|" + "---|" * len(HEADINGS))
        lines += ["| " + " | ".join(_cells(row)) + " |" for row in data[name]]
        lines.append("")
    lines += ["## intervals", "", *(f"- {line}" for line in _coverage_lines(data["coverage"])), ""]
    lines += [f"- {line}" for line in data["coverage"]["outside"]]
    lines += ["", "## wrong and missed", "", *(f"- {_failure_line(r)}" for r in data["failures"])]
    return "\n".join(lines) + "\n"


def write_tables(data: dict[str, Any], out: Path, title: str, stem: str) -> None:
    """Write the tables as markdown and as JSON."""
    (out / f"{stem}.md").write_text(markdown(data, title))
    (out / f"{stem}.json").write_text(json.dumps(data, indent=1) + "\n")
