"""A trial: the declared model with a set of candidates, fitted and judged."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.scores import mean_square
from ptp_symbolic.identify.coordinates import FreeParameter, to_search, to_values
from ptp_symbolic.identify.evaluate import Evaluation, Tolerance, evaluate
from ptp_symbolic.identify.fit import Effort, Fit, fit_parameters
from ptp_symbolic.identify.run import Run
from ptp_symbolic.runtime.model import Model

FloatArray = NDArray[np.float64]
Progress = Callable[[str], None]

NEARBY_COUNTS = 5.0
COARSE, FINE = Tolerance(1e-4, 1e-6), Tolerance(1e-5, 1e-7)
NEXT = Effort(10, 2e-3, COARSE, 0.5, secants=True)
LAST = Effort(10, 3e-4, FINE, secants=True)
SMOOTH = Effort(15, 1e-4, FINE)


@dataclass(frozen=True, eq=False)
class Task:
    """What stays the same through a diagnosis."""

    model: Model
    train: tuple[Run, ...]
    validate: tuple[Run, ...]
    free: tuple[FreeParameter, ...]
    fixed: Mapping[str, float]
    executor: Executor
    progress: Progress
    input_noise: tuple[float | None, ...]


@dataclass(frozen=True, eq=False)
class Trial:
    """One set of candidates with its fit, and the held-out runs once it was judged."""

    candidates: tuple[Candidate, ...]
    train: Fit
    validate: Fit | None = None

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the candidates, sorted."""
        return tuple(sorted(c.key for c in self.candidates))


def simulated(task: Task, fit: Fit, values: Mapping[str, float]) -> list[Evaluation]:
    """All runs of `fit` with `values` in place of its own, begun where its runs begin; coarse and
    without derivatives.
    """
    p, none = task.model.parameter_vector({**fit.values, **values}), np.zeros(0, dtype=np.int64)

    def one(pair: tuple[Run, FloatArray]) -> Evaluation:
        return evaluate(task.model, pair[0], p, pair[1], none, False, COARSE)

    return list(task.executor.map(one, zip(fit.runs, fit.z, strict=True)))


def squares(evaluations: Sequence[Evaluation]) -> float:
    """Sum of the squared residuals of all runs; infinite where one has failed."""
    return float(sum(np.inf if e.failed else e.residual @ e.residual for e in evaluations))


def held_out_cost(trial: Trial) -> float:
    """Mean square of the held-out residuals; infinite when not judged."""
    if trial.validate is None or trial.validate.failed:
        return np.inf
    return mean_square(trial.validate.pairs())


def restarted(fit: Fit) -> tuple[FreeParameter, ...]:
    """The free parameters of `fit`, started where it ended."""
    return tuple(
        replace(f, start=max(fit.values[f.name], 1e-6 * f.start) if f.logarithmic else
                float(np.clip(fit.values[f.name], f.lower, f.upper)))
        for f in fit.free
    )  # fmt: skip


def moved(fit: Fit, shift: FloatArray) -> list[FreeParameter]:
    """The free parameters of `fit`, started `shift` [nf] search coordinates from where it ended."""
    free = restarted(fit)
    ahead = to_values(free, to_search(free, fit.values) + shift)
    return [replace(f, start=ahead[f.name]) for f in free]


def fixed_values(task: Task, free: Sequence[FreeParameter]) -> dict[str, float]:
    """Values of the parameters that stay fixed while `free` are searched."""
    names = {name for f in free for name in (f.name, *f.tied)}
    return {name: value for name, value in task.fixed.items() if name not in names}


def refit(
    task: Task, free: Sequence[FreeParameter], z: Sequence[FloatArray], effort: Effort
) -> Fit:
    """Fit the train runs with `free` begun as given, every run begun at its z, the rest fixed."""
    fixed = fixed_values(task, free)
    return fit_parameters(task.model, task.train, free, fixed, z, effort, task.executor)


def continue_fits(task: Task, trials: Sequence[Trial], effort: Effort) -> list[Trial]:
    """Fit every trial on from where it ended, best first; a worse end is not taken."""
    continued = []
    for trial in trials:
        fit = refit(task, restarted(trial.train), trial.train.z, _suited(effort, trial))
        is_better = fit.cost <= 1.02 * trial.train.cost or not trial.train.is_differentiated
        kept = fit if is_better else trial.train
        continued.append(replace(trial, train=kept))
    return sorted(continued, key=lambda trial: trial.train.cost)


def _suited(effort: Effort, trial: Trial) -> Effort:
    """`effort` near the floor; far from it a coarse one is good enough."""
    near = trial.train.rms_counts() < NEARBY_COUNTS
    return effort if near else replace(effort, tolerance=COARSE)


def start_afresh(task: Task, trial: Trial, effort: Effort) -> Trial:
    """Fit `trial` anew: declared parameters at their table start, those of the effect where they
    are, unless they went to a bound; these begin where their search began.
    """
    began = {f.name: f for c in trial.candidates for f in c.starts[0]}
    free = []
    for f in restarted(trial.train):
        if f.table is not None:
            f = replace(f, start=f.table)
        elif f.name in began and not f.lower < f.start < f.upper:
            f = began[f.name]
        free.append(f)
    z = [np.zeros(len(run.unknowns)) for run in task.train]
    return replace(trial, train=refit(task, free, z, _suited(effort, trial)))
