"""Run many trajectories of one model on a GPU, one per thread.

Trajectories are independent: one that fails reports why, and the others finish.

The two kernels of a model, one thread a trajectory.

Arrays of all trajectories have the trajectory as their last index, so that neighbouring threads
read neighbouring numbers; what a thread works on is in registers and memory of its own.

Smooth models: Tsitouras's pair of order 5(4), every thread with a step length of its own.

Steps end where an input jumps; the step length is taken up again after such a stop.
"""

import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numba import cuda, float64, int64
from numba.extending import register_jitable
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.gpu.implicit import (
    StepWork,
    begin_rigid,
    choose_start_modes,
    find_sprung_modes,
    integrate_in_steps,
    keep_modes,
    land_rigid,
    never_strike,
)
from ptp_symbolic.numeric.gpu.machine import (
    READY,
    Drives,
    Layout,
    Machine,
    Runs,
    Signals,
    begin_signals,
    copy,
    drives_of,
    evaluate,
    is_finite,
    is_outside,
    next_stop,
)
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import (
    InputSignal,
    delayed,
    delays_of,
    stack,
    values_at,
)
from ptp_symbolic.numeric.simulation.integration import (
    EXPLICIT,
    checked_accuracy,
    default_method,
    new_watch,
    refuse_start,
)
from ptp_symbolic.numeric.simulation.kernels.records import (
    DIVERGED,
    DONE,
    EXHAUSTED,
    OUTSIDE,
    TOO_FAST,
)
from ptp_symbolic.numeric.simulation.lanes import IMPOSSIBLE, impossible
from ptp_symbolic.numeric.simulation.methods.runge_kutta import ERROR, ORDER, STAGES, A, C
from ptp_symbolic.numeric.simulation.run import FIXED_STEP, refuse_failure

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

SHORTEST = 1e-11  # s
SAFETY, LEAST, MOST = 0.9, 0.2, 5.0  # factors by which a step length changes
FIRST = 1e-4  # s; the longest first step
BEFORE_STOP = 2.0  # step lengths: a shorter rest before a stop is cut in two


class Accuracy(NamedTuple):
    """Relative tolerance, absolute ones [n] in the units of the states, the longest step in s, and
    the most steps tried.
    """

    relative: Any
    absolute: Any
    longest: Any
    most_steps: Any


@register_jitable
def integrate_smooth(machine, signals, k, begin, end, accuracy):
    """Integrate machine.x [n] from `begin` to `end` in s, with stages k [7, n].

    Returns status, the time reached in s, and the number of steps tried.
    """
    t, stop, h, steps = begin, begin, min(FIRST, accuracy.longest), 0
    if is_outside(machine, machine.x):
        return OUTSIDE, t, steps
    while t < end:
        if t >= stop:
            stop = next_stop(t, end, signals)
            evaluate(t, 1, signals, machine.u)
            machine.derivative(
                t, machine.x, machine.u, machine.p, machine.m, machine.prepared, k[0]
            )
        if steps >= accuracy.most_steps:
            return EXHAUSTED, t, steps
        length = h
        if t + h >= stop:
            length = stop - t
        elif t + BEFORE_STOP * h > stop:
            length = 0.5 * (stop - t)
        attempt(machine, signals, k, t, length)
        steps += 1
        error = error_norm(machine, k, length, accuracy)
        factor = MOST
        if not error < (SAFETY / MOST) ** ORDER:
            factor = max(LEAST, SAFETY * error ** (-1.0 / ORDER)) if error < 1e30 else LEAST
        if error <= 1.0:
            if is_outside(machine, machine.end):
                copy(machine.end, machine.x)
                return OUTSIDE, t + length, steps
            t = stop if t + h >= stop else t + length
            accept(machine, k)
            h = max(h, factor * length) if length < h else factor * length
            h = min(h, accuracy.longest)
            continue
        h = factor * length
        if h < SHORTEST:
            return (TOO_FAST if is_finite(machine.end) else DIVERGED), t, steps
    return (DONE if is_finite(machine.x) else DIVERGED), t, steps


@register_jitable
def attempt(machine, signals, k, t, h):
    """Try a step of h s: write the slopes k [7, n] and the state machine.end [n]."""
    for i in range(1, STAGES):
        for a in range(len(machine.x)):
            change = 0.0
            for j in range(i):
                change += A[i, j] * k[j, a]
            machine.end[a] = machine.x[a] + h * change
        evaluate(t + C[i] * h, -1 if C[i] == 1.0 else 1, signals, machine.u)
        machine.derivative(
            t + C[i] * h, machine.end, machine.u, machine.p, machine.m, machine.prepared, k[i]
        )


