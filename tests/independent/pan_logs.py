"""Field logs of a pan axis with a chosen hidden effect, simulated by `pan_drive`.

The declared drive is the one of the thesis (Table 5.7) with friction near Table 4.1 (PWM drive) or
Table 4.2 (DC drive) and equal in both directions. Every run starts at rest, at a random place in
the gap and a random place within the first encoder count.
"""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tests.independent.pan_drive import CURRENT, LOAD_ANGLE, Floats, PanDrive, simulate

PERIOD = 5e-3  # s
COUNT = 2 * math.pi / 7200  # rad
VOLTAGE_NOISE, CURRENT_NOISE = 8e-3, 4e-3  # V and A rms, on the logged columns only
COLUMNS = "time [s],pan_voltage [V],pan_current [A],pan_angle [rad]"
DECLARED_GAP = math.radians(1.49)
PAYLOAD_WEIGHT_TORQUE = 4.992 * 9.81 * 0.1  # N m, mass, gravity and lever
STAIRS = (0.0, 3.0, 6.0, 12.0, 0.0, -3.0, -6.0, -12.0)  # V
TONES = (0.1, 0.23, 0.47, 0.81, 1.7, 3.1)  # Hz

Settings = Mapping[str, float]

# Per effect: parameters that grow with the size asked for, and parameters that do not.
EFFECTS: dict[str, tuple[dict[str, float], dict[str, float]]] = {
    "nothing": ({}, {}),
    "base_tilt": ({"beta_base": math.radians(5.0)}, {"alpha_base": 0.9}),
    "cable_spring": ({"k1_cable_pan": 0.6, "k3_cable_pan": 0.4}, {"theta0_cable_pan": 0.3}),
    "direction_dependent_friction": (
        {"asymmetry_F_c": 0.15, "asymmetry_F_s": 0.2, "asymmetry_F_v": 0.05},
        {},
    ),
    "constant_torque": ({"tau0_pan": 0.3}, {}),
    "voltage_offset": ({"u0_pan": 0.15}, {}),
    "wrong_gap": ({"gap_excess": math.radians(0.31)}, {}),
    "position_dependent_friction": (
        {"friction_ripple": 1.0},
        {"ripple_count": 5.0, "ripple_phase": 0.7},
    ),
    "rate_dependent_breakaway": ({"dwell_gain": 0.15}, {"dwell_time": 0.3}),
    "winding_heating": ({"heating_gain": 0.3}, {"heating_time": 15.0}),
    "periodic_torque": ({"shake_torque": 0.5}, {"shake_frequency": 1.3, "shake_phase": 0.4}),
}
DC_EFFECTS = ("rate_dependent_breakaway", "winding_heating")


