"""The catalogue: every set of the benchmark, in a fixed order with a seed of its own.

Build and report alternate in the pattern build, report, report, build: that gives both halves the
same number of sets, and a machine or an effect that comes twice in a row comes once in each.
"""

import dataclasses
import itertools
from collections import Counter
from collections.abc import Iterator

import numpy as np

from tests.benchmark import plan
from tests.benchmark.delays import DelayedVariation
from tests.benchmark.effects import WHOLE_PLATFORM
from tests.benchmark.entry import OF_STRUCTURES, Entry, Planted
from tests.benchmark.structures import SMALL_DEVIATIONS, STIFF_SHAFT
from tests.benchmark.unlisted import DECLARED_VALUE
from tests.benchmark.variation import (
    Variation,
    draw_variation,
    for_faint_effects,
    for_small_deviations,
)

FIRST_SEED = 4000
SEEDS_APART = 10_000  # of the same entry drawn again
HALVES = ("build", "report", "report", "build")
COMBINED_LEVELS = (1.5, 6.0)
UNLISTED_LEVELS = (1.5, 8.0)
DECLARED_LEVEL = 3.0
SHORT_ARC_LEVEL = 3.0

Draft = tuple[str, str, tuple[Planted, ...]]  # machine, kind, what is planted


def _planted(machine: str, name: str, level: float) -> Planted:
    """From "effect" or "effect@axis"; a machine with one axis need not be told which."""
    effect, _, axis = name.partition("@")
    if effect in WHOLE_PLATFORM or effect.startswith(DECLARED_VALUE):
        return Planted(effect, None, level)
    return Planted(effect, axis or plan.MACHINE_AXIS[machine], level)


def _levels(seed: int, count: int, between: tuple[float, float]) -> list[float]:
    """Random levels, even in their logarithm."""
    rng = np.random.default_rng([seed, 7])
    return [round(float(level), 2) for level in np.exp(rng.uniform(*np.log(between), count))]


def _singles() -> Iterator[Draft]:
    """One effect each: the places of an effect in turn, and the levels in turn."""
    for number, (effect, (count, places)) in enumerate(plan.SINGLES.items()):
        for k in range(count):
            machine, axis = places[k % len(places)]
            level = plan.LEVELS[(k + number) % len(plan.LEVELS)]
            level = min(level, plan.MOST_LEVEL.get(effect, level))
            yield machine, "single", (Planted(effect, axis, level),)


def _combined(kind: str, table: tuple[tuple[str, ...], ...], seed: int) -> Iterator[Draft]:
    """Sets with several effects, each with a level of its own."""
    for number, (machine, *names) in enumerate(table):
        names = [name for name in names if name]
        between = UNLISTED_LEVELS if kind == "unlisted" else COMBINED_LEVELS
        levels = _levels(seed + number, len(names), between)
        planted = [_planted(machine, *both) for both in zip(names, levels, strict=True)]
        yield machine, kind, tuple(planted)


def _drafts() -> Iterator[Draft]:
    """All sets in the order of the catalogue, without seeds."""
    yield from _singles()
    yield from _combined("pair", plan.PAIRS, 100)
    yield from _combined("triple", plan.TRIPLES, 200)
    for machine, parameter in plan.DECLARED_VALUES:
        yield (
            machine,
            "declared_value",
            (_planted(machine, DECLARED_VALUE + parameter, DECLARED_LEVEL),),
        )
    for _ in range(plan.PERFECT_PER_MACHINE):
        for machine in plan.SLIGHTLY_WRONG:
            yield machine, "perfect", ()
    yield from _combined("unlisted", plan.UNLISTED, 300)
    for machine, count in plan.SLIGHTLY_WRONG.items():
        yield from itertools.repeat((machine, "slightly_wrong", ()), count)
    for machine, effect in plan.SHORT_ARCS:
        yield machine, "short_arc", (_planted(machine, effect, SHORT_ARC_LEVEL),)
    yield from _both_driven()
    yield from _structures()
    yield from _structure_nulls()


def _strata(between: tuple[float, float], count: int, seed: int) -> list[float]:
    """Sizes even in their logarithm, one in each of `count` parts of the range, in random order."""
    rng = np.random.default_rng([seed, 9])
    places = (rng.permutation(count) + rng.uniform(0.1, 0.9, count)) / count
    low, high = np.log(between)
    return [float(f"{size:.4g}") for size in np.exp(low + places * (high - low))]


def _structures() -> Iterator[Draft]:
    """Hidden structures in the sizes of their own or in thresholds, some with a listed term."""
    for number, (structure, (between, places)) in enumerate(plan.STRUCTURES.items()):
        sizes = _strata(between, len(places), 500 + number)
        terms = _levels(600 + number, len(places), COMBINED_LEVELS)
        for (machine, axis, *beside), size, level in zip(places, sizes, terms, strict=True):
            planted = [Planted(structure, axis, size)]
            for name in beside:
                effect, _, where = name.partition("@")
                whole = effect in WHOLE_PLATFORM
                planted.append(Planted(effect, None if whole else where or axis, level))
            yield machine, "structure_pair" if beside else "structure", tuple(planted)