@register_jitable
def error_norm(machine, k, h, accuracy):
    """The largest estimated error of a state over its tolerance; infinite for what is no number."""
    worst = 0.0
    for a in range(len(machine.x)):
        error = 0.0
        for i in range(STAGES):
            error += ERROR[i] * k[i, a]
        size = max(abs(machine.x[a]), abs(machine.end[a]))
        ratio = abs(h * error) / (accuracy.absolute[a] + accuracy.relative * size)
        worst = max(worst, ratio) if ratio < 1e300 else 1e300
    return worst


@register_jitable
def accept(machine, k):
    """Go on to the end of the step, where its last slope is the first of the next."""
    for a in range(len(machine.x)):
        machine.x[a] = machine.end[a]
        k[0, a] = k[STAGES - 1, a]


@register_jitable
def read_trajectory(i, runs, machine, signals, delays, prepare, domain):
    """Read trajectory i into a machine and its signals."""
    for a in range(runs.x.shape[0]):
        machine.x[a] = runs.x[a, i]
    for a in range(runs.p.shape[0]):
        machine.p[a] = runs.p[a, i]
    for a in range(runs.m.shape[0]):
        machine.m[a] = runs.m[a, i]
    prepare(machine.p, machine.prepared)
    domain(machine.p, machine.bounds)
    begin_signals(signals, delays, machine.p)


@register_jitable
def write_trajectory(i, runs, x, status, reached, steps):
    """Write the final state x [n] and how the run ended to the place of trajectory i."""
    for a in range(runs.x.shape[0]):
        runs.x[a, i] = x[a]
    runs.status[i], runs.reached[i], runs.steps[i] = status, reached, steps


@lru_cache(maxsize=16)
def smooth_kernel(layout: Layout) -> Any:
    """The kernel of a smooth model: explicit steps within tolerances."""
    module, f = layout.module, float64
    derivative, guards = module.prepared_derivative, module.guards
    prepare, domain = module.prepare, module.domain
    n, nu, parameters, prepared = sizes_of(layout)
    modes, guard_count, limits = layout.modes, layout.guards, layout.limits
    bounds, limited, delays = max(1, limits), layout.limited, layout.delays
    rates, zero_at_rest, stages = layout.friction_rates, layout.zero_at_rest, STAGES
    contact_rates = layout.contact_rates

    @cuda.jit
    def run_smooth(runs, drives, begin, end, accuracy):
        i, local = cuda.grid(1), cuda.local.array
        if i >= len(runs.status) or runs.status[i] != READY:
            return
        x, u = local(n, f), local(nu, f)
        machine = Machine(
            derivative,
            guards,
            guards,
            guards,
            0,
            0,
            rates,
            zero_at_rest,
            contact_rates,
            limits,
            limited,
            x,
            local(n, f),
            u,
            u,
            local(parameters, f),
            local(prepared, f),
            local(modes, f),
            local(modes, f),
            local(guard_count, f),
            local((bounds, 2), f),
            local(1, int64),
            local(1, int64),
            local(1, f),
        )
        first = runs.kind[i] * nu
        signals = Signals(drives, first, local(nu, f), local(nu, int64), local(nu, int64))
        read_trajectory(i, runs, machine, signals, delays, prepare, domain)
        status, reached, steps = integrate_smooth(
            machine, signals, local((stages, n), f), begin, end, accuracy
        )
        write_trajectory(i, runs, x, status, reached, steps)

    return run_smooth


@lru_cache(maxsize=16)
def stepping_kernel(layout: Layout) -> Any:
    """The kernel of all models: fixed steps that find the modes of friction and contact."""
    module, f = layout.module, float64
    derivative, linearize = module.prepared_derivative, module.linearize
    guards, prepare, domain = module.guards, module.prepare, module.domain
    n, nu, parameters, prepared = sizes_of(layout)
    modes, guard_count, limits = layout.modes, layout.guards, layout.limits
    frictions, contacts, directions = layout.frictions, layout.contacts, 2 * layout.frictions + 1
    bounds, limited, delays = max(1, limits), layout.limited, layout.delays
    rates, zero_at_rest = layout.friction_rates, layout.zero_at_rest
    contact_rates, touching = layout.contact_rates, max(1, contacts)
    impacts = module.impacts if layout.rigid else guards
    changes = touching * (n + 2) if layout.rigid else 1
    begin_modes, find_modes, land = choose_start_modes, find_sprung_modes, never_strike
    if layout.rigid:
        begin_modes, find_modes, land = begin_rigid, keep_modes, land_rigid

    @cuda.jit
    def run_in_steps(runs, drives, begin, end, step):
        i, local = cuda.grid(1), cuda.local.array
        if i >= len(runs.status) or runs.status[i] != READY:
            return
        x = local(n, f)
        machine = Machine(
            derivative,
            linearize,
            guards,
            impacts,
            frictions,
            contacts,
            rates,
            zero_at_rest,
            contact_rates,
            limits,
            limited,
            x,
            local(n, f),
            local(nu, f),
            local(nu, f),
            local(parameters, f),
            local(prepared, f),
            local(modes, f),
            local(modes, f),
            local(guard_count, f),
            local((bounds, 2), f),
            local(touching, int64),
            local(touching, int64),
            local(changes, f),
        )
        for c in range(touching):
            machine.pressed[c] = 0
            machine.settling[c] = 0
        work = StepWork(
            local((n, n), f),
            local((n, nu), f),
            local((n, n), f),
            local(n, int64),
            local(n, f),
            local(n, f),
            local(directions, int64),
        )
        first = runs.kind[i] * nu
        signals = Signals(drives, first, local(nu, f), local(nu, int64), local(nu, int64))
        read_trajectory(i, runs, machine, signals, delays, prepare, domain)
        status, reached, steps = integrate_in_steps(
            machine, signals, work, begin, end, step, begin_modes, find_modes, land
        )
        write_trajectory(i, runs, x, status, reached, steps)

    return run_in_steps


