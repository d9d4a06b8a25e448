"""The search: sets that the weak-form regression proposes, refitted by simulation; the best of them
is completed, pruned and grown until every candidate in it is needed and none outside would add to
it.

It is a stepwise selection by one candidate at a time, of all candidates or of effects alone.
Effects that act at breakaway are fitted through windows of growing length.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate, with_what_it_brings
from ptp_symbolic.numeric.diagnose.cut_runs import (
    fitted_through,
    fitted_to_windows,
    growing,
    in_windows_of,
    more_than_halves,
    parted_problem,
    settled,
)
from ptp_symbolic.numeric.diagnose.fitted_model import (
    FittedModel,
    SearchProblem,
    deviances,
    fitted,
    halving,
    is_near,
    ranked,
    simulated,
)
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.noise_floor import (
    PropagatedNoise,
    leaves_white_noise,
    most_hidden,
    propagated_input_noise,
    with_fewer_samples,
)
from ptp_symbolic.numeric.diagnose.proposals import (
    ProposedSet,
    ProposedSets,
    placed_by_rows,
    propose,
)
from ptp_symbolic.numeric.diagnose.refits import (
    better_over_same_runs,
    declared_from,
    fitted_over_windows,
    from_far_off,
    is_near_noise_floor,
    over_whole_runs,
    refitted_in,
    started,
    taken_over,
    to_its_end,
)
from ptp_symbolic.numeric.diagnose.responses import at_lines_of_outputs
from ptp_symbolic.numeric.diagnose.stepwise import (
    Search,
    Step,
    StepwiseSearch,
    best_of_each_set,
    simplified,
    step_of,
)
from ptp_symbolic.numeric.identify.constants import (
    ABOVE_NOISE,
    AMOUNTS,
    CYCLES,
    DEVIATIONS,
    LARGEST,
    MOST,
    SCREENED,
)
from ptp_symbolic.numeric.identify.evaluate import mean_squares
from ptp_symbolic.numeric.identify.evidence import Allowance, recorded
from ptp_symbolic.numeric.identify.fit import Fit

FloatArray = NDArray[np.float64]


def each_through_windows(
    problem: SearchProblem,
    parent: FittedModel,
    candidates: Sequence[Candidate],
    propagated: PropagatedNoise,
    *,
    is_white: bool,
) -> list[FittedModel]:
    """The parent with each of `candidates` but declared values, fitted through windows (see
    `through_windows`); those alone that are reached in time.
    """
    wanted = {c.key: c for c in candidates if not c.is_declared_value}
    found = [
        through_windows(problem, parent, c, propagated, is_white=is_white)
        for c in wanted.values()
        if not problem.is_over
    ]
    return [t for t in found if t is not None]


def through_windows(
    problem: SearchProblem,
    parent: FittedModel,
    candidate: Candidate,
    propagated: PropagatedNoise,
    *,
    is_white: bool,
) -> FittedModel | None:
    """The parent with a candidate, fitted to whole runs from the end of a fit over windows, and
    again as long as that is better; None where it does not gain materially in a few windows.
    `propagated` is that of `leaves_white_noise`; `is_white`: the noise is known to be, since the
    residual of another set is no larger.
    """
    few = growing(problem, few=True)
    hidden = 1.0 if is_white else most_hidden(problem)
    most = ABOVE_NOISE * np.hypot(hidden, propagated.most)
    candidates = with_what_it_brings(parent.candidates, candidate, problem.candidates)
    values = _first_values(few, parent, candidates, most) if few else None
    if values is None:
        return None
    trial = to_its_end(problem, fitted(problem, candidates, values, None), propagated)
    parts = growing(problem)
    for _ in range(CYCLES):
        if leaves_white_noise(trial, propagated):
            break
        values = fitted_through(parts, candidates, trial.values)
        again = to_its_end(problem, fitted(problem, candidates, values, None), propagated)
        if ranked([trial, again])[0] is trial:
            break
        trial = again
    return trial


def _first_values(
    parts: Sequence[SearchProblem],
    parent: FittedModel,
    candidates: Sequence[Candidate],
    most: FloatArray,
) -> Mapping[str, float] | None:
    """Values of the last of `candidates`, with those that it brings along, fitted through windows;
    None where windows on which it has no influence hold more than `most` [ny] times their noise,
    and where it does not gain materially in the longest: each has an initial state of its own, so
    that short ones show little of an effect that acts late.

    It starts at its usual amount, to which all others are fitted first: from where they compensate
    it a search does not return. And in every part at the best of several amounts, all others as
    they are without it.
    """
    shortest, run = parts[0], parts[0].executor
    alone = fitted_to_windows(shortest, parent.candidates, parent.values)
    added = candidates[len(parent.candidates) :]
    shapes = added[-1].shapes
    starts = [{**_amounts(added, 1.0), **shape} for shape in shapes]
    if not any(_may_be_all(shortest, alone, start, most) for start in starts):
        return None

    def followed(start: Mapping[str, float]) -> FittedModel:
        part = replace(shortest, fixed={**shortest.fixed, **start})
        others = settled(
            part, fitted(part, parent.candidates, {**alone.values, **start}, None), None, brief=True
        )
        return fitted_to_windows(shortest, candidates, others.values)

    with_it: list[FittedModel] = []
    for part in parts:
        if part is shortest:
            jobs = [run.submit(followed, start) for start in starts]
        else:
            alone = fitted_to_windows(part, parent.candidates, alone.values)
            jobs = [run.submit(fitted_to_windows, part, candidates, t.values) for t in with_it]
        jobs += [run.submit(_scanned, part, alone, added, s) for s in shapes]
        found = [job.result() for job in jobs]
        with_it = [found[k] for k in np.argsort(deviances(found))[:SCREENED]]
    cost = deviances([alone, with_it[0]])
    least_change = sum(r.size for r in alone.fit.runs) * np.log(1.0 - shortest.material)
    return with_it[0].values if cost[1] <= cost[0] + least_change else None


def _scanned(
    part: SearchProblem, alone: FittedModel, added: Sequence[Candidate], shape: Mapping[str, float]
) -> FittedModel:
    """A trial with the best of several amounts of what is added, of some `shape`, fitted on."""
    candidates = (*alone.candidates, *added)
    values = [{**alone.values, **_amounts(added, k), **shape} for k in AMOUNTS]
    begun = [fitted(part, candidates, v, alone.fit.z) for v in values]
    return fitted_to_windows(part, candidates, ranked(begun)[0].values)


def _amounts(candidates: Sequence[Candidate], factor: float) -> dict[str, float]:
    """What switches candidates on, each at its start times a factor."""
    return {
        n: float(np.clip(factor * f.start, f.lower, f.upper))
        for candidate in candidates
        for f in candidate.defining
        for n in f.names
    }


def _may_be_all(
    part: SearchProblem, alone: FittedModel, amounts: Mapping[str, float], most: FloatArray
) -> bool:
    """Whether a candidate at some `amounts` changes some windows, and the residual of the others is
    within noise, at `most` [ny]: else something else is missing too.
    """
    changed = _changed(part, alone.fit, amounts)
    fit = alone.fit
    left = mean_squares(fit.evaluations, fit.runs)[np.logical_not(changed)]
    usual = np.median(left, axis=0) if len(left) else np.zeros(left.shape[1])
    return any(changed) and bool(np.all(np.sqrt(usual) <= most))


@recorded()
def _changed(part: SearchProblem, fit: Fit, amounts: Mapping[str, float]) -> list[bool]:
    """Which windows of a fit a candidate changes at some `amounts`."""
    return [
        e.failed is not None or not np.array_equal(e.residual, before.residual)
        for e, before in zip(simulated(part, fit, amounts, None), fit.evaluations, strict=True)
    ]


def extended(
    stepwise: StepwiseSearch, best: FittedModel, steps: list[Step], end: FittedModel | None = None
) -> tuple[FittedModel, list[Step]]:
    """A pruned trial with one candidate more as long as one is needed, up to the set of `end`, to
    which none could be added before; and the `steps` of its candidates. A candidate that came first
    may be dropped once others are there: then there is room for one more.
    """
    material = stepwise.problem.material
    for rounds in range(2 * LARGEST):
        if rounds >= LARGEST <= len(best.candidates):
            break
        if end is not None and best.keys == end.keys and gain(best, end).share < material:
            break
        stepwise.tried.others[:] = best_of_each_set(stepwise.tried.others, best)
        grown = stepwise.grown(best)
        if grown is None:
            break
        stepwise.tried.others.append(best)
        full = stepwise.completed(grown)
        if gain(grown, best).share >= MOST:  # else `best_earning` has restarted it
            full = stepwise.restarted(full)
        pruned, fewer = stepwise.pruned(full)
        same = pruned.keys == best.keys
        if same and ranked([best, pruned])[0] is best:
            break
        stepwise.follow(pruned)
        best, steps = pruned, fewer  # the same candidates too: a third may show them a better place
    return best, steps


def floated(
    stepwise: StepwiseSearch, best: FittedModel, steps: list[Step]
) -> tuple[FittedModel, list[Step]]:
    """The trial, or a better one from where a set goes without one of its candidates: an alias of
    an effect hides it as long as it is there (floating search: Pudil, Novovicova and Kittler,
    1994).
    """
    if stepwise.is_white(best):
        return best, steps
    for step in steps:
        others = tuple(c for c in stepwise.problem.candidates if c.key != step.candidate.key)
        grown = stepwise.among(others).grown(step.without, briefly=True)
        if grown is not None and gain(grown, best).share >= stepwise.problem.material:
            stepwise.tried.others.append(best)
            return extended(stepwise, *stepwise.pruned(stepwise.completed(grown)))
    return best, steps


def by_effects_alone(
    stepwise: StepwiseSearch, best: FittedModel, steps: list[Step], end: FittedModel | None = None
) -> tuple[FittedModel, list[Step]]:
    """The trial, or its effects alone where their residual is white, or the result of forward
    selection among effects alone, if that fits better, or has a white residual too with no more
    parameters. `end` is that of `extended`.

    Declared values are known, and a few of them changed together imitate much: they scale all
    torques of an axis that is driven by a voltage. So they are taken out together: torque constant
    and resistance change nothing but the viscous friction where one goes with the other, and none
    can be done without alone then. A single one with a white residual is kept here.
    """
    quiet = stepwise.is_white(best)
    known = [c for c in best.candidates if c.is_declared_value]
    if quiet and (not known or len(best.candidates) == 1):
        return best, steps
    effects = tuple(c for c in best.candidates if not c.is_declared_value)
    if known and effects:
        left = stepwise.polished(ranked(taken_over(stepwise.problem, effects, best))[0])
        if stepwise.is_white(left):
            stepwise.tried.others.append(best)
            return stepwise.pruned(left)
        stepwise.tried.others.append(left)
    alone = stepwise.among(tuple(c for c in stepwise.problem.candidates if not c.is_declared_value))
    other, fewer = extended(alone, stepwise.declared, [], end)
    no_larger = stepwise.is_white(other) and len(other.fit.free) <= len(best.fit.free)
    if ranked([best, other])[0] is best and not (quiet and no_larger):
        stepwise.tried.others.append(other)
        return best, steps
    stepwise.tried.others.append(best)
    return other, fewer


def search(
    problem: SearchProblem, *, brief: bool = False, known: ProposedSet | None = None
) -> Search:
    """Find the set of candidates that the training runs support; once its allowance is over, with
    what has been tried by then. A `brief` search ends with what is found soon: enough to see
    whether any set fits as well as a model whose residual is noise alone. A set that is `known` to
    fit is tried beside those of the rows.
    """
    problem.progress("comparing all sets of effects along the measured motion")
    proposals = propose(problem)
    if known is not None:
        sets = (known, *proposals.sets)
        proposals = replace(proposals, sets=sets, is_any_preferred=True)
    problem = replace(problem, candidates=placed_by_rows(problem.candidates, proposals))
    problem = with_fewer_samples(problem, proposals.start)
    problem.progress("fitting the declared model")
    if not problem.windows:
        return _over_windows(problem, proposals, None, brief=brief)
    stepwise = _seeker(*over_whole_runs(problem, proposals), proposals)
    before = stepwise.declared
    stepwise, found = _with_lines(stepwise, _soon_found(stepwise), _soon_found)
    if stepwise.problem.is_over or any(map(stepwise.is_white, (stepwise.declared, *found))):
        return replace(_from_declared(stepwise, found), is_over_windows=False)
    if brief:
        best = stepwise.pruned(ranked([stepwise.declared, *found])[0])
        return replace(_ended(stepwise, *best), is_over_windows=False, is_brief=True)
    problem = replace(problem, candidates=stepwise.problem.candidates)
    return _over_windows(problem, stepwise.proposals, before)


def continued(problem: SearchProblem, begun: Search) -> Search:
    """The whole search, of which `begun` is the brief one; that itself where it is whole."""
    if not begun.is_brief:
        return begun
    if not problem.windows:
        return search(problem)
    problem = with_fewer_samples(problem, begun.proposals.start)
    problem = replace(problem, candidates=begun.problem.candidates)
    return _over_windows(problem, begun.proposals, begun.declared)


def _over_windows(
    problem: SearchProblem,
    proposals: ProposedSets,
    before: FittedModel | None,
    *,
    brief: bool = False,
) -> Search:
    """The search over windows; `before` is the declared model fitted over whole runs."""
    problem.progress("fitting the declared model over windows")
    part, after = fitted_over_windows(problem, proposals)
    declared = after if before is None else better_over_same_runs(before, after)
    stepwise = _seeker(part, declared, proposals)
    found = _proposed(stepwise)
    if not problem.windows:
        stepwise, found = _with_lines(stepwise, found, _proposed)
    if brief and not any(map(stepwise.is_white, (stepwise.declared, *found))):
        best = stepwise.pruned(ranked([stepwise.declared, *found])[0])
        return replace(_ended(stepwise, *best), is_brief=True)
    return _from_declared(stepwise, found)


def _seeker(
    problem: SearchProblem, declared: FittedModel, proposals: ProposedSets
) -> StepwiseSearch:
    return StepwiseSearch(
        problem, declared, proposals, propagated_input_noise(problem, declared.fit)
    )


def _with_lines(
    stepwise: StepwiseSearch,
    found: list[FittedModel],
    again: Callable[[StepwiseSearch], list[FittedModel]],
) -> tuple[StepwiseSearch, list[FittedModel]]:
    """The search and what it has `found`; or where its residual exceeds the noise, and lines of
    waves stand out in the outputs, one that has them at these, and what that finds `again`.
    """
    every, before = [stepwise.declared, *found], stepwise.proposals
    if stepwise.problem.is_over or any(map(stepwise.is_white, every)):
        return stepwise, found
    beside = ranked([t for t in every if all(c.locked is None for c in t.candidates)])[0]
    placed = at_lines_of_outputs(stepwise.problem, before.space, beside, before.waves)
    if not placed:
        return stepwise, found
    keys = {c.key for c in placed}
    others = [c for c in stepwise.problem.candidates if c.key not in keys]
    problem = replace(stepwise.problem, candidates=(*others, *placed))
    proposals = replace(propose(problem), waves=before.waves)
    problem = replace(problem, candidates=placed_by_rows(problem.candidates, proposals))
    lined = StepwiseSearch(
        problem, stepwise.declared, proposals, stepwise.propagated, stepwise.tried
    )
    return lined, again(lined)


def _proposed(stepwise: StepwiseSearch) -> list[FittedModel]:
    """The best of the proposed sets, to its end, and where neither that nor the declared model has
    a white residual, the best of those that the rows rank next; none where the declared model has
    one and the rows prefer no set.
    """
    proposals, best = stepwise.proposals, stepwise.declared
    if not proposals.is_any_preferred and stepwise.is_white(best):
        return []
    found = _refitted(stepwise, proposals.sets, [])
    if not (stepwise.problem.is_over or any(map(stepwise.is_white, (best, *found)))):
        found += _refitted(stepwise, proposals.further(), found)
    return found


def _refitted(
    stepwise: StepwiseSearch, sets: Sequence[ProposedSet], known: Sequence[FittedModel]
) -> list[FittedModel]:
    """The best of some sets, to its end; none where what is `known` is far better."""
    problem = stepwise.problem
    begun = started(problem, stepwise.declared, sets)
    problem.progress(f"refitting {len(begun)} proposed sets")
    found = halving(problem, begun, SCREENED, 1, seen=stepwise.tried.others)
    every = [stepwise.declared, *known, *found]
    stepwise.follow(ranked(every)[0])
    return [stepwise.completed(t) for t in found if is_near(t, every)]


def _soon_found(stepwise: StepwiseSearch) -> list[FittedModel]:
    """What is proposed, and with one candidate more as long as that more than halves the sum of
    squares: only the last set, where its residual is white. One that ends near the noise floor is
    restarted from the rows first.
    """
    found = _proposed(stepwise)
    best = next(
        (t for t in ranked(found) if gain(t, stepwise.declared).share >= MOST), stepwise.declared
    )
    for _ in range(LARGEST):
        if stepwise.is_white(best):
            break
        grown = stepwise.grown(best, briefly=True)
        if grown is None:
            break
        best = stepwise.completed(grown)
    if is_near_noise_floor(best):
        best = stepwise.restarted(best)
    if not best.candidates or not stepwise.is_white(best):
        return found
    stepwise.tried.others.extend(t for t in found if t is not best)
    return [best]


def _from_declared(stepwise: StepwiseSearch, found: list[FittedModel]) -> Search:
    """Complete what is `found` of the proposed sets, prune, grow, simplify; from the beginning in
    windows where an added effect multiplies small errors, and again where the declared model fits
    materially better from the end of the chosen set (or from a far start).
    """
    while True:
        begun, steps = _begun(stepwise, found)
        best, cut = begun, _in_windows(stepwise, begun)
        if cut is None:
            best, steps = extended(stepwise, begun, steps)
            cut = _in_windows(stepwise, best)
        if cut is not None:
            stepwise, found = cut, _proposed(cut)
            continue
        best, steps = _over_other_roads(stepwise, begun, best, steps)
        better = _better_from_far_off(stepwise, best)
        declared, before = _declared_after(stepwise, better), stepwise.declared
        stepwise.declared = declared
        is_end = declared is before or stepwise.problem.is_over or stepwise.is_white(better)
        if is_end or gain(declared, before).share < stepwise.problem.material:
            break
        stepwise.tried.others.clear()
        found = _proposed(stepwise)
    if better is not best or declared is not before:
        best, steps = stepwise.pruned(better)
    is_taken_over = declared is not before and bool(better.candidates)
    return replace(_ended(stepwise, best, steps), is_taken_over=is_taken_over)


def _begun(stepwise: StepwiseSearch, found: list[FittedModel]) -> tuple[FittedModel, list[Step]]:
    """The best of the proposed sets, of effects that the motion does not show, and of effects that
    show in windows, pruned; and the steps of its candidates.
    """
    problem, best = stepwise.problem, stepwise.declared
    if stepwise.proposals.is_any_preferred or not stepwise.is_white(best):
        if not stepwise.have_answer(best, *found, *stepwise.tried.others):
            without_influence = stepwise.without_influence(best)
            problem.progress(
                f"refitting {len(without_influence)} effects that the motion does not show"
            )
            found = found + halving(problem, without_influence, 1)
        ends = [stepwise.completed(t) if is_near(t, found) else t for t in found]
        best = ranked([best, *ends])[0]
        stepwise.tried.others.extend(t for t in ends if t is not best)
        best = stepwise.restarted(best)
        stepwise.follow(best)
    pruned = stepwise.pruned(best) if stepwise.is_white(best) else None
    if pruned is not None and stepwise.have_answer(pruned[0]):
        return pruned
    each = each_through_windows(
        problem,
        stepwise.declared,
        stepwise.proposals.without_influence,
        stepwise.propagated,
        is_white=pruned is not None,
    )
    simplest = stepwise.simplest([best, *each])
    return pruned if pruned is not None and simplest is best else stepwise.pruned(simplest)


def _over_other_roads(
    stepwise: StepwiseSearch, begun: FittedModel, grown: FittedModel, steps: list[Step]
) -> tuple[FittedModel, list[Step]]:
    """What was `begun` and `grown`, or what grows without a candidate, or from effects alone, if
    that is better; and the steps of its candidates.
    """
    best, steps = floated(stepwise, grown, steps)
    if begun.candidates or any(c.is_declared_value for c in best.candidates):
        best, steps = by_effects_alone(stepwise, best, steps, grown)
    return best, steps


def _declared_after(stepwise: StepwiseSearch, trial: FittedModel) -> FittedModel:
    """The declared model fitted from the end of the chosen trial, which may be one itself."""
    if not trial.candidates:
        return trial
    found = declared_from(stepwise.problem, trial, stepwise.declared, stepwise.propagated)
    return stepwise.declared if found is None else found


def _ended(stepwise: StepwiseSearch, best: FittedModel, steps: list[Step]) -> Search:
    """The search that chose the trial, with each of its candidates in its simplest form; without
    those that are not needed any more then: harmonics that trade for each other may leave a fit at
    a place where a declared value makes up for it.
    """
    is_cut_short, simple = stepwise.problem.is_over, simplified(stepwise, best)
    if simple is not best and len(simple.candidates) > 1 and stepwise.is_white(simple):
        simple, steps = stepwise.pruned(simple)
    best = stepwise.sharpened(simple)
    if stepwise.is_white(best):
        without = {s.candidate.key: s.without for s in steps}
    else:  # the steps were brief, or there are none
        without = {c.key: stepwise.without(best, c) for c in best.candidates}
    members = tuple(step_of(best, c, without[c.key]) for c in best.candidates)
    return Search(
        replace(stepwise.problem, allowance=Allowance()),
        stepwise.declared,
        best,
        members,
        stepwise.tried,
        stepwise.proposals,
        stepwise.propagated,
        is_cut_short,
    )


def _better_from_far_off(stepwise: StepwiseSearch, best: FittedModel) -> FittedModel:
    """The trial, or the end of a fit that starts elsewhere over a declared parameter that is weakly
    identified by the rows, where that is significantly likelier for one parameter: deviances differ
    by minus twice the logarithm of the ratio of likelihoods.
    """
    if stepwise.problem.is_over:
        return best
    found = halving(stepwise.problem, from_far_off(stepwise.problem, stepwise.proposals, best), 1)
    before, *after = deviances([best, *found])
    is_lower = bool(after) and before - after[0] > DEVIATIONS**2
    return stepwise.polished(found[0]) if is_lower else best


def _in_windows(stepwise: StepwiseSearch, best: FittedModel) -> StepwiseSearch | None:
    """A search in windows where the best of another needs them (`parted_problem`, `in_windows_of`);
    None where its residual is white, where runs can be predicted to their end, and where most of
    the residual stays in windows too: something else is missing then.
    """
    if not best.candidates or stepwise.problem.is_over or stepwise.is_white(best):
        return None
    for cut in (parted_problem, in_windows_of):
        part = cut(stepwise.problem, best)
        if part is stepwise.problem:
            continue
        part = with_fewer_samples(part, best.values)
        if not more_than_halves(refitted_in(part, best), best):
            continue
        declared = refitted_in(part, stepwise.declared)
        return _seeker(part, declared, stepwise.proposals)
    return None
