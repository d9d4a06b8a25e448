"""Shafts, gaps, bristles, lags, ceilings, losses and stops of the two simulators: closed forms,
SciPy, MuJoCo, and each against the other.
"""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.independent.bodies import PAN, TILT, single_axis
from tests.independent.drive import Drive
from tests.independent.pan_drive import (
    BEND,
    GEAR_ANGLE,
    LAGGED,
    LOAD_ANGLE,
    LOAD_RATE,
    STATES,
    simulate,
)
from tests.independent.pan_drive import GEAR_RATE as PAN_GEAR_RATE
from tests.independent.rigid_drives import ANGLE, DRIVEN, GEAR, RATE, joints
from tests.independent.rigid_drives import LAGGED as JOINT_LAGGED
from tests.independent.rigid_runs import at_rest, replay
from tests.independent.test_rigid_drives import PLATFORM, SMOOTH

PERIOD = 5e-3
NO_FRICTION = dict.fromkeys(
    ("F_c_forward", "F_c_backward", "F_s_forward", "F_s_backward", "F_v_forward", "F_v_backward"),
    0.0,
)
TIMES = np.arange(120) * PERIOD
VOLTAGE = np.round(14.0 * np.sin(9.0 * TIMES) + 8.0 * np.sign(np.sin(40.0 * TIMES)), 3)


def held(slope, start: np.ndarray, inputs: np.ndarray) -> np.ndarray:
    """States [n, len(start)] by SciPy's Radau, one held input after the other."""
    states = np.empty((len(inputs), len(start)))
    y = np.array(start, dtype=float)
    for k, u in enumerate(inputs):
        states[k] = y
        span = (k * PERIOD, (k + 1) * PERIOD)
        y = solve_ivp(slope, span, y, "Radau", args=(u,), rtol=1e-8, atol=1e-11).y[:, -1]
    return states


def run(machine, inputs: np.ndarray, start: np.ndarray, step: float = 1e-4) -> np.ndarray:
    """States [n, 2, 12] under held inputs [n, 2]."""
    pushes = np.zeros((len(inputs) + 1, 2))
    return replay(machine, inputs, pushes, start[None], len(inputs), PERIOD, step)


def pan_only(inputs: np.ndarray) -> np.ndarray:
    return np.column_stack([inputs, np.zeros(len(inputs))])


def test_shaft_bristles_and_lags_agree_with_scipy(figure) -> None:
    drive = Drive(
        gap=0.0,
        k_shaft=300.0,
        d_shaft=0.5,
        actuator_lag=4e-3,
        measurement_lag=7e-3,
        bristle_stiffness=900.0,
        bristle_damping=15.0,
    )
    states, events = simulate(drive, VOLTAGE, np.zeros(STATES), PERIOD, 1e-12)
    assert events == 0

    def slope(t: float, y: np.ndarray, u: float) -> list[float]:
        load, load_rate, gear, gear_rate, current, volts, shown, bend = y
        shaft = 300.0 * (gear - load) + 0.5 * (gear_rate - load_rate)
        level = 0.24 + (0.65 - 0.24) * math.exp(-((gear_rate / 0.016) ** 2))
        bending = gear_rate - 900.0 * abs(gear_rate) / level * bend
        friction = 900.0 * bend + 15.0 * bending + 14.0 * gear_rate
        return [
            load_rate,
            (shaft - 2.0 * load_rate) / 0.1,
            gear_rate,
            (500.0 * 0.0724 * current - shaft - friction) / (1.1e-5 * 500.0**2),
            (volts - 12.9 * current - 0.0724 * 500.0 * gear_rate) / 6.9e-3,
            (u - volts) / 4e-3,
            (load - shown) / 7e-3,
            bending,
        ]

    exact = held(slope, [0.0] * 5 + [VOLTAGE[0], 0.0, 0.0], VOLTAGE)
    ours = states[:, [LOAD_ANGLE, GEAR_ANGLE, LAGGED, BEND]]
    assert np.ptp(exact[:, 0]) > 0.05
    assert np.max(np.abs(exact[:, 7])) > 2e-4
    difference = np.max(np.abs(ours - exact[:, [0, 2, 6, 7]]))
    assert figure("rad of shaft, bristles and lags against Radau", difference) < 1e-8


def test_steady_bristles_carry_the_law_that_sticking_has() -> None:
    drive = Drive(gap=0.0, k_shaft=300.0, d_shaft=0.5, b_load=0.0)
    bristles = drive._replace(bristle_stiffness=900.0, bristle_damping=15.0)
    volts = np.full(600, 12.0)
    rates = [simulate(one, volts, np.zeros(STATES))[0][-1, LOAD_RATE] for one in (drive, bristles)]
    assert rates[1] == pytest.approx(rates[0], abs=1e-7)


