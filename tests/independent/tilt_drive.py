"""Tilt drive of the thesis in motor coordinates, written from its tables and errata alone.

States are motor angle, motor speed and current. The screw follows Eq. 3.12 by cases, the linkage is
solved from the actuator's length, and the load is moved by the rod's force: none of the program's
joint coordinates, ratios or friction formulas appear. Motion and rest are phases that end at events
found by SciPy (LSODA for the motion, as the winding is stiff).
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

GRAVITY = 9.81
ANGLE, SPEED, CURRENT = range(3)


class TiltDrive(NamedTuple):
    """Tables 5.5 and 5.6; `c_x` and `c_z` place the centre of mass at tilt zero.

    `F_joint` is Coulomb friction in the joint, in N m.
    """

    L: float = 9.35e-3
    R: float = 17.0
    K_t: float = 0.044
    J_motor: float = 1.62e-6
    b_motor: float = 1.1696e-4
    N: float = 93.0
    lead: float = 4e-3
    d_screw: float = 8e-3
    f_screw: float = 0.15
    l_ground: float = 0.19755
    l_min: float = 0.139
    r_arm: float = 0.0634133
    s_start: float = 0.0405022
    mass: float = 6.3785
    c_x: float = 0.0
    c_z: float = 0.0876228
    J_own: float = 1.36e-2
    b_joint: float = 10.0
    F_joint: float = 0.0

    @property
    def metres_per_radian(self) -> float:
        """Stroke per motor angle."""
        return self.lead / (2.0 * math.pi * self.N)

    @property
    def load_inertia(self) -> float:
        """Inertia of the load about the joint in kg m^2."""
        return self.J_own + self.mass * (self.c_x**2 + self.c_z**2)

    def raise_lower(self) -> tuple[float, float]:
        """Eq. 3.12: screw torque in N m per newton of load, raising and lowering."""
        d, f, lead = self.d_screw, self.f_screw, self.lead
        up = d / 2 * (lead + math.pi * f * d) / (math.pi * d - f * lead)
        down = d / 2 * (math.pi * f * d - lead) / (math.pi * d + f * lead)
        return up, down


class Pose(NamedTuple):
    """Joint angle, distance of the joint from the rod's line, and its change per length."""

    angle: float
    distance: float
    change: float


def opening(drive: TiltDrive, length: float) -> float:
    """Angle at the joint between ground link and arm."""
    r, g = drive.r_arm, drive.l_ground
    return math.acos((r * r + g * g - length * length) / (2.0 * r * g))


def pose(drive: TiltDrive, motor_angle: float) -> Pose:
    """The linkage at a motor angle (zero at tilt zero)."""
    r, g = drive.r_arm, drive.l_ground
    first = drive.l_min + drive.s_start
    length = first + drive.metres_per_radian * motor_angle
    at_pin = math.acos((r * r + length * length - g * g) / (2.0 * r * length))
    slope = -(1.0 / r - math.cos(at_pin) / length) / math.sin(at_pin)
    return Pose(
        opening(drive, first) - opening(drive, length),
        r * math.sin(at_pin),
        r * math.cos(at_pin) * slope,
    )


def load_torque(drive: TiltDrive, angle: float, rate: float, way: float) -> float:
    """Gravity and joint friction on the load, which turns or would turn in `way`."""
    level = drive.c_x * math.cos(angle) + drive.c_z * math.sin(angle)
    return drive.mass * GRAVITY * level - drive.b_joint * rate - drive.F_joint * way


def joint(drive: TiltDrive, x: np.ndarray) -> tuple[float, float]:
    """Tilt angle and rate of a state; a growing stroke lowers the angle."""
    where = pose(drive, x[ANGLE])
    return where.angle, -drive.metres_per_radian * x[SPEED] / where.distance


def motion(drive: TiltDrive, x: np.ndarray, direction: float) -> tuple[float, float]:
    """Motor acceleration and force in the rod (positive: it pushes), screw turning `direction`."""
    where, per = pose(drive, x[ANGLE]), drive.metres_per_radian
    angle, rate = joint(drive, x)
    speed = per * x[SPEED]
    bent = speed**2 * where.change / where.distance**2
    own = drive.K_t * x[CURRENT] - drive.b_motor * x[SPEED]
    up, down = drive.raise_lower()
    for torque_per_force, pushes in ((up, direction), (-down, -direction)):
        # Unknown: acceleration a of the motor, force F of the rod.
        #   J_motor a + torque_per_force / N F = own
        #   J_load (-per a / distance + bent) = load - distance F
        system = np.array(
            [
                [drive.J_motor, torque_per_force / drive.N],
                [-drive.load_inertia * per / where.distance, where.distance],
            ]
        )
        right = [own, load_torque(drive, angle, rate, -direction) - drive.load_inertia * bent]
        acceleration, force = np.linalg.solve(system, right)
        if force * pushes >= 0.0:
            return float(acceleration), float(force)
    raise ArithmeticError("the screw jams")


def margin(drive: TiltDrive, x: np.ndarray) -> tuple[float, float]:
    """How far the motor torque at rest is above what starts it forward, and below backward."""
    where = pose(drive, x[ANGLE])
    up, down = drive.raise_lower()
    needed = []
    for direction in (1.0, -1.0):
        force = load_torque(drive, where.angle, 0.0, -direction) / where.distance
        needed.append((up if force * direction > 0.0 else -down) * force)
    own = drive.N * drive.K_t * x[CURRENT]
    return own - needed[0], needed[1] - own


def way_out(drive: TiltDrive, x: np.ndarray) -> float:
    """Direction in which the motor leaves rest, or zero."""
    forward, backward = margin(drive, x)
    return 1.0 if forward > -1e-12 else -1.0 if backward > -1e-12 else 0.0


def simulate(
    drive: TiltDrive, volts: Callable[[float], float], times: np.ndarray, kinks: tuple[float, ...]
) -> np.ndarray:
    """States [k, 3] at `times` from rest at tilt zero; `kinks` are the corners of the voltage."""
    x, t = np.zeros(3), float(times[0])
    direction = way_out(drive, x)
    found = [x]
    ends = sorted({*(k for k in kinks if times[0] < k < times[-1]), float(times[-1])})
    while ends:

        def derivative(time: float, y: np.ndarray, way: float = direction) -> list[float]:
            speed = y[SPEED] if way else 0.0
            current = (volts(time) - drive.R * y[CURRENT] - drive.K_t * speed) / drive.L
            return [speed, motion(drive, y, way)[0] if way else 0.0, current]

        def over(time: float, y: np.ndarray, way: float = direction) -> float:
            return way * y[SPEED] + 1e-12 if way else max(margin(drive, y)) - 1e-12

        over.terminal = True  # type: ignore[attr-defined]
        over.direction = -1.0 if direction else 1.0  # type: ignore[attr-defined]
        if not direction:
            x[SPEED] = 0.0
        inside = times[(times > t) & (times <= ends[0])]
        step = solve_ivp(
            derivative,
            (t, ends[0]),
            x,
            "LSODA",
            np.unique([*inside, ends[0]]),
            events=over,
            rtol=1e-11,
            atol=1e-13,
            max_step=0.01,
        )
        done = len(inside) if step.status == 0 else len(step.t)
        found += list(np.reshape(step.y, (3, -1)).T[:done])
        if step.status == 1:
            t, x = float(step.t_events[0][0]), step.y_events[0][0].copy()
            direction = way_out(drive, x)
            continue
        t, x = ends.pop(0), step.y[:, -1].copy()
    return np.array(found)
