"""Derivatives of a staircase: the treads mislead, a difference over a finite step does not."""

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.constants import STEP
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.least_squares import Problem, Secants, minimise
from tests.identify.curves import Floats, evaluation

TREAD, TARGET, ROWS = 0.01, np.array([0.7357, 0.3333]), 400
WAVE = np.cos(np.linspace(0.0, 7.0, ROWS))
FAR = np.array([9.0, 9.0])


def stair(value: float) -> Floats:
    """A residual that moves in steps of TREAD, as by a breakaway one sample later or earlier."""
    return np.full(ROWS, TREAD * np.floor(value / TREAD))


def residual(run: int, phi: Floats, z: Floats) -> Floats:
    """Run 0 sees both parameters, the first through a staircase; run 1 the second alone."""
    smooth = (phi[1] - TARGET[1]) * WAVE
    if run == 1:
        return smooth
    return stair(phi[0]) - stair(TARGET[0]) + smooth


def evaluate(phi: Floats) -> list[Evaluation]:
    """Runs with derivatives at the point: those of a tread are zero."""
    jacobian = np.column_stack([np.zeros(ROWS), WAVE])
    return [
        evaluation(residual(r, phi, np.zeros(0)), jacobian, np.zeros((ROWS, 0))) for r in (0, 1)
    ]


NO_STARTS = [np.zeros(0), np.zeros(0)]


def test_the_difference_replaces_what_misleads_from_the_second_call_on() -> None:
    refine = Secants(residual, FAR)
    refine(np.array([0.5, 0.6]), NO_STARTS, evaluate(np.array([0.5, 0.6])))
    phi = np.array([0.6049, 0.5])
    before = evaluate(phi)
    marked = before[0].by_parameter.copy()
    marked[:, 1] *= 1.07  # as no difference would reproduce
    before[0] = evaluation(before[0].residual, marked, before[0].by_start)
    after = refine(phi, NO_STARTS, before)
    moved = stair(phi[0] + STEP) - stair(phi[0])
    assert after[0].by_parameter[:, 0] == pytest.approx(moved / STEP)
    assert np.array_equal(after[0].by_parameter[:, 1], marked[:, 1])
    assert np.array_equal(after[1].by_parameter, before[1].by_parameter)
    assert np.array_equal(after[0].residual, before[0].residual)


def test_the_first_call_compares_every_column_and_returns_the_differences() -> None:
    phi = np.array([0.6049, 0.5])
    asked = []

    def counted(run: int, moved: Floats, z: Floats) -> Floats:
        asked.append((run, tuple(np.flatnonzero(moved != phi))))
        return residual(run, moved, z)

    refine = Secants(counted, FAR)
    after = refine(phi, NO_STARTS, evaluate(phi))
    assert sorted(asked) == [(0, (0,)), (0, (1,)), (1, (0,)), (1, (1,))]
    assert after[1].by_parameter[:, 1] == pytest.approx(WAVE, abs=1e-12)
    assert np.all(after[1].by_parameter[:, 0] == 0.0)
    asked.clear()
    refine(phi, NO_STARTS, evaluate(phi))
    assert asked == [(0, (0,))]


@pytest.mark.parametrize(("error", "replaced"), [(0.2, False), (0.3, True)])
def test_a_derivative_misleads_when_it_is_wrong_by_more_than_a_quarter(
    error: float, replaced: bool
) -> None:
    phi = np.array([0.4])

    def line(run: int, moved: Floats, z: Floats) -> Floats:
        return 3.0 * moved[0] * np.ones(5)

    runs = [evaluation(line(0, phi, phi), np.full((5, 1), 3.0 * (1 + error)), np.zeros((5, 0)))]
    refine = Secants(line, FAR[:1])
    refine(phi, NO_STARTS[:1], runs)
    second = refine(phi, NO_STARTS[:1], runs)
    expected = 3.0 if replaced else 3.0 * (1 + error)
    assert second[0].by_parameter[:, 0] == pytest.approx(np.full(5, expected))


def test_at_the_upper_bound_the_step_goes_down() -> None:
    phi = np.array([1.0])
    asked = []

    def cube(run: int, moved: Floats, z: Floats) -> Floats:
        asked.append(moved[0])
        return np.array([moved[0] ** 3])

    runs = [evaluation(np.ones(1), np.zeros((1, 1)), np.zeros((1, 0)))]
    (after,) = Secants(cube, np.array([1.01]))(phi, NO_STARTS[:1], runs)
    assert asked == [pytest.approx(1.0 - STEP)]
    assert after.by_parameter[0, 0] == pytest.approx((1.0 - (1.0 - STEP) ** 3) / STEP)


@pytest.mark.parametrize("after", [None, np.array([1.0, 1e200, 1.0]), np.array([1.0, 1.0, np.nan])])
def test_where_the_shifted_simulation_fails_or_flies_off_the_derivative_stays(
    after: Floats | None,
) -> None:
    runs = [evaluation(np.ones(3), np.full((3, 1), 2.0), np.zeros((3, 0)))]
    refine = Secants(lambda run, phi, z: after, FAR[:1])
    for _ in range(2):
        (after,) = refine(np.array([0.5]), NO_STARTS[:1], runs)
        assert np.all(after.by_parameter == 2.0)


def test_a_search_climbs_down_the_staircase_only_with_differences() -> None:
    bounds = np.array([-9.0, -9.0]), FAR
    problem = Problem(
        lambda phi, z, tangents: evaluate(phi),
        *bounds,
        *[NO_STARTS] * 3,
        np.zeros(2),
        np.zeros(2),
    )
    mended = Problem(**{**vars(problem), "refine": Secants(residual, FAR)})
    begin = np.array([0.3, 0.9])
    without = minimise(problem, begin, NO_STARTS)
    assert without.phi[0] == begin[0]
    found = minimise(mended, begin, NO_STARTS)
    assert abs(found.phi[0] - TARGET[0]) < TREAD
    assert found.phi[1] == pytest.approx(TARGET[1], abs=1e-3)
