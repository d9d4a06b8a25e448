"""Runs that nothing predicts to their end, cut into windows with initial states of their own.

The deviance of long runs is a staircase where friction breaks away: one start of motion a sample
late moves all that follows. In a window with a single one it is smooth, and longer windows identify
the parameters: the ends of fits over windows of growing length are the initial values for whole
runs (multiple shooting: Bock, 1983). Runs are parted, too, where samples are missing and it matters
what the inputs did meanwhile.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.data.latency import IntArray, after_lost, parted
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.fitted_model import (
    FittedModel,
    SearchProblem,
    continued,
    fitted,
    is_same_end,
)
from ptp_symbolic.numeric.diagnose.noise_floor import normalised_residual
from ptp_symbolic.numeric.identify.blocks import MANY_RUNS, weighted_median
from ptp_symbolic.numeric.identify.constants import (
    CYCLES,
    ITERATIONS,
    LENGTHS,
    MOST,
    SEARCH_PERIOD,
    SHORT,
    WIDE_STEP,
)
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate, mean_squares
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import has_linked, linked, starts_in_place
from ptp_symbolic.numeric.identify.least_squares import POLISH
from ptp_symbolic.numeric.identify.run import Run, samples_within, sizes, thinned, with_start
from ptp_symbolic.numeric.identify.windows import (
    cut,
    cut_where_errors_grow,
    multiplies_errors,
    piece_of,
    split_run,
)
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import InputSignal, sampled_signals, stack

FloatArray = NDArray[np.float64]


def parted_at_lost_samples(model: Model, run: Run, p: FloatArray) -> tuple[Run, ...]:
    """The run, or its parts where the signals depend on what the inputs did while samples were
    missing, at p [np]: held until the next sample, or changed right after the last one, they would
    move some signal by more than its noise.
    """
    gaps = after_lost(run.time)
    parts = parted(run.time, gaps) if gaps.size else []
    if len(parts) < 2 or not _matters(model, run, p, gaps):
        return (run,)
    return tuple(
        with_start(model, piece_of(run, part, number), underway=part.start > 0)
        for number, part in enumerate(parts, start=1)
    )


@recorded()
def _matters(model: Model, run: Run, p: FloatArray, gaps: IntArray) -> bool:
    """Whether inputs that change at the beginning of the gaps before the samples `gaps`, not at
    their ends, move a signal by more than its noise.
    """
    none = np.zeros(0, dtype=np.int64)
    at_end, at_begin = (
        evaluate(model, one, p, run.guess, none, False, Tolerance())
        for one in (run, _changed_at_begin(run, gaps))
    )
    if at_end.failed or at_begin.failed:
        return True
    moved = (at_end.residual - at_begin.residual).reshape(run.measured.shape)
    return bool(np.any(np.mean(moved**2, axis=0) > 1.0))


def _changed_at_begin(run: Run, gaps: IntArray) -> Run:
    """The run with inputs that change right after the last samples before the gaps."""
    signals = []
    for signal in sampled_signals(run.inputs):
        times, earlier = signal.breaks[:-1], signal.coefficients.copy()
        for gap in gaps:
            inside = (times >= run.time[gap - 1]) & (times < run.time[gap])
            after = max(0, int(np.searchsorted(times, run.time[gap], side="right")) - 1)
            earlier[inside] = [signal.coefficients[after, 0], 0.0, 0.0, 0.0]
        signals.append(InputSignal(signal.breaks, earlier))
    return replace(run, inputs=stack(signals))


def first_windows(windows: tuple[Run, ...], length: float, stretch: float) -> tuple[Run, ...]:
    """Windows of `length` s for a first fit: spread over the logs; where each determines the
    initial state of the next, in stretches of `stretch` s, and all of them where that is no longer
    than a window.
    """
    if not has_linked(windows):
        return spread_over(windows, length)
    count = round(stretch / length)
    if count <= 1:
        return windows
    series = [s[k : k + count] for s in linked(windows) for k in range(0, len(s), count)]
    return tuple(windows[k] for s in series[:: _apart(windows, length)] for k in s)


def spread_over(windows: tuple[Run, ...], length: float) -> tuple[Run, ...]:
    """Windows of `length` s spread over the logs, at least as many as a median needs, and more of
    shorter ones, in the same time.
    """
    return windows[:: _apart(windows, length)]


def _apart(windows: Sequence[Run], length: float) -> int:
    """Every which one to take of `windows` of `length` s."""
    return max(1, int(len(windows) * length / (MANY_RUNS * SHORT)))


def growing(problem: SearchProblem, *, few: bool = False) -> list[SearchProblem]:
    """The problem over windows of doubled lengths, up to 2 s, that are shorter than its runs; over
    all of them, or a `few`, in pairs where one determines the initial state of the other.
    """
    runs = [thinned(run, samples_within(run, SEARCH_PERIOD)) for run in problem.whole]
    longest = max(float(run.time[-1] - run.time[0]) for run in problem.train)
    every = {x: cut(problem.model, runs, x) for x in LENGTHS[:1:-1] if x < longest}
    windows = [first_windows(w, x, 2.0 * x) if few else w for x, w in every.items()]
    return [replace(problem, train=w, robust_below=np.inf) for w in windows]


def fitted_through(
    parts: Sequence[SearchProblem], candidates: Sequence[Candidate], values: Mapping[str, float]
) -> Mapping[str, float]:
    """Values of a set fitted to the windows of one of `parts` after the other, from `values`."""
    for part in parts:
        values = fitted_to_windows(part, candidates, values).values
    return values


def fitted_to_windows(
    part: SearchProblem, candidates: Sequence[Candidate], values: Mapping[str, float]
) -> FittedModel:
    """A set fitted to windows from `values`."""
    trial = settled(part, fitted(part, candidates, values, None), None, brief=True)
    return continued(part, trial, POLISH, secants=WIDE_STEP)


def settled(
    problem: SearchProblem, trial: FittedModel, executor: Executor | None, *, brief: bool = False
) -> FittedModel:
    """The trial fitted on until some iterations more change next to nothing, the places of the
    gears estimated anew each time: a window that began on the wrong side of a gap holds the others
    back. `brief` is that of `starts_in_place`.
    """
    for _ in range(CYCLES):
        z = starts_of(trial, executor, brief=brief)
        better = continued(problem, trial, ITERATIONS, executor=executor, z=z)
        if is_same_end(better, trial):
            break
        trial = better
    return trial


def starts_of(
    trial: FittedModel, executor: Executor | None, *, brief: bool = False
) -> list[FloatArray]:
    """Start unknowns, each [nz], of the runs of a trial with what is hidden at their start in place
    (see `starts_in_place`).
    """
    fit = trial.fit
    usual = _usual_square(trial, _squares(trial))
    return starts_in_place(
        fit.model, fit.runs, fit.values, fit.z, fit.tolerance, executor, brief=brief, usual=usual
    )


def shares_of_usual(trial: FittedModel) -> FloatArray:
    """Mean square residual [n] of every run of a trial, over their median."""
    square = _squares(trial)
    return square / max(_usual_square(trial, square), 1e-300)


def _squares(trial: FittedModel) -> FloatArray:
    fit = trial.fit
    return np.asarray(mean_squares(fit.evaluations, fit.runs).mean(axis=1), dtype=np.float64)


def _usual_square(trial: FittedModel, square: FloatArray) -> float:
    return float(weighted_median(square[:, None], sizes(trial.fit.runs))[0])


CUT = "runs that multiply small errors are cut into windows"


def in_windows(problem: SearchProblem, declared: FittedModel) -> SearchProblem:
    """The problem with runs cut into windows where the fitted model amplifies errors until nothing
    can be predicted (see `cut_where_errors_grow`).
    """
    model, noise = problem.model, problem.input_noise
    p = model.parameter_vector(declared.values)
    left = np.sqrt(mean_squares(declared.fit.evaluations, problem.train))
    train = cut_where_errors_grow(
        model, problem.every_sample, declared.fit.z, left, p, noise, problem.executor
    )
    if len(train) == len(problem.train):
        return problem
    fewer = dict(zip(problem.every_sample, problem.train, strict=True))
    problem.progress(CUT)
    return replace(problem, every_sample=train, train=tuple(fewer.get(run, run) for run in train))


def validation_in_windows(problem: SearchProblem, declared: FittedModel) -> SearchProblem:
    """The problem with its validation runs cut as training runs would be, whatever their
    residual.
    """
    model, runs = problem.model, problem.validate
    p, starts = model.parameter_vector(declared.values), [run.guess for run in runs]
    left = np.zeros((len(runs), len(problem.train[0].signals)))
    cut = cut_where_errors_grow(model, runs, starts, left, p, problem.input_noise, problem.executor)
    return replace(problem, validate=cut)


def parted_problem(problem: SearchProblem, trial: FittedModel) -> SearchProblem:
    """The problem with training and validation runs parted where samples are missing, and the
    signals depend on what the inputs did meanwhile (see `parted_at_lost_samples`), at the values of
    a trial.
    """
    p = problem.model.parameter_vector(trial.values)

    def parts_of(run: Run, _z: FloatArray) -> tuple[Run, ...]:
        return parted_at_lost_samples(problem.model, run, p)

    return _in_parts(problem, trial, parts_of, "runs are parted where samples are missing")


def more_than_halves(short: FittedModel, trial: FittedModel) -> bool:
    """Whether the mean square residual of a trial in windows is less than half of that over whole
    runs: where it is not, something else is missing, which windows hide.
    """
    left, whole = (float(np.sum(normalised_residual(t.fit) ** 2)) for t in (short, trial))
    return left <= (1.0 - MOST) * whole


def in_windows_of(problem: SearchProblem, trial: FittedModel) -> SearchProblem:
    """The problem with training and validation runs cut into windows where the model of a trial
    multiplies an error of the start tenfold (see `window_length`, which is the same test of the
    declared model): a machine that cogs, or leans, runs on from the edge of a valley into one or
    the other, and its fit has an end for each of them.
    """
    p = problem.model.parameter_vector(trial.values)

    def windows_of(run: Run, z: FloatArray) -> tuple[Run, ...]:
        multiplies = multiplies_errors(problem.model, run, p, z)
        return split_run(problem.model, run, SHORT) if multiplies else (run,)

    return _in_parts(problem, trial, windows_of, CUT)


def _in_parts(
    problem: SearchProblem,
    trial: FittedModel,
    parts_of: Callable[[Run, FloatArray], tuple[Run, ...]],
    said: str,
) -> SearchProblem:
    """The problem with the parts of every run, by the run and its start; as it is where all
    training runs stay whole, else that is `said`.
    """
    every = list(problem.executor.map(parts_of, problem.every_sample, trial.fit.z))
    if all(len(parts) == 1 for parts in every):
        return problem
    problem.progress(said)
    fewer = [
        (run,) if len(parts) == 1 else parts
        for run, parts in zip(problem.train, every, strict=True)
    ]
    starts = [run.guess for run in problem.validate]
    validate = problem.executor.map(parts_of, problem.validate, starts)
    train = tuple(part for parts in fewer for part in parts)
    return replace(
        problem,
        every_sample=tuple(part for parts in every for part in parts),
        train=train,
        few=problem.few if problem.windows else spread_over(train, SHORT),
        validate=tuple(part for parts in validate for part in parts),
    )
