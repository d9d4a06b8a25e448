"""The score: what counts as right, missed and wrong, and the bounds of its shares."""

import math

import pytest

from tests.benchmark.score import clopper_pearson, intervals, score


def truth(kind: str, *keys: tuple[str, str | None], unlisted: tuple[str, ...] = ()) -> dict:
    """A truth with the listed effects `keys`."""
    return {
        "kind": kind,
        "effects": [effect for effect, _ in keys],
        "axes": [axis for _, axis in keys],
        "unlisted": list(unlisted),
        "parameters": {"J_pan": 0.1, "alpha_base": 3.0, "k1_cable_pan": 0.5},
        "hidden": {},
    }


def answer(verdict: str, *named: tuple[str, str | None, tuple[str, ...]]) -> dict:
    """A diagnosis that names effects with what they may be confused with."""
    return {
        "verdict": verdict,
        "added": [
            {"effect": effect, "axis": axis, "confusable_with": list(group), "parameters": {}}
            for effect, axis, group in named
        ],
        "fit": {"after": {"parameters": {}}},
    }


SPRING = ("cable_spring", "pan")
LEAN = ("base_tilt", None)


@pytest.mark.parametrize(
    ("kind", "verdict", "expected"),
    [
        ("perfect", "nothing_missing", "right"),
        ("perfect", "unexplained", "missed"),
        ("slightly_wrong", "nothing_missing", "right"),
        ("slightly_wrong", "unexplained", "right"),
        ("slightly_wrong", "partly_explained", "missed"),
        ("structure_null", "nothing_missing", "right"),
        ("structure_null", "unexplained", "right"),
        ("structure_null", "explained", "missed"),
        ("unlisted", "unexplained", "right"),
        ("unlisted", "nothing_missing", "missed"),
        ("unlisted", "explained", "missed"),
    ],
)
def test_answers_without_a_name(kind: str, verdict: str, expected: str) -> None:
    assert score(truth(kind), answer(verdict)).answer == expected


@pytest.mark.parametrize("kind", ["perfect", "slightly_wrong", "structure_null", "unlisted"])
def test_a_name_where_there_is_none_is_wrong(kind: str) -> None:
    result = score(truth(kind), answer("explained", (*SPRING, ("base_tilt",))))
    assert result.answer == "wrong"
    assert result.dishonest == ("cable_spring@pan",)


def test_a_deviation_of_a_slightly_wrong_machine_is_told_apart_from_an_invented_effect() -> None:
    named = answer("partly_explained", (*SPRING, ()), (*LEAN, ()))
    named["added"][0]["parameters"] = {"k1_cable_pan": {"value": 0.4}}
    machine = truth("slightly_wrong") | {"hidden": {"k1_cable_pan": 0.5}}
    result = score(machine, named)
    assert (result.answer, result.small) == ("wrong", ("cable_spring@pan",))
    assert result.dishonest == ("cable_spring@pan", "base_tilt")


def test_the_right_name_is_right_under_every_verdict_that_tells_one() -> None:
    for verdict in ("explained", "explained_up_to_group", "partly_explained"):
        result = score(truth("single", SPRING), answer(verdict, (*SPRING, ())))
        assert (result.answer, result.group) == ("right", False)
    assert score(truth("single", SPRING), answer("unexplained", (*SPRING, ()))).answer == "missed"
    assert score(truth("single", SPRING), answer("nothing_missing")).answer == "missed"


def test_a_group_that_holds_the_truth_is_right_and_one_that_does_not_is_wrong() -> None:
    held = answer("explained_up_to_group", (*SPRING, ("constant_torque@pan", "base_tilt")))
    result = score(truth("short_arc", LEAN), held)
    assert (result.answer, result.group, result.by_group) == ("right", True, ("base_tilt",))
    missed = answer("explained_up_to_group", (*SPRING, ("constant_torque@pan",)))
    assert score(truth("short_arc", LEAN), missed).answer == "wrong"


def test_the_axis_counts_where_it_is_told() -> None:
    two = truth("single", ("constant_torque", "tilt"))
    assert score(two, answer("explained", ("constant_torque", "pan", ()))).answer == "wrong"
    group = answer("explained", ("constant_torque", "pan", ("constant_torque@tilt",)))
    assert score(two, group).group
    assert score(two, answer("explained", ("cogging", "pan", ("constant_torque",)))).group


