"""10 s of the pan drive, by our methods and SciPy's with events, on the same jitted functions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ptp_symbolic.api.scipy_peer import simulate_with_scipy
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation import inputs, integration
from ptp_symbolic.numeric.simulation.integration import Solution, integrate, tolerance_weights
from ptp_symbolic.numeric.simulation.kernels.records import DONE

END = 10.0  # s
GRID, LAST = np.linspace(0.0, END, 10001), np.array([0.0, END])
ROSENBROCK = "rosenbrock"
CASES = {
    "step": inputs.step(0.0, 24.0, 0.5),
    "ramp": inputs.ramp(0.0, 4.0, 0.0, END),
    "crawl": inputs.multisine([2.0], [0.15]),
    "multisine": inputs.multisine([5.0, 4.0, 3.0], [0.3, 0.9, 2.1]),
}


def off(x: Any, exact: Any) -> float:
    """Largest difference of two arrays."""
    return float(np.max(np.abs(x - exact)))


def prepare(model: Model, signal: inputs.InputSignal) -> Callable[..., Solution]:
    """A function that runs a geared machine for 10 s from rest: run(tolerance, ...)."""
    table, p, x = inputs.stack([signal]), model.parameter_vector(), np.zeros(len(model.state_names))
    stops, weights = table.with_stops(np.array([0.0, END])), 0.1 * tolerance_weights(model)

    def run(tolerance: float, times: Any = GRID, method: str = ROSENBROCK, **rest: Any) -> Solution:
        accuracy = integration.Accuracy(tolerance, tolerance * weights, 0.1)
        found = integrate(
            model,
            method,
            p,
            x,
            table,
            table.held,
            stops,
            times,
            accuracy,
            event_room=10_000,
            **rest,
        )
        if found.status != DONE:
            raise RuntimeError(f"stopped at {found.reached:g} s with status {found.status}")
        return found

    return run


def prepare_peer(
    model: Model, signal: inputs.InputSignal, method: str, ours: Callable[..., Solution]
) -> Callable[..., tuple[float, int]]:
    """A function that runs 10 s by scipy: run(tolerance) gives its largest error and its events."""
    table, weights = inputs.stack([signal]), 0.1 * tolerance_weights(model)

    def run(tolerance: float, compared: bool = True) -> tuple[float, int]:
        times, states, events = simulate_with_scipy(
            model, table, END, method, tolerance, tolerance * weights
        )
        if not compared:
            return np.nan, events
        order = np.unique(times)
        exact = np.interp(times, order, ours(1e-12, order, "runge_kutta").x[:, 0])
        return off(states[:, 0], exact), events

    return run
