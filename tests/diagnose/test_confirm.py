"""What an effect must stand before it is named, on fits of straight models."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from ptp_symbolic.numeric.diagnose.candidates import Candidate, with_what_needs_it
from ptp_symbolic.numeric.diagnose.confirm import (
    at_bound,
    depends_on_run,
    first_dominates,
    is_amount_known,
    is_reproduced_by_others,
    why_unconfirmed,
)
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.gain import Gain, p_value
from ptp_symbolic.numeric.diagnose.stepwise import is_earned, looked_at
from ptp_symbolic.numeric.identify.constants import FALSE_ALARM
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.intervals import estimates
from tests.identify.curves import Floats
from tests.identify.straight import finished

SPRING = free_parameter("k", 1.0, -5.0, 5.0)
EFFECT = Candidate("spring", None, "", "", (SPRING,), {"k": 0.0})


def fit_of(columns: list[Floats], truths: list[float], noise: float = 0.01):
    """Runs [k] that follow `truths` times their column, fitted by one spring for all."""
    rng = np.random.default_rng(8)
    pairs = list(zip(truths, columns, strict=True))
    measured = [k * c + noise * rng.standard_normal(len(c)) for k, c in pairs]
    whole, right = np.concatenate(columns), np.concatenate(measured)
    value = float(whole @ right / (whole @ whole))
    residuals = [m - value * c for m, c in zip(measured, columns, strict=True)]
    slopes = [-c[:, None] * SPRING.scale for c in columns]
    return finished(residuals, slopes, None, (SPRING,), {"k": value})


def waves(count: int) -> list[Floats]:
    return [np.sin(0.1 * np.arange(300) + k) for k in range(count)]


def test_an_effect_that_all_runs_ask_for_holds() -> None:
    assert depends_on_run(fit_of(waves(4), [1.0] * 4), EFFECT) is None


def test_an_effect_that_one_run_asks_for_and_others_deny_does_not_hold() -> None:
    """Of the four the last asks for 4, the others for nothing: 1 in all, 0 without it."""
    assert depends_on_run(fit_of(waves(4), [0.0, 0.0, 0.0, 4.0]), EFFECT) == "run 3"


def test_an_effect_that_one_run_alone_can_show_is_let_be() -> None:
    columns = [0.0 * w for w in waves(3)] + waves(1)
    assert depends_on_run(fit_of(columns, [0.0, 0.0, 0.0, 1.0]), EFFECT) is None


@pytest.mark.parametrize(("refitted", "left_out"), [(0.05, "run 0"), (0.15, None)])
def test_a_fit_without_a_run_is_held_against_the_one_in_which_a_bad_run_weighs_less(
    refitted: float, left_out: str | None
) -> None:
    """Five logs ask for 1, a bad one for -8: -0.5 in all, and 0.18 where that weighs less. Without
    the first, linear prediction leaves nothing of it, which a fit confirms or not.
    """
    fit = fit_of([waves(1)[0]] * 6, [1.0] * 5 + [-8.0])
    again = replace(fit, values={"k": refitted})
    assert depends_on_run(fit, EFFECT, lambda name: again) == left_out


@pytest.mark.parametrize(("second", "is_so"), [(0.3, True), (-1.3, False)])
def test_the_part_that_has_to_lead_is_the_larger_one(second: float, is_so: bool) -> None:
    """Of two amounts the first leads, which is one; where none has to, any is right."""
    other = free_parameter("k2", 1.0, -5.0, 5.0)
    pair = Candidate("pair", None, "", "", (SPRING, other), {"k": 0.0, "k2": 0.0}, dominant=("k",))
    (wave,) = waves(1)
    slopes = [-np.column_stack([wave, np.roll(wave, 7)])]
    fit = finished([0.0 * wave], slopes, None, (SPRING, other), {"k": 1.0, "k2": second})
    assert first_dominates(fit, pair) is is_so
    assert first_dominates(fit, replace(pair, dominant=()))


@pytest.mark.parametrize(("stiffness", "is_known"), [(0.01, False), (1.0, True)])
def test_an_effect_needs_an_amount_that_can_be_told_from_zero(
    stiffness: float, is_known: bool
) -> None:
    """The fit is good to 1 / sqrt(600) = 0.04 under noise of one."""
    fit = fit_of(waves(4), [stiffness] * 4, 1.0)
    assert is_amount_known(fit, EFFECT) is is_known


def test_parameters_that_trade_for_each_other_have_an_amount_together() -> None:
    """Columns that differ by a hundredth: each amount is good to 4, their sum to 0.03."""
    second = free_parameter("k2", 1.0, -5.0, 5.0)
    pair = Candidate("pair", None, "", "", (SPRING, second), {"k": 0.0, "k2": 0.0})
    wave = waves(4)
    columns = [np.column_stack([w, w + 0.01 * np.roll(w, 7)]) for w in wave]
    rng = np.random.default_rng(8)
    measured = [c @ [0.5, 0.5] + rng.standard_normal(len(c)) for c in columns]
    whole, right = np.concatenate(columns), np.concatenate(measured)
    found = np.linalg.lstsq(whole, right, rcond=None)[0]
    residuals = [m - c @ found for m, c in zip(measured, columns, strict=True)]
    slopes = [-c * np.array([SPRING.scale, second.scale]) for c in columns]
    fit = finished(residuals, slopes, None, (SPRING, second), {"k": found[0], "k2": found[1]})
    assert not any(e.identified for e in estimates(fit))
    assert is_amount_known(fit, pair)


@pytest.mark.parametrize(("apart", "is_named"), [(0.0, False), (0.01, False), (0.5, True)])
def test_no_effect_is_named_where_noise_is_left_and_the_others_can_do_what_it_does(
    apart: float, is_named: bool
) -> None:
    """A wave of half the noise per sample, and a parameter that is free too and acts as it does."""
    other = free_parameter("J", 1.0, -9.0, 9.0)
    columns = [np.column_stack([w, w + apart * np.roll(w, 16)]) for w in waves(4)]
    noise = [np.random.default_rng(8).standard_normal(len(c)) for c in columns]
    fit = finished(noise, [-c for c in columns], None, (SPRING, other), {"k": 0.5, "J": 1.0})
    reason = why_unconfirmed(fit, EFFECT, leaves_noise=True)
    assert (reason is None) is is_named
    assert is_named or "reproduce all that it does" in str(reason)


def test_an_effect_of_a_machine_of_which_all_is_known_is_done_by_nothing() -> None:
    columns = [w[:, None] for w in waves(4)]
    noise = [np.random.default_rng(8).standard_normal(len(c)) for c in columns]
    fit = finished(noise, [-c for c in columns], None, (SPRING,), {"k": 0.4})
    assert not is_reproduced_by_others(fit, EFFECT)
    assert not is_reproduced_by_others(replace(fit, values={"k": 0.0}), EFFECT)


@pytest.mark.parametrize(("lower", "is_done"), [(-9.0, True), (0.6, True), (0.95, False)])
def test_others_do_what_they_can_within_their_bounds(lower: float, is_done: bool) -> None:
    """To stand in for the spring, the other would go from 1.0 to 0.6."""
    other = free_parameter("J", 1.0, lower, 9.0)
    columns = [np.column_stack([w, -w]) for w in waves(4)]
    noise = [np.random.default_rng(8).standard_normal(len(c)) for c in columns]
    fit = finished(noise, [-c for c in columns], None, (SPRING, other), {"k": 0.4, "J": 1.0})
    assert is_reproduced_by_others(fit, EFFECT) is is_done


@pytest.mark.parametrize(("amount", "spoilt"), [(0.1, False), (0.5, True), (0.0, False)])
def test_only_what_others_do_is_held_against_an_effect(amount: float, spoilt: bool) -> None:
    """A wave that nothing else makes is let be, however small: half a percent of the noise's mean
    square; one that is large, beside a log that is off by 60 times the noise; one without slope.
    """
    other = free_parameter("J", 1.0, -9.0, 9.0)
    columns = [np.column_stack([w, np.roll(w, 16)]) for w in waves(4)]
    noise = list(np.random.default_rng(8).standard_normal((4, 300)))
    noise[1] *= 60.0 if spoilt else 1.0
    slopes = [-c if amount else 0.0 * c for c in columns]
    fit = finished(noise, slopes, None, (SPRING, other), {"k": amount, "J": 1.0})
    assert not is_reproduced_by_others(fit, EFFECT)


def test_an_effect_of_no_amount_through_which_another_acts_is_known_with_that() -> None:
    """Friction that goes with the load alone needs the law that it makes larger."""
    through = free_parameter("F", 1.0, 0.0, 5.0)
    law = Candidate("law", None, "", "", (through,), {"F": 0.0})
    load = Candidate("load", None, "", "", (SPRING,), {"k": 0.0}, brings=("law",))
    columns = [np.column_stack([w, np.roll(w, 50)]) for w in waves(4)]
    noise = [np.random.default_rng(8).standard_normal(len(c)) for c in columns]
    slopes = [-c * np.array([SPRING.scale, through.scale]) for c in columns]
    fit = finished(noise, slopes, None, (SPRING, through), {"k": 1.0, "F": 0.0})
    assert not is_amount_known(fit, law)
    assert why_unconfirmed(fit, law, False) is not None
    assert why_unconfirmed(fit, with_what_needs_it(law, (law, load)), False) is None
    assert with_what_needs_it(load, (law, load)) == load


def test_an_amount_is_known_whatever_its_shape() -> None:
    """A shape that acts as the amount does: of a wave along an unknown direction its part along
    the axis is seen, and that is not zero.
    """
    azimuth = free_parameter("azimuth", 1.0, -7.0, 7.0)
    by_input_noise = Candidate("by_input_noise", None, "", "", (SPRING, azimuth), {"k": 0.0})
    columns = [np.column_stack([w, 0.5 * w]) for w in waves(4)]
    noise = [np.random.default_rng(8).standard_normal(len(c)) for c in columns]
    slopes = [-c * np.array([SPRING.scale, azimuth.scale]) for c in columns]
    fit = finished(noise, slopes, None, (SPRING, azimuth), {"k": 1.0, "azimuth": 0.5})
    assert not any(e.identified for e in estimates(fit))
    assert is_amount_known(fit, by_input_noise)


@pytest.mark.parametrize(("value", "named"), [(4.9999, "k"), (-5.0, "k"), (0.0, None), (2.0, None)])
def test_a_parameter_pressed_against_a_bound_is_named(value: float, named: str | None) -> None:
    fit = finished([np.ones(9)], [np.ones((9, 1))], None, (SPRING,), {"k": value})
    assert at_bound(fit, EFFECT) == named


@pytest.mark.parametrize(("place", "named"), [(7.0, "place"), (-7.0, "place"), (3.0, None)])
def test_a_shape_at_its_bound_makes_another_effect(place: float, named: str | None) -> None:
    """A spring that is relaxed far away is a constant torque."""
    shape = free_parameter("place", 1.0, -7.0, 7.0)
    spring = Candidate("spring", None, "", "", (SPRING, shape), {"k": 0.0})
    values = {"k": 0.3, "place": place}
    fit = finished([np.zeros(20)], [np.zeros((20, 2))], None, (SPRING, shape), values)
    assert at_bound(fit, spring) == named


def test_what_a_few_blocks_show_beyond_doubt_is_clear() -> None:
    """One run in six shows the effect, in a third of its samples; noise alone is not clear."""
    pulse = np.where(np.arange(600) % 300 < 100, np.sin(0.1 * np.arange(600)), 0.0)
    columns = [0.0 * pulse] * 5 + [pulse]
    found = FittedModel((), fit_of(columns, [1.0] * 6))
    assert p_value(found, {"k": 0.0}) < 1e-6
    nothing = FittedModel((), fit_of(columns, [0.0] * 6))
    assert p_value(nothing, {"k": 0.0}) > 0.01


def test_a_gain_must_be_material_and_clear_over_all_candidates() -> None:
    """Clear by its parameters, by the gain in blocks or by their ranks, each at a third of the
    level.
    """
    p = FALSE_ALARM / 40 / 3.0
    threshold = float(stats.t.isf(p, 20))
    for t, by_rank, chance, earned in (
        (0.0, 1.0, 0.9 * p, True),
        (0.0, 1.0, 1.1 * p, False),
        (1.001 * threshold, 1.0, 1.0, True),
        (0.999 * threshold, 1.0, 1.0, False),
        (0.0, 0.9 * p, 1.0, True),
        (0.0, 1.1 * p, 1.0, False),
    ):
        assert is_earned(Gain(0.1, 0.01, 0.2, t, 20, by_rank), chance, 40, 0.1) is earned
    scanned = replace(EFFECT, frequencies_compared=50)
    assert looked_at([EFFECT, scanned], [EFFECT]) == 2
    assert looked_at([EFFECT, scanned], [scanned, EFFECT]) == 100
    small = Gain(0.09, 0.01, 0.2, 9.0, 20)
    assert is_earned(small, 0.9 * p, 40, 0.05)
    assert not is_earned(small, 0.9 * p, 40, 0.1)
    assert not is_earned(Gain(0.1, -0.01, 0.2, 9.0, 20), 0.9 * p, 40, 0.1)
