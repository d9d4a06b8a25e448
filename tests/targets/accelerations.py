"""Accelerations of a machine without waiting for a compiler."""

from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.models.emission import module_of
from ptp_symbolic.platform import Platform
from tests.effects.plain_python import module_as_python

FloatArray = NDArray[np.float64]


class Accelerations:
    """Of the emitted module of a platform without modes, as plain Python."""

    def __init__(self, platform: Platform) -> None:
        self.module: ModuleType = module_as_python(module_of(platform))
        self.p = np.array([default for _, _, default, *_ in self.module.PARAMETERS])

    def __call__(self, x: FloatArray, u: FloatArray) -> FloatArray:
        dx = np.zeros(len(x))
        self.module.state_derivative(0.0, x, u, self.p, dx)
        return dx[len(x) // 2 :]
