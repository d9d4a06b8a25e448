"""Integrate a model with adaptive steps: preallocate, run, and return the solution.

Preallocated arrays of a run, for its work and its results: kernels allocate nothing.

Integrate smooth motion by steps of order 8: preallocate, run, and return the results.
"""

import threading
from dataclasses import dataclass, replace
from functools import lru_cache
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError, number_of
from ptp_symbolic.numeric.runtime.element_layout import contact_count, contact_guards, contact_modes
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation import hybrid, smooth_runner
from ptp_symbolic.numeric.simulation.events.impacts import STICKS
from ptp_symbolic.numeric.simulation.inputs import InputTable, delays_of
from ptp_symbolic.numeric.simulation.kernels.calls import addresses, smooth_addresses
from ptp_symbolic.numeric.simulation.kernels.linear import padded
from ptp_symbolic.numeric.simulation.kernels.records import (
    EVENTS,
    EXHAUSTED,
    STEPS,
    STIFF,
    TIME,
    Record,
    Step,
    Tangents,
    Watch,
)
from ptp_symbolic.numeric.simulation.methods.exponential_step import (
    LENGTHS,
    Propagator,
    forget,
    new_propagator,
)
from ptp_symbolic.numeric.simulation.methods.rosenbrock import STAGES
from ptp_symbolic.numeric.simulation.methods.steps import ROSENBROCK, RUNGE_KUTTA
from ptp_symbolic.numeric.simulation.sampling import loop_address, new_sampling
from ptp_symbolic.numeric.simulation.smooth_runner import LANES, REACHED, ROWS, START, TRIED

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


class _OfThread(threading.local):
    """Propagators by their size, and how many."""

    def __init__(self) -> None:
        self.propagators: dict[tuple[int, int, int, int], list[Propagator]] = {}


_OF_THREAD = _OfThread()


def is_smooth(model: Model) -> bool:
    """Whether the motion of `model` has no modes, samplers or bounds, so that nothing ends a step
    but its inputs.
    """
    return not (model.mode_names or model.sampler_periods or model.limits)


