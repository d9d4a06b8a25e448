"""Currents of two motors along a measured motion: where they settle follows from Ohm's law."""

import numpy as np

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.equation_space import prepare_equation_space
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import EffectDeclaration, Platform, SignalDeclaration

AXES = "pan", "tilt"
EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    *(EffectDeclaration("dc_motor", axis, None) for axis in AXES),
)
SIGNALS = tuple(
    signal
    for a in AXES
    for signal in (
        SignalDeclaration(f"u_{a}", f"u_{a}", "V", "input"),
        SignalDeclaration(f"theta_{a}", f"theta_{a}", "rad", "output", noise=1e-5),
        SignalDeclaration(f"i_{a}", f"i_{a}", "A", "output", noise=1e-3),
    )
)
PLATFORM = Platform("two_motors", "Both axes with motors", AXES, 9.81, EFFECTS, (), SIGNALS)
PERIOD = 0.002  # s


def test_every_current_settles_to_its_own_voltage_over_its_resistance() -> None:
    """Back-EMF over resistance per joint rate; the other axis and the inductance have no say."""
    model = emission.emit(PLATFORM)
    time = PERIOD * np.arange(1500)
    angles = np.column_stack([0.1 * np.sin(3.0 * time), 0.1 * np.cos(2.0 * time)])
    columns = {"theta_pan": angles[:, 0], "theta_tilt": angles[:, 1]}
    outputs = np.column_stack([columns.get(n, np.zeros_like(time)) for n in model.output_names])
    log = Log("run", time, np.zeros((len(time), 2)), outputs)
    p = model.parameter_vector({"N_pan": 300.0, "K_t_tilt": 0.05, "R_tilt": 4.0})
    runs = prepare_runs(model, PLATFORM, [log])
    space = prepare_equation_space(model, runs, p, [], p)
    *_, further = space._torques(0, p, None, space.rows_of[0].part)
    at = space.rows_of[0].grid[space.rows_of[0].chosen]
    value = dict(zip(model.parameter_names, p, strict=True))
    expected = np.diag([-value[f"N_{a}"] * value[f"K_t_{a}"] / value[f"R_{a}"] for a in AXES])
    assert len(at) > 40
    assert np.allclose(further.by_rate[at], expected, rtol=1e-6, atol=1e-6)
