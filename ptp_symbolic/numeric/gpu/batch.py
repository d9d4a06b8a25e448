"""Run many trajectories of one model on a GPU, one per thread.

Trajectories are independent: one that fails reports why, and the others finish.
"""

import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.gpu.kernels import Accuracy
from ptp_symbolic.numeric.gpu.machine import Drives, Layout, Runs, drives_of
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.buffers import new_watch
from ptp_symbolic.numeric.simulation.integration import (
    EXPLICIT,
    checked_accuracy,
    default_method,
    refuse_start,
)
from ptp_symbolic.numeric.simulation.kernels.records import DONE, EXHAUSTED
from ptp_symbolic.numeric.simulation.lanes import IMPOSSIBLE, impossible
from ptp_symbolic.numeric.simulation.run import FIXED_STEP, refuse_failure
from ptp_symbolic.numeric.simulation.signals.inputs import (
    InputSignal,
    delayed,
    delays_of,
    stack,
    values_at,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

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
    from ptp_symbolic.numeric.gpu.kernels import smooth_kernel, stepping_kernel

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
