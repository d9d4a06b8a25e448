"""Kernels for a GPU in numba's simulator: against closed forms, and against runs one by one."""

import importlib.util
from collections.abc import Iterator

import numba
import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.api.machine import Machine
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.gpu.batch import IMPOSSIBLE, GpuStates, integrate_on_gpu, is_simulated
from ptp_symbolic.numeric.simulation.inputs import constant, parse_profile, table
from ptp_symbolic.numeric.simulation.kernels.records import DIVERGED, DONE, OUTSIDE
from ptp_symbolic.platform import EffectDeclaration, Platform
from tests.effects.test_backlash_kinds import PUSHED, platform


@pytest.fixture(autouse=True)
def simulator(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The simulator of numba-cuda, in place of a GPU."""
    pytest.importorskip("numba_cuda", reason="numba-cuda is not installed: the extra gpu")
    monkeypatch.setattr(numba.config, "ENABLE_CUDASIM", 1)
    from numba import cuda

    if not is_simulated(cuda):
        pytest.skip("numba.cuda was imported without its simulator before these tests")
    yield


def _rows(model: ptp.Machine, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Parameters and initial states of `count` equal runs."""
    p, x = model.parameter_vector(), np.array(model.module.STATE_INITIAL)
    return np.repeat(p[None], count, 0), np.repeat(x[None], count, 0)


def test_bodies_with_viscous_friction_follow_their_exponential() -> None:
    model = ptp.load("ideal")
    p, x = _rows(model, 3)
    pan, tilt, b = (model.parameter_names.index(n) for n in ("J_pan", "J_z_tilt", "b_pan"))
    p[:, pan], p[:, b] = [5e-4, 6e-4, 5e-4], [1e-3, 1e-3, 2e-3]
    inertia = p[:, pan] + p[:, tilt]  # the tilt body stays level
    torques = [0.01, -0.02]
    kinds = [[constant(torque), constant(0.0)] for torque in torques]
    kind = np.array([0, 1, 1])
    found = integrate_on_gpu(model, p, x, kinds, kind, (0.0, 0.5), rtol=1e-7, atol=1e-8)
    torque = np.array(torques)[kind]
    speed = torque / p[:, b] * (1.0 - np.exp(-p[:, b] * 0.5 / inertia))
    angle = (torque * 0.5 - inertia * speed) / p[:, b]
    assert found.status.tolist() == [DONE] * 3
    assert found.x[:, model.state_names.index("omega_pan")] == pytest.approx(speed, rel=1e-6)
    assert found.x[:, model.state_names.index("theta_pan")] == pytest.approx(angle, rel=1e-6)


def _one_by_one(
    model: ptp.Machine, signals: list, x: np.ndarray, end: float, **how: object
) -> np.ndarray:
    """The final states of single runs on the processor."""
    inputs = dict(zip(model.input_names, signals, strict=True))
    finals = []
    for start in x:
        initial = dict(zip(model.state_names, start, strict=True))
        run = ptp.simulate(model, [0.0, end], inputs=inputs, initial=initial, **how)
        finals.append([run[name][-1] for name in model.state_names])
    return np.array(finals)


def test_a_payload_moves_as_in_single_runs_through_jumps_tables_and_sines() -> None:
    model, end = ptp.load("payload"), 0.25
    held = table(np.array([0.0, 0.07, 0.16]), np.array([0.02, -0.03, 0.01]), "hold")
    signals = [held, parse_profile("sweep:0.05@1..9", end)]
    p, x = _rows(model, 2)
    x[:, 1] = 0.3, -0.2
    found = integrate_on_gpu(model, p, x, [signals], None, (0.0, end), rtol=1e-8, atol=1e-9)
    single = _one_by_one(model, signals, x, end, rtol=1e-11, atol=1e-12)
    assert found.x == pytest.approx(single, abs=1e-7)
    assert np.ptp(single[:, 1]) > 0.1  # the two runs differ


def test_a_drive_sticks_slides_and_crosses_its_gap_as_in_single_fixed_steps() -> None:
    model, end, h = ptp.load("pan_drive"), 0.26, 2e-3
    signals = [parse_profile("trapezoid:12,0.12,0.05,0.02@0.011", end)]
    p, x = _rows(model, 2)
    x[1, model.state_names.index("omega_gear_pan")] = -0.3
    found = integrate_on_gpu(model, p, x, [signals], None, (0.0, end), step=h)
    single = _one_by_one(model, signals, x, end, method="fixed_step", step=h)
    run = ptp.simulate(model, [0.0, end], inputs={"u_pan": signals[0]}, method="fixed_step", step=h)
    modes = {event.mode for event in run.events}
    assert {"slides forward", "touches the upper face", "is in the gap"} <= modes
    assert found.status.tolist() == [DONE, DONE]
    assert found.x == pytest.approx(single, abs=1e-11)
    assert found.steps.tolist() == [run.steps, run.steps]


def _some_fail() -> tuple[ptp.Machine, GpuStates]:
    model = ptp.load("pan_drive")
    p, x = _rows(model, 5)
    p[1, model.parameter_names.index("J_pan")] = -0.05
    p[2, model.parameter_names.index("F_s_pan")] = 0.01  # less than F_c
    x[3, 0] = np.nan
    x[4, 0] = 1e13
    return model, integrate_on_gpu(model, p, x, [[constant(3.0)]], None, (0.0, 0.01), step=1e-3)


def test_delays_are_those_of_each_run() -> None:
    effects = ("rigid_bodies", None), ("viscous_friction", "pan"), ("input_delay", "pan")
    declared = tuple(EffectDeclaration(effect, axis, None) for effect, axis in effects)
    model = Machine(
        emission.emit(Platform("late", "Late", ("pan",), 9.81, declared, (), ())).module
    )
    J, b, torque, delay = 1e-3, 2e-3, 0.02, np.array([0.013, 0.0])
    p = np.repeat(model.parameter_vector({"J_pan": J, "b_pan": b})[None], 2, 0)
    p[:, model.parameter_names.index("t_delay_pan")] = delay
    drive = [parse_profile(f"step:{torque}@0.05", 0.3)]
    for method in ("runge_kutta", "fixed_step"):
        found = integrate_on_gpu(
            model, p, np.zeros((2, 2)), [drive], None, (0.0, 0.3), method, 1e-3, 1e-9, 1e-10
        )
        driven = 0.3 - 0.05 - delay
        speed = torque / b * (1.0 - np.exp(-b * driven / J))
        assert found.x[:, 1] == pytest.approx(speed, rel=1e-7 if method == "runge_kutta" else 1e-6)


def test_a_run_that_leaves_its_domain_says_which_limit() -> None:
    model = ptp.load("tilt_drive")
    p, x = _rows(model, 3)
    x[1:, 0] = 0.79, 0.81  # rad; the stroke ends at 0.797
    kinds = [[constant(0.0)], [constant(-24.0)]]
    found = integrate_on_gpu(model, p, x, kinds, np.array([0, 1, 0]), (0.0, 1.0), step=0.01)
    assert found.status.tolist() == [DONE, OUTSIDE, OUTSIDE]
    assert "past the stroke end" in found.reasons[1] and np.isnan(found.x[1]).all()
    initial = {"theta_tilt": 0.79}
    with pytest.raises(InputError, match="past the stroke end") as single:
        ptp.simulate(
            model,
            [0.0, 1.0],
            {"u_tilt": kinds[1][0]},
            None,
            initial,
            method="fixed_step",
            step=0.01,
        )
    stopped, alone = (float(said.split()[2]) for said in (found.reasons[1], str(single.value)))
    assert alone == pytest.approx(stopped, abs=0.01)  # a step
    assert found.reasons[2].startswith("Stopped at 0 s with theta_tilt = 0.81 rad")


def test_runs_that_are_impossible_say_so_and_the_others_finish() -> None:
    _, found = _some_fail()
    assert found.status.tolist() == [DONE, IMPOSSIBLE, IMPOSSIBLE, IMPOSSIBLE, DIVERGED]
    assert np.isfinite(found.x[0]).all() and np.isnan(found.x[1:]).all()
    assert found.reasons[0] == ""
    assert found.reasons[1].startswith("Parameter 'J_pan' = -0.05 kg m^2 lies outside its bounds")
    assert "F_s is at least F_c" in found.reasons[2]
    assert "give a finite number" in found.reasons[3]
    assert "the state diverges" in found.reasons[4]


def _start(model: ptp.Machine, **how: object) -> GpuStates:
    p, x = _rows(model, 1)
    drives = [[constant(0.0)] * len(model.input_names)]
    return integrate_on_gpu(model, p, x, drives, None, (0.0, 1.0), **how)


def test_without_the_library_or_a_gpu_one_line_says_what_to_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from numba import cuda

    monkeypatch.setattr(cuda, "is_available", lambda: False)
    with pytest.raises(InputError, match=r"No NVIDIA GPU .* NUMBA_ENABLE_CUDASIM=1"):
        _start(ptp.load("ideal"))
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"pip install 'ptp-symbolic\[gpu\]'"):
        _start(ptp.load("ideal"))