def test_a_bristle_bends_back_where_sticking_stays() -> None:
    """Below breakaway the gear moves by about torque over stiffness and returns."""
    drive = Drive(gap=0.0, k_shaft=0.0, bristle_stiffness=900.0, bristle_damping=60.0)
    torque = 0.1  # of 0.65 N m
    volts = np.r_[np.full(1600, torque * drive.R / (drive.N * drive.K_t)), np.zeros(1600)]
    gear = simulate(drive, volts, np.zeros(STATES))[0][:, GEAR_ANGLE]
    assert gear[1599] == pytest.approx(torque / 900.0, rel=0.15)
    assert abs(gear[-1]) < 0.2 * gear[1599]


def test_a_rigid_pan_drive_is_the_joint_of_the_other_simulator(figure) -> None:
    drive = Drive(k_shaft=0.0, d_shaft=0.0, gap=0.0, gravity_torque=0.3, alpha_base=0.5)
    states, events = simulate(drive, VOLTAGE, np.zeros(STATES), PERIOD, 1e-12)
    machine = joints(single_axis(PAN, 0.1, (0.0, 0.0)), drive, None, voltage_driven=True)
    other = run(machine, pan_only(VOLTAGE), at_rest(np.zeros(2)))[:, PAN, ANGLE]
    assert events >= 4
    assert np.array_equal(states[:, GEAR_ANGLE], states[:, LOAD_ANGLE])
    difference = np.max(np.abs(states[:, LOAD_ANGLE] - other))
    assert figure("rad of a rigid drive, one simulator against the other", difference) < 1e-8


def test_a_shaft_that_is_stiff_is_rigid(figure) -> None:
    rigid = Drive(k_shaft=0.0, d_shaft=0.0, gap=0.0)
    angles = [
        simulate(one, VOLTAGE, np.zeros(STATES), PERIOD, 1e-10)[0][:, LOAD_ANGLE]
        for one in (rigid, rigid._replace(k_shaft=1e6, d_shaft=60.0))
    ]
    difference = np.max(np.abs(angles[1] - angles[0]))
    assert figure("rad between 1e6 N m/rad and rigid", difference) < 1e-5


def test_free_bodies_bounce_in_the_gap_as_newton_says(figure) -> None:
    """Between impacts both move evenly: their distance is a zigzag of shrinking slope."""
    restitution, gap = 0.7, 0.05
    drive = Drive(**NO_FRICTION, K_t=0.0, b_load=0.0, k_shaft=0.0, gap=gap, restitution=restitution)
    start = np.zeros(STATES)
    start[LOAD_RATE], start[PAN_GEAR_RATE] = 1.0, 0.2
    states, events = simulate(drive, np.zeros(120), start, PERIOD, 1e-12)
    gear = drive.J_motor * drive.N**2
    common = (drive.J_load * 1.0 + gear * 0.2) / (drive.J_load + gear)
    time, twist, rate, expected = 0.0, 0.0, -0.8, []
    hit = 0.5 * gap / 0.8
    for t in np.arange(120) * PERIOD:
        while t >= hit:
            twist, time = math.copysign(0.5 * gap, rate), hit
            rate *= -restitution
            hit += gap / abs(rate)
        expected.append(twist + rate * (t - time))
    middle = (drive.J_load * states[:, LOAD_ANGLE] + gear * states[:, GEAR_ANGLE]) / (
        drive.J_load + gear
    )
    assert events >= 4
    difference = np.max(np.abs(states[:, GEAR_ANGLE] - states[:, LOAD_ANGLE] - expected))
    assert figure("rad of a bounce against its closed form", difference) < 1e-9
    assert np.max(np.abs(middle - common * np.arange(120) * PERIOD)) < 1e-9


