"""Whole fits on runs of an independent simulator: known truths found, blind spots admitted."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance, evaluate
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters, run_counts
from ptp_symbolic.numeric.identify.intervals import estimates, with_finite_differences
from ptp_symbolic.numeric.identify.least_squares import Effort, Simulations
from tests.identify.pan_runs import (
    FINE_STEPS,
    FLOOR,
    GAP,
    KNOWN,
    MODEL,
    THREE,
    TRUTH,
    crawl,
    fitted,
    make_runs,
    seconds,
    sine,
    starts_off,
    unfree,
)
from tests.independent.pan_drive import PanDrive
from tests.independent.pan_logs import COUNT

FloatArray = NDArray[np.float64]


@pytest.fixture(scope="module", params=[10, 11])
def found(request: pytest.FixtureRequest) -> Fit:
    made = make_runs(PanDrive(), [profile() for profile in THREE], request.param)
    return fitted(made.runs, starts_off(TRUTH, request.param), unfree(TRUTH))


def test_seven_truths_lie_within_their_intervals(found: Fit) -> None:
    """From starts off by 30 to 50 %; the bound is three half widths, most lie within one."""
    told = {e.name: e for e in estimates(found)}
    off = np.array(
        [(told[n].value - v) / (told[n].upper - told[n].lower) * 2 for n, v in TRUTH.items()]
    )
    assert np.all(np.abs(off) < 3.0), off
    assert np.mean(np.abs(off) < 1.0) > 0.5
    assert all(e.identified and not e.at_bound for e in told.values())


@pytest.mark.long
def test_intervals_are_as_wide_as_values_scatter_from_one_noise_to_the_next() -> None:
    """Over 16 seeds, seven parameters each: the truth lies within 95 % intervals as often as it
    should for 112 of them (at least 95 are expected in 99.9 % of cases where 95 % is right, as the
    seven of one fit go together by threes), and their widths are those of the scatter.
    """
    ratios, inside = [], []
    for seed in range(20, 36):
        made = make_runs(PanDrive(), [profile() for profile in THREE], seed)
        told = {
            e.name: e for e in estimates(fitted(made.runs, starts_off(TRUTH, seed), unfree(TRUTH)))
        }
        inside.append([told[n].lower <= v <= told[n].upper for n, v in TRUTH.items()])
        ratios.append(
            [(told[n].value / v, told[n].upper - told[n].lower) for n, v in TRUTH.items()]
        )
    scatter = 1.96 * np.std(np.array(ratios)[:, :, 0], axis=0, ddof=1) * list(TRUTH.values())
    half_widths = 0.5 * np.median(np.array(ratios)[:, :, 1], axis=0)
    assert np.sum(inside) >= 95
    assert 0.8 < stats.gmean(half_widths / scatter) < 2.0


def test_only_rounding_and_noise_are_left(found: Fit) -> None:
    assert found.rms_counts() == pytest.approx(FLOOR, rel=0.15)
    for run, e in found.pairs():
        counts = run_counts(run, e)
        assert 0.2 < np.sqrt(np.mean(counts**2)) < 1.1 * FLOOR
        assert np.max(np.abs(counts)) < 1.5
        current = e.residual.reshape(run.measured.shape)[:, 0]
        assert np.sqrt(np.mean(current**2)) == pytest.approx(1.0, rel=0.1)


def test_threads_change_nothing() -> None:
    made = make_runs(PanDrive(), [crawl()[:600], sine()[:300]], 5)
    free = starts_off({"F_c_pan": 0.24, "F_v_pan": 14.0}, 5)
    fixed = {**KNOWN, **TRUTH}
    alone = fit_parameters(MODEL, made.runs, free, fixed)
    with ThreadPoolExecutor(2) as executor:
        together = fit_parameters(MODEL, made.runs, free, fixed, executor=executor)
    assert together.values == alone.values
    assert together.cost == alone.cost


def test_the_end_of_an_earlier_fit_is_not_simulated_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A fit goes on to the same values with one simulation of every run less; from other starts of
    the runs, or with another tolerance, it simulates all.
    """
    made = make_runs(PanDrive(), [crawl()[:600], sine()[:300]], 5)
    free = starts_off({"F_c_pan": 0.24, "F_v_pan": 14.0}, 5)
    fixed, rough = {**KNOWN, **TRUTH}, Effort(2)
    first = fit_parameters(MODEL, made.runs, free, fixed, None, rough)
    there = [replace(f, start=first.values[f.name], scale=2.0 * f.scale) for f in free]
    simulated: list[int] = []

    def counted(self: Simulations, *arguments: Any) -> list[Evaluation]:
        simulated.append(1)
        return whole(self, *arguments)

    whole = Simulations.evaluate
    monkeypatch.setattr(Simulations, "evaluate", counted)

    def count(z: Sequence[FloatArray], effort: Effort, earlier: Fit | None) -> tuple[Fit, int]:
        simulated.clear()
        fit = fit_parameters(MODEL, made.runs, there, fixed, z, effort, earlier=earlier)
        return fit, len(simulated)

    afresh, evaluations = count(first.z, rough, None)
    continued, fewer = count(first.z, rough, first)
    assert fewer == evaluations - 1
    assert continued.values == pytest.approx(afresh.values, rel=1e-9)
    assert continued.cost == pytest.approx(afresh.cost, rel=1e-9)
    other = [z + 1e-6 for z in first.z]
    assert count(other, rough, first)[1] == count(other, rough, None)[1]
    sharp = Effort(2, tolerance=Tolerance(1e-6, 1e-8))
    assert count(first.z, sharp, first)[1] == count(first.z, sharp, None)[1]


