"""95 % intervals: how often they hold the truth, and what they say where the data are silent."""

import numpy as np
import pytest
from scipy.signal import lfilter

import ptp_symbolic
from ptp_symbolic.identify.coordinates import FreeParameter, free_parameter
from ptp_symbolic.identify.fit import Fit
from ptp_symbolic.identify.intervals import estimates, project_out
from ptp_symbolic.identify.run import Run
from ptp_symbolic.simulation.inputs import constant, stack
from tests.identify.curves import Floats, evaluation

RUNS, SECONDS, RATE = 4, 15, 50
TRUTH = np.array([2.0, -0.7])
MEMORY, SIZE = 0.8, 3.0  # correlation from sample to sample; rms over the believed noise
REPEATS = 400


def run_of(time: Floats) -> Run:
    """A run with one analog signal; only its times and sizes matter here."""
    k = len(time)
    return Run(
        "run", time, stack([constant(0.0)]), np.zeros((k, 1)), np.zeros((k, 1)),
        np.zeros(1, dtype=np.int64), np.ones(1), np.full(1, np.nan), ("y",), np.zeros(0), (),
    )  # fmt: skip


TIME = np.arange(SECONDS * RATE) / RATE
MODEL = ptp_symbolic.load("ideal")  # never asked for anything by intervals


def slow_wave(seed: int) -> Floats:
    """A regressor [k] that changes over seconds, as parameters of machines act."""
    phases = np.random.default_rng(seed).uniform(0.0, 6.0, 3)
    return np.sin(2 * np.pi * np.outer(TIME, [0.11, 0.29, 0.43]) + phases).sum(axis=1)


WAVE, OTHER = slow_wave(100), slow_wave(101)
COLUMNS = [np.column_stack([slow_wave(r), slow_wave(RUNS + r)]) for r in range(RUNS)]
OFFSET = np.ones((len(TIME), 1))  # the unknown start of every run


def noise(rng: np.random.Generator) -> Floats:
    """Noise [runs, k] of rms SIZE whose samples remember one another."""
    white = SIZE * np.sqrt(1 - MEMORY**2) * rng.standard_normal((RUNS, len(TIME) + 100))
    return lfilter([1.0], [1.0, -MEMORY], white)[:, 100:]


def straight_fit(measured: Floats, free: tuple[FreeParameter, ...]) -> Fit:
    """Least squares of a straight model, all at once, as a Fit of linear parameters."""
    blocks = [np.kron(np.eye(RUNS)[r][None], OFFSET) for r in range(RUNS)]
    whole = np.vstack([np.hstack([c, b]) for c, b in zip(COLUMNS, blocks, strict=True)])
    found = np.linalg.lstsq(whole, measured.ravel())[0]
    residual = (measured.ravel() - whole @ found).reshape(measured.shape)
    scales = np.array([f.scale for f in free])
    ends = tuple(
        evaluation(r, -c * scales, -OFFSET) for r, c in zip(residual, COLUMNS, strict=True)
    )
    values = {f.name: float(v) for f, v in zip(free, found, strict=False)}
    runs = tuple(run_of(TIME) for _ in range(RUNS))
    return Fit(MODEL, runs, free, values, tuple(found[2:, None]), float(np.sum(residual**2)), ends)


LINEAR = (free_parameter("a", 1.0, -50.0, 50.0), free_parameter("b", -0.3, -50.0, 50.0))


@pytest.fixture(scope="module")
def repeats() -> tuple[Floats, Floats, Floats]:
    """Values, half widths, and half widths if noise were white, each [REPEATS, 2]."""
    rng = np.random.default_rng(20)
    clean = np.array([c @ TRUTH for c in COLUMNS]) + np.array([[0.4], [-1.0], [0.0], [2.0]])
    centred = [c - c.mean(axis=0) for c in COLUMNS]
    inverse = np.linalg.inv(sum(c.T @ c for c in centred))
    values, halves, white = [], [], []
    for _ in range(REPEATS):
        fit = straight_fit(clean + noise(rng), LINEAR)
        found = estimates(fit)
        values.append([e.value for e in found])
        halves.append([(e.upper - e.lower) / 2 for e in found])
        freedom = RUNS * len(TIME) - 2 - RUNS
        white.append(1.96 * np.sqrt(fit.cost / freedom * np.diag(inverse)))
    return np.array(values), np.array(halves), np.array(white)


