"""Which structure explains the logs: the declared platform and those one structure away from it are
fitted, the best go on into the search for terms, and what each ends with is compared.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from ptp_symbolic.models import variants
from ptp_symbolic.models.structures import Rebuilt, family, structures
from ptp_symbolic.models.variants import candidate_effects
from ptp_symbolic.numeric.diagnose.fitted_model import (
    FittedModel,
    SearchProblem,
    deviances,
)
from ptp_symbolic.numeric.diagnose.gain import (
    Gain,
    gain,
    held_out_gain,
    is_validated,
    simulated_freely,
)
from ptp_symbolic.numeric.diagnose.groups import Alternative, confusable
from ptp_symbolic.numeric.diagnose.noise_floor import leaves_noise_alone, noise_floor_of
from ptp_symbolic.numeric.diagnose.refits import is_near_noise_floor
from ptp_symbolic.numeric.diagnose.search import continued, search
from ptp_symbolic.numeric.diagnose.stepwise import Search
from ptp_symbolic.numeric.diagnose.structures import (
    FittedStructure,
    alternatives,
    effects_of,
    gain_over,
    is_better,
    named_effects,
    on_runs_of,
    structure_row,
    terms_beside,
    unaffected_axes,
    why_rejected,
)
from ptp_symbolic.numeric.diagnose.verdict import (
    Verdict,
    decide,
    word_of,
)
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.numeric.identify.windows import parted_like
from ptp_symbolic.platform import Platform
from ptp_symbolic.workflows.preparation import effect_keys, model_of, problem_for, with_effects
from ptp_symbolic.workflows.structure_fits import (
    Fitted,
    Logs,
    fit_structures,
    in_scale,
    leading_platform,
    on_axes_of,
    pairs_with,
)

FAR_BEHIND = "with terms beside it, the best leaves surely less than half of its squared error"
IDLE = "not tried: nothing is left to explain on this axis"
SHARE = 0.5  # of the allowance, for fits of structures: what terms beside them take is left
LEAST_SHARE = 0.1  # of the allowance, for a search beside a structure that fits well


@dataclass(frozen=True, eq=False)
class Outcome:
    """What one structure ends with: the `platform` with it, the search for terms in it, and its
    verdict. `structure` is None for the declared one.
    """

    platform: Platform
    structure: FittedStructure | None
    problem: SearchProblem
    found: Search
    verdict: Verdict

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the effects of the structure."""
        return self.structure.keys if self.structure else ()


@dataclass(frozen=True, eq=False)
class Searched:
    """A structure with the search for terms in it, brief or whole; the verdict on it is reached
    when `decided` is asked for.
    """

    platform: Platform
    structure: FittedStructure | None
    problem: SearchProblem
    found: Search

    @property
    def is_noise_alone(self) -> bool:
        """Whether the chosen set leaves noise alone."""
        trial = self.found.chosen
        return leaves_noise_alone(
            trial, noise_floor_of(self.found.problem, trial, self.found.propagated)
        )

    @cached_property
    def decided(self) -> Outcome:
        """What it ends with, by the rules of `decide`."""
        verdict = decide(self.found)
        return Outcome(self.platform, self.structure, self.problem, self.found, verdict)


@dataclass(frozen=True, eq=False)
class Choice:
    """The chosen outcome, `terms` (the outcome of the declared structure), a row for every
    structure, and why candidates were not tried, by key; `is_cut_short` says that its allowance
    was used up.
    """

    chosen: Outcome
    terms: Outcome
    rows: tuple[dict[str, Any], ...]
    untried: Mapping[str, str]
    is_cut_short: bool


