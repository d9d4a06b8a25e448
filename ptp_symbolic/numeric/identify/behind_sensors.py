"""Joint angles behind sensors that err: where they show what was measured."""

import numpy as np
from numba import njit

from ptp_symbolic.numeric.identify.constants import ROUNDS
from ptp_symbolic.numeric.simulation.kernels.calls import call

NEXT_TO_NONE = float(np.sqrt(np.finfo(float).eps))  # rad; of an angle: the root of rounding


@njit(cache=True, nogil=True, error_model="numpy")
def angles_behind_sensors(addresses, layout, shown, time, measured, inputs, p, signals):
    """Joint angles [k, na] in rad at which the sensors at p [np] show what was `measured` [k, na];
    `shown` [na] is the place of every angle among the `signals` outputs. Fixed-point iteration:
    errors of sensors are small and smooth.
    """
    angles = measured.copy()
    x, y = np.zeros(layout.states), np.zeros(signals)
    for k in range(len(time)):
        for _ in range(ROUNDS):
            left = 0.0
            for a in range(len(shown)):
                x[layout.angle[a]] = angles[k, a]
            call(addresses[2], time[k], x, inputs[k], p, y)
            for a in range(len(shown)):
                error = measured[k, a] - y[shown[a]]
                angles[k, a] += error
                left = max(left, abs(error))
            if left <= NEXT_TO_NONE:
                break
    return angles
