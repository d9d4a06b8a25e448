"""The law that made the points is named, and intervals hold its parameters as often as said.

Truth and noise are typed apart from the package; noise has fixed seeds.
"""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.stats import binom
from scipy.stats import t as student

from ptp_symbolic.numeric.friction_map.choice import Member, choose, compare
from ptp_symbolic.numeric.friction_map.points import LINEAR, Points
from ptp_symbolic.numeric.friction_map.summary import friction_map, profile
from tests.friction_map.laws import RATES, SCATTER, SPEEDS, Side, drawn, torque

FULL = Member("Stribeck", True)
DRY = frozenset({"Coulomb"})
COULOMB_ALONE = Side(0.3, 0.3, 0.3, 0.0)
VISCOUS = Side(0.3, 0.3, 0.3, 0.05)
CURVE = Side(0.3, 0.5, 0.3, 0.05)


LAWS = {
    "Coulomb": (Member("", False), COULOMB_ALONE, COULOMB_ALONE),
    "viscous": (Member("", True), VISCOUS, VISCOUS),
    "direction": (Member("", False, DRY), Side(0.33, 0.33, 0.3, 0.0), Side(0.27, 0.27, 0.3, 0.0)),
    "Stribeck": (FULL, CURVE, CURVE),
    "Stribeck, direction": (
        Member("Stribeck", True, DRY),
        Side(0.33, 0.53, 0.3, 0.05),
        Side(0.27, 0.47, 0.3, 0.05),
    ),
}


def check_what_is_named(law: str, draws: range) -> None:
    """The law in at least 95 of 100 draws, and a curve that is not there in at most 5."""
    member, positive, negative = LAWS[law]
    named = [choose(compare(drawn(seed, positive, negative))).member for seed in draws]
    assert sum(name == member for name in named) >= 0.95 * len(draws)
    assert sum(name.rise != member.rise for name in named) <= 0.05 * len(draws)


@pytest.mark.parametrize(("law", "draws"), [("Coulomb", 20), ("viscous", 20), ("Stribeck", 5)])
def test_the_law_that_made_the_points_is_named(law: str, draws: int) -> None:
    check_what_is_named(law, range(draws))


@pytest.mark.long
@pytest.mark.parametrize("law", LAWS)
def test_the_law_is_named_in_95_of_100_draws(law: str) -> None:
    check_what_is_named(law, range(1000, 1100))


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    truth = {"F_c": 0.3, "F_s": 0.5, "F_v": 0.05, "v_s": 0.3}
    held = dict.fromkeys(truth, 0)
    draws = 100
    for seed in range(draws):
        found = profile(compare(drawn(seed, CURVE, CURVE)), FULL, 0.95)
        of = {name: found.linear(w) for name, w in found.weights()[1].items()}
        of["v_s"] = found.of_speeds(found.speeds[:, 0], bounded=True)
        for name, estimate in of.items():
            assert estimate.low is not None and estimate.high is not None
            held[name] += estimate.low <= truth[name] <= estimate.high
    least, most = binom.ppf([0.001, 0.999], draws, 0.95)
    assert all(least <= count <= most for count in held.values()), held


def test_the_best_fit_is_that_of_scipy_from_many_starts() -> None:
    points = drawn(3, CURVE, CURVE)
    found = profile(compare(points), FULL, 0.95)
    values = {name: found.linear(w).value for name, w in found.weights()[1].items()}

    def residual(x: np.ndarray) -> np.ndarray:
        return torque(points.rate, Side(*x), Side(*x)) - points.torque

    starts = [(0.3, 0.4, v, 0.05) for v in (0.05, 0.2, 0.6, 2.0)]
    best = min((least_squares(residual, s, xtol=1e-14) for s in starts), key=lambda r: r.cost)
    assert [values["F_c"], values["F_s"], values["F_v"]] == pytest.approx(
        best.x[[0, 1, 3]], rel=2e-4
    )
    assert found.speeds[found.best, 0] == pytest.approx(best.x[2], rel=2e-3)


