"""A base that moves and sensors on the tilt body: equations and readings against MuJoCo and against
a program of their own, at random states.
"""

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import EffectDeclaration, Platform, SignalDeclaration
from tests.effects.plain_python import as_python
from tests.independent import moving_base
from tests.independent.moving_base import Base, Body

GYROS = tuple(f"omega_{k}_{place}" for place in ("tilt", "imu") for k in "xyz")
ACCELEROMETER = tuple(f"specific_force_{k}_imu" for k in "xyz")
SIGNALS = tuple(SignalDeclaration(name, name, "1", "output") for name in (*GYROS, *ACCELEROMETER))
BODIES = ("rigid_bodies", "pan_com_offset", "axis_offset")
VALUES = {
    "J_pan": 0.3,
    "J_x_pan": 0.35,
    "J_y_pan": 0.4,
    "m_pan_body": 5.0,
    "c_x_pan": 0.05,
    "c_y_pan": -0.03,
    "c_z_pan": -0.2,
    "J_x_tilt": 0.05,
    "J_y_tilt": 0.04,
    "J_z_tilt": 0.06,
    "m_tilt": 7.0,
    "a_tilt": 0.12,
    "m_payload": 3.0,
    "J_x_payload": 0.02,
    "J_y_payload": 0.025,
    "J_z_payload": 0.03,
    "c_x_payload": 0.2,
    "c_y_payload": 0.05,
    "c_z_payload": -0.07,
    "x_imu": 0.1,
    "y_imu": -0.2,
    "z_imu": 0.05,
    "roll_imu": 0.3,
    "pitch_imu": -0.5,
    "yaw_imu": 1.1,
    "x_base": 0.4,
    "y_base": -0.3,
    "z_base": -0.5,
}
SETS = {
    "ship": (*BODIES, "payload", "base_rotation", "base_acceleration:specific_force", "imu"),
    "ship without payload": (
        *BODIES,
        "base_rotation",
        "base_acceleration:specific_force",
        "imu",
    ),
    "carriage on a track": (*BODIES, "payload", "base_acceleration", "imu"),
    "rotary table": (*BODIES, "payload", "base_rotation", "base_acceleration", "imu"),
}


def platform(effects: tuple[str, ...], axes: tuple[str, ...] = ("pan", "tilt")) -> Platform:
    declared = tuple(
        EffectDeclaration(name, None, None, kind or None)
        for name, _, kind in (effect.partition(":") for effect in effects)
    )
    return Platform("moved", "Moving base", axes, 9.81, declared, (), SIGNALS)


@cache
def machine(name: str) -> Model:
    return as_python(emission.emit(platform(SETS[name])))


def values(model: Model) -> dict[str, float]:
    return {name: VALUES[name] for name in model.parameter_names if name in VALUES}


def found(model: Model, q: np.ndarray, w: np.ndarray, given: dict[str, float]) -> np.ndarray:
    """Joint accelerations [2], then what the sensors show, in the order of SIGNALS."""
    p = model.parameter_vector(values(model))
    u, x = np.array([given[name] for name in model.input_names]), np.concatenate([q, w])
    y = np.zeros(len(model.output_names))
    model.module.outputs(0.0, x, u, p, y)
    shown = [y[model.output_names.index(s.signal)] for s in SIGNALS]
    return np.array([*model.rhs(0.0, x, u, p)[2:], *shown])


def inputs(tau: np.ndarray, **vectors: np.ndarray) -> dict[str, float]:
    given = {f"tau_{axis}": float(t) for axis, t in zip(("pan", "tilt"), tau, strict=True)}
    for name, vector in vectors.items():
        given |= {f"{name}_{k}_base": float(v) for k, v in zip("xyz", vector, strict=True)}
    return given


def off(ours: np.ndarray, truth: np.ndarray) -> float:
    return float(np.max(np.abs(ours - truth)) / (1.0 + np.max(np.abs(truth))))


@pytest.mark.parametrize("name", SETS)
def test_against_mujoco(name: str, figure: Callable[[str, float], float]) -> None:
    """The base is driven along and about all of its axes; where the equations have gravity fixed in
    the base, about its z axis alone, and where it does not turn, along all of them.
    """
    pytest.importorskip("mujoco", reason="MuJoCo is an extra")
    from tests.independent.mujoco_moving_base import MovingPlatform

    model = machine(name)
    carried = "payload" in SETS[name]
    own = {n: v for n, v in VALUES.items() if carried or not n.endswith("_payload")}
    truth, rng, worst = MovingPlatform(own), np.random.default_rng(3), 0.0
    turns = {"ship": (3, 4, 5), "ship without payload": (3, 4, 5), "rotary table": (3,)}
    for _ in range(60):
        base = rng.normal(size=(3, 6)) * np.array([[1.0], [1.5], [3.0]])
        base[:, [k for k in (3, 4, 5) if k not in turns.get(name, ())]] = 0.0
        q, w, tau = rng.normal(size=(3, 2)) * np.array([[2.0], [3.0], [10.0]])
        read = truth.read(base, q, w, tau)
        given = inputs(
            tau,
            omega=read.rate,
            alpha=read.slope,
            specific_force=read.force,
            acceleration=read.acceleration,
        )
        expected = np.array([*read.joints, *_in_body(read), *read.gyro, *read.accelerometer])
        worst = max(worst, off(found(model, q, w, given), expected))
    assert figure("relative difference to MuJoCo", worst) < 1e-9


