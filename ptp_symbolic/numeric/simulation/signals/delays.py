"""Input delays, as tables shifted in time."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.signals.inputs import InputTable

FloatArray = NDArray[np.float64]


def delays_of(model: Model, p: FloatArray) -> FloatArray:
    """Delay of every input [nu] in s for parameters p [np]."""
    index = model.input_delays
    return np.where(index >= 0, p[np.maximum(index, 0)], 0.0) if len(p) else np.zeros(len(index))


def delayed(table: InputTable, delays: FloatArray) -> InputTable:
    """`table` with every signal delayed by its entry of `delays` [nu] in s."""
    if not np.any(delays):
        return table
    breaks, sines, sweeps = table.breaks.copy(), table.sines.copy(), table.sweeps.copy()
    for j, delay in enumerate(delays):
        breaks[table.offsets[j] + j : table.offsets[j + 1] + j + 1] += delay
        own = slice(table.sine_offsets[j], table.sine_offsets[j + 1])
        sines[own, 2] -= 2 * np.pi * sines[own, 1] * delay
        sweeps[table.sweep_offsets[j] : table.sweep_offsets[j + 1], 3:] += delay
    late = np.unique(np.concatenate([table.stops + delay for delay in delays]))
    return replace(table, breaks=breaks, sines=sines, sweeps=sweeps, stops=late)


def delay_columns(model: Model, columns: NDArray[np.int64]) -> NDArray[np.int64]:
    """Per input [nu] the tangent column of its delay among parameter `columns`, or -1."""
    where = {int(c): k for k, c in enumerate(columns)}
    return np.array([where.get(int(i), -1) if i >= 0 else -1 for i in model.input_delays], np.int64)
