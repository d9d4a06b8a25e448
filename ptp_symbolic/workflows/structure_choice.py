"""Which structure the logs ask for: the declared platform and those one structure away from it are
fitted, the best go on into the search for terms, and what each ends with is compared.
"""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import variants
from ptp_symbolic.models.structures import Rebuilt, structures
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose.findings import Search
from ptp_symbolic.numeric.diagnose.floor import floor_of, leaves_noise_alone
from ptp_symbolic.numeric.diagnose.gain import Gain, gain
from ptp_symbolic.numeric.diagnose.groups import Rival, confusable, is_clearly_more
from ptp_symbolic.numeric.diagnose.held_out import held_out_gain, is_borne_out, simulated_freely
from ptp_symbolic.numeric.diagnose.search import search
from ptp_symbolic.numeric.diagnose.side_by_side import side_by_side
from ptp_symbolic.numeric.diagnose.structures import (
    Begun,
    FittedStructure,
    alternatives,
    begin_structure,
    by_fit,
    gain_over,
    misfit,
    named_effects,
    on_runs_of,
    why_rejected,
)
from ptp_symbolic.numeric.diagnose.summary import gain_table
from ptp_symbolic.numeric.diagnose.trial import Task, misfits, ranked
from ptp_symbolic.numeric.diagnose.verdict import (
    PARTLY,
    UNEXPLAINED,
    Verdict,
    decide,
    word_of,
)
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.numeric.identify.windows import parted_like
from ptp_symbolic.platform import Platform
from ptp_symbolic.workflows.preparation import effect_keys, model_of, task_for
from ptp_symbolic.workflows.result import Progress

FOLLOWED = 2  # structures that go on into the search for terms where none leaves noise alone


@dataclass(frozen=True, eq=False)
class Logs:
    """What every structure is fitted to, and judged by."""

    train: tuple[Log, ...]
    validate: tuple[Log, ...]
    executor: Executor
    progress: Progress