def _in_body(read: object) -> np.ndarray:
    """The gyro's rates turned back from its mounting into the axes of the tilt body."""
    turn = np.eye(3)
    for axis, angle in (("z", "yaw"), ("y", "pitch"), ("x", "roll")):
        turn = turn @ moving_base.about(np.eye(3)["xyz".index(axis)], VALUES[f"{angle}_imu"])
    return np.asarray(turn @ read.gyro)  # type: ignore[attr-defined]


def vector(template: str) -> np.ndarray:
    return np.array([VALUES[template.format(k)] for k in "xyz"])


def bodies(payload: bool) -> list[Body]:
    pan = np.diag([VALUES["J_x_pan"], VALUES["J_y_pan"], VALUES["J_pan"]])
    carried = [
        Body(0, VALUES["m_pan_body"], vector("c_{}_pan"), pan),
        Body(1, VALUES["m_tilt"], np.zeros(3), np.diag(vector("J_{}_tilt"))),
    ]
    own = Body(1, VALUES["m_payload"], vector("c_{}_payload"), np.diag(vector("J_{}_payload")))
    return [*carried, own] if payload else carried


@pytest.mark.parametrize("name", ["ship", "ship without payload"])
def test_against_newton_and_euler(name: str, figure: Callable[[str, float], float]) -> None:
    model, rng, worst = machine(name), np.random.default_rng(5), 0.0
    angles = np.array([VALUES[f"{angle}_imu"] for angle in ("roll", "pitch", "yaw")])
    carried, apart = bodies("payload" in SETS[name]), VALUES["a_tilt"]
    for _ in range(200):
        rate, slope, force = rng.normal(size=(3, 3)) * np.array([[1.0], [4.0], [10.0]])
        q, w, tau = rng.normal(size=(3, 2)) * np.array([[2.0], [3.0], [10.0]])
        back = -vector("{}_base")
        turning = np.cross(slope, back) + np.cross(rate, np.cross(rate, back))
        base = Base(rate, slope, force + turning)
        a = moving_base.accelerations(q, w, tau, base, carried, apart)
        tilt, _ = moving_base.imu(q, w, a, base, np.zeros(3), np.zeros(3), apart)
        gyro, read = moving_base.imu(q, w, a, base, vector("{}_imu"), angles, apart)
        ours = found(model, q, w, inputs(tau, omega=rate, alpha=slope, specific_force=force))
        worst = max(worst, off(ours, np.array([*a, *tilt, *gyro, *read])))
    assert figure("relative difference to Newton and Euler", worst) < 1e-9


def test_body_rates_on_a_base_at_rest_are_those_of_the_thesis() -> None:
    """Eq. 3.1: (-omega_p sin, omega_t, omega_p cos) of theta_t."""
    model = as_python(emission.emit(platform(("rigid_bodies", "imu"))))
    q, w = np.array([0.3, 0.7]), np.array([1.3, -0.4])
    shown = found(model, q, w, inputs(np.zeros(2)))[2:5]
    assert shown == pytest.approx([-1.3 * np.sin(0.7), -0.4, 1.3 * np.cos(0.7)], rel=1e-14)


@pytest.mark.parametrize("name", ["ship", "carriage on a track"])
def test_derivatives_of_rates_and_readings_are_those_of_differences(name: str) -> None:
    model, rng = machine(name), np.random.default_rng(8)
    p = model.parameter_vector(values(model))
    n, ny, nu = len(model.state_names), len(model.output_names), len(model.input_names)
    for _ in range(3):
        x, u = rng.normal(size=n), rng.normal(size=nu)
        yx, yp = np.zeros((ny, n)), np.zeros((ny, len(p)))
        model.module.output_jacobian(0.0, x, u, p, yx, yp)
        fx, fu, fp, *_ = model.derivatives(0.0, x, u, p, np.zeros(0))

        def at(x: np.ndarray, u: np.ndarray, p: np.ndarray) -> np.ndarray:
            y = np.zeros(ny)
            model.module.outputs(0.0, x, u, p, y)
            return np.concatenate([y, model.rhs(0.0, x, u, p)])

        for given, jacobian in ((0, np.vstack([yx, fx])), (2, np.vstack([yp, fp])), (1, fu)):
            for j in range(jacobian.shape[1]):
                ends = []
                for sign in (1.0, -1.0):
                    moved = [x.copy(), u.copy(), p.copy()]
                    moved[given][j] += sign * 1e-5
                    ends.append(at(*moved))
                quotient = (ends[0] - ends[1]) / 2e-5
                expected = quotient[-len(jacobian) :]
                assert jacobian[:, j] == pytest.approx(expected, rel=1e-5, abs=1e-5), (given, j)
