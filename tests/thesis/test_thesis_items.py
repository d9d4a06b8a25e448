"""Items of the thesis against numbers by hand and closed forms that share no code with them."""

import math

import numpy as np
import pytest

from ptp_symbolic.thesis import (
    backlash,
    configurations,
    contact,
    errata_listings,
    friction,
    printed,
    ramp_items,
    ramp_test,
    responses,
    rigid,
)
from ptp_symbolic.thesis.items import Item, compared, erratum, half_last_digit


def by_id(items: list[Item]) -> dict[str, Item]:
    return {item.id: item for item in items}


@pytest.mark.parametrize(
    ("printed_value", "half"), [(0.025, 0.0005), (7.656, 0.0005), (12.0, 0.05), (1e-4, 5e-5)]
)
def test_half_of_the_last_digit(printed_value: float, half: float) -> None:
    assert half_last_digit(printed_value) == pytest.approx(half)


def test_numbers_agree_within_the_last_digit_and_keep_their_erratum_only_if_not() -> None:
    near = compared("a", "", 1.49, 1.4949, "deg", "", erratum=9)
    far = compared("a", "", 1.49, 1.496, "deg", "", erratum=9)
    assert near.agrees is True and near.erratum is None
    assert far.agrees is False and far.erratum == 9
    assert compared("a", "", 1.49, math.nan, "deg", "").agrees is False


def test_an_erratum_whose_check_fails_claims_nothing() -> None:
    failed = erratum(3, "Eq. 2.11", "as printed", "what holds", "", False, "check")
    assert failed.computed is None
    assert failed.agrees is None
    assert failed.settled is False


def test_table_2_2() -> None:
    found = {i.id.removeprefix("table_2_2."): i.computed for i in configurations.table_2_2()}
    assert found == {
        "completely_symmetric_balanced": "linear; un-coupled",
        "partially_symmetric_balanced": "non-linear; coupled at higher speeds",
        "symmetric_imbalanced": "non-linear; coupled",
        "asymmetric_balanced": "non-linear; coupled",
        "asymmetric_imbalanced": "non-linear; coupled",
        "cause": "inertia",
    }


def test_equation_3_8_term_by_term() -> None:
    items = configurations.equation_3_8()
    assert len(items) == 5
    assert all(item.agrees for item in items)


def test_a_wrong_sign_in_equation_3_8_would_be_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    right = configurations.printed_equation_3_8()
    wrong = {**right, "torque_tilt": -right["torque_tilt"]}
    monkeypatch.setattr(configurations, "printed_equation_3_8", lambda: wrong)
    found = {i.id: i.agrees for i in configurations.equation_3_8()}
    assert found.pop("eq_3_8.torque_tilt") is False
    assert all(found.values())


def test_backlash_mean_and_interval() -> None:
    mean, low, high = backlash.mean_interval()
    assert mean == pytest.approx(29.8 / 20)
    # Student t, 19 degrees of freedom, 97.5 %: 2.0930 from a table; standard deviation 0.08522
    half = 2.0930 * 0.0852242 / math.sqrt(20)
    assert (low, high) == pytest.approx((mean - half, mean + half), abs=1e-5)


def test_coupling_amplitudes() -> None:
    # (Jx - Jz) times the product of rates; twice that for pan, over two by sin(2 theta)
    J_x, J_z, m = 4.1e-4, 2.7e-4, 4.992
    items = by_id(rigid.items())
    assert items["fig_5_1.pan_coupling_amplitude"].computed == pytest.approx((J_x - J_z) * 100)
    assert items["fig_5_2.tilt_coupling_amplitude"].computed == pytest.approx((J_x - J_z) * 50)
    for name, c in (("0.1", 0.1), ("0.01", 0.01)):
        whole = J_x + 5.3e-3 - (J_z + 6.8e-3 + m * c * c)
        pan = items[f"fig_5_4.pan_at_{name}_m"].computed
        assert pan == pytest.approx(abs(whole) * 0.5, rel=1e-6)
        # weight plus the joint's friction at 0.5 rad/s, and at most the centrifugal torque
        tilt = items[f"fig_5_5.tilt_at_{name}_m"].computed
        assert m * 9.81 * c < tilt < m * 9.81 * c + 0.05 + abs(whole) / 2