def sizes_of(layout: Layout) -> tuple[int, int, int, int]:
    """Numbers of states, inputs, parameters and prepared subexpressions."""
    return layout.states, layout.inputs, layout.parameters, layout.prepared


THREADS = 128  # a block: four warps, so that registers never hold one back
LARGEST_STEP = 1.0  # s, of smooth models
MOST_STEPS = 1_000_000  # of a trajectory: a GPU that shows a desktop stops kernels of seconds
METHODS = (EXPLICIT, FIXED_STEP)


@dataclass(frozen=True, eq=False)
class GpuStates:
    """How b trajectories ended: status [b] (see `kernels.records`, or IMPOSSIBLE) and `reasons` [b]
    in words, empty where it is DONE; steps tried [b]; final states x [b, n], NaN where it failed.
    """

    status: IntArray
    reasons: list[str]
    steps: IntArray
    x: FloatArray


def integrate_on_gpu(
    model: Model,
    p: FloatArray,
    x: FloatArray,
    drives: Sequence[Sequence[InputSignal]],
    drive: IntArray | None,
    span: tuple[float, float],
    method: str | None = None,
    step: float = 1e-4,
    rtol: float = 1e-8,
    atol: float = 1e-9,
    largest_step: float = LARGEST_STEP,
) -> GpuStates:
    """Integrate from every x [b, n] over `span` in s at parameters p [b, np], in SI.

    `drives` are the signals of all inputs, in the order of the model, for every kind of run;
    `drive` [b] says which one drives a trajectory, None that there is one kind. `method` is
    "runge_kutta" for smooth models, within rtol and atol (see `simulate`), or "fixed_step" for all
    without sampled controllers, in steps of at most `step` s; None lets the model choose.

    Values that are impossible, and runs that do not reach their end, are reported in their place.
    Raises InputError for arrays of another shape, for a model that has no method here, for a span,
    step or tolerance that is not above zero, and where there is neither GPU nor simulator.
    """
    chosen = _method(model, method)
    count = len(p)
    kind = np.zeros(count, np.int64) if drive is None else np.asarray(drive, np.int64)
    _refuse_shapes(model, p, x, drives, kind)
    p, x = (np.ascontiguousarray(values, np.float64) for values in (p, x))
    begin, end = map(float, span)
    for name, value in (("Duration", end - begin), ("Step", step)):
        if not 0.0 < value < np.inf:
            raise InputError(f"{name} {value:g} s; give a positive number of seconds.")
    if chosen == FIXED_STEP and (end - begin) / step > MOST_STEPS:
        raise InputError(
            f"Step {step:g} s for {end - begin:g} s; give one of at least"
            f" {(end - begin) / MOST_STEPS:g} s, which makes {MOST_STEPS} steps."
        )
    accuracy = checked_accuracy(model, rtol, atol, largest_step)
    cuda = cuda_library()

    status, reasons = impossible(model, p, x)
    runs = Runs(
        np.ascontiguousarray(x.T, np.float64),
        np.ascontiguousarray(p.T, np.float64),
        _start_modes(model, p, x, drives, kind, begin, status, reasons),
        kind,
        status.copy(),
        np.zeros(count),
        np.zeros(count, np.int64),
    )
    on_device = Runs(*map(cuda.to_device, runs))
    tables, layout = Drives(*map(cuda.to_device, drives_of(drives))), Layout.of(model)
    grid = (-(-count // THREADS), THREADS) if not is_simulated(cuda) else (count, 1)
    if chosen == FIXED_STEP:
        stepping_kernel(layout)[grid](on_device, tables, begin, end, float(step))
    else:
        limits = Accuracy(
            accuracy.relative, cuda.to_device(accuracy.absolute), float(largest_step), MOST_STEPS
        )
        smooth_kernel(layout)[grid](on_device, tables, begin, end, limits)
    ended = Runs(*(array.copy_to_host() for array in on_device))
    return _reported(model, p, ended, reasons)


def cuda_library() -> ModuleType:
    """CUDA for numba, on a GPU or in its simulator. Raises InputError where there is neither."""
    if importlib.util.find_spec("numba_cuda") is None:
        raise InputError(
            "numba-cuda is not installed; run pip install 'ptp-symbolic[gpu]', or leave the GPU"
            " out."
        )
    from numba import cuda

    if not cuda.is_available():
        raise InputError(
            "No NVIDIA GPU with a CUDA driver here; run on a machine with one, leave the GPU out,"
            " or set NUMBA_ENABLE_CUDASIM=1 before Python starts to try it, slowly, without."
        )
    return cuda


def is_simulated(cuda: object) -> bool:
    """Whether `cuda` is numba's simulator, where a thread of a block is a thread of Python."""
    return "simulator" in str(getattr(getattr(cuda, "to_device", None), "__module__", ""))


def _method(model: Model, method: str | None) -> str:
    """The method to take. Raises InputError for one that is unknown or does not suit the model."""
    if method is not None and method not in METHODS:
        raise InputError(f"Unknown method '{method}' on a GPU. Choose from: {', '.join(METHODS)}.")
    chosen = method or (EXPLICIT if default_method(model) == EXPLICIT else FIXED_STEP)
    if chosen == EXPLICIT and model.mode_names:
        raise InputError(
            f"Model '{model.name}' has friction or contact, and runge_kutta on a GPU locates no"
            " events; take the method fixed_step."
        )
    if len(model.sampler_periods):
        raise InputError(
            f"Model '{model.name}' has a sampled controller, for which a GPU has no kernel; leave"
            " the GPU out."
        )
    return chosen


def _refuse_shapes(
    model: Model,
    p: FloatArray,
    x: FloatArray,
    drives: Sequence[Sequence[InputSignal]],
    kind: IntArray,
) -> None:
    """Raise InputError where arrays do not fit the model or each other."""
    count = len(p)
    for what, shape, width in (
        ("Parameters", np.shape(p), len(model.parameter_names)),
        ("Initial states", np.shape(x), len(model.state_names)),
    ):
        if shape != (count, width) or not count:
            raise InputError(f"{what} of shape {shape}; give [n, {width}], with n of one or more.")
    if kind.shape != (count,) or not np.all((kind >= 0) & (kind < len(drives))):
        raise InputError(
            f"Kinds of drive: give one for each of {count} runs, from 0 to {len(drives) - 1}."
        )
    for signals in drives:
        if len(signals) != len(model.input_names):
            raise InputError(
                f"{len(signals)} signals; give {len(model.input_names)}:"
                f" {', '.join(model.input_names)}."
            )


def _start_modes(
    model: Model,
    p: FloatArray,
    x: FloatArray,
    drives: Sequence[Sequence[InputSignal]],
    kind: IntArray,
    begin: float,
    status: IntArray,
    reasons: list[str],
) -> FloatArray:
    """Modes [nm, b] at `begin` in s of rigid contacts; marks starts in which bodies overlap.

    Those of sprung contacts are found in the threads: their modes stay zero.
    """
    m = np.zeros((len(p), max(1, len(model.mode_names))))
    if not model.contacts[:, 2].any():
        return np.ascontiguousarray(m.T)
    watch, tables = new_watch(model, x.shape[1], p[0]), [stack(signals) for signals in drives]
    for b in np.flatnonzero(status == DONE):
        table = delayed(tables[kind[b]], delays_of(model, p[b]))
        u = values_at(table, np.array([begin]))[0]
        model.module.initial_modes(begin, x[b], u, p[b], watch.m)
        try:
            refuse_start(model, x[b], u, p[b], watch)
        except InputError as error:
            status[b], reasons[b] = IMPOSSIBLE, str(error)
        m[b] = watch.m
    return np.ascontiguousarray(m.T)


def _reported(model: Model, p: FloatArray, ended: Runs, reasons: list[str]) -> GpuStates:
    """The results, with a sentence for every run that failed."""
    x = np.ascontiguousarray(ended.x.T)
    for b in np.flatnonzero((ended.status != DONE) & (ended.status != IMPOSSIBLE)):
        if ended.status[b] == EXHAUSTED:
            reasons[b] = f"Stopped at {ended.reached[b]:.6g} s: {MOST_STEPS} steps are used up."
            continue
        try:
            refuse_failure(model, p[b], int(ended.status[b]), float(ended.reached[b]), x[b])
        except ValueError as error:
            reasons[b] = str(error)
    x[ended.status != DONE] = np.nan
    return GpuStates(ended.status, reasons, ended.steps, x)
