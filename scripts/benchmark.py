"""Time the simulation against its peers in one run: `python3 scripts/benchmark.py [--out DIR]`.

Every ratio is of two times taken here, one after the other, on the same jitted functions; each is
processor time, the best of several. How to read the tables:

- "right-hand side": one evaluation in a compiled loop, each state from the last (chained) or from
  a list (throughput), beside gcc's code for the same formulas, which may keep what depends on
  parameters alone out of its loop. Below 1.05 it is as fast as C. "in single precision": the module
  of the target `numba-float` beside that of `numba`, each state from the last.
- "trajectory": 10 s of the payload model at a final error below 1e-9, beside scipy's DOP853.
- "pan_drive": 10 s through stick-slip and gap with 10001 outputs; the error is that of the load
  angle over all outputs against the explicit method at a tolerance of 1e-12. "final" is the time of
  the same run for the final state alone, "ledger" that with outputs and an energy ledger. Ours and
  every peer run at the loosest tolerance of a list that stays below 1e-8 (the error of a peer is
  that at its own steps); a peer keeps no outputs, and its ratio is to "final".
- "first run": 10 s in a new process, its processor time with an empty cache of compiled code (ms)
  and with that full (final).
- "short run": 1 ms of the payload by the public `simulate`, which is all setting up.
- "log of 50,000 rows": a CSV file read and checked, beside numpy's loadtxt, which only reads it.
- "batch": trajectories per second on one core, and how many times as many as each peer.
- "sensitivities": time with six parameters over time without, and their largest relative error.

- "growth": processor time over the number of trajectories, over the simulated time of one run, and
  speed-up by the clock over cores; a curve ends where its next point would take too long.

`--out DIR` writes benchmark.json, work_precision.png (error over time), growth.png and index.html,
a page of all. `--quick` takes about a minute of one core: one input, two peers, short curves, and
no first run with an empty cache. `--all` adds the slower peers; `scripts/work_precision.py` draws
error over time for all inputs and all of them.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import work_precision
from batch_peers import batches
from benchmark_page import page
from drive_runs import CASES, END, LAST, off, prepare, prepare_peer
from growth import draw, growth
from log_reading import log_reading
from right_hand_side import right_hand_side, single_precision
from scipy.integrate import solve_ivp
from timing import Row, best, print_table

import ptp_symbolic
from ptp_symbolic.api.bench import computer
from ptp_symbolic.atomic_files import write_files_atomically
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation import inputs, integration
from ptp_symbolic.numeric.simulation.integration import Solution, integrate
from ptp_symbolic.platform import ParameterDeclaration, read_platform

WANTED = 1e-8  # rad
TOLERANCES = (1e-6, 5e-7, 2e-7, 1e-7, 5e-8, 2e-8, 1e-8, 1e-9)
TOLERANCES_OF_PEERS = (1e-7, 3e-8, 1e-8, 3e-9, 1e-9, 3e-10, 1e-10)
LIMIT, QUICK_LIMIT = 60.0, 1.0  # s, of one point of a curve
QUICK_CASES, QUICK_BATCH = ("step",), 400
QUICK_METHODS = ("rosenbrock", "runge_kutta", "LSODA")
ALL_METHODS = (*work_precision.OURS, *work_precision.PEERS)
SIX = ("F_c_pan", "J_pan", "gap_pan", "k_shaft_pan", "R_pan", "F_v_pan")


def one_trajectory() -> list[Row]:
    """10 s of the payload model, smooth, beside DOP853 on the same function."""
    model = ptp_symbolic.load("payload")
    p, u, start = model.parameter_vector(), np.zeros(2), np.array([0.0, 0.5, 1.0, 0.0])
    table, ends = inputs.stack([inputs.constant(0.0)] * 2), np.array([0.0, END])

    def run(tolerance: float) -> Solution:
        accuracy = integration.Accuracy(tolerance, np.full(4, tolerance), 0.5)
        return integrate(model, "runge_kutta", p, start, table, True, ends, ends, accuracy)

    def peer(tolerance: float) -> Any:
        def rhs(t: float, x: Any) -> Any:
            dx = np.empty(4)
            model.module.mode_derivative(t, x, u, p, x, dx)
            return dx

        return solve_ivp(rhs, (0.0, END), start, method="DOP853", rtol=tolerance, atol=tolerance)

    exact = run(1e-13).x[-1]
    ours = next(t for t in 10.0 ** -np.arange(6.0, 13.0, 0.5) if off(run(t).x[-1], exact) < 1e-9)
    theirs = next(
        t for t in 10.0 ** -np.arange(6.0, 13.0, 0.5) if off(peer(t).y[:, -1], exact) < 1e-9
    )
    (mine, found), (other, _) = best(lambda: run(ours), 50), best(lambda: peer(theirs), 3)
    return [
        {
            "what": "trajectory, payload, 10 s",
            "ms": mine * 1e3,
            "error": off(found.x[-1], exact),
            "peer": "scipy DOP853",
            "peer ms": other * 1e3,
            "ratio": other / mine,
        }
    ]


FIRST = """
import ptp_symbolic, time
ptp_symbolic.simulate({!r}, 10.0, {})
print(time.process_time())
"""
FIRST_RUNS = {"payload": {"tau_pan": "multisine:0.1@1"}, "pan_drive": {"u_pan": "step:24@0.5"}}


def first_runs() -> list[Row]:
    """The first run of a smooth machine and of one with events, interpreter and compiler too."""
    rows: list[Row] = []
    for name, given in FIRST_RUNS.items():
        with TemporaryDirectory() as empty:
            command = [sys.executable, "-c", FIRST.format(name, given)]
            cold, warm = (
                float(
                    subprocess.run(
                        command,
                        env={**os.environ, "NUMBA_CACHE_DIR": empty},
                        capture_output=True,
                        check=True,
                    ).stdout
                )
                for _ in range(2)
            )
        rows.append({"what": f"first run, {name}", "ms": cold * 1e3, "final": warm * 1e3})
    return rows


def short_run() -> list[Row]:
    """What the public function takes beside the integration."""
    model = ptp_symbolic.load("payload")
    taken, _ = best(lambda: ptp_symbolic.simulate(model, 1e-3, tau_pan=0.1), 1000)
    return [{"what": "short run, payload, 1 ms", "ms": taken * 1e3}]


def drive_cases(cases: Sequence[str], everything: bool) -> list[Row]:
    """The pan drive beside scipy's integrators with events."""
    model, rows = ptp_symbolic.load("pan_drive"), []
    for name, signal in ((case, CASES[case]) for case in cases):
        run = prepare(model, signal)
        exact = run(1e-12, method="runge_kutta").x[:, 0]
        tolerance = next(t for t in TOLERANCES if off(run(t).x[:, 0], exact) < WANTED)
        whole, found = best(partial(run, tolerance), 30)
        final, _ = best(partial(run, tolerance, LAST), 30)
        ledger, _ = best(partial(run, tolerance, ledger=True), 30)
        rows.append(
            {
                "what": f"pan_drive, {name}, {len(found.events)} events",
                "tolerance": tolerance,
                "error": off(found.x[:, 0], exact),
                "ms": whole * 1e3,
                "final": final * 1e3,
                "ledger": ledger * 1e3,
            }
        )
        peers = ("LSODA", "Radau", "DOP853") if everything or name == "step" else ("LSODA",)
        rows += [_peer_row(model, name, method, run, final) for method in peers]
    return rows


