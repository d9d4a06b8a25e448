"""The error of a model in force along a measured motion, as the authors of EMPS compute it.

Janot, Gautier and Brunot (Nonlinear Benchmark Workshop 2019): the position goes through a
zero-phase Butterworth filter of order 4 at 100 Hz and is differentiated twice; what the model makes
of it and the measured force are filtered alike and decimated by 10; the error is
100 |y - yhat| / |y|. In a closed loop the error of the position says nothing. They compare the two
forces at the samples; but a force that is held until the next sample acts half a period later.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from ptp_symbolic.models.inverse_dynamics import Motion, inverse_dynamics
from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

FloatArray = NDArray[np.float64]

CORNER, ORDER = 100.0, 4  # Hz, of the filter
DECIMATION = 10
EDGE = 5  # decimated samples at either end, where the filters begin and end


def force_error(
    platform: Platform,
    parameters: Mapping[str, float],
    time: FloatArray,
    force: FloatArray,
    position: FloatArray,
    held: bool = False,
) -> float:
    """Relative error in percent of the force that `platform` with `parameters` needs for a motion.

    `time` [k] in s, evenly sampled; `force` [k] in N; `position` [k] in m. A force that is `held`
    from each sample to the next is compared with the mean of what is needed in between; one that
    acts late, where the platform has a delay, with what is needed then.
    """
    period = float(np.median(np.diff(time)))
    smooth = signal.filtfilt(*signal.butter(ORDER, 2.0 * CORNER * period), position)
    speed = np.gradient(smooth, period)
    acceleration = np.gradient(speed, period)
    motion = Motion(smooth[:, None], speed[:, None], acceleration[:, None], time)
    needed = inverse_dynamics(platform, motion, parameters)[:, 0]
    (delay,) = assemble(platform).delays
    needed = np.interp(time + parameters.get(str(delay), 0.0), time, needed)
    if held:
        needed = np.append(0.5 * (needed[1:] + needed[:-1]), needed[-1])
    measured, predicted = (
        signal.decimate(column, DECIMATION, zero_phase=True)[EDGE:-EDGE]
        for column in (force, needed)
    )
    left = np.linalg.norm(measured - predicted)
    return 100.0 * float(left / np.linalg.norm(measured))
