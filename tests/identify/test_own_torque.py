"""What an input lacks for the torque of a motor to be the model's own: a joint that turns at one
rate, whose motor has the voltage of another torque than that takes; the current is not measured.
"""

from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.equation_space import prepare_equation_space
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from tests.identify.pan_runs import COUNT, KNOWN, MODEL, PLATFORM
from tests.identify.test_rows_off_face import EMF, FRICTION, LOAD, RATE, P

DRAG = 0.1  # N m that the motor has too much
SHOWN = tuple(s for s in PLATFORM.signals if s.signal != "i_pan")


def test_an_input_lacks_the_same_whatever_was_asked_before() -> None:
    """0.1 N m too much are 0.1 R / (N K_t) = 0.036 V too much. Asked a second time, with currents
    kept from rows with that voltage, 0.001 V was the answer.
    """
    time = 0.005 * np.arange(800)
    volts = EMF * RATE + KNOWN["R_pan"] * (FRICTION + LOAD + DRAG) / EMF
    angle = np.rint(RATE * time / COUNT) * COUNT
    log = Log("run", time, np.full((800, 1), volts), angle[:, None])
    runs = prepare_runs(MODEL, replace(PLATFORM, signals=SHOWN), [log])
    space = prepare_equation_space(MODEL, runs, P, [], P)
    middle = slice(len(space.rows_of[0].grid) // 4, -(len(space.rows_of[0].grid) // 4))
    for _ in range(2):
        (own,) = space.own_torque(P)
        lacking = float(np.mean(own[middle, 0]))
        assert lacking == pytest.approx(-KNOWN["R_pan"] * DRAG / EMF, rel=0.02)
        assert abs(float(np.mean(space.rows(P, [own])))) < 0.02 * DRAG
    assert abs(float(np.mean(space.rows(P)))) == pytest.approx(DRAG, rel=0.02)
