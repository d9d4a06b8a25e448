"""What an effect must pass before it is named, besides its predictive gain; and what remains of a
set once the members that are not confirmed are dropped, or simplified.

A torque with the shape of an effect along the angle, but another law of the rate, is of one size
where its axis is slow and of another where it is fast. Simulations hardly see that, for they
integrate both; the weak-form rows do.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate, with_what_needs_it
from ptp_symbolic.numeric.diagnose.fitted_model import (
    SHARP,
    FittedModel,
    SearchProblem,
    all_free,
    fitted,
    tolerance_for,
)
from ptp_symbolic.numeric.diagnose.gain import (
    gain,
    gain_in_innovations,
    held_out_fit,
    held_out_gain,
)
from ptp_symbolic.numeric.diagnose.groups import Alternative
from ptp_symbolic.numeric.diagnose.noise_floor import (
    NoiseFloor,
    is_within_noise_of_inputs,
    leaves_noise_alone,
    noise_floor_of,
)
from ptp_symbolic.numeric.diagnose.refits import forms
from ptp_symbolic.numeric.diagnose.regression import block_numbers
from ptp_symbolic.numeric.diagnose.responses import (
    effect_of,
    expected_gain,
    projected_off,
    residual_beside,
    stacked_jacobian,
    stacked_residual,
)
from ptp_symbolic.numeric.diagnose.stepwise import (
    Refusals,
    Step,
    StepwiseSearch,
    begun_in_form,
    looked_at,
    simplified,
    step_of,
)
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
from ptp_symbolic.numeric.identify.least_squares import POLISH
from ptp_symbolic.numeric.identify.run import with_inputs
from ptp_symbolic.numeric.identify.windows import estimable

FloatArray = NDArray[np.float64]


Refit = Callable[[str], Fit]  # the fit without the run of that name


def why_unconfirmed(
    fit: Fit, candidate: Candidate, leaves_noise: bool, refit: Refit | None = None
) -> str | None:
    """Why `candidate` of a set cannot be named; None where nothing speaks against it. `fit` is that
    of the set, from `with_finite_differences` if it is one of simulations, `refit` that of
    `depends_on_run`. Where the residual exceeds the noise, the candidate may compensate a missing
    effect; where it is noise alone, other parameters away from their optimum.
    """
    bound = at_bound(fit, candidate)
    if bound is not None:
        return f"{bound} ends at its bound"
    if not leaves_noise and not is_amount_known(fit, candidate):
        return "its amount is not significantly different from zero"
    if leaves_noise and is_reproduced_by_others(fit, candidate):
        return "other parameters of the model reproduce all that it does"
    if not first_dominates(fit, candidate):
        return "its higher harmonics are larger than its first"
    run = depends_on_run(fit, candidate, refit)
    if run is not None:
        return f"its value changes significantly without {run}"
    return None


def is_amount_known(fit: Fit, candidate: Candidate) -> bool:
    """Whether the parameters that switch the candidate on differ significantly from where they
    switch it off: an effect may merely compensate others.

    None of them need be known alone, for they may trade for each other. Nor need the shape be
    known: a single axis feels a base that shakes by what goes along with it, whatever the azimuth.
    """
    return chance_of_zero(fit, candidate.vanishing, candidate.parameters) < FALSE_ALARM


def is_reproduced_by_others(fit: Fit, candidate: Candidate) -> bool:
    """Whether the other parameters reproduce all that the candidate does, within their bounds and
    by linear prediction: the part that they cannot is small, and changes the mean square by less
    than errors of simulations do.
    """
    square, whole, left = _beside_others(fit, candidate)
    return square < min(ELSEWHERE * whole, LITTLE * left)


@recorded()
def _beside_others(fit: Fit, candidate: Candidate) -> tuple[float, float, float]:
    """Sums of squares: of the part of an effect that all other parameters cannot reproduce, of the
    whole effect, and of the residual.
    """
    rows = _rows_of(fit)
    others = {f.name for f in fit.free} - set(candidate.parameters)
    effect = effect_of(fit, candidate.vanishing, rows.columns)
    square = residual_beside(fit, effect, others, rows.columns)
    return square, float(effect @ effect), float(rows.residual @ rows.residual)


def first_dominates(fit: Fit, candidate: Candidate) -> bool:
    """Whether the part of a candidate that has to be the larger one is so: a disc off its centre
    reads wrongly once per turn, and twice by the square of that.
    """
    amount = {n: fit.values[n] - zero for n, zero in candidate.vanishing.items()}
    first = np.linalg.norm([amount.pop(name) for name in candidate.dominant])
    return not candidate.dominant or bool(first >= np.linalg.norm(list(amount.values())))


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


def _without_run(problem: SearchProblem, trial: FittedModel, name: str) -> Fit:
    """The trial fitted on without the run, or the windows, of a log."""
    kept = [k for k, run in enumerate(trial.fit.runs) if run.source != name]
    part = replace(problem, train=tuple(trial.fit.runs[k] for k in kept))
    z = [trial.fit.z[k] for k in kept]
    run = problem.executor
    return fitted(part, trial.candidates, trial.values, z, POLISH, executor=run).fit


def depends_on_run(fit: Fit, candidate: Candidate, refit: Refit | None = None) -> str | None:
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
    much of the effect remains (`left`) without it, by linear prediction; by `change` [nf] per unit
    of the search coordinates from where they are `at` [nf].
    """

    names: tuple[str, ...]
    shares: tuple[float, ...]
    left: tuple[float, ...]
    change: FloatArray
    at: FloatArray

    def left_at(self, fit: Fit, values: Mapping[str, float]) -> float:
        """How much of the effect remains at other values."""
        return 1.0 + float(self.change @ (to_search(fit.free, values) - self.at))


