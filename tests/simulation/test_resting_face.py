"""A joint at rest on the face of its gap, without load: rounding alone decides whether it touches.

All is at rest and nothing pushes, so that nothing may happen: no face lets go, none pushes.
"""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.run import simulate
from ptp_symbolic.platform import read_platform

PLATFORM = Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml"
MACHINE = {
    "J_pan": 0.064,
    "b_pan": 16.4,
    "d_shaft_pan": 100.0,
    "F_c_pan": 0.3,
    "F_s_pan": 0.3,
    "v_s_pan": 0.0092,
    "F_v_pan": 0.0,
}
START = {
    "theta_pan": 0.0064596202631651885,
    "omega_pan": 4.3368086899420227e-16,  # rad/s; what is left of a motion that has died away
    "theta_gear_pan": 0.01946232319052295,  # half the gap ahead, as far as rounding goes
    "i_pan": 0.0006046665569998161,
}


@pytest.mark.parametrize("volts", [0.0, 0.01, -0.01])
def test_nothing_happens_on_an_unloaded_face(volts):
    """A hundredth of a volt does not move a motor that its friction holds."""
    model = emission.emit(read_platform(PLATFORM))
    times = np.arange(0.0, 0.5, 0.005)
    run = simulate(
        model,
        times,
        {model.input_names[0]: f"constant:{volts}"},
        MACHINE,
        START,
        rtol=1e-4,
        atol=1e-6,
    )
    assert run.events == ()
    for name, moved in (("theta_pan", 1e-12), ("theta_gear_pan", 0.0)):
        assert np.ptp(run[name]) <= moved