def chosen_structure(platform: Platform, logs: Logs) -> Choice:
    """Search for terms of the declared platform, and where that adds any or leaves more than noise
    fit every structure one step away from it; search for terms in the best of them too, and choose.
    Once the allowance is over nothing new is begun, and no further fits of structures where their
    share does not pay for as much as the first took; the best are searched all the same.

    Where terms leave noise alone and a delay is among them, structures are fitted beside the
    others: a lag may be what it was named for. An axis with nothing left to explain has none.

    All searches are brief at first. The whole one follows where that leaves noise alone in most
    windows, not in all; and where no answer is found soon, of the structure that fits best, and of
    the declared one where that is beaten by little.
    """
    every, untried = structures(platform)
    untried |= variants.that_cannot_stand(platform)
    every = in_scale(every, platform)
    platforms = _platforms(every)

    def searched(structure: FittedStructure | None, begin: Searched | None = None) -> Searched:
        logs.progress(f"searching for terms beside {_name(structure)}")
        there = platforms[structure.keys, structure.provides] if structure else platform
        found = _searched(there, structure, logs, begin, brief=bool(every))
        return _continued(found, logs) if found.is_noise_alone else found

    terms = searched(None)
    is_enough = terms.is_noise_alone and not terms.found.chosen.candidates
    is_stopped = logs.allowance.is_out_of_time
    if not every or is_enough or is_stopped:
        why = "the residual of the declared structure is noise alone"
        why = f"not tried: {why if is_enough else 'the time was over'}"
        untried = {**untried, **{key: why for each in every for key in each.keys}}
        is_cut_short = is_stopped or terms.found.is_cut_short
        return Choice(terms.decided, terms.decided, (), untried, is_cut_short)
    idle = unaffected_axes(terms.found, terms.is_noise_alone)
    untried |= {key: IDLE for r in every if r.axes <= idle for key in r.keys}
    every = tuple(r for r in every if not r.axes <= idle)
    found = terms.found.chosen.values
    beside = None if terms.is_noise_alone else _with_found(platform, terms)
    there = _with_found(platform, terms) if terms.is_noise_alone and _late(terms) else None
    before = logs.allowance.work.samples
    shared = replace(logs, allowance=logs.allowance.part(SHARE))
    if there is not None:
        beside_late = on_axes_of(every, in_scale(structures(there)[0], platform))
        fitted = fit_structures(there, beside_late, shared, found)
    else:
        known = found if terms.is_noise_alone else None
        fitted = fit_structures(platform, every, shared, known, terms.found if beside else None)
    is_paid = shared.allowance.pays_for(logs.allowance.work.samples - before) >= 1.0
    if not terms.is_noise_alone and not fitted.quiet and is_paid:
        again = _fitted_beside(platform, beside, fitted, shared, found) if beside else None
        again = again or _led(platform, every, fitted, shared)
        fitted = again or fitted.over_windows_too(shared)
        if not fitted.quiet and fitted.order and not shared.allowance.is_over:
            fitted, paired = _paired(platform, fitted, every, shared)
            platforms |= _platforms(paired)
    followed = fitted.quiet or ([] if terms.is_noise_alone else fitted.followed)
    outcomes = [searched(s) for s in followed]
    if not logs.allowance.is_over:
        outcomes = [_from_what_contains_it(one, outcomes, searched) for one in outcomes]
    if not terms.is_noise_alone:
        fitted, outcomes = _followed_on(platform, fitted, outcomes, searched, logs)
    is_late = not terms.is_noise_alone and logs.allowance.is_over
    if not terms.is_noise_alone and not logs.allowance.is_out_of_time:
        outcomes, terms = _at_length(outcomes, terms, logs)
    left = _not_far_behind(outcomes)
    chosen, refused = _chosen(terms.decided, [s.decided for s in left], fitted, logs)
    refused |= {s.structure: FAR_BEHIND for s in outcomes if s.structure and s not in left}
    order = fitted.order
    rest = [s for s in fitted.every if s not in order]
    alike = _alike(chosen, fitted)
    own = set(effect_keys(platform))
    leading = [e.title for e in fitted.declared.problem.model.effects if e.key not in own]
    named = chosen.structure
    rows = tuple(
        structure_row(s, fitted.declared, named, refused, alike, leading) for s in [*order, *rest]
    )
    is_late |= any(s.found.is_cut_short for s in [terms, *outcomes])
    return Choice(chosen, terms.decided, rows, {**untried, **fitted.failed}, is_late)


def _platforms(every: Sequence[Rebuilt]) -> dict[tuple[tuple[str, ...], frozenset[str]], Platform]:
    """The platforms of structures by keys and mechanisms: kinds of one effect have one key."""
    return {(rebuilt.keys, rebuilt.provides): rebuilt.platform for rebuilt in every}