@recorded(_WithoutRuns)
def _without_each_run(fit: Fit, candidate: Candidate) -> _WithoutRuns:
    """What `depends_on_run` compares for every log; for none where there is no effect."""
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


def is_moved_by_inputs(problem: SearchProblem, trial: FittedModel) -> bool:
    """Whether the inputs move the fitted model by more than its residual: a model so inert that
    free initial states alone follow the logs explains nothing.
    """
    changed, left = _without_inputs(problem, trial)
    return changed > left


@recorded()
def _without_inputs(problem: SearchProblem, trial: FittedModel) -> tuple[float, float]:
    """Sums of squares: of what the inputs change in the outputs, and of the residual."""
    p, none = problem.model.parameter_vector(trial.values), np.zeros(0, dtype=np.int64)
    changed = left = 0.0
    for (run, e), z in zip(trial.fit.pairs(), trial.fit.z, strict=True):
        idle = with_inputs(run, np.zeros_like(run.held_inputs))
        found = evaluate(problem.model, idle, p, z, none, False, tolerance_for(problem, SHARP))
        if found.failed is None:
            changed += float(np.sum((found.residual - e.residual) ** 2))
            left += float(np.sum(e.residual**2))
    return changed, left


def contradicts_its_law(
    problem: SearchProblem,
    space: EquationSpace,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    member: Candidate,
    *,
    loosely: bool = False,
) -> bool:
    """Whether the torque of a member of a set at `values` depends on the speed of its axis in
    another way than its law says, significantly, and by a material share of the torque of the rows
    or by most of its own: a multiple of it times speed / mean speed - 1 is added, where all
    parameters are free, its own too. That multiple is 0 by its law, and 1 for what goes with the
    speed beside that. Its error is that of a jackknife over blocks of time. `loosely` it has to be
    both, a material share and most of its own: the friction of a real machine follows no law
    exactly. Errors of sensors are no torques, and what acts on currents or temperatures comes to
    the joint through these, late.
    """
    names = list(problem.model.parameter_names)
    elsewhere = space.sensing | space.moving
    if any(elsewhere[names.index(name)] for name in member.names):
        return False
    free = all_free(problem, candidates, values)
    at = linearised(space, free, values, {f.name: values[f.name] for f in free}, problem.executor)
    without = space.rows(problem.model.parameter_vector({**values, **member.vanishing}))
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
    material = beside_all @ beside_all > problem.material * (whole @ whole)
    scaled = 1.0 + float(own @ table[:, mine] @ change[1:][mine]) / float(own @ own)
    most = abs(change[0]) > MOST * abs(scaled)
    return bool(clear and (material and most if loosely else material or most))


class Weakness(NamedTuple):
    """A candidate that is not confirmed, and why not."""

    step: Step
    reason: str
    breaks_law: bool = False


