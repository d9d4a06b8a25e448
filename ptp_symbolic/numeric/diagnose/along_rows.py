"""Effects beside a residual above the noise floor, found in the torques along the measured motion.

A torque that the model lacks is integrated twice in an angle: beside an unexplained residual,
simulations see its slow part alone, and effects gain in them by the drift they follow. The
weak-form regression rows see it as it is, unless a gear crosses a gap. There, in rows with the
shortest windows that noise allows, a set is extended by effects whose gain on blocks left out is
material and significant: longer windows average away what is fast, such as a delay. Its values and
their intervals are those of a fit to the same rows (inverse dynamic identification: Gautier and
Khalil, 1990).
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import (
    Candidate,
    with_what_needs_it,
    without_member,
)
from ptp_symbolic.numeric.diagnose.confirm import (
    contradicts_its_law,
    is_moved_by_inputs,
    why_unconfirmed,
)
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, SearchProblem, all_free
from ptp_symbolic.numeric.diagnose.gain import Gain, compared, simulated_freely
from ptp_symbolic.numeric.diagnose.proposals import (
    ProposedSets,
    equation_space,
    in_rows_of,
    possible,
    start_of,
)
from ptp_symbolic.numeric.diagnose.regression import (
    Regression,
    block_numbers,
    exchanges,
    gain_along_motion,
    larger_sets,
)
from ptp_symbolic.numeric.diagnose.stepwise import looked_at
from ptp_symbolic.numeric.identify.constants import FAR, LARGEST, TRIED
from ptp_symbolic.numeric.identify.coordinates import slopes, to_search
from ptp_symbolic.numeric.identify.equation_fit import fit_equations, linearised, robust_scale
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.least_squares import POLISH
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class AlongMotion:
    """A set that has grown along the motion: `fit` is that to the rows, `trial` the training runs
    simulated with its values. By the key of each candidate, `gains` is what it gains in the rows,
    and `alternatives` are the candidates beside which it gains nothing, and which predict as well.
    """

    trial: FittedModel
    fit: Fit
    gains: Mapping[str, Gain]
    alternatives: Mapping[str, tuple[str, ...]]


def extended_along_motion(
    problem: SearchProblem,
    found: ProposedSets,
    trial: FittedModel,
    runs: Sequence[Run],
    contradicting: Collection[str] = (),
) -> AlongMotion | None:
    """The set of a trial with what else gains along the measured motion, simulated on the training
    `runs`; None where nothing does, or where the rows do not show all of the set.

    Declared values are not tried: beside an unexplained residual they are aliased with many
    effects. The extended set reduces the residual torque along the validation runs by a material
    share. Torques depend on the rate as their laws say, within loose limits (see
    `contradicts_its_law`). Those whose keys are `contradicting` did not in a smaller set, which may
    have lacked more: they are held to their laws in the extended one.
    """
    if found.regression is None or len(problem.model.contacts):
        return None
    space = equation_space(problem, found.start, shortest=True)
    if space is None:
        return None
    candidates = trial.candidates
    rows = in_rows_of(problem, space, found.start, candidates)
    if not set(trial.keys) <= {s.candidate.key for s in rows.signatures}:
        return None
    motion = _Motion(problem, space, rows, found.start, contradicting)
    while len(candidates) < len(trial.candidates) + LARGEST:
        effects = [
            s for s in larger_sets(rows, candidates) if not any(c.is_declared_value for c in s)
        ]
        simple = (motion.in_simplest_forms(s, candidates) for s in effects[:TRIED])
        grown = next((s for s in simple if motion.is_confirmed(s)), None)
        if grown is None:
            break
        candidates = grown
    if len(candidates) == len(trial.candidates):
        return None
    fit = motion.fitted(candidates)
    if not motion.predicts_better(fit, motion.fitted(trial.candidates)):
        return None
    final = FittedModel(
        candidates, replace(simulated_freely(problem, runs, fit.values), free=fit.free)
    )
    if final.fit.failed or not is_moved_by_inputs(problem, final):
        return None
    gains = {c.key: gain for c in candidates if (gain := motion.gain(candidates, c)) is not None}
    return AlongMotion(final, fit, gains, motion.alternatives(candidates))


@dataclass(frozen=True, eq=False)
class _Motion:
    """The `space` whose rows sets are fitted to, those `rows` as a regression in which sets are
    compared, and all parameters at the `start` of every fit; `contradicting` as in
    `extended_along_motion`.
    """

    problem: SearchProblem
    space: EquationSpace
    rows: Regression
    start: Mapping[str, float]
    contradicting: Collection[str]

    def gain(self, candidates: Sequence[Candidate], member: Candidate) -> Gain | None:
        """What a member of a set gains in the rows, with what needs it; None where they do not show
        it.
        """
        smaller = without_member(candidates, member)
        return gain_along_motion(self.rows, candidates, smaller)

    def earns(self, candidates: Sequence[Candidate], member: Candidate) -> bool:
        """Whether the gain of a member of a set is material, and significant over all candidates
        and frequencies that were compared.
        """
        return self._is_earned(self.gain(candidates, member), member)

    def _is_earned(self, found: Gain | None, member: Candidate) -> bool:
        tests = looked_at(self.problem.candidates, [member])
        return found is not None and found.is_better(self.problem.material, tests)

    def in_simplest_forms(
        self, candidates: Sequence[Candidate], kept: Sequence[Candidate]
    ) -> tuple[Candidate, ...]:
        """A set with every member that is not `kept` in the simplest form beside which a fuller one
        gains nothing: a cubic spring about a far place is a linear one as well.
        """
        for member in [c for c in candidates if c not in kept]:
            every = [s.candidate for s in self.rows.signatures if s.candidate.key == member.key]
            simpler = [form for form in every if len(form.free) < len(member.free)]
            for form in sorted(simpler, key=lambda c: len(c.free)):
                smaller = tuple(form if c is member else c for c in candidates)
                if not self._is_earned(gain_along_motion(self.rows, candidates, smaller), member):
                    candidates = smaller
                    break
        return tuple(candidates)

    def is_confirmed(self, candidates: Sequence[Candidate]) -> bool:
        """Whether every member of a set has such a gain, and passes the other tests that a name
        requires.
        """
        if not all(self.earns(candidates, c) for c in candidates):
            return False
        fit = self.fitted(candidates)
        members = [with_what_needs_it(c, candidates) for c in candidates]
        if any(why_unconfirmed(fit, c, leaves_noise=False) for c in members):
            return False
        return not any(
            contradicts_its_law(
                self.problem,
                self.space,
                candidates,
                fit.values,
                c,
                loosely=c.key not in self.contradicting,
            )
            for c in candidates
        )

    def alternatives(self, candidates: Sequence[Candidate]) -> dict[str, tuple[str, ...]]:
        """By the key of each member of a set, those that predict no worse in its place, and beside
        which it gains nothing any more.
        """
        found: dict[str, set[str]] = {c.key: set() for c in candidates}
        for other in exchanges(self.rows, candidates):
            keys = {c.key for c in other}
            for member in candidates:
                if member.key not in keys and not self.earns((*other, member), member):
                    found[member.key] |= keys - set(found)
        return {key: tuple(sorted(keys)) for key, keys in found.items()}

    def fitted(self, candidates: Sequence[Candidate]) -> Fit:
        """A set fitted to the rows, as a fit whose runs are the rows along each run in the order of
        time, those of all equations.
        """
        problem, space = self.problem, self.space
        begun = start_of(problem, self.rows, candidates, self.start)
        free = all_free(problem, candidates, begun)
        values = fit_equations(space, free, begun, POLISH, problem.executor, own_torque=True)
        values = possible(problem, free, {**begun, **values})
        here = {f.name: values[f.name] for f in free}
        at = linearised(space, free, values, here, problem.executor, own_torque=True)
        root = np.sqrt(at.weight)
        residual = at.rows * root
        table = at.jacobian * root[:, None] * slopes(free, to_search(free, values))
        _, run, time = space.labels()
        order = np.lexsort((time, run))
        runs, evaluations = [], []
        for number, whole in enumerate(space.runs):
            own = order[run[order] == number]
            runs.append(_of_rows(whole, time[own], residual[own]))
            evaluations.append(Evaluation(residual[own], table[own], np.zeros((own.size, 0))))
        cost = float(residual @ residual)
        return Fit(problem.model, tuple(runs), free, values, (), cost, tuple(evaluations))

    def predicts_better(self, larger: Fit, smaller: Fit) -> bool:
        """Whether the residual along the validation runs is materially smaller with the values of
        one fit than with those of another, in windows as short as those of the training runs. It is
        that of the inputs: torques of a drive whose constant is fitted too small are small as well.
        """
        space = equation_space(
            self.problem, self.start, self.problem.validate, half_width=self.space.half_width
        )
        if space is None:
            return False
        equation, run, time = space.labels()
        rows = [self._residual_inputs(space, fit) for fit in (larger, smaller)]
        scale = robust_scale(rows[0], equation)
        block = block_numbers(run, time)
        squares = [np.minimum((r / scale) ** 2, FAR**2) for r in rows]
        losses = [np.asarray(np.bincount(block, s), np.float64) for s in squares]
        return compared(losses[0], losses[1]).share >= self.problem.material

    def _residual_inputs(self, space: EquationSpace, fit: Fit) -> FloatArray:
        """What the inputs lack in the rows [n] of `space` with the values of a fit, in the units of
        these.
        """
        p = self.problem.model.parameter_vector(dict(fit.values))
        equation, _, _ = space.labels()
        return space.rows(p) / space.drive_gains(p)[equation]


def _of_rows(run: Run, time: FloatArray, residual: FloatArray) -> Run:
    """The run with residual torques [k] of the equations, in units of their noise, as what was
    measured at `time`: one signal, whatever the sensors of the run.
    """
    return replace(
        run,
        time=time,
        measured=residual[:, None],
        weight=np.ones(1),
        counts=np.full(1, np.nan),
        signals=("torque",),
    )
