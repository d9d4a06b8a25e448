"""Section 4.2: the steady friction of Table 4.1, estimated again, and what PWM makes of it."""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import OptimizeResult, least_squares

from ptp_symbolic.platform import read_platform
from ptp_symbolic.thesis import printed
from ptp_symbolic.thesis.items import Item, Kind, compared, unprinted
from ptp_symbolic.thesis.printed import DIRECTIONS, Friction

FloatArray = NDArray[np.float64]

# The thesis does not print the speeds of its map; these reach from below v_s to full speed.
SPEEDS = np.geomspace(0.004, 0.55, 24)
CONTROLLER_GAINS = (400.0, 4000.0)
DUTY_SPEEDS = (0.1, 0.2, 0.3, 0.4, 0.5)
ESTIMATION_TOLERANCE = 1e-3


def steady_friction(speed: FloatArray, friction: Friction, gamma: float = 2.0) -> FloatArray:
    """Torque in N m at `speed` [k] in rad/s. Source: thesis Eq. 4.1."""
    stribeck = np.exp(-(np.abs(speed / friction.v_s) ** gamma))
    dry = friction.F_c + (friction.F_s - friction.F_c) * stribeck
    return dry * np.sign(speed) + friction.F_v * speed


@cache
def drive_values() -> dict[str, float]:
    """Parameters of the packaged pan drive (Table 5.7), SI."""
    return {p.name: p.value for p in read_platform("thesis-pan-drive").parameters}


def torque_map(friction: Friction) -> FloatArray:
    """Steady motor torque in N m at SPEEDS: the drive under PI speed control, run by LSODA.

    State: speed at the gear output, motor current, integral of the speed error.
    """
    p = drive_values()
    gear_constant = p["K_t_pan"] * p["N_pan"]
    inertia = p["J_motor_pan"] * p["N_pan"] ** 2 + p["J_pan"]
    proportional, integral = CONTROLLER_GAINS

    def derivative(_: float, x: FloatArray, wanted: float) -> list[float]:
        speed, current, error_sum = x
        error = wanted - speed
        voltage = proportional * error + integral * error_sum
        torque = gear_constant * current - steady_friction(speed, friction)
        back = p["R_pan"] * current + gear_constant * speed
        return [torque / inertia, (voltage - back) / p["L_pan"], error]

    ends = [
        solve_ivp(
            derivative, (0.0, 5.0), [speed, 0.0, 0.0], "LSODA", args=(speed,), rtol=1e-9, atol=1e-12
        ).y[1, -1]
        for speed in SPEEDS
    ]
    return gear_constant * np.array(ends)


def fit_map(torques: FloatArray, direction: str) -> OptimizeResult:
    """The fit of Appendix B: Tc, Ts, Ws, gamma, Tv by a bounded trust-region reflective method.

    A start outside its bounds is moved inside, as lsqcurvefit does and least_squares refuses to.
    """
    lower, upper = map(np.array, printed.APPENDIX_B_BOUNDS[direction])

    def residual(x: FloatArray) -> FloatArray:
        coulomb, static, speed, gamma, viscous = x
        return steady_friction(SPEEDS, Friction(coulomb, static, speed, viscous), gamma) - torques

    start = np.clip(start_of(direction), lower + 1e-6, upper - 1e-6)
    return least_squares(
        residual,
        start,
        bounds=(lower, upper),
        method="trf",
        x_scale=start,
        xtol=1e-14,
        ftol=1e-14,
        gtol=1e-14,
        max_nfev=4000,
    )


def start_of(direction: str) -> FloatArray:
    """Start of Appendix B in the order Tc, Ts, Ws, gamma, Tv."""
    s = printed.TABLE_4_1_START[direction]
    return np.array([s.F_c, s.F_s, s.v_s, printed.GAMMA, s.F_v])


@cache
def estimated(direction: str) -> Friction:
    """Friction of one direction, estimated from data made with the printed values."""
    coulomb, static, speed, _, viscous = fit_map(
        torque_map(printed.TABLE_4_1[direction]), direction
    ).x
    return Friction(float(coulomb), float(static), float(speed), float(viscous))


def mean_friction(direction: str) -> Friction:
    """Means of the five tests of Table 4.2."""
    rows = [test.friction for test in printed.TABLE_4_2[direction]]
    return Friction(
        *(float(np.mean([getattr(r, n) for r in rows])) for n in printed.FRICTION_UNITS)
    )


def duty_and_torque(speed: float, friction: Friction) -> tuple[float, float]:
    """Duty at `speed` in rad/s on a 24 V supply, and the torque that the supply current suggests.

    The supply of a PWM drive delivers the motor current during the duty alone.
    """
    p = drive_values()
    gear_constant = p["K_t_pan"] * p["N_pan"]
    torque = float(steady_friction(np.array(speed), friction))
    voltage = p["R_pan"] * torque / gear_constant + gear_constant * speed
    duty = voltage / printed.SUPPLY_VOLTAGE
    return duty, duty * torque


def estimation_items() -> list[Item]:
    """The eight numbers of Table 4.1."""
    check = (
        "the measured map is not printed: data from the printed parameters, drive under PI control"
        " by scipy LSODA; start, bounds and method of Appendix B; recovered within 0.1 %"
    )
    return [
        compared(
            f"table_4_1.{name}_{direction}",
            f"Table 4.1, {name}, omega {sign} 0",
            getattr(printed.TABLE_4_1[direction], name),
            getattr(estimated(direction), name),
            unit,
            check,
            ESTIMATION_TOLERANCE * getattr(printed.TABLE_4_1[direction], name),
            kind=Kind.ROUND_TRIP,
        )
        for direction, sign in zip(DIRECTIONS, "><", strict=True)
        for name, unit in printed.FRICTION_UNITS.items()
    ]


def duty_items() -> list[Item]:
    """Torque of Table 4.1 beside duty times torque of Table 4.2, at five speeds."""
    return [
        unprinted(
            f"fig_4_3.duty_torque_at_{speed:g}",
            f"Duty times DC friction at {speed:g} rad/s",
            duty_and_torque(speed, mean_friction("positive"))[1],
            "N m",
            "duty at 24 V x mean friction of Table 4.2, omega > 0; Table 4.1 gives"
            f" {steady_friction(np.array(speed), printed.TABLE_4_1['positive']):.3g} N m"
            " (erratum 21)",
        )
        for speed in DUTY_SPEEDS
    ]


def items() -> list[Item]:
    """All items of this file."""
    return [*estimation_items(), *duty_items()]
