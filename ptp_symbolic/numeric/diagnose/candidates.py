"""Candidates: effects that the declared machine may lack, and declared values that may be wrong."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import PLAUSIBLE_FACTOR, STEP, WIDE_STEP
from ptp_symbolic.numeric.identify.coordinates import SMALLEST_SHARE, FreeParameter, free_parameter
from ptp_symbolic.numeric.runtime.model import EffectInstance, Model, ModelParameter
from ptp_symbolic.platform import effect_key

FloatArray = NDArray[np.float64]

FAR_OFF = PLAUSIBLE_FACTOR * PLAUSIBLE_FACTOR  # between the ends of what is plausible: of starts
DECLARED_VALUE = "declared_value"


@dataclass(frozen=True)
class Candidate:
    """One explanation, or a nested member of it: id, axis and the parameters that it frees.

    `free` are the parameters with the amounts at which a search begins; those in `vanishing` switch
    it off at the values given, in their units, all others shape it. `shapes` are sets of values of
    the shaping parameters from which a search begins. `locked` is a shaping frequency that a scan
    finds, with what it is locked to ("time" or "angle"); the scan has compared so many that can be
    resolved (`frequencies_compared`). `brings` are keys of candidates without which it has nothing
    to act on. `whole_only` are parameters that show only at the amount with which they begin (see
    `at_best_delays`). `dominant` are those parameters that can only be the larger part of it.
    `member` numbers the nested versions, the simplest first.
    """

    id: str
    axis: str | None
    title: str
    separating_experiment: str
    free: tuple[FreeParameter, ...]
    vanishing: Mapping[str, float]
    shapes: tuple[Mapping[str, float], ...] = ({},)
    locked: tuple[str, str] | None = None
    brings: tuple[str, ...] = ()
    dominant: tuple[str, ...] = ()
    member: int = 0
    frequencies_compared: int = 1
    whole_only: frozenset[str] = frozenset()

    @property
    def key(self) -> str:
        """Id and axis in one word, e.g. ``cable_spring@pan``."""
        return effect_key(self.id, self.axis)

    @property
    def is_declared_value(self) -> bool:
        """True where it frees a value that the platform declares as known."""
        return self.id.startswith(DECLARED_VALUE)

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of the parameters that it frees."""
        return tuple(f.name for f in self.free)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters that it frees and of those tied to them."""
        return tuple(name for f in self.free for name in f.names)

    @property
    def defining(self) -> tuple[FreeParameter, ...]:
        """The parameters that switch it on, those in `vanishing`."""
        return tuple(f for f in self.free if f.name in self.vanishing)

    def is_limit(self, f: FreeParameter) -> bool:
        """Whether a parameter limits something: it vanishes at its upper bound, out of reach, or at
        its lower one, as an angle at which a stop is met; amounts of effects do so at zero.
        """
        zero = self.vanishing.get(f.name)
        return zero == f.upper or zero == f.lower != 0.0

    def met_at(self, f: FreeParameter) -> float:
        """The value of a limit from which on it does nothing in the logs (see `within_reach`)."""
        if f.logarithmic:
            return float(f.start * np.exp(WIDE_STEP))
        return self.vanishing[f.name]


def with_what_needs_it(candidate: Candidate, candidates: Sequence[Candidate]) -> Candidate:
    """A candidate with the parameters of those that act through it: taken out of a set, it takes
    them along, and of itself it may be next to nothing (friction that goes with the load alone).
    """
    needing = [c for c in candidates if candidate.key in c.brings]
    free = tuple(f for c in (candidate, *needing) for f in c.free)
    vanishing = {n: v for c in (candidate, *needing) for n, v in c.vanishing.items()}
    return replace(candidate, free=free, vanishing=vanishing)


def with_what_it_brings(
    kept: Sequence[Candidate], candidate: Candidate, candidates: Sequence[Candidate]
) -> tuple[Candidate, ...]:
    """The set `kept` with a candidate, and with those of `candidates` that it brings along."""
    have = {c.key for c in kept}
    by_key = {c.key: c for c in reversed(candidates)}
    added = (by_key[key] for key in candidate.brings if key not in have)
    return (*kept, *added, candidate)


def without_member(candidates: Sequence[Candidate], member: Candidate) -> tuple[Candidate, ...]:
    """A set without one of its members, and without those that have nothing to act on then."""
    return with_all_they_need(tuple(c for c in candidates if c is not member))


def with_all_they_need(candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """Those of `candidates` that find everything they bring among them, in the same order."""
    kept = tuple(candidates)
    while True:
        keys = {c.key for c in kept}
        able = tuple(c for c in kept if keys.issuperset(c.brings))
        if len(able) == len(kept):
            return kept
        kept = able


def find_candidates(
    model: Model, declared: Sequence[str], known: Mapping[str, tuple[float, float | None]]
) -> tuple[Candidate, ...]:
    """Candidates in the emitted union `model`: the members of effects not in `declared`, then
    `known` values, each with the most by which it may be off, in its unit (None: a factor).
    """
    by_name = {p.name: p for p in model.parameters}
    found: list[Candidate] = []
    for effect in model.effects:
        if effect.key not in declared and effect.parameters:
            found += _members(effect, by_name, declared)
    for name, (value, uncertainty) in known.items():
        if name in by_name:
            found += _declared_value(by_name[name], value, uncertainty)
    return tuple(found)


def _members(
    effect: EffectInstance, by_name: Mapping[str, ModelParameter], declared: Sequence[str]
) -> list[Candidate]:
    members = effect.members or (("", effect.parameters, ()),)
    brings = tuple(key for key in effect.acts_on if key not in declared)
    dominant = members[0][1] if effect.first_leads else ()
    found = []
    for number, (_, names, ties) in enumerate(members):
        own = [by_name[name] for name in names]
        followers = {leader: tuple(f for f, t in ties if t == leader) for _, leader in ties}
        shaping = [p for p in own if p.vanishes is None and p.locked_to is None]
        grid = itertools.product(*(p.starts or (p.default,) for p in shaping))
        locked = next(((p.name, p.locked_to) for p in own if p.locked_to is not None), None)
        found.append(
            Candidate(
                effect.id,
                effect.axis,
                effect.title,
                effect.separating_experiment,
                tuple(_freed(p, followers.get(p.name, ())) for p in own),
                {p.name: p.vanishes for p in own if p.vanishes is not None},
                tuple(dict(zip([p.name for p in shaping], point, strict=True)) for point in grid),
                locked,
                brings,
                tuple(name for name in dominant if by_name[name].vanishes is not None),
                number,
            )
        )
    return found


def _freed(parameter: ModelParameter, tied: tuple[str, ...]) -> FreeParameter:
    """The parameter with the amount at which it begins: its first start that does something."""
    usual = parameter.starts or (parameter.default,)
    amount = next((s for s in usual if s != parameter.vanishes), None)
    if amount is None:
        amount = WIDE_STEP * min(1.0, parameter.upper - parameter.lower)
    return free_parameter(
        parameter.name, amount, parameter.lower, parameter.upper, parameter.period, tied
    )


def _declared_value(
    parameter: ModelParameter, value: float, uncertainty: float | None
) -> list[Candidate]:
    """A declared value as a candidate; none where it is zero or known exactly."""
    if value == 0.0 or uncertainty == 0.0:
        return []
    if uncertainty is None:
        ends = sorted((value / PLAUSIBLE_FACTOR, value * PLAUSIBLE_FACTOR))
    else:
        ends = [value - uncertainty, value + uncertainty]
    lower, upper = max(ends[0], parameter.lower), min(ends[1], parameter.upper)
    if not lower < value < upper:
        return []
    freed = free_parameter(parameter.name, value, lower, upper, parameter.period)
    return [
        Candidate(
            f"{DECLARED_VALUE}:{parameter.name}",
            None,
            f"declared value of {parameter.name} is wrong ({parameter.meaning})",
            f"Measure {parameter.name} on its own, apart from the machine.",
            (freed,),
            {parameter.name: value},
        )
    ]


def within_reach(
    candidate: Candidate,
    model: Model,
    largest: FloatArray,
    angles: Mapping[str, tuple[float, float]] = MappingProxyType({}),
) -> Candidate:
    """The candidate; a limit that nothing reaches where it vanishes, such as a largest voltage,
    vanishes from the `largest` value [nu] on that an input of its axis and unit has in the logs,
    and begins just below. One of either sign limits the angle of its axis: it vanishes from the end
    on of what that measures in the logs, lowest and highest by axis in `angles`, and begins within.
    """
    free, vanishing = [], dict(candidate.vanishing)
    for f in candidate.free:
        if candidate.is_limit(f) and f.lower < 0.0:
            if (ends := angles.get(str(candidate.axis))) is not None:
                f = _at_end(f, vanishing[f.name], *ends)
                vanishing[f.name] = f.upper if vanishing[f.name] > 0.0 else f.lower
            free.append(f)
            continue
        sizes = [
            size
            for name, size in zip(model.input_names, largest, strict=True)
            if name.endswith(f"_{candidate.axis}") and model.units[name] == model.units[f.name]
        ]
        met = max(sizes, default=0.0)
        if candidate.is_limit(f) and f.lower < met < f.upper:
            start = float(np.clip(np.exp(-WIDE_STEP) * met, f.lower, met))
            f, vanishing[f.name] = replace(f, start=start, scale=start, upper=met), met
        free.append(f)
    return replace(candidate, free=tuple(free), vanishing=vanishing)


def _at_end(f: FreeParameter, zero: float, lowest: float, highest: float) -> FreeParameter:
    """A limit of an angle that vanishes at `zero`, out of reach, with the end of what is measured
    as its bound: it begins inside of that by a small share of the range.
    """
    inside = STEP * max(highest - lowest, SMALLEST_SHARE)
    if zero > 0.0:
        return replace(f, start=highest - inside, scale=inside, upper=highest)
    end = lowest or -SMALLEST_SHARE  # an amount vanishes at zero, a limit does not
    return replace(f, start=lowest + inside, scale=inside, lower=end)


def vanished(model: Model, declared: Sequence[str]) -> dict[str, float]:
    """Vanishing values (or defaults) of the parameters of every effect outside `declared`."""
    by_name = {p.name: p for p in model.parameters}
    return {
        name: by_name[name].default if by_name[name].vanishes is None else by_name[name].vanishes  # type: ignore[misc]
        for effect in model.effects
        if effect.key not in declared
        for name in effect.parameters
    }
