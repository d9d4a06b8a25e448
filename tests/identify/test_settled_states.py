"""A window of a motor that runs begins with the current that drives it; the motion is that of a
matrix exponential.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.evaluate import start_state
from ptp_symbolic.numeric.identify.fit import fit_parameters
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.numeric.identify.windows import split_run
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import EffectDeclaration, Platform, SignalDeclaration

VALUES = {
    "J_pan": 0.02,
    "b_pan": 0.8,
    "R_pan": 5.0,
    "L_pan": 0.005,
    "K_t_pan": 0.03,
    "J_motor_pan": 1e-6,
    "N_pan": 200.0,
}
TORQUE = VALUES["N_pan"] * VALUES["K_t_pan"]  # N m/A
LOAD = VALUES["J_pan"] + VALUES["N_pan"] ** 2 * VALUES["J_motor_pan"]  # kg m^2
COUNTS = 1_000_000
COUNT = 2.0 * np.pi / COUNTS
EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("viscous_friction", "pan", None),
    EffectDeclaration("dc_motor", "pan", None),
)
SIGNALS = (
    SignalDeclaration("u_pan", "voltage", "V", "input", None),
    SignalDeclaration("theta_pan", "angle", "rad", "output", COUNTS),
)
PLATFORM = Platform("running", "Pan axis, motor", ("pan",), 9.81, EFFECTS, (), SIGNALS)


def motion(period: float, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Voltages [k] that are held from sample to sample, and the states [k, 3]: angle, rate,
    current; begun at rest.
    """
    voltage = 8.0 + 3.0 * np.sin(1.7 * period * np.arange(samples))
    flow = np.zeros((4, 4))
    flow[0, 1] = 1.0
    flow[1, 1:3] = -VALUES["b_pan"] / LOAD, TORQUE / LOAD
    flow[2, 1:] = [-TORQUE, -VALUES["R_pan"], 1.0]
    flow[2] /= VALUES["L_pan"]
    step, state = expm(period * flow), np.zeros((samples, 3))
    for k in range(samples - 1):
        state[k + 1] = (step @ [*state[k], voltage[k]])[:3]
    return voltage, state


def windows_of(period: float, samples: int) -> tuple[Model, list[Run], np.ndarray]:
    voltage, state = motion(period, samples)
    model = emission.emit(PLATFORM)
    time = period * np.arange(samples)
    reading = np.rint(state[:, :1] / COUNT) * COUNT
    (run,) = prepare_runs(model, PLATFORM, [Log("run", time, voltage[:, None], reading)])
    windows = split_run(model, run, 0.25 * period * samples)
    assert len(windows) == 4
    begun = [state[int(np.searchsorted(time, w.time[0]))] for w in windows]
    return model, list(windows), np.array(begun)


@pytest.mark.parametrize(("period", "within"), [(0.02, 1e-3), (0.005, 0.01)])
def test_a_window_begins_with_the_current_of_its_motion(period: float, within: float) -> None:
    model, windows, begun = windows_of(period, 400)
    p = model.parameter_vector(VALUES)
    states, none = list(model.state_names), np.zeros(0, dtype=np.int64)
    for window, true in zip(windows, begun, strict=True):
        z = window.guess
        rate = [u.name for u in window.unknowns].index("omega_pan")
        z[rate] = true[1] - window.start[states.index("omega_pan")]
        x, _ = start_state(model, window, p, z, none)
        assert x[states.index("i_pan")] == pytest.approx(true[2], abs=within * np.max(begun[:, 2]))


def test_what_windows_leave_is_rounding() -> None:
    """An encoder of a million counts tells a current that has yet to come up."""
    model, windows, _ = windows_of(0.02, 400)
    fit = fit_parameters(model, windows, (), {**model.defaults, **VALUES})
    assert fit.rms_counts() < 1.2 / np.sqrt(12.0)