def test_rigid_impact_is_the_limit_of_a_stiff_damped_contact(figure) -> None:
    """Schwager and Poeschel (2007): restitution of a linear damped contact that cannot pull. What
    is left goes with the time of a contact, which four times the stiffness halves.
    """
    rigid = Drive(k_shaft=0.0, d_shaft=0.0, gap=0.03, gravity_torque=0.4, alpha_base=1.0)
    gear, left = rigid.J_motor * rigid.N**2, []
    mass = gear * rigid.J_load / (gear + rigid.J_load)
    for factor in (1.0, 2.0, 4.0):
        k, beta = 3e6 * factor**2, 900.0 * factor
        omega = math.sqrt(k / mass - beta**2)
        turn = math.atan2(2 * beta * omega, omega**2 - beta**2)
        rigid = rigid._replace(restitution=math.exp(-beta / omega * (math.pi - turn)))
        soft = rigid._replace(k_shaft=k, d_shaft=2 * beta * mass)
        (sharp, events), (smooth, _) = (
            simulate(one, VOLTAGE[:80], np.zeros(STATES), PERIOD, 1e-10) for one in (rigid, soft)
        )
        left.append(float(np.max(np.abs(sharp[:, LOAD_ANGLE] - smooth[:, LOAD_ANGLE]))))
    assert 0.3 < rigid.restitution < 0.7
    assert events >= 5
    assert left[1] < 0.6 * left[0]
    assert left[2] < 0.6 * left[1]
    assert figure("rad between rigid and stiff impacts", left[2]) < 1e-4


def test_between_rigid_faces_nothing_overlaps_and_contact_presses() -> None:
    drive = Drive(k_shaft=0.0, gap=0.03, restitution=0.5, gravity_torque=0.4, alpha_base=1.0)
    states, _ = simulate(drive, VOLTAGE, np.zeros(STATES), PERIOD, 1e-10)
    twist = states[:, GEAR_ANGLE] - states[:, LOAD_ANGLE]
    assert np.max(np.abs(twist)) <= 0.015 + 1e-9
    assert np.mean(np.abs(twist) > 0.015 - 1e-9) > 0.05
    states, _ = simulate(drive, np.zeros(800), np.zeros(STATES), PERIOD, 1e-10)
    twist = states[:, GEAR_ANGLE] - states[:, LOAD_ANGLE]
    assert twist[-1] == pytest.approx(-0.015, abs=1e-12), "at rest on the side it falls to"
    assert 0.0 < states[-1, GEAR_ANGLE] < 1e-3, "impacts push the gear on"
    assert states[-1, LOAD_RATE] == 0.0


def test_a_stop_gives_back_what_hunt_and_crossley_say(figure) -> None:
    """With J v dv = -k x (1 + c v) dx the sum v / c - ln(1 + c v) / c^2 is as large going in as
    coming out.
    """
    drive = SMOOTH._replace(b_load=0.0, stop_upper=0.1, stop_stiffness=400.0, stop_damping=0.8)
    machine = joints(single_axis(PAN, 0.05, (0.0, 0.0)), drive, None)
    start = at_rest(np.zeros(2), np.array([1.0, 0.0]))
    states = run(machine, np.zeros((100, 2)), start)[:, PAN]
    mirrored = drive._replace(stop_upper=1e6, stop_lower=-0.1)
    machine = joints(single_axis(PAN, 0.05, (0.0, 0.0)), mirrored, None)
    other = run(machine, np.zeros((100, 2)), at_rest(np.zeros(2), np.array([-1.0, 0.0])))[:, PAN]

    def stored(rate: float) -> float:
        return rate / 0.8 - math.log(1.0 + 0.8 * rate) / 0.8**2

    assert np.max(np.abs(other[:, RATE] + states[:, RATE])) < 1e-12
    assert -0.9 < states[-1, RATE] < -0.4
    difference = abs(stored(states[-1, RATE]) / stored(1.0) - 1.0)
    assert figure("share of what a stop gives back", difference) < 1e-4
    deepest = 0.1 + math.sqrt(2 * 0.05 * stored(1.0) / 400.0)
    assert states[:, ANGLE].max() == pytest.approx(deepest, abs=2e-4)


def test_a_ceiling_and_a_lag_of_the_torque_have_closed_forms() -> None:
    body, time = single_axis(PAN, 0.05, (0.0, 0.0)), np.arange(100) * PERIOD
    inputs = pan_only(np.full(100, 0.8))
    machine = joints(body, SMOOTH._replace(b_load=0.0, torque_limit=0.3), None)
    angle = run(machine, inputs, at_rest(np.zeros(2)))[:, PAN, ANGLE]
    assert angle == pytest.approx(0.5 * 0.3 / 0.05 * time**2, abs=1e-12)
    slow = SMOOTH._replace(b_load=0.0, actuator_lag=0.02, measurement_lag=0.01)
    states = run(joints(body, slow, None), inputs, at_rest(np.zeros(2)))[:, PAN]
    left = 1.0 - np.exp(-time / 0.02)
    assert states[:, DRIVEN] == pytest.approx(0.8 * left, abs=1e-8)
    angle = 0.8 / 0.05 * (0.5 * time**2 - 0.02 * (time - 0.02 * left))
    assert states[:, ANGLE] == pytest.approx(angle, abs=1e-8)
    shown = solve_ivp(
        lambda t, y: (np.interp(t, time, angle) - y) / 0.01, (0, time[-1]), [0.0], t_eval=time
    ).y[0]
    assert states[:, JOINT_LAGGED] == pytest.approx(shown, abs=2e-3)


