"""Section 5.3: linkage, lead screw and motor of the tilt drive under 24 V (Figs. 5.9-5.14)."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from ptp_symbolic.errors import InputError
from ptp_symbolic.thesis.items import Item, unprinted
from ptp_symbolic.thesis.printed import STROKES, SUPPLY_VOLTAGE, TILT_DRIVE

FloatArray = NDArray[np.float64]
GRAVITY = 9.81

# The thesis prints the level of the trapezoid alone; its edges here are those of section 5.4.3.
TRAPEZOID = (0.5, 2.5, 0.5)
TIMES = np.linspace(0.0, 5.0, 5_001)
# Below this stroke speed in m/s the screw passes smoothly from raising to lowering.
SCREW_SPEED = 1e-9
# Where the centre of mass lies at tilt angle zero, as unit vector (x, z) of the tilt frame.
COM_DIRECTIONS = {
    "above": (0.0, 1.0),
    "ahead": (1.0, 0.0),
    "below": (0.0, -1.0),
    "behind": (-1.0, 0.0),
}


@dataclass(frozen=True, eq=False)
class TiltRun:
    """Figs. 5.9 to 5.14: t [k] in s, stroke and speed in m and m/s, force in N, current in A,
    tilt rate and angle in rad/s and rad, voltage in V, each [k].
    """

    t: FloatArray
    voltage: FloatArray
    stroke: FloatArray
    stroke_speed: FloatArray
    force: FloatArray
    current: FloatArray
    tilt_rate: FloatArray
    tilt_angle: FloatArray


def deviation(stroke: float | FloatArray) -> FloatArray:
    """Angle theta of Fig. 3.13 in rad between link and the perpendicular of the actuator.

    Raises InputError for a stroke in m with which the three bars do not close.
    """
    d = TILT_DRIVE
    length = d.shortest_length + np.asarray(stroke, dtype=np.float64)
    arm, ground = d.moment_arm, d.ground_link
    cosine = (arm**2 + length**2 - ground**2) / (2.0 * length * arm)
    if np.any(np.abs(cosine) > 1.0):
        wrong = np.ravel(stroke)[np.argmax(np.abs(cosine))]
        shortest = max(0.0, ground - arm - d.shortest_length)
        raise InputError(
            f"Stroke {wrong:g} m: the linkage closes from {shortest:g} to"
            f" {ground + arm - d.shortest_length:g} m; give a stroke between them."
        )
    return np.pi / 2.0 - np.arccos(cosine)


def link_angle(stroke: float | FloatArray) -> FloatArray:
    """Angle in rad at the tilt axis between link and ground link, by the law of cosines."""
    d = TILT_DRIVE
    length = d.shortest_length + np.asarray(stroke, dtype=np.float64)
    sides = d.moment_arm**2 + d.ground_link**2 - length**2
    return np.arccos(sides / (2.0 * d.moment_arm * d.ground_link))


def screw_factors() -> tuple[float, float]:
    """Screw torque per force in m, raising and lowering. Source: thesis Eq. 3.12."""
    d = TILT_DRIVE
    lead, turn, f = d.lead, math.pi * d.pitch_diameter, d.screw_friction
    half = d.pitch_diameter / 2.0
    raising = half * (lead + f * turn) / (turn - f * lead)
    lowering = half * (f * turn - lead) / (turn + f * lead)
    return raising, lowering


def trapezoid_voltage(t: float) -> float:
    """The input in V at time t in s."""
    rise, hold, fall = TRAPEZOID
    return SUPPLY_VOLTAGE * float(np.interp(t, np.cumsum([0.0, rise, hold, fall]), [0, 1, 1, 0]))


@cache
def simulate_tilt_drive(
    stroke: float,
    direction: str = "above",
    voltage: Callable[[float], float] = trapezoid_voltage,
    duration: float = 5.0,
) -> TiltRun:
    """The tilt drive from rest at `stroke` in m, tilt angle zero there, by scipy's Radau.

    State: stroke, stroke speed, current. `direction`: where the centre of mass lies. Raises
    InputError for a stroke outside the linkage.
    """
    deviation(stroke)
    times = TIMES[duration >= TIMES]

    def derivative(t: float, x: FloatArray) -> list[float]:
        acceleration = _acceleration(x, stroke, direction)[0]
        d = TILT_DRIVE
        motor_rate = _turns(x[1])
        back = d.R * x[2] + d.K_t * motor_rate
        return [x[1], acceleration, (voltage(t) - back) / d.L]

    run = solve_ivp(
        derivative,
        (0.0, times[-1]),
        [stroke, 0.0, 0.0],
        "Radau",
        times,
        rtol=1e-8,
        atol=[1e-12, 1e-12, 1e-10],
        max_step=0.02,
    )
    if run.status != 0:
        raise InputError(f"The tilt drive stopped at {run.t[-1]:g} s: {run.message}")
    force = np.array([_acceleration(x, stroke, direction)[1] for x in run.y.T])
    s, v, i = run.y
    return TiltRun(
        times,
        np.array([voltage(t) for t in times]),
        s,
        v,
        force,
        i,
        -v / (TILT_DRIVE.moment_arm * np.cos(deviation(s))),
        link_angle(stroke) - link_angle(s),
    )


def _turns(speed: float) -> float:
    """Motor rate in rad/s at a stroke speed in m/s."""
    return 2.0 * math.pi * TILT_DRIVE.N * speed / TILT_DRIVE.lead


def _acceleration(x: FloatArray, start: float, direction: str) -> tuple[float, float]:
    """Stroke acceleration in m/s^2 and actuator force in N.

    The force is a stroke acceleration times the reflected tilt inertia plus the rest; the motor
    feels it through the screw, whose factor depends on whether force and motion agree.
    """
    d = TILT_DRIVE
    stroke, speed, current = x
    theta = float(deviation(stroke))
    arm = d.moment_arm * math.cos(theta)
    tilt_rate, tilt = -speed / arm, float(link_angle(start) - link_angle(stroke))
    inertia = d.J_y + d.mass * d.com_offset**2
    # rate of the lever arm: d(theta)/dt from the change of the actuator's angle to the link
    length = d.shortest_length + stroke
    arm_rate = -d.moment_arm * math.sin(theta) * _deviation_slope(length, theta) * speed
    weight = d.mass * GRAVITY * d.com_offset
    ahead, above = COM_DIRECTIONS[direction]
    gravity = weight * (ahead * math.cos(tilt) + above * math.sin(tilt))
    # tilt_acceleration = -acceleration / arm + speed arm_rate / arm^2
    reflected = inertia / arm**2
    rest = -(inertia * speed * arm_rate / arm**2 + d.b_joint * tilt_rate - gravity) / arm
    motor_mass = d.J_motor * _turns(1.0)
    motor_torque = d.K_t * current - d.b_motor * _turns(speed)
    positive = reflected * motor_torque + motor_mass * rest > 0.0
    factor = _screw_factor(positive, speed) / d.N
    acceleration = (motor_torque - factor * rest) / (motor_mass + factor * reflected)
    return acceleration, reflected * acceleration + rest


def _deviation_slope(length: float, theta: float) -> float:
    """d(theta)/d(length) in rad/m, from sin(theta) as the law of cosines gives it."""
    d = TILT_DRIVE
    slope = (length**2 - d.moment_arm**2 + d.ground_link**2) / (2.0 * length**2 * d.moment_arm)
    return slope / math.cos(theta)


def _screw_factor(positive: bool, speed: float) -> float:
    """Screw torque per force in m: raising where force and motion agree, else lowering."""
    raising, lowering = screw_factors()
    mean, half = (raising - lowering) / 2.0, (raising + lowering) / 2.0
    return mean + (half if positive else -half) * math.tanh(speed / SCREW_SPEED)


def reverses(run: TiltRun) -> tuple[bool, float | None]:
    """Whether the force starts positive and becomes negative, and when in s."""
    moving = run.t > 0.0
    first = next((f for f in run.force[moving] if abs(f) > 1e-3), 0.0)
    negative = np.flatnonzero(run.force < -1e-3)
    if first <= 0.0 or not len(negative):
        return False, None
    return True, float(run.t[negative[0]])


def run_items(name: str, stroke: float) -> list[Item]:
    """What Figs. 5.9 to 5.14 show, for one of the two printed strokes."""
    run = simulate_tilt_drive(stroke)
    when = reverses(run)[1]
    check = (
        f"scipy Radau, Tables 5.5 and 5.6, Eq. 3.12, stroke {name} mm, c.g. above the axis"
        " (erratum 24); trapezoid 0.5 s up, 2.5 s at 24 V, 0.5 s down (edges not printed); the"
        " thesis prints the curve alone"
    )
    rows = (
        ("fig_5_9", "largest_stroke_speed", np.max(run.stroke_speed) * 1e3, "mm/s"),
        ("fig_5_10", "largest_force", np.max(run.force), "N"),
        ("fig_5_10", "reversal_time", when, "s"),
        ("fig_5_10", "final_force", run.force[-1], "N"),
        ("fig_5_11", "largest_current", np.max(run.current), "A"),
        ("fig_5_12", "largest_tilt_rate", np.min(np.degrees(run.tilt_rate)), "deg/s"),
        ("fig_5_14", "final_tilt_angle", np.degrees(run.tilt_angle[-1]), "deg"),
    )
    return [
        unprinted(
            f"{figure}.{what}_stroke_{name}_mm",
            f"Fig. {figure[4:].replace('_', '.')}, {what.replace('_', ' ')}, stroke {name} mm",
            None if value is None else float(value),
            unit,
            check,
        )
        for figure, what, value, unit in rows
    ]


def items() -> list[Item]:
    """All items of this file."""
    raising, lowering = screw_factors()
    screw = "Eq. 3.12 with Table 5.5, torque per force"
    return [
        *(item for name, stroke in STROKES.items() for item in run_items(name, stroke)),
        unprinted("eq_3_12.raising", "Lead screw, torque per force, raising", raising, "m", screw),
        unprinted(
            "eq_3_12.lowering", "Lead screw, torque per force, lowering", lowering, "m", screw
        ),
        *(
            unprinted(
                f"fig_3_13.deviation_stroke_{name}_mm",
                f"Fig. 3.13, link from the perpendicular at stroke {name} mm",
                float(np.degrees(deviation(stroke))),
                "deg",
                "law of cosines, Table 5.6",
            )
            for name, stroke in STROKES.items()
        ),
    ]
