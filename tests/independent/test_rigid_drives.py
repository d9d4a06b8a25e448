"""Driven joints of rigid bodies against MuJoCo, SciPy, closed forms and their own statements."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.independent import rigid_platform
from tests.independent.bodies import PAN, TILT, mass_matrix, products, rate_torque, single_axis
from tests.independent.drive import Drive, rows
from tests.independent.rigid_drives import ANGLE, CURRENT, RATE, SLIP, Joints, joints
from tests.independent.rigid_runs import Servo, at_rest, replay, track

PERIOD = 5e-3
SMOOTH = Drive(
    **dict.fromkeys(("F_c_forward", "F_c_backward", "F_s_forward", "F_s_backward"), 0.0),
    F_v_forward=0.0,
    F_v_backward=0.0,
    b_load=0.1,
)
PLATFORM = {
    "J_pan": 0.012,
    "J_x_tilt": 0.012,
    "J_y_tilt": 0.014,
    "J_z_tilt": 0.01,
    "J_xy_tilt": 0.002,
    "J_xz_tilt": -0.001,
    "J_yz_tilt": 0.0015,
    "m_payload": 4.992,
    "J_x_payload": 0.0053,
    "J_y_payload": 0.0068,
    "J_z_payload": 0.0068,
    "c_x_payload": 0.1,
    "dc_y_payload": 0.01,
    "dc_z_payload": 0.005,
    "beta_base": 0.1,
    "alpha_base": 0.7,
}


def rough(coulomb: float, static: float | None = None, **others: object) -> Drive:
    """A drive with dry friction in N m, the same both ways."""
    levels = dict.fromkeys(("F_c_forward", "F_c_backward"), coulomb)
    levels |= dict.fromkeys(("F_s_forward", "F_s_backward"), static or coulomb)
    return SMOOTH._replace(**levels)._replace(**others)


def run(machine: Joints, inputs: np.ndarray, start: np.ndarray, step: float = 2.5e-4) -> np.ndarray:
    """States [n, 2, 7] under held inputs [n, 2]."""
    pushes = np.zeros((len(inputs) + 1, 2))
    return replay(machine, inputs, pushes, start[None], len(inputs), PERIOD, step)


def tilting(gravity: tuple[float, float], drive: Drive, inertia: float = 0.06) -> Joints:
    return joints(single_axis(TILT, inertia, gravity), None, drive)


def test_mass_bias_and_gravity_are_mujocos(figure) -> None:
    mujoco_bodies = pytest.importorskip("tests.independent.mujoco_bodies")
    pytest.importorskip("mujoco")
    bodies = mujoco_bodies.mujoco_bodies(PLATFORM)
    model = mujoco_bodies.load(PLATFORM, np.array([0.0, 0.0, -9.81]))
    rng, worst = np.random.default_rng(1), 0.0
    for _ in range(50):
        theta, omega = rng.uniform(-3, 3, 2), rng.normal(size=2) * 4
        wave = np.empty(9)
        products(theta[0], theta[1], wave)
        mass, bias = mujoco_bodies.mass_and_bias(model, theta, omega)
        ours = mass_matrix(bodies.mass, wave)
        torque = np.array(rate_torque(bodies.mass, wave, *omega)) - bodies.gravity @ wave
        worst = max(worst, abs(ours[0] - mass[0, 0]), abs(ours[1] - mass[0, 1]))
        worst = max(worst, abs(ours[2] - mass[1, 1]), float(np.max(np.abs(torque - bias))))
    assert figure("mass and bias against MuJoCo", worst) < 1e-12


def test_without_friction_the_motion_is_mujocos(figure) -> None:
    mujoco = pytest.importorskip("mujoco")
    mujoco_bodies = pytest.importorskip("tests.independent.mujoco_bodies")
    machine = joints(mujoco_bodies.mujoco_bodies(PLATFORM), SMOOTH, SMOOTH)
    model = mujoco_bodies.load(PLATFORM, np.array([0.0, 0.0, -9.81]))
    model.dof_damping[:] = SMOOTH.b_load
    data, start = mujoco.MjData(model), at_rest(np.array([0.3, 0.2]), np.array([1.0, -0.5]))
    data.qpos[:], data.qvel[:] = start[:, ANGLE], start[:, RATE]
    time = np.arange(300) * PERIOD
    inputs = np.column_stack([0.5 * np.sin(3 * time), -4.5 + 0.4 * np.cos(4 * time)])
    states = run(machine, inputs, start)
    angles = np.empty((300, 2))
    for k, torque in enumerate(inputs):
        angles[k] = data.qpos
        data.qfrc_applied[:] = torque
        for _ in range(20):
            mujoco.mj_step(model, data)
    difference = np.max(np.abs(states[:, :, ANGLE] - angles))
    assert np.ptp(angles, axis=0).min() > 0.5
    assert figure("rad against MuJoCo's RK4", difference) < 1e-7


def test_a_shaking_base_is_gravity_the_other_way() -> None:
    mujoco_bodies = pytest.importorskip("tests.independent.mujoco_bodies")
    pytest.importorskip("mujoco")
    shaking = PLATFORM | {"a_base": 0.8, "psi_base": 0.4}
    bodies = mujoco_bodies.mujoco_bodies(shaking)
    theta = np.array([0.9, -0.3])
    wave = np.empty(9)
    products(*theta, wave)
    chain = rigid_platform.chain(PLATFORM)
    push = -0.8 * np.array([math.cos(0.4), math.sin(0.4), 0.0])
    still = np.zeros(2)
    pushed = rigid_platform.chain_torque(chain._replace(gravity=push), theta, still, still)
    assert bodies.shake @ wave == pytest.approx(-pushed, abs=1e-12)


def test_the_step_for_the_logs_is_fine_enough(figure) -> None:
    drive = rough(0.3, 0.5, v_s_forward=0.03, v_s_backward=0.03, R=5.0, L=5e-3, K_t=0.03, N=150.0)
    drive = drive._replace(J_motor=1e-6, F_v_forward=0.4, F_v_backward=0.4, b_load=0.0)
    machine = joints(single_axis(TILT, 0.025, (0.5, 0.0)), None, drive, voltage_driven=True)
    time = np.arange(600) * PERIOD
    volts = np.column_stack([0.0 * time, 4.0 * np.sin(4.0 * time) + 3.0 * np.sin(17.0 * time)])
    start = at_rest(np.array([0.0, 0.5]))
    coarse, fine = run(machine, volts, start, 5e-4), run(machine, volts, start, 5e-5)
    error = np.max(np.abs(coarse[:, 1, ANGLE] - fine[:, 1, ANGLE]))
    assert figure("rad, steps of 0.5 ms against 0.05 ms", error) < 5e-7


def test_a_tilt_that_friction_can_hold_stands_exactly_still_and_else_falls() -> None:
    start = at_rest(np.array([0.0, 0.3]))
    for weight, holds in ((0.5, True), (0.56, False)):
        machine = tilting((weight, 0.0), rough(0.3, 0.5))
        states = run(machine, np.zeros((200, 2)), start)
        assert (weight * math.cos(0.3) < 0.5) == holds
        still = np.all(states[:, TILT, ANGLE] == 0.3) and np.all(states[:, TILT, RATE] == 0.0)
        assert still == holds
        assert holds or states[-1, TILT, ANGLE] > 0.4, "a positive tilt lowers the payload"


def test_a_free_swing_agrees_with_scipy(figure) -> None:
    drive = SMOOTH._replace(
        b_load=0.02,
        quadratic_drag=0.01,
        k1_cable=0.1,
        theta0_cable=0.2,
        cogging=rows(3, (0.05, 9.0, 0.3)),
    )
    states = run(tilting((0.5, -0.2), drive), np.zeros((400, 2)), at_rest(np.array([0.0, -0.8])))

    def slope(t: float, y: np.ndarray) -> list[float]:
        angle, rate = y
        torque = 0.5 * math.cos(angle) - 0.2 * math.sin(angle) - 0.02 * rate
        torque -= 0.01 * rate * abs(rate) + 0.1 * (angle - 0.2)
        torque += 0.05 * math.sin(9.0 * angle + 0.3)
        return [rate, torque / 0.06]

    times = np.arange(400) * PERIOD
    exact = solve_ivp(slope, (0, 2), [-0.8, 0.0], "DOP853", times, rtol=1e-12, atol=1e-13)
    difference = np.max(np.abs(states[:, TILT, ANGLE] - exact.y[0]))
    assert figure("rad of a swing against SciPy", difference) < 1e-8


def test_a_motor_on_the_joint_agrees_with_scipy(figure) -> None:
    drive = rough(0.3, 0.45, R=5.0, L=5e-3, K_t=0.03, N=150.0, J_motor=1e-6, b_load=0.0)
    drive = drive._replace(
        v_s_forward=0.03, F_v_forward=0.4, heating_gain=0.1, heating_time=3.0, friction_by_load=0.05
    )
    machine = joints(single_axis(TILT, 0.025, (0.5, 0.0)), None, drive, voltage_driven=True)
    start = at_rest(np.array([0.0, 0.1]), np.array([0.0, 0.5]))
    states = run(machine, np.full((200, 2), 6.0), start, 1e-4)

    def slope(t: float, y: np.ndarray) -> list[float]:
        angle, rate, current, heat = y
        motor = 4.5 * current
        level = 0.3 + 0.15 * math.exp(-((rate / 0.03) ** 2)) + 0.05 * abs(motor)
        torque = motor + 0.5 * math.cos(angle) - level - 0.4 * rate
        drop = 5.0 * (1 + heat) * current
        inertia = 0.025 + 1e-6 * 150.0**2
        return [
            rate,
            torque / inertia,
            (6.0 - drop - 4.5 * rate) / 5e-3,
            (0.1 * drop * current - heat) / 3.0,
        ]

    times = np.arange(200) * PERIOD
    begin = [0.1, 0.5, 0.0, 0.0]
    exact = solve_ivp(slope, (0, 1), begin, "LSODA", times, rtol=1e-12, atol=1e-13)
    difference = np.abs(states[:, TILT][:, [ANGLE, CURRENT]] - exact.y[[0, 2]].T)
    assert figure("rad and A of a motor against SciPy", np.max(difference)) < 1e-7


def test_friction_takes_coulomb_torque_times_travel_and_stops_for_good() -> None:
    bodies = single_axis(PAN, 0.05, (0.0, 0.0))
    machine = joints(bodies, rough(0.3, b_load=0.0), None)
    states = run(machine, np.zeros((200, 2)), at_rest(np.zeros(2), np.array([2.0, 0.0])))
    assert states[-1, PAN, RATE] == 0.0
    assert states[-1, PAN, SLIP] == 0.0
    assert states[-1, PAN, ANGLE] == pytest.approx(0.5 * 0.05 * 4.0 / 0.3, abs=1e-12)


def test_a_stuck_joint_stands_still_while_the_other_swings() -> None:
    mujoco_bodies = pytest.importorskip("tests.independent.mujoco_bodies")
    pytest.importorskip("mujoco")
    machine = joints(mujoco_bodies.mujoco_bodies(PLATFORM), rough(3.0), SMOOTH)
    states = run(machine, np.zeros((200, 2)), at_rest(np.array([0.4, 0.0])))
    assert np.all(states[:, PAN, ANGLE] == 0.4)
    assert np.ptp(states[:, TILT, ANGLE]) > 0.5


def test_breakaway_grows_with_the_time_at_rest() -> None:
    ramp = np.column_stack([0.1 * np.arange(800) * PERIOD, np.zeros(800)])
    bodies = single_axis(PAN, 0.05, (0.0, 0.0))
    drive = rough(0.15, 0.22, dwell_gain=0.3, dwell_time=0.5)
    states = run(joints(bodies, drive, None), ramp, at_rest(np.zeros(2)))
    freed = PERIOD * int(np.argmax(states[:, PAN, RATE] > 0))
    assert 0.1 * freed == pytest.approx(0.22 * (1 + 0.3 * math.log(1 + freed / 0.5)), abs=1e-3)


def test_one_joints_input_may_be_late_alone() -> None:
    bodies = single_axis(PAN, 0.05, (0.0, 0.0))
    inputs = np.zeros((100, 2))
    inputs[:, 0] = np.cos(np.arange(100) * 0.2)
    late = run(joints(bodies, SMOOTH._replace(delay=0.0117), None), inputs, at_rest(np.zeros(2)))
    dense = np.repeat(inputs, 50, axis=0)
    dense = np.concatenate([np.repeat(inputs[:1], 117, axis=0), dense])[: len(dense)]
    machine, pushes = joints(bodies, SMOOTH, None), np.zeros((len(dense) + 1, 2))
    fine = replay(machine, dense, pushes, at_rest(np.zeros(2))[None], len(dense), 1e-4)
    assert np.max(np.abs(late[:, PAN, ANGLE] - fine[::50, PAN, ANGLE])) < 1e-11


def test_windows_that_begin_at_recorded_states_repeat_the_recording() -> None:
    bodies = single_axis(PAN, 0.05, (0.0, 0.0))
    drive = rough(0.15, 0.22, v_s_forward=0.03, v_s_backward=0.03, dwell_gain=0.2)
    machine = joints(bodies, drive, None)
    time = np.arange(400) * PERIOD
    targets = np.zeros((400, 2, 3))
    targets[:, 0, 1] = 0.4 * np.sin(2.0 * time)
    targets[:, 0, 2] = 0.8 * np.cos(2.0 * time)
    kept = np.ones(400, dtype=bool)
    kept[100:112] = False
    gains = (np.array([18.0, 0.0]), np.array([1.5, 0.0]), np.zeros(2), np.full(2, 10.0))
    servo, pushes = Servo(*gains, 2 * math.pi / 65_536), np.zeros((401, 2))
    inputs, states = track(machine, servo, targets, kept, pushes, at_rest(np.zeros(2)), PERIOD)
    assert np.all(inputs[100:112] == inputs[99]), "a stalled computer holds its output"
    again = replay(machine, inputs, pushes, states[::50].copy(), 50, PERIOD)
    assert np.array_equal(again, states)


@pytest.mark.long
def test_with_friction_the_motion_is_that_of_the_newton_euler_simulator(figure) -> None:
    pytest.importorskip("mujoco")
    from tests.independent.mujoco_bodies import mujoco_bodies
    from tests.independent.two_axis import simulate, two_axis

    parameters = {k: v for k, v in PLATFORM.items() if k not in ("J_xy_tilt", "J_yz_tilt")}
    parameters |= {"b_pan": 0.1, "b_tilt": 0.1, "F_c_pan": 0.6, "F_c_tilt": 0.9}
    machine = joints(mujoco_bodies(parameters), rough(0.6), rough(0.9))
    time = np.arange(400) * PERIOD
    targets = np.zeros((400, 2, 3))
    targets[:, 0, 1] = 0.6 * np.clip(np.sin(4.0 * time), -0.7, 0.7)
    targets[:, 1, 1] = 0.4 * np.clip(np.sin(5.0 * time + 0.5), -0.6, 0.6)
    gains = (np.array([15.0, 15.0]), np.array([1.0, 1.0]), np.array([0.0, 4.9]), np.full(2, 20.0))
    servo, pushes = Servo(*gains, 1e-4), np.zeros((401, 2))
    start, kept = at_rest(np.array([0.2, 0.0])), np.ones(400, dtype=bool)
    inputs, states = track(machine, servo, targets, kept, pushes, start, PERIOD)

    def torque(time: float, *_: np.ndarray) -> np.ndarray:
        return inputs[round(time / PERIOD)]

    _, angles, _ = simulate(two_axis(parameters), [0.2, 0.0], [0.0, 0.0], torque, 400)
    stuck = np.mean(states[10:, :, RATE] == 0.0, axis=0)
    assert np.all((stuck > 0.05) & (stuck < 0.95)), "the run must hold sticking and sliding"
    difference = np.max(np.abs(states[:, :, ANGLE] - angles))
    assert figure("rad against the Newton-Euler simulator", difference) < 1e-9
