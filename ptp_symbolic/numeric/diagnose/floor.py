"""The noise floor: what a perfect model leaves, and whether a model leaves no more.

Rounding and noise of a signal, as the platform declares them or as its logs show; the colour of
that noise, where it is not declared, from what the model leaves; and the noise of the inputs,
carried to the outputs by the model itself.

The samples that a search needs: simulations end a step at each, which is most of their cost.

A search compares sets over runs with fewer samples, as long as the simulated signals at these stay
the same within the noise; what was found is fitted to every sample at last.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.left_over import Carried, left_over, with_every_residual
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    TUNING,
)
from ptp_symbolic.numeric.identify.evaluate import mean_squares
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.noise import (
    POLES,
    Noise,
    coloured_noise,
    hidden_from_differences,
    is_missed_at_rest,
    most_in_quietest,
)
from ptp_symbolic.numeric.identify.run import by_source

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Floor:
    """What a perfect model leaves in every signal [ny], in units of the rounding and noise that
    weights stand for: the `noise` of the signal, the `largest` that it may have at 95 % (noise of
    unknown colour), and what the inputs `carried` there.
    """

    noise: FloatArray
    largest: FloatArray
    carried: Carried

    @property
    def level(self) -> FloatArray:
        """Root mean square [ny] of all that a perfect model leaves."""
        return np.hypot(self.noise, self.carried.usual)

    @property
    def most(self) -> FloatArray:
        """The largest root mean square [ny] that may be noise."""
        return np.hypot(self.largest, self.carried.most)


def floor_of(task: Task, trial: Trial, carried: Carried) -> Floor:
    """The floor, with the colour of the noise as the residual of `trial` shows it, but no more than
    the differences of the measured signals and the quietest run leave room for, and what the inputs
    `carried`. Where more is left than noise of that colour, where what is left varies as no noise
    does (and not by that of the inputs), or where its slow part is not there while the model rests,
    model error has a colour: the floor is white then, as it is for a task whose noise is.
    """
    white = np.ones(len(trial.fit.runs[0].signals))
    if task.white:
        return Floor(white, white, carried)
    floor = Floor(*_of_its_colour(task, trial.fit, carried), carried)
    return floor if leaves_noise_alone(trial, floor) else Floor(white, white, carried)


@recorded()
def _of_its_colour(task: Task, fit: Fit, carried: Carried) -> tuple[FloatArray, FloatArray]:
    """The `noise` and the `largest` of a floor [ny], with the colour of the residual of a fit."""
    fit = with_every_residual(task, fit)
    runs = fit.runs
    rms, most = np.ones(len(runs[0].signals)), np.ones(len(runs[0].signals))
    squares = mean_squares(fit.evaluations, runs)
    hidden = most_hidden(task)
    usual = squares <= TUNING**2 * np.maximum(left_over(fit) ** 2, 1.0)
    for column, signal in enumerate(runs[0].signals):
        if signal not in task.declared_noise:
            series = [e.residual.reshape(r.measured.shape)[:, column] for r, e in fit.pairs()]
            measured = [run.measured[:, column] * run.weight[column] for run in runs]
            kept = np.flatnonzero(usual[:, column])
            parts = [series[k] for k in kept]
            noise = coloured_noise(parts, 1.0)
            doubted = not noise.steady or is_missed_at_rest(
                parts, [measured[k] - series[k] for k in kept], _slow_part(parts, noise), noise.pole
            )
            if doubted and np.hypot(1.0, carried.most[column]) <= ABOVE_NOISE:
                continue
            by_log = [[series[k] for k in log if usual[k, column]] for log in by_source(runs)]
            quiet = max(1.0, most_in_quietest([parts for parts in by_log if parts]))
            rms[column] = min(noise.rms, _with_hidden(noise.pole), quiet)
            most[column] = min(noise.most, hidden[column], quiet)
    return rms, most


def _slow_part(series: Sequence[FloatArray], noise: Noise) -> float:
    """Standard deviation of what residual `series` [n] hold beside white noise of 1, no more than
    `noise` would: a spectrum that is cut below tells slow noise too large.
    """
    left = float(np.mean(np.concatenate(series) ** 2)) if series else 1.0
    return float(np.sqrt(max(min(noise.rms**2, left) - 1.0, 0.0)))


def most_hidden(task: Task) -> FloatArray:
    """The largest root mean square [ny] that noise of any colour may have, over the noise that the
    differences of the signals show; 1 where it is declared.
    """
    signals = task.train[0].signals
    return np.array([1.0 if s in task.declared_noise else _with_hidden(POLES[-1]) for s in signals])


def _with_hidden(pole: float) -> float:
    """Root mean square of white noise of 1 and of what noise with a `pole` hides beside it."""
    return float(np.hypot(1.0, ABOVE_NOISE * hidden_from_differences(pole)))


def leaves_white_noise(trial: Trial, carried: Carried) -> bool:
    """Whether a trial leaves no more than rounding, white noise and what the inputs `carried`
    there; a search goes on where it does, whatever the colour of the residual.
    """
    return bool(np.all(left_over(trial.fit) <= ABOVE_NOISE * np.hypot(1.0, carried.most)))


def leaves_noise_alone(trial: Trial, floor: Floor) -> bool:
    """Whether the residual of a trial cannot be told from noise, in any signal."""
    return bool(np.all(left_over(trial.fit) <= ABOVE_NOISE * floor.most))


def leaves_unusual_noise(trial: Trial, floor: Floor) -> bool:
    """Whether a trial leaves more, in any signal, than noise of the colour that its residual shows
    and what the noise of the inputs seldom exceeds.
    """
    seldom = np.hypot(floor.noise, floor.carried.seldom)
    return bool(np.any(left_over(trial.fit) > ABOVE_NOISE * seldom))


def leaves_noise_of_inputs(trial: Trial, floor: Floor) -> bool:
    """Whether a trial leaves what is usual where the noise of the inputs leaves more than that of
    the signals. It lasts for seconds, so that some effect always follows a part of it, in every
    block of time: where nothing more is left without an effect, that shows no lack.
    """
    most_by_inputs = np.any(floor.carried.usual > floor.noise)
    return bool(most_by_inputs and np.all(left_over(trial.fit) <= ABOVE_NOISE * floor.level))
