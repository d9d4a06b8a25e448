"""Candidates that these logs do not distinguish from one that was chosen.

An effect of the chosen set is compared, at the fit, with what every other candidate would change in
the outputs, both projected off what the declared parameters and the other effects can follow
(canonical correlation: Hotelling, 1936). Those that resemble it are refitted in its place to the
same depth; the ones that predict as well form its group.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import (
    Candidate,
    with_what_it_brings,
    with_what_needs_it,
    without_member,
)
from ptp_symbolic.numeric.diagnose.fitted_model import (
    FittedModel,
    SearchProblem,
    fitted,
    halving,
    keys_of,
    ranked,
)
from ptp_symbolic.numeric.diagnose.gain import Gain, gain
from ptp_symbolic.numeric.diagnose.noise_floor import (
    NoiseFloor,
    is_within_noise_of_inputs,
    noise_floor_of,
)
from ptp_symbolic.numeric.diagnose.proposals import ProposedSets, start_for
from ptp_symbolic.numeric.diagnose.refits import is_near_noise_floor, restarted_fit
from ptp_symbolic.numeric.diagnose.responses import (
    Columns,
    canonical_correlation,
    effect_of,
    least,
    projected_off,
    response_columns,
    stacked_jacobian,
    stacked_residual,
)
from ptp_symbolic.numeric.diagnose.signatures import Signature
from ptp_symbolic.numeric.diagnose.stepwise import StepwiseSearch
from ptp_symbolic.numeric.identify.constants import MATERIAL, MOST, REACH
from ptp_symbolic.numeric.identify.coordinates import to_search, to_values
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Alternative:
    """A set that these logs do not distinguish from the chosen one; `gain` is that of the chosen
    one over it.

    It predicts as well, or it `is_within_input_noise`: the chosen one predicts better, but the
    residual of this one is within the propagated noise of the inputs.
    """

    trial: FittedModel
    gain: Gain
    is_within_input_noise: bool = False


@dataclass(frozen=True, eq=False)
class Similarity:
    """A candidate in the place of another: canonical correlation, and where its refit starts."""

    candidate: Candidate
    correlation: float
    values: dict[str, float]


def refitted_alternatives(
    stepwise: StepwiseSearch, chosen: FittedModel, fit: Fit
) -> list[Alternative]:
    """Sets as large as the chosen one that these logs do not refute (`not_refuted`), those that the
    search has started already among them. `fit` is the fit of the chosen one, from
    `with_finite_differences`.

    A few iterations show which come near the chosen set. A set with an indistinguishable response
    is fitted to its end where these come near the noise floor, and where the residual of the chosen
    one exceeds the noise, however far it is till then.
    """
    problem = stepwise.problem
    near = [t for t in ranked(stepwise.tried.others) if _comes_near(t, chosen)]
    tried = {t.keys for t in near}
    begun: list[FittedModel] = []
    resembling: set[tuple[str, ...]] = set()
    for member in chosen.candidates:
        kept = without_member(chosen.candidates, member)
        instead = partial(with_what_it_brings, kept, candidates=problem.candidates)
        similar = look_alikes(problem, chosen, fit, with_what_needs_it(member, chosen.candidates))
        begun += [
            fitted(problem, instead(s.candidate), s.values, chosen.fit.z, 0, fit) for s in similar
        ]
        along = alike_along_motion(stepwise.proposals, chosen, member)
        wanted = {c.key: c for c in (*(s.candidate for s in similar), *along)}
        for candidate in wanted.values():
            if keys_of(instead(candidate)) not in tried:
                begun += _in_place(problem, stepwise.proposals, instead(candidate), chosen)
        resembling |= {keys_of(instead(s.candidate)) for s in similar}
    if begun:
        problem.progress(f"refitting {len(begun)} sets that resemble the chosen one")
    trials = [*halving(problem, begun, len(begun)), *near]
    best: dict[tuple[str, ...], FittedModel] = {}
    for trial in ranked(trials):
        best.setdefault(trial.keys, trial)
    found = []
    for trial in best.values():
        resembles = trial.keys in resembling
        if resembles and not stepwise.is_white(chosen):
            found.append(restarted_fit(problem, stepwise.polished(trial), stepwise.propagated))
        elif gain(chosen, trial).share < 1.0 - problem.material or (
            resembles and is_near_noise_floor(trial)
        ):
            found.append(stepwise.polished(trial))
    compared = [Alternative(trial, gain(chosen, trial)) for trial in found]
    return not_refuted(
        compared,
        noise_floor_of(problem, chosen, stepwise.input_noise_for(chosen)),
        problem.material,
    )


def not_refuted(
    found: Sequence[Alternative], floor: NoiseFloor, material: float
) -> list[Alternative]:
    """Those over which the chosen set has no material and significant gain; and those whose
    residual is within the usual propagated noise of the inputs: it would be as large if they were
    true, and another set may follow a part of it.
    """
    worse = [other.gain.is_better(material, len(found)) for other in found]
    return [
        replace(other, is_within_input_noise=is_worse)
        for other, is_worse in zip(found, worse, strict=True)
        if not is_worse or is_within_noise_of_inputs(other.trial, floor)
    ]


def _comes_near(other: FittedModel, chosen: FittedModel) -> bool:
    """Whether another set as large as the chosen one predicts nearly as well, as far as it was
    fitted.
    """
    if len(other.candidates) != len(chosen.candidates) or other.keys == chosen.keys:
        return False
    return bool(np.isfinite(other.fit.cost)) and gain(chosen, other).share < MOST


def better_alternative(
    chosen: FittedModel, found: Sequence[Alternative], material: float
) -> FittedModel | None:
    """The best of the alternatives that predict significantly better than the chosen set, by a
    `material` share; None if none does.
    """
    tests = len(found)
    better = [r.trial for r in found if gain(r.trial, chosen).is_better(material, tests)]
    return ranked(better)[0] if better else None


def _in_place(
    problem: SearchProblem,
    proposals: ProposedSets,
    candidates: Sequence[Candidate],
    trial: FittedModel,
) -> list[FittedModel]:
    """A set like that of `trial`, where the rows start it, and where they start its candidates
    alone.
    """
    start, run = start_for(problem, proposals, candidates, trial.values), problem.executor
    beside = trial.values | {name: start[name] for c in candidates for name in c.names}
    return [
        fitted(problem, candidates, values, None, 0, executor=run) for values in (start, beside)
    ]


def alike_along_motion(
    found: ProposedSets, chosen: FittedModel, member: Candidate
) -> list[Candidate]:
    """Candidates whose signature correlates above 1 - MATERIAL with that of `member`, as it is
    fitted, apart from what the declared parameters and the other members can follow; best first.
    """
    rows = found.regression
    if rows is None:
        return []
    root = np.sqrt(rows.weight)[:, None]
    own = {c.key for c in chosen.candidates}
    mine = [s for s in rows.signatures if s.candidate.key == member.key]
    named = {f.name for f in member.defining}
    whole = [s for s in mine if {f.name for f in s.candidate.defining} == named]
    if not whole:
        return []
    parts = [
        slope * (chosen.values[f.name] - member.vanishing[f.name])
        for f, slope in zip(whole[0].candidate.defining, _nearest(whole[0], chosen), strict=True)
    ]
    rest = [s.columns for s in rows.signatures if s.candidate.key in own - {member.key}]
    away = np.column_stack([rows.base, *rest]) * root
    target = projected_off(np.sum(parts, axis=0)[:, None] * root, away)[:, 0]
    correlation: dict[str, tuple[float, Candidate]] = {}
    for s in rows.signatures:
        if s.candidate.key in own:
            continue
        value = canonical_correlation(target, projected_off(s.columns * root, away))
        if value > max(1.0 - MATERIAL, correlation.get(s.candidate.key, (0.0, s.candidate))[0]):
            correlation[s.candidate.key] = value, s.candidate
    return [c for _, c in sorted(correlation.values(), key=lambda pair: -pair[0])]


def _nearest(signature: Signature, chosen: FittedModel) -> tuple[FloatArray, ...]:
    """The slopes at the shaping values nearest to the fitted ones."""
    here = chosen.values
    far = [
        sum(abs(v - here[name]) / max(abs(v), abs(here[name]), 1e-300) for name, v in shape.items())
        for shape in signature.candidate.shapes
    ]
    return signature.slopes[int(np.argmin(far))]


def confusable(chosen: FittedModel, found: Sequence[Alternative]) -> dict[str, tuple[str, ...]]:
    """For every key of the chosen set the keys of its alternatives."""
    named: dict[str, set[str]] = {key: set() for key in chosen.keys}
    for other in found:
        for key in set(chosen.keys) - set(other.trial.keys):
            named[key] |= set(other.trial.keys) - set(chosen.keys)
    return {key: tuple(sorted(keys)) for key, keys in named.items()}


def look_alikes(
    problem: SearchProblem, trial: FittedModel, fit: Fit, member: Candidate
) -> list[Similarity]:
    """Candidates whose response has a canonical correlation above 1 - MATERIAL with the effect of
    `member` at `fit`, best first.
    """
    full = {c.key: c for c in sorted(problem.candidates, key=lambda c: len(c.free))}
    wanted = [c for c in full.values() if c.key not in trial.keys]
    by_key = {c.key: c for c in reversed(problem.candidates)}
    brings = [by_key[key] for c in wanted for key in c.brings if key in by_key]
    found = _look_alikes(problem, trial, fit, member, wanted, brings)
    return [Similarity(wanted[k], correlation, values) for k, correlation, values in found]


@recorded()
def _look_alikes(
    problem: SearchProblem,
    trial: FittedModel,
    fit: Fit,
    member: Candidate,
    wanted: Sequence[Candidate],
    brings: Sequence[Candidate],
) -> list[tuple[int, float, dict[str, float]]]:
    """By number in `wanted`, what `look_alikes` finds of them; `brings` are all candidates that
    they bring along.
    """
    residual = stacked_residual(fit)
    table = stacked_jacobian(fit)
    own = [k for k, f in enumerate(fit.free) if f.name in member.parameters]
    others = [k for k in range(len(fit.free)) if k not in own]
    effect = effect_of(fit, member.vanishing, table)
    away = table[:, others]
    target = projected_off(effect[:, None], away)[:, 0]
    size = float(np.linalg.norm(target))
    if size == 0.0:
        return []
    off = {name: member.vanishing[f.name] for f in member.defining for name in f.names}
    base = trial.values | off
    every = [(k, shape) for k, c in enumerate(wanted) for shape in c.shapes]
    most = REACH * float(np.linalg.norm(effect))

    def compare(
        pair: tuple[int, Mapping[str, float]],
    ) -> tuple[int, float, dict[str, float]] | None:
        number, shape = pair
        candidate = wanted[number]
        found = response_columns(problem, trial, candidate, shape, most)
        if found is None:
            return None
        correlation = canonical_correlation(target, projected_off(found.table, away))
        if correlation < 1.0 - MATERIAL:
            return None
        values = _instead(base, fit, others, residual - effect, away, found)
        return number, correlation, values | dict(found.base)

    best: dict[int, tuple[int, float, dict[str, float]]] = {}
    jobs = [s for s in problem.executor.map(compare, every) if s is not None]
    for s in sorted(jobs, key=lambda s: -s[1]):
        best.setdefault(s[0], s)
    return list(best.values())


def _instead(
    base: Mapping[str, float],
    fit: Fit,
    others: Sequence[int],
    residual: FloatArray,
    away: FloatArray,
    found: Columns,
) -> dict[str, float]:
    """Values of all parameters at which `found` explains the `residual` of the fit without a
    member.
    """
    amounts, _ = least(residual, away, found)
    shift = np.zeros(len(fit.free))
    shift[list(others)] = amounts[: len(others)]
    phi = to_search(fit.free, fit.values) + shift
    there = to_values(fit.free, phi)
    values = dict(base)
    for k in others:
        f = fit.free[k]
        values.update(dict.fromkeys(f.names, there[f.name]))
    values.update(found.values(amounts[len(others) :]))
    return values
