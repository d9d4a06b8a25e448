"""A controller of the user in the loop: sampled, with a zero-order hold between samples."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.runtime.element_layout import contact_count, contact_modes
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import (
    InputTable,
    delays_of,
    values_at,
)
from ptp_symbolic.numeric.simulation.integration import Accuracy, Solution, integrate
from ptp_symbolic.numeric.simulation.kernels.records import DONE

FloatArray = NDArray[np.float64]

MOST_SAMPLES = 10_000_000
EVENT_ROOM = 200  # events of one period for which there is room at first
COINCIDENT = 1e-12  # s


@dataclass(frozen=True, eq=False)
class Feedback:
    """`controller(t, y) -> u` is called every `period` s, with t in s and the signals y [m] named
    in `measured`: outputs, or states that no output is called after; None for all states. It
    returns the inputs: an array [nu], a number where there is
    one input, or a mapping by name; they add to what the inputs are given as.
    """

    controller: Callable[[float, FloatArray], object]
    period: float
    measured: tuple[str, ...] | None


@dataclass(frozen=True, eq=False)
class Commands:
    """What a controller returned: `u` [m, nu] from the times `t` [m] in s on."""

    t: FloatArray
    u: FloatArray


def integrate_with_feedback(
    model: Model,
    method: str,
    p: FloatArray,
    x: FloatArray,
    inputs: InputTable,
    feedback: Feedback,
    times: FloatArray,
    accuracy: Accuracy,
    ledger: bool,
) -> tuple[Solution, Commands]:
    """Integrate `model` at p [np] from x [n] over `times` [k] in s, under `feedback`.

    Every sample begins a new integration from the state alone: modes of friction and contact follow
    from it. Raises InputError for a period that does not fit, a machine that samples by itself, and
    what the controller returns.
    """
    _refuse_odd(model, feedback, times)
    loop = _Loop(model, p, inputs, feedback)
    found, clock = _Found(model, times, ledger), float(times[0])
    count = int(np.ceil((times[-1] - times[0]) / feedback.period - 1e-9))
    commands = np.zeros((count, len(model.input_names)))
    for k in range(count):
        begin = clock + k * feedback.period
        commands[k] = loop.command(begin, x)
        bounds = [*loop.changes, feedback.period]
        for since, until in pairwise(bounds):
            a, b = begin + since, min(begin + until, float(times[-1]))
            if b - a <= COINCIDENT:
                continue
            held = loop.inputs(k, since, commands)
            solution = found.add(a, b, x, p, held, method, accuracy)
            if solution.status != DONE:
                return found.whole(solution), _commands(clock, k + 1, feedback, commands)
            x = solution.state
    return found.whole(solution), _commands(clock, count, feedback, commands)


def _commands(clock: float, count: int, feedback: Feedback, u: FloatArray) -> Commands:
    return Commands(clock + feedback.period * np.arange(count, dtype=np.float64), u[:count])


def _refuse_odd(model: Model, feedback: Feedback, times: FloatArray) -> None:
    duration = float(times[-1] - times[0])
    if model.sampler_periods:
        raise InputError(
            f"Model '{model.name}' has a sampled controller of its own; leave that effect out of"
            " the platform, or give no `controller`."
        )
    if not 0.0 < feedback.period <= duration or duration / feedback.period > MOST_SAMPLES:
        raise InputError(
            f"`period` = {feedback.period:g} s in a run of {duration:g} s; give a positive time, at"
            f" most that of the run and at most {MOST_SAMPLES:g} samples."
        )
    known = tuple(dict.fromkeys((*model.output_names, *model.state_names)))
    for name in feedback.measured or ():
        if name not in known:
            raise unknown("measured signal", name, known)


class _Loop:
    """The controller, what it sees, and the inputs that follow from what it returned."""

    def __init__(self, model: Model, p: FloatArray, inputs: InputTable, feedback: Feedback) -> None:
        self.model, self.p, self.feedback = model, p, feedback
        self.given = inputs
        self.table = InputTable(
            inputs.breaks,
            inputs.coefficients.copy(),
            *inputs.arrays[2:],
            inputs.stops,
        )
        delays = delays_of(model, p)
        self.late = np.floor(delays / feedback.period + 1e-9).astype(np.int64)
        rest = np.maximum(delays - self.late * feedback.period, 0.0)
        self.rest = np.where(rest < COINCIDENT, 0.0, rest)
        self.changes = np.unique([0.0, *self.rest]).tolist()
        self.y = np.zeros(len(model.output_names))
        self.states = {name: k for k, name in enumerate(model.state_names)}
        self.outputs = {name: k for k, name in enumerate(model.output_names)}
        self.last = np.zeros(len(model.input_names))

    def command(self, t: float, x: FloatArray) -> FloatArray:
        """What the controller returns at t in s and x [n], as a vector [nu]."""
        returned = self.feedback.controller(t, self._seen(t, x))
        self.last = _as_vector(returned, t, self.model)
        return self.last

    def _seen(self, t: float, x: FloatArray) -> FloatArray:
        names = self.feedback.measured
        if names is None:
            return x.copy()
        acting = self.last + values_at(self.given, np.array([t]))[0]
        self.model.module.outputs(t, x, acting, self.p, self.y)
        return np.array(
            [self.y[self.outputs[n]] if n in self.outputs else x[self.states[n]] for n in names]
        )

    def inputs(self, k: int, since: float, commands: FloatArray) -> InputTable:
        """The inputs from `since` s after sample k on, each by the command that is due."""
        due = k - self.late - (since < self.rest - COINCIDENT)
        offsets = self.given.offsets
        for j, row in enumerate(due):
            value = commands[row, j] if row >= 0 else 0.0
            own = slice(offsets[j], offsets[j + 1])
            self.table.coefficients[own, 0] = self.given.coefficients[own, 0] + value
        return self.table


def _as_vector(returned: object, t: float, model: Model) -> FloatArray:
    names = model.input_names
    if isinstance(returned, Mapping):
        for name in returned:
            if name not in names:
                raise unknown("input", str(name), names)
        returned = [returned.get(name, 0.0) for name in names]
    try:
        u = np.asarray(returned, dtype=np.float64)
    except (TypeError, ValueError):
        u = np.full(1, np.nan)
    u = u.reshape(1) if u.ndim == 0 else u
    if u.shape != (len(names),) or not np.all(np.isfinite(u)):
        raise InputError(
            f"The controller returned {returned!r} at {t:.6g} s; it must return finite numbers"
            f" [{len(names)}]: {', '.join(names)}, or a mapping by name."
        )
    return u


class _Found:
    """The results of one integration after the other, put together."""

    def __init__(self, model: Model, times: FloatArray, ledger: bool) -> None:
        self.model, self.times, self.with_ledger = model, times, ledger
        self.x = np.zeros((len(times), len(model.state_names)))
        self.ledger = np.zeros((len(times) if ledger else 0, 3))
        self.done, self.total, self.steps = 0, np.zeros(3), 0
        self.events: list[FloatArray] = []
        self.modes: FloatArray | None = None

    def add(
        self,
        a: float,
        b: float,
        x: FloatArray,
        p: FloatArray,
        inputs: InputTable,
        method: str,
        accuracy: Accuracy,
    ) -> Solution:
        """Integrate from a to b in s, and keep the outputs between, those at the end of the run
        too.
        """
        last = b >= self.times[-1] - COINCIDENT
        until = len(self.times) if last else int(np.searchsorted(self.times, b - COINCIDENT))
        own = self.times[self.done : until]
        asked = np.append(own, b) if len(own) == 0 or own[-1] < b else own
        room = EVENT_ROOM
        while True:
            found = integrate(
                self.model,
                method,
                p,
                x,
                inputs,
                inputs.held,
                inputs.with_stops(np.array([a, b])),
                asked,
                accuracy,
                ledger=self.with_ledger,
                event_room=room,
            )
            if found.event_count <= room:
                break
            room = found.event_count
        self._keep(a, until, found)
        return found

    def _keep(self, a: float, until: int, found: Solution) -> None:
        count = until - self.done
        self.x[self.done : until] = found.x[:count]
        if self.with_ledger:
            self.ledger[self.done : until] = found.ledger[:count]
            self.ledger[self.done : until, 1:] += self.total[1:]
            self.total[1:] += found.ledger[-1, 1:]
        if self.modes is not None:
            self.events.append(
                _changed(a, self.modes, found.first_modes, len(self.model.friction_rates))
            )
        self.events.append(found.events)
        self.modes, self.done = found.last_modes, until
        self.steps += found.steps

    def whole(self, last: Solution) -> Solution:
        """All that was found, with status, time and state of the `last` integration."""
        events = np.concatenate([np.zeros((0, 3)), *self.events])
        return Solution(
            last.status,
            last.reached,
            last.state,
            self.x,
            last.s,
            self.ledger,
            events,
            len(events),
            self.steps,
            last.first_modes,
            last.last_modes,
        )


def _changed(t: float, before: FloatArray, after: FloatArray, frictions: int) -> FloatArray:
    """Events [e, 3] at t in s of the elements whose modes differ: time, element, mode entered."""
    rows: list[Sequence[float]] = []
    for element in range(frictions + contact_count(frictions, len(after))):
        if element < frictions:
            if before[element] != after[element]:
                rows.append((t, element, after[element]))
            continue
        own = slice(
            contact_modes(frictions, element - frictions),
            contact_modes(frictions, element - frictions) + 2,
        )
        if np.any(before[own] != after[own]):
            touched, active = after[own]
            rows.append((t, element, touched * (2.0 - active)))
    return np.array(rows).reshape(-1, 3)
