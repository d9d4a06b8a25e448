"""Delays of the inputs that a machine has and its platform declares, as known or to be fitted."""

from dataclasses import dataclass

import numpy as np

from tests.benchmark.machine import Declared, Values
from tests.benchmark.variation import Variation

START, BOUNDS = 2e-3, (0.0, 0.03)  # s
TRUE = (1e-3, 9e-3)  # s, least and most


@dataclass(frozen=True)
class DelayedVariation(Variation):
    """The surroundings of a machine with delays: "known" or "free"; "" is none."""

    delays: str = ""


def _kind(variation: Variation) -> str:
    return variation.delays if isinstance(variation, DelayedVariation) else ""


def draw_delays(
    rng: np.random.Generator, axes: tuple[str, ...], variation: Variation
) -> dict[str, float]:
    """True delays in s, even in their logarithm."""
    if not _kind(variation):
        return {}
    return {f"t_delay_{axis}": float(np.exp(rng.uniform(*np.log(TRUE)))) for axis in axes}


def free_delays(axes: tuple[str, ...], variation: Variation) -> tuple[str, ...]:
    """Names of the delays that are to be fitted."""
    return tuple(f"t_delay_{axis}" for axis in axes) if _kind(variation) == "free" else ()


def with_delays(
    platform: Declared, values: Values, axes: tuple[str, ...], variation: Variation
) -> Declared:
    """The platform with its delays, where there are any."""
    if _kind(variation):
        for axis in axes:
            name = f"t_delay_{axis}"
            platform["effects"].append({"effect": "input_delay", "axis": axis})
            known = {"value": values[name]}
            fitted = {"start": START, "bounds": list(BOUNDS)}
            platform["parameters"][name] = known if _kind(variation) == "known" else fitted
    return platform
