"""What an effect must stand before it is named, besides its predictive gain.

Whether the torque of an effect goes with the rate as its law says.

What has the shape of an effect along the angle, but another law of the rate, has to be of one size
where its axis is slow and of another where it is fast. Simulations hardly see that, for they
integrate both; the rows of the equation space do.

What is left of a set when all that cannot be confirmed is taken out, or made simpler.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate, with_what_needs_it
from ptp_symbolic.numeric.diagnose.gain import (
    Gain,
    gain,
    gain_in_innovations,
    held_out_fit,
    held_out_gain,
)
from ptp_symbolic.numeric.diagnose.groups import Rival
from ptp_symbolic.numeric.diagnose.noise_floor import (
    Floor,
    floor_of,
    leaves_noise_alone,
    leaves_noise_of_inputs,
)
from ptp_symbolic.numeric.diagnose.refits import expected_gain, forms, without_run
from ptp_symbolic.numeric.diagnose.regression import block_numbers
from ptp_symbolic.numeric.diagnose.responses import (
    effect_of,
    left_beside,
    projected_off,
    stacked_jacobian,
    stacked_residual,
)
from ptp_symbolic.numeric.diagnose.seeker import (
    Refusals,
    Seeker,
    Step,
    begun_in_form,
    simplified,
    step_of,
)
from ptp_symbolic.numeric.diagnose.trial import SHARP, Task, Trial, all_free, tolerance_for
from ptp_symbolic.numeric.identify.blocks import (
    ELSEWHERE,
    SINGULAR,
    jackknife_covariance,
    leave_blocks_out,
    without_outliers,
)
from ptp_symbolic.numeric.identify.constants import (
    FALSE_ALARM,
    FAR,
    FEWEST_BLOCKS,
    LITTLE,
    MATERIAL,
    MOST,
    SAME,
)
from ptp_symbolic.numeric.identify.coordinates import to_search
from ptp_symbolic.numeric.identify.equation_fit import linearised
from ptp_symbolic.numeric.identify.equation_space import EquationSpace, row_motion
from ptp_symbolic.numeric.identify.evaluate import evaluate
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import chance_of_zero, with_finite_differences
from ptp_symbolic.numeric.identify.run import with_inputs
from ptp_symbolic.numeric.identify.windows import estimable

FloatArray = NDArray[np.float64]


Refit = Callable[[str], Fit]  # the fit without the run of that name


def why_unconfirmed(
    fit: Fit, candidate: Candidate, leaves_noise: bool, refit: Refit | None = None
) -> str | None:
    """Why `candidate` of a set cannot be named; None where nothing speaks against it. `fit` is that
    of the set, from `with_finite_differences` if it is one of simulations, `refit` that of
    `unstable_without`. Where more than noise is left, the candidate may make up for what is
    missing; where noise alone is, for a better place of the other parameters.
    """
    bound = at_bound(fit, candidate)
    if bound is not None:
        return f"{bound} ends at its bound"
    if not leaves_noise and not is_amount_known(fit, candidate):
        return "its amount is not significantly different from zero"
    if leaves_noise and is_done_by_others(fit, candidate):
        return "other parameters of the model reproduce all that it does"
    if not leads(fit, candidate):
        return "its higher harmonics are larger than its first"
    run = unstable_without(fit, candidate, refit)
    if run is not None:
        return f"its value changes significantly without {run}"
    return None


def is_amount_known(fit: Fit, candidate: Candidate) -> bool:
    """Whether the parameters that switch the candidate on can be told from where they switch it
    off: a set may need an effect that only makes up for others.

    None of them need be known alone, for they may trade for each other. Nor need the shape be
    known: a single axis feels a base that shakes by what goes along with it, whatever the azimuth.
    """
    return chance_of_zero(fit, candidate.vanishing, candidate.parameters) < FALSE_ALARM


def is_done_by_others(fit: Fit, candidate: Candidate) -> bool:
    """Whether the other parameters can do all that the candidate does, within their bounds and by
    linear prediction: a small part of it is left beside them, and changes the mean square by less
    than errors of simulations do.
    """
    square, whole, left = _beside_others(fit, candidate)
    return square < min(ELSEWHERE * whole, LITTLE * left)


@recorded()
def _beside_others(fit: Fit, candidate: Candidate) -> tuple[float, float, float]:
    """Sums of squares: of what is left of a candidate beside what all other parameters can do, of
    all that it does, and of the residual.
    """
    rows = _rows_of(fit)
    others = {f.name for f in fit.free} - set(candidate.parameters)
    effect = effect_of(fit, candidate.vanishing, rows.columns)
    square = left_beside(fit, effect, others, rows.columns)
    return square, float(effect @ effect), float(rows.residual @ rows.residual)


def leads(fit: Fit, candidate: Candidate) -> bool:
    """Whether the part of a candidate that has to be the larger one is so: a disc off its centre
    reads wrongly once per turn, and twice by the square of that.
    """
    amount = {n: fit.values[n] - zero for n, zero in candidate.vanishing.items()}
    first = np.linalg.norm([amount.pop(name) for name in candidate.leading])
    return not candidate.leading or bool(first >= np.linalg.norm(list(amount.values())))


def at_bound(fit: Fit, candidate: Candidate) -> str | None:
    """Name of a parameter of the candidate with an active bound at which it does not vanish.

    A shape counts too: at the end of its range an effect becomes another one, as a spring that is
    relaxed far away becomes a constant torque.
    """
    own = {f.name: f for f in fit.free}
    for begun in candidate.free:
        f, value = own[begun.name], fit.values[begun.name]
        if f.period is not None:
            continue
        near = SAME * max(abs(f.start), abs(value))
        ends = [end for end in (f.lower, f.upper) if abs(value - end) <= near]
        if ends and abs(value - candidate.vanishing.get(f.name, np.inf)) > near:
            return f.name
    return None


def unstable_without(fit: Fit, candidate: Candidate, refit: Refit | None = None) -> str | None:
    """Leave-one-run-out: the first run without which less than half of the effect, or its opposite,
    would be found.

    The effect is what it changes in the outputs, projected off what other parameters follow; runs
    far worse than usual weigh less. Where a single run holds all that is known of it, leaving that
    out says nothing. What linear prediction finds so is fitted without the run where a `refit` is
    given: breakaways are no straight line.
    """
    found = _without_each_run(fit, candidate)
    for name, share, left in zip(found.names, found.shares, found.left, strict=True):
        if share > 1.0 - ELSEWHERE or left >= MOST:
            continue
        anew = None if refit is None else refit(name)
        if anew is None or anew.failed or not found.left_at(fit, anew.values) >= MOST:
            return name
    return None


@dataclass(frozen=True, eq=False)
class _WithoutRuns:
    """By the `names` of the logs, the `shares` of the square of an effect that each holds, and how
    much of the effect is `left` without it, by linear prediction; by `change` [nf] per unit of the
    search coordinates from where they are `at` [nf].
    """

    names: tuple[str, ...]
    shares: tuple[float, ...]
    left: tuple[float, ...]
    change: FloatArray
    at: FloatArray

    def left_at(self, fit: Fit, values: Mapping[str, float]) -> float:
        """How much of the effect is left at other values."""
        return 1.0 + float(self.change @ (to_search(fit.free, values) - self.at))


@recorded(_WithoutRuns)
def _without_each_run(fit: Fit, candidate: Candidate) -> _WithoutRuns:
    """What `unstable_without` asks of every log; of no log where there is no effect."""
    names, residual, columns, step, label = _rows_of(fit)
    shifts = leave_blocks_out(residual, columns, label).shifts
    own = [k for k, f in enumerate(fit.free) if f.name in candidate.parameters]
    others = [k for k in range(len(fit.free)) if k not in own]
    whole = effect_of(fit, candidate.vanishing, columns) + columns[:, own] @ step[own]
    effect = projected_off(whole[:, None], columns[:, others])[:, 0]
    square, at = float(effect @ effect), to_search(fit.free, fit.values) + step
    change = np.zeros(len(at))
    if square == 0.0:
        return _WithoutRuns((), (), (), change, at)
    change[own] = projected_off(columns[:, own], columns[:, others]).T @ effect / square
    squares = np.bincount(label, effect**2, len(names)) / square
    left = 1.0 + shifts @ change
    return _WithoutRuns(tuple(names), tuple(squares.tolist()), tuple(left.tolist()), change, at)


class _Rows(NamedTuple):
    """Residual [n] and columns [n, nf] of a fit, projected off the starts of its runs, logs far
    worse than usual weighed down; the step [nf] to the optimum with these weights, and the number
    [n] in `names` of the log of each.
    """

    names: list[str]
    residual: FloatArray
    columns: FloatArray
    step: FloatArray
    label: NDArray[np.int64]


def _rows_of(fit: Fit) -> _Rows:
    sources = [run.source for run in fit.runs]
    names = list(dict.fromkeys(sources))
    residual = stacked_residual(fit)
    columns = stacked_jacobian(fit)
    signals = fit.runs[0].measured.shape[1]
    source = np.repeat([names.index(s) for s in sources], [len(run.time) for run in fit.runs])
    weighed = without_outliers(residual, columns, source, signals)
    return _Rows(names, *weighed, np.repeat(source, signals))


def answers_to_inputs(task: Task, trial: Trial) -> bool:
    """Whether the inputs move the fitted model by more than it leaves over: a model so inert that
    free starts alone follow the logs explains nothing.
    """
    changed, left = _without_inputs(task, trial)
    return changed > left


@recorded()
def _without_inputs(task: Task, trial: Trial) -> tuple[float, float]:
    """Sums of squares: of what the inputs change in the outputs, and of what the trial leaves."""
    p, none = task.model.parameter_vector(trial.values), np.zeros(0, dtype=np.int64)
    changed = left = 0.0
    for (run, e), z in zip(trial.fit.pairs(), trial.fit.z, strict=True):
        idle = with_inputs(run, np.zeros_like(run.held_inputs))
        found = evaluate(task.model, idle, p, z, none, False, tolerance_for(task, SHARP))
        if found.failed is None:
            changed += float(np.sum((found.residual - e.residual) ** 2))
            left += float(np.sum(e.residual**2))
    return changed, left


def breaks_its_law(
    task: Task,
    space: EquationSpace,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    member: Candidate,
    *,
    loosely: bool = False,
) -> bool:
    """Whether the torque of a member of a set at `values` changes with the speed of its axis in
    another way than its law says, clearly, and by a material share of what the rows ask for or
    by most of its own: a multiple of it times speed / mean speed - 1 is added, where all parameters
    are free, its own too. That multiple is 0 by its law, and 1 for what goes with the speed beside
    that. Blocks of time are left out in turn to tell how clear it is. `loosely` it has to be both,
    a material share and most of its own: the friction of a real machine follows no law exactly.
    Errors of sensors are no torques, and what acts on currents or temperatures comes to the joint
    through these, late.
    """
    names = list(task.model.parameter_names)
    elsewhere = space.sensing | space.moving
    if any(elsewhere[names.index(name)] for name in member.names):
        return False
    free = all_free(task, candidates, values)
    at = linearised(space, free, values, {f.name: values[f.name] for f in free}, task.executor)
    without = space.rows(task.model.parameter_vector({**values, **member.vanishing}))
    equation, run, time = space.labels()
    speed = np.full(len(equation), np.nan)
    for axis in range(len(space.layout.angle)):
        speed[equation == axis] = np.abs(row_motion(space, axis).rate)
    known = np.isfinite(speed)
    block = block_numbers(run[known], time[known])
    if len(np.unique(block)) < FEWEST_BLOCKS:
        return False
    root = np.sqrt(at.weight[known])
    rows, effect = root * at.rows[known], root * (at.rows - without)[known]
    table = root[:, None] * at.jacobian[known]
    mine = np.array([f.name in member.parameters for f in free])
    own = projected_off(effect[:, None], table[:, ~mine])[:, 0]
    if not (np.all(np.isfinite(own)) and np.any(own)):
        return False
    growing = effect * (speed[known] / np.average(speed[known], weights=own**2) - 1.0)
    columns = np.column_stack([growing, table])
    size = np.maximum(np.linalg.norm(columns, axis=0), 1e-300)
    change = -np.linalg.lstsq(columns / size, rows, rcond=SINGULAR)[0]
    left = leave_blocks_out(rows + columns / size @ change, columns / size, block)
    variance = float(jackknife_covariance(left.shifts)[0, 0])
    change, clear = change / size, change[0] ** 2 > FAR**2 * variance
    added = change[0] * growing[:, None]
    beside_all, beside_others = (projected_off(added, t)[:, 0] for t in (table, table[:, ~mine]))
    whole = own + beside_others
    material = beside_all @ beside_all > MATERIAL * (whole @ whole)
    scaled = 1.0 + float(own @ table[:, mine] @ change[1:][mine]) / float(own @ own)
    most = abs(change[0]) > MOST * abs(scaled)
    return bool(clear and (material and most if loosely else material or most))


class Weakness(NamedTuple):
    """A candidate that is not confirmed, and why not."""

    step: Step
    reason: str
    breaks_law: bool = False


def confirmed(
    seeker: Seeker, trial: Trial, steps: list[Step], refused: Refusals
) -> tuple[Trial, list[Step], Fit]:
    """What is left of a trial when all that cannot be confirmed is taken out, noted in `refused`
    with the reason; its steps, and its fit with all that is asked of it (see `_examined`).
    """
    fit = _examined(seeker, trial)
    while trial.candidates:
        simpler = _off_bounds(seeker, trial, fit)
        weakness = _weakness(seeker, trial, steps, fit) if simpler is None else None
        if simpler is not None:
            trial, steps = shortened(seeker, simpler)
        elif weakness is not None:
            key = weakness.step.candidate.key
            refused.note(key, weakness.reason, weakness.breaks_law)
            trial, steps = shortened(seeker, weakness.step.without)
        else:
            break
        fit = _examined(seeker, trial)
    return trial, steps, fit


def _examined(seeker: Seeker, trial: Trial) -> Fit:
    """The fit of a trial with derivatives that are not blind; where more than noise is left, so
    that amounts must be known, with what the noise of the inputs changes as well.
    """
    task = seeker.task
    if leaves_noise_alone(trial, floor_of(task, trial, seeker.carried)):
        return with_finite_differences(trial.fit, task.executor)
    return estimable(trial.fit, task.input_noise, task.executor)


def shortened(seeker: Seeker, trial: Trial) -> tuple[Trial, list[Step]]:
    """A trial that lacks something now, fitted sharply, and what its candidates gain."""
    trial = seeker.sharpened(trial)
    return trial, [seeker.step(trial, c) for c in trial.candidates]


def leaner_rival(seeker: Seeker, trial: Trial, alike: Sequence[Rival]) -> Trial | None:
    """Where the trial leaves noise alone, one of those that it cannot be told from, without a
    candidate that is of no use there, if that leaves noise alone too; None where there is none.
    """
    if not seeker.is_at_noise(trial):
        return None
    for rival in alike:
        for candidate in rival.trial.candidates:
            if expected_gain(rival.trial, candidate.vanishing) < seeker.task.material:
                smaller = seeker.without(rival.trial, candidate)
                if seeker.is_at_noise(smaller) and len(smaller.candidates) < len(trial.candidates):
                    return smaller
    return None


def doubtful(
    trial: Trial, steps: Sequence[Step], named: Mapping[str, tuple[str, ...]], floor: Floor
) -> Step | None:
    """A declared value in whose place others may stand (`named`), where more than noise is left;
    None if there is none. It is known, after all: that it is wrong is the answer only where nothing
    else is.
    """
    if leaves_noise_alone(trial, floor):
        return None
    known = [s for s in steps if s.candidate.is_declared_value]
    return next((s for s in known if named[s.candidate.key]), None)


def denied(task: Task, trial: Trial, steps: Sequence[Step]) -> Step | None:
    """The candidate of a set that the validation runs deny most: without it, the others clearly
    leave less of their error, at 5 % over all of the set; None if there is none.
    """
    if len(steps) < 2:
        return None
    after = held_out_fit(task, trial)
    gains = [held_out_gain(held_out_fit(task, s.without), after) for s in steps]
    worst = min(range(len(steps)), key=lambda k: gains[k].chance)
    return steps[worst] if gains[worst].is_clear(len(steps)) else None


def simplest_alike(
    seeker: Seeker, chosen: Trial, steps: list[Step], chosen_fit: Fit, alike: list[Rival]
) -> tuple[Trial, list[Step], Fit, list[Rival]]:
    """Of one effect and what predicts as well as it, the one with the fewest parameters, if
    that is confirmed too; with its fit from `_examined`, `chosen_fit` of the first.
    """
    unchanged = chosen, steps, chosen_fit, alike
    as_good = [r for r in alike if not r.excused]
    best = min(as_good, key=lambda r: len(r.trial.fit.free), default=None)
    if len(steps) != 1 or best is None or len(best.trial.fit.free) >= len(chosen.fit.free):
        return unchanged
    if len(best.trial.candidates) != 1:
        return unchanged
    (candidate,) = best.trial.candidates
    fit = _examined(seeker, best.trial)
    step = step_of(best.trial, candidate, steps[0].without)
    if _weakness(seeker, best.trial, [step], fit) is not None:
        return unchanged
    others = [chosen, *(r.trial for r in alike if r is not best)]
    return best.trial, [step], fit, [Rival(other, gain(best.trial, other)) for other in others]


def _off_bounds(seeker: Seeker, trial: Trial, fit: Fit) -> Trial | None:
    """The trial with a candidate in the fullest form that lacks a parameter which ends at its
    bound; None where none does, or where no form lacks it.
    """
    for candidate in trial.candidates:
        bound = at_bound(fit, candidate)
        kept = {f.name for f in candidate.free if f.name != bound}
        lacking = [f for f in forms(seeker.task, candidate) if {p.name for p in f.free} <= kept]
        if bound is not None and lacking:
            fullest = max(lacking, key=lambda form: len(form.free))
            full = seeker.polished(begun_in_form(seeker, trial, candidate, fullest))
            return simplified(seeker, full)
    return None


def _weakness(seeker: Seeker, trial: Trial, steps: list[Step], fit: Fit) -> Weakness | None:
    """The candidate of a trial that gains least of those that are not confirmed, and why not; None
    where all are. What is known of the others may change once it is out.
    """
    floor = floor_of(seeker.task, trial, seeker.carried)
    quiet = leaves_noise_alone(trial, floor)
    excused = replace(floor, carried=seeker.excusing(trial))
    by_gain = sorted(steps, key=lambda s: s.gain.share)
    refit = partial(without_run, seeker.task, trial)
    for step in by_gain:
        if not seeker.is_needed(step):
            return Weakness(step, _too_little(step.gain, seeker.task.material))
        if leaves_noise_of_inputs(step.without, excused):
            return Weakness(step, "without it the residual is within the noise of the inputs")
        member = with_what_needs_it(step.candidate, trial.candidates)
        reason = why_unconfirmed(fit, member, quiet, refit)
        if reason is not None:
            return Weakness(step, reason)
        space = seeker.proposals.space
        if space is not None and breaks_its_law(
            seeker.task, space, trial.candidates, trial.values, step.candidate
        ):
            return Weakness(
                step, "its torque depends on the speed in another way than its law", breaks_law=True
            )
        if not quiet:
            doubt = _doubt_beside_a_remainder(seeker.task, trial, step)
            if doubt is not None:
                return Weakness(step, doubt)
    if not answers_to_inputs(seeker.task, trial):
        return Weakness(by_gain[0], "with it the simulated motion no longer depends on the inputs")
    return None


def _doubt_beside_a_remainder(task: Task, trial: Trial, step: Step) -> str | None:
    """Why a step cannot be named where more than noise is left, which a wrong effect may imitate:
    it does not surely take away more than is left, or no material share but of slow drift.
    """
    if not step.gain.is_most:
        share, least = (100.0 * max(x, 0.0) for x in (step.gain.share, step.gain.lower))
        return (
            f"reduces the sum of squares by {share:.0f} % (lower 95 % limit {least:.0f} %), "
            "too little while the residual exceeds the noise"
        )
    if gain_in_innovations(trial, step.without).share < task.material:
        return "reduces slow drift alone, which other missing effects can cause as well"
    return None


def _too_little(earned: Gain, material: float) -> str:
    """Why a gain earns no name, which asks for a `material` share."""
    if earned.share <= 0.0:
        return "does not improve the prediction of blocks left out"
    share = f"{100.0 * earned.share:.0f} %"
    if earned.share < material:
        return f"reduces the sum of squares by {share} only; {100.0 * material:g} % are required"
    return f"reduces the sum of squares by {share}, which is not significant"