def confirmed(
    stepwise: StepwiseSearch, trial: FittedModel, steps: list[Step], refused: Refusals
) -> tuple[FittedModel, list[Step], Fit]:
    """The trial without the members that are not confirmed, which are noted in `refused` with the
    reason; its steps, and its fit as the tests need it (see `_examined`).
    """
    fit = _examined(stepwise, trial)
    while trial.candidates:
        simpler = _off_bounds(stepwise, trial, fit)
        weakness = _weakness(stepwise, trial, steps, fit) if simpler is None else None
        if simpler is not None:
            trial, steps = shortened(stepwise, simpler)
        elif weakness is not None:
            key = weakness.step.candidate.key
            others = " and ".join(k for k in trial.keys if k != key)
            reason = f"beside {others} {weakness.reason}" if others else weakness.reason
            refused.note(key, reason, weakness.breaks_law)
            trial, steps = shortened(stepwise, weakness.step.without)
        else:
            break
        fit = _examined(stepwise, trial)
    return trial, steps, fit


def _examined(stepwise: StepwiseSearch, trial: FittedModel) -> Fit:
    """The fit of a trial with finite differences where derivatives miss what these see; where the
    residual exceeds the noise, so that amounts must be known, also with the propagated noise of the
    inputs.
    """
    problem = stepwise.problem
    if leaves_noise_alone(trial, noise_floor_of(problem, trial, stepwise.propagated)):
        return with_finite_differences(trial.fit, problem.executor)
    return estimable(trial.fit, problem.input_noise, problem.executor)


def shortened(stepwise: StepwiseSearch, trial: FittedModel) -> tuple[FittedModel, list[Step]]:
    """A trial that lacks something now, fitted sharply, and what its candidates gain."""
    trial = stepwise.sharpened(trial)
    return trial, [stepwise.step(trial, c) for c in trial.candidates]


def smaller_alternative(
    stepwise: StepwiseSearch, trial: FittedModel, alternatives: Sequence[Alternative]
) -> FittedModel | None:
    """Where the residual of the trial is white noise, one of its `alternatives` without a candidate
    that explains nothing there, if its residual is white noise too; None where there is none.
    """
    if not stepwise.is_white(trial):
        return None
    for other in alternatives:
        for candidate in other.trial.candidates:
            if expected_gain(other.trial, candidate.vanishing) < stepwise.problem.material:
                smaller = stepwise.without(other.trial, candidate)
                if stepwise.is_white(smaller) and len(smaller.candidates) < len(trial.candidates):
                    return smaller
    return None


def ambiguous_value(
    trial: FittedModel,
    steps: Sequence[Step],
    named: Mapping[str, tuple[str, ...]],
    floor: NoiseFloor,
) -> Step | None:
    """A declared value that has alternatives (`named`), where the residual exceeds the noise; None
    if there is none. It was declared as known: that it is wrong is the answer only where nothing
    else is.
    """
    if leaves_noise_alone(trial, floor):
        return None
    known = [s for s in steps if s.candidate.is_declared_value]
    return next((s for s in known if named[s.candidate.key]), None)


def rejected_on_validation(
    problem: SearchProblem, trial: FittedModel, steps: Sequence[Step]
) -> Step | None:
    """The candidate of a set that the validation runs reject most: they are predicted significantly
    better without it, at 5 % over all members; None if there is none.
    """
    if len(steps) < 2:
        return None
    after = held_out_fit(problem, trial)
    gains = [held_out_gain(held_out_fit(problem, s.without), after) for s in steps]
    worst = min(range(len(steps)), key=lambda k: gains[k].chance)
    return steps[worst] if gains[worst].is_significant(len(steps)) else None


