"""Facts of the catalogue: how many sets of what, both halves alike, a seed for each."""

import hashlib
from collections import Counter

import pytest

from tests.benchmark import plan
from tests.benchmark.catalogue import catalogue, redrawn
from tests.benchmark.effects import LISTED, WHOLE_PLATFORM
from tests.benchmark.entry import KINDS, OF_STRUCTURES
from tests.benchmark.machines import MACHINES
from tests.benchmark.structures import SMALL_DEVIATIONS, STRUCTURES
from tests.benchmark.unlisted import DECLARED_VALUE, UNLISTED

ENTRIES = catalogue()
PER_KIND = {
    "single": 167,
    "pair": 30,
    "triple": 18,
    "declared_value": 16,
    "perfect": 36,
    "unlisted": 24,
    "slightly_wrong": 24,
    "short_arc": 6,
    "structure": 41,
    "structure_pair": 19,
    "structure_null": 40,
}
TERMS = ENTRIES[:321]  # the sets that came before hidden structures
OF_TERMS = {entry.machine for entry in TERMS}
KINDS_OF_TERMS = set(KINDS) - set(OF_STRUCTURES)


def test_number_of_sets_per_kind() -> None:
    assert Counter(entry.kind for entry in ENTRIES) == PER_KIND
    assert set(PER_KIND) == set(KINDS)


def test_sets_of_terms_are_those_of_before_structures() -> None:
    """Figures are compared with earlier ones: identities, seeds, halves and surroundings stay."""
    text = "\n".join(repr(entry) for entry in TERMS)
    assert hashlib.sha256(text.encode()).hexdigest() == (
        "ee0e8fbc74613374afecdc318be638b487fc1fac1ffd81656eb9f02415b41e63"
    )


def test_structures_come_after_in_both_halves_and_most_alone() -> None:
    later = ENTRIES[321:]
    assert {entry.kind for entry in later} == set(OF_STRUCTURES)
    for half in ("build", "report"):
        chosen = [entry for entry in later if entry.half == half and entry.planted]
        assert {entry.planted[0].effect for entry in chosen} == set(STRUCTURES) | {SMALL_DEVIATIONS}
        assert {entry.machine for entry in later if entry.half == half} >= {
            "rigid_pan",
            "rigid_pan_dc",
            *OF_TERMS - {"pan_drive", "pan_drive_dc"},
        }
    for entry in later:
        terms = entry.planted[1:] if entry.kind != "structure_null" else ()
        assert all(one.effect in LISTED and 1.5 <= one.level <= 6.0 for one in terms)
        assert entry.variation.period == 0.005


def test_seeds_and_identities_are_unique_and_the_catalogue_does_not_change() -> None:
    assert len({entry.seed for entry in ENTRIES}) == len(ENTRIES)
    assert len({entry.id for entry in ENTRIES}) == len(ENTRIES)
    assert catalogue() == ENTRIES


def test_both_halves_hold_every_kind_machine_and_effect() -> None:
    halves = Counter(entry.half for entry in ENTRIES)
    assert abs(halves["build"] - halves["report"]) <= 1
    for half in ("build", "report"):
        chosen = [entry for entry in TERMS if entry.half == half]
        assert {entry.kind for entry in chosen} == KINDS_OF_TERMS
        assert {entry.machine for entry in chosen} == OF_TERMS
        planted = {one.effect for entry in chosen for one in entry.planted}
        assert planted >= set(LISTED) | set(UNLISTED)
        for kind in ("perfect", "unlisted", "slightly_wrong"):
            machines = {entry.machine for entry in chosen if entry.kind == kind}
            assert machines == OF_TERMS, f"{kind} in {half}"


def test_every_single_effect_comes_in_all_five_sizes() -> None:
    for effect in LISTED:
        entries = [e for e in ENTRIES if e.kind == "single" and e.planted[0].effect == effect]
        most = plan.MOST_LEVEL.get(effect, max(plan.LEVELS))
        levels = {entry.planted[0].level for entry in entries}
        assert levels == {min(level, most) for level in plan.LEVELS}, effect
        assert {entry.half for entry in entries} == {"build", "report"}


def test_every_machine_sees_all_rates_and_a_third_of_the_perfect_ones_start_far_off() -> None:
    for machine in OF_TERMS:
        entries = [entry for entry in TERMS if entry.machine == machine]
        assert {entry.variation.period for entry in entries} == {0.001, 0.005, 0.01, 0.02}
        perfect = [entry for entry in entries if entry.kind == "perfect"]
        assert sum(entry.variation.far for entry in perfect) == 2
        for kind in ("none", "white", "coloured"):
            assert any(entry.variation.noise_kind == kind for entry in entries)
        for flag in ("repeat", "declared_noise", "declared_input_noise", "stalls"):
            assert any(getattr(entry.variation, flag) for entry in entries), (machine, flag)


def test_the_build_half_is_drawn_anew_with_its_surroundings() -> None:
    """Geared drives that start far off, of which the half holds one, are a third of them then."""
    build = [entry for entry in ENTRIES if entry.half == "build"]
    again = [redrawn(entry, number) for number in range(1, 13) for entry in build]
    assert len({entry.seed for entry in (*ENTRIES, *again)}) == len(ENTRIES) + len(again)
    assert len({entry.id for entry in again}) == len(again)
    for entry, new in zip(build, again, strict=False):
        assert (new.machine, new.kind, new.planted) == (entry.machine, entry.kind, entry.planted)
    other = sum(a.variation != b.variation for a, b in zip(build, again, strict=False))
    assert other > 0.95 * len(build)
    geared = [e for e in again if e.kind == "perfect" and e.machine.startswith("pan_drive")]
    share = sum(entry.variation.far for entry in geared) / len(geared)
    assert abs(share - 1 / plan.FAR_EVERY) < 0.15


def test_the_report_half_is_drawn_once() -> None:
    report = next(entry for entry in ENTRIES if entry.half == "report")
    with pytest.raises(ValueError, match="report half"):
        redrawn(report, 1)


def test_names_and_axes_are_those_of_the_machine() -> None:
    for entry in ENTRIES:
        for one in entry.planted:
            if one.effect == SMALL_DEVIATIONS:
                continue
            known = one.effect in LISTED or one.effect in UNLISTED or one.effect in STRUCTURES
            assert known or one.effect.startswith(DECLARED_VALUE)
            whole = one.effect in WHOLE_PLATFORM or one.effect.startswith(DECLARED_VALUE)
            assert (one.axis is None) == whole
            assert whole or one.axis in MACHINES[entry.machine].axes
