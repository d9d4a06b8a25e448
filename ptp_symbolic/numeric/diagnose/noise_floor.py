"""The noise floor: the residual of a perfect model, and whether that of a fit is no larger.

It consists of rounding and noise of each signal, as the platform declares them or as its logs show;
of the autocorrelation of that noise, where it is not declared, by the residual; and of the noise of
the inputs, propagated to the outputs by the model itself.

A search compares sets over runs with fewer samples, as long as the simulated signals at these stay
the same within the noise, for simulations end a step at each; what was found is fitted to every
sample at last.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import special, stats
from scipy.optimize import brentq

from ptp_symbolic.numeric.diagnose.fitted_model import (
    SHARP,
    FittedModel,
    SearchProblem,
    continued,
    fitted,
    simulated,
    tolerance_for,
)
from ptp_symbolic.numeric.identify.blocks import (
    MANY_RUNS,
    huber_loss,
    trimmed_mean,
    weighted_median,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    FALSE_ALARM,
    LITTLE,
    MATERIAL,
    NOTHING,
    ROUGH,
    SEARCH_PERIOD,
    STEP,
    TEST_ALARM,
    TUNING,
)
from ptp_symbolic.numeric.identify.evaluate import (
    Evaluation,
    Tolerance,
    evaluate,
    mean_squares,
    simulated_signals,
)
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.least_squares import POLISH
from ptp_symbolic.numeric.identify.noise import (
    POLES,
    Noise,
    coloured_noise,
    hidden_from_differences,
    is_missed_at_rest,
    most_in_quietest,
)
from ptp_symbolic.numeric.identify.run import Run, by_source, samples_within, sizes, thinned
from ptp_symbolic.numeric.identify.windows import replayed_squares
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PropagatedNoise:
    """The propagated noise of the inputs in every signal [ny], over the noise of that: its median
    root mean square, and those that are exceeded at FALSE_ALARM (`rare`) and at TEST_ALARM (`most`;
    see `bound_of`).
    """

    median: FloatArray
    rare: FloatArray
    most: FloatArray


def normalised_residual(fit: Fit) -> FloatArray:
    """Robust root mean square [ny] of the residual of a fit in every signal, over its noise."""
    return np.sqrt(_robust_mean(mean_squares(fit.evaluations, fit.runs), sizes(fit.runs)))


def _robust_mean(squares: FloatArray, size: FloatArray) -> FloatArray:
    """One mean square per signal [ny] of those of all runs [runs, ny], with so many samples [runs].

    Of many windows the worst are left out, a MATERIAL share of the samples, for one in twenty
    begins on the wrong side of a rest; of few runs, those far worse than usual count linearly.
    """
    if not np.all(np.isfinite(squares)):
        return np.full(squares.shape[1], np.inf)
    if len(squares) >= MANY_RUNS:
        return trimmed_mean(squares, size, MATERIAL)
    usual = weighted_median(squares, size)
    bounded = huber_loss(squares, TUNING**2 * np.maximum(usual, 1.0))
    return np.asarray(size @ bounded / size.sum())


@recorded(PropagatedNoise)
def propagated_input_noise(problem: SearchProblem, fit: Fit) -> PropagatedNoise:
    """The propagated noise of the inputs, by the model of `fit`.

    All runs are replayed some times, and what that adds to the noise of their signals is summed up
    as a residual is. A replay that cannot be simulated counts as the median of its run, and a run
    without any is left out.
    """
    p = problem.model.parameter_vector(dict(fit.values))
    runs = problem.every_sample if is_thinned(problem, fit) else fit.runs
    every = replayed_squares(problem.model, runs, fit.z, p, problem.input_noise, problem.executor)
    simulated, size = _simulated(every, sizes(runs))
    left = np.array([_robust_mean(1.0 + squares, size) - 1.0 for squares in simulated])
    left = np.maximum(left, NOTHING)
    bounds = [[bound_of(c, chance) for c in left.T] for chance in (FALSE_ALARM, TEST_ALARM)]
    return PropagatedNoise(np.sqrt(np.median(left, axis=0)), *np.sqrt(bounds))


def _simulated(squares: FloatArray, size: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean squares [replays, k, ny] of the runs of which any replay was simulated, from those of
    all runs [replays, runs, ny], nan where one was not; and their `size` [k].
    """
    known = np.ma.masked_invalid(squares)
    medians = np.ma.median(known, axis=0)
    told = ~np.any(np.ma.getmaskarray(medians), axis=1)
    if not told.any():
        return np.zeros_like(squares), size
    filled = np.where(np.ma.getmaskarray(known), np.ma.getdata(medians), squares)
    return filled[:, told], size[told]