def simplest_alternative(
    stepwise: StepwiseSearch,
    chosen: FittedModel,
    steps: list[Step],
    chosen_fit: Fit,
    alternatives: list[Alternative],
) -> tuple[FittedModel, list[Step], Fit, list[Alternative]]:
    """Of one effect and what predicts as well as it, the one with the fewest parameters, if
    that is confirmed too; with its fit from `_examined`, `chosen_fit` of the first.
    """
    unchanged = chosen, steps, chosen_fit, alternatives
    as_good = [r for r in alternatives if not r.is_within_input_noise]
    best = min(as_good, key=lambda r: len(r.trial.fit.free), default=None)
    if len(steps) != 1 or best is None or len(best.trial.fit.free) >= len(chosen.fit.free):
        return unchanged
    if len(best.trial.candidates) != 1:
        return unchanged
    (candidate,) = best.trial.candidates
    fit = _examined(stepwise, best.trial)
    step = step_of(best.trial, candidate, steps[0].without)
    if _weakness(stepwise, best.trial, [step], fit) is not None:
        return unchanged
    others = [chosen, *(r.trial for r in alternatives if r is not best)]
    return (
        best.trial,
        [step],
        fit,
        [Alternative(other, gain(best.trial, other)) for other in others],
    )


def _off_bounds(stepwise: StepwiseSearch, trial: FittedModel, fit: Fit) -> FittedModel | None:
    """The trial with a candidate in the fullest form that lacks a parameter which ends at its
    bound; None where none does, or where no form lacks it.
    """
    for candidate in trial.candidates:
        bound = at_bound(fit, candidate)
        kept = {f.name for f in candidate.free if f.name != bound}
        lacking = [
            f for f in forms(stepwise.problem, candidate) if {p.name for p in f.free} <= kept
        ]
        if bound is not None and lacking:
            fullest = max(lacking, key=lambda form: len(form.free))
            full = stepwise.polished(begun_in_form(stepwise, trial, candidate, fullest))
            return simplified(stepwise, full)
    return None


def _weakness(
    stepwise: StepwiseSearch, trial: FittedModel, steps: list[Step], fit: Fit
) -> Weakness | None:
    """The candidate of a trial that gains least of those that are not confirmed, and why not; None
    where all are. What is known of the others may change once it is out.
    """
    floor = noise_floor_of(stepwise.problem, trial, stepwise.propagated)
    quiet = leaves_noise_alone(trial, floor)
    by_inputs = replace(floor, propagated=stepwise.input_noise_for(trial))
    by_gain = sorted(steps, key=lambda s: s.gain.share)
    refit = partial(_without_run, stepwise.problem, trial)
    for step in by_gain:
        if not stepwise.is_needed(step):
            return Weakness(step, _too_little(stepwise.problem, step))
        if is_within_noise_of_inputs(step.without, by_inputs):
            return Weakness(step, "without it the residual is within the noise of the inputs")
        member = with_what_needs_it(step.candidate, trial.candidates)
        reason = why_unconfirmed(fit, member, quiet, refit)
        if reason is not None:
            return Weakness(step, reason)
        space = stepwise.proposals.space
        if space is not None and contradicts_its_law(
            stepwise.problem, space, trial.candidates, trial.values, step.candidate
        ):
            return Weakness(
                step, "its torque depends on the speed in another way than its law", breaks_law=True
            )
        if not quiet:
            doubt = _doubt_beside_residual(stepwise.problem, trial, step)
            if doubt is not None:
                return Weakness(step, doubt)
    if not is_moved_by_inputs(stepwise.problem, trial):
        return Weakness(by_gain[0], "with it the simulated motion no longer depends on the inputs")
    return None


def _doubt_beside_residual(problem: SearchProblem, trial: FittedModel, step: Step) -> str | None:
    """Why a step cannot be named where the residual exceeds the noise, which a wrong effect may
    imitate: the lower limit of its gain is below one half, or it reduces slow drift alone.
    """
    if not step.gain.is_most:
        return f"{step.gain.in_words}, too little while the residual exceeds the noise"
    if gain_in_innovations(trial, step.without).share < problem.material:
        return "reduces slow drift alone, which other missing effects can cause as well"
    return None


def _too_little(problem: SearchProblem, step: Step) -> str:
    """Why the gain of a step is too small for a name."""
    earned, material = step.gain, problem.material
    if earned.share <= 0.0:
        return "does not improve the prediction of blocks left out"
    if earned.share < material:
        share = f"{100.0 * earned.share:.0f} %"
        return f"reduces the sum of squares by {share} only; {100.0 * material:g} % are required"
    tests = looked_at(problem.candidates, [step.candidate])
    chance = earned.smallest_chance(step.p_value)
    return (
        f"{earned.in_words}, which is not significant: chance {chance:.2g}, of {tests} compared"
        f" {FALSE_ALARM / tests:.2g} is required"
    )
