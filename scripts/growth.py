"""How time grows with the number of trajectories, the length of a run and the cores.

Each curve ends where its next point would take longer than a limit. Seconds are of the processor,
of all threads, but for those over cores, which a clock on the wall shows: there, and there alone,
other programs on the machine count.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
from timing import Row

import ptp_symbolic as ptp
from ptp_symbolic.api.scipy_peer import simulate_with_scipy
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.simulation.integration import tolerance_weights
from ptp_symbolic.numeric.simulation.lanes import cores
from ptp_symbolic.numeric.simulation.run import input_table

COUNTS = (10, 100, 1_000, 10_000, 100_000, 1_000_000)
LENGTHS = (1.0, 10.0, 60.0, 600.0, 3600.0)  # s
PER_CORE = {"payload": 20_000, "pan_drive": 500}  # trajectories, which take half a second or so
END, TOLERANCE = 10.0, 1e-6
DRIVEN = {
    "payload": {"tau_pan": "multisine:0.05@0.3,0.7", "tau_tilt": "multisine:0.05@0.2,0.9"},
    "pan_drive": {"u_pan": "multisine:5@0.3,0.9,2.1"},
}
# With looser tolerances LSODA finds events without end at rest.
PEERS = {"payload": ("DOP853", 1e-6), "pan_drive": ("LSODA", 1e-8)}
BATCH, LOOP = "simulate_batch", "loop over simulate"
OVER_COUNT, OVER_LENGTH, OVER_CORES = "trajectories", "length of a run", "cores"


def growth(limit: float) -> list[Row]:
    """All curves, each with points of up to `limit` s."""
    return [*over_trajectories(limit), *over_length(limit), *over_cores()]


def over_trajectories(limit: float) -> list[Row]:
    """10 s, final states, on one core, as a batch and in a loop."""
    rows = []
    for name in DRIVEN:
        ways: dict[str, Callable[[int], Any]] = {
            BATCH: partial(_batch, name, threads=1),
            LOOP: partial(_loop, name),
        }
        for way, run in ways.items():
            for count, seconds in _curve(run, COUNTS, limit):
                row = {"what": OVER_COUNT, "model": name, "how": way, "n": count, "s": seconds}
                rows.append(row | {"us each": seconds / count * 1e6})
    return rows


def over_length(limit: float) -> list[Row]:
    """One run under sines that go on, the final state alone, beside SciPy on the same functions."""
    rows = []
    for name, (peer, tolerance) in PEERS.items():
        ways: dict[str, Callable[[float], Any]] = {
            "simulate": partial(_run, ptp.load(name)),
            f"scipy {peer} at {tolerance:g}": partial(_by_scipy, name, peer, tolerance),
        }
        for way, run in ways.items():
            for length, seconds in _curve(run, LENGTHS, limit):
                row = {"what": OVER_LENGTH, "model": name, "how": way, "length, s": length}
                rows.append(row | {"s": seconds, "ms each s": seconds / length * 1e3})
    return rows


def over_cores() -> list[Row]:
    """A batch on 1, 2, 4 ... cores: how many times faster by the clock, and how much more work."""
    rows = []
    numbers = [k for k in (1, 2, 4, 8, 16, 32, 64, 128) if k <= cores()]
    for name, count in PER_CORE.items():
        for k in dict.fromkeys([*numbers, cores()]):
            run = partial(_batch, name, count, threads=k)
            run()
            wall, work = time.perf_counter(), time.process_time()
            run()
            taken, worked = time.perf_counter() - wall, time.process_time() - work
            row = {"what": OVER_CORES, "model": name, "how": BATCH, "cores": k, "s": worked}
            rows.append(row | {"s by the clock": taken})
    return rows


def _curve(
    run: Callable[[Any], Any], sizes: Sequence[float], limit: float
) -> list[tuple[Any, float]]:
    """Sizes and seconds; a size is left out, with those after it, that would take `limit` s or
    that a peer does not reach, which is said.
    """
    run(sizes[0])
    found: list[tuple[Any, float]] = []
    for size in sizes:
        if found and found[-1][1] * size / found[-1][0] > limit:
            break
        taken = []
        try:
            for _ in range(3):
                start = time.process_time()
                run(size)
                taken.append(time.process_time() - start)
                if sum(taken) > 0.1 * limit:
                    break
        except InputError as error:
            print(f"{size:g}: {error}", file=sys.stderr)
            break
        found.append((size, min(taken)))
    return found


def _varied(name: str, count: int) -> dict[str, Any]:
    """What differs between trajectories: the tilt at the start, or the inertia of the load."""
    if name == "payload":
        return {"x0": {"theta_tilt": np.linspace(0.2, 0.6, count)}}
    inertia = ptp.load(name).defaults["J_pan"] * np.linspace(1.0, 1.2, count)
    return {"parameters": {"J_pan": inertia}, "inputs": {"u_pan": "step:24@0.5"}}


def _batch(name: str, count: int, threads: int) -> Any:
    same: dict[str, Any] = {"rtol": TOLERANCE, "atol": TOLERANCE, "threads": threads}
    return ptp.simulate_batch(ptp.load(name), END, **same, **_varied(name, count))


def _loop(name: str, count: int) -> None:
    machine, given, ends = ptp.load(name), _varied(name, count), np.array([0.0, END])
    same: dict[str, Any] = {"rtol": TOLERANCE, "atol": TOLERANCE, "ledger": False}
    same["inputs"] = given.get("inputs")
    kind = "x0" if "x0" in given else "parameters"
    ((varied, values),) = given[kind].items()
    for value in values:
        same[kind] = {varied: value}
        ptp.simulate(machine, ends, **same)


def _run(machine: ptp.Machine, length: float) -> Any:
    same: dict[str, Any] = {"rtol": TOLERANCE, "atol": TOLERANCE, "ledger": False}
    return ptp.simulate(machine, np.array([0.0, length]), DRIVEN[machine.name], **same)


def _by_scipy(name: str, method: str, tolerance: float, length: float) -> Any:
    machine = ptp.load(name)
    table = input_table(machine, DRIVEN[name], machine.parameter_vector(), length)
    atol = 0.1 * tolerance * tolerance_weights(machine)
    return simulate_with_scipy(machine, table, length, method, tolerance, atol)


def draw(rows: list[Row], path: Path) -> None:
    """Draw the three kinds of growth side by side."""
    mpl.use("Agg")
    figure, panels = plt.subplots(1, 3, figsize=(13.0, 4.6), layout="constrained")
    axes = {OVER_COUNT: "n", OVER_LENGTH: "length, s", OVER_CORES: "cores"}
    labels = {
        OVER_COUNT: ("trajectories of 10 s, one core", "processor time, s"),
        OVER_LENGTH: ("simulated time, s", "processor time, s"),
        OVER_CORES: ("cores", "times as fast as one core, by the clock"),
    }
    for panel, (what, size) in zip(panels, axes.items(), strict=True):
        chosen = [row for row in rows if row["what"] == what]
        for model, how in dict.fromkeys((row["model"], row["how"]) for row in chosen):
            own = [row for row in chosen if (row["model"], row["how"]) == (model, how)]
            x = [row[size] for row in own]
            y = [row["s"] for row in own]
            if what == OVER_CORES:
                y = [own[0]["s by the clock"] / row["s by the clock"] for row in own]
            line = "o-" if how in (BATCH, "simulate") else "s--"
            colour = f"C{list(DRIVEN).index(model)}"
            panel.plot(x, y, line, color=colour, label=f"{model}, {how}")
        if what == OVER_CORES:
            panel.plot(x, x, ":", color="0.5", label="as many as cores")
            panel.set_xticks(x)
        else:
            panel.set_xscale("log")
            panel.set_yscale("log")
        panel.set_xlabel(labels[what][0])
        panel.set_ylabel(labels[what][1])
        panel.grid(alpha=0.3)
        place = "upper left" if what == OVER_CORES else "lower right"
        panel.legend(frameon=False, fontsize=8, loc=place)
    figure.savefig(path, dpi=150)
    plt.close(figure)
