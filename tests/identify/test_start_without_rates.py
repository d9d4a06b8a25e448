"""A window that would begin where no rate is finite: its simulation fails, and the fit goes on."""

from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import EffectDeclaration, Platform, SignalDeclaration

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("dc_motor", "pan", None),
)
SIGNALS = (
    SignalDeclaration("u_pan", "u_pan", "V", "input"),
    SignalDeclaration("theta_pan", "theta_pan", "rad", "output", noise=1e-5),
)
PLATFORM = Platform("motor", "Pan axis with a motor", ("pan",), 9.81, EFFECTS, (), SIGNALS)


@pytest.mark.parametrize("tangents", [False, True])
def test_a_back_emf_that_is_infinite(tangents: bool) -> None:
    model = emission.emit(PLATFORM)
    time = 0.005 * np.arange(400)
    log = Log("run", time, np.ones((400, 1)), np.sin(time)[:, None])
    (run,) = prepare_runs(model, PLATFORM, [log])
    window = replace(run, before=run.held_inputs[0])
    p = model.parameter_vector({"N_pan": 300.0, "K_t_pan": 0.05})
    z = np.array([1e308 if u.name.startswith("omega_") else 0.0 for u in window.unknowns])
    assert z.any()
    columns = np.array([model.parameter_names.index("K_t_pan")])
    found = evaluate(model, window, p, z, columns, tangents, Tolerance(1e-6, 1e-6))
    assert found.failed is not None
    assert not found.residual.any()