def test_what_has_no_kernel_is_refused() -> None:
    model = ptp.load("pan_drive")
    with pytest.raises(InputError, match="take the method fixed_step"):
        _start(model, method="runge_kutta")
    with pytest.raises(InputError, match="Choose from: runge_kutta, fixed_step"):
        _start(model, method="euler")
    with pytest.raises(InputError, match="Step 1e-09 s for 1 s; give one of at least 1e-06 s"):
        _start(model, step=1e-9)
    with pytest.raises(InputError, match="Step -1 s; give a positive number"):
        _start(model, step=-1.0)
    p, x = _rows(model, 2)
    with pytest.raises(InputError, match=r"Initial states of shape \(1, 5\); give \[n, 5\]"):
        integrate_on_gpu(model, p, x[:1], [[constant(0.0)]], None, (0.0, 1.0))
    with pytest.raises(InputError, match="2 signals; give 1: u_pan"):
        integrate_on_gpu(model, p, x, [[constant(0.0)] * 2], None, (0.0, 1.0))
    with pytest.raises(InputError, match="one for each of 2 runs, from 0 to 0"):
        integrate_on_gpu(model, p, x, [[constant(0.0)]], np.array([0, 1]), (0.0, 1.0))


@pytest.mark.parametrize("kind", ["elastic_impact", "hysteresis_friction"])
def test_rigid_faces_strike_and_rest_as_in_single_fixed_steps(kind: str) -> None:
    model = Machine(emission.emit(platform(kind)).module)
    end, h, given = 0.3, 2e-3, {**PUSHED, "e_gap_pan": 0.3}
    given = {name: value for name, value in given.items() if name in model.parameter_names}
    p = np.repeat(model.parameter_vector(given)[None], 3, 0)
    x = np.zeros((3, len(model.state_names)))
    x[:, model.state_names.index("i_pan")] = 50.0, -30.0, 50.0
    x[2, model.state_names.index("theta_gear_pan")] = 0.1  # beyond the face
    signals = [constant(500.0)]
    found = integrate_on_gpu(model, p, x, [signals], None, (0.0, end), step=h)
    single = _one_by_one(model, signals, x[:2], end, method="fixed_step", step=h, parameters=given)
    run = ptp.simulate(
        model,
        [0.0, end],
        inputs={"u_pan": signals[0]},
        parameters=given,
        initial={"i_pan": 50.0},
        method="fixed_step",
        step=h,
    )
    assert any("upper face" in event.mode for event in run.events)
    assert found.status.tolist() == [DONE, DONE, IMPOSSIBLE]
    assert "beyond a rigid face" in found.reasons[2]
    assert found.x[:2] == pytest.approx(single, abs=1e-11)