def test_starts_of_runs_are_found_when_only_they_are_asked_for() -> None:
    """To half a count, as rounding does not average out at rest; that is 0.034 of the place."""
    made = make_runs(PanDrive(), [profile() for profile in THREE], 12)
    judged = fit_parameters(MODEL, made.runs, (), {**KNOWN, **TRUTH}, None, FINE_STEPS)
    assert judged.free == ()
    assert judged.rms_counts() == pytest.approx(FLOOR, rel=0.15)
    for run, z, angle, place in zip(judged.runs, judged.z, made.angles, made.places, strict=True):
        unknowns = dict(zip([u.name for u in run.unknowns], z, strict=True))
        assert set(unknowns) == {"theta_pan", "gap_place_0"}
        assert unknowns["gap_place_0"] == pytest.approx(place, abs=0.5 * COUNT / (GAP / 2))
        at = run.start[MODEL.state_names.index("theta_pan")] + unknowns["theta_pan"]
        assert at == pytest.approx(angle, abs=0.5 * COUNT)


def test_tied_parameters_move_together() -> None:
    """A machine without Stribeck effect, declared so: one number for breakaway and sliding.

    It comes out a little high: noise of the logged voltage, 0.02 N m, breaks the model away early.
    """
    made = make_runs(PanDrive(F_s_forward=0.24, F_s_backward=0.24), [crawl(), sine()], 3)
    free = (free_parameter("F_c_pan", 0.35, 0.0, 20.0, None, ("F_s_pan",)),)
    fit = fitted(made.runs, free, {**KNOWN, **TRUTH})
    assert fit.values["F_s_pan"] == fit.values["F_c_pan"]
    assert fit.values["F_c_pan"] == pytest.approx(0.24, rel=0.05)
    (told,) = estimates(fit)
    assert told.identified


def test_standstill_identifies_nothing() -> None:
    """Below breakaway the machine does not move: the data say nothing about its inertia."""
    made = make_runs(PanDrive(), [np.full(200, 0.05)], 4)
    free = (free_parameter("J_pan", 0.14, 0.0, 100.0), free_parameter("F_v_pan", 10.0, 0.0, 100.0))
    fit = fit_parameters(MODEL, made.runs, free, {**KNOWN, **TRUTH})
    assert fit.failed is None
    assert [e.identified for e in estimates(fit)] == [False, False]


