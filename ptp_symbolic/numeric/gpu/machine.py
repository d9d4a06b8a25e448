"""One machine in one thread: the emitted functions of its model and arrays of its own.

All device code here is plain Python that numba compiles for the GPU, and that its simulator runs
as it stands.

What drives the trajectories: the signals of all kinds of runs in flat arrays, and their values
in a thread.

The same signals as in `simulation.input_values`: piecewise cubics (constants, zero-order holds,
linear tables), sines and sweeps. A delay belongs to the parameters, so that every thread has its
own.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numba.extending import register_jitable
from numpy.typing import NDArray

from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import InputSignal, stack
from ptp_symbolic.numeric.simulation.integration import limited_states
from ptp_symbolic.numeric.simulation.kernels.records import LARGEST_STATE

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


READY = 0  # status before a run; any other says that the trajectory is not to be run


@dataclass(frozen=True)
class Layout:
    """Sizes and indices of a model, which are constants of its kernels. Tuples without rows and
    sizes of zero are made one long, for arrays of a thread cannot be empty.
    """

    module: ModuleType
    states: int
    inputs: int
    parameters: int
    prepared: int
    frictions: int
    contacts: int
    limits: int
    modes: int
    guards: int
    friction_rates: tuple[int, ...]
    zero_at_rest: tuple[int, ...]
    contact_rates: tuple[int, ...]
    rigid: bool
    limited: tuple[int, ...]
    delays: tuple[int, ...]

    @staticmethod
    def of(model: Model) -> "Layout":
        """The layout of `model`."""
        frictions, contacts = len(model.friction_rates), len(model.contacts)
        limited = limited_states(model)
        return Layout(
            model.module,
            len(model.state_names),
            len(model.input_names),
            max(1, len(model.parameter_names)),
            max(1, int(model.module.PREPARED)),
            frictions,
            contacts,
            len(limited),
            max(1, len(model.mode_names)),
            max(1, 3 * frictions + 4 * contacts),
            _whole(model.friction_rates) or (0,),
            _whole(model.zero_at_rest),
            _whole(model.contacts.reshape(-1)) or (0, 0, 0),
            bool(model.contacts[:, 2].any()),
            _whole(limited) or (0,),
            _whole(model.input_delays),
        )


def _whole(values: Any) -> tuple[int, ...]:
    return tuple(int(each) for each in values)


class Runs(NamedTuple):
    """All trajectories: states x [n, b] in and out, parameters p [np, b], modes m [nm, b] at the
    start of rigid contacts, the kind of drive [b]; status [b] in and out, time reached in s [b] and
    number of steps [b] out.
    """

    x: Any
    p: Any
    m: Any
    kind: Any
    status: Any
    reached: Any
    steps: Any


class Machine(NamedTuple):
    """The emitted functions, the indices of `Layout`, and arrays: state x, trial state `end` [n],
    inputs at the start and the end of a step u, u_end [nu], parameters p [np], what `prepare` makes
    of them, modes m and m_before, guards g, bounds [limits, 2]; per contact whether it is pressed
    onto a joint that sticks, and whether it settles without a bounce; what `impacts` writes.
    """

    derivative: Any
    linearize: Any
    guard_values: Any
    impacts: Any
    frictions: Any
    contacts: Any
    friction_rates: Any
    zero_at_rest: Any
    contact_rates: Any
    limits: Any
    limited: Any
    x: Any
    end: Any
    u: Any
    u_end: Any
    p: Any
    prepared: Any
    m: Any
    m_before: Any
    g: Any
    bounds: Any
    pressed: Any
    settling: Any
    changes: Any


@register_jitable
def copy(source, target):
    """Copy a vector."""
    for i in range(len(source)):
        target[i] = source[i]


@register_jitable
def rates_of(machine, t, x, u, k):
    """Write dx/dt into k [n]; a gear output pressed onto a sticking joint stays at rest."""
    machine.derivative(t, x, u, machine.p, machine.m, machine.prepared, k)
    for c in range(machine.contacts):
        if machine.pressed[c] == 1:
            k[machine.contact_rates[3 * c]] = 0.0


@register_jitable
def is_finite(x):
    """Whether every state of x [n] is a number, and not a huge one."""
    found = True
    for a in range(len(x)):
        found = found and abs(x[a]) < LARGEST_STATE
    return found


@register_jitable
def is_outside(machine, x):
    """Whether some state of x [n] is past a bound of the domain of the equations."""
    for k in range(machine.limits):
        value = x[machine.limited[k]]
        if value < machine.bounds[k, 0] or value > machine.bounds[k, 1]:
            return True
    return False
