"""Preallocated arrays of a run, for its work and its results: kernels allocate nothing."""

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.runtime.element_layout import contact_count, contact_guards
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.kernels.linear import padded
from ptp_symbolic.numeric.simulation.kernels.records import Record, Step, Tangents, Watch
from ptp_symbolic.numeric.simulation.methods.rosenbrock import STAGES

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def new_record(times: FloatArray, n: int, ns: int, ledger: int, event_room: int) -> Record:
    """Preallocated results at `times` [k] in s: n states, ns tangents, `ledger` rows, events."""
    z = np.zeros
    return Record(
        times,
        z((len(times), n)),
        z((len(times), n, ns)),
        z((ledger, 3)),
        z((event_room, 3)),
        z(3),
        z((4, 3)),
        z(2),
        z(6, dtype=np.int64),
    )


def new_step(n: int, nu: int, parameters: int, solved: int) -> Step:
    """Preallocated arrays of a step of n states, the first `solved` of them in linear systems; with
    no `parameters` derivatives by these are not asked for.
    """
    z, width = np.zeros, padded(n)
    return Step(
        z(width),
        z(width),
        z((STAGES, width)),
        z((STAGES, width)),
        z(n),
        z((5, width)),
        z((n, n)),
        z((n, nu)),
        z((n if parameters else 0, parameters)),
        z((solved, width)),
        z((solved, width)),
        z(n, dtype=np.int64),
        z(width),
        z(width),
        z(width),
    )


def contact_table(model: Model) -> IntArray:
    """Table [c, 5] of the contacts: both rates, rule, flags PRESSED and SETTLING, cleared."""
    rules = model.contacts
    table = np.zeros((len(rules), 5), dtype=np.int64)
    table[:, :3] = rules
    return table


def limited_states(model: Model) -> IntArray:
    """State index [limits] of every limit of the domain."""
    return np.array([model.state_names.index(name) for name, _ in model.limits], np.int64)


def new_watch(model: Model, n: int, p: FloatArray) -> Watch:
    """Preallocated guards and modes of n states, with the bounds of the domain at p [np]."""
    parameters = len(p)
    frictions, modes = len(model.friction_rates), len(model.mode_names)
    elements = frictions + contact_count(frictions, modes)
    watched = elements + len(model.limits)
    guards, z = contact_guards(frictions, elements - frictions), np.zeros
    strikes = (elements - frictions) * (n + 2)
    return Watch(
        z(guards),
        z(modes),
        z(modes),
        z(watched),
        z(watched),
        z(watched),
        z((guards, n)),
        z((guards, parameters)),
        z(n),
        z(parameters),
        z(n),
        z(n),
        z(strikes),
        z((strikes, n)),
        z((strikes, parameters)),
        z(1),
        z((2, 3)),
        limited_states(model),
        model.domain(p),
        z(modes),
        z(n),
    )


def new_tangents(
    s: FloatArray, columns: IntArray, delay_column: IntArray, parameters: int, nu: int
) -> Tangents:
    """Preallocated tangents, begun at s [n, ns]; `columns` and `delay_column` as in `integrate`."""
    (n, ns), z = (len(s), padded(s.shape[1])), np.zeros
    table = z((n, ns))
    table[:, : s.shape[1]] = s
    return Tangents(
        table.reshape(-1),
        table,
        columns,
        delay_column,
        z((STAGES, n * ns)),
        z(n * ns),
        z(n * ns),
        z(n * ns),
        z((3, n, n)),
        z((3, n * ns)),
        z((n, n)),
        z((n, nu)),
        z((n, parameters)),
    )
