"""Integrate smooth motion by steps of order 8: preallocate, run, and return the results."""

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation import smooth_runner
from ptp_symbolic.numeric.simulation.kernels.calls import smooth_addresses
from ptp_symbolic.numeric.simulation.signals.inputs import InputTable
from ptp_symbolic.numeric.simulation.smooth_runner import LANES, REACHED, ROWS, START, TRIED

FloatArray = NDArray[np.float64]


def is_smooth(model: Model) -> bool:
    """Whether the motion of `model` has no modes, samplers or bounds, so that nothing ends a step
    but its inputs.
    """
    return not (model.mode_names or model.sampler_periods or model.limits)


def integrate_smooth(
    model: Model,
    p: FloatArray,
    x: FloatArray,
    inputs: InputTable,
    held: bool,
    stops: FloatArray,
    times: FloatArray,
    limits: FloatArray,
    atol: FloatArray,
    ledger: bool,
) -> tuple[int, float, FloatArray, FloatArray, FloatArray, int]:
    """Integrate `model` at p [np] from x [n] over `stops` in s, as `integrate` does: status, time
    reached in s, state there, states [k, n] and ledger [k, 3] at `times`, steps tried.

    `limits` [3]: relative tolerance, largest step in s, most steps; `atol` [n].
    """
    n, k, z = len(x), len(times), np.zeros
    width = -(-(n + 2 * ledger) // LANES) * LANES
    work, clock, counts = z((ROWS, width)), z(5), z(4, np.int64)
    work[START, :n] = x
    u, cursor, out, energies = z(len(model.input_names)), inputs.new_cursor(), z((k, n)), z((0, 3))
    if ledger:
        energies = z((k, 3))
    status = smooth_runner.runner()(
        smooth_addresses(model.module, ledger),
        p,
        z(0),
        model.prepared(p),
        inputs.arrays,
        cursor,
        held,
        u,
        limits,
        atol,
        work,
        clock,
        counts,
        stops,
        times,
        out,
        energies,
    )
    return status, float(clock[REACHED]), work[START, :n], out, energies, int(counts[TRIED])
