"""Simulate a model: inputs as profiles or logs, located events, energy ledger.

Changes of mode in words.

Output times of a simulation.

Integrate a model in steps of fixed length: preallocate, run, and return the solution.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation import fixed_runner
from ptp_symbolic.numeric.simulation.feedback import Commands, Feedback, integrate_with_feedback
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.inputs import (
    InputSignal,
    InputTable,
    as_signals,
    constant,
    delayed,
    delays_of,
    stack,
)
from ptp_symbolic.numeric.simulation.integration import (
    METHODS,
    MOST_STEPS,
    Solution,
    checked_accuracy,
    contact_table,
    default_method,
    integrate,
    limited_states,
    new_record,
    new_tangents,
    new_watch,
    refuse_start,
)
from ptp_symbolic.numeric.simulation.kernels.calls import addresses
from ptp_symbolic.numeric.simulation.kernels.records import (
    CHATTERING,
    DIVERGED,
    DONE,
    EVENTS,
    EXHAUSTED,
    INSTANT,
    OUTSIDE,
    STEPS,
    STIFF,
    TIME,
    TOO_FAST,
    UNDECIDED,
)
from ptp_symbolic.numeric.simulation.methods.implicit_step import StepWork
from ptp_symbolic.numeric.simulation.sampling import new_sampling

FloatArray = NDArray[np.float64]


MOST_FIXED_STEPS = 1e9


@dataclass(frozen=True, eq=False)
class FixedSolution:
    """Solution in steps of fixed length: status, time reached in s and state [n] there.

    At the output times x [k, n] and ledger [k, 3] (stored, supplied, dissipated in J); the first
    events [e, 3] (time in s, element, mode entered) and their number in all, steps taken, and the
    most mode sets that a single step tried.
    """

    status: int
    reached: float
    state: FloatArray
    x: FloatArray
    ledger: FloatArray
    events: FloatArray
    event_count: int
    steps: int
    most_sweeps: int


def integrate_in_fixed_steps(
    model: Model,
    p: FloatArray,
    x: FloatArray,
    inputs: InputTable,
    times: FloatArray,
    step: float,
    event_room: int = 0,
) -> FixedSolution:
    """Simulate `model` at p [np] from x [n] in steps of at most `step` s; outputs at `times` [k]
    in s.

    Every output time and every jump of an input is the end of a step. Raises InputError for a step
    that is no positive time or makes too many steps, and as `refuse_start` and `new_sampling` do.
    """
    duration = times[-1] - times[0]
    if not 0.0 < step < np.inf or duration / step > MOST_FIXED_STEPS:
        raise InputError(
            f"Step {step:g} s for {duration:g} s; give a positive number of seconds that makes at"
            f" most {MOST_FIXED_STEPS:g} steps."
        )
    grid = inputs.with_stops(times)
    n, nu, z = len(x), len(model.input_names), np.zeros
    x, u, none = x.copy(), z((2, nu)), z(0, np.int64)
    watch, tangents = new_watch(model, n, p), new_tangents(z((n, 0)), none, z(nu, np.int64), 0, nu)
    if model.contacts[:, 2].any():
        evaluate_inputs(times[0], 1, *inputs.arrays, inputs.new_cursor(), u[0])
        model.module.initial_modes(times[0], x, u[0], p, watch.m)
        refuse_start(model, x, u[0], p, watch)
    work = StepWork(
        z((n, n)),
        z((n, nu)),
        z((0, len(p))),
        z((n, n)),
        z(n, np.int64),
        z(n),
        z(n),
        z(n),
        z((len(model.friction_rates), 2), np.int64),
    )
    record = new_record(grid, n, 0, len(grid), event_room)
    status = fixed_runner.runner()(
        addresses(model.module, tangents=False),
        p,
        model.prepared(p),
        model.friction_rates,
        model.zero_at_rest,
        contact_table(model),
        inputs.arrays,
        inputs.new_cursor(),
        inputs.held,
        u,
        x,
        float(step),
        tuple(watch),
        tuple(tangents),
        tuple(work),
        tuple(record),
        tuple(new_sampling(model, p, x, times, 0)),
    )
    kept, counts = np.searchsorted(grid, times), record.counts
    return FixedSolution(
        status,
        float(record.clock[TIME]),
        x,
        record.x[kept],
        record.ledger[kept],
        record.events[: counts[EVENTS]],
        int(counts[EVENTS]),
        int(counts[STEPS]),
        int(counts[INSTANT]),
    )


OUTPUT_STEP = 1e-3
MOST_SAMPLES = 5_000_000


def output_times(times: float | ArrayLike, every: float = OUTPUT_STEP) -> FloatArray:
    """Output times [k] in s: from 0 to a duration in s and `every` so many s between, or as given;
    a tuple of two is the span (start, end), with `every` so many s between.

    Raises InputError for what is no number, for a duration or an interval that is not positive, for
    less than two times or times that are not finite and increasing, and for five million or more
    within a duration.
    """
    try:
        t = np.array(times, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(f"Times {times!r:.60}; give seconds, as numbers.") from error
    if t.ndim == 0:
        if not 0.0 < t < np.inf:
            raise InputError(f"Duration {float(t):g} s; give a positive number of seconds.")
        t = _regular_times(float(t), every)
    elif isinstance(times, tuple) and t.shape == (2,) and 0.0 < t[1] - t[0] < np.inf:
        t = float(t[0]) + _regular_times(float(t[1] - t[0]), every)
    if t.ndim != 1 or len(t) < 2 or not _increases(t):
        raise InputError("Output times must be two or more finite, increasing numbers of seconds.")
    return t


def _increases(t: FloatArray) -> bool:
    """Whether the numbers t [k] are finite and increase."""
    return bool((t[1:] > t[:-1]).all()) and math.isfinite(t[0]) and math.isfinite(t[-1])


def _regular_times(duration: float, every: float) -> FloatArray:
    if not 0.0 < every < np.inf:
        raise InputError(f"Output every {every:g} s; give a positive number of seconds.")
    count = duration / every
    if count >= MOST_SAMPLES:
        raise InputError(
            f"{duration:g} s with an output every {every:g} s make {count:.3g} samples, at most"
            f" {MOST_SAMPLES} are allowed; shorten the duration, or give output times further"
            f" apart (`every` {1.01 * duration / MOST_SAMPLES:.3g})."
        )
    if abs(count - round(count)) < 1e-3 or count < 1.0:
        return np.linspace(0.0, duration, max(2, round(count) + 1))
    return np.append(every * np.arange(int(count) + 1), duration)


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


@dataclass(frozen=True)
class Event:
    """A change of mode: time in s, the element (``friction pan``, ``contact pan``), what it did."""

    time: float
    element: str
    mode: str


def named_events(model: Model, rows: FloatArray) -> tuple[Event, ...]:
    """The events of `rows` [e, 3]: time in s, element, mode entered."""
    if not len(rows):
        return ()
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


FIXED_STEP = "fixed_step"
EVENT_ROOM = 100_000  # events for which there is room at first; a run with more is repeated
AT_BOUND = 1e-6  # rad; where the equations end, steps can become too short to go on
LARGEST_IMBALANCE = 0.1  # of the energies: a motion that makes more out of nothing is made up


class SimulationError(InputError):
    """A simulation that did not reach its end, or whose energies do not balance; the message tells
    time, state and what to do.
    """


@dataclass(frozen=True, eq=False)
class Trajectory:
    """States x [k, n] at times t [k] in s, the events between them, and the energy ledger in J.

    stored - stored[0] = supplied - dissipated along every trajectory, each [k], or [0] where no
    ledger was asked for. `state_names` are those that were saved; `commands` what a controller in
    the loop returned, None without one.
    """

    t: FloatArray
    x: FloatArray
    state_names: tuple[str, ...]
    events: tuple[Event, ...]
    stored: FloatArray
    supplied: FloatArray
    dissipated: FloatArray
    steps: int
    commands: Commands | None = None

    def __getitem__(self, name: str) -> FloatArray:
        """State `name` [k]. Raises KeyError for another name."""
        if name not in self.state_names:
            raise KeyError(str(unknown("state", name, self.state_names)))
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
    ledger: bool = True,
    save: Sequence[str] | None = None,
    most_steps: int = MOST_STEPS,
    feedback: Feedback | None = None,
) -> Trajectory:
    """Simulate `model` from 0 to a duration in s or over a span (start, end) in s, with an output
    every ms, or at given `times` [k] in s; under `feedback`, if any.

    Inputs are signals or profiles as text ("step:1@0.5"), zero where not given; `parameters` and
    `initial` states are in SI. rtol and atol bound the local error, atol in rad for angles (see
    `tolerance_weights`). `method` is "rosenbrock" for stiff machines, "runge_kutta" for smooth ones
    and where a controller samples faster than a winding settles, "fixed_step" for steps of `step`
    s, None to let the model choose. Fixed steps are of order one across events: their error goes
    with `step`. Where a controller samples, the state at that instant is the one after it.

    `save` names the states to keep (None: all). Without `ledger` no energy is summed up, and a
    machine with a sampled controller is integrated from sample to sample by an exponential method,
    in less time.

    Rigid bodies that turn out stiff, as in strong damping, are integrated by "rosenbrock"; where
    "runge_kutta" was asked for, that is refused.

    Raises InputError for unknown names, parameters out of bounds, times that do not increase, a
    tolerance or largest step that is not above zero and a step that does not fit; SimulationError
    when the state diverges, modes chatter, an explicit method is held up by stability, `most_steps`
    do not reach the end, or fixed steps make a motion whose energies do not add up.
    """
    t = output_times(times)
    x, p = start_of(model, initial or {}), checked_parameters(model, parameters or {})
    table = input_table(model, inputs or {}, p, float(t[-1]))
    kept = _columns_of(model, save)
    chosen = chosen_method(model, method, (*METHODS, FIXED_STEP) if feedback is None else METHODS)
    accuracy = checked_accuracy(model, rtol, atol, largest_step, most_steps)

    commands = None

    def run(event_room: int) -> Solution | FixedSolution:
        nonlocal commands
        if feedback is not None:
            found, commands = integrate_with_feedback(
                model, chosen, p, x, table, feedback, t, accuracy, ledger
            )
            return found
        if chosen == FIXED_STEP:
            return integrate_in_fixed_steps(model, p, x, table, t, step, event_room)
        return integrate(
            model,
            None if method is None else chosen,
            p,
            x,
            table,
            table.held,
            table.with_stops(t[[0, -1]]),
            t,
            accuracy,
            ledger=ledger,
            event_room=event_room,
        )

    room = EVENT_ROOM if model.mode_names else 0
    found = run(room)
    if found.event_count > room and feedback is None:
        found = run(found.event_count)
    refuse_failure(model, p, found.status, found.reached, found.state)
    if chosen == FIXED_STEP:
        _refuse_unbalanced(found, step)
    energies = found.ledger if ledger else np.zeros((0, 3))
    return Trajectory(
        t,
        found.x[:, kept],
        tuple(model.state_names[k] for k in kept),
        named_events(model, found.events),
        energies[:, 0],
        energies[:, 1],
        energies[:, 2],
        found.steps,
        commands,
    )


def _columns_of(model: Model, save: Sequence[str] | None) -> list[int]:
    """Columns of the states to `save`. Raises InputError for unknown names."""
    if save is None:
        return list(range(len(model.state_names)))
    _refuse_unknown("state", dict.fromkeys(save, None), model.state_names)
    return [model.state_names.index(name) for name in save]


def _refuse_unbalanced(found: Solution | FixedSolution, step: float) -> None:
    """Raise SimulationError where a run in fixed steps makes energy out of nothing.

    Implicit steps that are long beside a decay lose some, which only damps it more.
    """
    stored, supplied, dissipated = found.ledger.T
    made = np.max(stored - stored[0] - supplied + dissipated)
    turned_over = np.max(np.abs(stored)) + np.max(np.abs(supplied)) + dissipated[-1]
    if made > LARGEST_IMBALANCE * turned_over:
        raise SimulationError(
            f"Steps of {step:g} s make {made:.3g} J out of nothing,"
            f" {100 * made / turned_over:.0f} % of what is stored and supplied; take shorter steps,"
            " or the method rosenbrock."
        )


def input_table(
    model: Model, inputs: Mapping[str, InputSignal | str], p: FloatArray, end: float
) -> InputTable:
    """`inputs` from 0 to `end` s as the model sees them, delayed where parameters p [np] say so.

    Inputs that are not given stay zero. Raises InputError for unknown names and profiles.
    """
    given = as_signals(model.input_names, inputs, end)
    signals = [given.get(name, constant(0.0)) for name in model.input_names]
    return delayed(stack(signals), delays_of(model, p))


def chosen_method(
    model: Model, method: str | None, known: Iterable[str] = (*METHODS, FIXED_STEP)
) -> str:
    """`method`, or the one that suits `model` (None). Raises InputError for one not `known`."""
    if method is None:
        return default_method(model)
    if method not in known:
        raise InputError(f"Unknown method '{method}'. Choose from: {', '.join(known)}.")
    return method


def checked_parameters(model: Model, parameters: Mapping[str, float]) -> FloatArray:
    """Parameter vector [np] in SI.

    Raises InputError for unknown names, values outside bounds, values that do not fit each other.
    """
    vector = model.parameter_vector(parameters)
    model.refuse_impossible(vector, parameters)
    return vector


def start_of(model: Model, initial: Mapping[str, float]) -> FloatArray:
    """Initial state [n] in SI. Raises InputError for unknown names and values not finite."""
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
    if status == OUTSIDE or (status in (DIVERGED, TOO_FAST) and past > -AT_BOUND):
        name, meaning = model.limits[limit]
        (lower, upper), unit = model.domain(p)[limit], model.units[name]
        raise SimulationError(
            f"Stopped at {reached:.6g} s with {name} = {x[model.state_names.index(name)]:.6g}"
            f" {unit}: past the {meaning}, which allows {lower:.6g} to {upper:.6g} {unit}; shorten"
            f" the input, start elsewhere or change the lengths. The state there: {state}."
        )
    why = {
        DIVERGED: "the state diverges; check inputs and parameters",
        EXHAUSTED: "all steps are used up; make the inputs slower, the inertias or inductances"
        " larger, the tolerances looser, or allow more by most_steps",
        TOO_FAST: "it changes too fast for steps of 1e-11 s; check for an inertia, an inductance or"
        " a time constant next to nothing, and for inputs that are too large",
        STIFF: "the machine is stiff, and explicit steps are as short as its shortest time"
        " constant; take the method rosenbrock, or leave the choice to the model",
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
