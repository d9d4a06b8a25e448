"""Refits of a set by simulation: over short windows first, then whole runs, at last to the end.

Their initial values are those of the weak-form rows, of responses in the outputs, and others near
them. The declared model is one of the sets: each set is restarted from the end of that and it from
theirs, for a set fits no worse than the declared model, which it contains, and its gain counts over
the best fit of that.
"""

import math
from collections.abc import Mapping, Sequence, Set
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import FAR_OFF, Candidate
from ptp_symbolic.numeric.diagnose.cut_runs import (
    fitted_through,
    growing,
    in_windows,
    in_windows_of,
    more_than_halves,
    parted_problem,
    settled,
    shares_of_usual,
    starts_of,
    validation_in_windows,
)
from ptp_symbolic.numeric.diagnose.fitted_model import (
    SHARP,
    FittedModel,
    SearchProblem,
    all_free,
    continued,
    deviances,
    fitted,
    halving,
    is_near,
    is_same_end,
    ranked,
    side_by_side,
    simulated_at,
)
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.noise_floor import (
    PropagatedNoise,
    leaves_white_noise,
    normalised_residual,
    propagated_input_noise,
    with_fewer_samples,
)
from ptp_symbolic.numeric.diagnose.proposals import (
    ProposedSet,
    ProposedSets,
    declared_start,
    start_for,
)
from ptp_symbolic.numeric.diagnose.regression import weakly_identified
from ptp_symbolic.numeric.diagnose.responses import (
    Response,
    compensated,
    stacked_jacobian,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    CYCLES,
    FORGOTTEN,
    ITERATIONS,
    MOST,
    NEARBY,
    ROUGH,
    SCREENED,
    STEP,
    TRIED,
    TUNING,
    WIDE_STEP,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit, has_linked
from ptp_symbolic.numeric.identify.least_squares import POLISH

FloatArray = NDArray[np.float64]


def refitted_in(part: SearchProblem, trial: FittedModel) -> FittedModel:
    """A trial fitted to its end to runs in parts, whose initial states start at their guesses."""
    begun = fitted(part, trial.candidates, trial.values, None)
    return polished(part, begun, propagated_input_noise(part, begun.fit))


def without_misleading(trial: FittedModel) -> FittedModel:
    """The trial with its record of misleading derivatives cleared: they are searched again."""
    return replace(trial, fit=replace(trial.fit, misleading=None))


def over_windows(
    problem: SearchProblem,
    candidates: Sequence[Candidate],
    starts: Sequence[Mapping[str, float]],
    spread: Sequence[Mapping[str, float]] = (),
) -> list[FittedModel]:
    """The trial that starts where fits over windows of growing length end, from the best of
    `starts`, and of those `spread` further off where the residual of these exceeds white noise: a
    whole run that sticks where the machine slid misleads a fit, windows do not (multiple shooting:
    Bock, 1983). None where the runs are windows already, or no fit succeeds.

    Windows with residuals far above the median hardly count: they are many, and only give initial
    values.
    """
    best: FittedModel | None = None
    for windows in problem.windows:
        part = replace(problem, train=windows, robust_below=np.inf)

        def begin(
            values: Mapping[str, float],
            z: Sequence[FloatArray] | None = None,
            part: SearchProblem = part,
        ) -> FittedModel:
            return fitted(part, candidates, values, z, executor=problem.executor)

        near = starts if best is None else [best.values]
        begun = halving(part, [begin(values) for values in near], 1)
        if best is None and not (
            begun and np.all(normalised_residual(begun[0].fit) <= ABOVE_NOISE)
        ):
            known = begun[0].fit.z if begun else None
            far = halving(part, [begin(values, known) for values in spread], TRIED, iterations=1)
            begun = ranked([*begun, *halving(part, far, 1)])
        if not begun:
            return []
        best = settled(part, begun[0], problem.executor, brief=bool(candidates))
    return (
        [fitted(problem, candidates, best.values, None, executor=problem.executor)] if best else []
    )


def polished(
    problem: SearchProblem, trial: FittedModel, propagated: PropagatedNoise
) -> FittedModel:
    """The trial fitted to its end, and restarted where that is near the noise floor."""
    trial = to_its_end(problem, trial, propagated)
    if not is_near_noise_floor(trial):
        return trial
    return restarted_fit(problem, _in_time(problem, trial, propagated), propagated)


def is_near_noise_floor(trial: FittedModel) -> bool:
    """Whether the residual of a trial is at most NEARBY times the noise, in every signal."""
    return bool(np.all(normalised_residual(trial.fit) <= NEARBY))


def _in_time(
    problem: SearchProblem, trial: FittedModel, propagated: PropagatedNoise
) -> FittedModel:
    """The trial, or a better end past local minima in which friction breaks away a sample late
    somewhere: a drive soon forgets it, so that blocks of runs separate it from the parameters,
    where the sum of all squares compensates it by parameters that are wrong everywhere (see
    `identify.blocks`). Where runs are windows, these are such blocks.
    """
    for _ in range(CYCLES if problem.windows else 0):
        if leaves_white_noise(trial, propagated):
            return trial
        candidates, z, run = trial.candidates, trial.fit.z, problem.executor
        eased = fitted(problem, candidates, trial.values, z, POLISH, block=FORGOTTEN, executor=run)
        if eased.fit.failed:
            return trial
        before, trial = trial, ranked([trial, to_its_end(problem, eased, propagated)])[0]
        if is_same_end(trial, before):
            break
    return trial


def restarted_fit(
    problem: SearchProblem, trial: FittedModel, propagated: PropagatedNoise
) -> FittedModel:
    """The trial, or a better end from elsewhere: with the initial states of the runs estimated
    anew, and with declared parameters outside their prior range back at their starts, or at the
    ends of that range.

    Places in a gap that have followed the parameters keep these in place, and a parameter that the
    others' errors drove to where it does nothing has no derivative that points back.
    """
    if leaves_white_noise(trial, propagated):
        return trial
    left = halving(problem, restarts(problem, trial), 1)
    return ranked([trial, *(to_its_end(problem, t, propagated) for t in left)])[0]


def restarts(problem: SearchProblem, trial: FittedModel) -> list[FittedModel]:
    """The restarts of `restarted_fit`; none where every run has a single initial guess."""
    if not has_rough_starts(problem):
        return []
    here = fitted(
        problem, trial.candidates, trial.values, None, parent=trial.fit, executor=problem.executor
    )
    return [here, *back_in_prior_range(problem, trial)]


def back_in_prior_range(problem: SearchProblem, trial: FittedModel) -> list[FittedModel]:
    """The trial with declared parameters outside their prior range back at their starts, and at the
    ends of that range, not yet fitted; none where none is outside.
    """
    run, outside = problem.executor, outside_prior_range(problem, trial.values)
    begun: list[FittedModel] = []
    for factor in (1.0, FAR_OFF, 1.0 / FAR_OFF) if outside else ():
        back = {n: inside(f, factor * f.start) for f in outside for n in f.names}
        values = trial.values | back
        z, parent = trial.fit.z, trial.fit
        begun.append(fitted(problem, trial.candidates, values, z, parent=parent, executor=run))
    return begun


def has_rough_starts(problem: SearchProblem) -> bool:
    """Whether runs may begin at several places, in a gap or at rest: the deviance is rough then."""
    return any(u.contact is not None or u.instead for run in problem.train for u in run.unknowns)


def outside_prior_range(problem: SearchProblem, values: Mapping[str, float]) -> list[FreeParameter]:
    """Declared parameters outside their prior range: further from their starts than these may be
    off.
    """
    return [
        f
        for f in problem.free
        if f.start > 0.0 and not f.start / FAR_OFF <= values[f.name] <= FAR_OFF * f.start
    ]


def inside(free: FreeParameter, value: float) -> float:
    """The value, or the bound of a parameter that it exceeds."""
    return float(np.clip(value, free.lower, free.upper))


def to_its_end(
    problem: SearchProblem, trial: FittedModel, propagated: PropagatedNoise
) -> FittedModel:
    """The trial fitted with derivatives where the motion is smooth, with finite differences where
    friction makes it a staircase, in turn; windows are restarted where the one before ends.
    """
    for _ in range(CYCLES):
        if has_linked(problem.train):
            z = starts_of(trial, problem.executor)
            begun = fitted(problem, trial.candidates, trial.values, z, executor=problem.executor)
            trial = ranked([trial, begun])[0]
        smooth = continued(problem, trial, POLISH, executor=problem.executor)
        if leaves_white_noise(smooth, propagated):
            return _with_windows_restarted(problem, smooth)
        trial = continued(
            problem, without_misleading(smooth), POLISH, ROUGH, WIDE_STEP, problem.executor
        )
        if is_same_end(trial, smooth):
            break
    return trial


def _with_windows_restarted(problem: SearchProblem, trial: FittedModel) -> FittedModel:
    """The trial, or a better end with its windows started where the one before ends, if the
    residual of one is so large that it hardly counts: its initial state was lost while the
    parameters moved.
    """
    if not has_linked(problem.train) or np.all(shares_of_usual(trial) <= TUNING**2):
        return trial
    z = starts_of(trial, problem.executor)
    return continued(problem, trial, POLISH, executor=problem.executor, z=z)


def sharpened(
    problem: SearchProblem, trial: FittedModel, propagated: PropagatedNoise
) -> FittedModel:
    """A polished trial fitted on with sharp simulations, where the residual is little more than
    noise.
    """
    if trial.fit.failed or not leaves_white_noise(trial, propagated):
        return trial
    trial = continued(problem, trial, POLISH, SHARP, executor=problem.executor)
    return continued(problem, without_misleading(trial), POLISH, SHARP, STEP, problem.executor)


def forms(problem: SearchProblem, candidate: Candidate) -> list[Candidate]:
    """All forms of a candidate, a scanned frequency where it was found."""
    starts = {f.name: f for f in candidate.free}
    return [
        replace(c, free=tuple(starts.get(f.name, f) for f in c.free))
        for c in problem.candidates
        if c.key == candidate.key
    ]


def fullest(problem: SearchProblem, candidate: Candidate) -> Candidate:
    """The form of a candidate with the most parameters."""
    best = max(forms(problem, candidate), key=lambda c: len(c.free))
    return best if len(best.free) > len(candidate.free) else candidate


def started(
    problem: SearchProblem, declared: FittedModel, sets: Sequence[ProposedSet]
) -> list[FittedModel]:
    """The proposed sets that do best over short windows, each at the better of two starts: the end
    of the windows, and beside the declared model.
    """
    part = replace(problem, train=problem.few)

    def short_fit(proposal: ProposedSet) -> FittedModel:
        values, run = proposal.values, problem.executor
        return fitted(part, proposal.candidates, values, None, ITERATIONS, executor=run)

    def at_better_start(short: FittedModel) -> FittedModel:
        own = {name for c in short.candidates for name in c.names}
        beside = declared.values | {name: short.values[name] for name in own}
        starts = [
            _begun(problem, short.candidates, short.values, None),
            _begun(problem, short.candidates, beside, declared.fit),
        ]
        return ranked(starts)[0]

    return side_by_side(at_better_start, ranked(side_by_side(short_fit, sets))[:TRIED])


def along(
    problem: SearchProblem, proposals: ProposedSets, found: Response, parent: FittedModel
) -> list[FittedModel]:
    """Refits started where a response in the outputs predicts, from `parent`, and part of the way
    there. What has no influence on the rows has misleading derivatives: they are replaced at once.
    """
    proposal = found.proposal
    origin = parent.values | dict(found.shape)
    begun = []
    for part in (1.0, MOST):
        values = {n: origin[n] + part * (v - origin[n]) for n, v in proposal.values.items()}
        begun.append(_begun(problem, proposal.candidates, values, parent.fit))
    if found.candidate.key not in {c.key for c in proposals.without_influence}:
        return [ranked(begun)[0]]
    return [continued(problem, t, 1, secants=WIDE_STEP, executor=problem.executor) for t in begun]


def from_rows(
    problem: SearchProblem,
    proposals: ProposedSets,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
) -> list[FittedModel]:
    """A set with the initial values of the rows (what they do not show stays at `values`), and
    where fits over windows end from there and from the declared start.
    """
    start = start_for(problem, proposals, candidates, values)
    own = {name: start[name] for c in candidates for name in c.names}
    begun = over_windows(problem, candidates, [start, declared_start(problem) | own])
    return [*begun, _begun(problem, candidates, start, None)]


def taken_over(
    problem: SearchProblem, kept: Sequence[Candidate], trial: FittedModel
) -> list[FittedModel]:
    """The declared model with some candidates `kept` of a trial, without the others: as they are,
    and where they compensate for the others, by linear prediction; a limit is switched off too far
    away for that.
    """
    dropped = [c for c in trial.candidates if c not in kept]
    off = {name: problem.fixed[name] for c in dropped for name in c.names}
    values = trial.values | off
    others = {f.name for f in all_free(problem, kept, values)}
    linear = [f for c in dropped for f in c.defining if not c.is_limit(f)]
    vanishing = {f.name: off[f.name] for f in linear}
    taken = _taken(trial.fit, vanishing, others) | off
    starts = [values] if taken == values else [values, taken]
    return side_by_side(lambda start: _begun(problem, kept, start, trial.fit), starts)


@recorded()
def _taken(fit: Fit, vanishing: Mapping[str, float], others: Set[str]) -> dict[str, float]:
    """See `compensated`."""
    return compensated(fit, vanishing, others, stacked_jacobian(fit))


def far_starts(
    free: Sequence[FreeParameter], values: Mapping[str, float]
) -> list[dict[str, float]]:
    """`values` with one of the parameters `free` after the other, of those with a start above zero,
    at the ends of its prior range: rows identify an inertia behind a gear only within the whole,
    and fits that start with a gap and too little of it end with none.
    """
    return [
        {**values, **dict.fromkeys(f.names, inside(f, factor * f.start))}
        for f in free
        for factor in (FAR_OFF, 1.0 / FAR_OFF)
        if f.start > 0.0
    ]


def from_far_off(
    problem: SearchProblem, proposals: ProposedSets, trial: FittedModel
) -> list[FittedModel]:
    """A trial with one declared parameter that is weakly identified by the rows far off, each of
    them in turn (see `far_starts`), and in other local minima over it, the best first, not yet
    fitted: the damping of a shaft shows only as a gear bounces, and the deviance is rough in it.
    And with those outside their prior range back in it: the residual may be noise alone in runs
    where they hardly matter.
    """
    rows = proposals.regression
    free = [] if rows is None else [f for f in weakly_identified(rows) if f.start > 0.0]
    valleys = [t for f in free for t in _local_minima(problem, trial, f)]
    order = np.argsort(deviances([trial, *valleys])[1:])[:TRIED]
    starts = [*(valleys[k].values for k in order), *far_starts(free, trial.values)]
    begun = [_begun(problem, trial.candidates, values, trial.fit) for values in starts]
    return begun + back_in_prior_range(problem, trial)


def _local_minima(
    problem: SearchProblem, trial: FittedModel, free: FreeParameter
) -> list[FittedModel]:
    """The trial, not fitted, at values of one parameter, all others fixed, at which its deviance is
    below that at the values beside: half as much more at every step, at least as far from its start
    as that may be off. Its own value is among the values, and not returned.
    """
    own, steps = trial.values[free.name], math.ceil(math.log(FAR_OFF) / math.log(1.0 + MOST))
    spread = free.start * (1.0 + MOST) ** np.arange(-steps, steps + 1)
    amounts = sorted({own, *(inside(free, a) for a in spread)})
    scanned = [trial if a == own else _moved(problem, trial, free, a) for a in amounts]
    cost = [np.inf, *deviances(scanned), np.inf]
    return [
        place
        for place, before, here, after in zip(scanned, cost, cost[1:], cost[2:], strict=False)
        if place is not trial and here < min(before, after)
    ]


def _moved(
    problem: SearchProblem, trial: FittedModel, free: FreeParameter, amount: float
) -> FittedModel:
    """The trial with one parameter at another amount, not fitted, and without new Jacobians."""
    values = trial.values | dict.fromkeys(free.names, amount)
    evaluations = simulated_at(problem, trial.fit, values)
    return replace(trial, fit=replace(trial.fit, values=values, evaluations=evaluations))


def _begun(
    problem: SearchProblem,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    parent: Fit | None,
) -> FittedModel:
    """A set at some values, not yet fitted; its runs start where those of the parent did, or else
    at their guesses.
    """
    z = None if parent is None else parent.z
    return fitted(problem, candidates, values, z, 0, parent, executor=problem.executor)


def beside_declared(
    problem: SearchProblem, trial: FittedModel, declared: FittedModel, propagated: PropagatedNoise
) -> FittedModel:
    """A trial that fits worse than the declared model, restarted from that, its effects as they are
    or at their vanishing values; `propagated` as in `Search`.
    """
    own = {name: trial.values[name] for c in trial.candidates for name in c.names}
    off = {n: c.vanishing[f.name] for c in trial.candidates for f in c.defining for n in f.names}
    begun = [
        fitted(problem, trial.candidates, values, declared.fit.z, 0, declared.fit)
        for values in (declared.values | own, declared.values | own | off)
    ]
    left = halving(problem, begun, 1)
    return ranked([trial, *(polished(problem, t, propagated) for t in left)])[0]


def declared_from(
    problem: SearchProblem, trial: FittedModel, declared: FittedModel, propagated: PropagatedNoise
) -> FittedModel | None:
    """The declared model fitted from where a trial ended, as it is and where it compensates for the
    effects; None unless that is materially better than `declared`, which was in a local minimum
    then.
    """
    left = halving(problem, taken_over(problem, (), trial), 1)
    again = [polished(problem, t, propagated) for t in left if is_near(t, [declared])]
    best = ranked([declared, *again])[0]
    return best if gain(best, declared).share >= problem.material else None


def fit_declared(
    problem: SearchProblem, proposals: ProposedSets
) -> tuple[SearchProblem, FittedModel]:
    """The declared model fitted to whole runs, and over windows where the residual exceeds white
    noise; and the problem with windows for runs that need them.
    """
    if not problem.windows:
        return fitted_over_windows(problem, proposals)
    part, trial = over_whole_runs(problem, proposals)
    if leaves_white_noise(trial, propagated_input_noise(part, trial.fit)):
        return part, trial
    part, after = fitted_over_windows(problem, proposals)
    return part, better_over_same_runs(trial, after)


def better_over_same_runs(before: FittedModel, after: FittedModel) -> FittedModel:
    """The declared model `after` a fit over windows, or as it was `before` if that is better: a
    better start does not always give a better end. Fits of other runs cannot be compared.
    """
    names = [[run.name for run in trial.fit.runs] for trial in (before, after)]
    return ranked([before, after])[0] if names[0] == names[1] else after


def over_whole_runs(
    problem: SearchProblem, proposals: ProposedSets
) -> tuple[SearchProblem, FittedModel]:
    """The declared model fitted to whole runs from the rows' start and from the declared one; the
    problem as in `fitted_over_windows`.
    """
    starts = [proposals.start, declared_start(problem)]
    run = problem.executor
    begun = [fitted(problem, (), values, None, executor=run) for values in starts]
    return _finished(problem, begun)


def fitted_over_windows(
    problem: SearchProblem, proposals: ProposedSets
) -> tuple[SearchProblem, FittedModel]:
    """The declared model, from where fits over windows end that start at the values of the rows and
    at the declared ones, and from those two; where runs are windows already, from starts far off
    too, and from the ends of shorter ones. And the problem with windows for runs that multiply
    small errors (see `in_windows`), which would mislead the fit.
    """
    starts = [proposals.start, declared_start(problem)]
    spread = far_starts(problem.free, proposals.start) if has_rough_starts(problem) else []
    begun = over_windows(problem, (), starts, spread)
    if begun:
        part = in_windows(problem, begun[0])
        if part is not problem:
            problem, after = part, fitted(part, (), begun[0].values, None)
            begun = [settled(problem, after, problem.executor)]
    begun += [fitted(problem, (), values, None, executor=problem.executor) for values in starts]
    if not problem.windows:
        far = [fitted(problem, (), values, None, executor=problem.executor) for values in spread]
        begun += halving(problem, far, SCREENED)
        begun.append(
            fitted(problem, (), fitted_through(growing(problem), (), proposals.start), None)
        )
    return _finished(problem, begun)


def _finished(
    problem: SearchProblem, begun: Sequence[FittedModel]
) -> tuple[SearchProblem, FittedModel]:
    """The best of what was begun, fitted to its end, and as `_in_windows_of_its_own`."""
    best = (halving(problem, begun, 1) or begun[-1:])[0]
    noise = propagated_input_noise(problem, best.fit)
    return _in_windows_of_its_own(problem, polished(problem, best, noise))


def _in_windows_of_its_own(
    problem: SearchProblem, trial: FittedModel
) -> tuple[SearchProblem, FittedModel]:
    """The problem with its runs parted and cut where the declared model needs it, and the trial
    refitted there. The length of windows was chosen at the start values, which may multiply fewer
    errors than the fitted ones: their residual may seem to be noise of the inputs, which can push a
    simulation to the other side of a rest.
    """
    problem, trial = _in_parts_if_better(parted_problem(problem, trial), problem, trial)
    part = in_windows(problem, trial)
    if part is not problem:
        short = refitted_in(part, trial)
        if np.all(normalised_residual(short.fit) <= normalised_residual(trial.fit)):
            problem, trial = part, short
    if not problem.windows and np.any(normalised_residual(trial.fit) > ABOVE_NOISE):
        part = in_windows_of(problem, trial)
        if part is not problem:
            part = with_fewer_samples(part, trial.values)
            problem, trial = _in_parts_if_better(part, problem, trial)
    trial = _back_in_range(problem, trial)
    return validation_in_windows(problem, trial), trial


def _back_in_range(problem: SearchProblem, trial: FittedModel) -> FittedModel:
    """The declared model, or a better end with parameters back in their prior range (see
    `restarts`), if some iterations gain materially: one that went where it does nothing has no
    derivative that points back, and what compensates it is no effect.
    """
    outside = outside_prior_range(problem, trial.values)
    if not outside or (is_near_noise_floor(trial) and not trial.fit.failed):
        return trial
    left = halving(problem, restarts(problem, trial), 1)
    if not left or not (trial.fit.failed or gain(left[0], trial).share >= problem.material):
        return trial
    return polished(problem, left[0], propagated_input_noise(problem, left[0].fit))


def _in_parts_if_better(
    part: SearchProblem, problem: SearchProblem, trial: FittedModel
) -> tuple[SearchProblem, FittedModel]:
    """The problem in parts and the trial refitted there, where that halves the sum of squares."""
    if part is problem:
        return problem, trial
    short = refitted_in(part, trial)
    return (part, short) if more_than_halves(short, trial) else (problem, trial)
