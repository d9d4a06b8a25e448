"""The structures one step away from a platform, each emitted, and fitted to the same logs."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import variants
from ptp_symbolic.models.structures import (
    Family,
    Rebuilt,
    family,
    pairs,
    structures,
    to_scale,
    with_what_leads,
)
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose.fitted_model import side_by_side
from ptp_symbolic.numeric.diagnose.stepwise import Search
from ptp_symbolic.numeric.diagnose.structures import (
    FittedStructure,
    begin_structure,
    by_fit,
    comes_near,
    deviance,
    gain_over,
    is_better,
    is_identifiable,
    is_near,
)
from ptp_symbolic.numeric.identify.evidence import Allowance
from ptp_symbolic.platform import Platform
from ptp_symbolic.workflows.preparation import model_of, problem_for
from ptp_symbolic.workflows.result import Progress

FOLLOWED = 2  # structures that go on into the search for terms where none leaves noise alone


@dataclass(frozen=True, eq=False)
class Logs:
    """What every structure is fitted to and judged by, and the allowance of the diagnosis."""

    train: tuple[Log, ...]
    validate: tuple[Log, ...]
    executor: Executor
    progress: Progress
    allowance: Allowance


@dataclass(frozen=True, eq=False)
class Fitted:
    """A `platform`, as declared or with effects that were found, and all structures one step away
    from it, each fitted; which of these are the `better` half, and by key why others could not be.
    """

    platform: Platform
    declared: FittedStructure
    every: tuple[FittedStructure, ...]
    better: tuple[int, ...]
    failed: Mapping[str, str]

    @cached_property
    def order(self) -> list[FittedStructure]:
        """Those that predict better than the declared one, the best first (see `by_fit`)."""
        return by_fit(self.declared, self.every)

    @cached_property
    def quiet(self) -> list[FittedStructure]:
        """The best that leaves noise alone, if any does: the logs tell a parameter of what it is
        named after, where they do so of any.
        """
        quiet = [s for s in self.order if s.is_noise_alone]
        told = [s for s in quiet if is_identifiable(s.added[0], s.trial)]
        return (told or quiet)[:1]

    @cached_property
    def followed(self) -> list[FittedStructure]:
        """Those that go on into the search for terms where none leaves noise alone: the best, of
        one with friction or encoder on either side the better side, and none that has all
        mechanisms of another and predicts no better.
        """
        distinct: dict[Family, FittedStructure] = {}
        for one in self.order:
            parts = [s for s in distinct.values() if s.provides <= one.provides]
            if all(is_better(one, part) for part in parts):
                distinct.setdefault(family(one.keys, one.provides), one)
        return list(distinct.values())[:FOLLOWED]

    def over_windows_too(self, logs: Logs) -> "Fitted":
        """The declared structure and the better half fitted over windows, of many structures the
        best few, and no more than the allowance pays for.
        """
        logs.progress("fitting structures over windows")
        best = sorted(self.better, key=lambda k: deviance(self.every[k], self.declared))
        declared = self.declared.over_windows_too()
        before = logs.allowance.work.samples
        every = _each(FittedStructure.over_windows_too, self.every, best[:1])
        others = _affordable(best[1 : 3 * FOLLOWED], before, logs.allowance)
        every = _each(FittedStructure.over_windows_too, every, others)
        return replace(self, declared=declared, every=every)


def fit_structures(
    platform: Platform,
    every: Sequence[Rebuilt],
    logs: Logs,
    known: Mapping[str, float] | None = None,
    rival: Search | None = None,
) -> Fitted:
    """Fit a platform and `every` structure one step away from it: a few iterations each from their
    starts, the better half to the end of whole runs (see `_finished`). The encoder is put at the
    motor only in those that are in the better half with it at the joint. Where the best of them
    does not come near what a `rival` search found, only that best one is fitted to its end.

    They are started beside the parameters `known` from a fit with effects that were found, else
    beside those of the platform's: where a delay makes up for a lag, the former are right, the
    latter not. Beside the former they are started at the declared values too: fits without a shaft
    tell only the sum of the viscous friction on its two sides.
    Until they are fitted to their end, they are compared in the runs of the platform begun.
    """
    usual = [rebuilt for rebuilt in every if not rebuilt.of]
    logs.progress(f"fitting {len(usual)} structures one step away")
    at_first = _begun(platform, None, logs, [] if known is None else [known])
    declared = at_first.finished()
    declared_starts = {p.name: p.value for p in platform.parameters if p.free}
    beside = [declared.trial.values] if known is None else [declared_starts, known]

    def one(rebuilt: Rebuilt) -> FittedStructure | str:
        try:
            return _begun(rebuilt.platform, rebuilt, logs, beside)
        except InputError as error:
            return f"the platform with it cannot be fitted: {error}"

    results = list(zip(usual, side_by_side(one, usual), strict=True))
    first = [(r, b) for r, b in results if isinstance(b, FittedStructure)]
    first.sort(key=lambda pair: deviance(pair[1], at_first))
    versions = {r.provides for r, _ in first[: max(FOLLOWED, (len(first) + 1) // 2)]}
    further = [rebuilt for rebuilt in every if rebuilt.of in versions]
    results += zip(further, side_by_side(one, further), strict=True)
    begun = [b for _, b in results if isinstance(b, FittedStructure)]
    better = _better_half(begun, at_first)
    logs.progress(f"fitting the better {len(better)} of them to their end")
    tried = {key for b in begun for key in b.keys}
    failed = {r.keys[0]: b for r, b in results if isinstance(b, str) and r.keys[0] not in tried}
    finished = _finished(begun, better, at_first, declared, rival)
    every_finished = _from_those_that_contain(finished, better, declared)
    return Fitted(platform, declared, every_finished, better, failed)


def in_scale(every: Sequence[Rebuilt], platform: Platform) -> tuple[Rebuilt, ...]:
    """Structures with their starts in the scale of a platform."""
    model = model_of(platform)
    axes, states = model.module.AXES, model.state_names
    x, u = np.zeros(len(states)), np.zeros(len(model.input_names))
    p = model.parameter_vector({d.name: d.value for d in platform.parameters})
    mass, inertia = np.zeros((len(states), len(states))), dict.fromkeys(axes, 0.0)
    model.module.mass_matrix(0.0, x, u, p, np.ones(len(model.mode_names)), mass)
    bodies = [*axes, *(a for a in axes if f"omega_gear_{a}" in states)]
    for axis, own in zip(bodies, np.diag(mass), strict=False):
        inertia[axis] += float(own)
    return tuple(to_scale(rebuilt, inertia) for rebuilt in every)


def on_axes_of(every: Sequence[Rebuilt], others: Sequence[Rebuilt]) -> tuple[Rebuilt, ...]:
    """Those of other structures that are on axes of `every`."""
    axes = {axis for rebuilt in every for axis in rebuilt.axes}
    return tuple(rebuilt for rebuilt in others if rebuilt.axes <= axes)


def pairs_with(
    best: FittedStructure, platform: Platform, every: Sequence[Rebuilt]
) -> tuple[tuple[Rebuilt, ...], Platform]:
    """The pairs of the best structure, and each of those one step away from a platform with it on
    axes of `every`; and that platform, with the values that the best one was fitted with.
    """
    known = structures(platform)[0]
    first = next(r for r in known if (r.keys, r.provides) == (best.keys, best.provides))
    there = variants.extended(first.platform, (), best.trial.values, ())
    return in_scale(on_axes_of(every, pairs(replace(first, platform=there))), there), there


def leading_platform(
    platform: Platform, every: Sequence[Rebuilt], fitted: Fitted, logs: Logs
) -> Platform | None:
    """The platform with effects beside which some structures are led right, where one of these
    surely halves the squared error of the best that was fitted without; else None. A gap alone fits
    next to nothing where a torque holds the gear on one face.
    """
    leading = with_what_leads(platform, every)
    if not leading:
        return None
    own = {(r.keys, r.provides) for r in every if r.beside and not r.of}
    there = [
        (beside, rebuilt)
        for beside in leading
        for rebuilt in in_scale(structures(beside)[0], platform)
        if (rebuilt.keys, rebuilt.provides) in own
    ]
    logs.progress(f"fitting {len(there)} structures beside what may lead them")

    def one(pair: tuple[Platform, Rebuilt]) -> FittedStructure | None:
        try:
            return _begun(pair[1].platform, pair[1], logs, [fitted.declared.trial.values])
        except InputError:
            return None

    def cost(structure: FittedStructure) -> float:
        return deviance(structure, fitted.declared)

    before = min((s for s in (fitted.declared, *fitted.every) if not s.trial.fit.failed), key=cost)
    begun = zip(there, side_by_side(one, there), strict=True)
    led = [(beside, s) for (beside, _), s in begun if s and not s.trial.fit.failed]
    ahead = [(beside, s) for beside, s in led if cost(s) < cost(before)]
    ends = side_by_side(FittedStructure.finished, [s for _, s in ahead])
    better = [(cost(end), k) for k, end in enumerate(ends) if gain_over(end, before).is_most]
    return ahead[min(better)[1]][0] if better else None


def _finished(
    begun: Sequence[FittedStructure],
    better: Sequence[int],
    at_first: FittedStructure,
    declared: FittedStructure,
    rival: Search | None = None,
) -> tuple[FittedStructure, ...]:
    """The structures, those in `better`, the best first, fitted to their end; where the best leaves
    noise alone, of the others those that come near it in the runs `at_first`, and none where the
    best is far from a `rival`; as many as the allowance pays for.
    """
    allowance = declared.problem.allowance
    before = allowance.work.samples
    every = _each(FittedStructure.finished, begun, better[:1])
    others = _affordable(better[1:], before, allowance)
    best = every[better[0]] if better else None
    if best is None or (rival and not comes_near(best, rival.problem, rival.chosen, declared)):
        return every
    if best.is_noise_alone:
        every = _each(FittedStructure.further, every, others)
        others = [k for k in others if is_near(every[k], best, at_first)]
    return _each(FittedStructure.finished, every, others)


def _affordable(which: Sequence[int], begun: int, allowance: Allowance) -> list[int]:
    """As many of them, the first first, as an allowance pays for if each costs what was simulated
    since it had simulated `begun` samples.
    """
    each = allowance.work.samples - begun
    return list(which[: int(min(allowance.pays_for(each), len(which)))])


def _begun(
    platform: Platform, rebuilt: Rebuilt | None, logs: Logs, known: Sequence[Mapping[str, float]]
) -> FittedStructure:
    model = model_of(platform)
    problem = problem_for(
        platform,
        model,
        logs.train,
        logs.validate,
        (),
        logs.executor,
        logs.progress,
        logs.allowance,
    )
    if rebuilt is None:
        return begin_structure((), frozenset(), problem, (), known)
    keys, provides, starts = rebuilt.keys, rebuilt.provides, rebuilt.starts
    return begin_structure(keys, provides, problem, starts, known, rebuilt.notes)


def _better_half(begun: Sequence[FittedStructure], at_first: FittedStructure) -> tuple[int, ...]:
    """Which structures fit better than half of them, in the runs `at_first`, at least as many as
    are followed; a side of friction or encoder that is far behind another is left out. Others that
    contain one of these are among them: at their end they fit as well at least.
    """
    cost = [deviance(b, at_first) for b in begun]
    ahead: dict[Family, FittedStructure] = {}
    left = []
    for k in sorted(range(len(begun)), key=cost.__getitem__):
        one = begun[k]
        first = ahead.setdefault(family(one.keys, one.provides), one)
        if is_near(one, first, at_first):
            left.append(k)
    half = max(FOLLOWED, (len(left) + 1) // 2)
    parts = [begun[k].provides for k in left[:half]]
    others = (k for k in left[half:] if any(part < begun[k].provides for part in parts))
    return (*left[:half], *others)


def _from_those_that_contain(
    every: tuple[FittedStructure, ...], better: Sequence[int], declared: FittedStructure
) -> tuple[FittedStructure, ...]:
    """Structures fitted again from where one that contains them fits clearly better: without a gap
    that is not there a shaft has to fit as well as with it.
    """

    def again(one: FittedStructure) -> FittedStructure:
        larger = [s for s in every if one.provides < s.provides]
        best = min(larger, key=lambda s: deviance(s, declared), default=None)
        return (
            one if best is None or not is_better(best, one) else one.from_values(best.trial.values)
        )

    return _each(again, every, better)


def _each(
    step: Callable[[FittedStructure], FittedStructure],
    every: Sequence[FittedStructure],
    which: Sequence[int],
) -> tuple[FittedStructure, ...]:
    """The structures, those in `which` a step further."""
    further = dict(zip(which, side_by_side(step, [every[k] for k in which]), strict=True))
    return tuple(further.get(k, s) for k, s in enumerate(every))