def integrate_smooth(
    model: Model,
    p: FloatArray,
    x: FloatArray,
    inputs: InputTable,
    held: bool,
    stops: FloatArray,
    times: FloatArray,
    limits: FloatArray,
    atol: FloatArray,
    ledger: bool,
) -> tuple[int, float, FloatArray, FloatArray, FloatArray, int]:
    """Integrate `model` at p [np] from x [n] over `stops` in s, as `integrate` does: status, time
    reached in s, state there, states [k, n] and ledger [k, 3] at `times`, steps tried.

    `limits` begins with the relative tolerance, largest step in s, most steps; `atol` [n].
    """
    n, k, z = len(x), len(times), np.zeros
    width = -(-(n + 2 * ledger) // LANES) * LANES
    work, clock, counts = z((ROWS, width)), z(5), z(4, np.int64)
    work[START, :n] = x
    u, cursor, out, energies = z(len(model.input_names)), inputs.new_cursor(), z((k, n)), z((0, 3))
    if ledger:
        energies = z((k, 3))
    status = smooth_runner.runner()(
        smooth_addresses(model.module, ledger),
        p,
        z(0),
        model.prepared(p),
        inputs.arrays,
        cursor,
        held,
        u,
        limits,
        atol,
        work,
        clock,
        counts,
        stops,
        times,
        out,
        energies,
    )
    return status, float(clock[REACHED]), work[START, :n], out, energies, int(counts[TRIED])


FACE_WIDTH = 1e-9  # rad, or m
EXPLICIT, IMPLICIT = "runge_kutta", "rosenbrock"
METHODS = {EXPLICIT: RUNGE_KUTTA, IMPLICIT: ROSENBROCK}
MOST_STEPS = 50_000_000  # a minute or two
PATIENCE = 100_000  # explicit steps after which is asked whether stability holds them up: 0.1 s
MOST_EXPLICIT_STEPS = 5_000_000  # that a stiff machine is let take: some seconds
STABLE = 2.5  # step of the explicit method over the shortest time constant
NEAR_STABILITY = 0.4  # of the stable step: with tangents, or rejected steps among them


@dataclass(frozen=True, eq=False)
class Solution:
    """Solution of a run: status (see `kernels.records`), time reached in s and state [n] there.

    At the output times x [k, n], tangents s [k, n, ns] and ledger [k, 3] (stored, supplied,
    dissipated in J; no rows if not asked for); the first events [e, 3] (time in s, element, mode
    entered) and the number of all, steps tried; the modes at the start and at the end.
    """

    status: int
    reached: float
    state: FloatArray
    x: FloatArray
    s: FloatArray
    ledger: FloatArray
    events: FloatArray
    event_count: int
    steps: int
    first_modes: FloatArray
    last_modes: FloatArray


@dataclass(frozen=True, eq=False)
class Accuracy:
    """Local error tolerances, relative and absolute per state [n] in its unit, the largest step
    in s, and how many steps may be tried: in all, and at once beyond those that are usual from one
    stop to the next.
    """

    relative: float
    absolute: FloatArray
    largest_step: float
    most_steps: int = MOST_STEPS
    most_at_once: int = MOST_STEPS
    usual: int = 0


def default_method(model: Model) -> str:
    """`runge_kutta` for rigid bodies alone, `rosenbrock` where drives, friction or contact are.

    A winding or a shaft is a hundred times faster than the motion: the machine is stiff, and
    stability limits the steps of an explicit method.
    """
    return _default_method(model.module)


@lru_cache(maxsize=256)
def _default_method(module: ModuleType) -> str:
    bodies = {f"{kind}_{axis}" for kind in ("theta", "omega") for axis in module.AXES}
    smooth = not module.MODE_NAMES and set(module.STATE_NAMES) <= bodies
    return EXPLICIT if smooth else IMPLICIT


def checked_accuracy(
    model: Model, rtol: float, atol: float, largest_step: float, most_steps: int = MOST_STEPS
) -> Accuracy:
    """The accuracy of a run of `model`, atol in rad (see `tolerance_weights`), largest step in s.

    Raises InputError for a tolerance or a largest step that is not above zero.
    """
    for name, value in (("rtol", rtol), ("atol", atol), ("largest_step", largest_step)):
        if not number_of(value, f"`{name}`") > 0.0:
            raise InputError(f"{name} = {value:g}; give a number above zero.")
    return Accuracy(rtol, atol * tolerance_weights(model), largest_step, most_steps)


def tolerance_weights(model: Model) -> FloatArray:
    """Factor [n] from an absolute tolerance in rad or m to that of every state; 1 for free bodies,
    whose errors do not decay.
    """
    if default_method(model) == EXPLICIT:
        return np.ones(len(model.state_names))
    return geared_weights(model)


def geared_weights(model: Model) -> FloatArray:
    """Factor [n] from an absolute tolerance in rad or m to that of every state of a geared machine.

    An error of a rate (rad/s, m/s) counts a hundredth and any other, such as a current, a
    thousandth: it decays before it reaches an angle or a position.
    """
    return _geared_weights(model.module).copy()


@lru_cache(maxsize=256)
def _geared_weights(module: ModuleType) -> FloatArray:
    factors = {"rad": 1.0, "m": 1.0, "rad/s": 100.0, "m/s": 100.0}
    return np.array([factors.get(unit, 1000.0) for unit in module.STATE_UNITS])


def integrate(
    model: Model,
    method: str | None,
    p: FloatArray,
    x: FloatArray,
    inputs: InputTable,
    held: bool,
    stops: FloatArray,
    times: FloatArray,
    accuracy: Accuracy,
    s: FloatArray | None = None,
    columns: IntArray | None = None,
    delay_column: IntArray | None = None,
    ledger: bool = False,
    event_room: int = 0,
    rough_tangents: bool = False,
    functions: IntArray | None = None,
) -> Solution:
    """Integrate `model` at p [np] from the first to the last of `stops` in s, from x [n] with
    tangents s [n, ns]; outputs at `times` [k] in s.

    `held`: inputs are zero-order hold, with jumps at stops only; those that samplers alone read
    need not be. With tangents, output times must be stops. The first tangents are by the parameters
    `columns`; `delay_column` [nu] is per input the tangent of its delay, or -1. States that act on
    nothing (see `Model.acting`) stand still under the implicit method. `rough_tangents`: good to
    some thousandths is enough, so that exponential steps may carry them (see
    `methods.exponential_tangents`). `functions` are those of `addresses`, where others than the
    model's own are to be called.

    Without a `method` it is the one that suits the model, and the implicit one where the explicit
    one would be held up by stability; with one, the status is then STIFF. Raises InputError as
    `refuse_start` and `new_sampling` do.
    """

    def attempt(chosen: str, most_steps: int) -> Solution:
        return _integrate(
            model,
            chosen,
            p,
            x,
            inputs,
            held,
            stops,
            times,
            replace(accuracy, most_steps=most_steps),
            s,
            columns,
            delay_column,
            ledger,
            event_room,
            rough_tangents,
            functions,
        )

    chosen, most = method or default_method(model), accuracy.most_steps
    if chosen != EXPLICIT or most <= PATIENCE:
        return attempt(chosen, most)
    found = attempt(chosen, PATIENCE)
    if found.status == EXHAUSTED and not _held_up(model, p, found, stops):
        return attempt(chosen, most)
    if found.status == EXHAUSTED:
        return attempt(IMPLICIT, most) if method is None else replace(found, status=STIFF)
    return found


def _held_up(model: Model, p: FloatArray, found: Solution, stops: FloatArray) -> bool:
    """Whether explicit steps are as short as stability asks, and so many more than can be taken."""
    step = (found.reached - stops[0]) / found.steps
    too_many = stops[-1] - stops[0] > MOST_EXPLICIT_STEPS * step
    return bool(too_many and step > NEAR_STABILITY * stable_step(model, p, found.state))


def stable_step(model: Model, p: FloatArray, x: FloatArray) -> float:
    """Step in s at which the explicit method is stable, by the spectral radius of the Jacobian at x
    [n], p [np] in open modes, and with every friction sliding and every contact closed.
    """
    u, fastest = np.zeros(len(model.input_names)), 0.0
    for modes in (np.zeros(len(model.mode_names)), np.ones(len(model.mode_names))):
        fx = model.derivatives(0.0, x, u, p, modes).fx
        if np.all(np.isfinite(fx)):
            fastest = max(fastest, float(np.abs(np.linalg.eigvals(fx)).max()))
    return STABLE / fastest if fastest > 0.0 else np.inf


def _integrate(
    model: Model,
    method: str,
    p: FloatArray,
    x: FloatArray,
    inputs: InputTable,
    held: bool,
    stops: FloatArray,
    times: FloatArray,
    accuracy: Accuracy,
    s: FloatArray | None,
    columns: IntArray | None,
    delay_column: IntArray | None,
    ledger: bool,
    event_room: int,
    rough_tangents: bool,
    functions: IntArray | None,
) -> Solution:
    """One run, as `integrate` has it."""
    stands_still = held or not any(model.module.INPUT_ACTS)
    at_once, usual = accuracy.most_at_once, accuracy.usual
    most = accuracy.most_steps, at_once, usual, at_once
    limits = np.array([accuracy.relative, accuracy.largest_step, *most], dtype=np.float64)
    if method == EXPLICIT and (s is None or not s.shape[1]) and is_smooth(model):
        status, reached, state, states, energies, steps = integrate_smooth(
            model, p, x, inputs, stands_still, stops, times, limits, accuracy.absolute, ledger
        )
        none, tangents_of_none = np.zeros((0, 3)), np.zeros((len(times), len(x), 0))
        return Solution(
            status,
            reached,
            state,
            states,
            tangents_of_none,
            energies,
            none,
            0,
            steps,
            np.zeros(0),
            np.zeros(0),
        )
    n, nu, module = len(x), len(model.input_names), model.module
    columns = np.zeros(0, dtype=np.int64) if columns is None else columns
    s = np.zeros((n, 0)) if s is None else s
    tangents = new_tangents(
        s,
        columns,
        np.full(nu, -1) if delay_column is None else delay_column,
        len(p),
        nu,
    )
    solved, c = n if s.shape[1] else model.moving, model.prepared(p)
    functions = addresses(module, s.shape[1] > 0) if functions is None else functions
    acting = model.acting(p, columns)
    if method == IMPLICIT:
        solved = min(solved, acting)
    x, u, cursor = x.copy(), np.zeros((3, nu)), inputs.new_cursor()
    watch = new_watch(model, n, p)
    hybrid.evaluate_inputs(stops[0], 1, *inputs.arrays, cursor, u[0])
    module.initial_modes(stops[0], x, u[0], p, watch.m)
    first_modes = watch.m.copy()
    refuse_start(model, x, u[0], p, watch)
    record = new_record(times, n, s.shape[1], len(times) if ledger else 0, event_room)
    sampled = len(model.sampler_periods) > 0
    whole = method == IMPLICIT and stands_still and not ledger and not sampled
    whole = whole and (rough_tangents or not s.shape[1])
    modes, moving = len(model.mode_names), solved if whole or sampled else 0
    lean_runner = method == IMPLICIT and not (s.shape[1] or sampled)
    status = hybrid.runner(sampled, lean_runner)(
        METHODS[method],
        loop_address() if whole else 0,
        functions,
        p,
        c,
        model.friction_rates,
        model.zero_at_rest,
        contact_table(model),
        inputs.arrays,
        cursor,
        stands_still,
        u,
        x,
        stops,
        limits,
        accuracy.absolute,
        tuple(new_step(n, nu, len(p) if s.shape[1] else 0, solved)),
        tuple(watch),
        tuple(tangents),
        tuple(record),
        tuple(new_sampling(model, p, x, stops, padded(s.shape[1]))),
        _propagators(model, p, modes, moving, n),
    )
    return Solution(
        status,
        float(record.clock[TIME]),
        x,
        record.x,
        record.s,
        record.ledger,
        record.events[: record.counts[EVENTS]],
        int(record.counts[EVENTS]),
        int(record.counts[STEPS]),
        first_modes,
        watch.m,
    )


def _propagators(
    model: Model, p: FloatArray, modes: int, moving: int, n: int
) -> tuple[tuple[Any, ...], ...]:
    """Propagators [LENGTHS] of which nothing is known yet, as many different ones as lengths of
    steps follow one another: one more than inputs are late at p [np], each by its own delay. A
    thread makes those of a size once, a tenth of the time of a short simulation.
    """
    late = {delay for delay in delays_of(model, p).tolist() if delay > 0.0}
    count = min(1 + len(late), LENGTHS)
    made = _OF_THREAD.propagators.setdefault((modes, moving, n, count), [])
    while len(made) < count:
        made.append(new_propagator(modes, moving, n))
    for propagator in made:
        forget(propagator)
    return tuple(tuple(made[k % len(made)]) for k in range(LENGTHS))


def refuse_start(model: Model, x: FloatArray, u: FloatArray, p: FloatArray, watch: Watch) -> None:
    """Raise InputError where the initial state x [n], with u [nu] and p [np], lets rigid bodies
    overlap, or moves a joint that sticks in its gap. Modes are read from `watch`, its guards
    written.
    """
    frictions = len(model.friction_rates)
    if not model.contacts[:, 2].any():
        return
    model.module.guards(0.0, x, u, p, watch.m, watch.g)
    for contact, (_, joint, rule) in enumerate(model.contacts):
        separation, half_gap = watch.g[contact_guards(frictions, contact) :][:2]
        unit = model.module.STATE_UNITS[joint].removesuffix("/s")
        if rule and abs(separation) > half_gap + FACE_WIDTH:
            raise InputError(
                f"The gear output starts {separation:.6g} {unit} ahead of the joint, beyond a rigid"
                f" face at {half_gap:.6g} {unit}; start it within the gap."
            )
        if (
            rule == STICKS
            and not watch.m[contact_modes(frictions, contact) + 1]
            and x[joint] != 0.0
        ):
            raise InputError(
                f"State '{model.state_names[joint]}' starts at {x[joint]:.6g} {unit}/s in the gap,"
                " where friction holds the joint; start it at rest."
            )
