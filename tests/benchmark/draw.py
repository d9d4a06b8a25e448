"""Pictures of a run: power against size per effect, and what was answered for what."""

import math
from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from tests.benchmark.score import clopper_pearson, read_key
from tests.benchmark.table import Result, answer_for

EDGES = (0.0, 0.42, 0.77, 1.42, 3.1, math.inf)  # thresholds, between the bins of size
CENTRES = (0.3, 0.6, 1.0, 2.0, 5.0)
COLUMNS = 6  # of the small multiples
RIGHT, MISSED, WRONG, EMPTY = "#1b6ca8", "#7f7f7f", "#c0392b", "#d9d9d9"
# Columns of answers without a name.
SILENT = ("nothing missing", "unexplained", "partly explained", "explained", "no answer")
ALONE = ("single", "declared_value", "short_arc")  # kinds with one effect that has a name

Point = tuple[float, str]  # level in thresholds, answer


def points_by_effect(results: Sequence[Result]) -> dict[str, list[Point]]:
    """Level and answer of every listed effect, wherever it is planted."""
    found: dict[str, list[Point]] = {}
    for result in results:
        for number, name in enumerate(result.truth["effects"]):
            answer, _ = answer_for(result, number)
            found.setdefault(name.partition(":")[0], []).append(
                (result.truth["level"][number], answer)
            )
    return found


def _power(axes: Axes, points: Sequence[Point], title: str) -> None:
    """Share right and share wrong per bin of size, with 95 % bounds of the share right."""
    levels = np.array([level for level, _ in points])
    bins = np.digitize(levels, EDGES[1:-1])
    for answer, colour in (("right", RIGHT), ("wrong", WRONG)):
        where, shares, below, above = [], [], [], []
        for number, centre in enumerate(CENTRES):
            answers = [a for (_, a), b in zip(points, bins, strict=True) if b == number]
            if not answers:
                continue
            hits = answers.count(answer)
            low, high = clopper_pearson(hits, len(answers))
            where.append(centre)
            shares.append(hits / len(answers))
            below.append(hits / len(answers) - low)
            above.append(high - hits / len(answers))
            if answer == "right":
                label = f"{len(answers)}"
                axes.annotate(label, (centre, -0.16), ha="center", va="center", fontsize=6)
        if answer == "right":
            axes.errorbar(where, shares, [below, above], color=colour, lw=0.8, alpha=0.35)
        axes.plot(where, shares, "o-", color=colour, lw=1.4, ms=4)
    axes.set(xscale="log", xlim=(0.22, 7.0), ylim=(-0.26, 1.08))
    axes.set_xticks(CENTRES, [f"{centre:g}" for centre in CENTRES], fontsize=7)
    axes.minorticks_off()
    axes.set_yticks((0.0, 0.5, 1.0), ("0", "½", "1"), fontsize=7)
    axes.grid(color=EMPTY, lw=0.5)
    axes.set_axisbelow(True)
    axes.set_title(f"{title.replace('_', ' ')} ({len(points)})", fontsize=8)
    axes.spines[["top", "right"]].set_visible(False)


def draw_power(figure: SubFigure, results: Sequence[Result]) -> None:
    """Small multiples, all effects together first."""
    by_effect = points_by_effect(results)
    panels = [("all effects", [point for points in by_effect.values() for point in points])]
    panels += sorted(by_effect.items())
    rows = math.ceil(len(panels) / COLUMNS)
    grid = figure.subplots(rows, COLUMNS, squeeze=False)
    for axes, (title, points) in zip(grid.flat, panels, strict=False):
        _power(axes, points, title)
    for axes in grid.flat[len(panels) :]:
        axes.set_visible(False)
    figure.supxlabel("size in thresholds (number of sets below the line)", fontsize=9)
    figure.supylabel("share of the sets", fontsize=9)
    figure.suptitle(
        "Power against size: right (blue, with 95 % bounds) and wrong names (red)", fontsize=11
    )


def _row_name(result: Result) -> str | None:
    """The row of a set: its one effect, or its kind; None for several effects."""
    kind, effects = result.truth["kind"], result.truth["effects"]
    if kind in ALONE:
        return effects[0].partition(":")[0]
    if kind == "unlisted" and not effects:
        return "unlisted torque"
    return {"perfect": "nothing", "slightly_wrong": "slightly wrong"}.get(kind)


