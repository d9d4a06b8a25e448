"""A run with other inputs: noisy, silent, averaged."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.simulation.signals.inputs import stack, table


def with_inputs(run: Run, values: NDArray[np.float64]) -> Run:
    """`run` with the inputs `values` [k, nu], zero-order hold from sample to sample."""
    held = np.ascontiguousarray(values)
    return replace(run, inputs=stack([table(run.time, c) for c in held.T]), held_inputs=held)
