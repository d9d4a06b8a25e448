"""Pieces of declared platforms: start values, bounds, signals; and how far off a start may be."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from tests.benchmark.machine import CURRENT_NOISE
from tests.benchmark.variation import Variation

UNITS = {
    "J": "kg m^2",
    "b": "N m s/rad",
    "d_shaft": "N m s/rad",
    "F_c": "N m",
    "F_s": "N m",
    "v_s": "rad/s",
    "F_v": "N m s/rad",
}
BOUNDS = {
    "J": (1e-4, 2.0),
    "b": (0.0, 50.0),
    "d_shaft": (0.0, 100.0),
    "F_c": (0.0, 20.0),
    "F_s": (0.0, 30.0),
    "v_s": (1e-3, 0.5),
    "F_v": (0.0, 50.0),
}
NEAR = (0.6, 1.7)
FAR = (3.0, 6.0)


def near(rng: np.random.Generator) -> float:
    """A factor of 0.6 to 1.7, even in its logarithm."""
    return float(np.exp(rng.uniform(*np.log(NEAR))))


def far(rng: np.random.Generator) -> float:
    """A factor of 3 to 6, or one by it."""
    factor = float(np.exp(rng.uniform(*np.log(FAR))))
    return factor if rng.random() < 0.5 else 1.0 / factor


def letter(name: str) -> str:
    """The physics letter of a parameter: F_c of F_c_pan, J of J_y_tilt."""
    stem = name.rpartition("_")[0]
    return "J" if stem.startswith("J") else stem


def bounds_for(names: Iterable[str]) -> dict[str, list[float]]:
    """Declared bounds of free parameters."""
    return {name: list(BOUNDS[letter(name)]) for name in names}


def angle_signal(axis: str, variation: Variation) -> dict[str, Any]:
    """The encoder of `axis`."""
    signal = {
        "role": "output",
        "column": f"{axis}_angle",
        "unit": "rad",
        "counts_per_revolution": variation.counts,
    }
    if variation.declared_noise:
        signal["noise"] = variation.noise_counts * 2 * math.pi / variation.counts
    return signal


def input_signal(axis: str, quantity: str) -> dict[str, Any]:
    """A voltage or torque; its noise is added once it is known."""
    unit = {"voltage": "V", "torque": "N m"}[quantity]
    return {"role": "input", "column": f"{axis}_{quantity}", "unit": unit}


def drive_signals(axis: str, variation: Variation) -> dict[str, Any]:
    """Voltage in, angle out, and the current where it is logged."""
    signals = {f"u_{axis}": input_signal(axis, "voltage")}
    if variation.current:
        signals[f"i_{axis}"] = {
            "role": "output",
            "column": f"{axis}_current",
            "unit": "A",
            "noise": CURRENT_NOISE,
        }
    signals[f"theta_{axis}"] = angle_signal(axis, variation)
    return signals


def torque_signals(axis: str, variation: Variation) -> dict[str, Any]:
    """Torque in, angle out."""
    return {
        f"tau_{axis}": input_signal(axis, "torque"),
        f"theta_{axis}": angle_signal(axis, variation),
    }


def rigid_effects(
    axes: tuple[str, ...], motor: bool, viscous: bool, without: tuple[str, ...]
) -> list[dict[str, str]]:
    """Declared effects of a machine without gap and shaft, less those named in `without`."""
    effects = [{"effect": "rigid_bodies"}, {"effect": "payload"}]
    for axis in axes:
        if motor:
            effects.append({"effect": "dc_motor", "axis": axis})
        if viscous and f"viscous_friction@{axis}" not in without:
            effects.append({"effect": "viscous_friction", "axis": axis})
        if f"csvs_friction@{axis}" not in without:
            effects.append({"effect": "csvs_friction", "axis": axis, "site": "joint"})
    return effects


def owned(effects: list[dict[str, str]], parameters: dict[str, Any]) -> dict[str, Any]:
    """The parameters whose friction effect is declared; those of bodies and motors all are."""
    of_friction = {"b": "viscous_friction"} | dict.fromkeys(
        ("F_c", "F_s", "v_s", "F_v"), "csvs_friction"
    )
    kept = {}
    for name, declaration in parameters.items():
        effect, axis = of_friction.get(letter(name)), name.rpartition("_")[2]
        declared = any(one["effect"] == effect and one["axis"] == axis for one in effects[2:])
        if effect is None or declared:
            kept[name] = declaration
    return kept
