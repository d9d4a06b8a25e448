"""The search: sets that the equation space proposes, refitted by simulation; the best of them is
completed, pruned and grown until every candidate in it is needed and none outside would add to it.

The frequency of a wave by what it changes in the simulated outputs.

Where a machine rests, or lies in a gap, most of the time, few rows are left, and no line stands out
in them. The outputs still know it: waves of all frequencies are simulated in turn.

Sets that grow and shrink by one candidate at a time: stepwise selection, of all candidates or of
effects alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.cut_runs import in_windows_of, parted_task, takes_away_most
from ptp_symbolic.numeric.diagnose.declared_fit import (
    better_over_same_runs,
    declared_from,
    led_over_windows,
    over_whole_runs,
)
from ptp_symbolic.numeric.diagnose.findings import Search, Step, step_of, worth_keeping
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.left_over import carried_noise, with_fewer_samples
from ptp_symbolic.numeric.diagnose.linear import projected_off, stacked_jacobian, stacked_residual
from ptp_symbolic.numeric.diagnose.proposals import (
    Proposal,
    Proposals,
    placed_by_rows,
    propose,
)
from ptp_symbolic.numeric.diagnose.refits import is_near_floor, refitted_in
from ptp_symbolic.numeric.diagnose.responses import response_columns
from ptp_symbolic.numeric.diagnose.seeker import Seeker, simplified
from ptp_symbolic.numeric.diagnose.signatures import at_line, axes_of, band
from ptp_symbolic.numeric.diagnose.starts import from_far_off, started, taken_over
from ptp_symbolic.numeric.diagnose.through_windows import each_through_windows
from ptp_symbolic.numeric.diagnose.trial import (
    Task,
    Trial,
    halving,
    is_near,
    misfits,
    ranked,
)
from ptp_symbolic.numeric.identify.constants import (
    CYCLES_APART,
    DEVIATIONS,
    LARGEST,
    MOST,
    REACH,
    ROWS_PER_WINDOW,
    SCANNED,
    SCREENED,
)
from ptp_symbolic.numeric.identify.equation_space import EquationSpace, row_motion
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.work import Allowance

FloatArray = NDArray[np.float64]


def at_lines_of_outputs(
    task: Task, space: EquationSpace | None, trial: Trial, waves: Sequence[Candidate]
) -> tuple[Candidate, ...]:
    """Those of the candidates `waves` of which a line stands out in what a trial leaves of the
    outputs, by linear prediction; at that line, in all their forms. None without the `space` of
    rows, which tells how far to look; and none of a wave of which the rows tell all frequencies.
    """
    found: list[Candidate] = []
    if space is None:
        return ()
    for key in dict.fromkeys(c.key for c in waves):
        forms = [c for c in waves if c.key == key]
        line = None if key in trial.keys else _line(task, space, trial, forms[0])
        placed = [at_line(form, *line) for form in forms] if line is not None else []
        found += [c for c in placed if c is not None]
    return tuple(found)


def _line(
    task: Task, space: EquationSpace, trial: Trial, candidate: Candidate
) -> tuple[float, float, int] | None:
    """The frequency of the strongest line of a candidate, in Hz or cycles per turn, the lowest that
    is a line, and how many can be told from one another; None where none takes away a material
    share, and twice what any other does: what drifts looks like many slow waves. And where there
    are more rows, those that overlap counted once, than frequencies, or too many to simulate.

    A step of half of what tells two apart dims a line between by a fifth; then it is looked for
    beside the strongest.
    """
    span, usual, rows = _place(space, trial, candidate)
    lowest, highest = band(space, candidate, span, usual)
    apart = int((highest - lowest) * span)
    if not rows / ROWS_PER_WINDOW < apart <= SCANNED:
        return None
    task.progress(f"simulating {candidate.key} at all frequencies, {apart} of which are resolved")
    best = _strongest(task, trial, candidate, span, lowest, highest, task.material)
    return None if best is None else (best, 0.9 * lowest, apart)


@recorded()
def _strongest(
    task: Task,
    trial: Trial,
    candidate: Candidate,
    span: float,
    lowest: float,
    highest: float,
    material: float,
) -> float | None:
    """The frequency of the strongest line of `_line`, from the lowest to the highest, where it
    takes away a `material` share.
    """
    away = stacked_jacobian(trial.fit)
    residual = projected_off(stacked_residual(trial.fit)[:, None], away)[:, 0]

    def left(frequency: float) -> float:
        return _left(task, trial, candidate, frequency, residual, away)

    steps = np.arange(lowest, highest, MOST / span)
    shares = np.array(list(task.executor.map(left, steps)))
    best = float(steps[int(np.argmin(shares))])
    others = shares[np.abs(steps - best) > 1.0 / span]
    close = np.clip(best + CYCLES_APART / span * np.array([-1.0, 0.0, 1.0]), lowest, highest)
    shares = np.array(list(task.executor.map(left, close)))
    taken, by_others = 1.0 - shares.min(), 1.0 - others.min(initial=1.0)
    if taken < material or by_others > MOST * taken:
        return None
    return float(close[int(np.argmin(shares))])


def _place(space: EquationSpace, trial: Trial, candidate: Candidate) -> tuple[float, float, int]:
    """How far the place goes that a wave is locked to, in s or turns, how fast it usually goes as
    it moves, per s (an axis without rows: 1 rad/s), and how many rows tell of it.
    """
    assert candidate.locked is not None
    runs, own = trial.fit.runs, axes_of(space, candidate)
    rows = int(np.isin(space.labels()[0], own).sum())
    if candidate.locked[1] == "time":
        return max(run.time[-1] for run in runs) - min(run.time[0] for run in runs), 1.0, rows
    columns = [run.measured[:, run.signals.index(f"theta_{candidate.axis}")] for run in runs]
    rate = np.abs(row_motion(space, own[0]).rate) if rows else np.ones(1)
    turns = float(np.ptp(np.concatenate(columns))) / (2.0 * np.pi)
    return turns, float(np.median(rate)) / (2.0 * np.pi), rows


def _left(
    task: Task,
    trial: Trial,
    candidate: Candidate,
    frequency: float,
    residual: FloatArray,
    away: FloatArray,
) -> float:
    """Share of the square of a `residual` [n] that is left beside a wave of some frequency in any
    of its shapes; both projected off the columns `away` [n, nf].
    """
    assert candidate.locked is not None
    most = REACH * float(np.linalg.norm(residual))
    shapes = [{**shape, candidate.locked[0]: frequency} for shape in candidate.shapes]
    found = [response_columns(task, trial, candidate, shape, most) for shape in shapes]
    tables = [columns.table for columns in found if columns is not None]
    if not tables:
        return 1.0
    wave = projected_off(np.column_stack(tables), away)
    rest = projected_off(residual[:, None], wave)
    return float(np.sum(rest**2) / max(np.sum(residual**2), 1e-300))


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