def _with_found(platform: Platform, one: Searched) -> Platform | None:
    """The platform with the effects that a search found and that can be there without its
    structure, where these surely halve the squared error; None where they do not. A delay is not
    among them, for it makes up for the lag of a structure. What was declared free starts as it was:
    viscous friction has gone from one side of a gear to the other where only their sum is known.
    """
    trial, own = one.found.chosen, {(e.effect, e.axis) for e in candidate_effects(platform)}
    late = _late(one)
    kept = tuple(
        c
        for c in trial.candidates
        if c.is_declared_value or ((c.id, c.axis) in own and c.key not in late)
    )
    if all(c.is_declared_value for c in kept):
        return None
    without = on_runs_of(one.found.problem, one.found.declared, trial.fit.runs)
    if not gain(trial, without).is_most:
        return None
    return with_effects(platform, replace(trial, candidates=kept), moves=False)


def _late(one: Searched) -> set[str]:
    """Keys of the delays that a search found."""
    trial = one.found.chosen
    late = {trial.fit.model.parameter_names[k] for k in trial.fit.model.input_delays if k >= 0}
    return {c.key for c in trial.candidates if late & set(c.parameters)}


def _fitted_beside(
    platform: Platform,
    beside: Platform,
    fitted: Fitted,
    logs: Logs,
    known: Mapping[str, float] | None = None,
) -> Fitted | None:
    """The structures fitted again `beside` effects that were found with `known` values; None where
    none predicts better than these alone.
    """
    own = {(s.keys, s.provides) for s in fitted.every}
    better = {(s.keys, s.provides) for s in (fitted.every[k] for k in fitted.better)}
    every = in_scale(structures(beside)[0], platform)
    kept = [r for r in every if (r.keys, r.provides) in (better if r.of else own)]
    found = fit_structures(beside, kept, logs, known)
    found = found if found.quiet else found.over_windows_too(logs)
    return replace(found, failed={**fitted.failed, **found.failed}) if found.order else None


def _led(platform: Platform, every: Sequence[Rebuilt], fitted: Fitted, logs: Logs) -> Fitted | None:
    """The structures fitted beside what leads some of them, if the best is one of these then: a
    torque also makes up for friction that differs by direction, beside any other.
    """
    leading = leading_platform(platform, every, fitted, logs)
    found = _fitted_beside(platform, leading, fitted, logs) if leading else None
    led = {family(r.keys, r.provides) for r in every if r.beside}
    best = found.order[0] if found else None
    return found if best and family(best.keys, best.provides) in led else None


def _followed_on(
    platform: Platform,
    fitted: Fitted,
    outcomes: list[Searched],
    searched: Callable[..., Searched],
    logs: Logs,
) -> tuple[Fitted, list[Searched]]:
    """The structures fitted once more beside the effects that were found in the best of those that
    were followed, where that leaves more than noise; and the best of them followed too: which one
    fits best without terms depends on the terms that are missing.
    """
    if not outcomes or any(s.is_noise_alone for s in outcomes) or logs.allowance.is_over:
        return fitted, outcomes
    best = _best_fit(outcomes)
    beside = _with_found(platform, best)
    known = {effect.key for effect in fitted.declared.problem.model.effects}
    found = None
    if beside is not None and not known.issuperset(effect_keys(beside)):
        found = _fitted_beside(platform, beside, fitted, logs, best.found.chosen.values)
    there = {(s.keys, s.provides): s for s in found.every} if found else {}
    own = [(s.structure.keys, s.structure.provides) for s in outcomes if s.structure]
    if found is None or not all(key in there for key in own):
        return fitted, outcomes
    moved = [replace(s, structure=there[key]) for s, key in zip(outcomes, own, strict=True)]
    first = (found.quiet or found.order)[0]
    if all(s.structure is not first for s in moved) and not logs.allowance.is_over:
        moved.append(searched(first))
    return found, moved


