"""MuJoCo's pan-tilt platform on a base that is driven exactly, with sensors on base and tilt body.

Three slides and three hinges carry the base. Their motion is given; the accelerations of the two
joints follow from MuJoCo's mass matrix and bias torque, and its sensors read what follows.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

Array = Any
DRIVEN, JOINTS = slice(0, 6), slice(6, 8)
_MODEL = """
<mujoco>
  <compiler boundmass="0" balanceinertia="false" angle="radian" eulerseq="zyx"/>
  <option gravity="0 0 -9.81"/>
  <worldbody><body name="base">
    <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
    <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/>
    <joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 0 1"/>
    <joint type="hinge" axis="0 1 0"/><joint type="hinge" axis="1 0 0"/>
    <site name="base" pos="{base}"/>
    <body name="pan"><joint type="hinge" axis="0 0 1"/>
      <inertial pos="{pan}" mass="{m_pan!r}" diaginertia="{pan_inertia}"/>
      <body name="tilt" pos="{apart!r} 0 0"><joint type="hinge" axis="0 1 0"/>
        <inertial pos="0 0 0" mass="{m_tilt!r}" diaginertia="{tilt_inertia}"/>
        <site name="imu" pos="{imu}" euler="{mounting}"/>
        <body name="payload">
          <inertial pos="{payload}" mass="{m_payload!r}" diaginertia="{payload_inertia}"/>
        </body></body></body></body></worldbody>
  <sensor>
    <gyro site="base"/><accelerometer site="base"/>
    <frameangacc objtype="site" objname="base"/>
    <gyro site="imu"/><accelerometer site="imu"/>
  </sensor>
</mujoco>
"""


@dataclass(frozen=True)
class Reading:
    """Joint accelerations [2], and of the base (in its axes) and of the tilt body the rate [3] and
    the specific force [3]; `slope` and `acceleration` of the base without gravity; all SI.
    """

    joints: Array
    rate: Array
    force: Array
    slope: Array
    acceleration: Array
    gyro: Array
    accelerometer: Array


@dataclass(frozen=True)
class MovingPlatform:
    """The platform with parameters named as in the project; those left out are zero."""

    parameters: Mapping[str, float]

    @cached_property
    def model(self) -> Any:
        """MuJoCo's model."""
        import mujoco

        def of(*names: str) -> str:
            return " ".join(repr(float(self.parameters.get(name, 0.0))) for name in names)

        def body(name: str) -> dict[str, str]:
            return {name: of(*(f"c_{k}_{name}" for k in "xyz"))}

        def inertia(name: str, *elements: str) -> dict[str, str]:
            return {f"{name}_inertia": of(*elements)}

        text = _MODEL.format(
            base=of("x_base", "y_base", "z_base"),
            imu=of("x_imu", "y_imu", "z_imu"),
            mounting=of("yaw_imu", "pitch_imu", "roll_imu"),
            apart=float(self.parameters.get("a_tilt", 0.0)),
            m_pan=float(self.parameters.get("m_pan_body", 0.0)) or 1e-12,
            m_tilt=float(self.parameters.get("m_tilt", 0.0)) or 1e-12,
            m_payload=float(self.parameters.get("m_payload", 0.0)) or 1e-12,
            **body("pan"),
            **body("payload"),
            **inertia("pan", "J_x_pan", "J_y_pan", "J_pan"),
            **inertia("tilt", "J_x_tilt", "J_y_tilt", "J_z_tilt"),
            **inertia("payload", "J_x_payload", "J_y_payload", "J_z_payload"),
        )
        return mujoco.MjModel.from_xml_string(text)

    @cached_property
    def data(self) -> Any:
        """MuJoCo's state."""
        import mujoco

        return mujoco.MjData(self.model)

    def read(self, base: Array, q: Array, w: Array, tau: Array) -> Reading:
        """What happens at angles q, rates w and torques tau [2]; `base` [3, 6] has places (x, y, z
        in m, yaw, pitch and roll in rad), their rates and accelerations.
        """
        import mujoco

        m, d = self.model, self.data
        d.qpos[:] = [*base[0], *q]
        d.qvel[:] = [*base[1], *w]
        mujoco.mj_forward(m, d)
        mass = np.zeros((m.nv, m.nv))
        for column, unit in zip(mass, np.eye(m.nv), strict=True):
            mujoco.mj_mulM(m, d, column, unit)
        left = tau - d.qfrc_bias[JOINTS] - mass[JOINTS, DRIVEN] @ base[2]
        joints = np.linalg.solve(mass[JOINTS, JOINTS], left)
        d.qacc[:] = [*base[2], *joints]
        mujoco.mj_rnePostConstraint(m, d)
        mujoco.mj_sensorVel(m, d)
        mujoco.mj_sensorAcc(m, d)
        rate, force, slope, gyro, accelerometer = d.sensordata.reshape(5, 3).copy()
        into_base = d.site_xmat[0].reshape(3, 3).T
        moved = force + into_base @ m.opt.gravity
        return Reading(joints, rate, force, into_base @ slope, moved, gyro, accelerometer)
