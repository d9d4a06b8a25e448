"""A pan-tilt platform on a moving base, by Newton and Euler: every body in the axes of the base.

Written from the physics, with rotation matrices and cross products alone. The base is given by its
rate and angular acceleration, and by the specific force of the point where the axes cross
(acceleration less gravity), all in its own axes. A body is (joint behind which it is, mass, centre
[3] and inertia [3, 3] about it in the axes of the body).
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

Array = Any
AXES = (np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0]))


@dataclass(frozen=True)
class Base:
    """Rate, angular acceleration and specific force [3] in the axes of the base, SI."""

    rate: Array
    slope: Array
    force: Array


@dataclass(frozen=True)
class Body:
    """A body behind joint 0 (pan) or 1 (tilt)."""

    joint: int
    mass: float
    centre: Array
    inertia: Array


@dataclass(frozen=True)
class Frame:
    """Rotation to the base, origin, rate, angular acceleration, specific force of the origin."""

    turn: Array
    origin: Array
    rate: Array
    slope: Array
    force: Array


def about(direction: Array, angle: float) -> Array:
    """Rotation [3, 3] by `angle` in rad about the unit vector `direction`."""
    x, y, z = direction
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def force_at(frame: Frame, arm: Array) -> Array:
    """Specific force [3] of a point at `arm` from the origin of `frame`, both in base axes."""
    turning = np.cross(frame.rate, np.cross(frame.rate, arm))
    return frame.force + np.cross(frame.slope, arm) + turning


def frames(q: Array, w: Array, a: Array, base: Base, apart: float) -> list[Frame]:
    """The pan and the tilt frame at angles q, rates w and accelerations a [2]; the tilt axis is
    `apart` in m ahead of the pan axis.
    """
    frame = Frame(np.eye(3), np.zeros(3), base.rate, base.slope, base.force)
    found = []
    for joint, arm in enumerate((np.zeros(3), np.array([apart, 0.0, 0.0]))):
        arm = frame.turn @ arm
        axis = frame.turn @ AXES[joint]
        frame = Frame(
            frame.turn @ about(AXES[joint], q[joint]),
            frame.origin + arm,
            frame.rate + axis * w[joint],
            frame.slope + axis * a[joint] + np.cross(frame.rate, axis * w[joint]),
            force_at(frame, arm),
        )
        found.append(frame)
    return found


def torques(
    q: Array, w: Array, a: Array, base: Base, bodies: list[Body], apart: float = 0.0
) -> Array:
    """Joint torques [2] in N m that the motion takes."""
    moving = frames(q, w, a, base, apart)
    found = np.zeros(2)
    for body in bodies:
        frame = moving[body.joint]
        arm = frame.turn @ body.centre
        inertia = frame.turn @ body.inertia @ frame.turn.T
        force = body.mass * force_at(frame, arm)
        moment = inertia @ frame.slope + np.cross(frame.rate, inertia @ frame.rate)
        for joint in range(body.joint + 1):
            axis = moving[joint].turn @ AXES[joint]
            lever = frame.origin + arm - moving[joint].origin
            found[joint] += axis @ (np.cross(lever, force) + moment)
    return found


def accelerations(
    q: Array, w: Array, tau: Array, base: Base, bodies: list[Body], apart: float = 0.0
) -> Array:
    """Joint accelerations [2] in rad/s^2 at joint torques tau [2] in N m."""
    rest = torques(q, w, np.zeros(2), base, bodies, apart)
    columns = [torques(q, w, unit, base, bodies, apart) - rest for unit in np.eye(2)]
    return np.linalg.solve(np.array(columns).T, tau - rest)


def imu(
    q: Array, w: Array, a: Array, base: Base, place: Array, angles: Array, apart: float = 0.0
) -> tuple[Array, Array]:
    """What gyro and accelerometer [3] read at `place` on the tilt body, mounted with roll, pitch
    and yaw `angles`.
    """
    frame = frames(q, w, a, base, apart)[1]
    roll, pitch, yaw = angles
    mounting = about(np.array([0, 0, 1.0]), yaw) @ about(np.array([0, 1.0, 0]), pitch)
    sensor = frame.turn @ mounting @ about(np.array([1.0, 0, 0]), roll)
    return sensor.T @ frame.rate, sensor.T @ force_at(frame, frame.turn @ place)