def _paired(
    platform: Platform, fitted: Fitted, every: Sequence[Rebuilt], logs: Logs
) -> tuple[Fitted, Sequence[Rebuilt]]:
    """The fitted structures, and pairs of the best one, or the simplest that it contains, and each
    of those one step away from it, where one of these leaves noise alone: bristles show beside the
    shaft that they are behind.

    A best one near the noise floor that does not surely halve the squared error of the declared
    structure is no half of a pair: such logs show many small deviations, not two large ones.
    """
    best = fitted.order[0]
    contained = [s for s in fitted.order if s.provides < best.provides]
    best = min(contained, key=lambda s: len(s.provides), default=best)
    if is_near_noise_floor(best.trial) and not gain_over(best, fitted.declared).is_most:
        return fitted, ()
    logs.progress(f"fitting pairs with {' + '.join(best.keys)}")
    beside, there = pairs_with(best, fitted.platform, every)
    found = fit_structures(there, beside, logs)
    if not found.quiet:
        found = found.over_windows_too(logs)
    if not found.quiet:
        return fitted, ()
    finished = tuple(found.every[k] for k in found.better)
    own, _ = pairs_with(best, platform, every)
    return replace(fitted, every=(*fitted.every, *finished)), own


def _from_what_contains_it(
    one: Searched, outcomes: Sequence[Searched], searched: Callable[..., Searched]
) -> Searched:
    """A search in a structure that leaves more than noise, made again from the values of a larger
    structure that leaves noise alone, and kept if it does so too: shaft and gap lead to the place
    where the shaft alone is enough.
    """
    richer = [s for s in outcomes if s.is_noise_alone and _contains(s, one)]
    if one.is_noise_alone or not richer:
        return one
    again = searched(one.structure, richer[0])
    return again if again.is_noise_alone else one


def _at_length(
    outcomes: Sequence[Searched], terms: Searched, logs: Logs
) -> tuple[list[Searched], Searched]:
    """The searches, in whole where they were brief: in the structure that fits best, or in its
    simplest part that is not far behind (a gap beside a shaft may make up for a missing term), and
    in the declared one unless that is far behind.
    """
    best = _best_fit([terms, *outcomes])
    if best is not terms and not best.is_noise_alone:
        as_good = [s for s in outcomes if _contains(best, s) and not _is_far_ahead(best, s)]
        found = min(
            as_good or [best], key=lambda s: len(s.structure.provides) if s.structure else 0
        )
        whole = _continued(found, logs)
        outcomes = [whole if s is found else s for s in outcomes]
        best = _best_fit([best, whole]) if found is not best else whole
    if best is terms or not _is_far_ahead(best, terms):
        terms = _continued(terms, logs)
    return list(outcomes), terms


def _continued(one: Searched, logs: Logs) -> Searched:
    """The search, in whole where it was brief."""
    if not one.found.is_brief:
        return one
    logs.progress(f"searching on for terms beside {_name(one.structure)}")
    problem = replace(one.problem, allowance=logs.allowance.rest(LEAST_SHARE))
    return replace(one, found=continued(problem, one.found))


def _name(structure: FittedStructure | None) -> str:
    return " + ".join(structure.keys) if structure else "what is declared"


def _contains(one: Searched, other: Searched) -> bool:
    """Whether the structure of the first is that of the second, and more."""
    assert one.structure is not None and other.structure is not None
    return other.structure.provides < one.structure.provides


def _best_fit(searches: Sequence[Searched]) -> Searched:
    """The search that ends with the best fit, in the windows of the first one."""
    return searches[_least([(s.found.problem, s.found.chosen) for s in searches])]


def _least(ends: Sequence[tuple[SearchProblem, FittedModel]]) -> int:
    """Which of some trials, each of its own problem, fits best in the windows of the first one."""
    pattern = ends[0][1].fit.runs
    cost = deviances([on_runs_of(problem, trial, pattern) for problem, trial in ends])
    return min(range(len(cost)), key=cost.__getitem__)


def _not_far_behind(outcomes: Sequence[Searched]) -> Sequence[Searched]:
    """Those that may be chosen: where the best leaves noise alone, none that it is far ahead of."""
    if len(outcomes) < 2:
        return outcomes
    best = _best_fit(outcomes)
    if not best.is_noise_alone:
        return outcomes
    return [s for s in outcomes if s is best or s.is_noise_alone or not _is_far_ahead(best, s)]