def test_a_friction_that_differs_by_direction_is_given_as_the_effect_takes_it() -> None:
    positive, negative = Side(0.33, 0.56, 0.3, 0.06), Side(0.27, 0.42, 0.3, 0.04)
    found = friction_map(drawn(1, positive, negative, scatter=1e-6), "tilt", 0.95)["parameters"]
    expected = {
        "F_c_tilt": 0.3,
        "a_F_c_tilt": 0.1,
        "F_s_tilt": 0.49,
        "a_F_s_tilt": 1.0 / 7.0,
        "F_v_tilt": 0.05,
        "a_F_v_tilt": 0.2,
        "v_s_tilt": 0.3,
    }
    assert {name: of["value"] for name, of in found.items()} == pytest.approx(expected, rel=1e-3)


def test_stribeck_speeds_of_each_direction_are_found() -> None:
    positive, negative = Side(0.33, 0.56, 0.2, 0.06), Side(0.27, 0.42, 0.6, 0.04)
    found = friction_map(drawn(1, positive, negative, scatter=1e-3), "pan", 0.95)
    assert found["member"].endswith("all by direction")
    assert found["parameters"]["v_s_pan"]["value"] == pytest.approx(0.4, rel=0.02)
    assert found["parameters"]["a_v_s_pan"]["value"] == pytest.approx(-0.5, rel=0.03)
    assert found["by_direction"]["negative"]["v_s"]["value"] == pytest.approx(0.6, rel=0.03)


def test_a_curve_below_the_lowest_rate_is_not_named_and_said_to_be_out_of_sight() -> None:
    fast = RATES[np.abs(RATES) > 1.0]
    found = friction_map(drawn(0, CURVE, CURVE, fast), "pan", 0.95)
    assert found["parts"] == ["Coulomb", "viscous"]
    said = " ".join(found["remarks"])
    assert "below 1.5 rad/s, the lowest speed" in said
    assert "or add breakaway torques as points at rate 0." in said


def test_breakaway_torques_show_static_friction_without_a_speed() -> None:
    fast = RATES[np.abs(RATES) > 1.0]
    moving = drawn(0, CURVE, CURVE, fast)
    rest = np.array([0.5, 0.51, 0.49, -0.5, -0.49, -0.51])
    points = Points("b.csv", np.append(moving.rate, np.zeros(6)), np.append(moving.torque, rest))
    found = friction_map(points, "pan", 0.95)
    assert found["parts"] == ["Coulomb", "static", "viscous"]
    assert found["parameters"]["F_s_pan"]["value"] == pytest.approx(0.5, abs=0.01)
    assert "v_s_pan" not in found["parameters"]
    assert any("Stribeck speed is not determined" in text for text in found["remarks"])


def test_one_direction_alone_leaves_the_difference_open() -> None:
    found = friction_map(drawn(0, CURVE, CURVE, SPEEDS), "pan", 0.95)
    assert not any("by direction" in row["member"] for row in found["members"])
    assert any("All points move one way" in text for text in found["remarks"])


def test_no_parameter_leaves_what_the_points_show() -> None:
    """A parabola: a Stribeck speed far beyond the data would fit, with an absurd static torque."""
    rate = np.concatenate([-SPEEDS, SPEEDS])
    noise = SCATTER * np.random.default_rng(5).standard_normal(len(rate))
    points = Points("p.csv", rate, np.sign(rate) * (0.5 - 0.004 * rate**2) + noise)
    found = friction_map(points, "pan", 0.95)
    for row in found["parameters"].values():
        assert abs(row["value"]) < 10.0
    said = " ".join(found["remarks"])
    assert "not determined upwards" in said
    assert "The torque is curved over the whole range" in said


def test_remarks_on_a_linear_axis_speak_of_forces_in_newtons() -> None:
    fast = RATES[np.abs(RATES) > 1.0]
    drawn_points = drawn(0, CURVE, CURVE, fast)
    points = Points("l.csv", fast, drawn_points.torque, units=LINEAR)
    said = " ".join(friction_map(points, "pan", 0.95)["remarks"])
    assert "below 1.5 m/s, the lowest speed" in said
    assert "or add breakaway forces as points at rate 0." in said