def test_the_loss_by_torque_agrees_with_scipy(figure) -> None:
    values = {"R": 5.0, "L": 5e-3, "K_t": 0.03, "N": 150.0, "J_motor": 1e-6, "b_load": 0.2}
    drive = SMOOTH._replace(**values, loss_mean=0.2, loss_difference=0.05, loss_angle=0.02)
    machine = joints(single_axis(TILT, 0.025, (0.5, 0.1)), None, drive, voltage_driven=True)
    volts = 4.0 * np.sin(12.0 * TIMES)
    inputs = np.column_stack([np.zeros(120), volts])
    states = run(machine, inputs, at_rest(np.array([0.0, 0.3])))[:, TILT]

    def slope(t: float, y: np.ndarray, u: float) -> list[float]:
        angle, rate, current, wound = y
        motor = 4.5 * current
        loss = 0.2 * abs(motor) * wound + 0.05 * motor * wound**2
        torque = motor - loss + 0.5 * math.cos(angle) + 0.1 * math.sin(angle) - 0.2 * rate
        back = (u - 5.0 * current - 4.5 * rate) / 5e-3
        return [rate, torque / 0.0475, back, (rate - abs(rate) * wound) / 0.02]

    exact = held(slope, [0.3, 0.0, 0.0, 0.0], volts)
    assert np.ptp(exact[:, 0]) > 0.1
    difference = np.max(np.abs(states[:, ANGLE] - exact[:, 0]))
    assert figure("rad of a lossy joint against Radau", difference) < 1e-7


def test_a_flexible_tilt_of_two_axes_is_mujocos(figure) -> None:
    """MuJoCo has the motor as armature of a joint and the shaft as a second one with a spring."""
    mujoco = pytest.importorskip("mujoco")
    mujoco_bodies = pytest.importorskip("tests.independent.mujoco_bodies")
    still = SMOOTH._replace(b_load=0.0, K_t=0.0, J_motor=2e-6, N=150.0)
    soft = still._replace(gap=0.0, k_shaft=60.0, d_shaft=0.05)
    bodies = mujoco_bodies.mujoco_bodies(PLATFORM)
    machine = joints(bodies, still, soft, voltage_driven=True, flexible=(False, True))
    start = at_rest(np.array([0.3, 0.2]), np.array([1.0, -0.5]))
    states = run(machine, np.zeros((200, 2)), start)
    text = mujoco_bodies.model_text(PLATFORM, np.array([0.0, 0.0, -9.81]))
    spec = mujoco.MjSpec.from_string(text)
    for name in ("pan", "tilt"):
        spec.joint(name).armature = 2e-6 * 150.0**2
    spec.body("tilt").add_joint(name="twist", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 1, 0])
    model = spec.compile()
    model.jnt_stiffness[2], model.dof_damping[2] = 60.0, 0.05
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = [0.3, 0.2, 0.0], [1.0, -0.5, 0.0]
    angles = np.empty((200, 3))
    for k in range(200):
        angles[k] = data.qpos
        for _ in range(20):
            mujoco.mj_step(model, data)
    found = np.column_stack([states[:, 0, ANGLE], states[:, 1, GEAR], states[:, 1, ANGLE]])
    expected = np.column_stack([angles[:, 0], angles[:, 1], angles[:, 1] + angles[:, 2]])
    assert np.ptp(angles[:, 2]) > 0.02
    difference = np.max(np.abs(found - expected))
    assert figure("rad of a flexible tilt against MuJoCo", difference) < 1e-6


def test_a_gap_of_the_joint_is_that_of_the_pan_drive(figure) -> None:
    """Without dry friction, which sits at different places."""
    drive = Drive(**NO_FRICTION)._replace(b_load=1.0, k_shaft=800.0, d_shaft=0.8, gap=0.02)
    states, events = simulate(drive, VOLTAGE, np.zeros(STATES), PERIOD, 1e-12)
    body = single_axis(PAN, drive.J_load, (0.0, 0.0))
    machine = joints(body, drive, None, voltage_driven=True, flexible=(True, False))
    other = run(machine, pan_only(VOLTAGE), at_rest(np.zeros(2)))[:, PAN, ANGLE]
    assert events > 10
    difference = np.max(np.abs(states[:, LOAD_ANGLE] - other))
    assert figure("rad of a gap, one simulator against the other", difference) < 1e-7
