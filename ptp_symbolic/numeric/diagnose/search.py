"""The search: sets that the equation space proposes, refitted by simulation; the best of them is
completed, pruned and grown until every candidate in it is needed and none outside would add to it.

The frequency of a wave by what it changes in the simulated outputs.

Where a machine rests, or lies in a gap, most of the time, few rows are left, and no line stands out
in them. The outputs still know it: waves of all frequencies are simulated in turn.

Sets that grow and shrink by one candidate at a time: stepwise selection, of all candidates or of
effects alone.

Effects that act as friction lets go, led to where they fit through ever longer windows.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate, with_what_it_brings
from ptp_symbolic.numeric.diagnose.cut_runs import (
    growing,
    in_windows_of,
    led,
    led_through,
    parted_task,
    settled,
    takes_away_most,
)
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.noise_floor import (
    Carried,
    carried_noise,
    leaves_white_noise,
    most_hidden,
    with_fewer_samples,
)
from ptp_symbolic.numeric.diagnose.proposals import (
    Proposal,
    Proposals,
    placed_by_rows,
    propose,
)
from ptp_symbolic.numeric.diagnose.refits import (
    better_over_same_runs,
    declared_from,
    from_far_off,
    is_near_floor,
    led_over_windows,
    over_whole_runs,
    refitted_in,
    started,
    taken_over,
    to_its_end,
)
from ptp_symbolic.numeric.diagnose.responses import at_lines_of_outputs
from ptp_symbolic.numeric.diagnose.seeker import (
    Search,
    Seeker,
    Step,
    simplified,
    step_of,
    worth_keeping,
)
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
    fitted,
    halving,
    is_near,
    misfits,
    ranked,
    simulated,
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
    task: Task,
    parent: Trial,
    candidates: Sequence[Candidate],
    carried: Carried,
    *,
    is_white: bool,
) -> list[Trial]:
    """The parent with each of `candidates` but declared values, where windows lead to it (see
    `through_windows`); those alone that are reached in time.
    """
    wanted = {c.key: c for c in candidates if not c.is_declared_value}
    led = [
        through_windows(task, parent, c, carried, is_white=is_white)
        for c in wanted.values()
        if not task.is_over
    ]
    return [t for t in led if t is not None]


def through_windows(
    task: Task, parent: Trial, candidate: Candidate, carried: Carried, *, is_white: bool
) -> Trial | None:
    """The parent with a candidate, fitted to whole runs from where windows lead it, and again as
    long as that is a better place; None where it does not gain materially in a few windows.
    `carried` is that of `leaves_white_noise`; `is_white`: the noise is known to be, since another
    set leaves no more than that.
    """
    few = growing(task, few=True)
    hidden = 1.0 if is_white else most_hidden(task)
    most = ABOVE_NOISE * np.hypot(hidden, carried.most)
    candidates = with_what_it_brings(parent.candidates, candidate, task.candidates)
    values = _first_lead(few, parent, candidates, most) if few else None
    if values is None:
        return None
    trial = to_its_end(task, fitted(task, candidates, values, None), carried)
    parts = growing(task)
    for _ in range(CYCLES):
        if leaves_white_noise(trial, carried):
            break
        values = led_through(parts, candidates, trial.values)
        again = to_its_end(task, fitted(task, candidates, values, None), carried)
        if ranked([trial, again])[0] is trial:
            break
        trial = again
    return trial


def _first_lead(
    parts: Sequence[Task], parent: Trial, candidates: Sequence[Candidate], most: FloatArray
) -> Mapping[str, float] | None:
    """Values where windows lead the last of `candidates`, with those that it brings along; None
    where windows that it leaves as they are hold more than `most` [ny] times their noise, and where
    it does not gain materially in the longest: each begins by itself, so that short ones leave
    little of an effect that acts late.

    It begins at the amount of its start, to which all others follow first: from where they make up
    for it a search does not find back. And in every part at the best of several amounts, all others
    as they are without it.
    """
    shortest, run = parts[0], parts[0].executor
    alone = led(shortest, parent.candidates, parent.values)
    added = candidates[len(parent.candidates) :]
    shapes = added[-1].shapes
    starts = [{**_amounts(added, 1.0), **shape} for shape in shapes]
    if not any(_may_be_all(shortest, alone, start, most) for start in starts):
        return None

    def followed(start: Mapping[str, float]) -> Trial:
        part = replace(shortest, fixed={**shortest.fixed, **start})
        others = settled(
            part, fitted(part, parent.candidates, {**alone.values, **start}, None), None, brief=True
        )
        return led(shortest, candidates, others.values)

    with_it: list[Trial] = []
    for part in parts:
        if part is shortest:
            jobs = [run.submit(followed, start) for start in starts]
        else:
            alone = led(part, parent.candidates, alone.values)
            jobs = [run.submit(led, part, candidates, t.values) for t in with_it]
        jobs += [run.submit(_scanned, part, alone, added, s) for s in shapes]
        found = [job.result() for job in jobs]
        with_it = [found[k] for k in np.argsort(misfits(found))[:SCREENED]]
    cost = misfits([alone, with_it[0]])
    least_change = sum(r.size for r in alone.fit.runs) * np.log(1.0 - shortest.material)
    return with_it[0].values if cost[1] <= cost[0] + least_change else None


def _scanned(
    part: Task, alone: Trial, added: Sequence[Candidate], shape: Mapping[str, float]
) -> Trial:
    """A trial with the best of several amounts of what is added, of some `shape`, fitted on."""
    candidates = (*alone.candidates, *added)
    values = [{**alone.values, **_amounts(added, k), **shape} for k in AMOUNTS]
    begun = [fitted(part, candidates, v, alone.fit.z) for v in values]
    return led(part, candidates, ranked(begun)[0].values)


def _amounts(candidates: Sequence[Candidate], factor: float) -> dict[str, float]:
    """What switches candidates on, each at its start times a factor."""
    return {
        n: float(np.clip(factor * f.start, f.lower, f.upper))
        for candidate in candidates
        for f in candidate.defining
        for n in f.names
    }


def _may_be_all(part: Task, alone: Trial, amounts: Mapping[str, float], most: FloatArray) -> bool:
    """Whether a candidate at some `amounts` changes some windows, and those that it leaves as they
    are hold no more than may be noise, at `most` [ny]: else they lack something besides.
    """
    changed = _changed(part, alone.fit, amounts)
    fit = alone.fit
    left = mean_squares(fit.evaluations, fit.runs)[np.logical_not(changed)]
    usual = np.median(left, axis=0) if len(left) else np.zeros(left.shape[1])
    return any(changed) and bool(np.all(np.sqrt(usual) <= most))


@recorded()
def _changed(part: Task, fit: Fit, amounts: Mapping[str, float]) -> list[bool]:
    """Which windows of a fit a candidate changes at some `amounts`."""
    return [
        e.failed is not None or not np.array_equal(e.residual, before.residual)
        for e, before in zip(simulated(part, fit, amounts, None), fit.evaluations, strict=True)
    ]


def extended(
    seeker: Seeker, best: Trial, steps: list[Step], end: Trial | None = None
) -> tuple[Trial, list[Step]]:
    """A pruned trial with one candidate more as long as one is needed, up to the set of `end`, to
    which none could be added before; and the `steps` of its candidates. A candidate that leads the
    way may be dropped once others are there: then there is room for one more.
    """
    material = seeker.task.material
    for rounds in range(2 * LARGEST):
        if rounds >= LARGEST <= len(best.candidates):
            break
        if end is not None and best.keys == end.keys and gain(best, end).share < material:
            break
        seeker.tried.others[:] = worth_keeping(seeker.tried.others, best)
        grown = seeker.grown(best)
        if grown is None:
            break
        seeker.tried.others.append(best)
        full = seeker.completed(grown)
        if gain(grown, best).share >= MOST:  # one that gains less has been begun anew before
            full = seeker.restarted(full)
        pruned, fewer = seeker.pruned(full)
        same = pruned.keys == best.keys
        if same and ranked([best, pruned])[0] is best:
            break
        seeker.follow(pruned)
        best, steps = pruned, fewer  # the same candidates too: a third may show them a better place
    return best, steps


def floated(seeker: Seeker, best: Trial, steps: list[Step]) -> tuple[Trial, list[Step]]:
    """The trial, or a better one from where a set goes without one of its candidates: what stands
    in for an effect hides it as long as it is there (floating search: Pudil, Novovicova and
    Kittler, 1994).
    """
    if seeker.is_at_noise(best):
        return best, steps
    for step in steps:
        others = tuple(c for c in seeker.task.candidates if c.key != step.candidate.key)
        grown = seeker.among(others).grown(step.without, briefly=True)
        if grown is not None and gain(grown, best).share >= seeker.task.material:
            seeker.tried.others.append(best)
            return extended(seeker, *seeker.pruned(seeker.completed(grown)))
    return best, steps


def by_effects_alone(
    seeker: Seeker, best: Trial, steps: list[Step], end: Trial | None = None
) -> tuple[Trial, list[Step]]:
    """The trial, or its effects alone where these leave only noise, or what forward selection from
    the declared model makes of effects alone, if that fits better, or leaves only noise too with no
    more parameters. `end` is that of `extended`.

    Declared values are known, and a few of them changed together imitate much: they scale all
    torques of an axis that is driven by a voltage. So they are taken out together: torque constant
    and resistance change nothing but the viscous friction where one goes with the other, and none
    can be done without alone then. A single one that leaves only noise is not doubted here.
    """
    quiet = seeker.is_at_noise(best)
    known = [c for c in best.candidates if c.is_declared_value]
    if quiet and (not known or len(best.candidates) == 1):
        return best, steps
    effects = tuple(c for c in best.candidates if not c.is_declared_value)
    if known and effects:
        left = seeker.polished(ranked(taken_over(seeker.task, effects, best))[0])
        if seeker.is_at_noise(left):
            seeker.tried.others.append(best)
            return seeker.pruned(left)
        seeker.tried.others.append(left)
    alone = seeker.among(tuple(c for c in seeker.task.candidates if not c.is_declared_value))
    other, fewer = extended(alone, seeker.declared, [], end)
    no_larger = seeker.is_at_noise(other) and len(other.fit.free) <= len(best.fit.free)
    if ranked([best, other])[0] is best and not (quiet and no_larger):
        seeker.tried.others.append(other)
        return best, steps
    seeker.tried.others.append(best)
    return other, fewer


def search(task: Task, *, brief: bool = False) -> Search:
    """Find the set of candidates that the training runs support; once its allowance is over, with
    what has been tried by then. A `brief` search ends with what is found soon: enough to tell
    whether any set leaves as little as a model that leaves noise alone.
    """
    task.progress("comparing all sets of effects along the measured motion")
    proposals = propose(task)
    task = replace(task, candidates=placed_by_rows(task.candidates, proposals))
    task = with_fewer_samples(task, proposals.start)
    task.progress("fitting the declared model")
    before = None
    if task.windows:
        seeker = _seeker(*over_whole_runs(task, proposals), proposals)
        before = seeker.declared
        seeker, found = _with_lines(seeker, _soon_found(seeker), _soon_found)
        if seeker.task.is_over or any(map(seeker.is_at_noise, (seeker.declared, *found))):
            return replace(_from_declared(seeker, found), is_led=False)
        if brief:
            best = seeker.pruned(ranked([seeker.declared, *found])[0])
            return replace(_ended(seeker, *best), is_led=False)
        task = replace(task, candidates=seeker.task.candidates)
        proposals = seeker.proposals
        task.progress("fitting the declared model over windows")
    part, led = led_over_windows(task, proposals)
    declared = led if before is None else better_over_same_runs(before, led)
    seeker = _seeker(part, declared, proposals)
    found = _proposed(seeker)
    if not task.windows:
        seeker, found = _with_lines(seeker, found, _proposed)
    if brief and not any(map(seeker.is_at_noise, (seeker.declared, *found))):
        return _ended(seeker, *seeker.pruned(ranked([seeker.declared, *found])[0]))
    return _from_declared(seeker, found)


def _seeker(task: Task, declared: Trial, proposals: Proposals) -> Seeker:
    return Seeker(task, declared, proposals, carried_noise(task, declared.fit))


def _with_lines(
    seeker: Seeker, found: list[Trial], again: Callable[[Seeker], list[Trial]]
) -> tuple[Seeker, list[Trial]]:
    """The search and what it has `found`; or where that leaves more than noise, and waves draw
    lines in the outputs, one that has them at these, and what that finds `again`.
    """
    every, before = [seeker.declared, *found], seeker.proposals
    if seeker.task.is_over or any(map(seeker.is_at_noise, every)):
        return seeker, found
    beside = ranked([t for t in every if all(c.locked is None for c in t.candidates)])[0]
    placed = at_lines_of_outputs(seeker.task, before.space, beside, before.waves)
    if not placed:
        return seeker, found
    keys = {c.key for c in placed}
    others = [c for c in seeker.task.candidates if c.key not in keys]
    task = replace(seeker.task, candidates=(*others, *placed))
    proposals = replace(propose(task), waves=before.waves)
    task = replace(task, candidates=placed_by_rows(task.candidates, proposals))
    lined = Seeker(task, seeker.declared, proposals, seeker.carried, seeker.tried)
    return lined, again(lined)


def _proposed(seeker: Seeker) -> list[Trial]:
    """The best of the proposed sets, to its end, and where neither that nor the declared model
    leaves noise alone, the best of those that the rows put next; none where the declared model
    leaves only noise and the rows ask for nothing.
    """
    proposals, best = seeker.proposals, seeker.declared
    if not proposals.asked_for and seeker.is_at_noise(best):
        return []
    found = _refitted(seeker, proposals.sets, [])
    if not (seeker.task.is_over or any(map(seeker.is_at_noise, (best, *found)))):
        found += _refitted(seeker, proposals.further(), found)
    return found


def _refitted(seeker: Seeker, sets: Sequence[Proposal], known: Sequence[Trial]) -> list[Trial]:
    """The best of some sets, to its end; none where what is `known` is far better."""
    task = seeker.task
    begun = started(task, seeker.declared, sets)
    task.progress(f"refitting {len(begun)} proposed sets")
    found = halving(task, begun, SCREENED, 1, seen=seeker.tried.others)
    every = [seeker.declared, *known, *found]
    seeker.follow(ranked(every)[0])
    return [seeker.completed(t) for t in found if is_near(t, every)]


def _soon_found(seeker: Seeker) -> list[Trial]:
    """What is proposed, and with one candidate more as long as that takes away most of what is
    left: only the last set, where that leaves noise alone. One that ends near the floor is begun
    anew from the rows first.
    """
    found = _proposed(seeker)
    best = next(
        (t for t in ranked(found) if gain(t, seeker.declared).share >= MOST), seeker.declared
    )
    for _ in range(LARGEST):
        if seeker.is_at_noise(best):
            break
        grown = seeker.grown(best, briefly=True)
        if grown is None:
            break
        best = seeker.completed(grown)
    if is_near_floor(best):
        best = seeker.restarted(best)
    if not best.candidates or not seeker.is_at_noise(best):
        return found
    seeker.tried.others.extend(t for t in found if t is not best)
    return [best]


def _from_declared(seeker: Seeker, found: list[Trial]) -> Search:
    """Complete what is `found` of the proposed sets, prune, grow, simplify; where the chosen set
    (or a far start) leads the declared model to a better place, from the beginning, or with new
    gains if only noise is left; where what it adds multiplies small errors, from the beginning in
    windows.
    """
    begun, steps = _begun(seeker, found)
    best, cut = begun, _in_windows(seeker, begun)
    if cut is None:
        best, steps = extended(seeker, begun, steps)
        cut = _in_windows(seeker, best)
    if cut is not None:
        return _from_declared(cut, _proposed(cut))
    best, steps = _over_other_roads(seeker, begun, best, steps)
    better = _better_from_far_off(seeker, best)
    declared, before = _led_by(seeker, better), seeker.declared
    if declared is not before:
        seeker.declared = declared
        led_on = gain(declared, before).share >= seeker.task.material
        if led_on and not seeker.task.is_over and not seeker.is_at_noise(better):
            seeker.tried.others.clear()
            return _from_declared(seeker, _proposed(seeker))
    if better is not best or declared is not before:
        best, steps = seeker.pruned(better)
    ended = _ended(seeker, best, steps)
    return replace(ended, is_taken_over=declared is not before and bool(better.candidates))


def _begun(seeker: Seeker, found: list[Trial]) -> tuple[Trial, list[Step]]:
    """The best of the proposed sets, of effects that the motion does not show, and of effects that
    show in windows, pruned; and the steps of its candidates.
    """
    task, best = seeker.task, seeker.declared
    if seeker.proposals.asked_for or not seeker.is_at_noise(best):
        if not seeker.have_answer(best, *found, *seeker.tried.others):
            unseen = seeker.unseen(best)
            task.progress(f"refitting {len(unseen)} effects that the motion does not show")
            found = found + halving(task, unseen, 1)
        ends = [seeker.completed(t) if is_near(t, found) else t for t in found]
        best = ranked([best, *ends])[0]
        seeker.tried.others.extend(t for t in ends if t is not best)
        best = seeker.restarted(best)
        seeker.follow(best)
    pruned = seeker.pruned(best) if seeker.is_at_noise(best) else None
    if pruned is not None and seeker.have_answer(pruned[0]):
        return pruned
    each = each_through_windows(
        task,
        seeker.declared,
        seeker.proposals.unseen,
        seeker.carried,
        is_white=pruned is not None,
    )
    led = seeker.simplest([best, *each])
    return pruned if pruned is not None and led is best else seeker.pruned(led)


def _over_other_roads(
    seeker: Seeker, begun: Trial, grown: Trial, steps: list[Step]
) -> tuple[Trial, list[Step]]:
    """What was `begun` and `grown`, or what an exchange of candidates or effects alone lead to, if
    that is better; and the steps of its candidates.
    """
    best, other = grown, seeker.exchanged(grown)
    if other is not None:
        seeker.tried.others.append(best)
        best, steps = extended(seeker, *seeker.pruned(other))
    best, steps = floated(seeker, best, steps)
    if begun.candidates or any(c.is_declared_value for c in best.candidates):
        best, steps = by_effects_alone(seeker, best, steps, grown)
    return best, steps


def _led_by(seeker: Seeker, trial: Trial) -> Trial:
    """The declared model where the chosen trial, which may be one itself, leads it to."""
    if not trial.candidates:
        return trial
    led = declared_from(seeker.task, trial, seeker.declared, seeker.carried)
    return seeker.declared if led is None else led


def _ended(seeker: Seeker, best: Trial, steps: list[Step]) -> Search:
    """The search that chose the trial, with each of its candidates in its simplest form."""
    is_cut_short, best = seeker.task.is_over, seeker.sharpened(simplified(seeker, best))
    if seeker.is_at_noise(best):
        without = {s.candidate.key: s.without for s in steps}
    else:  # the search was brief
        without = {c.key: seeker.without(best, c) for c in best.candidates}
    members = tuple(step_of(best, c, without[c.key]) for c in best.candidates)
    return Search(
        replace(seeker.task, allowance=Allowance()),
        seeker.declared,
        best,
        members,
        seeker.tried,
        seeker.proposals,
        seeker.carried,
        is_cut_short,
    )


def _better_from_far_off(seeker: Seeker, best: Trial) -> Trial:
    """The trial, or the end of a fit that begins elsewhere over a declared parameter that the rows
    do not tell, where that is likelier by more than noise makes of one parameter: misfits differ by
    minus twice the logarithm of the ratio of likelihoods.
    """
    if seeker.task.is_over:
        return best
    found = halving(seeker.task, from_far_off(seeker.task, seeker.proposals, best), 1)
    before, *after = misfits([best, *found])
    is_lower = bool(after) and before - after[0] > DEVIATIONS**2
    return seeker.polished(found[0]) if is_lower else best


def _in_windows(seeker: Seeker, best: Trial) -> Seeker | None:
    """A search that begins in windows where the best of another asks for them (`parted_task`,
    `in_windows_of`); None where it leaves only noise, where runs can be followed to their end, and
    where most of what is left stays in windows too: something else is missing then.
    """
    if not best.candidates or seeker.task.is_over or seeker.is_at_noise(best):
        return None
    for cut in (parted_task, in_windows_of):
        part = cut(seeker.task, best)
        if part is seeker.task:
            continue
        part = with_fewer_samples(part, best.values)
        if not takes_away_most(refitted_in(part, best), best):
            continue
        declared = refitted_in(part, seeker.declared)
        return _seeker(part, declared, seeker.proposals)
    return None
