"""What the noise of inputs does to fits and to runs that are predicted: closed forms of a free axis
that integrates its torque twice.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.gain import left_by_best_values
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, free_parameter
from ptp_symbolic.numeric.identify.evaluate import evaluate
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters
from ptp_symbolic.numeric.identify.intervals import (
    chance_of_zero,
    covariance_of,
    estimates,
    project_out,
)
from ptp_symbolic.numeric.identify.least_squares import Effort
from ptp_symbolic.numeric.identify.run import with_inputs
from ptp_symbolic.numeric.identify.windows import estimable, with_input_noise
from ptp_symbolic.numeric.simulation.inputs import constant, stack, table
from tests.identify.curves import Floats
from tests.identify.straight import finished
from tests.identify.test_windows import COUNT, FREE, INERTIA, MODEL, run_of

SIGMA = COUNT / math.sqrt(12.0)  # rad, of rounding
TORQUE = 0.004  # N m
TIME = 0.01 * np.arange(301)
INERTIA_FREE = free_parameter("J_pan", 0.02, 1e-4, 1.0)
LINE = np.column_stack([np.ones_like(TIME), TIME])


def accelerated(runs: int, inertia: float = INERTIA) -> Fit:
    """Runs of an axis of `inertia` in kg m^2 under constant torque, fitted."""
    angle = 0.1 * TIME + 0.5 * TORQUE / inertia * TIME**2
    every = [run_of(angle, 0.0 * TIME, np.full(len(TIME), TORQUE), 0.01) for _ in range(runs)]
    fixed = {**MODEL.defaults, **{n: v for n, v in FREE.items() if n != "J_pan"}}
    return fit_parameters(MODEL, every, (INERTIA_FREE,), fixed, None, Effort(20))


def drifts(noise: float, draws: int) -> Floats:
    """Angles [k, draws] in rad that torque noise makes, held from sample to sample, without what a
    start can take up.
    """
    by_input_noise = np.random.default_rng(3).standard_normal((len(TIME), draws)) * noise / INERTIA
    rate = 0.01 * np.cumsum(by_input_noise, axis=0)
    angle = np.zeros_like(rate)
    angle[1:] = np.cumsum(0.01 * (rate[:-1] - 0.5 * 0.01 * by_input_noise[:-1]), axis=0)
    return project_out(angle, LINE)


def test_replays_change_the_residual_as_noise_of_the_input_does() -> None:
    fit = with_input_noise(accelerated(3), (0.002, 0.0))
    assert [c.shape for c in fit.by_input_noise] == [(2 * len(TIME), 34)] * 3
    pan = np.concatenate([c[0::2] for c in fit.by_input_noise], axis=1)
    expected = np.sqrt(np.mean(drifts(0.002, 4000) ** 2)) / SIGMA
    assert np.sqrt(np.mean(pan**2)) == pytest.approx(expected, rel=0.2)
    assert all(np.max(np.abs(c[1::2])) < 1e-9 for c in fit.by_input_noise)


def test_silent_inputs_leave_a_fit_as_it_is() -> None:
    fit = accelerated(1)
    assert with_input_noise(fit, (0.0, 0.0)) is fit


def test_inputs_that_change_between_samples_are_no_noise() -> None:
    """A torque on a clock of its own, half a sample late, next to silent: replays hold it from
    sample to sample, which moves the angle by counts.
    """
    fit = accelerated(1)
    (run,), none = fit.runs, np.zeros(0, dtype=np.int64)
    torque = 10.0 * TORQUE * np.sin(40.0 * TIME)
    late = replace(
        run,
        inputs=stack([table(TIME + 0.005, torque), constant(0.0)]),
        held_inputs=np.column_stack([torque, 0.0 * torque]),
    )
    p = MODEL.parameter_vector(dict(fit.values))
    own, held = (
        evaluate(MODEL, r, p, fit.z[0], none, True, fit.tolerance)
        for r in (late, with_inputs(late, late.held_inputs))
    )
    assert np.max(np.abs(own.residual - held.residual)) > 0.5
    by_input_noise = with_input_noise(
        replace(fit, runs=(late,), evaluations=(own,)), (1e-9, 0.0)
    ).by_input_noise
    assert np.max(np.abs(by_input_noise[0])) < 1e-3


def test_an_interval_is_as_wide_as_noise_of_the_input_makes_it() -> None:
    """The shift of the inertia by a drift is that of a line through the parabola it makes."""
    known = estimable(accelerated(3), (0.002, 0.0))
    (told,) = estimates(known)
    bend = project_out(0.5 * TORQUE / INERTIA**2 * TIME[:, None] ** 2, LINE)[:, 0]
    shift = bend @ drifts(0.002, 4000) / (bend @ bend)
    half = 1.96 * np.std(shift) / math.sqrt(3.0)
    assert (told.upper - told.lower) / 2.0 == pytest.approx(half, rel=0.25)
    (narrow,) = estimates(replace(known, by_input_noise=()))
    assert narrow.upper - narrow.lower < 0.5 * (told.upper - told.lower)


@pytest.mark.parametrize("off", [0.5, 3.0])
def test_runs_may_be_off_by_what_the_training_runs_allow_the_values(off: float) -> None:
    """An inertia that is `off` by that many reaches of its 99 % region (chi squared with one degree
    of freedom: 6.63) bends the predicted angle: of a parabola over T a line leaves T^2 / (6 sqrt 5)
    rms. What the region does not hold stays.
    """
    known = estimable(accelerated(3), (0.0003, 0.0))
    covariance, degrees, _ = covariance_of(known)
    assert np.isinf(degrees).all()
    (told,) = estimates(known)
    relative = math.log(told.upper / told.value) / 1.95996
    assert relative == pytest.approx(math.sqrt(covariance[0, 0]), rel=1e-3)
    reach = math.sqrt(6.635) * relative
    after = accelerated(1, math.exp(off * reach) * known.values["J_pan"])
    after = fit_parameters(MODEL, after.runs, (), dict(known.values), None, Effort(20))
    bend = 0.5 * TORQUE / known.values["J_pan"] * TIME[-1] ** 2 / (6.0 * math.sqrt(5.0))
    rms = bend * reach * after.runs[0].weight[0]
    found = left_by_best_values(after, known, np.ones(2))
    assert left_by_best_values(after, known, np.full(2, 4.0)) == pytest.approx(found)
    expected = (max(off - 1.0, 0.0) * rms) ** 2 + 1.0  # and the rounding of the angle
    assert found[0, 0] == pytest.approx(expected, rel=0.1)
    assert found[0, 1] == pytest.approx(0.0, abs=1e-9)


def test_one_run_that_is_far_off_does_not_draw_the_values_to_it() -> None:
    """Six runs ask for an inertia at four fifths of the reach, one for one far off on the other
    side; the mean of all would leave 3.2 times the square of the reach in the six.
    """
    known = estimable(accelerated(3), (0.0003, 0.0))
    covariance, _, _ = covariance_of(known)
    reach = math.sqrt(6.635 * covariance[0, 0])
    inertia = known.values["J_pan"]
    runs = accelerated(6, math.exp(0.8 * reach) * inertia).runs
    runs += accelerated(1, math.exp(-15.0 * reach) * inertia).runs
    after = fit_parameters(MODEL, runs, (), dict(known.values), None, Effort(20))
    bend = 0.5 * TORQUE / inertia * TIME[-1] ** 2 / (6.0 * math.sqrt(5.0))
    rms = bend * reach * runs[0].weight[0]
    found = left_by_best_values(after, known, np.ones(2))
    assert np.all(found[:6, 0] < 1.0 + rms**2)
    assert found[6, 0] > (14.0 * rms) ** 2


def test_values_do_not_take_up_what_has_another_form() -> None:
    """A wave that turns eight times is no parabola, however little the inertia is known: errors of
    it as large as the region allows would be more than the wave.
    """
    known = estimable(accelerated(3), (0.02, 0.0))
    wave = 10.0 * SIGMA * np.sin(16.0 * np.pi * TIME / TIME[-1])
    after = accelerated(1)
    (run,) = after.runs
    measured = run.measured + np.column_stack([wave, 0.0 * wave])
    runs = (replace(run, measured=measured),)
    by_input_noise = fit_parameters(MODEL, runs, (), dict(known.values), None, Effort(20))
    plain = left_by_best_values(by_input_noise, replace(known, free=()), np.ones(2))
    found = left_by_best_values(by_input_noise, known, np.ones(2))
    assert found[0, 0] == pytest.approx(plain[0, 0], rel=0.05)
    reach = math.sqrt(6.635 * covariance_of(known)[0][0, 0])
    bend = 0.5 * TORQUE / INERTIA * TIME[-1] ** 2 / (6.0 * math.sqrt(5.0))
    assert (bend * reach * run.weight[0]) ** 2 > 4.0 * plain[0, 0]


WINDOWS, SAMPLES = 4, 300
FOUR = tuple(free_parameter(f"p{k}", 1.0, -1e3, 1e3) for k in range(4))


def twice_integrated(rng: np.random.Generator, draws: int) -> Floats:
    return np.cumsum(np.cumsum(rng.standard_normal((draws, SAMPLES)), axis=1), axis=1).T / 300.0


def windows(rng: np.random.Generator, replays: int, free: tuple[FreeParameter, ...]) -> Fit:
    """A least squares fit of what smooth inputs make, integrated twice, to windows that noise of
    the input bends; the truth is zero.
    """
    t = np.linspace(0.0, 1.0, SAMPLES)
    start = np.column_stack([np.ones(SAMPLES), t])
    tables = [
        np.column_stack([np.sin((2.0 + k + 0.7 * w) * t + k) for k in range(4)]) * 10.0
        for w in range(WINDOWS)
    ]
    noise = [twice_integrated(rng, 1)[:, 0] + rng.standard_normal(SAMPLES) for _ in tables]
    bent = [project_out(n[:, None], start)[:, 0] for n in noise]
    columns = [project_out(c, start) for c in tables]
    found = np.linalg.lstsq(np.vstack(columns), np.concatenate(bent))[0]
    scales = np.array([f.scale for f in free])
    fit = finished(
        [b - c @ found for b, c in zip(bent, columns, strict=True)],
        [-c * scales for c in tables],
        [start] * WINDOWS,
        free,
        {f.name: float(v) for f, v in zip(free, found, strict=True)},
    )
    by_input_noise = [project_out(twice_integrated(rng, replays), start) for _ in tables]
    return replace(fit, by_input_noise=tuple(by_input_noise))


def test_a_few_windows_that_noise_bends_have_intervals_that_hold_the_truth() -> None:
    """Four parameters and eight starts follow most of what the noise of the input leaves in four
    windows, so that the residual tells too little of it.
    """
    rng = np.random.default_rng(5)
    held, without = [], []
    for _ in range(200):
        fit = windows(rng, 25, FOUR)
        held.append([e.lower <= 0.0 <= e.upper for e in estimates(fit)])
        without.append(
            [e.lower <= 0.0 <= e.upper for e in estimates(replace(fit, by_input_noise=()))]
        )
    assert np.mean(without) < 0.92
    assert 0.90 <= np.mean(held) <= 0.99


def test_a_chance_has_no_degrees_of_freedom_where_replays_tell_it() -> None:
    """Of those are as many as one likes: what is far from zero is so all the same."""
    rng, zero = np.random.default_rng(7), {f.name: 0.0 for f in FOUR}
    chance = [chance_of_zero(windows(rng, 25, FOUR), zero) for _ in range(50)]
    assert np.all(np.isfinite(chance))
    assert np.median(chance) > 0.1
    far = {name: -10.0 for name in zero}
    assert chance_of_zero(windows(rng, 25, FOUR), far) < 1e-6
