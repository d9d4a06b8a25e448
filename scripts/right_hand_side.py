"""One evaluation of the right-hand side beside gcc's code for the same formulas, and in single
precision beside double.
"""

from __future__ import annotations

from functools import partial
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType

import numpy as np
from c_peer import compile_c, pointer
from numba import njit
from timing import Row, best

import ptp_symbolic
from ptp_symbolic.numeric.runtime.model import COMMITTED
from ptp_symbolic.numeric.simulation.kernels.records import KERNEL


@njit(**KERNEL)
def _chained(derivative, count, x, u, p, dx):  # type: ignore[no-untyped-def]
    for _ in range(count):
        derivative(0.0, x, u, p, x, dx)
        for a in range(4):
            x[a] += 1e-9 * dx[a]
    return x[0]


@njit(**KERNEL)
def _independent(derivative, count, states, u, p, dx):  # type: ignore[no-untyped-def]
    total = 0.0
    for i in range(count):
        derivative(0.0, states[i % len(states)], u, p, dx, dx)
        for a in range(4):
            total += dx[a]
    return total


def right_hand_side() -> list[Row]:
    """The payload model's right-hand side beside C."""
    model, count = ptp_symbolic.load("payload"), 20_000
    p, u, library = model.parameter_vector(), np.array([0.3, 1.0]), compile_c(model)
    states = np.random.default_rng(1).standard_normal((64, 4))
    x, dx, derivative = states[0].copy(), np.zeros(4), model.module.mode_derivative
    times = {
        "chained": best(lambda: _chained(derivative, count, x, u, p, dx), 500)[0],
        "throughput": best(lambda: _independent(derivative, count, states, u, p, dx), 500)[0],
    }
    if library is None:
        return [
            {"what": f"right-hand side, {name}", "ns": t / count * 1e9, "peer": "no gcc here"}
            for name, t in times.items()
        ]
    peer = {
        "chained": lambda: library.chained(count, pointer(x), pointer(u), pointer(p)),
        "throughput": lambda: library.independent(
            count, len(states), pointer(states), pointer(u), pointer(p)
        ),
    }
    rows = []
    for name, t in times.items():
        c, peer_name = best(peer[name], 500)[0], "gcc -O3 -march=native"
        rows.append(
            {
                "what": f"right-hand side, {name}",
                "ns": t / count * 1e9,
                "peer": peer_name,
                "peer ns": c / count * 1e9,
                "ratio": t / c,
            }
        )
    return rows


@njit(**KERNEL)
def _in_modes(derivative, count, h, x, u, p, m, dx):  # type: ignore[no-untyped-def]
    for _ in range(count):
        derivative(h, x, u, p, m, dx)
        for a in range(len(x)):
            x[a] += h * dx[a]
    return x[0]


def _imported(path: Path) -> ModuleType:
    spec = spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def single_precision() -> list[Row]:
    """The right-hand side of the committed models in single precision, beside double."""
    count, rows = 20_000, []
    for name, preset in COMMITTED.items():
        times = []
        for target, kind in (("numba-float", np.float32), ("numba", np.float64)):
            with TemporaryDirectory() as folder:
                (path,) = ptp_symbolic.export(preset, target, folder)
                module = _imported(path)
                x, u, m, dx = (
                    np.full(len(names), 0.1, kind)
                    for names in (
                        module.STATE_NAMES,
                        module.INPUT_NAMES,
                        module.MODE_NAMES,
                        module.STATE_NAMES,
                    )
                )
                p = np.array([row[2] for row in module.PARAMETERS], kind)
                m[:] = 1.0
                derivative, h = module.mode_derivative, kind(1e-9)
                run = partial(_in_modes, derivative, count, h, x, u, p, m, dx)
                times.append(best(run, 200)[0] / count * 1e9)
        own, double = times
        what = f"right-hand side in single precision, {name}"
        peer = {"peer": "double precision", "peer ns": double, "ratio": own / double}
        rows.append({"what": what, "ns": own, **peer})
    return rows
