"""Is an answer right? Judged from the truth and the diagnosis alone.

A named effect is honest if it is in the truth, or if one of its `confusable_with` is, or if the
truth allows it: a shaft beside a gap, for example, too stiff to need a name. An answer with any
dishonest name is *wrong*. What *right* means depends on the kind of the set; an answer that is
neither is *missed*.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

from scipy.stats import beta

UNTOLD = {"nothing_missing", "unexplained"}
TOLD = {"explained", "explained_up_to_group", "partly_explained"}
OPEN_END = {"unexplained", "partly_explained"}
TURNING = ("alpha_base", "phi_base", "psi_base")  # angles of which a full turn does not matter

Key = tuple[str, str | None]
Data = Mapping[str, Any]


@dataclass(frozen=True)
class Score:
    """Class of an answer: "right", "missed" or "wrong".

    `group`: right, but a truth is named only as a member of a group; `covered`: effects of the
    truth that are named, `by_group`: those of them named only through a group; `small`: dishonest
    names of effects that a slightly wrong machine does have, too small to be named.
    """

    answer: str
    group: bool
    verdict: str
    named: tuple[str, ...]
    dishonest: tuple[str, ...]
    covered: tuple[str, ...]
    by_group: tuple[str, ...]
    small: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Plain data."""
        return asdict(self)


def read_key(text: str) -> Key:
    """An effect and its axis from `effect` or `effect@axis`."""
    effect, _, axis = text.partition("@")
    return effect, axis or None


def write_key(key: Key) -> str:
    """The inverse of `read_key`."""
    return key[0] if key[1] is None else f"{key[0]}@{key[1]}"


def same(one: Key, other: Key) -> bool:
    """Whether two keys mean the same effect; an axis left out matches any."""
    return one[0] == other[0] and (one[1] == other[1] or None in (one[1], other[1]))


def _is_right(kind: str, verdict: str, complete: bool, allowed: bool) -> bool:
    """Whether an answer without a dishonest name is right; `complete`: every truth is named;
    `allowed`: what no truth lists may be named, and is.
    """
    if kind == "perfect":
        return verdict == "nothing_missing"
    if kind in ("slightly_wrong", "structure_null"):
        return verdict in UNTOLD
    if kind == "unlisted":
        return verdict in OPEN_END or (complete and allowed and verdict in TOLD)
    return complete and verdict in TOLD


def _deviates(truth: Data) -> bool:
    """Whether the machine has many small deviations from its model."""
    return truth["kind"] == "slightly_wrong" or bool(truth.get("small_deviations"))


def score(truth: Data, diagnosis: Data | None) -> Score:
    """The class of an answer; None, a diagnosis that ended without one, is missed."""
    if diagnosis is None:
        return Score("missed", False, "none", (), (), (), ())
    listed: list[Key] = list(zip(truth["effects"], truth["axes"], strict=True))
    verdict = str(diagnosis["verdict"])
    allowed = [read_key(text) for text in truth.get("allowed", ())]
    deviating = set(truth["hidden"]) if _deviates(truth) else set()
    named, dishonest, small, covered, direct = [], [], [], set(), set()
    for one in diagnosis["added"]:
        key: Key = (one["effect"], one["axis"])
        group = [read_key(text) for text in one["confusable_with"]]
        named.append(write_key(key))
        hits = {truth_key for truth_key in listed if same(truth_key, key)}
        direct |= hits
        hits |= {other for other in listed if any(same(other, member) for member in group)}
        covered |= hits
        if not hits and not any(same(free, other) for free in allowed for other in (key, *group)):
            dishonest.append(write_key(key))
            if deviating & set(one["parameters"]):
                small.append(write_key(key))
    right = not dishonest and _is_right(
        truth["kind"], verdict, covered == set(listed), bool(allowed) and len(named) > len(direct)
    )
    return Score(
        answer="wrong" if dishonest else "right" if right else "missed",
        group=right and bool(covered - direct),
        verdict=verdict,
        named=tuple(named),
        dishonest=tuple(dishonest),
        covered=tuple(sorted(write_key(key) for key in covered)),
        by_group=tuple(sorted(write_key(key) for key in covered - direct)),
        small=tuple(small),
    )


def clopper_pearson(hits: int, count: int, confidence: float = 0.95) -> tuple[float, float]:
    """Exact bounds of a share of `hits` in `count`."""
    tail = 0.5 * (1.0 - confidence)
    low = float(beta.ppf(tail, hits, count - hits + 1)) if hits > 0 else 0.0
    high = float(beta.ppf(1.0 - tail, hits + 1, count - hits)) if hits < count else 1.0
    return low, high


@dataclass(frozen=True)
class Interval:
    """One 95 % interval of an answer beside the true value; `added` of a named effect."""

    parameter: str
    added: bool
    low: float
    high: float
    true: float

    @property
    def holds(self) -> bool:
        """Whether the true value lies within; azimuths and phases up to full turns."""
        turns = (-1, 0, 1) if self.parameter in TURNING else (0,)
        return any(self.low <= self.true + 2 * math.pi * turn <= self.high for turn in turns)


def intervals(truth: Data, diagnosis: Data) -> Iterator[Interval]:
    """All intervals whose true value is known, of named effects first, each parameter once.

    None where the truth holds what no model can: its parameters have no true value there.
    """
    if truth["kind"] == "unlisted" or _deviates(truth):
        return
    tables = [(False, diagnosis["fit"]["after"]["parameters"])]
    tables += [(True, one["parameters"]) for one in diagnosis["added"]]
    seen = set()
    for added, table in reversed(tables):
        for name, entry in table.items():
            ends, true = entry.get("ci95"), truth["parameters"].get(name)
            if ends is None or true is None or None in ends or name in seen:
                continue
            seen.add(name)
            yield Interval(name, added, float(ends[0]), float(ends[1]), float(true))
