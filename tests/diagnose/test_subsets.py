"""All subsets of effects as columns of one regression: planted ones found, noise not taken."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose import regression as regression_module
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.regression import (
    Regression,
    Subset,
    exchanges,
    gain_along_motion,
    is_no_worse,
    larger_sets,
    ranked_subsets,
    regression,
    remainder,
    weakly_identified,
)
from ptp_symbolic.numeric.diagnose.signatures import Signature
from ptp_symbolic.numeric.identify.constants import CYCLES, FAR, REPEATS
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from tests.identify.curves import Floats

ROWS, BLOCKS = 400, 40
DECLARED = (free_parameter("J", 1.0, 0.0, 9.0), free_parameter("b", 1.0, 0.0, 9.0))


def signature(key: str, columns: Floats, brings: tuple[str, ...] = ()) -> Signature:
    """What a candidate of that key, a parameter per column [n, c], would change."""
    columns = np.linalg.qr(columns)[0]
    names = [f"{key}_{k}" for k in range(columns.shape[1])]
    free = tuple(free_parameter(name, 1.0, -9.0, 9.0) for name in names)
    off = dict.fromkeys(names, 0.0)
    candidate = Candidate(key, None, f"effect {key}", "-", free, off, brings=brings)
    return Signature(candidate, (tuple(columns.T),), frozenset(), columns)


def effects(rng: np.random.Generator, keys: str) -> list[Signature]:
    """Unrelated effects, every other one with two parameters."""
    return [signature(k, rng.standard_normal((ROWS, 1 + n % 2))) for n, k in enumerate(keys)]


def in_one_run(block: NDArray[np.int64]) -> NDArray[np.int64]:
    """Blocks [n] of one run in the form [n, 2] that a regression has."""
    return np.column_stack([0 * block, block])


def rows_of(
    rng: np.random.Generator, found: Sequence[Signature], planted: dict[str, float], blocks: int
) -> Regression:
    """Rows with noise of 1, declared parameters, and effects `planted` with that rms a column."""
    base = rng.standard_normal((ROWS, 2))
    rows = base @ [1.0, -3.0] + rng.standard_normal(ROWS)
    for s in found:
        rms = planted.get(s.candidate.key, 0.0)
        rows = rows + rms * np.sqrt(ROWS) * s.columns.sum(axis=1)
    block = in_one_run(np.arange(ROWS) * blocks // ROWS)
    equation = np.zeros(ROWS, dtype=np.int64)
    return regression(rows, DECLARED, base, found, equation, block, np.ones(ROWS))


def keys(subset: Subset) -> str:
    return "".join(c.key for c in subset.candidates)


@pytest.mark.parametrize("planted", ["", "d", "bg", "aef"])
def test_the_planted_set_predicts_best_and_smaller_ones_are_worse(planted: str) -> None:
    """Effects of 0.4 of the noise: 400 rows tell each to 0.05. An idle effect may be lucky
    and gain a little, but the planted set is no worse than with it.
    """
    rng = np.random.default_rng(51)
    found = rows_of(rng, effects(rng, "abcdefgh"), dict.fromkeys(planted, 0.4), BLOCKS)
    ranking = ranked_subsets(found, 3)
    by_keys = {keys(s): s for s in ranking}
    assert [s.loss for s in ranking] == sorted(s.loss for s in ranking)
    assert set(planted) <= set(keys(ranking[0]))
    no_worse = [s for s in ranking if is_no_worse(s, ranking[0], 2.0, 0.02)]
    assert min(no_worse, key=lambda s: s.columns) is by_keys[planted]


def test_what_a_subset_loses_is_what_refits_without_each_block_mispredict() -> None:
    """As many blocks as folds: each is predicted by the seven others, and capped."""
    rng = np.random.default_rng(52)
    found = rows_of(rng, effects(rng, "abc"), {"b": 0.7}, REPEATS)
    found.rows[::50] += 30.0
    root = np.sqrt(found.weight)[:, None]
    for subset in ranked_subsets(found, 2):
        own = [s.columns for s in found.signatures if s.candidate in subset.candidates]
        table = np.column_stack([found.base, *own])
        for block in range(REPEATS):
            here = found.block[:, 1] == block
            weighted = [(m * root)[~here] for m in (table, found.rows[:, None])]
            left = found.rows[here] - table[here] @ np.linalg.lstsq(*weighted)[0][:, 0]
            expected = np.sum(np.minimum((left / found.scale[here]) ** 2, FAR**2))
            assert subset.losses[block] == pytest.approx(expected, rel=1e-6)
        assert subset.columns == table.shape[1]


def test_where_nothing_is_missing_the_empty_set_is_no_worse() -> None:
    """Fifty draws of noise with ten effects. The best of 56 sets gains about 1 % by luck, and two
    standard errors in one draw of a hundred: three times in fifty with a chance of 1 %.
    """
    holds, by_errors_alone, best = 0, 0, 0
    for seed in range(50):
        rng = np.random.default_rng(seed)
        ranking = ranked_subsets(rows_of(rng, effects(rng, "abcdefghij"), {}, BLOCKS), 2)
        empty = next(s for s in ranking if not s.candidates)
        holds += is_no_worse(empty, ranking[0], 2.0, 0.02)
        by_errors_alone += is_no_worse(empty, ranking[0], 2.0, 0.0)
        best += empty is ranking[0]
    assert holds >= 48 and by_errors_alone >= 47
    assert best < 40


def test_the_empty_set_is_worse_where_an_effect_is_missing() -> None:
    rng = np.random.default_rng(53)
    ranking = ranked_subsets(rows_of(rng, effects(rng, "abc"), {"a": 0.7}, BLOCKS), 2)
    empty = next(s for s in ranking if not s.candidates)
    assert not is_no_worse(empty, ranking[0], 2.0, 0.02)


def test_no_worse_is_within_standard_errors_of_the_paired_blocks_or_within_a_share() -> None:
    """Differences of 1 +- 2 over 16 blocks of 10: an excess of 16 with a standard error of 8."""
    best = Subset((), np.full(16, 10.0), 1)
    other = Subset((), best.losses + 1.0 + np.tile([2.0, -2.0], 8), 2)
    assert is_no_worse(other, best, 2.01, 0.0) and not is_no_worse(other, best, 1.99, 0.0)
    assert is_no_worse(other, best, 0.0, 0.101) and not is_no_worse(other, best, 0.0, 0.099)


@pytest.mark.parametrize("apart", [0.0, 1e-12, 1e-8, 1e-5, 1e-2])
def test_effects_that_nearly_act_alike_do_as_well_alone_as_together(apart: float) -> None:
    rng = np.random.default_rng(54)
    shape = rng.standard_normal((ROWS, 1))
    twin = shape + apart * rng.standard_normal((ROWS, 1))
    found = [signature("a", shape), signature("b", twin), *effects(rng, "cd")]
    by_keys = {keys(s): s for s in ranked_subsets(rows_of(rng, found, {"a": 0.7}, BLOCKS), 3)}
    assert all(np.all(np.isfinite(s.losses)) for s in by_keys.values())
    assert by_keys["a"].loss == pytest.approx(by_keys["b"].loss, rel=0.02)
    assert by_keys["ab"].loss == pytest.approx(by_keys["a"].loss, rel=0.02)
    assert by_keys["a"].loss < 0.8 * by_keys[""].loss


def test_an_effect_is_never_proposed_without_what_it_acts_on_nor_in_two_versions() -> None:
    """Load-dependent friction needs a friction, and this one explains the rows best."""
    rng = np.random.default_rng(55)
    friction, load, other = effects(rng, "fgo")
    load = signature("g", load.columns, brings=("f",))
    richer = signature("f", np.column_stack([friction.columns, rng.standard_normal(ROWS)]))
    found = rows_of(rng, [load, friction, other, richer], {"g": 0.8}, BLOCKS)
    ranking = ranked_subsets(found, 3)
    sets = [keys(s) for s in ranking]
    assert "g" in sets[0]
    assert all("f" in s for s in sets if "g" in s)
    assert all(s.count("f") <= 1 for s in sets)
    assert {"".join(sorted(s)) for s in sets} == {"", "f", "o", "fg", "fo", "fgo"}


def test_the_remainder_is_what_the_declared_columns_cannot_take_up() -> None:
    rng = np.random.default_rng(56)
    found = rows_of(rng, effects(rng, "a"), {"a": 2.0}, BLOCKS)
    assert found.base.T @ (found.weight * remainder(found)) == pytest.approx(0.0, abs=1e-9)


def test_outliers_count_less_and_the_scale_is_that_of_the_other_rows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Every eighth row is off by 50 standard deviations, as contacts are that were not masked: the
    median of absolute values, of noise and outliers together, moves up by a quarter at most. The
    weights are settled.
    """
    rng = np.random.default_rng(57)
    base, rows = rng.standard_normal((ROWS, 2)), rng.standard_normal(ROWS)
    rows[::8] += 50.0
    equation, block = np.zeros(ROWS, dtype=np.int64), in_one_run(np.arange(ROWS) // 10)
    found = regression(rows, DECLARED, base, (), equation, block, np.ones(ROWS))
    assert found.scale == pytest.approx(np.ones(ROWS), rel=0.25)
    assert np.max(found.weight[::8]) < 0.06 * np.max(found.weight)
    monkeypatch.setattr(regression_module, "CYCLES", 20 * CYCLES)
    settled = regression(rows, DECLARED, base, (), equation, block, np.ones(ROWS))
    assert found.weight == pytest.approx(settled.weight, rel=0.01)


def test_a_candidate_that_rows_cannot_tell_from_a_member_is_tried_in_its_place() -> None:
    """Of "ad" the effect "a" has a double, "d" has none, and "b" is something else."""
    rng = np.random.default_rng(5)
    found = effects(rng, "abd")
    twin = found[0].columns + 1e-3 * np.linalg.qr(rng.standard_normal((ROWS, 1)))[0]
    found.append(signature("t", twin))
    rows = rows_of(rng, found, {"a": 1.0, "d": 1.0}, BLOCKS)
    chosen = tuple(s.candidate for s in rows.signatures if s.candidate.key in "ad")
    assert [sorted(c.key for c in s) for s in exchanges(rows, chosen)] == [["d", "t"]]


@pytest.mark.parametrize("is_hidden", [False, True])
def test_an_exchange_leaves_nothing_without_what_it_acts_on(is_hidden: bool) -> None:
    """A twin of `a` takes its place beside what needs nothing, not beside what acts through `a`,
    whether the rows show that or not.
    """
    rng = np.random.default_rng(62)
    found = effects(rng, "ab")
    twin = found[0].columns + 1e-3 * rng.standard_normal((ROWS, 1))
    found += [signature("t", twin), signature("c", rng.standard_normal((ROWS, 1)), ("a",))]
    rows = rows_of(rng, found, {"a": 1.0, "b": 1.0, "c": 1.0}, BLOCKS)
    chosen = tuple(s.candidate for s in found if s.candidate.key in "abc")
    if is_hidden:
        rows = replace(rows, signatures=tuple(found[:3]))
    assert [s for s in exchanges(rows, chosen) if "t" in {c.key for c in s}] == []
    (instead,) = exchanges(rows, chosen[:2])
    assert {c.key for c in instead} == {"b", "t"}


def named(found: Regression, wanted: str) -> list[Candidate]:
    return [s.candidate for s in found.signatures if s.candidate.key in wanted]


@pytest.mark.parametrize("planted", ["bd", "ceg"])
def test_a_set_grows_by_the_planted_effect_that_it_lacks(planted: str) -> None:
    """With all but one of the planted effects, that one comes first; with all of them, none of the
    idle ones gains clearly.
    """
    rng = np.random.default_rng(61)
    found = rows_of(rng, effects(rng, "abcdefgh"), dict.fromkeys(planted, 0.4), BLOCKS)
    for lacking in planted:
        have = named(found, planted.replace(lacking, ""))
        first = larger_sets(found, have)[0]
        assert [c.key for c in first] == [*(c.key for c in have), lacking]
        gained = gain_along_motion(found, first, have)
        assert gained is not None
        assert gained.is_significant(8)
    every = named(found, planted)
    idle = [gain_along_motion(found, larger, every) for larger in larger_sets(found, every)]
    assert len(idle) == 8 - len(planted)
    assert not any(g is None or g.is_significant(8) for g in idle)


def test_the_gain_along_the_motion_is_the_share_of_the_squares_that_is_planted() -> None:
    """A column of 0.5 of the noise: 0.25 of 1.25, to two standard errors of 400 rows, 0.08, losses
    at four standard deviations hardly capped; and turned round the gain is a loss.
    """
    rng = np.random.default_rng(62)
    found = rows_of(rng, effects(rng, "abc"), {"a": 0.5}, BLOCKS)
    gained = gain_along_motion(found, named(found, "a"), [])
    lost = gain_along_motion(found, [], named(found, "a"))
    assert gained is not None and lost is not None
    assert gained.share == pytest.approx(0.2, abs=0.08)
    assert gained.lower < 0.2 < gained.upper
    assert lost.share < 0.0


def test_blocks_of_a_gain_do_not_reach_from_one_run_into_the_next() -> None:
    """The blocks of two runs in which they are numbered alike, as of one run twice as long. Taken
    for the same they would be half as many; each run ends with a shorter block of its own.
    """
    rng = np.random.default_rng(65)
    found = rows_of(rng, effects(rng, "abc"), {"a": 0.5}, BLOCKS)
    run, own = np.divmod(found.block[:, 1], BLOCKS // 2)
    parted = replace(found, block=np.column_stack([run, own]))
    whole, halves = (gain_along_motion(f, named(found, "a"), []) for f in (found, parted))
    assert whole is not None and halves is not None
    assert halves.share == pytest.approx(whole.share, rel=1e-9)
    assert halves.degrees > 0.75 * whole.degrees


def test_rows_say_nothing_of_what_they_do_not_show() -> None:
    rng = np.random.default_rng(63)
    found = rows_of(rng, effects(rng, "abc"), {"a": 0.5}, BLOCKS)
    hidden = signature("x", rng.standard_normal((ROWS, 1))).candidate
    assert gain_along_motion(found, [hidden], []) is None
    assert gain_along_motion(found, [hidden, *named(found, "a")], [hidden]) is not None
    assert all(larger[0] is hidden for larger in larger_sets(found, [hidden]))
    assert len(larger_sets(found, [hidden])) == 3


def test_a_set_grows_with_what_an_effect_brings_along() -> None:
    rng = np.random.default_rng(64)
    own = [signature("a", rng.standard_normal((ROWS, 1)), brings=("c",)), *effects(rng, "bc")]
    found = rows_of(rng, own, {"a": 0.5}, BLOCKS)
    assert [c.key for c in larger_sets(found, named(found, "b"))[0]] == ["b", "c", "a"]
    assert [c.key for c in larger_sets(found, named(found, "bc"))[0]] == ["b", "c", "a"]


@pytest.mark.parametrize(("rms", "named"), [(0.1, ["b"]), (0.3, [])])
def test_rows_that_overlap_tell_as_much_as_their_blocks_do(rms: float, named: list[str]) -> None:
    """400 rows of noise 1 tell a column of 0.1 to half its start, which is 1; their 40 blocks do
    not.
    """
    rng = np.random.default_rng(7)
    found = rows_of(rng, [], {}, BLOCKS)
    base = found.base * [1.0, rms]
    assert [f.name for f in weakly_identified(replace(found, base=base))] == named
