"""What is settled before a diagnosis: candidates, windows, noise.

Inputs that seem to act the other way round: a motor, or a sensor, wired with its sign turned.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.diagnose.candidates import find_candidates, vanished, within_reach
from ptp_symbolic.numeric.diagnose.cut_runs import leading, spread_over, takes_away_most
from ptp_symbolic.numeric.diagnose.declared_rows import declared_start, equation_space, first_fit
from ptp_symbolic.numeric.diagnose.refits import is_near_floor
from ptp_symbolic.numeric.diagnose.trial import Progress, Task, Trial, fitted
from ptp_symbolic.numeric.identify.constants import (
    FORGOTTEN,
    LEAST_START,
    SEARCH_PERIOD,
    SHORT,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.run import Run, with_inputs
from ptp_symbolic.numeric.identify.sample_averages import samples_within, thinned
from ptp_symbolic.numeric.identify.simulations import POLISH, all_values_at_start
from ptp_symbolic.numeric.identify.windows import cut, window_length
from ptp_symbolic.numeric.identify.work import Allowance
from ptp_symbolic.numeric.runtime.model import Model


def task_of(
    model: Model,
    train: tuple[Run, ...],
    validate: tuple[Run, ...],
    free: tuple[FreeParameter, ...],
    known: Mapping[str, tuple[float, float | None]],
    declared: Sequence[str],
    noises: Mapping[str, float | None],
    window: float | None,
    material: float,
    executor: Executor,
    progress: Progress,
    allowance: Allowance | None = None,
) -> Task:
    """All that stays the same through a diagnosis, or through a fit where nothing is `declared`.

    `known` are the known values with the most by which each may be off, `declared` the keys of the
    effects that are no candidates, `noises` the declared noise (rms) of every signal in its unit
    (None: not declared), `window` the length in s of the windows (None: as far as the noise of the
    inputs allows, see `window_length`), `material` that of `Task`, `allowance` what the search may
    take (None: no limit). Raises InputError for values out
    of bounds, and for windows of too few samples.
    """
    if window is not None:
        _refuse_short(window, train)
    off = vanished(model, declared) if declared else {}
    fixed = {**model.defaults, **off, **{name: value for name, (value, _) in known.items()}}
    start = model.parameter_vector({**fixed, **all_values_at_start(free)})
    noise = tuple(noises[name] for name in model.input_names)
    length = window_length(model, train, start, noise, executor) if window is None else window
    if length is not None and length >= max(float(run.time[-1] - run.time[0]) for run in train):
        length = None
    few = [thinned(run, samples_within(run, SEARCH_PERIOD)) for run in train]
    windows = {x: cut(model, few, x) for x in (FORGOTTEN, SHORT)}
    pieces = cut(model, train, length)
    largest = np.max([np.max(np.abs(run.held_inputs), axis=0) for run in train], axis=0)
    found = find_candidates(model, declared, known) if declared else ()
    angles = _reached_angles(model, train)
    candidates = tuple(within_reach(c, model, largest, angles) for c in found)
    return Task(
        model,
        train,
        pieces,
        pieces,
        tuple(leading(w, x, SHORT) for x, w in windows.items()) if length is None else (),
        spread_over(windows[SHORT], SHORT) if length is None else spread_over(pieces, length),
        cut(model, validate, length),
        free,
        fixed,
        candidates,
        executor,
        progress,
        noise,
        frozenset(name for name, size in noises.items() if size is not None),
        _finest_angle(train),
        material=material,
        allowance=Allowance() if allowance is None else allowance,
    )


def _refuse_short(window: float, runs: Sequence[Run]) -> None:
    """Raise InputError for windows in s in which no run has the samples of two starts."""
    period = min(float(np.median(np.diff(run.time))) for run in runs)
    least = 2 * LEAST_START
    if window < least * period:
        raise InputError(
            f"fit.window: {window:g} s holds fewer than {least} samples of these logs, one every"
            f" {period:.3g} s; give at least {least * period:.3g} s."
        )


def _reached_angles(model: Model, runs: Sequence[Run]) -> dict[str, tuple[float, float]]:
    """Lowest and highest measured angle in rad of the axes (m of a linear joint)."""
    found: dict[str, tuple[float, float]] = {}
    for axis in model.module.AXES:
        measured = [
            run.measured[:, k]
            for run in runs
            for k, signal in enumerate(run.signals)
            if signal == f"theta_{axis}"
        ]
        if measured:
            found[axis] = (float(min(map(np.min, measured))), float(max(map(np.max, measured))))
    return found


def _finest_angle(runs: Sequence[Run]) -> float:
    """Smallest noise of a measured angle in rad; of any signal where no angle is measured."""
    run = runs[0]
    angles = [k for k, name in enumerate(run.signals) if name.startswith("theta_")]
    return float(np.min(1.0 / run.weight[angles or list(range(len(run.weight)))]))


DRIVING = ("V", "N m", "N", "A")  # units of inputs that drive an axis


def turned_inputs(task: Task, declared: Trial) -> tuple[str, ...]:
    """A sentence for every driving input with which, its sign turned, the declared model fits the
    training runs so much better that most of what the fit `declared` leaves is gone.
    """
    if is_near_floor(declared):
        return ()
    found = []
    for k, name in enumerate(task.model.input_names):
        if task.model.units[name] in DRIVING and takes_away_most(_turned(task, k), declared):
            found.append(
                f"The declared model fits far better with the sign of '{name}' inverted: one of"
                " motor and sensor is wired the other way round; give one of their signals a"
                " negative scale."
            )
    return tuple(found)


def _turned(task: Task, number: int) -> Trial:
    """The declared model fitted to the training runs with an input turned, begun at its rows."""

    def turned(run: Run) -> Run:
        sign = np.ones(run.held_inputs.shape[1])
        sign[number] = -1.0
        return with_inputs(run, sign * run.held_inputs)

    train, whole = tuple(map(turned, task.train)), tuple(map(turned, task.whole))
    part = replace(task, train=train, every_sample=train, whole=whole)
    start = declared_start(part)
    space = equation_space(part, start)
    values = start if space is None else first_fit(part, space, start)
    return fitted(part, (), values, None, POLISH, executor=part.executor)
