"""The NumPy platform against MuJoCo and against its own energy."""

import numpy as np
import pytest

from tests.independent import rigid_platform

mujoco = pytest.importorskip("mujoco", reason="MuJoCo is an extra")

TENSOR_NAMES = ("J_x", "J_y", "J_z", "J_xy", "J_xz", "J_yz")
JOINT_AXIS = {"pan": "0 0 1", "tilt": "0 1 0"}


def random_body(rng: np.random.Generator, body: str) -> dict[str, float]:
    """A body with a physical inertia tensor, mass and centre of mass."""
    spread = rng.normal(size=(3, 3)) * 0.05
    second_moments = spread @ spread.T + 1e-3 * np.eye(3)
    tensor = np.trace(second_moments) * np.eye(3) - second_moments
    elements = (*np.diag(tensor), tensor[0, 1], tensor[0, 2], tensor[1, 2])
    parameters = {
        f"{name}_{body}": float(value) for name, value in zip(TENSOR_NAMES, elements, strict=True)
    }
    parameters[f"m_{body}"] = float(rng.uniform(0.5, 8.0))
    for k in "xyz":
        parameters[f"c_{k}_{body}"] = float(rng.uniform(-0.2, 0.2))
    return parameters


def random_platform(rng: np.random.Generator, axes: tuple[str, ...]) -> dict[str, float]:
    parameters = {"beta_base": float(rng.uniform(0, 0.6)), "alpha_base": float(rng.uniform(-3, 3))}
    for body in (*axes, "payload"):
        parameters |= random_body(rng, body)
    for axis in axes:
        parameters[f"b_{axis}"] = float(rng.uniform(0, 2))
    parameters |= {f"dc_{k}_payload": float(rng.uniform(-0.02, 0.02)) for k in "xyz"}
    return parameters


def inertial_element(parameters: dict[str, float], body: str) -> str:
    shift = [parameters[f"c_{k}_{body}"] + parameters.get(f"dc_{k}_{body}", 0.0) for k in "xyz"]
    tensor = " ".join(repr(parameters[f"{name}_{body}"]) for name in TENSOR_NAMES)
    position = " ".join(repr(value) for value in shift)
    return f'<inertial pos="{position}" mass="{parameters[f"m_{body}"]!r}" fullinertia="{tensor}"/>'


def mujoco_model(
    parameters: dict[str, float], axes: tuple[str, ...], tilted: str
) -> "mujoco.MjModel":
    """Nested bodies with one hinge each; `tilted` = "gravity" or "base" says what leans."""
    beta, alpha = parameters["beta_base"], parameters["alpha_base"]
    inner = f'<body name="payload">{inertial_element(parameters, "payload")}</body>'
    for axis in reversed(axes):
        inner = (
            f'<body name="{axis}">{inertial_element(parameters, axis)}'
            f'<joint type="hinge" axis="{JOINT_AXIS[axis]}" damping="{parameters[f"b_{axis}"]!r}"/>'
            f"{inner}</body>"
        )
    gravity = (0.0, 0.0, -9.81)
    quaternion = (1.0, 0.0, 0.0, 0.0)
    if tilted == "gravity":
        lean = 9.81 * np.sin(beta)
        gravity = (lean * np.cos(alpha), lean * np.sin(alpha), -9.81 * np.cos(beta))
    else:
        half = np.sin(beta / 2)
        quaternion = (np.cos(beta / 2), -half * np.sin(alpha), half * np.cos(alpha), 0.0)
    vector, turn = (" ".join(repr(float(v)) for v in values) for values in (gravity, quaternion))
    return mujoco.MjModel.from_xml_string(
        f'<mujoco><compiler boundmass="0" balanceinertia="false"/><option gravity="{vector}"/>'
        f'<worldbody><body quat="{turn}">{inner}</body></worldbody></mujoco>'
    )