def _structure_nulls() -> Iterator[Draft]:
    """Machines that are declared rigid and are."""
    for machine, (perfect, deviating, stiff) in plan.STRUCTURE_NULLS.items():
        yield from itertools.repeat((machine, "structure_null", ()), perfect)
        small = (Planted(SMALL_DEVIATIONS, None, 1.0),)
        yield from itertools.repeat((machine, "structure_null", small), deviating)
        shaft = (Planted(STIFF_SHAFT, plan.MACHINE_AXIS[machine], plan.STIFF),) if stiff else ()
        yield from itertools.repeat((machine, "structure_null", shaft), stiff)


def _both_driven() -> Iterator[Draft]:
    """All sets of the machine with two motors."""
    visible = plan.LEVELS[:3]
    for number, (kind, *names) in enumerate(plan.OF_BOTH_DRIVEN):
        levels = _levels(400 + number, len(names), COMBINED_LEVELS)
        if kind == "single":
            levels = [visible[number % len(visible)]]
        elif kind == "declared_value":
            names, levels = [DECLARED_VALUE + names[0]], [DECLARED_LEVEL]
        planted = [_planted(plan.BOTH_DRIVEN, *both) for both in zip(names, levels, strict=True)]
        yield plan.BOTH_DRIVEN, kind, tuple(planted)


def _variation(seed: int, draft: Draft, far: bool) -> Variation:
    """The surroundings of a set: by chance, but for what its effects need."""
    machine, kind, planted = draft
    if kind in OF_STRUCTURES:
        return _rigid_variation(seed, draft)
    fine = machine == "direct_drive" or kind == "short_arc"
    variation = draw_variation(seed, fine, far, kind == "short_arc")
    without = [
        f"{one.effect}@{one.axis}"
        for one in planted
        if one.effect in ("viscous_friction", "csvs_friction")
    ]
    if any(one.effect in plan.FAINT.get(machine, ()) for one in planted):
        variation = for_faint_effects(variation)
    if any(one.effect == "product_of_inertia" for one in planted):
        # The small tilt body is nearly a rod: it can hardly have products of inertia.
        variation = dataclasses.replace(variation, heavy=True)
    if kind == "slightly_wrong":
        variation = for_small_deviations(variation)
    return dataclasses.replace(variation, without=tuple(without))


def _rigid_variation(seed: int, draft: Draft) -> Variation:
    """The surroundings of a machine that is declared rigid: 200 Hz, at most 3 counts of noise."""
    machine, kind, planted = draft
    variation = draw_variation(seed, machine == "direct_drive")
    rng = np.random.default_rng([seed, 10])
    noise = 0.0 if variation.noise_kind == "none" else round(float(rng.uniform(0.0, 3.0)), 3)
    counts = min(variation.counts, plan.MOST_COUNTS)
    for one in planted:
        if one.effect in plan.FINE_BEYOND and one.axis == "pan":
            value, above = plan.FINE_BEYOND[one.effect]
            if (one.level > value) == above:
                counts, noise = plan.MOST_COUNTS, 0.1 * noise
    variation = dataclasses.replace(
        variation, period=plan.RIGID_PERIOD, repeat=False, noise_counts=noise, counts=counts
    )
    faint = plan.FAINT.get(machine.replace("rigid_pan", "pan_drive"), ())
    if any(one.effect in faint for one in planted):
        variation = for_faint_effects(variation)
    if any(one.effect == SMALL_DEVIATIONS for one in planted):
        variation = for_small_deviations(variation)
        if machine.startswith("rigid_pan"):
            variation = for_faint_effects(variation)
    if kind != "structure_null":
        return variation
    return DelayedVariation(
        **dataclasses.asdict(variation), delays=str(rng.choice(["", "known", "free"]))
    )


def catalogue() -> tuple[Entry, ...]:
    """All entries; the same on every call."""
    entries, perfect = [], Counter[str]()
    for number, draft in enumerate(_drafts()):
        machine, kind, planted = draft
        far = False
        if kind == "perfect":
            far = perfect[machine] % plan.FAR_EVERY == 1
            perfect[machine] += 1
        seed = FIRST_SEED + number
        names = "+".join(
            one.effect.replace(DECLARED_VALUE, "") + (f"@{one.axis}" if one.axis else "")
            for one in planted
        )
        identity = "-".join(filter(None, (f"{number:03d}", machine, kind, names)))
        variation = _variation(seed, draft, far)
        half = HALVES[number % len(HALVES)]
        entries.append(Entry(identity, machine, kind, planted, seed, variation, half))
    return tuple(entries)


def redrawn(entry: Entry, number: int) -> Entry:
    """The same machine, effects and sizes in other surroundings and with another chance, for work
    on the diagnosis: an entry of the report half would no longer be unseen.

    Raises ValueError for one of the report half.
    """
    if entry.half != "build":
        raise ValueError(f"{entry.id} is of the report half: it is drawn once")
    seed = entry.seed + number * SEEDS_APART
    far = entry.kind == "perfect" and np.random.default_rng([seed, 8]).random() < 1 / plan.FAR_EVERY
    variation = _variation(seed, (entry.machine, entry.kind, entry.planted), far)
    identity = f"redrawn{number}-{entry.id}"
    return dataclasses.replace(entry, id=identity, seed=seed, variation=variation)
