"""Forward sensitivities of states and measured signals, through located events.

The tangents follow the variational equation with the method of the run itself; at an event the
saltation matrix, the jump of the vector field times the shift of the event time, updates them
(Aizerman and Gantmacher, 1958).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.integration import (
    IMPLICIT,
    METHODS,
    Solution,
    checked_accuracy,
    integrate,
    stable_step,
)
from ptp_symbolic.numeric.simulation.kernels.records import STIFF
from ptp_symbolic.numeric.simulation.run import (
    checked_parameters,
    chosen_method,
    input_table,
    output_times,
    refuse_failure,
    start_of,
)
from ptp_symbolic.numeric.simulation.signals.inputs import (
    InputSignal,
    InputTable,
    delay_columns,
    slopes_at,
    values_at,
)

FloatArray = NDArray[np.float64]

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
    columns = np.array([_index(model.parameter_names, n, "parameter") for n in wanted], np.int64)
    x = start_of(model, initial or {})
    s = np.zeros((len(x), len(columns) + len(by_initial)))
    for offset, name in enumerate(by_initial):
        s[_index(model.state_names, name, "state"), len(columns) + offset] = 1.0
    chosen = chosen_method(model, method, tuple(METHODS))
    accuracy = checked_accuracy(model, rtol, atol, largest_step)

    def run(chosen: str) -> Solution:
        # The error estimate does not see a fast mode that has decayed in the states, and it still
        # grows in the tangents, by ten powers of ten where explicit steps are too long.
        stable = stable_step(model, p, x)
        stops = table.with_stops(t)
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
            t,
            replace(accuracy, largest_step=min(largest_step, stable)),
            s,
            columns,
            delay_columns(model, columns),
        )

    found = run(chosen)
    if found.status == STIFF and method is None:
        found = run(IMPLICIT)
    refuse_failure(model, p, found.status, found.reached, found.state)
    y, signals = _measured(model, t, found.x, found.s, p, columns, table)
    return Sensitivities(t, found.x, y, (*wanted, *by_initial), found.s, signals)


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


def _measured(
    model: Model,
    t: FloatArray,
    x: FloatArray,
    s: FloatArray,
    p: FloatArray,
    columns: NDArray[np.int64],
    table: InputTable,
) -> tuple[FloatArray, FloatArray]:
    """Signals y [k, ny] and their derivatives [k, ny, m], by way of delayed inputs too, which act
    at once on what depends on accelerations.
    """
    ny, u, slopes = len(model.output_names), values_at(table, t), slopes_at(table, t)
    y, signals = np.zeros((len(t), ny)), np.zeros((len(t), ny, s.shape[2]))
    yx, yp = np.zeros((ny, x.shape[1])), np.zeros((ny, len(p)))
    ends = np.zeros((2, ny))
    for k, time in enumerate(t):
        model.module.outputs(time, x[k], u[k], p, y[k])
        model.module.output_jacobian(time, x[k], u[k], p, yx, yp)
        signals[k] = yx @ s[k]
        signals[k, :, : len(columns)] += yp[:, columns]
        for j, column in enumerate(delay_columns(model, columns)):
            if column >= 0 and slopes[k, j] != 0.0:
                for end, sign in zip(ends, (1.0, -1.0), strict=True):
                    later = u[k] + sign * OF_DELAY * slopes[k, j] * np.eye(u.shape[1])[j]
                    model.module.outputs(time, x[k], later, p, end)
                signals[k, :, column] -= (ends[0] - ends[1]) / (2.0 * OF_DELAY)
    return y, signals


def _index(known: Sequence[str], name: str, what: str) -> int:
    if name not in known:
        raise unknown(what, name, known)
    return list(known).index(name)
