"""Effects that act where more than noise is left, found in the torques along the measured motion.

A torque that the model lacks is integrated twice in an angle: beside a remainder, simulations see
its slow part alone, and effects gain in them by the drift they follow. The rows of the equation
space see it as it is. Where these show all of a set and no gear leaves its face, the set grows
there by what gains materially and clearly on blocks left out. Its values are those of the rows with
the shortest windows that noise allows (inverse dynamic identification: Gautier and Khalil, 1990),
as are their intervals.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.confirm import why_unconfirmed
from ptp_symbolic.numeric.diagnose.declared_rows import equation_space, possible
from ptp_symbolic.numeric.diagnose.findings import is_earned
from ptp_symbolic.numeric.diagnose.gain import Gain
from ptp_symbolic.numeric.diagnose.proposals import Proposals, start_of
from ptp_symbolic.numeric.diagnose.subsets import (
    Regression,
    exchanges,
    gain_along_motion,
    larger_sets,
)
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, all_free, tolerance_for
from ptp_symbolic.numeric.identify.constants import (
    GAIN,
    LARGEST,
    POLISH,
    ROUGH,
    SHARP,
    SHORTEST_HALF_WIDTHS,
    TRIED,
)
from ptp_symbolic.numeric.identify.coordinates import slopes, to_search
from ptp_symbolic.numeric.identify.equation_fit import fit_equations, linearised
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.fit import Effort, Fit, fit_parameters


@dataclass(frozen=True, eq=False)
class AlongMotion:
    """A set by the rows: `trial` is the training runs simulated with its values, `fit` that of the
    rows, `gains` [candidates] is what each gains there, and `alike` are by key those of other
    candidates that predict the rows as well in its place.
    """

    trial: Trial
    fit: Fit
    gains: tuple[Gain, ...]
    alike: dict[str, tuple[str, ...]]


def grown_along_motion(task: Task, found: Proposals, trial: Trial) -> AlongMotion | None:
    """The set of a trial with what else gains along the measured motion; None where nothing does,
    or where the rows do not show all of the set.
    """
    rows = found.regression
    if rows is None or len(task.model.contacts):
        return None
    if not set(trial.keys) <= {s.candidate.key for s in rows.signatures}:
        return None
    space = equation_space(task, found.start, SHORTEST_HALF_WIDTHS)
    if space is None:
        return None
    motion = _Motion(task, rows, space, found.start)
    candidates, best = trial.candidates, None
    while len(candidates) < len(trial.candidates) + LARGEST:
        tried = larger_sets(rows, candidates)[:TRIED]
        confirmed = (motion.confirmed(larger, candidates) for larger in tried)
        grown = next((end for end in confirmed if end is not None), None)
        if grown is None:
            break
        candidates, best = grown[0], grown
    if best is None:
        return None
    alike = {c.key: motion.alike(candidates, c) for c in candidates}
    return AlongMotion(_simulated(task, candidates, best[1]), best[1], best[2], alike)


@dataclass(frozen=True, eq=False)
class _Motion:
    """The `rows` that sets are compared in, those of `space` that they are fitted to, and all
    parameters at the start of both.
    """

    task: Task
    rows: Regression
    space: EquationSpace
    start: Mapping[str, float]

    def confirmed(
        self, candidates: tuple[Candidate, ...], known: Sequence[Candidate]
    ) -> tuple[tuple[Candidate, ...], Fit, tuple[Gain, ...]] | None:
        """A set, its fit to the rows and what its candidates gain; None unless each of them gains
        materially and clearly, and those not `known` stand the rest of what a name asks for.
        """
        gains = [self.earns(candidates, candidate) for candidate in candidates]
        earned = tuple(gain for gain in gains if gain is not None)
        if len(earned) < len(gains):
            return None
        fit = self.fitted(candidates)
        fresh = [c for c in candidates if c not in known]
        if any(why_unconfirmed(fit, c, leaves_noise=False) for c in fresh):
            return None
        return candidates, fit, earned

    def earns(self, candidates: Sequence[Candidate], candidate: Candidate) -> Gain | None:
        """What a candidate of a set gains, if that is material and clear, whatever frequencies were
        compared; None if not.
        """
        smaller = [c for c in candidates if c is not candidate and candidate.key not in c.brings]
        found = gain_along_motion(self.rows, candidates, smaller)
        tests = len(self.task.candidates) * candidate.lines
        return found if found and is_earned(found, found.chance, tests) else None

    def alike(self, candidates: Sequence[Candidate], member: Candidate) -> tuple[str, ...]:
        """Keys of those that predict no worse in the place of a member of a set, and beside which
        that member earns nothing any more.
        """
        own, found = {c.key for c in candidates}, set()
        for other in exchanges(self.rows, candidates):
            keys = {c.key for c in other}
            if member.key not in keys and self.earns((*other, member), member) is None:
                found |= keys - own
        return tuple(sorted(found))

    def fitted(self, candidates: Sequence[Candidate]) -> Fit:
        """A set fitted to the rows, as a fit whose runs are those of each equation along each
        run.
        """
        task, space = self.task, self.space
        begun = start_of(task, self.rows, candidates, self.start)
        free = all_free(task, candidates, begun)
        values = fit_equations(space, free, begun, POLISH, task.executor)
        values = possible(task, free, {**begun, **values})
        here = {f.name: values[f.name] for f in free}
        at = linearised(space, free, values, here, task.executor)
        root = np.sqrt(at.weight)
        residual = at.rows * root
        table = at.jacobian * root[:, None] * slopes(free, to_search(free, values))
        equation, run, time = space.labels()
        runs, evaluations = [], []
        for number, source in enumerate(space.runs):
            for e in np.unique(equation):
                own = np.flatnonzero((run == number) & (equation == e))
                if own.size:
                    nothing = np.zeros((own.size, 0))
                    runs.append(replace(source, time=time[own], measured=residual[own, None]))
                    evaluations.append(Evaluation(residual[own], table[own], nothing))
        cost = float(residual @ residual)
        return Fit(task.model, tuple(runs), free, values, (), cost, tuple(evaluations))


def _simulated(task: Task, candidates: Sequence[Candidate], fit: Fit) -> Trial:
    """The training runs simulated with the values of a fit, nothing but their starts fitted."""
    effort = Effort(POLISH, GAIN * ROUGH, tolerance_for(task, SHARP))
    values, run = dict(fit.values), task.executor
    starts = fit_parameters(task.model, task.every_sample, (), values, None, effort, run)
    return Trial(tuple(candidates), replace(starts, free=fit.free))
