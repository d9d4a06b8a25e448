"""Structures compared: the declared platform and those one structure away from it, each fitted to
the same logs by a model of its own.

A structure has no value of a parameter at which it vanishes, so that no derivative tells what it
would gain. It is fitted, and predicts blocks left out better than the declared structure or does
not; with what else the logs lack it is judged as any term is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from ptp_symbolic.numeric.diagnose import fitted_model
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.confirm import is_moved_by_inputs
from ptp_symbolic.numeric.diagnose.fitted_model import (
    FittedModel,
    SearchProblem,
    deviances,
    fitted,
    halving,
    ranked,
    side_by_side,
)
from ptp_symbolic.numeric.diagnose.gain import Gain, gain
from ptp_symbolic.numeric.diagnose.noise_floor import (
    leaves_noise_alone,
    noise_floor_of,
    normalised_residual,
    propagated_input_noise,
)
from ptp_symbolic.numeric.diagnose.proposals import (
    ProposedSet,
    ProposedSets,
    declared_start,
    propose,
)
from ptp_symbolic.numeric.diagnose.refits import (
    fitted_over_windows,
    inside,
    over_whole_runs,
    polished,
    refitted_in,
    sharpened,
)
from ptp_symbolic.numeric.diagnose.stepwise import Search, Tried, is_earned
from ptp_symbolic.numeric.diagnose.summary import ranking_row
from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, SCREENED
from ptp_symbolic.numeric.identify.evidence import Allowance
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.windows import parted_like

_ON_OTHER_RUNS: WeakKeyDictionary[FittedModel, dict[tuple[Any, ...], FittedModel]] = (
    WeakKeyDictionary()
)


@dataclass(frozen=True, eq=False)
class FittedStructure:
    """A structure fitted to the training runs, no term added; `added` are its effects with the
    parameters that they brought (none for the declared structure), `provides` its mechanisms, and
    `proposals` what leads further. At first it `is_begun`: fitted to whole runs (windows, where
    they are) by a few iterations from the best of its starts.
    """

    added: tuple[Candidate, ...]
    provides: frozenset[str]
    problem: SearchProblem
    trial: FittedModel
    proposals: ProposedSets
    is_begun: bool = False

    @property
    def keys(self) -> tuple[str, ...]:
        """Keys of the added effects."""
        return tuple(c.key for c in self.added)

    @property
    def with_parameters(self) -> tuple[Candidate, ...]:
        """The added effects that have any: where an encoder sits has none."""
        own = {e.key for e in self.problem.model.effects if e.parameters}
        return tuple(c for c in self.added if c.key in own)

    @property
    def is_noise_alone(self) -> bool:
        """Whether it leaves noise alone."""
        if self.trial.fit.failed:
            return False
        propagated = propagated_input_noise(self.problem, self.trial.fit)
        return leaves_noise_alone(self.trial, noise_floor_of(self.problem, self.trial, propagated))

    def further(self) -> "FittedStructure":
        """The structure fitted a few iterations further."""
        left = halving(self.problem, [self.trial], 1)
        return replace(self._with(self.problem, (left or [self.trial])[0]), is_begun=True)

    def finished(self) -> "FittedStructure":
        """The structure fitted to the end of whole runs; windows are for `over_windows_too`."""
        problem = self.problem
        if not problem.windows:
            return replace(self, is_begun=False)
        return self._with(*over_whole_runs(problem, self.proposals))

    def over_windows_too(self) -> "FittedStructure":
        """The structure led over windows, where whole runs leave more than noise."""
        if self.is_noise_alone:
            return self
        return self._with(*fitted_over_windows(self.problem, self.proposals))

    def from_values(self, values: Mapping[str, float]) -> "FittedStructure":
        """The structure fitted to the end from `values` of another one that contains it, where that
        leads to a better fit.
        """
        problem = self.problem
        own = {f.name for f in problem.free}
        start = {**self.trial.values, **{n: v for n, v in values.items() if n in own}}
        begun = fitted(problem, (), start, None, executor=problem.executor)
        best = (halving(problem, [begun], 1) or [begun])[0]
        return self._with(
            problem, polished(problem, best, propagated_input_noise(problem, best.fit))
        )

    def without_terms(self) -> Search:
        """A search for terms in the structure that ends with none."""
        propagated = propagated_input_noise(self.problem, self.trial.fit)
        trial = sharpened(self.problem, self.trial, propagated)
        problem = replace(self.problem, allowance=Allowance())
        return Search(problem, trial, trial, (), Tried(), self.proposals, propagated, False)

    def _with(self, problem: SearchProblem, trial: FittedModel) -> "FittedStructure":
        """The structure with a trial, or with its own where that fits better in the same runs."""
        if _alike(trial, self.trial):
            trial = ranked([trial, self.trial])[0]
        proposals = replace(self.proposals, start=trial.values)
        return replace(self, problem=problem, trial=trial, proposals=proposals, is_begun=False)


def _alike(one: FittedModel, other: FittedModel) -> bool:
    return [r.size for r in one.fit.runs] == [r.size for r in other.fit.runs]


def begin_structure(
    keys: Sequence[str],
    provides: frozenset[str],
    problem: SearchProblem,
    starts: Sequence[Mapping[str, float]],
    known: Sequence[Mapping[str, float]],
    notes: Sequence[str] = (),
) -> FittedStructure:
    """The structure of `problem`, begun from `starts` (of the parameters that the effects named in
    `keys` bring), each beside the start of the rows, and beside each of the `known` values of other
    parameters. `notes` say of added effects what was moved with them.
    """
    proposals = propose(problem)
    own = {f.name: f for f in problem.free}
    others = [{n: inside(own[n], v) for n, v in values.items() if n in own} for values in known]
    every = [
        {**proposals.start, **beside, **start}
        for beside in ({}, *others)
        for start in ({}, *starts)
    ]
    distinct = {tuple(sorted(values.items())): values for values in every}
    few, run = replace(problem, train=problem.few), problem.executor
    first = [fitted(few, (), v, None, executor=run) for v in distinct.values()]
    ends = halving(few, first, SCREENED) or first[:1]
    begun = [fitted(problem, (), end.values, None, executor=run) for end in ends]
    trial = (halving(problem, begun, 1) or begun[:1])[0]
    proposals = replace(proposals, start=trial.values)
    effects = effects_of(problem, keys)
    added = tuple(
        replace(effect, title=f"{effect.title}, {note}") if note else effect
        for effect, note in zip(effects, (*notes, *[""] * len(effects)), strict=False)
    )
    return FittedStructure(added, provides, problem, trial, proposals, is_begun=True)


def effects_of(problem: SearchProblem, keys: Sequence[str]) -> tuple[Candidate, ...]:
    """The effects named in `keys` as candidates that nothing switches off, in their order."""
    free = {f.name: f for f in problem.free}
    own = {e.key: e for e in problem.model.effects}
    return tuple(
        Candidate(
            effect.id,
            effect.axis,
            effect.title,
            effect.separating_experiment,
            tuple(free[name] for name in effect.parameters if name in free),
            {},
        )
        for effect in (own[key] for key in keys)
    )


def terms_beside(structure: FittedStructure | None, problem: SearchProblem) -> ProposedSet | None:
    """The terms that a structure was fitted beside, as candidates of the `problem` of a search in
    it, with the values of that fit; None where there are none, as for the declared platform.
    """
    if structure is None:
        return None
    own = {f.name for f in structure.problem.free}
    there: dict[str, Candidate] = {}
    for effect in structure.problem.model.effects:
        forms = [c for c in problem.candidates if c.key == effect.key and own.issuperset(c.names)]
        whole = max(forms, key=lambda c: len(c.names), default=None)
        if whole is not None and whole.locked is None:
            there[effect.key] = whole
    values = {n: v for n, v in structure.trial.values.items() if n in own}
    found = ProposedSet(tuple(there.values()), {**declared_start(problem), **values})
    return found if there else None


def on_runs_of(
    problem: SearchProblem, trial: FittedModel, pattern: Sequence[Run], is_begun: bool = False
) -> FittedModel:
    """The trial fitted to the windows and samples of other runs of the same logs, by a few
    iterations for one that `is_begun`; kept as long as the trial is, for one is compared with many.
    """
    own, other = (
        [(r.source, r.time[0], len(r.time)) for r in each] for each in (trial.fit.runs, pattern)
    )
    if own == other:
        return trial
    kept, windows = _ON_OTHER_RUNS.setdefault(trial, {}), (problem, is_begun, *other)
    if windows not in kept:
        runs = parted_like(problem.model, problem.whole, pattern)
        part = replace(problem, every_sample=runs, train=runs, windows=())
        if is_begun:
            begun = fitted(part, trial.candidates, trial.values, None)
            kept[windows] = (halving(part, [begun], 1) or [begun])[0]
        else:
            kept[windows] = refitted_in(part, trial)
    return kept[windows]


def gain_over(one: FittedStructure, other: FittedStructure) -> Gain:
    """What the first of two structures predicts better than the second."""
    return gain(one.trial, on_runs_of(other.problem, other.trial, one.trial.fit.runs))


def by_fit(declared: FittedStructure, found: Sequence[FittedStructure]) -> list[FittedStructure]:
    """The structures that predict a material share better than the declared one, the best fit
    first; but of those that come near the best fit of all (see `is_near`) one with fewer
    parameters comes before another that it predicts as well as.
    """
    whole = [s for s in found if not s.trial.fit.failed]
    gains = side_by_side(lambda s: gain_over(s, declared), whole)
    better = [s for s, g in zip(whole, gains, strict=True) if g.share >= declared.problem.material]
    each = side_by_side(lambda s: deviance(s, declared), better)
    cost = {id(s): m for s, m in zip(better, each, strict=True)}
    near = min(cost.values(), default=0.0) + sum(r.size for r in declared.trial.fit.runs)
    left, ordered = sorted(better, key=lambda s: cost[id(s)]), []
    while left:
        best = left[0]
        others = [s for s in left[1:] if _size(s) < _size(best) and cost[id(s)] <= near]
        simpler = [s for s in others if _is_as_good(s, best)]
        best = min(simpler, key=_size, default=best)
        ordered.append(best)
        left.remove(best)
    return ordered


def _is_as_good(simpler: FittedStructure, best: FittedStructure) -> bool:
    """Whether a simpler structure predicts as well as the best fit: one that this contains, where
    it is not significantly worse; any other, where it is not materially worse, for a wide interval
    alone, as where much is unexplained, makes a lag no equal of a shaft.
    """
    if simpler.provides < best.provides:
        return not is_better(best, simpler)
    return gain_over(best, simpler).share < best.problem.material


def is_better(one: FittedStructure, other: FittedStructure) -> bool:
    """Whether the first of two structures predicts a material share better, clearly so."""
    return gain_over(one, other).is_better(one.problem.material)


def _size(structure: FittedStructure) -> int:
    return len(structure.trial.fit.free)


def deviance(structure: FittedStructure, declared: FittedStructure) -> float:
    """How badly a structure fits, in the windows of the declared one."""
    pattern, is_begun = declared.trial.fit.runs, declared.is_begun
    there = on_runs_of(structure.problem, structure.trial, pattern, is_begun)
    return deviances([declared.trial, there])[1]


def is_near(one: FittedStructure, best: FittedStructure, declared: FittedStructure) -> bool:
    """Whether a structure fits nearly as well as the best one (see `fitted_model.is_near`), in the
    windows of the declared one.
    """
    return comes_near(one, best.problem, best.trial, declared)


def comes_near(
    one: FittedStructure, problem: SearchProblem, trial: FittedModel, declared: FittedStructure
) -> bool:
    """Whether a structure fits nearly as well as a `trial` of another problem; see `is_near`."""
    pattern = declared.trial.fit.runs
    own, other = (
        on_runs_of(p, t, pattern, declared.is_begun)
        for p, t in ((one.problem, one.trial), (problem, trial))
    )
    return fitted_model.is_near(own, [other])


def alternatives(
    chosen: FittedStructure,
    found: Sequence[FittedStructure],
    declared: FittedStructure | None = None,
) -> list[FittedStructure]:
    """The other structures that are not significantly worse than the chosen one, each without
    terms; not those that have all of its mechanisms, for what they have more shows in nothing.

    Where more than noise remains, which structure fits best without terms depends on what else is
    missing. Then `declared` is given: structures that come near the chosen one (see `is_near`), and
    predict better than the declared one, are alternatives too.
    """
    others = [
        s
        for s in found
        if s is not chosen and not s.trial.fit.failed and not chosen.provides <= s.provides
    ]

    def is_beaten(one: FittedStructure) -> bool:
        if not is_better(chosen, one):
            return False
        return declared is None or not (is_near(one, chosen, declared) and is_better(one, declared))

    beaten = side_by_side(is_beaten, others)
    return [s for s, worse in zip(others, beaten, strict=True) if not worse]


def unaffected_axes(search: Search, is_noise_alone: bool) -> frozenset[str]:
    """Axes on which nothing is left to explain: there the chosen set of a search leaves noise alone
    and has no term. A term on the whole platform counts for every axis where the set
    `is_noise_alone`: it may be confounded with a structure on any.
    """
    trial, most = search.chosen, ABOVE_NOISE * np.hypot(1.0, search.propagated.most)
    is_quiet = dict(
        zip(trial.fit.runs[0].signals, normalised_residual(trial.fit) <= most, strict=True)
    )
    found = {c.axis for c in trial.candidates}
    if is_noise_alone and None in found:
        return frozenset()
    return frozenset(
        axis
        for axis in trial.fit.model.module.AXES
        if axis not in found and all(q for s, q in is_quiet.items() if s.endswith(f"_{axis}"))
    )


def is_identifiable(effect: Candidate, trial: FittedModel) -> bool:
    """Whether the logs tell any parameter of an effect that a trial has."""
    own = [e for e in estimates(trial.fit) if e.name in effect.parameters]
    return any(e.identified and not e.at_bound for e in own)


def is_there(effect: Candidate, trial: FittedModel, quiet: bool) -> bool:
    """Whether the logs tell a parameter of an effect that a trial has, or, where that is `quiet`
    (noise alone is left), keep one off both of its bounds: stiffness and inertia that are known
    only together are those of a shaft all the same.
    """
    bounds = {f.name: (f.lower, f.upper) for f in trial.fit.free}
    kept_off = (
        e.has_interval and bounds[e.name][0] < e.lower and e.upper < bounds[e.name][1]
        for e in estimates(trial.fit)
        if e.name in effect.parameters
    )
    return is_identifiable(effect, trial) or (quiet and any(kept_off))


def named_effects(structure: FittedStructure, trial: FittedModel) -> tuple[Candidate, ...]:
    """The effects of a structure, as a trial that has it tells them: one that came along with the
    first, and of which the logs tell nothing, is a part of it.
    """
    first, *along = structure.added
    told = [c for c in along if is_identifiable(c, trial)]
    parts = [f for c in along if c not in told for f in c.free]
    return (replace(first, free=(*first.free, *parts)), *told)


def why_rejected(
    structure: FittedStructure,
    problem: SearchProblem,
    trial: FittedModel,
    without: FittedModel,
    quiet: bool,
    tests: int,
) -> tuple[Gain, str | None]:
    """What the structure gains in `trial` (with what was found beside it) over the best model
    `without` it, and why that earns no name; None where it does. `quiet` says that the trial leaves
    noise alone, `tests` how many structures were compared.
    """
    earned = gain(trial, without)
    if not is_earned(earned, 1.0, tests, problem.material):
        return earned, f"{earned.in_words}, which is not significant"
    if not quiet and not earned.is_most:
        return earned, f"{earned.in_words}, too little while the residual exceeds the noise"
    first = structure.added[0]
    if not is_there(first, trial, quiet):
        return earned, f"no parameter of {first.key} is identifiable from these logs"
    if not is_moved_by_inputs(replace(problem, train=trial.fit.runs), trial):
        return earned, "with it the simulated motion no longer depends on the inputs"
    return earned, None


def structure_row(
    structure: FittedStructure,
    declared: FittedStructure,
    chosen: FittedStructure | None,
    refused: Mapping[FittedStructure, str],
    alike: Sequence[FittedStructure],
    beside: Sequence[str],
) -> dict[str, Any]:
    """A row of the ranking for a structure before a search for terms; `alike` are the alternatives
    of the chosen one, `beside` the titles of what all were fitted with.
    """
    failed = structure.trial.fit.failed
    accepted = structure is chosen
    if accepted:
        why = "the structure of the final model: it predicts blocks left out significantly better"
    elif failed:
        why = f"the fit failed: {failed}"
    elif structure in alike and structure not in refused:
        why = "cannot be told from the chosen structure by these logs, before terms were searched"
    else:
        why = refused.get(structure) or _why_not_followed(structure, declared, chosen)
    earned = None if failed else gain_over(structure, declared)
    row = ranking_row(structure.added, structure.trial, earned, accepted, why)
    title = " and ".join(c.title for c in structure.with_parameters)
    title += f", beside {' and '.join(beside)}" if beside else ""
    return {**row, "title": title, "structure": list(structure.keys)}


def _why_not_followed(
    structure: FittedStructure, declared: FittedStructure, chosen: FittedStructure | None
) -> str:
    if chosen is not None and chosen.provides <= structure.provides:
        return (
            "has all mechanisms of the chosen structure, which fits better, or as well with fewer"
            " parameters"
        )
    if gain_over(structure, declared).is_better(structure.problem.material):
        return "predicts better than the declared structure; those searched on fitted better"
    return "does not predict significantly better than the declared structure"