def test_the_start_goes_with_the_parameters_and_the_rate() -> None:
    model, windows, _ = windows_of(0.02, 400)
    names = ["R_pan", "K_t_pan"]
    columns = np.array([model.parameter_names.index(n) for n in names], dtype=np.int64)
    current = list(model.state_names).index("i_pan")
    window = windows[2]
    _, s = start_state(model, window, model.parameter_vector(VALUES), window.guess, columns)

    def at(changed: dict[str, float], z: np.ndarray) -> float:
        p = model.parameter_vector({**VALUES, **changed})
        return float(start_state(model, window, p, z, columns)[0][current])

    for k, name in enumerate(names):
        step = 1e-4 * VALUES[name]
        by = (
            at({name: VALUES[name] + step}, window.guess)
            - at({name: VALUES[name] - step}, window.guess)
        ) / (2.0 * step)
        assert s[current, k] == pytest.approx(by, rel=1e-5)
    for index in range(len(window.unknowns)):
        z = np.eye(len(window.unknowns))[index] * 1e-3
        by = (at({}, window.guess + z) - at({}, window.guess - z)) / 2e-3
        assert s[current, len(names) + index] == pytest.approx(by, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(("lag", "within"), [(0.01, 0.05), (0.06, 0.2)])
def test_a_window_of_a_turning_joint_begins_ahead_of_its_filtered_encoder(
    lag: float, within: float
) -> None:
    """The filter is integrated by a matrix exponential with the motion; its encoder shows what it
    is behind, and a window that begins there has the joint ahead by it.
    """
    period, samples = 0.005, 800
    voltage, flow = 8.0 + 3.0 * np.sin(1.7 * period * np.arange(samples)), np.zeros((5, 5))
    flow[0, 1] = 1.0
    flow[1, 1:3] = -VALUES["b_pan"] / LOAD, TORQUE / LOAD
    flow[2, 1:3] = -TORQUE / VALUES["L_pan"], -VALUES["R_pan"] / VALUES["L_pan"]
    flow[2, 4] = 1.0 / VALUES["L_pan"]
    flow[3, [1, 3]] = 1.0, -1.0 / lag
    step, state = expm(period * flow), np.zeros((samples, 4))
    for k in range(samples - 1):
        state[k + 1] = (step @ [*state[k], voltage[k]])[:4]
    filtered = replace(
        PLATFORM, effects=(*EFFECTS, EffectDeclaration("measurement_lag", "pan", None))
    )
    model, time = emission.emit(filtered), period * np.arange(samples)
    reading = np.rint((state[:, :1] - state[:, 3:]) / COUNT) * COUNT
    (run,) = prepare_runs(model, filtered, [Log("run", time, voltage[:, None], reading)])
    p = model.parameter_vector({**VALUES, "t_lag_pan": lag})
    names, column = list(model.state_names), list(model.parameter_names).index("t_lag_pan")
    for window in split_run(model, run, 0.25 * period * samples)[1:]:
        at, z = int(np.searchsorted(time, window.time[0])), window.guess
        rate = [u.name for u in window.unknowns].index("omega_pan")
        z[rate] = state[at, 1] - window.start[names.index("omega_pan")]
        x, s = start_state(model, window, p, z, np.array([column]))
        behind = x[names.index("lag_pan")]
        assert behind == pytest.approx(state[at, 3], rel=within)
        assert x[names.index("theta_pan")] - behind == pytest.approx(reading[at, 0], abs=2 * COUNT)
        assert s[names.index("theta_pan"), 0] == pytest.approx(state[at, 1], rel=within)


def test_a_log_that_begins_in_motion_begins_with_its_current() -> None:
    voltage, state = motion(0.005, 400)
    model, late = emission.emit(PLATFORM), slice(150, 400)
    log = Log("late", 0.005 * np.arange(250), voltage[late, None], state[late, :1])
    (run,) = prepare_runs(model, PLATFORM, [log])
    assert "omega_pan" in [u.name for u in run.unknowns]
    x, _ = start_state(model, run, model.parameter_vector(VALUES), run.guess, np.zeros(0, np.int64))
    assert x[list(model.state_names).index("i_pan")] == pytest.approx(state[150, 2], rel=0.02)
