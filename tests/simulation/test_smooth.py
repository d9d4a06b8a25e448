"""Smooth motion by the explicit method of order 8, beside SciPy's DOP853."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import DOP853

import ptp_symbolic
from ptp_symbolic.numeric.runtime.model import load_module

START = np.array([0.0, 0.5, 1.0, 0.0])
DRIVEN = {"tau_pan": "multisine:0.3@1", "tau_tilt": "multisine:0.2@0.7"}


def slope(t: float, x):
    u = [0.3 * np.sin(2.0 * np.pi * t), 0.2 * np.sin(1.4 * np.pi * t)]
    model = ptp_symbolic.load("payload")
    return model.rhs(t, x, u, model.parameter_vector())


@pytest.mark.parametrize("length", [0.05, 0.025])
def test_every_step_and_what_is_between_are_those_of_scipy(length: float) -> None:
    """Steps of one length at tolerances that let all pass: the same formulas, to rounding."""
    end, loose = 1.0, {"rtol": 1e3, "atol": 1e3}
    times = np.linspace(0.0, end, 41)
    theirs = DOP853(slope, 0.0, START, end, max_step=length, first_step=length, **loose)
    expected = [START]
    while theirs.status == "running":
        theirs.step()
        inside = times[(times > theirs.t_old + 1e-9) & (times <= theirs.t + 1e-9)]
        expected += list(theirs.dense_output()(inside).T)
    found = ptp_symbolic.simulate(
        "payload", times, DRIVEN, x0=START, largest_step=length, ledger=False, **loose
    )
    assert found.steps == round(end / length)
    assert found.x == pytest.approx(np.array(expected), abs=1e-12)


def test_states_between_steps_are_as_good_as_the_tolerance_says(figure) -> None:
    """The interpolant is of lower order than the steps, which it makes shorter where it counts."""
    times = np.linspace(0.0, 5.0, 2001)
    exact = ptp_symbolic.simulate("payload", times, DRIVEN, x0=START, largest_step=2.5e-3)
    for tolerance in (1e-6, 1e-8):
        found = ptp_symbolic.simulate(
            "payload", times, DRIVEN, x0=START, rtol=tolerance, atol=tolerance, ledger=False
        )
        assert found.steps < 250
        error = np.abs(found.x - exact.x).max()
        assert figure(f"error over a tolerance of {tolerance:g}", error / tolerance) < 30.0


def test_energies_of_a_motion_without_losses_do_not_shorten_its_steps(figure) -> None:
    """Nothing is supplied or dissipated: what is stored stays, within the tolerance."""
    free = {"b_pan": 0.0, "b_tilt": 0.0}
    lean = ptp_symbolic.simulate("payload", 5.0, parameters=free, x0=START, ledger=False)
    found = ptp_symbolic.simulate("payload", 5.0, parameters=free, x0=START)
    assert found.steps <= 2 * lean.steps
    drift = np.abs(found.stored - found.stored[0]).max() / abs(found.stored[0])
    assert figure("drift of the energy", drift) < 1e-7
    assert not found.supplied.any()
    assert not found.dissipated.any()


def test_only_what_a_smooth_run_calls_is_compiled(checkout: Path) -> None:
    """The payload under a name of its own: nobody has compiled it."""
    model = load_module(checkout / "generated/payload.py", "ptp_model_payload_of_this_test")
    ptp_symbolic.simulate(model, 0.1, tau_pan=0.1, ledger=False)
    compiled = {
        name
        for name, value in vars(model.module).items()
        if getattr(value, "nopython_signatures", None)
    }
    parts = {"constants", "mass_and_forces"}  # of these two, unless they come from the cache whole
    assert compiled - parts == {"prepare", "prepared_derivative"}
