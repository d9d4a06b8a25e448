"""Simulate a model: inputs as profiles or logs, located events, energy ledger."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.runtime.model import Model
from ptp_symbolic.simulation import hybrid
from ptp_symbolic.simulation.delays import delay_columns, delayed, delays_of
from ptp_symbolic.simulation.inputs import InputSignal, constant, stack

FloatArray = NDArray[np.float64]

OUTPUT_STEP = 1e-3
EVENT_CAPACITY = 100_000
SLIDING = {-1.0: "slides backward", 0.0: "sticks", 1.0: "slides forward"}
TOUCHING = {
    -2.0: "lets go of the lower face", -1.0: "touches the lower face", 0.0: "is in the gap",
    1.0: "touches the upper face", 2.0: "lets go of the upper face",
}  # fmt: skip


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
    inputs: Mapping[str, InputSignal] | None = None,
    parameters: Mapping[str, float] | None = None,
    initial: Mapping[str, float] | None = None,
    rtol: float = 1e-8,
    atol: float = 1e-10,
    largest_step: float = 0.1,
) -> Trajectory:
    """Simulate `model` from 0 to a duration in s (output every ms) or at given `times` [k].

    Inputs that are not given are zero. Raises InputError for unknown names or times that do not
    increase, SimulationError when the state diverges or modes switch without end.
    """
    t = output_times(times)
    table = stack([_signal(model, inputs or {}, name) for name in model.input_names])
    _refuse_unknown("input", inputs or {}, model.input_names)
    x = start_of(model, initial or {})
    p = checked_parameters(model, parameters or {})
    table = delayed(table, delays_of(model, p))
    m = np.zeros(len(model.mode_names))
    u = np.zeros(len(model.input_names))
    hybrid.evaluate_inputs(t[0], 1, *table.arrays, table.new_cursor(), u)
    module = model.module
    module.initial_modes(t[0], x, u, p, m)
    inner = table.stops[(table.stops > t[0]) & (table.stops < t[-1])]
    stops = np.unique(np.concatenate([[t[0]], inner, [t[-1]]]))
    out_x, n = np.zeros((len(t), len(x))), len(x)
    none = np.zeros(0, dtype=np.int64)
    ledger, events = np.zeros((len(t), 3)), np.zeros((EVENT_CAPACITY, 3))
    status, reached, count, steps = hybrid.integrate(
        module.mode_derivative, module.jacobian, module.guards, module.guard_jacobian,
        module.energy, x, m, p, model.friction_rates, model.zero_at_rest, table.arrays, len(u),
        False, stops, t, out_x, none, delay_columns(model, none), np.zeros((n, 0)),
        np.zeros((len(t), n, 0)), ledger, rtol, np.full(n, atol), largest_step, events,
    )  # fmt: skip
    refuse_outside(model, p, t[t <= reached], out_x)
    refuse_failure(model, status, reached, x)
    return Trajectory(
        t, out_x, model.state_names, _named(model, events[: min(count, EVENT_CAPACITY)]),
        ledger[:, 0], ledger[:, 1], ledger[:, 2], steps,
    )  # fmt: skip


def output_times(times: float | ArrayLike) -> FloatArray:
    """Times [k] of the output, from a duration or as given. Raises InputError if they decrease."""
    t = np.array(times, dtype=np.float64)
    if t.ndim == 0:
        if not 0.0 < t < np.inf:
            raise InputError(f"Duration {float(t):g} s; give a positive number of seconds.")
        t = np.linspace(0.0, float(t), max(2, round(float(t) / OUTPUT_STEP) + 1))
    if t.ndim != 1 or len(t) < 2 or not np.all(np.isfinite(t)) or np.any(np.diff(t) <= 0):
        raise InputError("Output times must be two or more finite, increasing numbers of seconds.")
    return t


def checked_parameters(model: Model, parameters: Mapping[str, float]) -> FloatArray:
    """Parameter vector [np].

    Raises InputError for unknown names, values outside bounds, values that do not fit each other.
    """
    _refuse_unknown("parameter", parameters, model.parameter_names)
    for p in model.parameters:
        value = parameters.get(p.name, p.default)
        if not p.lower <= value <= p.upper:
            raise InputError(
                f"Parameter '{p.name}' = {value:g} {p.unit} lies outside its bounds"
                f" [{p.lower:g}, {p.upper:g}]; change the value."
            )
    vector = model.parameter_vector(dict(parameters))
    model.refuse_impossible(vector)
    return vector


def start_of(model: Model, initial: Mapping[str, float]) -> FloatArray:
    """State [n] at the start. Raises InputError for unknown names or values that are not finite."""
    _refuse_unknown("state", initial, model.state_names)
    x = np.array(model.module.STATE_INITIAL, dtype=np.float64)
    for name, value in initial.items():
        if not np.isfinite(value):
            raise InputError(f"State '{name}' starts at {value}; give a finite number.")
        x[model.state_names.index(name)] = value
    return x


def refuse_outside(model: Model, p: FloatArray, t: FloatArray, x: FloatArray) -> None:
    """Raise SimulationError at the first of times t [k] at which x [k, n] is outside the domain."""
    found = []
    for (name, meaning), (lower, upper) in zip(model.limits, model.domain(p), strict=True):
        values = x[: len(t), model.state_names.index(name)]
        outside = np.flatnonzero((values < lower) | (values > upper))
        if len(outside):
            at, unit = outside[0], model.units[name]
            text = (
                f"Stopped at {t[at]:.6g} s with {name} = {values[at]:.6g} {unit}: past the"
                f" {meaning}, which allows {lower:.6g} to {upper:.6g} {unit}; shorten the input,"
                " start elsewhere or change the lengths."
            )
            found.append((at, text))
    if found:
        raise SimulationError(min(found, key=lambda each: each[0])[1])


def refuse_failure(model: Model, status: int, reached: float, x: FloatArray) -> None:
    """Raise SimulationError unless `status` says that the simulation reached its end."""
    if status == hybrid.DONE:
        return
    state = ", ".join(f"{n} {v:.3g}" for n, v in zip(model.state_names, x, strict=True))
    why = {
        hybrid.DIVERGED: "the state diverges; check inputs and parameters",
        hybrid.CHATTERING: "modes switch without end; loosen the tolerance or add damping",
    }.get(status, "the integrator gave up; loosen the tolerance")
    raise SimulationError(f"Stopped at {reached:.6g} s with {state}: {why}.")


def _signal(model: Model, inputs: Mapping[str, InputSignal], name: str) -> InputSignal:
    return inputs[name] if name in inputs else constant(0.0)


def _refuse_unknown(what: str, given: Mapping[str, object], known: Sequence[str]) -> None:
    for name in given:
        if name not in known:
            raise InputError(f"Unknown {what} '{name}'. Choose from: {', '.join(known)}.")


def _named(model: Model, rows: FloatArray) -> tuple[Event, ...]:
    frictions = [n.removeprefix("slide_") for n in model.mode_names if n.startswith("slide_")]
    contacts = [n.removeprefix("side_") for n in model.mode_names if n.startswith("side_")]
    events = []
    for time, element, mode in rows:
        index = int(element)
        if index < len(frictions):
            events.append(Event(float(time), f"friction {frictions[index]}", SLIDING[mode]))
        else:
            contact = contacts[index - len(frictions)]
            events.append(Event(float(time), f"contact {contact}", TOUCHING[mode]))
    return tuple(events)