@dataclass(frozen=True, eq=False)
class Outcome:
    """What one structure ends with: the `platform` with it, the search for terms in it, and its
    verdict. `structure` is None for the declared one.
    """

    platform: Platform
    structure: FittedStructure | None
    task: Task
    found: Search
    verdict: Verdict

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the effects of the structure."""
        return self.structure.keys if self.structure else ()


@dataclass(frozen=True, eq=False)
class Searched:
    """A structure with the search for terms in it, brief or whole; what it ends with is decided
    when it is asked for.
    """

    platform: Platform
    structure: FittedStructure | None
    task: Task
    found: Search

    @property
    def is_quiet(self) -> bool:
        """Whether the chosen set leaves noise alone."""
        trial = self.found.chosen
        return leaves_noise_alone(trial, floor_of(self.found.task, trial, self.found.carried))

    @cached_property
    def outcome(self) -> Outcome:
        """What it ends with."""
        verdict = decide(self.found)
        return Outcome(self.platform, self.structure, self.task, self.found, verdict)


@dataclass(frozen=True, eq=False)
class Choice:
    """The chosen outcome, `terms` (the outcome of the declared structure), a row for every
    structure, and why candidates were not tried, by key.
    """

    chosen: Outcome
    terms: Outcome
    rows: tuple[dict[str, Any], ...]
    untried: Mapping[str, str]


def chosen_structure(platform: Platform, logs: Logs, time_limit: float) -> Choice:
    """Search for terms of the declared platform, and where more than noise is left fit every
    structure one step away from it; search for terms in the best of them too, and choose. Every
    search ends after `time_limit` in s.

    All are brief at first. The whole one follows where no answer is found soon: of the structure
    that fits best, and of the declared one where that is beaten by little.
    """
    every, untried = structures(platform)
    found: list[tuple[Rebuilt, FittedStructure]] = []

    def searched(structure: FittedStructure | None, brief: bool) -> Searched:
        name = " + ".join(structure.keys) if structure else ""
        logs.progress(f"searching for terms beside {name or 'what is declared'}")
        platforms = {id(s): rebuilt.platform for rebuilt, s in found}
        there = platforms[id(structure)] if structure else platform
        return _searched(there, structure, logs, time_limit, brief=brief)

    terms = searched(None, brief=bool(every))
    if not every or (terms.is_quiet and not terms.found.chosen.candidates):
        why = "not tried: the declared structure leaves noise alone"
        untried = {**untried, **{key: why for each in every for key in each.keys}}
        return Choice(terms.outcome, terms.outcome, (), untried)
    logs.progress(f"fitting {len(every)} structures one step away")
    declared = _begun(platform, None, logs, {}).led_on().fitted
    found, failed = _all_fitted(every, logs, declared, lead=not terms.is_quiet)
    untried = {**untried, **failed}
    others = [s for _, s in found]
    order = by_fit(declared, others)
    quiet = [s for s in order if s.is_quiet][:1]
    followed = [
        searched(s, brief=True) for s in quiet or order[: 0 if terms.is_quiet else FOLLOWED]
    ]
    if terms.is_quiet:
        pass
    elif not order:
        terms = searched(None, brief=False)
    else:
        best = _best_fit([terms, *followed])
        if best is not terms and not best.is_quiet:
            whole = searched(best.structure, brief=False)
            followed = [whole if s is best else s for s in followed]
            best = whole
        if best is terms or not _is_far_ahead(best, terms):
            terms = searched(None, brief=False)
    chosen, refused = _chosen(terms.outcome, [s.outcome for s in followed], others, logs)
    rows = tuple(_row(s, declared, chosen, refused) for s in [*order, *_rest(others, order)])
    return Choice(chosen, terms.outcome, rows, untried)


def _best_fit(searches: Sequence[Searched]) -> Searched:
    """The search that ends with the best fit, in the windows of the first one."""
    pattern = searches[0].found.chosen.fit.runs
    trials = [on_runs_of(s.found.task, s.found.chosen, pattern) for s in searches]
    cost = misfits(trials)
    return searches[min(range(len(cost)), key=lambda k: cost[k])]


def _is_far_ahead(one: Searched, other: Searched) -> bool:
    """Whether the first surely halves the squared error of the second."""
    trial = one.found.chosen
    return gain(trial, on_runs_of(other.found.task, other.found.chosen, trial.fit.runs)).is_most


def _rest(
    others: Sequence[FittedStructure], order: Sequence[FittedStructure]
) -> list[FittedStructure]:
    return [s for s in others if s not in order]


def _begun(
    platform: Platform, rebuilt: Rebuilt | None, logs: Logs, known: Mapping[str, float]
) -> Begun:
    model = model_of(platform)
    task = task_for(platform, model, logs.train, logs.validate, (), logs.executor, logs.progress)
    if rebuilt is None:
        return begin_structure("as declared", (), frozenset(), task, (), known)
    return begin_structure(
        rebuilt.title, rebuilt.keys, rebuilt.provides, task, rebuilt.starts, known
    )


def _all_fitted(
    every: Sequence[Rebuilt], logs: Logs, declared: FittedStructure, lead: bool
) -> tuple[list[tuple[Rebuilt, FittedStructure]], dict[str, str]]:
    """Structures that can be emitted and fitted, and by key why others cannot. Where none leaves
    noise alone, the better half of them is led over windows too if `lead`.
    """

    def one(rebuilt: Rebuilt) -> Begun | str:
        try:
            return _begun(rebuilt.platform, rebuilt, logs, declared.trial.values)
        except InputError as error:
            return f"the platform with it cannot be fitted: {error}"

    results = list(zip(every, side_by_side(one, every), strict=True))
    begun = [(r, b) for r, b in results if isinstance(b, Begun)]
    failed = {r.keys[0]: b for r, b in results if isinstance(b, str)}
    if lead and not any(b.fitted.is_quiet for _, b in begun):
        logs.progress("leading the better half of the structures over windows")
        cost = [misfit(b.fitted, declared) for _, b in begun]
        better = sorted(range(len(begun)), key=cost.__getitem__)[: max(FOLLOWED, len(begun) // 2)]
        led = side_by_side(Begun.led_on, [begun[k][1] for k in better])
        for k, structure in zip(better, led, strict=True):
            begun[k] = begun[k][0], structure
    tried = {key for r, _ in begun for key in r.keys}
    failed = {key: why for key, why in failed.items() if key not in tried}
    return [(r, b.fitted) for r, b in begun], failed


def _searched(
    platform: Platform,
    structure: FittedStructure | None,
    logs: Logs,
    time_limit: float,
    *,
    brief: bool,
) -> Searched:
    """Search for terms in a structure, begun at the values that it was fitted with."""
    begun = platform
    if structure is not None:
        begun = variants.extended(platform, (), structure.trial.values, ())
    if structure is not None and structure.is_quiet:
        model = model_of(begun)
    else:
        try:
            model = model_of(variants.with_candidates(begun))
        except InputError as error:  # a candidate that cannot be beside the structure
            logs.progress(f"no terms are searched for: {error}")
            model = model_of(begun)
    task = task_for(
        begun, model, logs.train, logs.validate, effect_keys(begun), logs.executor, logs.progress
    )
    declared_starts = {p.name: p.value for p in platform.parameters}
    task = replace(
        task, free=tuple(replace(f, declared_start=declared_starts[f.name]) for f in task.free)
    )
    return Searched(platform, structure, task, search(task, time_limit, brief=brief))


def _chosen(
    terms: Outcome, outcomes: Sequence[Outcome], others: Sequence[FittedStructure], logs: Logs
) -> tuple[Outcome, dict[str, str]]:
    """The outcome that the logs ask for, and why structures that were followed are not named."""
    refused: dict[str, str] = {}
    accepted: list[Outcome] = []
    rivals: list[Rival] = []
    for outcome in outcomes:
        structure = outcome.structure
        assert structure is not None
        name = " + ".join(structure.keys)
        final = outcome.verdict.final
        without = on_runs_of(terms.found.task, terms.verdict.final, final.fit.runs)
        quiet = outcome.verdict.word not in (PARTLY, UNEXPLAINED)
        task = outcome.found.task
        earned, why = why_rejected(structure, task, final, without, quiet, len(others))
        unconfirmed = on_runs_of(terms.found.task, terms.found.chosen, final.fit.runs)
        if why is None and is_clearly_more(gain(unconfirmed, final), 1, task.material):
            why = f"{' + '.join(terms.found.chosen.keys)} predicts better, but is not confirmed"
        if why is None:
            named = _with_structure(outcome, terms, earned, others, logs)
            if _is_borne_out(named, terms, quiet):
                accepted.append(named)
                continue
            why = "reduces the error of the validation runs too little, or not significantly"
        elif quiet and terms.verdict.final.candidates:
            against = gain(without, final)
            if not is_clearly_more(against, 1, structure.task.material):
                candidates = (*structure.added, *final.candidates)
                rivals.append(Rival(replace(final, candidates=candidates), against))
        refused[name] = why
    if accepted:
        best = ranked([o.verdict.final for o in accepted])[0] if len(accepted) > 1 else None
        return next(o for o in accepted if best is None or o.verdict.final is best), refused
    if rivals:
        return _beside(terms, rivals), refused
    return terms, refused


def _beside(terms: Outcome, rivals: Sequence[Rival]) -> Outcome:
    """The outcome of the declared structure, with structures that its terms cannot be told from."""
    verdict = terms.verdict
    found = confusable(verdict.final, [*verdict.rivals, *rivals])
    merged = {
        key: tuple(sorted({*verdict.confusable.get(key, ()), *found[key]}))
        for key in verdict.final.keys
    }
    quiet = verdict.word not in (PARTLY, UNEXPLAINED)
    word = word_of(verdict.final, merged, quiet)
    return replace(terms, verdict=replace(verdict, confusable=merged, word=word))


def _with_structure(
    outcome: Outcome, terms: Outcome, earned: Gain, others: Sequence[FittedStructure], logs: Logs
) -> Outcome:
    """The outcome with its structure named: among the effects of the final model, what was declared
    as the model before.
    """
    structure, verdict = outcome.structure, outcome.verdict
    assert structure is not None
    own = named_effects(structure, verdict.final)
    final = replace(verdict.final, candidates=(*own, *verdict.final.candidates))
    alike = [Rival(s.trial, gain_over(structure, s)) for s in alternatives(structure, others)]
    names = {
        key for s in alternatives(structure, others) for key in s.keys if key not in structure.keys
    }
    group = {c.key: tuple(sorted(names)) for c in own}
    merged = {**verdict.confusable, **group}
    quiet = verdict.word not in (PARTLY, UNEXPLAINED)
    before = _declared_validation(terms, verdict.after, logs)
    declared = on_runs_of(terms.found.task, terms.verdict.declared, final.fit.runs)
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
            rivals=(*verdict.rivals, *alike),
            closest=None,
            before=before,
            held_out=held_out_gain(verdict.after, before),
        ),
    )


def _declared_validation(terms: Outcome, after: Fit, logs: Logs) -> Fit:
    """The validation runs by the declared model, in the windows of another fit of them."""
    task, declared = terms.found.task, terms.verdict.declared
    whole = prepare_runs(task.model, terms.platform, logs.validate)
    return simulated_freely(task, parted_like(task.model, whole, after.runs), declared.values)


def _is_borne_out(named: Outcome, terms: Outcome, quiet: bool) -> bool:
    """Whether the validation runs bear out the structure beside what terms alone explain."""
    held_out = named.verdict.held_out
    if held_out is None:
        return False
    return is_borne_out(held_out, quiet, False, named.task.material)


def _row(
    structure: FittedStructure, declared: FittedStructure, chosen: Outcome, refused: dict[str, str]
) -> dict[str, Any]:
    """A row of the ranking for a structure without terms."""
    from ptp_symbolic.numeric.diagnose.errors import error_of

    name = " + ".join(structure.keys)
    units = structure.trial.fit.model.units
    failed = structure.trial.fit.failed
    accepted = structure is chosen.structure
    why = refused.get(name)
    if accepted:
        why = "the structure of the final model: it predicts blocks left out clearly better"
    elif failed:
        why = f"the fit failed: {failed}"
    elif why is None:
        why = "predicts worse than the best structure, or no better than the declared one"
    error = None if failed else error_of(structure.trial.fit, units)["total"]
    values = structure.trial.values
    axes = {c.axis for c in structure.added}
    return {
        "effect": " + ".join(c.id for c in structure.added),
        "axis": axes.pop() if len(axes) == 1 else None,
        "structure": list(structure.keys),
        "gain": None if failed else gain_table(gain_over(structure, declared)),
        "train_error_after": None
        if error is None
        else error["rmse"]
        if error["rmse_counts"] is None
        else error["rmse_counts"],
        "parameters": {
            f.name: {"value": values[f.name], "unit": units[f.name]}
            for c in structure.added
            for f in c.free
        },
        "accepted": accepted,
        "why": why,
    }
