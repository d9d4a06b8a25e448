"""Simulate a model: inputs as profiles or logs, located events, energy ledger."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.fixed_integration import (
    FixedSolution,
    integrate_in_fixed_steps,
)
from ptp_symbolic.numeric.simulation.integration import (
    METHODS,
    Accuracy,
    Solution,
    default_method,
    integrate,
    limited_states,
    tolerance_weights,
)
from ptp_symbolic.numeric.simulation.kernels.records import (
    CHATTERING,
    DIVERGED,
    DONE,
    OUTSIDE,
    UNDECIDED,
)
from ptp_symbolic.numeric.simulation.signals.delays import delayed, delays_of
from ptp_symbolic.numeric.simulation.signals.inputs import InputSignal, InputTable, constant, stack
from ptp_symbolic.numeric.simulation.signals.profile_text import as_signals

FloatArray = NDArray[np.float64]

OUTPUT_STEP = 1e-3
MOST_SAMPLES = 5_000_000
FIXED_STEP = "fixed_step"
EVENT_ROOM = 100_000  # events for which there is room at first; a run with more is repeated
AT_BOUND = 1e-6  # rad; where the equations end, steps can become too short to go on
SLIDING = {-1.0: "slides backward", 0.0: "sticks", 1.0: "slides forward"}
SWITCHING = {
    -2.0: "goes off beyond the lower threshold",
    -1.0: "goes on at the lower threshold",
    0.0: "is ready",
    1.0: "goes on at the upper threshold",
    2.0: "goes off beyond the upper threshold",
}
TOUCHING = {
    -4.0: "leans on the lower face",
    -3.0: "bounces off the lower face",
    -2.0: "lets go of the lower face",
    -1.0: "touches the lower face",
    0.0: "is in the gap",
    1.0: "touches the upper face",
    2.0: "lets go of the upper face",
    3.0: "bounces off the upper face",
    4.0: "leans on the upper face",
}


class SimulationError(InputError):
    """The simulation left its domain; the message tells time, state and what to do."""


@dataclass(frozen=True)
class Event:
    """A change of mode: time in s, the element (``friction pan``, ``contact pan``), what it did."""

    time: float
    element: str
    mode: str


@dataclass(frozen=True, eq=False)
class Trajectory:
    """States x [k, n] at times t [k] in s, the events between them, and the energy ledger in J.

    stored - stored[0] = supplied - dissipated along every trajectory, each [k].
    """

    t: FloatArray
    x: FloatArray
    state_names: tuple[str, ...]
    events: tuple[Event, ...]
    stored: FloatArray
    supplied: FloatArray
    dissipated: FloatArray
    steps: int

    def __getitem__(self, name: str) -> FloatArray:
        """State `name` [k]."""
        return self.x[:, self.state_names.index(name)]


def simulate(
    model: Model,
    times: float | ArrayLike,
    inputs: Mapping[str, InputSignal | str] | None = None,
    parameters: Mapping[str, float] | None = None,
    initial: Mapping[str, float] | None = None,
    rtol: float = 1e-8,
    atol: float = 1e-9,
    largest_step: float = 0.1,
    method: str | None = None,
    step: float = 1e-4,
) -> Trajectory:
    """Simulate `model` from 0 to a duration in s (output every ms) or at given `times` [k].

    Inputs are signals or profiles as text ("step:1@0.5"), zero where not given. rtol and atol bound
    the error of a step, atol in rad for angles (see `tolerance_weights`); `method` is "rosenbrock"
    for stiff machines, "runge_kutta" for smooth ones and where a controller samples faster than a
    winding settles, "fixed_step" for steps of `step` s, None to let the model choose. Where a
    controller samples, the state at that instant is the one after it.

    Raises InputError for unknown names, times that do not increase, a tolerance or largest step
    that is not above zero and a step that does not fit, SimulationError when the state diverges or
    modes switch without end.
    """
    t = output_times(times)
    x, p = start_of(model, initial or {}), checked_parameters(model, parameters or {})
    table = input_table(model, inputs or {}, p, float(t[-1]))
    chosen = chosen_method(model, method)
    for name, value in (("rtol", rtol), ("atol", atol), ("largest_step", largest_step)):
        if not value > 0.0:
            raise InputError(f"{name} = {value:g}; give a number above zero.")

    def run(event_room: int) -> Solution | FixedSolution:
        if chosen == FIXED_STEP:
            return integrate_in_fixed_steps(model, p, x, table, t, step, event_room)
        accuracy = Accuracy(rtol, atol * tolerance_weights(model), largest_step)
        return integrate(
            model,
            chosen,
            p,
            x,
            table,
            table.held,
            table.with_stops(t[[0, -1]]),
            t,
            accuracy,
            ledger=True,
            event_room=event_room,
        )

    found = run(EVENT_ROOM)
    if found.event_count > EVENT_ROOM:
        found = run(found.event_count)
    refuse_failure(model, p, found.status, found.reached, found.state)
    return Trajectory(
        t,
        found.x,
        model.state_names,
        _named(model, found.events),
        found.ledger[:, 0],
        found.ledger[:, 1],
        found.ledger[:, 2],
        found.steps,
    )


def input_table(
    model: Model, inputs: Mapping[str, InputSignal | str], p: FloatArray, end: float
) -> InputTable:
    """`inputs` from 0 to `end` s as the model sees them, late where parameters p [np] say so.

    Inputs that are not given stay zero. Raises InputError for unknown names and profiles.
    """
    given = as_signals(model.input_names, inputs, end)
    signals = [given.get(name, constant(0.0)) for name in model.input_names]
    return delayed(stack(signals), delays_of(model, p))


def chosen_method(
    model: Model, method: str | None, known: Sequence[str] = (*METHODS, FIXED_STEP)
) -> str:
    """`method`, or the one that suits `model` (None). Raises InputError for one not `known`."""
    if method is None:
        return default_method(model)
    if method not in known:
        raise InputError(f"Unknown method '{method}'. Choose from: {', '.join(known)}.")
    return method


def output_times(times: float | ArrayLike, every: float = OUTPUT_STEP) -> FloatArray:
    """Times [k] of the output: from 0 to a duration `every` so many s, its end too, or as given.

    Raises InputError if they decrease and for more than five million of them.
    """
    t = np.array(times, dtype=np.float64)
    if t.ndim == 0:
        if not 0.0 < t < np.inf:
            raise InputError(f"Duration {float(t):g} s; give a positive number of seconds.")
        t = _regular_times(float(t), every)
    if t.ndim != 1 or len(t) < 2 or not np.all(np.isfinite(t)) or np.any(np.diff(t) <= 0):
        raise InputError("Output times must be two or more finite, increasing numbers of seconds.")
    return t


def _regular_times(duration: float, every: float) -> FloatArray:
    if not 0.0 < every < np.inf:
        raise InputError(f"Output every {every:g} s; give a positive number of seconds.")
    count = duration / every
    if count >= MOST_SAMPLES:
        raise InputError(
            f"{duration:g} s with an output every {every:g} s make {count:.3g} samples, at most"
            f" {MOST_SAMPLES} are allowed; shorten the duration, or give output times further"
            f" apart (--every {1.01 * duration / MOST_SAMPLES:.3g})."
        )
    if abs(count - round(count)) < 1e-3 or count < 1.0:
        return np.linspace(0.0, duration, max(2, round(count) + 1))
    return np.append(every * np.arange(int(count) + 1), duration)


def checked_parameters(model: Model, parameters: Mapping[str, float]) -> FloatArray:
    """Parameter vector [np].

    Raises InputError for unknown names, values outside bounds, values that do not fit each other.
    """
    vector = model.parameter_vector(parameters)
    model.refuse_impossible(vector, parameters)
    return vector


def start_of(model: Model, initial: Mapping[str, float]) -> FloatArray:
    """State [n] at the start. Raises InputError for unknown names or values that are not finite."""
    _refuse_unknown("state", initial, model.state_names)
    x = np.array(model.module.STATE_INITIAL, dtype=np.float64)
    for name, value in initial.items():
        if not np.isfinite(value):
            unit = model.units[name]
            raise InputError(f"State '{name}' starts at {value} {unit}; give a finite number.")
        x[model.state_names.index(name)] = value
    return x


def refuse_failure(model: Model, p: FloatArray, status: int, reached: float, x: FloatArray) -> None:
    """Raise SimulationError unless `status` says that the simulation reached its end.

    `reached` in s and x [n] are time and state where it stopped, at parameters p [np].
    """
    if status == DONE:
        return
    state = ", ".join(f"{n} {v:.3g}" for n, v in zip(model.state_names, x, strict=True))
    limit, past = _nearest_limit(model, p, x)
    if status == OUTSIDE or (status == DIVERGED and past > -AT_BOUND):
        name, meaning = model.limits[limit]
        (lower, upper), unit = model.domain(p)[limit], model.units[name]
        raise SimulationError(
            f"Stopped at {reached:.6g} s with {name} = {x[model.state_names.index(name)]:.6g}"
            f" {unit}: past the {meaning}, which allows {lower:.6g} to {upper:.6g} {unit}; shorten"
            f" the input, start elsewhere or change the lengths. The state there: {state}."
        )
    why = {
        DIVERGED: "the state diverges; check inputs and parameters",
        CHATTERING: "modes switch without end; loosen the tolerance or add damping",
        UNDECIDED: "no set of modes fits the end of the step; take a smaller step",
    }[status]
    raise SimulationError(f"Stopped at {reached:.6g} s with {state}: {why}.")


def _nearest_limit(model: Model, p: FloatArray, x: FloatArray) -> tuple[int, float]:
    """The limit that x [n] is furthest past, or nearest to, and how far (< 0: inside)."""
    bounds, values = model.domain(p), x[limited_states(model)]
    if not len(values):
        return -1, -np.inf
    past = np.maximum(bounds[:, 0] - values, values - bounds[:, 1])
    limit = int(np.argmax(past))
    return limit, float(past[limit])


def _refuse_unknown(what: str, given: Mapping[str, object], known: Sequence[str]) -> None:
    for name in given:
        if name not in known:
            raise unknown(what, name, known)


def _named(model: Model, rows: FloatArray) -> tuple[Event, ...]:
    frictions = [n.removeprefix("slide_") for n in model.mode_names if n.startswith("slide_")]
    contacts = [n.removeprefix("side_") for n in model.mode_names if n.startswith("side_")]
    events = []
    for time, element, mode in rows:
        index = int(element)
        if index < len(frictions):
            events.append(Event(float(time), f"friction {frictions[index]}", SLIDING[mode]))
        else:
            number = index - len(frictions)
            is_switch = number >= len(model.module.CONTACT_ANGLES)
            what, modes = ("switch", SWITCHING) if is_switch else ("contact", TOUCHING)
            events.append(Event(float(time), f"{what} {contacts[number]}", modes[mode]))
    return tuple(events)