def test_a_gap_that_is_crossed_once_hides_behind_the_unknown_start() -> None:
    """One way only: a wider gap and a start further back look alike. Turning back tells them."""
    t = seconds(4.0)
    one_way, there_and_back = 5.0 * np.minimum(t, 2.0), 10.0 * np.sin(np.pi * t / 2.0)
    free = (free_parameter("gap_pan", 1.1 * GAP, 0.0, 1.0),)
    told = []
    for voltage in (one_way, there_and_back):
        made = make_runs(PanDrive(), [voltage], 6)
        (estimate,) = estimates(fitted(made.runs, free, unfree({"gap_pan": GAP}) | TRUTH))
        told.append(estimate)
    assert [e.identified for e in told] == [False, True]
    assert told[1].value == pytest.approx(GAP, rel=0.01)


@pytest.mark.parametrize("z", [np.array([1e-4, 0.3]), np.array([-2e-4, -0.6])])
def test_derivatives_by_start_and_gap_are_those_of_differences(z: np.ndarray) -> None:
    """The place in the gap moves with its width, and so do the derivatives by both."""
    made = make_runs(PanDrive(), [sine()[:100]], 7)
    run, names = made.runs[0], list(MODEL.parameter_names)
    columns = np.array([names.index("gap_pan"), names.index("F_v_pan")])
    tight = Tolerance(1e-9, 1e-11)

    def residual(change: np.ndarray, start: np.ndarray) -> np.ndarray:
        p = MODEL.parameter_vector({**KNOWN, **TRUTH})
        p[columns] += change
        return evaluate(MODEL, run, p, start, columns, False, tight).residual

    p = MODEL.parameter_vector({**KNOWN, **TRUTH})
    e = evaluate(MODEL, run, p, z, columns, True, tight)
    for index, h in enumerate([1e-6, 1e-4]):
        step = h * np.eye(2)[index]
        slope = (residual(step, z) - residual(-step, z)) / (2 * h)
        assert e.by_parameter[:, index] == pytest.approx(slope, abs=2e-3 * np.max(np.abs(slope)))
    for index, h in enumerate([1e-7, 1e-5]):
        step = h * np.eye(2)[index]
        slope = (residual(np.zeros(2), z + step) - residual(np.zeros(2), z - step)) / (2 * h)
        assert e.by_start[:, index] == pytest.approx(slope, abs=2e-3 * np.max(np.abs(slope)))


def test_a_parameter_without_influence_is_not_seen_through_coarse_simulations() -> None:
    """Without a Stribeck effect nothing depends on its rate: differences at the tolerance of the
    fit say so, those of a coarse simulation against a fine one would not.
    """
    made = make_runs(PanDrive(F_s_forward=0.24, F_s_backward=0.24), [sine()[:400]], 6)
    free = starts_off({"F_v_pan": 14.0, "v_s_pan": 0.02}, 6)
    fixed = {**KNOWN, **TRUTH, "F_c_pan": 0.24, "F_s_pan": 0.24}
    coarse = Effort(2, tolerance=Tolerance(1e-3, 1e-5))
    fit = with_finite_differences(fit_parameters(MODEL, made.runs, free, fixed, None, coarse))
    viscous, stribeck = (np.linalg.norm(fit.evaluations[0].by_parameter, axis=0)).tolist()
    assert viscous > 1.0
    assert stribeck < 1e-6 * viscous


def test_the_tolerance_follows_the_resolution_of_the_encoder() -> None:
    """A count of 20 bits is a hundred and forty times finer than one of 7200 per turn."""
    usual = Tolerance.for_resolution(COUNT / np.sqrt(12.0), 0.01)
    fine = Tolerance.for_resolution(2.0 * np.pi / 2**20 / np.sqrt(12.0), 0.01)
    assert (usual.relative, usual.angle) == pytest.approx((1e-4, 1e-6), rel=1e-9)
    assert usual.angle / fine.angle == pytest.approx(2**20 / 7200, rel=1e-9)
