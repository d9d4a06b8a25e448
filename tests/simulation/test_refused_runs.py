"""Runs that would not end, or mean nothing, are refused with what to change; what is saved."""

import numpy as np
import pytest

from ptp_symbolic import load, simulate
from ptp_symbolic.numeric.simulation.run import SimulationError


def test_inputs_too_fast_to_follow_use_up_the_steps() -> None:
    with pytest.raises(SimulationError, match=r"Stopped at \S+ s with .*: all steps are used up"):
        simulate(load("ideal"), 1.0, {"tau_pan": "multisine:1@1e9"}, most_steps=20_000)


def test_enough_steps_are_no_matter() -> None:
    few = simulate(load("ideal"), 1.0, {"tau_pan": "step:0.1@0.5"}, most_steps=20_000)
    assert few.steps < 20_000


def test_an_inertia_next_to_nothing_is_named_as_the_cause() -> None:
    with pytest.raises(SimulationError, match="inertia, an inductance or a time constant next to"):
        simulate(load("pan_drive"), 0.2, {"u_pan": "sweep:14@0.1..5"}, {"J_pan": 1e-11})


def test_steps_of_fixed_length_whose_energies_do_not_add_up_are_refused() -> None:
    """The machine turns ten times within a step: the motion is made up."""
    fast = {"omega_pan": 1e5, "omega_tilt": 1.0}
    with pytest.raises(SimulationError, match=r"make \S+ J out of nothing, \d\d % of"):
        simulate(load("ideal"), 0.002, initial=fast, method="fixed_step")


def test_states_that_are_saved_are_those_that_were_named() -> None:
    model = load("pan_drive")
    whole = simulate(model, 0.2, {"u_pan": "step:12@0.05"})
    some = simulate(model, 0.2, {"u_pan": "step:12@0.05"}, save=("i_pan", "theta_pan"))
    assert some.state_names == ("i_pan", "theta_pan")
    assert np.array_equal(some["i_pan"], whole["i_pan"])
    assert some.x.shape == (len(whole.t), 2)
    with pytest.raises(ValueError, match="Unknown state 'i_tilt'"):
        simulate(model, 0.2, save=("i_tilt",))


def test_without_a_ledger_a_servo_goes_from_sample_to_sample() -> None:
    """The same motion: the exponential step takes a whole sample at once, powers are not asked."""
    model = load("thesis-pan-servo")
    inputs = {model.input_names[0]: "step:0.5@0.1"}
    whole = simulate(model, [0.0, 0.5, 1.0], inputs)
    swift = simulate(model, [0.0, 0.5, 1.0], inputs, ledger=False)
    assert len(swift.stored) == len(swift.supplied) == len(swift.dissipated) == 0
    assert swift.steps <= whole.steps
    assert swift["theta_pan"] == pytest.approx(whole["theta_pan"], abs=1e-6)
