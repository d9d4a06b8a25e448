"""Rows in which a joint has left the face of its gap: no face pulls.

The joint turns at one rate throughout. For two seconds its motor has no voltage, so that the gear
could only be dragged along; then it has the voltage of that rate for four.
"""

import numpy as np
import pytest

from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.equation_space import EquationSpace, prepare_equation_space
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from tests.identify.pan_runs import COUNT, KNOWN, MODEL, PLATFORM, TRUTH

RATE, DRAGGED, PERIOD = 0.2, 2.0, 0.005  # rad/s, s, s
P = MODEL.parameter_vector({**KNOWN, **TRUTH})
EMF = KNOWN["N_pan"] * KNOWN["K_t_pan"]  # V s/rad, and N m/A, at the gear output
FRICTION = (
    TRUTH["F_c_pan"] + TRUTH["F_v_pan"] * RATE
)  # N m at the gear; Stribeck's part has died out
LOAD = TRUTH["b_pan"] * RATE  # N m that the joint takes


def space_of(direction: float, drag: float = 0.0) -> EquationSpace:
    """The rows of that motion, either way; after that the motor lacks the torque `drag`."""
    time = PERIOD * np.arange(round(3.0 * DRAGGED / PERIOD))
    current = (FRICTION + LOAD - drag) / EMF
    volts = np.where(time < DRAGGED, 0.0, EMF * RATE + KNOWN["R_pan"] * current)
    angle = np.rint(direction * RATE * time / COUNT) * COUNT
    flowing = np.where(time < DRAGGED, -EMF * RATE / KNOWN["R_pan"], current)
    outputs = np.column_stack([direction * flowing, angle])
    log = Log("run", time, direction * volts[:, None], outputs)
    runs = prepare_runs(MODEL, PLATFORM, [log])
    return prepare_equation_space(MODEL, runs, P, [], P)


def torque_rows(space: EquationSpace) -> np.ndarray:
    """Times [n] in s of the rows of the torque."""
    equation, _, time = space.labels()
    return time[equation == 0]


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_rows_of_a_joint_that_runs_ahead_are_left_out(direction: float) -> None:
    space = space_of(direction)
    before = torque_rows(space)
    assert np.sum(before < DRAGGED - 0.5) > 20
    assert space.leave_out_pulled(P, np.array([0.2]))
    after = torque_rows(space)
    assert np.min(after) > DRAGGED
    assert np.array_equal(after, before[before >= np.min(after)])
    assert not space.leave_out_pulled(P, np.array([0.2]))


def test_rows_within_the_margin_stay() -> None:
    """The motor lacks 0.1 N m more than the joint takes: a model may be that far off."""
    space = space_of(1.0, drag=LOAD + 0.1)
    assert space.leave_out_pulled(P, np.array([0.2]))
    assert np.sum(torque_rows(space) > DRAGGED) > 20


def test_all_rows_stay_where_most_would_be_pulled() -> None:
    """Then the parameters are wrong, not the face."""
    space = space_of(1.0, drag=LOAD + 0.1)
    before = torque_rows(space)
    assert not space.leave_out_pulled(P, np.array([0.05]))
    assert np.array_equal(torque_rows(space), before)