def _answers(result: Result, row: str) -> list[str]:
    """The columns of an answer: its names (the truth where a group holds it), or its verdict."""
    if result.diagnosis is None:
        return ["no answer"]
    if not result.score.named:
        return [result.score.verdict.replace("_", " ")]
    dishonest = [read_key(text)[0].partition(":")[0] for text in result.score.dishonest]
    # The right effect on the wrong axis, or the wrong one of the declared values.
    dishonest = [f"{name} (another)" if name == row else name for name in dishonest]
    return ([row] if result.score.covered else []) + dishonest


def confusion(results: Sequence[Result]) -> tuple[list[str], list[str], np.ndarray]:
    """Rows, columns and counts [rows, columns] of truths against answers."""
    cells: dict[tuple[str, str], float] = {}
    for result in results:
        row = _row_name(result)
        if row is not None:
            for column in _answers(result, row):
                cells[row, column] = cells.get((row, column), 0.0) + 1.0
    rest = ["nothing", "unlisted torque", "slightly wrong"]
    last = SILENT
    present = {row for row, _ in cells}
    rows = sorted(present - set(rest)) + [name for name in rest if name in present]
    answered = {column for _, column in cells}
    columns = sorted((answered | set(rows)) - set(last) - set(rest))
    columns += [name for name in last if name in answered]
    counts = np.array([[cells.get((row, column), 0.0) for column in columns] for row in rows])
    return rows, columns, counts


def draw_confusion(figure: SubFigure, results: Sequence[Result]) -> None:
    """Truths in rows, answers in columns; a set with several names counts in several cells."""
    rows, columns, counts = confusion(results)
    axes = figure.subplots()
    if not rows:
        axes.set_visible(False)
        return
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1.0)
    right = np.array([[row == column for column in columns] for row in rows])
    right |= np.array([[(row, column) in RIGHT_WITHOUT_NAME for column in columns] for row in rows])
    silent = np.broadcast_to([column in SILENT for column in columns], right.shape) & ~right
    colours = np.ones((*counts.shape, 3))
    for mask, colour in ((right, RIGHT), (silent, MISSED), (~right & ~silent, WRONG)):
        tone = np.array(matplotlib.colors.to_rgb(colour))
        colours = np.where(mask[..., None], 1.0 - shares[..., None] * (1.0 - tone), colours)
    axes.imshow(colours, aspect="auto")
    for (i, k), count in np.ndenumerate(counts):
        if count:
            dark = shares[i, k] > 0.55
            text = f"{count:g}"
            axes.text(k, i, text, ha="center", va="center", fontsize=7, color="wk"[not dark])
    axes.set_xticks(range(len(columns)), [c.replace("_", " ") for c in columns], fontsize=7)
    axes.tick_params(axis="x", rotation=90, length=0)
    axes.tick_params(axis="y", length=0)
    axes.set_yticks(range(len(rows)), [r.replace("_", " ") for r in rows], fontsize=7)
    axes.set_xticks(np.arange(-0.5, len(columns)), minor=True)
    axes.set_yticks(np.arange(-0.5, len(rows)), minor=True)
    axes.grid(which="minor", color=EMPTY, lw=0.5)
    axes.tick_params(which="minor", length=0)
    axes.set_xlabel("answer", fontsize=9)
    axes.set_ylabel("truth", fontsize=9)
    figure.suptitle(
        "Sets with one truth: what was answered (blue right, grey missed, red a wrong name)",
        fontsize=11,
    )


RIGHT_WITHOUT_NAME = {
    ("nothing", "nothing missing"),
    ("slightly wrong", "nothing missing"),
    ("slightly wrong", "unexplained"),
    ("unlisted torque", "unexplained"),
    ("unlisted torque", "partly explained"),
}


def draw_all(results: Sequence[Result], file: Path) -> None:
    """Both pictures above each other, as one file."""
    panels = 1 + len(points_by_effect(results))
    heights = (0.9 + 1.35 * math.ceil(panels / COLUMNS), 7.5)
    figure: Figure = plt.figure(figsize=(12.5, sum(heights)), layout="constrained", dpi=130)
    top, bottom = figure.subfigures(2, 1, height_ratios=heights)
    draw_power(top, results)
    draw_confusion(bottom, results)
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file)
    plt.close(figure)