def test_a_batch_on_a_gpu_follows_its_exponentials_and_keeps_its_failures() -> None:
    damping = np.array([1e-3, -1.0, 2e-3])
    given = {"tau_pan": 0.01, "J_pan": 5e-4, "b_pan": damping, "rtol": 1e-7, "atol": 1e-8}
    batch = ptp.simulate_batch("ideal", 0.5, device="gpu", **given)
    assert batch.status.tolist() == ["done", "impossible", "done"]
    assert "'b_pan' = -1" in batch.reasons[1] and np.isnan(batch["omega_pan"][1])
    inertia = 5e-4 + ptp.load("ideal").defaults["J_z_tilt"]
    b = damping[[0, 2]]
    speed = 0.01 / b * (1.0 - np.exp(-b * 0.5 / inertia))
    assert batch["omega_pan"][[0, 2]] == pytest.approx(speed, rel=1e-6)


def test_a_batch_on_a_gpu_refuses_what_it_does_not_keep() -> None:
    with pytest.raises(InputError, match="A GPU keeps final states alone"):
        ptp.simulate_batch("ideal", 0.5, outputs="all", device="gpu")
    with pytest.raises(InputError, match="Unknown device 'gpus': did you mean 'gpu'"):
        ptp.simulate_batch("ideal", 0.5, device="gpus")