def bound_of(squares: FloatArray, chance: float) -> float:
    """The bound that a mean square exceeds with a `chance`, from some [n] that are like it; 99 %
    bounds from eight replays, which give the scale only roughly, were exceeded by 2 to 3 %.

    It is a sum of squares of one normal number or more: the variance of its logarithm gives how
    many, the mean of that its scale (Bartlett and Kendall, 1946), and both are known from n alone.
    A replay that sticks elsewhere counts little in a logarithm.
    """

    def spread(log_freedom: float) -> float:
        return float(special.polygamma(1, 0.5 * np.exp(log_freedom)))

    logarithms, many = np.log(squares), np.log(1.0 / NOTHING)
    variance = float(np.clip(np.var(logarithms, ddof=1), spread(many), spread(0.0)))
    freedom = np.exp(brentq(lambda log: spread(log) - variance, 0.0, many))
    scale = np.exp(np.mean(logarithms) - special.digamma(0.5 * freedom)) * 0.5 * freedom
    return float(scale * stats.f.isf(chance, freedom, len(squares) * freedom))


def with_fewer_samples(problem: SearchProblem, values: Mapping[str, float]) -> SearchProblem:
    """The problem with training runs of fewer samples, as far as these change none of their signals
    by more than LITTLE of the squared noise, as the model simulates them with `values` of all
    parameters. Inputs between two samples count by their average: a current that follows them at
    once shows the difference, and keeps its samples.
    """
    p, tolerance = problem.model.parameter_vector(dict(values)), tolerance_for(problem, ROUGH)

    def fewer(run: Run) -> Run:
        every = _samples_apart(problem.model, run, p, tolerance)
        return run if every == 1 else thinned(run, every)

    return replace(problem, train=tuple(problem.executor.map(fewer, problem.every_sample)))


@recorded()
def _samples_apart(model: Model, run: Run, p: FloatArray, tolerance: Tolerance) -> int:
    """Every which sample of a run is enough for `with_fewer_samples`, at p [np]."""
    none = np.zeros(0, dtype=np.int64)

    def of(run: Run) -> Evaluation:
        return evaluate(model, run, p, run.guess, none, False, tolerance)

    every = samples_within(run, SEARCH_PERIOD)
    if every == 1 or (whole := of(run)).failed:
        return 1
    while every > 1:
        part = thinned(run, every)
        e = of(part)
        change = simulated_signals(part, e) - simulated_signals(run, whole)[::every]
        if not e.failed and np.all(np.mean((change * run.weight) ** 2, axis=0) <= LITTLE):
            return every
        every //= 2
    return 1


def is_thinned(problem: SearchProblem, fit: Fit) -> bool:
    """Whether `fit` is of training runs with fewer samples than they have."""
    return fit.runs == problem.train and problem.train != problem.every_sample


def with_every_residual(problem: SearchProblem, fit: Fit) -> Fit:
    """`fit` with the residuals of every sample of the training runs, without Jacobians."""
    if not is_thinned(problem, fit):
        return fit
    whole = replace(fit, runs=problem.every_sample)
    return replace(whole, evaluations=tuple(simulated(problem, whole, {}, problem.executor)))


def fitted_to_every_sample(
    problem: SearchProblem, trials: Sequence[FittedModel]
) -> list[FittedModel]:
    """Trials of the search fitted on to every sample of the training runs, sharply at last; all of
    them as they are where no run has fewer samples, or where one trial cannot be simulated.
    """
    whole, run = replace(problem, train=problem.every_sample), problem.executor
    begun = [
        fitted(whole, t.candidates, t.values, t.fit.z, executor=run)
        for t in trials
        if is_thinned(problem, t.fit)
    ]
    if len(begun) < len(trials) or any(t.fit.failed for t in begun):
        return list(trials)
    rough = [continued(whole, t, POLISH, executor=run) for t in begun]
    return [continued(whole, t, POLISH, SHARP, STEP, run) for t in rough]


@dataclass(frozen=True, eq=False)
class NoiseFloor:
    """The residual of a perfect model in every signal [ny], in units of the rounding and noise in
    its weight: the `noise` of the signal, the `largest` that it may have at 95 % (its
    autocorrelation is not known), and the noise `propagated` there from the inputs.
    """

    noise: FloatArray
    largest: FloatArray
    propagated: PropagatedNoise

    @property
    def level(self) -> FloatArray:
        """Root mean square [ny] of the residual of a perfect model."""
        return np.hypot(self.noise, self.propagated.median)

    @property
    def most(self) -> FloatArray:
        """The largest root mean square [ny] that may be noise."""
        return np.hypot(self.largest, self.propagated.most)