def profiles(rng: np.random.Generator, dc: bool = False) -> dict[str, Floats]:
    """Voltage [n] in V of every run, by "train/name" and "validate/name"."""
    crawl_peak, tone = (4.6, 6.5) if dc else (1.2, 4.0)

    def times(duration: float) -> Floats:
        return np.arange(round(duration / PERIOD)) * PERIOD

    def knots(duration: float, *points: tuple[float, float]) -> Floats:
        return np.interp(times(duration), *np.array(points).T, right=0.0)

    def multisine() -> Floats:
        phases = rng.uniform(0, 2 * math.pi, len(TONES))
        angles = 2 * math.pi * np.outer(times(20.0), TONES) + phases
        return tone * np.sin(angles).sum(axis=1)

    t = times(24.0)
    crawl = crawl_peak * np.where((t // 4.0) % 2 == 0, 1, -1) * np.minimum(t % 4.0, 1.0)
    t = times(6.0)
    step = np.where((t > 0.5) & (t < 5.0), 24.0, 0.0)
    ramp_crawl = knots(
        26.0, (0, 0), (11.995, 5.9975), (12, 0), (14, 0), (14.33, 6), (24.995, 6), (25, 0)
    )
    trapezoid = knots(5.0, (0, 0), (0.5, 24), (3, 24), (3.5, 0))
    t = times(16.0)
    return {
        "train/crawl": crawl,
        "train/multisine_1": multisine(),
        "train/ramp_crawl": ramp_crawl,
        "train/ramp_slow": knots(11.0, (0, 0), (9.995, 23.988), (10, 0)),
        "train/staircase": np.repeat(STAIRS, round(2.5 / PERIOD)),
        "train/step_ccw": step,
        "train/step_cw": -step,
        "validate/crawl_cw": -crawl,
        "validate/multisine_2": multisine(),
        "validate/ramp_crawl_cw": -ramp_crawl,
        "validate/ramp_fast": knots(2.0, (0, 0), (0.495, 23.76), (0.5, 0)),
        "validate/sweep": 14.0 * np.sin(2 * math.pi * (0.1 * t + 0.06 * t**2)),
        "validate/trapezoid_ccw": trapezoid,
        "validate/trapezoid_cw": -trapezoid,
    }


def draw_drive(rng: np.random.Generator, dc: bool = False) -> dict[str, float]:
    """What a fit has to find, SI units: friction 0.8 to 1.3 times the tables, load, damping."""
    coulomb, excess, stribeck, viscous = (5.4, 1.9, 0.05, 5.8) if dc else (0.24, 0.42, 0.016, 13.9)
    coulomb, excess, stribeck = (
        value * float(rng.uniform(0.8, 1.3)) for value in (coulomb, excess, stribeck)
    )
    return {
        "J_load": float(rng.uniform(0.09, 0.115)),
        "b_pan": float(rng.uniform(1.5, 2.5)),
        "d_shaft_pan": float(rng.uniform(0.5, 3.0)),
        "F_c_pan": coulomb,
        "F_s_pan": coulomb + excess,
        "v_s_pan": stribeck,
        "F_v_pan": viscous * float(rng.uniform(0.85, 1.15)),
    }


def planted(effects: Sequence[str], size: float, settings: Settings) -> dict[str, float]:
    """Parameters of the hidden effects, the strengths times `size`, `settings` given as they are.

    Raises KeyError for an effect that is not in EFFECTS and ValueError for a stray setting.
    """
    values: dict[str, float] = {}
    for effect in effects:
        strengths, others = EFFECTS[effect]
        values |= {name: value * size for name, value in strengths.items()} | others
    if stray := set(settings) - set(values):
        raise ValueError(f"{sorted(stray)} is no parameter of {list(effects)}: {sorted(values)}")
    return values | settings


def build_drive(nominal: Settings, hidden: Settings) -> PanDrive:
    """The true drive; an asymmetry a makes friction 1 + a times forward, 1 - a times backward."""
    friction = {}
    for name in ("F_c", "F_s", "v_s", "F_v"):
        asymmetry = hidden.get(f"asymmetry_{name}", 0.0)
        friction[f"{name}_forward"] = nominal[f"{name}_pan"] * (1 + asymmetry)
        friction[f"{name}_backward"] = nominal[f"{name}_pan"] * (1 - asymmetry)
    fields = {name: hidden[name] for name in PanDrive._fields if name in hidden}
    return PanDrive(
        J_load=nominal["J_load"],
        b_load=nominal["b_pan"],
        d_shaft=nominal["d_shaft_pan"],
        gap=DECLARED_GAP + hidden.get("gap_excess", 0.0),
        gravity_torque=PAYLOAD_WEIGHT_TORQUE * math.sin(hidden.get("beta_base", 0.0)),
        k1_cable=hidden.get("k1_cable_pan", 0.0),
        k3_cable=hidden.get("k3_cable_pan", 0.0),
        theta0_cable=hidden.get("theta0_cable_pan", 0.0),
        constant_torque=hidden.get("tau0_pan", 0.0),
        voltage_offset=hidden.get("u0_pan", 0.0),
        **fields,
        **friction,
    )


def log_rows(states: Floats, voltage: Floats, rng: np.random.Generator) -> list[str]:
    """CSV rows of a run: noisy voltage and current, angle rounded to encoder counts."""
    noisy_voltage = voltage + VOLTAGE_NOISE * rng.normal(size=len(voltage))
    noisy_current = states[:, CURRENT] + CURRENT_NOISE * rng.normal(size=len(voltage))
    angle = np.rint(states[:, LOAD_ANGLE] / COUNT) * COUNT + 0.0
    columns = zip(noisy_voltage, noisy_current, angle, strict=True)
    return [
        f"{k * PERIOD:.4f},{u:.4f},{i:.5f},{theta:.6f}" for k, (u, i, theta) in enumerate(columns)
    ]


def write_logs(
    folder: Path,
    effects: Sequence[str],
    seed: int,
    size: float = 1.0,
    settings: Settings | None = None,
    runs: Sequence[str] | None = None,
) -> dict[str, Any]:
    """Write train/*.csv and validate/*.csv (all, or `runs`) and return the truth as plain data."""
    rng = np.random.default_rng(seed)
    dc = any(effect in DC_EFFECTS for effect in effects)
    nominal, hidden = draw_drive(rng, dc), planted(effects, size, settings or {})
    drive = build_drive(nominal, hidden)
    starts = {}
    for name, voltage in profiles(rng, dc).items():
        place = float(rng.uniform(-0.45, 0.45)) * drive.gap
        start = np.array([float(rng.uniform(-0.45, 0.45)) * COUNT, 0.0, 0.0, 0.0, 0.0, 0.0])
        start[2] = start[0] + place
        noise = np.random.default_rng(rng.integers(2**32))
        if runs is not None and name not in runs:
            continue
        states, events = simulate(drive, voltage, start)
        path = folder / f"{name}.csv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join([COLUMNS, *log_rows(states, voltage, noise)]) + "\n")
        starts[name] = {"theta_pan": start[0], "theta_gear_pan": start[2], "events": events}
    return {
        "platform": "pan",
        "friction_table": "4.2 (DC drive)" if dc else "4.1 (PWM drive)",
        "effects": [effect for effect in effects if effect != "nothing"],
        "planted": hidden,
        "nominal": nominal,
        "drive": drive._asdict(),
        "runs": starts,
    }
