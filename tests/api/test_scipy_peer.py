"""The peers that the benchmark times find the same motion as the simulation."""

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.api.scipy_peer import simulate_with_scipy
from ptp_symbolic.numeric.simulation.inputs import stack, step
from ptp_symbolic.numeric.simulation.integration import tolerance_weights


@pytest.mark.parametrize("method", ["LSODA", "DOP853"])
def test_scipy_with_events_agrees(method: str) -> None:
    model, signal = ptp_symbolic.load("pan_drive"), step(0.0, 24.0, 0.05)
    atol = 1e-9 * tolerance_weights(model)
    times, states, events = simulate_with_scipy(model, stack([signal]), 0.15, method, 1e-8, atol)
    assert np.all(np.diff(times) > 0.0) and times[-1] == 0.15
    state = states[-1]
    ours = ptp_symbolic.simulate(model, np.array([0.0, 0.15]), {"u_pan": signal}, rtol=1e-8)
    assert events == len(ours.events) > 2
    assert state[0] == pytest.approx(ours["theta_pan"][-1], abs=1e-8)
