"""The bodies of a pan-tilt platform as MuJoCo has them, read off as trigonometric polynomials.

A base that leans turns the whole tree; a base that is accelerated is gravity the other way. There
are as many sampling angles as coefficients, so that the polynomials are exact; a test compares them
with MuJoCo's mass matrix and bias torque at random states.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from tests.independent.bodies import GRAVITY, Bodies, products
from tests.independent.drive import Floats

TENSOR = ("xx", "yy", "zz", "xy", "xz", "yz")
_MODEL = """
<mujoco>
  <compiler boundmass="0" balanceinertia="false" angle="radian"/>
  <option timestep="0.00025" integrator="RK4" gravity="{gravity}"/>
  <worldbody>
    <body quat="{base}">
      <body name="pan">
        <inertial pos="0 0 0" mass="1" diaginertia="{pan!r} {pan!r} {pan!r}"/>
        <joint name="pan" type="hinge" axis="0 0 1"/>
        <body name="tilt">
          <inertial pos="{centre}" mass="{payload!r}" fullinertia="{tensor}"/>
          <joint name="tilt" type="hinge" axis="0 1 0"/>
        </body>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def _join(values: Any) -> str:
    return " ".join(repr(float(value)) for value in values)


def load(parameters: Mapping[str, float], gravity: Floats) -> Any:
    """MuJoCo's model of the platform, see `model_text`."""
    import mujoco

    return mujoco.MjModel.from_xml_string(model_text(parameters, gravity))


def model_text(parameters: Mapping[str, float], gravity: Floats) -> str:
    """MuJoCo's XML of the platform; `gravity` [3] in m/s^2 in world axes.

    Parameters as in the project: J_pan, J_x_tilt, J_xy_tilt, m_payload, c_x_payload, dc_x_payload,
    J_x_payload, beta_base, alpha_base. Tilt body and payload are one body: its tensor is about the
    payload's centre of mass, as the tilt body alone is a rotor.
    """

    def of(name: str) -> float:
        return float(parameters.get(name, 0.0))

    tensor = [of(f"J_{k}_tilt") + of(f"J_{k}_payload") for k in "xyz"]
    tensor += [of(f"J_{k}_tilt") for k in TENSOR[3:]]
    beta, alpha = of("beta_base"), of("alpha_base")
    half = math.sin(beta / 2)
    base = (math.cos(beta / 2), -half * math.sin(alpha), half * math.cos(alpha), 0.0)
    centre = [of(f"c_{k}_payload") + of(f"dc_{k}_payload") for k in "xyz"]
    return _MODEL.format(
        gravity=_join(gravity),
        base=_join(base),
        pan=of("J_pan"),
        centre=_join(centre),
        payload=of("m_payload"),
        tensor=_join(tensor),
    )


def mass_and_bias(model: Any, theta: Floats, omega: Floats) -> tuple[Floats, Floats]:
    """MuJoCo's mass matrix [2, 2] and bias torque [2] (gravity and rates, on the left side)."""
    import mujoco

    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = theta, omega
    mujoco.mj_forward(model, data)
    mass = np.zeros((2, 2))
    for column, unit in zip(mass, np.eye(2), strict=True):
        mujoco.mj_mulM(model, data, column, unit)
    return mass, data.qfrc_bias.copy()


def _gravity_table(model: Any) -> Floats:
    """Gravity's torques as coefficients [2, 9], from nine poses."""
    thirds = 2 * math.pi / 3 * np.arange(3)
    waves, torques = [], []
    for pan in thirds:
        for tilt in thirds:
            wave = np.empty(9)
            products(pan, tilt, wave)
            waves.append(wave)
            torques.append(-mass_and_bias(model, np.array([pan, tilt]), np.zeros(2))[1])
    return np.linalg.solve(np.array(waves), np.array(torques)).T


def _mass_coefficients(model: Any) -> Floats:
    """Coefficients [6] of `Bodies.mass`, from three tilt angles."""
    tilts = (0.0, math.pi / 3, 2 * math.pi / 3)
    masses = [mass_and_bias(model, np.array([0.0, tilt]), np.zeros(2))[0] for tilt in tilts]
    doubled = np.array([[1.0, math.cos(2 * tilt), math.sin(2 * tilt)] for tilt in tilts])
    pan = np.linalg.solve(doubled, np.array([mass[0, 0] for mass in masses]))
    single = np.array([[math.cos(tilt), math.sin(tilt)] for tilt in tilts[:2]])
    coupling = np.linalg.solve(single, np.array([mass[0, 1] for mass in masses[:2]]))
    return np.array([*pan, *coupling, masses[0][1, 1]])


def mujoco_bodies(parameters: Mapping[str, float]) -> Bodies:
    """The bodies of `parameters`, on a base that may lean and shake (a_base, f_base, ...)."""
    model = load(parameters, np.array([0.0, 0.0, -GRAVITY]))
    shake = np.zeros((2, 9))
    if parameters.get("a_base", 0.0):
        # In the axes of the leaning base, which a tree on a level one stands for.
        azimuth = parameters.get("psi_base", 0.0)
        push = -parameters["a_base"] * np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
        level = {k: v for k, v in parameters.items() if k != "beta_base"}
        shake = _gravity_table(load(level, push))
    return Bodies(
        _mass_coefficients(model),
        _gravity_table(model),
        shake,
        float(parameters.get("f_base", 1.0)),
        float(parameters.get("phi_base", 0.0)),
    )