def test_intervals_hold_the_truth_as_often_as_they_promise(repeats) -> None:
    """Four hundred repeats: 95 % with a standard error of 1.1 %."""
    values, halves, _ = repeats
    coverage = np.mean(np.abs(values - TRUTH) <= halves, axis=0)
    assert np.all((coverage > 0.89) & (coverage < 0.985)), coverage


def test_intervals_for_white_noise_would_be_far_too_narrow(repeats) -> None:
    """Noise that remembers counts (1 + MEMORY) / (1 - MEMORY) = 9 times in the variance."""
    values, halves, white = repeats
    coverage = np.mean(np.abs(values - TRUTH) <= white, axis=0)
    assert np.all(coverage < 0.6), coverage
    assert np.median(halves / white, axis=0) == pytest.approx([3.0, 3.0], rel=0.25)


def test_widths_are_those_of_the_scatter(repeats) -> None:
    values, halves, _ = repeats
    assert np.median(halves, axis=0) / 1.96 == pytest.approx(values.std(axis=0), rel=0.15)


def test_white_residuals_below_the_declared_noise_keep_the_declared_width() -> None:
    """A lucky sample does not narrow the interval: at least the declared noise counts."""
    rng = np.random.default_rng(3)
    clean = np.array([c @ TRUTH for c in COLUMNS])
    found = estimates(straight_fit(clean + 0.01 * rng.standard_normal(clean.shape), LINEAR))
    centred = [c - c.mean(axis=0) for c in COLUMNS]
    sigma = np.sqrt(np.diag(np.linalg.inv(sum(c.T @ c for c in centred))))
    halves = np.array([(e.upper - e.lower) / 2 for e in found])
    assert np.all(halves >= 1.96 * sigma)
    assert np.all(halves < 2.1 * sigma)


def one_run(by_parameter: Floats, free: tuple[FreeParameter, ...], values: dict[str, float]) -> Fit:
    """Fifteen seconds of white residuals with the Jacobian [k, nf] in search coordinates."""
    residual = np.random.default_rng(5).standard_normal(len(TIME))
    e = evaluation(residual, by_parameter, OFFSET)
    cost = float(residual @ residual)
    return Fit(MODEL, (run_of(TIME),), free, values, (np.zeros(1),), cost, (e,))


def seen(fit: Fit) -> dict[str, bool]:
    return {e.name: e.identified for e in estimates(fit)}


J, B = free_parameter("J", 0.1, 0.0, 10.0), free_parameter("b", 2.0, 0.0, 50.0)


def test_logarithmic_parameters_get_the_interval_of_their_logarithm() -> None:
    """Half width 1.96 sigma / |J| in the logarithm: a factor up and the same factor down."""
    wave = WAVE - WAVE.mean()
    fit = one_run(100.0 * wave[:, None], (J,), {"J": 0.12})
    (found,) = estimates(fit)
    assert found.value == 0.12
    assert found.upper / found.value == pytest.approx(found.value / found.lower, rel=1e-12)
    expected = 1.96 / (100.0 * np.linalg.norm(wave))
    assert np.log(found.upper / found.value) == pytest.approx(expected, rel=0.6)
    assert np.log(found.upper / found.value) > expected
    assert found.identified
    assert not found.at_bound


def test_a_parameter_that_no_run_excites_is_not_identified() -> None:
    fit = one_run(np.column_stack([50 * WAVE, 0 * WAVE]), (J, B), {"J": 0.1, "b": 2.0})
    assert seen(fit) == {"J": True, "b": False}


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
    (lost,) = estimates(one_run(np.zeros((len(TIME), 1)), (free,), {"alpha": 1.0}))
    assert not lost.identified
    assert lost.upper - lost.lower == pytest.approx(2 * np.pi)


def test_without_free_parameters_there_is_nothing_to_tell() -> None:
    assert estimates(one_run(np.zeros((len(TIME), 0)), (), {})) == ()


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
