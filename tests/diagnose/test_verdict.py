"""Words for what is left: training and validation runs are each held to the noise of their own."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy import stats
from scipy.signal import lfilter

from ptp_symbolic.numeric.diagnose.confirm import ambiguous_value
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.gain import (
    chance_of_larger,
    held_out_gain,
    is_noise_alone,
    is_validated,
)
from ptp_symbolic.numeric.diagnose.noise_floor import (
    NoiseFloor,
    PropagatedNoise,
    is_within_noise_of_inputs,
    leaves_noise_alone,
    noise_floor_of,
)
from ptp_symbolic.numeric.diagnose.stepwise import Step
from ptp_symbolic.numeric.diagnose.verdict import (
    EXPLAINED,
    NOTHING_MISSING,
    PARTLY,
    UNEXPLAINED,
    UP_TO_GROUP,
    word_of,
)
from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE
from ptp_symbolic.numeric.identify.evaluate import mean_squares
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.run import sizes
from tests.identify.curves import Floats
from tests.identify.straight import finished
from tests.identify.test_noise_at_rest import motion, slow_noise

WAVE = np.where(np.arange(400) % 2, 1.0, -1.0)
EFFECT = cast(Any, object())


def floor(propagated: float = 0.0) -> NoiseFloor:
    one = np.ones(1)
    return NoiseFloor(one, one, PropagatedNoise(*[propagated * one] * 3))


def quiet(after: Fit, trained: Fit, propagated: float = 0.0, left: Floats | None = None) -> bool:
    """Whether `after` is, by what it has `left` [runs, ny] (default: as no value is free)."""
    left = mean_squares(after.evaluations, after.runs) if left is None else left
    return is_noise_alone(left, sizes(after.runs), floor(propagated), trained)


def word(
    left: float, held_out: float, named: bool, propagated: float = 0.0, group: tuple[str, ...] = ()
) -> str:
    """The word where training runs leave `left` times their noise and validation runs `held_out`,
    whose inputs carry `propagated` there.
    """
    trial = FittedModel((EFFECT,) if named else (), finished([left * WAVE] * 3))
    after = finished([held_out * WAVE] * 2)
    at_noise = quiet(after, trial.fit, propagated) and leaves_noise_alone(trial, floor())
    return word_of(trial, {"effect": group} if named else {}, at_noise)


@pytest.mark.parametrize(
    ("left", "held_out", "declared", "extended"),
    [
        (1.0, 1.0, NOTHING_MISSING, EXPLAINED),
        (1.05, 1.08, NOTHING_MISSING, EXPLAINED),
        (1.5, 1.0, UNEXPLAINED, PARTLY),
        (1.0, 1.2, UNEXPLAINED, PARTLY),
    ],
)
def test_all_runs_must_be_at_their_floor(
    left: float, held_out: float, declared: str, extended: str
) -> None:
    assert word(left, held_out, named=False) == declared
    assert word(left, held_out, named=True) == extended


def test_validation_runs_may_leave_what_their_own_inputs_carry_there() -> None:
    assert word(1.0, 2.0, named=False) == UNEXPLAINED
    assert word(1.0, 2.0, named=False, propagated=np.sqrt(3.0)) == NOTHING_MISSING
    assert word(2.0, 1.0, named=False, propagated=np.sqrt(3.0)) == UNEXPLAINED


@pytest.mark.parametrize(
    ("left", "propagated", "hidden"), [(1.5, 1.2, True), (2.0, 1.2, False), (1.2, 0.8, False)]
)
def test_what_the_noise_of_the_inputs_leaves_is_no_lack(
    left: float, propagated: float, hidden: bool
) -> None:
    """The square root of 1 + 1.2^2 is 1.56; where the signals' own noise is the larger part, blocks
    of time tell.
    """
    trial = FittedModel((), finished([left * WAVE] * 3))
    assert is_within_noise_of_inputs(trial, floor(propagated)) is hidden


@pytest.mark.parametrize("white", [False, True])
def test_slow_noise_is_noise_unless_it_is_known_to_be_white(white: bool) -> None:
    """An autoregression three times as large as the white noise beside it."""
    rng = np.random.default_rng(8)
    series = [
        rng.standard_normal(4000) + 3.0 * lfilter([np.sqrt(1.0 - 0.95**2)], [1.0, -0.95], slow)
        for slow in rng.standard_normal((3, 4000))
    ]
    trial = FittedModel((), finished(series))
    runs = trial.fit.runs
    problem = SimpleNamespace(declared_noise=(), train=runs, every_sample=runs, white=white)
    found = noise_floor_of(cast(Any, problem), trial, PropagatedNoise(*[np.zeros(1)] * 3))
    assert leaves_noise_alone(trial, found) is not white
    assert found.level[0] == pytest.approx(1.0 if white else np.sqrt(10.0), rel=0.2)


@pytest.mark.parametrize("goes_on", [True, False])
def test_slow_noise_goes_on_while_the_model_rests(goes_on: bool) -> None:
    """Noise of a pole that the spectrum, cut below, tells as larger than it is; or what stands
    still with the machine.
    """
    rng, signal = np.random.default_rng(9), motion(6)
    moved = np.concatenate([[True], np.diff(signal) != 0.0])
    last = np.maximum.accumulate(np.where(moved, np.arange(len(signal)), 0))
    series = []
    for _ in range(3):
        slow = 2.5 * slow_noise(rng, 0.82, len(signal))
        series.append(rng.standard_normal(len(signal)) + (slow if goes_on else slow[last]))
    fit = finished(series)
    shown = [(signal + part)[:, None] for part in series]
    runs = tuple(replace(r, measured=m) for r, m in zip(fit.runs, shown, strict=True))
    problem = SimpleNamespace(declared_noise=(), train=runs, every_sample=runs, white=False)
    trial = FittedModel((), replace(fit, runs=runs))
    found = noise_floor_of(cast(Any, problem), trial, PropagatedNoise(*[np.zeros(1)] * 3))
    assert leaves_noise_alone(trial, found) is goes_on


def test_look_alikes_make_a_group_of_an_explanation_alone() -> None:
    assert word(1.0, 1.0, named=True, group=("other",)) == UP_TO_GROUP
    assert word(2.0, 1.0, named=True, group=("other",)) == PARTLY


def test_a_run_that_sticks_elsewhere_does_not_decide() -> None:
    after = finished([WAVE, WAVE, 6.0 * WAVE])
    assert quiet(after, finished([WAVE] * 3))


def test_a_run_that_is_far_off_decides() -> None:
    """It may be the only one that excites what is missing."""
    after = finished([WAVE, WAVE, 40.0 * WAVE])
    assert not quiet(after, finished([WAVE] * 3))


def test_what_runs_leave_with_the_best_values_decides() -> None:
    """Of three runs the median counts."""
    after, trained = finished([2.0 * WAVE] * 3), finished([WAVE] * 3)
    assert not quiet(after, trained)
    assert quiet(after, trained, left=np.array([[1.0], [1.0], [4.0]]))
    assert not quiet(after, trained, left=np.array([[1.0], [4.0], [4.0]]))


def noisy(windows: int, spread: float, seed: int) -> list[Any]:
    """Windows of noise at the floor; every twelfth of them `spread` times as large."""
    rng = np.random.default_rng(seed)
    scale = np.where(np.arange(windows) % 12, 1.0, spread)
    return [scale[k] * rng.standard_normal(100) for k in range(windows)]


@pytest.mark.parametrize(("training", "validation"), [(1.0, 1.0), (5.0, 5.0), (5.0, 1.0)])
def test_windows_that_are_alike_are_quiet(training: float, validation: float) -> None:
    """A machine that sticks elsewhere in some windows does so in both parts."""
    after, trained = finished(noisy(28, validation, 1)), finished(noisy(48, training, 2))
    assert quiet(after, trained)


def test_a_quarter_of_the_windows_is_too_many_to_be_left_out() -> None:
    """Though as many training windows leave as much: something acts there in both."""
    scale = np.where(np.arange(48) % 4, 1.0, 5.0)
    windows = [s * w for s, w in zip(scale, noisy(48, 1.0, 1), strict=True)]
    assert not quiet(finished(windows[:28]), finished(windows))


def test_windows_half_of_which_leave_more_than_the_training_runs_are_not_quiet() -> None:
    """The median alone is within its bound, and says nothing of the other half; nor does it have to
    be one half: what the worst tenth leaves is left out, whatever the others are held to.
    """
    rms = np.concatenate([np.linspace(1.0, 1.05, 14), np.linspace(1.1, 9.0, 14)])
    after = finished([s * WAVE for s in rms])
    assert np.median(rms) < ABOVE_NOISE
    assert not quiet(after, finished(noisy(48, 1.0, 3)))
    assert not quiet(after, finished(noisy(3, 1.0, 3)))  # too few to be held to
    most = finished([s * WAVE for s in (*np.linspace(1.0, 1.05, 26), 9.0, 9.0)])
    assert quiet(most, finished(noisy(3, 1.0, 3)))


def test_one_window_that_sticks_elsewhere_is_no_lack() -> None:
    """Of 221 the largest is any of those 20 in one case of eleven."""
    after = finished([*noisy(19, 1.0, 4), *(5.0 * s for s in noisy(1, 1.0, 5))])
    assert quiet(after, finished(noisy(200, 1.0, 6)))
    ours, theirs = np.r_[np.ones(19), 5.0], np.ones(200)
    assert chance_of_larger(ours, theirs) == pytest.approx(20 / 220, abs=0.01)
    drawn = np.random.default_rng(2).standard_normal((2, 30))
    exact = stats.mannwhitneyu(*drawn, alternative="greater", method="exact").pvalue
    assert chance_of_larger(*drawn) == pytest.approx(exact, abs=0.02)


def test_windows_are_held_to_the_usual_noise_and_not_to_the_most_that_may_be() -> None:
    """All validation windows leave 1.8, which noise of some colour may, and the others one."""
    after, own, one = (
        finished([1.8 * s for s in noisy(28, 1.0, 4)]),
        finished(noisy(48, 1.0, 6)),
        np.ones(1),
    )
    left = mean_squares(after.evaluations, after.runs)
    wide = NoiseFloor(one, 1.9 * one, PropagatedNoise(*[0.0 * one] * 3))
    assert not is_noise_alone(left, np.full(28, 400), wide, own)
    assert is_noise_alone(left, np.full(28, 400), wide, after)


def test_windows_that_leave_noise_are_quiet_however_little_those_at_rest_leave() -> None:
    """A rounded angle that rests leaves next to nothing, and the validation runs move all along;
    what a third of them leave beside the noise is seen all the same.
    """
    resting = [0.1 * s for s in noisy(40, 1.0, 5)]
    trained = finished([*resting, *noisy(20, 1.0, 6)])
    moving = noisy(28, 1.0, 4)
    assert quiet(finished(moving), trained)
    assert quiet(finished([0.0 * s for s in moving]), finished([0.0 * s for s in resting]))
    assert not quiet(finished([*moving[:18], *(3.0 * s for s in moving[18:])]), trained)


@pytest.mark.parametrize(
    ("left", "declared_value", "group", "is_doubtful"),
    [
        (3.0, True, ("other",), True),
        (1.0, True, ("other",), False),
        (3.0, True, (), False),
        (3.0, False, ("other",), False),
    ],
)
def test_a_known_value_is_doubted_first(
    left: float, declared_value: bool, group: tuple[str, ...], is_doubtful: bool
) -> None:
    """A declared value with look-alikes, where more than noise is left; an effect is kept."""
    trial = FittedModel((EFFECT,), finished([left * WAVE] * 3))
    candidate = SimpleNamespace(key="value", is_declared_value=declared_value)
    steps = [cast(Step, SimpleNamespace(candidate=candidate))]
    found = ambiguous_value(trial, steps, {"value": group}, floor())
    assert found is (steps[0] if is_doubtful else None)


@pytest.mark.parametrize(("left", "taken_back"), [(0.9, False), (0.97, True), (1.3, True)])
def test_validation_runs_that_improve_by_less_than_is_material_take_a_name_back(
    left: float, taken_back: bool
) -> None:
    """The share of the mean square: 19, 6 and -69 %, where a tenth is asked for."""
    before, after = finished([2.0 * WAVE] * 4), finished([2.0 * left * WAVE] * 4)
    earned = held_out_gain(after, before)
    assert earned.share == pytest.approx(1.0 - left**2, rel=1e-9)
    assert is_validated(earned, quiet=True, unusual=False, material=0.1) is not taken_back


@pytest.mark.parametrize(("left", "taken_back"), [(0.6, False), (0.8, True)])
def test_beside_a_remainder_in_validation_runs_a_name_takes_away_more_than_it_leaves(
    left: float, taken_back: bool
) -> None:
    """The share of the mean square: 64 and 36 %."""
    before, after = finished([9.0 * WAVE] * 4), finished([9.0 * left * WAVE] * 4)
    earned = held_out_gain(after, before)
    assert is_validated(earned, quiet=False, unusual=False, material=0.1) is not taken_back


@pytest.mark.parametrize(
    ("third", "unusual", "borne_out"), [(2.2, False, True), (2.2, True, False), (1.2, True, True)]
)
def test_beside_more_than_the_usual_noise_validation_runs_gain_clearly(
    third: float, unusual: bool, borne_out: bool
) -> None:
    """Two of three runs go from 2 to 1.2 times their noise; if the third goes to 2.2, the t
    statistic is 1.26, which two degrees of freedom exceed by chance in 17 %.
    """
    before = finished([2.0 * WAVE] * 3)
    after = finished([1.2 * WAVE, 1.2 * WAVE, third * WAVE])
    earned = held_out_gain(after, before)
    assert is_validated(earned, quiet=True, unusual=unusual, material=0.1) is borne_out


@pytest.mark.parametrize(("runs", "borne_out"), [(11, True), (12, False)])
def test_a_dozen_validation_runs_have_to_gain_significantly(runs: int, borne_out: bool) -> None:
    """All but five go from 2 to 1.2 times their noise, five to 2.4: 15 % in all of eleven runs, and
    19 % of twelve, with a t that is exceeded by chance in more than 5 %.
    """
    before = finished([2.0 * WAVE] * runs)
    after = finished([(2.4 if k < 5 else 1.2) * WAVE for k in range(runs)])
    earned = held_out_gain(after, before)
    assert earned.share > 0.1 and earned.chance > 0.05
    assert is_validated(earned, quiet=True, unusual=False, material=0.1) is borne_out


@pytest.mark.parametrize(("worse", "borne_out"), [(0, True), (3, False)])
def test_one_window_that_gains_far_more_than_others_hides_no_gain_of_them_all(
    worse: int, borne_out: bool
) -> None:
    """Eight windows that begin 3 to 600 times off and end near the noise gain 99 %, nearly all of
    it in one of them: seven degrees of freedom exceed such a t by chance in more than 5 %, and all
    of eight gain once in 256. Where three of them lose, neither is significant.
    """
    errors = [13.0, 50.0, 83.0, 3.0, 600.0, 110.0, 8.0, 45.0]
    before = finished([size * WAVE for size in errors])
    after = finished([(1.3 if k >= worse else 2.0 * e) * WAVE for k, e in enumerate(errors)])
    earned = held_out_gain(after, before)
    assert earned.chance > 0.05
    assert is_validated(earned, quiet=True, unusual=True, material=0.1) is borne_out
