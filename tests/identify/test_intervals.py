"""95 % intervals: how often they hold the truth, and what they say where the data are silent."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from scipy.signal import lfilter

from ptp_symbolic.numeric.identify.blocks import degrees_of_freedom
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, free_parameter
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import (
    Estimate,
    estimates,
    project_out,
)
from tests.identify.curves import Floats
from tests.identify.straight import finished

RUNS, SAMPLES, RATE = 3, 500, 50
TRUTH = np.array([2.0, 0.0])
MEMORY, SIZE = 0.8, 3.0  # correlation from sample to sample; rms over the believed noise
REPEATS = 600
TIME = np.arange(SAMPLES) / RATE
NORMAL, STUDENT_11 = 1.95996, 2.20099  # 97.5 % quantiles, from a table


def slow_wave(seed: int) -> Floats:
    """A regressor [k] that changes over seconds, as parameters of machines act."""
    phases = np.random.default_rng(seed).uniform(0.0, 6.0, 3)
    return np.sin(2 * np.pi * np.outer(TIME, [0.11, 0.29, 0.43]) + phases).sum(axis=1)


WAVE, OTHER = slow_wave(100), slow_wave(101)
COLUMNS = [np.column_stack([slow_wave(r), slow_wave(RUNS + r)]) for r in range(RUNS)]
OFFSET = np.ones((SAMPLES, 1))  # the unknown start of every run
DESIGN = np.vstack(
    [np.hstack([c, np.kron(np.eye(RUNS)[[r]], OFFSET)]) for r, c in enumerate(COLUMNS)]
)
CENTRED = [c - c.mean(axis=0) for c in COLUMNS]
LINEAR = (free_parameter("a", 1.0, -50.0, 50.0), free_parameter("b", -0.3, -50.0, 50.0))
FRICTION = (LINEAR[0], free_parameter("b", 0.3, 0.0, 50.0))


def noise(rng: np.random.Generator, memory: float) -> Floats:
    """Noise [runs, k] of rms SIZE whose samples remember one another."""
    white = SIZE * np.sqrt(1 - memory**2) * rng.standard_normal((RUNS, SAMPLES + 100))
    return lfilter([1.0], [1.0, -memory], white)[:, 100:]


def straight_fit(measured: Floats, free: tuple[FreeParameter, ...]) -> Fit:
    """Least squares within the bounds of `free` and with an offset of every run, all at once."""
    lower = [f.lower for f in free] + [-np.inf] * RUNS
    upper = [f.upper for f in free] + [np.inf] * RUNS
    found = lsq_linear(DESIGN, measured.ravel(), (lower, upper)).x
    residuals = (measured.ravel() - DESIGN @ found).reshape(measured.shape)
    scales = np.array([f.scale for f in free])
    values = {f.name: float(v) for f, v in zip(free, found, strict=False)}
    return finished(residuals, [-c * scales for c in COLUMNS], [-OFFSET] * RUNS, free, values)


def white_widths(cost: float) -> Floats:
    """Half widths [2] of textbook intervals where neighbouring residuals are independent."""
    inverse = np.linalg.inv(sum(c.T @ c for c in CENTRED))
    return NORMAL * np.sqrt(cost / (RUNS * SAMPLES - 2 - RUNS) * np.diag(inverse))


@cache
def repeats(memory: float, free: tuple[FreeParameter, ...] = LINEAR) -> tuple[Floats, Floats]:
    """Lower ends, values and upper ends [REPEATS, 2, 3]; textbook half widths [REPEATS, 2]."""
    rng = np.random.default_rng(20)
    clean = np.array([c @ TRUTH for c in COLUMNS]) + np.array([[0.4], [-1.0], [2.0]])
    found, white = [], []
    for _ in range(REPEATS):
        fit = straight_fit(clean + noise(rng, memory), free)
        found.append([(e.lower, e.value, e.upper) for e in estimates(fit)])
        white.append(white_widths(fit.cost))
    return np.array(found), np.array(white)


@pytest.mark.parametrize("memory", [MEMORY, 0.0])
def test_intervals_hold_the_truth_as_often_as_they_promise(memory: float) -> None:
    """600 repeats: 95 % with a standard error of 0.9 %."""
    found, _ = repeats(memory)
    held = np.mean((found[..., 0] <= TRUTH) & (found[..., 2] >= TRUTH), axis=0)
    assert np.all((held >= 0.90) & (held <= 0.99)), held


def test_intervals_hold_the_truth_where_noise_of_an_input_lasts_for_a_run() -> None:
    """White noise of an input, summed up in the angle over a run, beside white noise of the encoder
    that hides its correlation from sample to sample.
    """
    rng = np.random.default_rng(21)
    clean = np.array([c @ TRUTH for c in COLUMNS])
    held = []
    for _ in range(REPEATS):
        drift = np.cumsum(0.03 * rng.standard_normal((RUNS, SAMPLES)), axis=1)
        fit = straight_fit(clean + drift + rng.standard_normal((RUNS, SAMPLES)), LINEAR)
        held.append([e.lower <= t <= e.upper for e, t in zip(estimates(fit), TRUTH, strict=True)])
    share = np.mean(held, axis=0)
    assert np.all((share >= 0.90) & (share <= 0.99)), share


def test_intervals_for_white_noise_would_be_far_too_narrow() -> None:
    """Noise that remembers counts (1 + MEMORY) / (1 - MEMORY) = 9 times in the variance."""
    found, white = repeats(MEMORY)
    held = np.mean(np.abs(found[..., 1] - TRUTH) <= white, axis=0)
    assert np.all(held < 0.6), held
    halves = (found[..., 2] - found[..., 0]) / 2
    assert np.median(halves / white, axis=0) == pytest.approx([3.0, 3.0], rel=0.25)


def test_widths_are_those_of_the_scatter() -> None:
    """A scatter over 600 repeats is good to 3 %, the median of widths to 2 %."""
    found, _ = repeats(MEMORY)
    halves = np.median(found[..., 2] - found[..., 0], axis=0) / 2
    assert halves / NORMAL == pytest.approx(found[..., 1].std(axis=0), rel=0.15)


def test_friction_that_is_not_there_has_an_interval_that_begins_at_zero() -> None:
    """Half of the fits end on the bound; of the others one in twenty may deny the truth."""
    found, _ = repeats(MEMORY, FRICTION)
    lower, value, upper = found[:, 1].T
    assert 0.35 < np.mean(value < 1e-6) < 0.65
    assert np.mean(lower > 0.0) <= 0.06
    assert np.all(lower[value < 1e-6] <= 0.0) and np.all(upper > 0.0)


def test_white_residuals_below_the_declared_noise_keep_the_declared_width() -> None:
    """A lucky sample does not narrow the interval: at least the declared noise counts."""
    rng = np.random.default_rng(3)
    clean = np.array([c @ TRUTH for c in COLUMNS])
    found = estimates(straight_fit(clean + 0.01 * rng.standard_normal(clean.shape), LINEAR))
    halves = np.array([(e.upper - e.lower) / 2 for e in found])
    sigma = np.sqrt(np.diag(np.linalg.inv(sum(c.T @ c for c in CENTRED))))
    assert np.all(halves >= NORMAL * sigma)
    assert np.all(halves < 2.1 * sigma)


def level(blocks: Floats) -> Estimate:
    """The estimate of a level of zero from residuals of one value per block of 40 samples."""
    residual = np.repeat(blocks, 40)
    free = (free_parameter("tau0", 1.0, -900.0, 900.0),)
    (found,) = estimates(
        finished([residual], [-np.ones((len(residual), 1))], None, free, {"tau0": 0.0})
    )
    return found


def test_twelve_blocks_give_a_students_interval_with_eleven_degrees_of_freedom() -> None:
    """Block means of +-5 about a level: 17 % wider than the normal interval of their mean square.

    A factor sqrt(12/11) is for the level that is fitted, the other is Student's quantile over the
    normal one. A single step remembers for so long that blocks are as long as they may be.
    """
    found = level(np.repeat([5.0, -5.0], 6))
    naive = NORMAL * 5.0 / np.sqrt(12.0)
    assert found.upper == pytest.approx(STUDENT_11 * 5.0 / np.sqrt(11.0), rel=1e-5)
    assert found.upper / naive == pytest.approx(1.173, abs=0.001)
    assert found.lower == pytest.approx(-found.upper)


def test_degrees_of_freedom_are_those_of_the_blocks_that_matter() -> None:
    """All alike: b - 1. One alone: 1. Two alike among idle ones, or any three that sum to zero,
    have a ratio of 6, which says 2; were they not centred, 6 - 2.
    """
    alike, alone, two = np.ones(30), np.zeros(30), np.zeros(30)
    alone[4], two[[4, 9]] = 7.0, [-3.0, 3.0]
    found = degrees_of_freedom(np.column_stack([alike, alone, two, 0.0 * alike]))
    assert found == pytest.approx([29.0, 1.0, 2.0, 1.0])
    assert degrees_of_freedom(two[:, None], centred=False) == pytest.approx([4.0])
    assert degrees_of_freedom(np.ones((1, 1))) == pytest.approx([1.0])


@pytest.mark.parametrize(("blocks", "least"), [(12, 0.87), (50, 0.9), (200, 0.9)])
def test_normal_shifts_have_nearly_as_many_degrees_as_blocks(blocks: int, least: float) -> None:
    """The estimate scatters about b - 1 by sqrt(24 / b) / 3 of it and is cut there: a few per cent
    less on average, for twelve a tenth.
    """
    shifts = np.random.default_rng(6).standard_normal((blocks, 2000))
    found = degrees_of_freedom(shifts - shifts.mean(axis=0))
    assert least < np.mean(found) / (blocks - 1) <= 1.0
    assert np.max(found) == blocks - 1


def one_run(
    by_parameter: Floats,
    free: tuple[FreeParameter, ...],
    values: dict[str, float],
    size: float = 1.0,
) -> Fit:
    """Ten seconds of white residuals with the Jacobian [k, nf] in search coordinates."""
    residual = size * np.random.default_rng(5).standard_normal(SAMPLES)
    return finished([residual], [by_parameter], [OFFSET], free, values)


def seen(fit: Fit) -> dict[str, bool]:
    return {e.name: e.identified for e in estimates(fit)}


J, B = free_parameter("J", 0.1, 1e-6, 10.0), free_parameter("b", 2.0, 0.0, 50.0)


def test_logarithmic_parameters_get_the_interval_of_their_logarithm() -> None:
    """Half width 1.96 sigma / |J| in the logarithm: a factor up and the same factor down."""
    wave = WAVE - WAVE.mean()
    fit = one_run(100.0 * wave[:, None], (J,), {"J": 0.12}, 0.1)
    (found,) = estimates(fit)
    assert found.value == 0.12
    assert found.upper / found.value == pytest.approx(found.value / found.lower, rel=1e-12)
    expected = NORMAL / (100.0 * np.linalg.norm(wave))
    assert np.log(found.upper / found.value) == pytest.approx(expected, rel=1e-5)
    assert found.identified
    assert not found.at_bound


def test_a_parameter_that_no_run_excites_is_not_identified() -> None:
    fit = one_run(np.column_stack([50 * WAVE, 0 * WAVE]), (J, B), {"J": 0.1, "b": 2.0})
    assert seen(fit) == {"J": True, "b": False}
    assert [e.has_interval for e in estimates(fit)] == [True, False]


def test_two_parameters_that_act_alike_are_not_identified() -> None:
    third = free_parameter("k", 5.0, -90.0, 90.0)
    columns = np.column_stack([50 * WAVE, 20 * WAVE, 30 * OTHER])
    fit = one_run(columns, (J, B, third), {"J": 0.1, "b": 2.0, "k": 5.0})
    assert seen(fit) == {"J": False, "b": False, "k": True}


def test_a_parameter_that_the_unknown_start_stands_in_for_is_not_identified() -> None:
    fit = one_run(np.column_stack([50 * WAVE, 80 * OFFSET[:, 0]]), (J, B), {"J": 0.1, "b": 2.0})
    assert seen(fit) == {"J": True, "b": False}


def test_a_weak_influence_is_not_identified_but_has_an_interval() -> None:
    """The derivative is so small that the interval exceeds the value itself."""
    free = (free_parameter("tau0", 0.5, -100.0, 100.0),)
    weak, strong = (one_run((c * WAVE)[:, None], free, {"tau0": 0.5}) for c in (0.02, 2.0))
    assert seen(weak) == {"tau0": False}
    assert [e.has_interval for e in estimates(weak)] == [True]
    (found,) = estimates(weak)
    assert found.lower < 0.0 < found.upper
    assert seen(strong) == {"tau0": True}


@pytest.mark.parametrize(
    ("value", "at_bound"), [(0.0, True), (1e-9, True), (0.1, False), (10.0, True), (9.9, False)]
)
def test_a_value_on_a_bound_says_so_and_its_interval_stays_inside(
    value: float, at_bound: bool
) -> None:
    fit = one_run(WAVE[:, None], (free_parameter("J", 0.1, 0.0, 10.0),), {"J": value})
    (found,) = estimates(fit)
    assert found.at_bound is at_bound
    assert 0.0 <= found.lower <= value <= found.upper <= 10.0


def test_a_periodic_parameter_is_reported_in_the_middle_turn() -> None:
    free = free_parameter("alpha", 0.5, -50.0, 50.0, period=2 * np.pi)
    (found,) = estimates(one_run(20 * WAVE[:, None], (free,), {"alpha": 2 * np.pi + 3.1}))
    assert found.value == pytest.approx(3.1)
    assert found.lower < 3.1 < found.upper
    (lost,) = estimates(one_run(np.zeros((SAMPLES, 1)), (free,), {"alpha": 1.0}))
    assert not lost.identified
    assert lost.upper - lost.lower == pytest.approx(2 * np.pi)


def test_without_free_parameters_there_is_nothing_to_tell() -> None:
    assert estimates(one_run(np.zeros((SAMPLES, 0)), (), {})) == ()


def test_projection_leaves_what_is_orthogonal_to_the_starts() -> None:
    rng = np.random.default_rng(8)
    jacobian, nuisance = rng.normal(size=(50, 3)), rng.normal(size=(50, 2))
    left = project_out(jacobian, nuisance)
    expected = jacobian - nuisance @ np.linalg.lstsq(nuisance, jacobian)[0]
    assert left == pytest.approx(expected, abs=1e-12)
    assert project_out(jacobian, np.zeros((50, 2))) == pytest.approx(jacobian)
    assert project_out(jacobian, nuisance[:, [0, 0]]) == pytest.approx(
        project_out(jacobian, nuisance[:, :1]), abs=1e-12
    )


@pytest.mark.parametrize("span", [2.0, 40.0])
def test_an_angle_that_stays_within_its_counts_tells_nothing(span: float) -> None:
    """Of two angles the first has 2 or 40 counts; `a` acts on it alone, `b` on the other alone."""
    rng = np.random.default_rng(4)
    residuals, columns = [], []
    for _ in range(RUNS):
        table = np.zeros((SAMPLES, 2, 2))
        table[:, 0, 0], table[:, 1, 1] = WAVE, OTHER
        columns.append(table.reshape(-1, 2))
        residuals.append(rng.standard_normal((SAMPLES, 2)))
    fit = finished(residuals, columns, free=LINEAR, values={"a": 2.0, "b": 0.5})
    measured = np.column_stack([span * 1e-3 * (TIME > 5.0), np.sin(TIME)])
    known = {"signals": ("theta_pan", "theta_tilt"), "counts": np.full(2, 1e-3)}
    runs = tuple(replace(run, measured=measured, **known) for run in fit.runs)
    on_pan, on_tilt = estimates(replace(fit, runs=runs))
    assert on_pan.identified == (span > 3.0)
    assert ((on_pan.lower, on_pan.upper) == (-50.0, 50.0)) == (span <= 3.0)
    assert on_tilt.identified
