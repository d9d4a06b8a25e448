"""What logs show of a structure before it is fitted: values at which its parameters may begin."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from ptp_symbolic.numeric.identify.constants import SPRING_BAND, SPRING_SHARE
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.sample_averages import usual_period
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


def spring_over_inertia(
    period: float, lags: Sequence[FloatArray], angles: Sequence[FloatArray]
) -> float | None:
    """The stiffness of a spring over the inertia behind it, in 1/s^2; None where the logs show no
    spring.

    `angles` [n] of the inertia in rad, and the `lags` [n] of these behind what a rigid model
    expects, both every `period` s. Within a band of frequencies the spring gives the inertia its
    acceleration, stiffness times lag and damping times rate of the lag: two columns, least squares.
    """
    lowest, highest = SPRING_BAND
    if highest >= 0.5 / period:
        return None
    band = butter(2, [lowest, highest], "bandpass", fs=1.0 / period, output="sos")
    columns, wanted = [], []
    for lag, angle in zip(lags, angles, strict=True):
        if len(lag) * period * lowest >= 1.0:
            twist, turned = sosfiltfilt(band, lag), sosfiltfilt(band, angle)
            columns.append(np.column_stack([twist, np.gradient(twist, period)]))
            wanted.append(np.gradient(np.gradient(turned, period), period))
    if not columns:
        return None
    rows, acceleration = np.vstack(columns), np.concatenate(wanted)
    stiffness = float(np.linalg.lstsq(rows, acceleration)[0][0])
    back = np.column_stack([acceleration, rows[:, 1]])
    error = rows[:, 0] - back @ np.linalg.lstsq(back, rows[:, 0])[0]
    share = 1.0 - np.sum(error**2) / max(np.sum(rows[:, 0] ** 2), np.finfo(float).tiny)
    return stiffness if share >= SPRING_SHARE and stiffness > 0.0 else None


def read_stiffness(rigid: Fit, axis: str, model: Model, name: str) -> float | None:
    """The value of the parameter `name` of `model`, the stiffness of a shaft before the joint of
    `axis`, that the fit of a `rigid` model leaves to be explained; None where it shows no spring.
    """
    signal = f"theta_{axis}"
    lags, angles, periods = [], [], []
    for run, evaluation in rigid.pairs():
        if signal in run.signals:
            k = run.signals.index(signal)
            missing = evaluation.residual.reshape(run.measured.shape)[:, k] / run.weight[k]
            lags.append(-missing)
            angles.append(run.measured[:, k])
            periods.append(usual_period([run]))
    if rigid.failed or not lags or not np.allclose(periods, periods[0]):
        return None
    found = spring_over_inertia(periods[0], lags, angles)
    own = _spring_over_inertia_of(model, axis)
    return None if found is None or own <= 0.0 else model.defaults[name] * found / own


def _spring_over_inertia_of(model: Model, axis: str) -> float:
    """What a `model` with a shaft has at its defaults: the slope of the acceleration over a twist
    that is wider than a gap, both sides turning, so that friction is the same.
    """
    states, p = list(model.state_names), model.parameter_vector()
    x, still = np.zeros(len(states)), np.zeros(len(model.input_names))
    x[[states.index(f"omega_{axis}"), states.index(f"omega_gear_{axis}")]] = 1.0
    gear, slopes = states.index(f"theta_gear_{axis}"), []
    for twist in (1.0, 2.0):
        x[gear] = twist
        slopes.append(model.rhs(0.0, x, still, p)[states.index(f"omega_{axis}")])
    return float(slopes[1] - slopes[0])
