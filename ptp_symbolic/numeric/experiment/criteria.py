"""What an experiment is worth: the separation of rival models, or the precision of parameters.

Separation: one model is taken for the machine, the other is fitted to what it would show, with all
that the logs so far know of it; by how much more it leaves than the first tells them apart
(T-optimality: Atkinson and Fedorov, 1975). Blocks of time with far more than noise count linearly,
as in a diagnosis: a run that tells by a few bounces alone tells little. Precision: the information
about parameters (D- and c-optimality).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.experiment.contender import (
    Contender,
    Refit,
    as_it_is,
    information,
    log_information,
    refitted,
)
from ptp_symbolic.numeric.experiment.machine import SCENARIOS, Conditions, Scenario, logged, play
from ptp_symbolic.numeric.identify.constants import TUNING
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.robust_loss import huber_loss
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]
Worth = Callable[[FloatArray], float]

BLOCK = 0.5  # s; of time that is looked at as one
SEARCHING = 3  # iterations of a refit while inputs are searched for


@dataclass(frozen=True, eq=False)
class Comparison:
    """A `run` of one model as it would be logged, the `refit` of another to it, and by how much
    that leaves more, in squared sigmas: in the run and in the logs so far.
    """

    run: Run
    refit: Refit | None
    more: float


def compared(
    machine: Contender,
    other: Contender,
    conditions: Conditions,
    wave: FloatArray,
    how: Scenario,
    iterations: int,
) -> Comparison | None:
    """`other`, refitted to what `machine` shows along `wave` [k, nu] in a scenario and to the logs
    so far, against the machine itself; None where the limits are not kept.
    """
    true = how.machine(machine)
    played = play(true, conditions, wave, how.place)
    if played is None:
        return None
    run = logged(true, conditions, played, how.seed)
    own, found = as_it_is(true, run, how.place), refitted(other, run, how.place, iterations)
    if own is None or found is None:
        return Comparison(run, found, 0.0)
    left = robust_square(found.evaluation, run) + found.logs
    return Comparison(run, found, max(0.0, left - robust_square(own, run)))


def robust_square(evaluation: Evaluation, run: Run) -> float:
    """Expected sum of squares in squared sigmas, that of the noise included, of residuals that are
    predicted without it (Huber's loss of the mean squares of blocks of time).
    """
    table = evaluation.residual.reshape(run.measured.shape)
    blocks = max(1, round(float(run.time[-1] - run.time[0]) / BLOCK))
    total = 0.0
    for part in np.array_split(table, blocks):
        squares = 1.0 + np.mean(part**2, axis=0)
        total += len(part) * float(np.sum(huber_loss(squares, np.full(len(squares), TUNING**2))))
    return total


def least_separation(
    contenders: Sequence[Contender],
    conditions: Conditions,
    wave: FloatArray,
    iterations: int = SEARCHING,
    thorough: bool = False,
) -> float:
    """Sigmas by which the nearest two contenders are apart after the run `wave` [k, nu], those of
    the logs so far not counted, in the scenario that tells least; -inf where it does not keep to
    the limits.

    The earlier of two is taken for the machine, in two scenarios; to be `thorough` each in turn, in
    all.
    """
    pairs = permutations if thorough else combinations
    least = np.inf
    for machine, other in pairs(contenders, 2):
        for how in SCENARIOS if thorough else SCENARIOS[:2]:
            found = compared(machine, other, conditions, wave, how, iterations)
            if found is None:
                return -np.inf
            least = min(least, float(np.sqrt(found.more)))
    return least


def precision(
    machine: Contender, wanted: Sequence[str], conditions: Conditions, wave: FloatArray
) -> float:
    """Mean logarithm of the precision (1/sd in search coordinates) of the parameters `wanted`
    after the run `wave` [k, nu] and the logs so far; -inf where it does not keep to the limits.
    """
    played = play(machine, conditions, wave)
    if played is None:
        return -np.inf
    known = information(machine, logged(machine, conditions, played), 0.0)
    if known is None:
        return -np.inf
    names = [f.name for f in machine.free]
    return 0.5 * log_information(known, [names.index(name) for name in wanted]) / len(wanted)
