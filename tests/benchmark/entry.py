"""An entry of the catalogue: which machine hides what, how large, with which chance."""

from dataclasses import dataclass

from tests.benchmark.variation import Variation

KINDS = (
    "single",
    "pair",
    "triple",
    "declared_value",
    "perfect",
    "unlisted",
    "slightly_wrong",
    "short_arc",
    "structure",
    "structure_pair",
    "structure_null",
)
OF_STRUCTURES = KINDS[-3:]  # of machines that are declared rigid


@dataclass(frozen=True)
class Planted:
    """A hidden effect: its name, its axis (None for the whole platform), its size in thresholds, or
    in its own unit where a structure has one.
    """

    effect: str
    axis: str | None
    level: float


@dataclass(frozen=True)
class Entry:
    """One set of logs; `half` is "build" for work on the diagnosis or "report" for its figures."""

    id: str
    machine: str
    kind: str
    planted: tuple[Planted, ...]
    seed: int
    variation: Variation
    half: str
