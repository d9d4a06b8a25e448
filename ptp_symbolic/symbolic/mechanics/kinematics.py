"""Axes, frames and signs: the one place that knows them.

Pan turns about the base z axis (up), tilt about the y axis of the pan body. The origin of a frame
lies on the axis behind which it is; the two axes cross unless a platform sets them apart. The
boresight is the x axis of the tilt frame, so a positive tilt angle lowers it. On a platform with
the tilt axis alone the pan frame is the base. A linear joint slides along the x axis of the base;
its coordinate theta is then in m, its rate in m/s, tau in N. Source: thesis section 3.1.1, Eq. 3.1.
"""

import sympy as sp

from ptp_symbolic.platform import AXES
from ptp_symbolic.symbolic.symbols import real

# Unit vector of every joint axis, the same in the frames before and behind the joint.
DIRECTIONS = {"pan": sp.ImmutableMatrix([0, 0, 1]), "tilt": sp.ImmutableMatrix([0, 1, 0])}
ALONG = sp.ImmutableMatrix([1, 0, 0])  # of a sliding joint, in the frames before and behind it
TIME = real("t")


def angle(axis: str) -> sp.Symbol:
    """Joint angle theta_<axis> in rad."""
    return real(f"theta_{axis}")


def rate(axis: str) -> sp.Symbol:
    """Joint rate omega_<axis> in rad/s."""
    return real(f"omega_{axis}")


def acceleration(axis: str) -> sp.Symbol:
    """Joint acceleration accel_<axis> in rad/s^2, which follows from the equations of motion."""
    return real(f"accel_{axis}")


def torque(axis: str) -> sp.Symbol:
    """Torque tau_<axis> on the joint in N m, positive towards a growing angle."""
    return real(f"tau_{axis}")


def gear_angle(axis: str) -> sp.Symbol:
    """Motor angle of `axis` seen at the gear output, in rad."""
    return real(f"theta_gear_{axis}")


def gear_rate(axis: str) -> sp.Symbol:
    """Motor rate of `axis` seen at the gear output, in rad/s."""
    return real(f"omega_gear_{axis}")


def place_of(motion: sp.Symbol) -> str:
    """Where an angle or rate is: ``pan`` of the joint, ``gear_pan`` of the gear output."""
    return _PLACES[motion]


def joint_direction(axis: str) -> sp.ImmutableMatrix:
    """Unit vector [3] of the joint axis, the same in the frames before and behind the joint."""
    return DIRECTIONS[axis]


def joint_rotation(axis: str) -> sp.ImmutableMatrix:
    """Rotation [3, 3] that turns vectors behind the joint of `axis` into the frame before it.

    Rodrigues' formula; Murray, Li and Sastry, 1994, Eq. 2.14.
    """
    x, y, z = direction = joint_direction(axis)
    cross = sp.Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    along = direction * direction.T
    turned = sp.cos(angle(axis)) * (sp.eye(3) - along) + sp.sin(angle(axis)) * cross
    return sp.ImmutableMatrix(along + turned)


def joints_up_to(axes: tuple[str, ...], frame: str) -> tuple[str, ...]:
    """Those of `axes` that lie between the base and `frame` ('pan' or 'tilt'), base first."""
    return tuple(axis for axis in axes if AXES.index(axis) <= AXES.index(frame))


_PLACES = {of(axis): axis for of in (angle, rate) for axis in AXES}
_PLACES |= {of(axis): f"gear_{axis}" for of in (gear_angle, gear_rate) for axis in AXES}
