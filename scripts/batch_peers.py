"""Batches beside their peers: trajectories per second and core, in one run, on one core.

The payload starts at 200 to 2,000 tilt angles and falls for 10 s at a tolerance of 1e-6; the error
is the largest of all angles at the end. A peer that is not installed has a row that says so.
"""

from __future__ import annotations

import importlib.util
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from timing import Row, best

import ptp_symbolic as ptp

END, TOLERANCE = 10.0, 1e-6
STEP_OF_MUJOCO = 2e-2  # s
Ends = Callable[[np.ndarray[Any, Any]], np.ndarray[Any, Any]]


def batches(most: int = 2000) -> list[Row]:
    """Up to `most` trajectories of the payload beside loops, MuJoCo and diffrax; pan_drive."""
    starts = np.linspace(0.2, 0.6, most)
    exact = _batch(starts, 1e-12)
    rows: list[Row] = []
    peers: list[tuple[str, Ends | None, int]] = [
        ("simulate_batch", lambda x: _batch(x, TOLERANCE), most),
        ("loop over simulate", _loop, 20),
        ("MuJoCo batch, RK4, 20 ms", _mujoco() if _has("mujoco.batch") else None, 20),
        ("diffrax Dopri8, vmap", _diffrax() if _has("diffrax") else None, 200),
        ("numbalsoda", None, 0),
    ]
    for name, run, count in peers:
        if run is None:
            rows.append({"what": "batch, payload, 10 s", "peer": f"{name}: not measured"})
            continue
        seconds, found = best(partial(run, starts[:count]), 3)
        error = float(np.abs(found - exact[:count]).max())
        rate = count / seconds
        rows.append({"what": "batch, payload, 10 s", "peer": name, "per s": rate, "error": error})
    rows.append(_drive())
    for row in rows[1:-1]:
        if "per s" in row:
            row["ratio"] = rows[0]["per s"] / row["per s"]
    return rows


def _has(name: str) -> bool:
    try:
        return importlib.util.find_spec(name) is not None
    except ModuleNotFoundError:
        return False


def _batch(starts: Any, tolerance: float) -> Any:
    found = ptp.simulate_batch(
        "payload", END, x0={"theta_tilt": starts}, rtol=tolerance, atol=tolerance, threads=1
    )
    return found["theta_tilt"]


def _loop(starts: Any) -> Any:
    ends, machine = np.array([0.0, END]), ptp.load("payload")
    return np.array(
        [
            ptp.simulate(
                machine, ends, x0={"theta_tilt": s}, rtol=TOLERANCE, atol=TOLERANCE, ledger=False
            )["theta_tilt"][-1]
            for s in starts
        ]
    )


def _mujoco() -> Ends:
    import mujoco
    from mujoco.batch import Batch

    with tempfile.TemporaryDirectory() as folder:
        path = next(p for p in ptp.export("payload", "mjcf", folder) if p.suffix == ".xml")
        model = mujoco.MjModel.from_xml_string(Path(path).read_text())
    model.opt.integrator, model.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, STEP_OF_MUJOCO

    def run(starts: Any) -> Any:
        batch = Batch(model, nsim=len(starts), nthread=1)
        angles = batch.bind("qpos")
        angles[:, 1] = starts
        for _ in range(round(END / STEP_OF_MUJOCO)):
            batch.step()
        return angles[:, 1].copy()

    return run


def _diffrax() -> Ends:
    import diffrax
    import jax

    space: dict[str, Any] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = ptp.export("payload", "jax", folder)[0]
        exec(Path(path).read_text(), space)
    p, u, m = np.array(space["PARAMETERS"]), np.zeros(2), np.zeros(0)
    control = diffrax.PIDController(rtol=TOLERANCE, atol=TOLERANCE)

    def rate(t: Any, x: Any, _: Any) -> Any:
        arguments = {"t": t, "x": x, "u": u, "p": p, "m": m}
        return space["vector_field"](*(arguments[a] for a in space["ARGUMENTS"]["vector_field"]))

    def one(start: Any) -> Any:
        x0 = jax.numpy.zeros(4).at[1].set(start)
        term = diffrax.ODETerm(rate)
        found = diffrax.diffeqsolve(
            term, diffrax.Dopri8(), 0.0, END, 0.01, x0, stepsize_controller=control
        )
        return found.ys[-1, 1]

    many = jax.jit(jax.vmap(one))
    return lambda starts: np.asarray(many(starts))


def _drive() -> Row:
    """`pan_drive`, a step of 24 V, at an error below 0.01 counts of 8.7e-4 rad."""
    inertia = ptp.load("pan_drive").defaults["J_pan"] * np.linspace(1.0, 1.2, 200)

    def run(tolerance: float) -> Any:
        return ptp.simulate_batch(
            "pan_drive",
            END,
            u_pan="step:24@0.5",
            J_pan=inertia,
            rtol=tolerance,
            atol=8.7 * tolerance,
            threads=1,
        )["theta_pan"]

    seconds, found = best(partial(run, 1e-6), 3)
    error = float(np.abs(found - run(1e-9)).max())
    return {
        "what": "batch, pan_drive, 10 s",
        "peer": "simulate_batch",
        "per s": 200 / seconds,
        "error": error,
    }


if __name__ == "__main__":
    for row in batches():
        print(row)