def _is_far_ahead(one: Searched, other: Searched) -> bool:
    """Whether the first surely halves the squared error of the second."""
    trial = one.found.chosen
    return gain(trial, on_runs_of(other.found.problem, other.found.chosen, trial.fit.runs)).is_most


def _searched(
    platform: Platform,
    structure: FittedStructure | None,
    logs: Logs,
    begin: Searched | None = None,
    *,
    brief: bool,
) -> Searched:
    """Search for terms in a structure, begun at the values that it was fitted with, or at those
    that another search ended with; for none where the structure is enough, or the time is over.
    """
    begun, is_alone = platform, False
    if structure is not None:
        is_all_its_own = len(structure.problem.model.effects) == len(platform.effects)
        is_alone = logs.allowance.is_out_of_time or (structure.is_noise_alone and is_all_its_own)
        if is_alone and is_all_its_own:
            return Searched(platform, structure, structure.problem, structure.without_terms())
        values = structure.trial.values
        if begin is not None:
            there = begin.found.chosen.values
            values = {name: there.get(name, value) for name, value in values.items()}
        begun = variants.extended(platform, (), values, ())
    model = model_of(begun if is_alone else variants.with_candidates(begun))
    problem = problem_for(
        begun,
        model,
        logs.train,
        logs.validate,
        effect_keys(begun),
        logs.executor,
        logs.progress,
        logs.allowance.rest(LEAST_SHARE),
    )
    starts = {p.name: p.value for p in platform.parameters}
    free = tuple(replace(f, declared_start=starts[f.name]) for f in problem.free)
    problem = replace(problem, free=free)
    found = search(problem, brief=brief, known=terms_beside(structure, problem))
    return Searched(platform, structure, problem, found)


def _chosen(
    terms: Outcome, outcomes: Sequence[Outcome], fitted: Fitted, logs: Logs
) -> tuple[Outcome, dict[FittedStructure, str]]:
    """The outcome that predicts best, and why structures that were followed are not named."""
    others = fitted.every
    refused: dict[FittedStructure, str] = {}
    accepted: list[tuple[Outcome, Outcome]] = []
    as_good: list[Alternative] = []
    for outcome in outcomes:
        structure = outcome.structure
        assert structure is not None
        final = outcome.verdict.final
        without = on_runs_of(terms.found.problem, terms.verdict.final, final.fit.runs)
        quiet = not outcome.verdict.leaves_more
        problem = outcome.found.problem
        earned, why = why_rejected(structure, problem, final, without, quiet, len(others))
        part = part_as_good(outcome, outcomes, others) if why is None else None
        if part is not None:
            why = f"{' + '.join(part.keys)}, a part of it, predicts as well"
        if why is None and is_beaten_by_terms(final, terms, problem.material):
            why = f"{' + '.join(terms.found.chosen.keys)} predicts better, but is not confirmed"
        if why is None:
            named = _with_structure(outcome, terms, earned, fitted, logs)
            if _is_borne_out(named, quiet):
                accepted.append((outcome, named))
                continue
            why = "reduces the error of the validation runs too little, or not significantly"
        if terms.verdict.final.candidates:
            other = final if quiet else outcome.found.chosen
            by_terms = on_runs_of(terms.found.problem, terms.verdict.final, other.fit.runs)
            against = gain(by_terms, other)
            is_as_good = not against.is_better(problem.material)
            if is_as_good if quiet else beats_terms(other, by_terms, problem.material):
                candidates = (*structure.added, *other.candidates)
                as_good.append(Alternative(replace(other, candidates=candidates), against))
        refused[structure] = why
    if accepted:
        ends = [(o.found.problem, o.verdict.final) for o, _ in accepted]
        return accepted[_least(ends)][1], refused
    if as_good:
        return _beside(terms, as_good), refused
    return terms, refused