def test_a_stiff_shaft_beside_a_gap_may_be_named_and_need_not_be() -> None:
    gap, shaft = ("backlash", "pan"), ("shaft_compliance", "pan")
    stiff = truth("structure", gap) | {"allowed": ["shaft_compliance@pan"]}
    for named in ((gap,), (gap, shaft)):
        result = score(stiff, answer("explained", *((*one, ()) for one in named)))
        assert (result.answer, result.dishonest) == ("right", ())
    alone = score(stiff, answer("explained", (*shaft, ())))
    assert (alone.answer, alone.dishonest) == ("missed", ())
    elsewhere = score(stiff, answer("explained", (*gap, ()), ("shaft_compliance", "tilt", ())))
    assert elsewhere.answer == "wrong"
    told = truth("structure", gap, shaft)
    assert score(told, answer("explained", (*gap, ()))).answer == "missed"


def test_every_effect_of_a_pair_must_be_named() -> None:
    pair = truth("pair", SPRING, LEAN)
    half = score(pair, answer("partly_explained", (*SPRING, ())))
    assert (half.answer, half.covered) == ("missed", ("cable_spring@pan",))
    whole = answer("explained", (*SPRING, ()), (*LEAN, ()))
    assert score(pair, whole).answer == "right"
    extra = answer("explained", (*SPRING, ()), (*LEAN, ()), ("cogging", "pan", ()))
    assert score(pair, extra).answer == "wrong"


def test_beside_an_unlisted_torque_only_an_open_end_is_right() -> None:
    both = truth("unlisted", SPRING, unlisted=("wind_gust",))
    assert score(both, answer("partly_explained", (*SPRING, ()))).answer == "right"
    assert score(both, answer("unexplained")).answer == "right"
    assert score(both, answer("explained", (*SPRING, ()))).answer == "missed"
    assert score(both, answer("partly_explained", (*LEAN, ()))).answer == "wrong"


def test_a_wrong_declared_value_is_named_with_its_parameter() -> None:
    gap = truth("declared_value", ("declared_value:gap_pan", None))
    named = answer("explained", ("declared_value:gap_pan", None, ()))
    assert score(gap, named).answer == "right"
    other = answer("explained", ("declared_value:R_pan", None, ()))
    assert score(gap, other).answer == "wrong"


def test_no_answer_is_missed() -> None:
    assert score(truth("perfect"), None).answer == "missed"


def test_clopper_and_pearsons_bounds() -> None:
    assert clopper_pearson(0, 10) == pytest.approx((0.0, 0.30850), abs=1e-5)
    assert clopper_pearson(10, 10) == pytest.approx((0.69150, 1.0), abs=1e-5)
    assert clopper_pearson(5, 20) == pytest.approx((0.08657, 0.49105), abs=1e-5)


def test_intervals_hold_angles_up_to_a_turn_and_count_a_parameter_once() -> None:
    told = answer("explained", (*LEAN, ()))
    told["fit"]["after"]["parameters"] = {
        "J_pan": {"value": 0.1, "ci95": [0.09, 0.099]},
        "alpha_base": {"value": -3.28, "ci95": [-3.4, -3.2]},
        "v_s_pan": {"value": 1.0, "ci95": [0.0, 2.0]},
        "k1_cable_pan": {"value": 0.5, "ci95": None},
    }
    turned = 3.0 - 2 * math.pi
    told["added"][0]["parameters"] = {
        "alpha_base": {"value": turned, "ci95": [turned - 0.1, turned + 0.1]}
    }
    found = {one.parameter: one for one in intervals(truth("single", LEAN), told)}
    assert set(found) == {"J_pan", "alpha_base"}
    assert not found["J_pan"].holds
    assert found["alpha_base"].holds
    assert found["alpha_base"].added


def test_a_torque_that_the_catalogue_describes_by_now_may_be_named() -> None:
    decay = truth("unlisted", unlisted=("decaying_friction",)) | {"allowed": ["friction_drift@pan"]}
    drift = ("friction_drift", "pan", ())
    assert score(decay, answer("explained", drift)).answer == "right"
    assert score(decay, answer("unexplained")).answer == "right"
    assert score(decay, answer("nothing_missing")).answer == "missed"
    assert score(decay, answer("explained", ("cogging", "pan", ()))).answer == "wrong"