@pytest.mark.parametrize("tilted", ["gravity", "base"])
@pytest.mark.parametrize("axes", [("pan", "tilt"), ("pan",), ("tilt",)])
def test_accelerations_mass_and_bias_agree(axes: tuple[str, ...], tilted: str, figure) -> None:
    rng = np.random.default_rng(len(axes))
    worst = np.zeros(3)
    for _ in range(30):
        parameters = random_platform(rng, axes)
        model = mujoco_model(parameters, axes, tilted)
        data = mujoco.MjData(model)
        data.qpos[:] = rng.uniform(-np.pi, np.pi, len(axes))
        data.qvel[:] = rng.normal(size=len(axes)) * 4
        data.qfrc_applied[:] = rng.normal(size=len(axes)) * 5
        mujoco.mj_forward(model, data)
        mass = np.zeros((model.nv, model.nv))
        for column, unit in zip(mass, np.eye(model.nv), strict=True):
            mujoco.mj_mulM(model, data, column, unit)
        still = np.zeros(len(axes))
        ours = (
            rigid_platform.accelerations(data.qpos, data.qvel, data.qfrc_applied, parameters, axes),
            rigid_platform.mass_matrix(data.qpos, parameters, axes),
            rigid_platform.inverse_dynamics(data.qpos, data.qvel, still, parameters, axes),
        )
        theirs = (data.qacc, mass, data.qfrc_bias - data.qfrc_passive)
        for k, (left, right) in enumerate(zip(ours, theirs, strict=True)):
            worst[k] = max(worst[k], np.max(np.abs(left - right)) / (1 + np.max(np.abs(right))))
    assert figure("relative difference to MuJoCo", worst.max()) < 1e-11


@pytest.mark.parametrize("axes", [("pan", "tilt"), ("pan",), ("tilt",)])
def test_power_of_the_torques_is_the_change_of_energy(axes: tuple[str, ...]) -> None:
    rng = np.random.default_rng(7)
    step = 1e-4
    for _ in range(10):
        parameters = random_platform(rng, axes)
        theta, omega = rng.uniform(-3, 3, len(axes)), rng.normal(size=len(axes))
        alpha = rng.normal(size=len(axes))

        def energy(
            dt: float, theta=theta, omega=omega, alpha=alpha, parameters=parameters
        ) -> float:
            angle, rate = theta + omega * dt + alpha * dt**2 / 2, omega + alpha * dt
            potential = rigid_platform.potential_energy(angle, parameters, axes)
            return potential + rigid_platform.kinetic_energy(angle, rate, parameters, axes)

        slope = (energy(step) - energy(-step)) / (2 * step)
        torque = rigid_platform.inverse_dynamics(theta, omega, alpha, parameters, axes)
        dissipated = sum(
            parameters[f"b_{axis}"] * rate**2 for axis, rate in zip(axes, omega, strict=True)
        )
        assert slope == pytest.approx(torque @ omega - dissipated, rel=1e-5, abs=1e-5)


def test_positive_tilt_lowers_the_boresight_and_the_azimuth_is_where_the_payload_rests() -> None:
    level = {"m_payload": 2.0, "c_x_payload": 0.1, "J_pan": 0.01, "J_y_tilt": 0.01}
    raised, lowered = (rigid_platform.potential_energy([0.3, t], level) for t in (-0.2, 0.2))
    assert lowered < raised
    leaning = level | {"beta_base": 0.1, "alpha_base": 0.7}
    hold = rigid_platform.inverse_dynamics([1.2, 0.0], [0, 0], [0, 0], leaning)
    assert hold[0] == pytest.approx(2.0 * 9.81 * 0.1 * np.sin(0.1) * np.sin(0.5), rel=1e-12)
    assert hold[1] == pytest.approx(-2.0 * 9.81 * 0.1 * np.cos(0.1), rel=1e-12), (
        "the boresight is heavy: the drive must pull it up"
    )
