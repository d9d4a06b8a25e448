"""Field logs of a torque-driven pan-tilt platform with a chosen hidden effect.

A sampled tracking controller that believes in the declared platform follows a smooth reference; its
torque is held from sample to sample and logged as applied, with sensor noise.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tests.independent.rigid_platform import Floats
from tests.independent.two_axis import simulate, two_axis

PERIOD = 5e-3  # s
COUNT = 2 * math.pi / 7200  # rad
TORQUE_NOISE = 3e-3  # N m rms, on the logged columns only
COLUMNS = "time [s],pan_torque [N*m],tilt_torque [N*m],pan_angle [rad],tilt_angle [rad]"
DURATION = 20.0  # s
STIFFNESS, RATE_GAIN = 20.0, 1.5  # N m/rad, N m s/rad
TONES = (0.13, 0.31, 0.54, 1.1)  # Hz
AMPLITUDES = ((0.8, 0.5, 0.25, 0.08), (0.5, 0.28, 0.17, 0.05))  # rad, pan and tilt
RUNS = (
    "train/tracking_1",
    "train/tracking_2",
    "train/tracking_3",
    "validate/tracking_4",
    "validate/tracking_5",
)

DECLARED = {
    "J_pan": 0.012,
    "J_x_tilt": 0.0041,
    "J_y_tilt": 0.0065,
    "J_z_tilt": 0.0027,
    "m_payload": 4.992,
    "J_x_payload": 0.0053,
    "J_y_payload": 0.0068,
    "J_z_payload": 0.0068,
    "c_x_payload": 0.1,
}

# Per effect: parameters that grow with the size asked for, and parameters that do not.
EFFECTS: dict[str, tuple[dict[str, float], dict[str, float]]] = {
    "nothing": ({}, {}),
    "payload_com_offset": (
        {"dc_x_payload": -0.004, "dc_y_payload": 0.006, "dc_z_payload": 0.009},
        {},
    ),
    "base_tilt": ({"beta_base": math.radians(4.0)}, {"alpha_base": 0.9}),
    "cable_spring_pan": (
        {"k1_cable_pan": 0.3, "k3_cable_pan": 0.1},
        {"theta0_cable_pan": 0.2},
    ),
    "cable_spring_tilt": (
        {"k1_cable_tilt": 0.4, "k3_cable_tilt": 0.2},
        {"theta0_cable_tilt": -0.3},
    ),
    "constant_torque_pan": ({"tau0_pan": 0.1}, {}),
    "constant_torque_tilt": ({"tau0_tilt": 0.2}, {}),
    "product_of_inertia": ({"J_xy_payload": 0.002, "J_yz_payload": -0.0015}, {}),
}


def draw_friction(rng: np.random.Generator) -> dict[str, float]:
    """Viscous friction in N m s/rad and Coulomb friction in N m of both joints."""
    friction = {}
    for axis in ("pan", "tilt"):
        friction[f"b_{axis}"] = float(rng.uniform(0.06, 0.16))
        friction[f"F_c_{axis}"] = float(rng.uniform(0.03, 0.08))
    return friction


def planted(effects: Sequence[str], size: float, settings: Mapping[str, float]) -> dict[str, float]:
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


def reference(rng: np.random.Generator) -> Callable[[float], tuple[Floats, Floats, Floats]]:
    """Angles, rates and accelerations [2] of a random sum of sines, as a function of time."""
    amplitudes = np.array(AMPLITUDES) * rng.uniform(0.85, 1.1, (2, len(TONES)))
    frequencies = 2 * math.pi * np.array(TONES) * rng.uniform(0.95, 1.05, (2, len(TONES)))
    phases = rng.uniform(0, 2 * math.pi, (2, len(TONES)))

    def at(time: float) -> tuple[Floats, Floats, Floats]:
        angles = frequencies * time + phases
        sines, cosines = amplitudes * np.sin(angles), amplitudes * np.cos(angles)
        return (
            sines.sum(axis=1),
            (frequencies * cosines).sum(axis=1),
            -(frequencies**2 * sines).sum(axis=1),
        )

    return at


def controller(
    wanted: Callable[[float], tuple[Floats, Floats, Floats]],
) -> Callable[[float, Floats, Floats], Floats]:
    """Torque [2] in N m: tracking, inertia and weight of the declared platform."""
    lever = DECLARED["m_payload"] * DECLARED["c_x_payload"]
    inertia = lever * DECLARED["c_x_payload"] + 0.0133

    def torque(time: float, theta: Floats, omega: Floats) -> Floats:
        angle, rate, acceleration = wanted(time)
        command = STIFFNESS * (angle - theta) + RATE_GAIN * (rate - omega)
        command += inertia * acceleration
        command[1] -= lever * 9.81 * math.cos(theta[1])
        return command

    return torque


def log_rows(torques: Floats, angles: Floats, rng: np.random.Generator) -> list[str]:
    """CSV rows of a run: torques [n, 2] with noise, angles [n, 2] rounded to encoder counts."""
    noisy = torques + TORQUE_NOISE * rng.normal(size=torques.shape)
    counted = np.rint(angles / COUNT) * COUNT + 0.0
    rows = np.hstack([noisy, counted])
    return [
        f"{k * PERIOD:.4f},{pan:.5f},{tilt:.5f},{theta_pan:.6f},{theta_tilt:.6f}"
        for k, (pan, tilt, theta_pan, theta_tilt) in enumerate(rows)
    ]


def write_logs(
    folder: Path,
    effects: Sequence[str],
    seed: int,
    size: float = 1.0,
    settings: Mapping[str, float] | None = None,
    runs: Sequence[str] | None = None,
) -> dict[str, Any]:
    """Write train/*.csv and validate/*.csv (all, or `runs`) and return the truth as plain data."""
    rng = np.random.default_rng(seed)
    friction, hidden = draw_friction(rng), planted(effects, size, settings or {})
    model = two_axis(DECLARED | friction | hidden)
    starts = {}
    for name in RUNS:
        wanted = reference(rng)
        noise = np.random.default_rng(rng.integers(2**32))
        if runs is not None and name not in runs:
            continue
        theta, omega, _ = wanted(0.0)
        torques, angles, _ = simulate(
            model, theta, omega, controller(wanted), round(DURATION / PERIOD), PERIOD
        )
        path = folder / f"{name}.csv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join([COLUMNS, *log_rows(torques, angles, noise)]) + "\n")
        starts[name] = {"theta": theta.tolist(), "omega": omega.tolist()}
    return {
        "platform": "two_axis",
        "effects": [effect for effect in effects if effect != "nothing"],
        "planted": hidden,
        "nominal": friction,
        "declared": DECLARED,
        "runs": starts,
    }