def test_torques_with_a_larger_declared_scatter_weigh_less() -> None:
    points = drawn(2, CURVE, CURVE)
    spread, wrong = np.full(len(RATES), SCATTER), points.torque.copy()
    wrong[5], spread[5] = wrong[5] + 0.5, 0.5
    found = friction_map(Points("s.csv", points.rate, wrong, spread), "pan", 0.95)
    assert found["parameters"]["F_c_pan"]["value"] == pytest.approx(0.3, abs=0.02)
    assert found["parts"] == ["Coulomb", "Stribeck", "viscous"]


def test_viscous_friction_alone_leaves_no_coulomb_friction() -> None:
    found = friction_map(drawn(0, Side(0.0, 0.0, 1.0, 0.1), Side(0.0, 0.0, 1.0, 0.1)), "pan", 0.95)
    assert found["parts"] == ["Coulomb", "viscous"]
    assert any("Coulomb friction is not significant" in text for text in found["remarks"])


@pytest.mark.parametrize("law", [np.sign, lambda v: v], ids=["Coulomb", "viscous"])
def test_points_without_scatter_are_fitted_exactly(law: Callable[[float], float]) -> None:
    rate = np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
    found = friction_map(Points("e.csv", rate, law(rate)), "pan", 0.95)
    assert len(found["parts"]) == 1 + (law is not np.sign)
    assert found["rms"]["law"] == pytest.approx(0.0, abs=1e-12)


def test_an_interval_of_a_linear_law_is_that_of_student() -> None:
    """Viscous and Coulomb friction is a straight line on each side: SciPy's t-distribution."""
    points = drawn(4, VISCOUS, VISCOUS)
    found = profile(compare(points), Member("", True), 0.95)
    columns = np.column_stack([np.sign(points.rate), points.rate])
    values, (rss,), *_ = np.linalg.lstsq(columns, points.torque, rcond=None)
    left = len(points.rate) - 2
    spread = np.sqrt(rss / left * np.diag(np.linalg.inv(columns.T @ columns)))
    half = student.isf(0.025, left) * spread
    estimates = {name: found.linear(w) for name, w in found.weights()[1].items()}
    for k, name in enumerate(("F_c", "F_v")):
        own = estimates[name]
        assert (own.low, own.high) == pytest.approx(
            (values[k] - half[k], values[k] + half[k]), rel=1e-6
        )


@pytest.mark.long
def test_a_law_is_given_up_at_one_chance_in_a_hundred_not_at_five() -> None:
    """Points that Coulomb friction alone makes as seldom as one in thirty are no evidence yet."""
    doubtful = 0
    for seed in range(400):
        points = compare(drawn(seed, COULOMB_ALONE, COULOMB_ALONE))
        strict = choose(points, level=0.05)
        if strict.member == Member("", False):
            continue
        p = choose(points).p_values[Member("", False)]
        if p > 0.012:
            doubtful += 1
            assert choose(points).member == Member("", False)
        if doubtful == 3:
            break
    assert doubtful == 3


@pytest.mark.parametrize("backwards", [1, 2, 3])
@pytest.mark.filterwarnings("error")
def test_few_points_of_one_direction_leave_out_the_laws_that_they_cannot_determine(
    backwards: int,
) -> None:
    """Coulomb and viscous friction without scatter, so that no law is better."""
    rate = np.array([0.5, 1.0, 2.0, 3.0, 5.0, 8.0, *(-1.0, -2.0, -4.0)[:backwards]])
    points = Points("few.csv", rate, 0.3 * np.sign(rate) + 0.05 * rate)
    law = friction_map(points, "pan", 0.95)
    assert law["parts"] == ["Coulomb", "viscous"]
    assert law["parameters"]["F_c_pan"]["value"] == pytest.approx(0.3, rel=1e-6)
    assert law["parameters"]["F_v_pan"]["value"] == pytest.approx(0.05, rel=1e-6)


@pytest.mark.filterwarnings("error")
def test_breakaway_torques_beside_a_curve_raise_no_warning() -> None:
    """Static friction at rest alone has as many linear parameters as the curve that holds it."""
    rate = np.array([0.0, 0.0, *RATES])
    moving = torque(RATES, CURVE, CURVE)
    noise = SCATTER * np.random.default_rng(5).standard_normal(len(rate))
    points = Points("rest.csv", rate, np.concatenate([[0.5, -0.5], moving]) + noise)
    assert choose(compare(points)).member == FULL