def _peer_row(
    model: Model, name: str, method: str, run: Callable[..., Solution], ours: float
) -> Row:
    simulate = prepare_peer(model, CASES[name], method, run)
    for tolerance in TOLERANCES_OF_PEERS:
        error, events = simulate(tolerance)
        if error < WANTED:
            break
    taken, _ = best(partial(simulate, tolerance, False), 2)
    return {
        "what": f"pan_drive, {name}, {events} events",
        "peer": f"scipy {method}, events",
        "tolerance": tolerance,
        "error": error,
        "peer ms": taken * 1e3,
        "ratio": taken / ours,
    }


def sampled_controller() -> list[Row]:
    """The pan servo with its controller at 1 kHz, along a ramp that ends: it comes to rest."""
    servo, rows = read_platform("thesis-pan-servo"), []
    fast = ParameterDeclaration("t_sample_pan", "s", 1e-3)
    kept = tuple(p for p in servo.parameters if p.name != "t_sample_pan")
    model = emission.emit(replace(servo, parameters=(*kept, fast)))
    goal = inputs.ramp(0.0, 1.0, 0.0, 5.0)
    run = prepare(model, goal)
    exact = run(1e-11, method="runge_kutta")
    for method in ("rosenbrock", "runge_kutta"):
        whole, found = best(partial(run, 1e-5, method=method))
        final, _ = best(partial(run, 1e-5, LAST, method))
        rows.append(
            {
                "what": f"pan_servo at 1 kHz, {len(found.events)} events, {method}",
                "ms": whole * 1e3,
                "final": final * 1e3,
                "error": off(found.x[:, 0], exact.x[:, 0]),
                "tolerance": 1e-5,
            }
        )
    return rows


