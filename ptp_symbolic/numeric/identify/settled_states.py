"""What no sensor shows and soon forgets, where a window begins: the winding current of a motor.

It follows the motion and the input before the window as if it had settled there, the reduced model
of fast states (Kokotovic, Khalil and O'Reilly, 1986, 1.2): from none, a current would come up
within the window, and a joint that slides would start a little behind.
"""

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import FORGOTTEN, SAME
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


def settle(
    model: Model,
    run: Run,
    p: FloatArray,
    x: FloatArray,
    s: FloatArray,
    columns: NDArray[np.int64],
) -> None:
    """Put the hidden states of a window that forget all but the share SAME of what they were within
    FORGOTTEN into the state x [n] with which it begins, at p [np], and their derivatives by the
    parameters `columns` [nc] and by the start unknowns [nz] into its tangents s [n, nc + nz]. Their
    own laws are linear in them. A run that is no window begins as it does.
    """
    if run.before is None or not (hidden := _hidden(model, run)):
        return
    n, t, u = len(x), float(run.time[0]), run.before
    m, dx = np.zeros(len(model.mode_names)), np.zeros(n)
    model.module.initial_modes(t, x, u, p, m)
    fx = model.derivatives(t, x, u, p, m).fx
    fast = [k for k in hidden if fx[k, k] * FORGOTTEN < np.log(SAME)]
    if not fast:
        return
    model.module.mode_derivative(t, x, u, p, m, dx)
    x[fast] -= np.linalg.solve(fx[fast][:, fast], dx[fast])
    if not s.shape[1]:
        return
    there = model.derivatives(t, x, u, p, m)
    own, s[fast] = there.fx[fast][:, fast], 0.0
    change = there.fx[fast] @ s
    change[:, : len(columns)] += there.fp[fast][:, columns]
    s[fast] = -np.linalg.solve(own, change)


def _hidden(model: Model, run: Run) -> tuple[int, ...]:
    """States with a differential equation beside the motion that no signal shows, and that friction
    does not set.
    """
    return tuple(
        k
        for k, name in enumerate(model.state_names[: model.moving])
        if not name.startswith(("theta_", "omega_"))
        and name not in run.signals
        and model.zero_at_rest[k] < 0
    )
