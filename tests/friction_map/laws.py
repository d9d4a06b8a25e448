"""Steady friction typed from thesis Eq. 4.1, apart from the package, and points made with it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.friction_map.points import Points

FloatArray = NDArray[np.float64]

SPEEDS = np.array([0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0])
RATES = np.concatenate([-SPEEDS, SPEEDS])
SCATTER = 0.01  # N m


class Side(NamedTuple):
    """Friction of one direction, SI units."""

    F_c: float
    F_s: float
    v_s: float
    F_v: float


def torque(rate: FloatArray, positive: Side, negative: Side) -> FloatArray:
    values = []
    for v in rate:
        side = positive if v > 0 else negative
        dry = side.F_c + (side.F_s - side.F_c) * np.exp(-((v / side.v_s) ** 2))
        values.append(dry * np.sign(v) + side.F_v * v)
    return np.array(values)


def drawn(
    seed: int, positive: Side, negative: Side, rate: FloatArray = RATES, scatter: float = SCATTER
) -> Points:
    noise = scatter * np.random.default_rng(seed).standard_normal(len(rate))
    return Points("drawn.csv", rate, torque(rate, positive, negative) + noise)