def sensitivities(cases: Sequence[str] = ("step", "ramp")) -> list[Row]:
    """Six parameters through the events of the step."""
    model, rows = ptp_symbolic.load("pan_drive"), []
    columns = np.array([model.parameter_names.index(n) for n in SIX])
    given = {"s": np.zeros((5, 6)), "columns": columns}
    for name in cases:
        run = prepare(model, CASES[name])
        exact = run(1e-11, LAST, "runge_kutta", **given)
        for tolerance in (1e-7, 1e-8, 1e-9):
            bare = partial(run, tolerance, LAST)
            (alone, _), (taken, found) = best(bare), best(partial(bare, **given))
            error = np.max(np.abs(found.s[-1, 0] / exact.s[-1, 0] - 1.0))
            rows.append(
                {
                    "what": f"sensitivities, {name}, 6 parameters",
                    "tolerance": tolerance,
                    "error": float(error),
                    "ms": taken * 1e3,
                    "peer": "the run alone",
                    "peer ms": alone * 1e3,
                    "ratio": taken / alone,
                }
            )
    return rows


def whole(everything: bool) -> list[Row]:
    """Every part."""
    return [
        *right_hand_side(),
        *single_precision(),
        *one_trajectory(),
        *short_run(),
        *first_runs(),
        *drive_cases(tuple(CASES), everything),
        *sampled_controller(),
        *sensitivities(),
        *batches(),
        *log_reading(),
    ]


def quick() -> list[Row]:
    """The parts that take seconds."""
    return [
        *right_hand_side(),
        *one_trajectory(),
        *short_run(),
        *drive_cases(QUICK_CASES, False),
        *sampled_controller(),
        *sensitivities(QUICK_CASES),
        *batches(QUICK_BATCH),
        *log_reading(),
    ]


def work_precision_rows(is_quick: bool) -> list[Row]:
    """Error over time, of fewer tolerances, inputs and peers where it `is_quick`."""
    cases, methods = (QUICK_CASES, QUICK_METHODS) if is_quick else (tuple(CASES), ALL_METHODS)
    tolerances = work_precision.TOLERANCES[:: 2 if is_quick else 1]
    pairs = [(case, method) for case in cases for method in methods]
    return [row for pair in pairs for row in work_precision.curve(*pair, tolerances)]


def write(out: Path, content: dict[str, Any]) -> None:
    """Write the JSON, the pictures and the page of `content`."""
    with TemporaryDirectory() as folder:
        pictures = {
            "Error over time": Path(folder, "work_precision.png"),
            "Growth": Path(folder, "growth.png"),
        }
        work_precision.draw(content["work precision"], pictures["Error over time"])
        draw(content["growth"], pictures["Growth"])
        tables = {name: content[name] for name in ("rows", "growth", "work precision")}
        files: dict[str, str | bytes] = {
            "benchmark.json": json.dumps(content, indent=2) + "\n",
            "index.html": page(content["computer"], str(__doc__), tables, pictures),
        }
        files |= {path.name: path.read_bytes() for path in pictures.values()}
        write_files_atomically(out, files)
    print(out / "index.html")


def main() -> None:
    """Run every part; print tables, or JSON, and write files."""
    parser = argparse.ArgumentParser(description="Time the simulation against its peers.")
    parser.add_argument("--json", action="store_true", help="print JSON instead of tables")
    parser.add_argument("--all", action="store_true", help="also the slower peers")
    parser.add_argument("--quick", action="store_true", help="about a minute")
    parser.add_argument("--out", type=Path, help="folder for JSON, pictures and a page")
    arguments = parser.parse_args()
    content: dict[str, Any] = {
        "computer": computer(),
        "rows": quick() if arguments.quick else whole(arguments.all),
        "growth": growth(QUICK_LIMIT if arguments.quick else LIMIT),
        "work precision": work_precision_rows(arguments.quick),
    }
    if arguments.json:
        print(json.dumps(content, indent=2))
    else:
        for name in ("rows", "growth", "work precision"):
            print_table(content[name])
    if arguments.out is not None:
        write(arguments.out, content)


if __name__ == "__main__":
    main()
