"""What drives the trajectories: the signals of all kinds of runs in flat arrays, and their values
in a thread.

The same signals as in `simulation.signals`: piecewise cubics (constants, zero-order holds, linear
tables), sines and sweeps. A delay belongs to the parameters, so that every thread has its own.
"""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

from ptp_symbolic.numeric.simulation.signals.inputs import InputSignal, stack

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Drives(NamedTuple):
    """The signals of the kinds of runs, those of a kind side by side, in the order of the inputs.

    Signal s: breaks from offsets[s] + s on, coefficients [offsets[s + 1] - offsets[s], 4] of its
    pieces, sines [r, 3], sweeps [q, 5] as an InputSignal has them; jumps in s between
    jump_offsets[s] and jump_offsets[s + 1], where a step must end.
    """

    breaks: Any
    coefficients: Any
    offsets: Any
    sines: Any
    sine_offsets: Any
    sweeps: Any
    sweep_offsets: Any
    jumps: Any
    jump_offsets: Any


class Signals(NamedTuple):
    """The signals of one thread: the `first` one among `drives`; per input its delay `late` [nu] in
    s, the piece found last, and its next jump.
    """

    drives: Any
    first: Any
    late: Any
    piece: Any
    jump: Any


def drives_of(kinds: Sequence[Sequence[InputSignal]]) -> Drives:
    """The signals of all `kinds`, packed. Arrays without rows get one, which nothing reads."""
    signals = [signal for kind in kinds for signal in kind]
    table = stack(signals)
    jumps = [np.unique(signal.jumps) for signal in signals]
    jump_offsets = np.cumsum([0, *map(len, jumps)], dtype=np.int64)
    every = (*table.arrays, np.concatenate([np.empty(0), *jumps]), jump_offsets)
    return Drives(*(a if len(a) else np.zeros((1, *a.shape[1:]), a.dtype) for a in every))


@register_jitable
def begin_signals(signals, delays, p):
    """Set the delays [nu] of a thread from its parameters p [np]; `delays` [nu] are their indices,
    or -1.
    """
    for j in range(len(signals.late)):
        signals.late[j] = p[delays[j]] if delays[j] >= 0 else 0.0
        signals.piece[j] = 0
        signals.jump[j] = signals.drives.jump_offsets[signals.first + j]


@register_jitable
def next_stop(t, end, signals):
    """The earlier of `end` and the next jump of a signal after t, in s."""
    stop = end
    for j in range(len(signals.late)):
        last = signals.drives.jump_offsets[signals.first + j + 1]
        k, late = signals.jump[j], signals.late[j]
        while k < last and signals.drives.jumps[k] + late <= t:
            k += 1
        signals.jump[j] = k
        if k < last:
            stop = min(stop, signals.drives.jumps[k] + late)
    return stop


@register_jitable
def evaluate(t, side, signals, u):
    """Write the inputs u [nu] at t in s; `side` 1: after a jump there, -1: before."""
    for j in range(len(signals.late)):
        s, late = signals.first + j, signals.late[j]
        u[j] = polynomial(t, side, signals, j) + waves(t, side, signals.drives, s, late)


@register_jitable
def polynomial(t, side, signals, j):
    """The piecewise cubic of input j at t in s."""
    d, late = signals.drives, signals.late[j]
    row = d.offsets[signals.first + j]
    pieces = d.offsets[signals.first + j + 1] - row
    at = row + signals.first + j
    k = signals.piece[j]
    while k < pieces and (
        d.breaks[at + k + 1] + late < t or (side > 0 and d.breaks[at + k + 1] + late == t)
    ):
        k += 1
    while k >= 0 and (d.breaks[at + k] + late > t or (side < 0 and d.breaks[at + k] + late == t)):
        k -= 1
    signals.piece[j] = k
    piece = min(max(k, 0), pieces - 1)
    inside = min(max(t, d.breaks[at] + late), d.breaks[at + pieces] + late)
    s = inside - (d.breaks[at + piece] + late)
    row += piece
    high = d.coefficients[row, 2] + s * d.coefficients[row, 3]
    return d.coefficients[row, 0] + s * (d.coefficients[row, 1] + s * high)


@register_jitable
def waves(t, side, d, s, late):
    """Sines and sweeps of signal s at t in s, delayed by `late` s."""
    value = 0.0
    for i in range(d.sine_offsets[s], d.sine_offsets[s + 1]):
        frequency = d.sines[i, 1]
        phase = d.sines[i, 2] - 2.0 * math.pi * frequency * late
        value += d.sines[i, 0] * math.sin(2.0 * math.pi * frequency * t + phase)
    for i in range(d.sweep_offsets[s], d.sweep_offsets[s + 1]):
        t0, t1 = d.sweeps[i, 3] + late, d.sweeps[i, 4] + late
        if t0 <= t < t1 or (side < 0 and t == t1):
            rate = 0.5 * (d.sweeps[i, 2] - d.sweeps[i, 1]) / (t1 - t0)
            turns = (d.sweeps[i, 1] + rate * (t - t0)) * (t - t0)
            value += d.sweeps[i, 0] * math.sin(2.0 * math.pi * turns)
    return value