def part_as_good(
    outcome: Outcome, outcomes: Sequence[Outcome], others: Sequence[FittedStructure]
) -> FittedStructure | None:
    """A part of the structure of an outcome that predicts as well alone; None where each predicts
    worse. A gap may seem identified beside a shaft that is not, though the shaft is enough.
    """
    structure, final = outcome.structure, outcome.verdict.final
    assert structure is not None
    ends = {o.structure: o for o in outcomes}
    for part in (s for s in others if s.provides < structure.provides and not s.trial.fit.failed):
        if part in ends:
            found = ends[part]
            by_part = on_runs_of(found.found.problem, found.verdict.final, final.fit.runs)
            is_more = gain(final, by_part).is_better(outcome.found.problem.material)
        else:
            is_more = is_better(structure, part)
        if not is_more:
            return part
    return None


def is_beaten_by_terms(final: FittedModel, terms: Outcome, material: float) -> bool:
    """Whether the terms found in the declared structure predict better, confirmed or not."""
    return gain(
        on_runs_of(terms.found.problem, terms.found.chosen, final.fit.runs), final
    ).is_better(material)


def beats_terms(other: FittedModel, named: FittedModel, material: float) -> bool:
    """Whether what was found in a structure, confirmed or not, predicts better than `named` terms
    of the declared one, beside which more than noise remains.
    """
    return gain(other, named).is_better(material)


def _beside(terms: Outcome, as_good: Sequence[Alternative]) -> Outcome:
    """The outcome of the declared structure, with structures that its terms cannot be told from."""
    verdict = terms.verdict
    found = confusable(verdict.final, [*verdict.alternatives, *as_good])
    merged = {
        key: tuple(sorted({*verdict.confusable.get(key, ()), *found[key]}))
        for key in verdict.final.keys
    }
    quiet = not verdict.leaves_more
    word = word_of(verdict.final, merged, quiet)
    return replace(terms, verdict=replace(verdict, confusable=merged, word=word))


def _with_structure(
    outcome: Outcome, terms: Outcome, earned: Gain, fitted: Fitted, logs: Logs
) -> Outcome:
    """The outcome with its structure named: among the effects of the final model, what was declared
    as the model before.
    """
    structure, verdict = outcome.structure, outcome.verdict
    assert structure is not None
    equals = _alike(outcome, fitted)
    if any(s.keys == structure.keys for s in equals):  # no log tells where the friction sits
        plain = replace(structure, added=effects_of(structure.problem, structure.keys))
    else:
        plain = structure
    own = named_effects(plain, verdict.final)
    final = replace(verdict.final, candidates=(*own, *verdict.final.candidates))
    alike = [Alternative(s.trial, gain_over(structure, s)) for s in equals]
    names = {c.key for s in equals for c in s.with_parameters} - set(structure.keys)
    group = {c.key: tuple(sorted(names)) for c in own}
    merged = {**verdict.confusable, **group}
    quiet = not verdict.leaves_more
    before = _declared_validation(terms, verdict.after, logs)
    declared = on_runs_of(terms.found.problem, terms.verdict.declared, final.fit.runs)
    gains = {**verdict.gains, **dict.fromkeys([c.key for c in own], earned)}
    return replace(
        outcome,
        verdict=replace(
            verdict,
            word=word_of(final, merged, quiet),
            final=final,
            declared=declared,
            gains=gains,
            confusable=merged,
            alternatives=(*verdict.alternatives, *alike),
            closest=None,
            before=before,
            held_out=held_out_gain(verdict.after, before),
            is_quiet=quiet,
        ),
    )


def _alike(outcome: Outcome, fitted: Fitted) -> list[FittedStructure]:
    """The structures that the one of an outcome is not told from."""
    if outcome.structure is None:
        return []
    quiet = not outcome.verdict.leaves_more
    return alternatives(outcome.structure, fitted.every, None if quiet else fitted.declared)


def _declared_validation(terms: Outcome, after: Fit, logs: Logs) -> Fit:
    """The validation runs by the declared model, in the windows of another fit of them."""
    problem, declared = terms.found.problem, terms.verdict.declared
    whole = prepare_runs(problem.model, terms.platform, logs.validate)
    return simulated_freely(problem, parted_like(problem.model, whole, after.runs), declared.values)


def _is_borne_out(named: Outcome, quiet: bool) -> bool:
    """Whether the validation runs bear out the final model, structure and terms together."""
    held_out = named.verdict.held_out
    return held_out is not None and is_validated(held_out, quiet, False, named.problem.material)
