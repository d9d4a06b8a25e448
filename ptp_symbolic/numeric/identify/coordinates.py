"""The coordinates in which a fit searches: logarithms where zero is out of bounds, or scaled."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import SAME

FloatArray = NDArray[np.float64]

SMALLEST_SHARE = SAME * SAME  # of a scale; from which on a logarithm begins


@dataclass(frozen=True)
class FreeParameter:
    """A parameter to be fitted: start, bounds, period and scale in its unit; `tied` follow its
    value.

    `declared_start` is the value that the platform declares to start from; None for a parameter of
    an effect that is only searched for.
    """

    name: str
    start: float
    lower: float
    upper: float
    period: float | None = None
    tied: tuple[str, ...] = ()
    logarithmic: bool = False
    scale: float = 1.0
    declared_start: float | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Its name and those of the parameters tied to it."""
        return (self.name, *self.tied)


def free_parameter(
    name: str,
    start: float,
    lower: float,
    upper: float,
    period: float | None = None,
    tied: tuple[str, ...] = (),
) -> FreeParameter:
    """Choose the coordinate: logarithmic where zero is out of bounds; the others can reach it."""
    logarithmic = lower > 0.0
    scale = abs(start) if start != 0.0 else min(1.0, 0.1 * (upper - lower))
    return FreeParameter(name, start, lower, upper, period, tied, logarithmic, scale)


def to_search(free: Sequence[FreeParameter], values: Mapping[str, float]) -> FloatArray:
    """Search coordinates [nf] of parameter values, dimensionless."""
    return np.array(
        [
            np.log(max(values[f.name], SMALLEST_SHARE * f.start) / f.start)
            if f.logarithmic
            else values[f.name] / f.scale
            for f in free
        ]
    )


def to_values(free: Sequence[FreeParameter], phi: FloatArray) -> dict[str, float]:
    """Parameter values of search coordinates phi [nf], within their bounds to the last bit."""
    given = [
        f.start * np.exp(v) if f.logarithmic else f.scale * v
        for f, v in zip(free, phi, strict=True)
    ]
    return {f.name: float(np.clip(v, f.lower, f.upper)) for f, v in zip(free, given, strict=True)}


def slopes(free: Sequence[FreeParameter], phi: FloatArray) -> FloatArray:
    """Derivative of every parameter value by its search coordinate phi [nf], in its unit."""
    values = to_values(free, phi)
    return np.array([values[f.name] if f.logarithmic else f.scale for f in free])


def limits(free: Sequence[FreeParameter]) -> tuple[FloatArray, FloatArray]:
    """Bounds of the search coordinates, each [nf]."""
    low, high = [], []
    for f in free:
        if f.logarithmic:
            low.append(np.log(max(f.lower, SMALLEST_SHARE * f.start) / f.start))
            high.append(np.log(f.upper / f.start))
        else:
            low.append(f.lower / f.scale)
            high.append(f.upper / f.scale)
    return np.array(low), np.array(high)


def wrapped(free: FreeParameter, value: float) -> float:
    """The value of a periodic parameter in (-period/2, period/2]."""
    if free.period is None:
        return value
    return float(value - free.period * np.ceil(value / free.period - 0.5))
