"""One machine in one thread: the emitted functions of its model and arrays of its own.

All device code here is plain Python that numba compiles for the GPU, and that its simulator runs
as it stands.
"""

from dataclasses import dataclass
from types import ModuleType
from typing import Any, NamedTuple

from numba.extending import register_jitable

from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.buffers import limited_states
from ptp_symbolic.numeric.simulation.kernels.records import LARGEST_STATE

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
