"""Draw what precision costs: `python3 scripts/work_precision.py FILE.png`.

10 s of the pan drive through stick-slip and gap, final state alone, by both of our methods and by
scipy's with events on the same jitted functions, all in one run: for a list of tolerances the
largest error of the load angle (ours at every millisecond, a peer's at its own steps) over time.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
from drive_runs import CASES, LAST, off, prepare, prepare_peer
from rich.progress import track
from timing import Row, best, print_table

import ptp_symbolic

TOLERANCES = (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
OURS = {"rosenbrock": "Rosenbrock, ours", "runge_kutta": "Runge-Kutta, ours"}
PEERS = ("LSODA", "Radau", "DOP853")


def curve(case: str, method: str, tolerances: Sequence[float] = TOLERANCES) -> list[Row]:
    """Tolerance, error and time of one input by one method."""
    model, rows = ptp_symbolic.load("pan_drive"), []
    run = prepare(model, CASES[case])
    exact = run(1e-12, method="runge_kutta").x[:, 0]
    peer = None if method in OURS else prepare_peer(model, CASES[case], method, run)
    for tolerance in tolerances:
        if peer is None:
            error = off(run(tolerance, method=method).x[:, 0], exact)
            taken, _ = best(partial(run, tolerance, LAST, method), 10)
        else:
            error, _ = peer(tolerance)
            taken, _ = best(partial(peer, tolerance, False), 1)
        rows.append(
            {
                "input": case,
                "method": OURS.get(method, f"scipy {method}"),
                "tolerance": tolerance,
                "error, rad": error,
                "ms": taken * 1e3,
            }
        )
    return rows


def draw(rows: list[Row], path: Path) -> None:
    """Draw a panel per input."""
    mpl.use("Agg")
    cases = list(dict.fromkeys(row["input"] for row in rows))
    across = 2 if len(cases) > 1 else 1
    down = -(-len(cases) // across)
    figure, panels = plt.subplots(
        down,
        across,
        figsize=(4.0 + 2.5 * across, 3.5 * down),
        sharex=True,
        squeeze=False,
        layout="constrained",
    )
    for case, panel in zip(cases, panels.flat, strict=True):
        for method in dict.fromkeys(row["method"] for row in rows):
            chosen = [r for r in rows if (r["input"], r["method"]) == (case, method)]
            panel.loglog(
                [r["error, rad"] for r in chosen], [r["ms"] for r in chosen], "o-", label=method
            )
        panel.set_title(case)
        panel.grid(alpha=0.3)
    figure.supxlabel("largest error of the load angle, rad")
    figure.supylabel("time for 10 s, ms")
    figure.legend(
        *panels[0, 0].get_legend_handles_labels(),
        loc="outside upper center",
        ncols=1 + 2 * across,
        fontsize=8,
    )
    figure.savefig(path, dpi=150)
    plt.close(figure)


def main() -> None:
    """Run all inputs by all methods, print the table and draw it."""
    parser = argparse.ArgumentParser(description="Draw error over time beside scipy's methods.")
    parser.add_argument("file", type=Path, help="picture to write, .png, .pdf or .svg")
    path = parser.parse_args().file
    pairs = [(case, method) for case in CASES for method in (*OURS, *PEERS)]
    rows = [row for pair in track(pairs, "running") for row in curve(*pair)]
    print_table(rows)
    draw(rows, path)


if __name__ == "__main__":
    main()
