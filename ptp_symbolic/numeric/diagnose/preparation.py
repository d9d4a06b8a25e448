"""What is settled before a diagnosis: candidates, windows, noise; and how small a parameter or an
effect these logs can show, predicted at the declared start values.

The prediction takes the declared model for right and the noise for white: model errors hide more.
An effect is simulated at a small amount; its response, projected off what the free parameters and
the initial states of the runs can follow, must stand out of the noise, and hold the share of the
squared error below which nothing is named.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.diagnose.candidates import (
    Candidate,
    find_candidates,
    vanished,
    within_reach,
)
from ptp_symbolic.numeric.diagnose.cut_runs import first_windows, more_than_halves, spread_over
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, Progress, SearchProblem, fitted
from ptp_symbolic.numeric.diagnose.proposals import declared_start, equation_space, first_fit
from ptp_symbolic.numeric.diagnose.refits import is_near_noise_floor
from ptp_symbolic.numeric.diagnose.responses import (
    projected_off,
    response_columns,
    stacked_jacobian,
)
from ptp_symbolic.numeric.identify.constants import (
    FALSE_ALARM,
    FORGOTTEN,
    LEAST_START,
    MOST,
    NOTHING,
    REACH,
    SEARCH_PERIOD,
    SHORT,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, slopes, to_search
from ptp_symbolic.numeric.identify.evidence import Allowance
from ptp_symbolic.numeric.identify.least_squares import POLISH, all_values_at_start
from ptp_symbolic.numeric.identify.run import Run, samples_within, thinned, with_inputs
from ptp_symbolic.numeric.identify.windows import cut, window_length
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


def problem_of(
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
) -> SearchProblem:
    """All that stays the same through a diagnosis, or through a fit where nothing is `declared`.

    `known` are the known values with the most by which each may be off, `declared` the keys of the
    effects that are no candidates, `noises` the declared noise (rms) of every signal in its unit
    (None: not declared), `window` the length in s of the windows (None: as far as the noise of the
    inputs allows, see `window_length`), `material` that of `SearchProblem`, `allowance` what the
    search may take (None: no limit). Raises InputError for values out of bounds, and for windows of
    too few samples.
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
    return SearchProblem(
        model,
        train,
        pieces,
        pieces,
        tuple(first_windows(w, x, SHORT) for x, w in windows.items()) if length is None else (),
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


def inverted_inputs(problem: SearchProblem, declared: FittedModel) -> tuple[str, ...]:
    """A sentence for every driving input with whose sign inverted the declared model more than
    halves the sum of squares of the fit `declared`.
    """
    if is_near_noise_floor(declared):
        return ()
    found = []
    for k, name in enumerate(problem.model.input_names):
        if problem.model.units[name] in DRIVING and more_than_halves(
            _inverted(problem, k), declared
        ):
            found.append(
                f"The declared model fits far better with the sign of '{name}' inverted: one of"
                " motor and sensor is wired the other way round; give one of their signals a"
                " negative scale."
            )
    return tuple(found)


def _inverted(problem: SearchProblem, number: int) -> FittedModel:
    """The declared model fitted to the training runs with the sign of an input inverted, started at
    the values of its rows.
    """

    def turned(run: Run) -> Run:
        sign = np.ones(run.held_inputs.shape[1])
        sign[number] = -1.0
        return with_inputs(run, sign * run.held_inputs)

    train, whole = tuple(map(turned, problem.train)), tuple(map(turned, problem.whole))
    part = replace(problem, train=train, every_sample=train, whole=whole)
    start = declared_start(part)
    space = equation_space(part, start)
    values = start if space is None else first_fit(part, space, start)
    return fitted(part, (), values, None, POLISH, executor=part.executor)


# Standard deviations, of either sign, with which 95 % are found at 5 % of false alarms.
SEEN = float(np.sum(stats.norm.isf([FALSE_ALARM, MOST * FALSE_ALARM])))


@dataclass(frozen=True)
class Visible:
    """A parameter, the `effect` that it switches on (None: declared and free), and the smallest
    amount in its unit that the logs show; infinite where they show none. Of a limit, such as a
    largest voltage, it is the `largest` that shows, and NaN where none does.
    """

    effect: str | None
    parameter: str
    smallest: float
    largest: float | None = None


def visible_amounts(problem: SearchProblem, start: FittedModel) -> list[Visible]:
    """Smallest visible change of every free parameter, and amount of every effect that is searched
    for in its simplest form, in their units, at `start`, the declared model with its Jacobians.
    """
    declared = stacked_jacobian(start.fit)
    units = np.abs(slopes(start.fit.free, to_search(start.fit.free, start.fit.values)))
    found = [
        Visible(None, f.name, _smallest(declared[:, k] / units[k], np.delete(declared, k, axis=1)))
        for k, f in enumerate(start.fit.free)
    ]
    simplest: dict[str, Candidate] = {}
    for candidate in sorted(problem.candidates, key=lambda c: len(c.free)):
        if not candidate.is_declared_value:
            simplest.setdefault(candidate.key, candidate)
    most = REACH * float(np.sqrt(len(declared)))
    named = max(SEEN, float(np.sqrt(problem.material / (1.0 - problem.material) * len(declared))))

    def amounts(candidate: Candidate) -> list[Visible]:
        columns = response_columns(problem, start, candidate, candidate.shapes[0], most)
        seen = {} if columns is None else dict(zip(columns.free, columns.table.T, strict=True))
        rows = []
        for f in candidate.defining:
            smallest = _smallest(seen[f], declared, named) if f in seen else float("inf")
            largest = None
            if candidate.is_limit(f) and f.logarithmic:
                at = np.nan if columns is None else columns.limits.get(f.name, np.nan)
                largest = largest_limit(candidate.met_at(f), at, f.upper, smallest)
                smallest = float("inf")
            rows.append(Visible(candidate.key, f.name, smallest, largest))
        return rows

    amount = f"{len(simplest)} effects, each simulated at several amounts"
    for done, rows in enumerate(problem.executor.map(amounts, simplest.values())):
        if done % max(len(simplest) // 4, 1) == 0:
            problem.progress(
                f"predicting what {len(problem.train)} runs can show: {done} of {amount}"
            )
        found += rows
    return found


def largest_limit(met: float, at: float, upper: float, smallest: float) -> float:
    """The largest limit that shows, of a signal that reaches `met`: the response to a limit `at`
    some value stands out of the noise at the amount `smallest`, were it counted from `upper`; it
    grows with what is cut off, met - at. NaN where no limit above zero shows.
    """
    cut = (met - at) * smallest / (upper - at)
    return float(met - cut) if cut < met else float("nan")


def _smallest(column: FloatArray, others: FloatArray, by: float = SEEN) -> float:
    """The amount whose response, `column` [n] per unit, stands out of unit noise `by` so many
    standard deviations beside what `others` [n, k] can follow.
    """
    size = float(np.linalg.norm(projected_off(column[:, None], others)))
    least = np.sqrt(NOTHING) * float(np.linalg.norm(column))
    return by / size if size > least else float("inf")
