"""A window that begins at rest knows from its log how long that has lasted."""

import numpy as np
import pytest

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.numeric.identify.windows import split_run
from ptp_symbolic.platform import EffectDeclaration, Platform, SignalDeclaration

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("csvs_friction", "pan", None),
    EffectDeclaration("rate_dependent_breakaway", "pan", None),
)
SIGNALS = (
    SignalDeclaration("tau_pan", "torque", "N m", "input", None),
    SignalDeclaration("theta_pan", "angle", "rad", "output", 7200),
)
PLATFORM = Platform("dwell", "Pan axis that settles", ("pan",), 9.81, EFFECTS, (), SIGNALS)
COUNT = 2.0 * np.pi / 7200
PERIOD, STOP = 0.01, 2.0  # s; the axis turns at 0.5 rad/s until it stops


@pytest.mark.parametrize("flicker", [0.0, 1.0])
def test_a_window_counts_the_rest_since_the_angle_came_there(flicker: float) -> None:
    """`flicker`: the last digit of a resting encoder changes from sample to sample."""
    time = np.arange(401) * PERIOD
    angle = 0.5 * np.minimum(time, STOP)
    angle[time > STOP] += flicker * COUNT * (np.arange(np.sum(time > STOP)) % 2)
    measured = np.rint(angle / COUNT) * COUNT
    model = emission.emit(PLATFORM)
    log = Log("run", time, np.zeros((len(time), 1)), measured[:, None])
    (run,) = prepare_runs(model, PLATFORM, [log])
    rest = model.state_names.index("rest_time_pan")
    windows = split_run(model, run, 0.5)
    assert len(windows) == 8
    for window in windows:
        expected = max(window.time[0] - STOP, 0.0)
        # a few counts before it stops the angle is where it stays, within its noise
        assert window.start[rest] == pytest.approx(expected, abs=0.02)
    assert max(window.start[rest] for window in windows) > 1.0