def noise_floor_of(
    problem: SearchProblem, trial: FittedModel, propagated: PropagatedNoise
) -> NoiseFloor:
    """The noise floor, with the autocorrelation of the residual of `trial`, but no more than the
    differences of the measured signals and the quietest run allow, and with the noise `propagated`
    from the inputs. Where the residual exceeds such noise, where its size varies as that of no
    noise (nor by the inputs), or where its slow part is absent while the model rests, it is model
    error: the floor is white then, as it is for a problem whose noise is.
    """
    white = np.ones(len(trial.fit.runs[0].signals))
    if problem.white:
        return NoiseFloor(white, white, propagated)
    floor = NoiseFloor(*_of_its_colour(problem, trial.fit, propagated), propagated)
    return floor if leaves_noise_alone(trial, floor) else NoiseFloor(white, white, propagated)


@recorded()
def _of_its_colour(
    problem: SearchProblem, fit: Fit, propagated: PropagatedNoise
) -> tuple[FloatArray, FloatArray]:
    """The `noise` and the `largest` of a noise floor [ny], with the autocorrelation of the residual
    of a fit.
    """
    fit = with_every_residual(problem, fit)
    runs = fit.runs
    rms, most = np.ones(len(runs[0].signals)), np.ones(len(runs[0].signals))
    squares = mean_squares(fit.evaluations, runs)
    hidden = most_hidden(problem)
    usual = squares <= TUNING**2 * np.maximum(normalised_residual(fit) ** 2, 1.0)
    for column, signal in enumerate(runs[0].signals):
        if signal not in problem.declared_noise:
            series = [e.residual.reshape(r.measured.shape)[:, column] for r, e in fit.pairs()]
            measured = [run.measured[:, column] * run.weight[column] for run in runs]
            kept = np.flatnonzero(usual[:, column])
            parts = [series[k] for k in kept]
            noise = coloured_noise(parts, 1.0)
            doubted = not noise.steady or is_missed_at_rest(
                parts, [measured[k] - series[k] for k in kept], _slow_part(parts, noise), noise.pole
            )
            if doubted and np.hypot(1.0, propagated.most[column]) <= ABOVE_NOISE:
                continue
            by_log = [[series[k] for k in log if usual[k, column]] for log in by_source(runs)]
            quiet = max(1.0, most_in_quietest([parts for parts in by_log if parts]))
            rms[column] = min(noise.rms, _with_hidden(noise.pole), quiet)
            most[column] = min(noise.most, hidden[column], quiet)
    return rms, most


def _slow_part(series: Sequence[FloatArray], noise: Noise) -> float:
    """Standard deviation of what residual `series` [n] hold beside white noise of 1, no more than
    `noise` would: a spectrum that is cut below overestimates slow noise.
    """
    left = float(np.mean(np.concatenate(series) ** 2)) if series else 1.0
    return float(np.sqrt(max(min(noise.rms**2, left) - 1.0, 0.0)))


def most_hidden(problem: SearchProblem) -> FloatArray:
    """The largest root mean square [ny] that noise of any colour may have, over the noise that the
    differences of the signals show; 1 where it is declared.
    """
    signals = problem.train[0].signals
    return np.array(
        [1.0 if s in problem.declared_noise else _with_hidden(POLES[-1]) for s in signals]
    )


def _with_hidden(pole: float) -> float:
    """Root mean square of white noise of 1 and of what noise with a `pole` hides beside it."""
    return float(np.hypot(1.0, ABOVE_NOISE * hidden_from_differences(pole)))


def leaves_white_noise(trial: FittedModel, propagated: PropagatedNoise) -> bool:
    """Whether the residual of a trial is within rounding, white noise and the noise `propagated`
    from the inputs; a search goes on where it is not, whatever its autocorrelation.
    """
    return bool(
        np.all(normalised_residual(trial.fit) <= ABOVE_NOISE * np.hypot(1.0, propagated.most))
    )


def leaves_noise_alone(trial: FittedModel, floor: NoiseFloor) -> bool:
    """Whether the residual of a trial is indistinguishable from noise, in all signals."""
    return bool(np.all(normalised_residual(trial.fit) <= ABOVE_NOISE * floor.most))


def exceeds_usual_noise(trial: FittedModel, floor: NoiseFloor) -> bool:
    """Whether the residual of a trial exceeds, in any signal, noise of its autocorrelation with the
    propagated noise of the inputs that is exceeded at FALSE_ALARM.
    """
    seldom = np.hypot(floor.noise, floor.propagated.rare)
    return bool(np.any(normalised_residual(trial.fit) > ABOVE_NOISE * seldom))


def is_within_noise_of_inputs(trial: FittedModel, floor: NoiseFloor) -> bool:
    """Whether the residual of a trial is within the usual noise, where that of the inputs,
    propagated, exceeds that of the signals. It lasts for seconds, so that some effect always
    follows a part of it, in every block of time: where the residual is no larger without an effect,
    nothing is missing.
    """
    most_by_inputs = np.any(floor.propagated.median > floor.noise)
    return bool(
        most_by_inputs and np.all(normalised_residual(trial.fit) <= ABOVE_NOISE * floor.level)
    )
