"""Forward sensitivities of states and measured signals, through located events.

The tangents follow the variational equation with the method of the run itself; at an event the
saltation matrix, the jump of the vector field times the shift of the event time, updates them
(Aizerman and Gantmacher, 1958).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numba import njit, types
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import (
    InputSignal,
    InputTable,
    delay_columns,
    slopes_at,
    values_at,
)
from ptp_symbolic.numeric.simulation.integration import (
    IMPLICIT,
    METHODS,
    Accuracy,
    Solution,
    checked_accuracy,
    default_method,
    integrate,
    stable_step,
)
from ptp_symbolic.numeric.simulation.kernels.calls import call, output_addresses
from ptp_symbolic.numeric.simulation.kernels.records import (
    CUBE,
    DONE,
    INTEGERS,
    KERNEL,
    MATRIX,
    STIFF,
    VECTOR,
)
from ptp_symbolic.numeric.simulation.lanes import BatchProblem, BatchStates, integrate_batch
from ptp_symbolic.numeric.simulation.run import (
    checked_parameters,
    chosen_method,
    input_table,
    output_times,
    refuse_failure,
    start_of,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

OF_DELAY = 1e-6  # s: step of the central difference by a delay
FAR = 1e5  # steps of a stable explicit method: a transient as short costs the states no accuracy
LONGER = 5.0  # times as long is each step through such a transient than the one before


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """States x [k, n] and signals y [k, ny] at t [k] in s, and their derivatives by `names` [m].

    `states` [k, n, m] and `signals` [k, ny, m] are in the unit of the numerator over the unit of
    the parameter or initial state.
    """

    t: FloatArray
    x: FloatArray
    y: FloatArray
    names: tuple[str, ...]
    states: FloatArray
    signals: FloatArray


def sensitivity(
    model: Model,
    times: float | ArrayLike,
    inputs: Mapping[str, InputSignal | str] | None = None,
    parameters: Mapping[str, float] | None = None,
    initial: Mapping[str, float] | None = None,
    by_parameters: Sequence[str] | None = None,
    by_initial: Sequence[str] = (),
    rtol: float = 1e-8,
    atol: float = 1e-9,
    largest_step: float = 0.1,
    method: str | None = None,
) -> Sensitivities:
    """Sensitivities by parameters (None: all) and by initial states, at `times` as in `simulate`.

    Tolerances and `method` are as in `simulate` too, `method` without "fixed_step". Near vanishing
    bounces the solution is only piecewise smooth: difference quotients over a thousandth of a
    parameter are off by half a percent; smaller steps converge to these derivatives, until rounding
    spoils them.

    Raises InputError for unknown names and methods, parameters out of bounds, times that do not
    increase and a tolerance or largest step that is not above zero, and
    SimulationError when the simulation cannot go on.
    """
    t, p = output_times(times), checked_parameters(model, parameters or {})
    table = input_table(model, inputs or {}, p, float(t[-1]))
    wanted = tuple(model.parameter_names if by_parameters is None else by_parameters)
    along = directions(model, wanted, by_initial)
    x = start_of(model, initial or {})
    chosen = None if method is None else chosen_method(model, method, tuple(METHODS))
    accuracy = checked_accuracy(model, rtol, atol, largest_step)
    found = integrate_tangents(model, chosen, p, x, table, t, accuracy, along)
    refuse_failure(model, p, found.status, found.reached, found.state)
    y, signals = measured(model, t, found.x, found.s, p, along, table)
    return Sensitivities(t, found.x, y, (*wanted, *by_initial), found.s, signals)


@dataclass(frozen=True, eq=False)
class Directions:
    """What is differentiated by: indices of parameters `columns` [j], then of states whose initial
    values are meant, `initial` [i].
    """

    columns: IntArray
    initial: IntArray

    def __len__(self) -> int:
        return len(self.columns) + len(self.initial)


def directions(model: Model, by_parameters: Sequence[str], by_initial: Sequence[str]) -> Directions:
    """The indices of parameters and states. Raises InputError for unknown names."""
    columns = [_index(model.parameter_names, name, "parameter") for name in by_parameters]
    initial = [_index(model.state_names, name, "state") for name in by_initial]
    return Directions(np.array(columns, np.int64), np.array(initial, np.int64))


def integrate_tangents(
    model: Model,
    method: str | None,
    p: FloatArray,
    x: FloatArray,
    table: InputTable,
    times: FloatArray,
    accuracy: Accuracy,
    along: Directions,
) -> Solution:
    """Integrate `model` at p [np] from x [n] over `times` [k] in s, with the tangents s [k, n, m]
    along `along`; `method` as `integrate` takes it. Raises InputError as that does.
    """
    s = np.zeros((len(x), len(along)))
    s[along.initial, len(along.columns) + np.arange(len(along.initial))] = 1.0

    def run(chosen: str) -> Solution:
        # The error estimate does not see a fast mode that has decayed in the states, and it still
        # grows in the tangents, by ten powers of ten where explicit steps are too long.
        stable = stable_step(model, p, x)
        stops = table.with_stops(times)
        if chosen == IMPLICIT:
            stops, stable = _through_transients(stops, table.stops, stable), np.inf
        return integrate(
            model,
            chosen,
            p,
            x,
            table,
            table.held,
            stops,
            times,
            replace(accuracy, largest_step=min(accuracy.largest_step, stable)),
            s,
            along.columns,
            delay_columns(model, along.columns),
        )

    found = run(method or default_method(model))
    return run(IMPLICIT) if found.status == STIFF and method is None else found


def integrate_batch_tangents(
    problem: BatchProblem,
    p: FloatArray,
    x: FloatArray,
    drive: IntArray,
    along: Directions,
    of_outputs: bool = False,
    threads: int | None = None,
) -> BatchStates:
    """As `integrate_batch`, each trajectory as `integrate_tangents` has it, with the derivatives of
    its states and, where they are asked for, of its outputs.
    """
    model, times, m = problem.model, problem.times, len(along)
    states = np.full((len(p), len(times), x.shape[1], m), np.nan)
    rows = len(p) if of_outputs else 0
    outputs = np.full((rows, len(times), len(model.output_names), m), np.nan)

    def alone(b: int, table: InputTable) -> Solution:
        found = integrate_tangents(
            model, problem.method, p[b], x[b], table, times, problem.accuracy, along
        )
        if found.status == DONE:
            states[b] = found.s
            if of_outputs:
                outputs[b] = measured(model, times, found.x, found.s, p[b], along, table)[1]
        return found

    found = integrate_batch(problem, p, x, drive, threads, alone)
    return replace(found, tangents=states, output_tangents=outputs)


def _through_transients(stops: FloatArray, jumps: FloatArray, shortest: float) -> FloatArray:
    """`stops` [k] in s, and more of them behind the start and behind `jumps` of an input, from
    `shortest` on, where a transient is over within a tiny part of the way to the next stop.

    The error estimate lets a step pass over it, of which the states keep next to nothing; the
    derivative of the vector field by a parameter changes with it, and the tangents keep that.
    """
    begins = np.flatnonzero(np.isin(stops[:-1], jumps) | (np.arange(len(stops) - 1) == 0))
    more = [stops]
    for begin, length in zip(stops[begins], np.diff(stops)[begins], strict=True):
        if length > FAR * shortest:
            count = int(np.log(length / shortest) / np.log(LONGER))
            more.append(begin + shortest * LONGER ** np.arange(count))
    return np.unique(np.concatenate(more))


def measured(
    model: Model,
    t: FloatArray,
    x: FloatArray,
    s: FloatArray,
    p: FloatArray,
    along: Directions,
    table: InputTable,
) -> tuple[FloatArray, FloatArray]:
    """Signals y [k, ny] along x [k, n] and their derivatives [k, ny, m], where those of the states
    are s [k, n, m]; by way of delayed inputs too, which act at once on what depends on
    accelerations.
    """
    ny, u = len(model.output_names), values_at(table, t)
    y, signals = np.zeros((len(t), ny)), np.zeros((len(t), ny, s.shape[2]))
    by_state, by_parameter = np.zeros((ny, x.shape[1])), np.zeros((ny, len(p)))
    functions = output_addresses(model.module)
    _fill_measured(functions, t, x, s, u, p, along.columns, by_state, by_parameter, y, signals)
    delays = delay_columns(model, along.columns)
    if np.any(delays >= 0):
        _add_delays(model, t, x, p, u, slopes_at(table, t), delays, signals)
    return y, signals


@njit(
    types.void(
        INTEGERS,
        VECTOR,
        MATRIX,
        CUBE,
        MATRIX,
        VECTOR,
        INTEGERS,
        MATRIX,
        MATRIX,
        MATRIX,
        CUBE,
    ),
    cache=True,
    **KERNEL,
)
def _fill_measured(  # type: ignore[no-untyped-def]
    functions, t, x, s, u, p, columns, by_state, by_parameter, y, signals
):
    """Write y [k, ny] and signals [k, ny, m]; by_state [ny, n] and by_parameter [ny, np] are
    scratch.
    """
    for k in range(len(t)):
        call(functions[0], t[k], x[k], u[k], p, y[k])
        call(functions[1], t[k], x[k], u[k], p, by_state, by_parameter)
        for a in range(signals.shape[1]):
            for c in range(signals.shape[2]):
                slope = by_parameter[a, columns[c]] if c < len(columns) else 0.0
                for b in range(x.shape[1]):
                    slope += by_state[a, b] * s[k, b, c]
                signals[k, a, c] = slope


def _add_delays(
    model: Model,
    t: FloatArray,
    x: FloatArray,
    p: FloatArray,
    u: FloatArray,
    slopes: FloatArray,
    delays: IntArray,
    signals: FloatArray,
) -> None:
    """Add to `signals` [k, ny, m] what a delay changes by way of the inputs u [k, nu] alone, which
    have `slopes` [k, nu] per s; `delays` [nu] are columns of m, or -1.
    """
    ends = np.zeros((2, signals.shape[1]))
    for j, column in enumerate(delays):
        for k in np.flatnonzero(slopes[:, j]) if column >= 0 else ():
            for end, sign in zip(ends, (1.0, -1.0), strict=True):
                later = u[k] + sign * OF_DELAY * slopes[k, j] * np.eye(u.shape[1])[j]
                model.module.outputs(t[k], x[k], later, p, end)
            signals[k, :, column] -= (ends[0] - ends[1]) / (2.0 * OF_DELAY)


def _index(known: Sequence[str], name: str, what: str) -> int:
    if name not in known:
        raise unknown(what, name, known)
    return list(known).index(name)
