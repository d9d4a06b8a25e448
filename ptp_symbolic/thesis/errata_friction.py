"""Errata of friction (chapters 2 and 4)."""

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ptp_symbolic.symbolic.symbols import real
from ptp_symbolic.thesis import printed, responses
from ptp_symbolic.thesis.friction import (
    DUTY_SPEEDS,
    drive_values,
    duty_and_torque,
    mean_friction,
    steady_friction,
)
from ptp_symbolic.thesis.items import Item, erratum, plain

FloatArray = NDArray[np.float64]
FRICTION = printed.TABLE_4_1["positive"]
PUSH = 1.0


def signum() -> Item:
    """Erratum 1: Eq. 2.6 with a sigmoid and with the signum."""
    power = {
        name: float(f(-1.0) * -1.0)
        for name, f in (("sigmoid", lambda v: 1.0 / (1.0 + np.exp(-v))), ("signum", np.sign))
    }
    return erratum(
        1,
        "Eq. 2.6, sign(v)",
        "sigmoid",
        "signum",
        "",
        power["sigmoid"] < 0.0 < power["signum"],
        f"power taken at v = -1 and F_c = 1: {power['sigmoid']:.3g} with a sigmoid (energy is"
        f" created), {power['signum']:.3g} with the signum",
    )


def printed_branches(speed: float, applied: float) -> float:
    """Friction torque in N m as Eq. 2.10 prints its branches, F(v) as in Eq. 4.1."""
    if abs(applied) >= FRICTION.F_s:
        return FRICTION.F_s * float(np.sign(applied))
    return float(steady_friction(np.array(speed), FRICTION)) if speed else applied


def branches() -> Item:
    """Erratum 2: a body that slides under a torque above F_s."""
    p = drive_values()
    inertia = p["J_motor_pan"] * p["N_pan"] ** 2

    def speed_after(seconds: float, as_printed: bool) -> float:
        def derivative(_: float, v: FloatArray) -> list[float]:
            right = float(steady_friction(v, FRICTION)[0])
            friction = printed_branches(float(v[0]), PUSH) if as_printed else right
            return [(PUSH - friction) / inertia]

        return float(solve_ivp(derivative, (0.0, seconds), [1e-3], "LSODA", rtol=1e-9).y[0, -1])

    settles = float(brentq(lambda v: steady_friction(np.array(v), FRICTION) - PUSH, 0.03, 1.0))
    wrong, right = ([speed_after(s, kind) for s in (10.0, 20.0)] for kind in (True, False))
    settled = wrong[1] > 1.9 * wrong[0] and abs(right[1] - settles) < 1e-5
    return erratum(
        2,
        "Eq. 2.10, sliding branch",
        "F = F_s above F_s",
        "sliding for v != 0, whatever F_e",
        "",
        settled,
        f"torque {PUSH:g} N m, Table 4.1: with the printed branches the speed is"
        f" {wrong[0]:.3g} rad/s after 10 s and {wrong[1]:.3g} after 20 s and grows for ever; with"
        f" the corrected ones it settles at {right[1]:.4g} rad/s",
    )


def _odd(number: int, where: str, dry: sp.Expr, viscous: sp.Expr) -> Item:
    """Friction must oppose motion: `dry` as printed is even in v and feeds energy in at v < 0."""
    v = real("v")
    values = {
        sp.Symbol("F_c"): FRICTION.F_c,
        sp.Symbol("F_s"): FRICTION.F_s,
        sp.Symbol("v_s"): FRICTION.v_s,
        sp.Symbol("F_v"): FRICTION.F_v,
    }
    force, corrected = dry + viscous, dry * sp.sign(v) + viscous
    power = [float((f * v).subs(values).subs(v, -0.01)) for f in (force, corrected)]
    odd = sp.simplify(corrected.subs(v, -v) + corrected) == 0
    return erratum(
        number,
        where,
        plain(force),
        plain(corrected),
        "N m",
        odd and power[0] < 0.0 < power[1],
        f"power taken at v = -0.01 rad/s, Table 4.1: {power[0]:.3g} W as printed (energy is"
        f" created), {power[1]:.3g} W with sign(v); the corrected law is odd in v",
    )


def csvs_sign() -> Item:
    """Erratum 3: Eq. 2.11 carries no sign(v)."""
    F_c, F_s, v_s, F_v = sp.symbols("F_c F_s v_s F_v")
    v = real("v")
    return _odd(3, "Eq. 2.11, dry part", F_c + (F_s - F_c) * sp.exp(-((v / v_s) ** 2)), F_v * v)


def stribeck_sign() -> Item:
    """Erratum 28: Eq. 2.9 carries no sign(v)."""
    F_c, F_s, v_s = sp.symbols("F_c F_s v_s")
    v = real("v")
    return _odd(
        28, "Eq. 2.9, Stribeck part", (F_s - F_c) * sp.exp(-((v / v_s) ** 2)), sp.Integer(0)
    )


def pwm_torque() -> Item:
    """Erratum 21: the supply current of a PWM drive is the duty times the motor current."""
    direct = mean_friction("positive")
    scaled = [duty_and_torque(speed, direct)[1] for speed in DUTY_SPEEDS]
    table = [float(steady_friction(np.array(s), FRICTION)) for s in DUTY_SPEEDS]
    speeds = ", ".join(f"{speed:g}" for speed in DUTY_SPEEDS)
    gap = max(abs(a / b - 1.0) for a, b in zip(scaled, table, strict=True))
    misses = [
        f"{responses.variant_error(name, 'dc_friction', end):.2f} ({value})"
        for name, end, value in printed.REPORTED_ERRORS
        if "ramp" in name
    ]
    return erratum(
        21,
        "section 4.2.1, torque under PWM",
        ", ".join(f"{t:.2f}" for t in table),
        ", ".join(f"{t:.2f}" for t in scaled),
        "N m",
        gap < 0.1,
        f"Table 4.1 beside duty x Table 4.2 at {speeds} rad/s, 24 V: within {100 * gap:.0f} %."
        " Strong evidence, not proof: against DC friction the ramp errors are"
        f" {', '.join(misses)}, in brackets what is printed",
    )


def gear_ratio() -> Item:
    """Erratum 22: torque = K_t x i leaves out the gear ratio."""
    p = drive_values()
    torque = 7.0
    without, behind = torque / p["K_t_pan"], torque / (p["K_t_pan"] * p["N_pan"])
    limit = printed.SUPPLY_VOLTAGE / p["R_pan"]
    return erratum(
        22,
        "section 4.2.1, current for 7 N m",
        without,
        behind,
        "A",
        without > limit > behind,
        f"K_t i against K_t N i; the winding lets at most {limit:.2g} A pass at 24 V",
    )


def counted_twice() -> Item:
    """Erratum 23: the joint friction beside F_v of Table 4.1."""
    model = responses.as_printed()
    with_it = responses.steady_speed(model, printed.SUPPLY_VOLTAGE)
    without = responses.steady_speed(model | {"b_pan": 0.0}, printed.SUPPLY_VOLTAGE)
    run = responses.response("step")
    simulated = float(run["omega_pan"][np.searchsorted(run.t, 11.0)])
    share = without / with_it - 1.0
    return erratum(
        23,
        "Table 5.7, speed at 24 V with joint friction 2",
        with_it,
        without,
        "rad/s",
        abs(simulated - with_it) < 1e-4 and 0.01 < share < 0.025,
        f"steady speed with and without it: {100 * share:.1f} % apart; simulated {simulated:.4f}."
        " F_v was measured with the whole torque, so it holds the joint already",
    )