def test_pan_torque_against_the_tilt_angle() -> None:
    # peak of J a + b w over one cubic edge of 0.5 s, evaluated on its own grid
    s = np.linspace(0.0, 1.0, 100_001)
    rate, acceleration = s * s * (3 - 2 * s), 6 * s * (1 - s) / 0.5
    items = by_id(rigid.items())
    for angle in (0.0, 30.0, 60.0, 90.0):
        cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        inertia = 5.3e-4 + 5.71e-3 * sin**2 + (7.07e-3 + 0.04992) * cos**2
        peak = float(np.max(inertia * acceleration + 0.1 * rate))
        found = items[f"fig_5_6.pan_peak_at_{angle:.0f}_deg"].computed
        assert found == pytest.approx(peak, rel=1e-5)


def test_steady_friction_is_recovered_and_the_duty_scales_it() -> None:
    items = by_id(friction.items())
    assert all(items[i].agrees for i in items if i.startswith("table_4_1"))
    # (12.9 T / 36.2 + 36.2 w) / 24 times T, T = 5.8206 + 5.6368 w far above v_s
    for speed in (0.2, 0.3, 0.4, 0.5):
        torque = 5.8206 + 5.6368 * speed
        duty = (12.9 * torque / 36.2 + 36.2 * speed) / 24
        found = items[f"fig_4_3.duty_torque_at_{speed:g}"].computed
        assert found == pytest.approx(duty * torque, rel=1e-4)


def test_the_ramp_test_finds_the_friction_and_not_the_inertia() -> None:
    for direction in printed.DIRECTIONS:
        for test, found in zip(
            printed.TABLE_4_2[direction], ramp_test.estimates(direction), strict=True
        ):
            assert found.value("F_c") == pytest.approx(test.friction.F_c, rel=2e-3)
            assert found.value("F_v") == pytest.approx(test.friction.F_v, rel=2e-3)
            assert found.rms_counts < 0.3
            assert min(abs(found.value("J") - bound) for bound in (0.049, 0.051)) < 1e-6
    free, shifted = ramp_test.inertia_without_bounds()
    # Jm + J is what the test sees: 2 % of 2.75 kg m^2 go into J
    assert shifted - free == pytest.approx(-0.055, abs=2e-3)


def test_averages_of_table_4_2() -> None:
    items = by_id(ramp_items.average_items())
    assert items["table_4_2.F_s_positive_mean"].computed == pytest.approx(37.224 / 5)
    assert items["table_4_2.v_s_negative_mean"].computed == pytest.approx(0.4763 / 5)
    assert items["table_4_2.J_negative_mean"].agrees
    assert ramp_test.matching_subsets("positive") == [(1, 2, 3, 4)]
    assert ramp_test.matching_subsets("negative") == []


def test_names_a_listing_never_sets() -> None:
    assert errata_listings.undefined_names("n = 3; for i = 1:length(n) a(:,k)=1; k=k+1;") == ["k"]
    assert errata_listings.undefined_names("k=1; for i = 1:length(n) a(:,k)=1; k=2;") == ["n"]


def test_contact_against_closed_forms() -> None:
    load, motor, k, b = 0.05, 1.1e-5 * 500**2, 5000.0, 2.0
    two_masses = math.sqrt(k * (1 / load + 1 / motor)) / (2 * math.pi)
    mode = contact.contact_mode()
    assert mode.frequency == pytest.approx(two_masses, rel=2e-3)
    ratio = b / (2 * math.sqrt(k * load))
    assert mode.damping == pytest.approx(ratio, rel=0.02)


def test_responses_settle_where_the_torques_balance() -> None:
    # 36.2 (24 - 36.2 w) / 12.9 = 0.2267 + (13.5844 + 2) w
    speed = (36.2 * 24 / 12.9 - 0.2267) / (15.5844 + 36.2**2 / 12.9)
    run = responses.response("step")
    assert run["omega_pan"][run.t == 11.0][0] == pytest.approx(speed, rel=1e-6)
    assert responses.relative_error(run, run, 12.5) == 0.0
    static, _ = responses.breakaway_of_slow_ramp()
    start = responses.run("slow_ramp", {"F_s_pan": static})
    moving = start.t[np.argmax(start["omega_gear_pan"] > 0)]
    # the ramp of 2.4 V/s holds until its stall torque reaches the breakaway torque
    assert moving == pytest.approx(static * 12.9 / 36.2 / 2.4, abs=0.01)
