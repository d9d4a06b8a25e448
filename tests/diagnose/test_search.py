"""The second road of the search: effects alone; on logs whose motion is known in closed form."""

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, fitted
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.noise_floor import propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import declared_from, fit_declared, taken_over
from ptp_symbolic.numeric.diagnose.search import by_effects_alone, extended
from ptp_symbolic.numeric.diagnose.stepwise import StepwiseSearch, best_of_each_set, simplified
from ptp_symbolic.numeric.identify.constants import MOST
from tests.diagnose.spring_table import DAMPING, INERTIA, MASS, PAYLOAD, STIFFNESS, spring_table


@pytest.fixture(scope="module")
def stepwise(tmp_path_factory: pytest.TempPathFactory) -> Iterator[StepwiseSearch]:
    with spring_table(tmp_path_factory.mktemp("table")) as problem:
        proposals = propose(problem)
        problem, declared = fit_declared(problem, proposals)
        yield StepwiseSearch(
            problem, declared, proposals, propagated_input_noise(problem, declared.fit)
        )


def trial(stepwise: StepwiseSearch, *keys: str) -> FittedModel:
    """These candidates fitted to their end, each in its fullest form."""
    problem = stepwise.problem
    full = {c.key: c for c in sorted(problem.candidates, key=lambda c: len(c.free))}
    chosen = tuple(full[key] for key in keys)
    amounts = {f.name: f.start for c in chosen for f in c.free}
    shapes = {name: value for c in chosen for name, value in c.shapes[0].items()}
    start = stepwise.declared.values | amounts | shapes
    return stepwise.polished(fitted(problem, chosen, start, None))


def test_a_declared_value_that_leaves_more_than_noise_gives_way_to_the_spring(
    stepwise: StepwiseSearch,
) -> None:
    wrong = trial(stepwise, "declared_value:c_x_payload")
    assert not stepwise.is_white(wrong)
    found, steps = by_effects_alone(stepwise, wrong, [])
    assert found.keys == ("cable_spring@pan",)
    assert found.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)
    assert [s.candidate.key for s in steps] == ["cable_spring@pan"]


def test_a_declared_value_beside_the_spring_is_taken_out(stepwise: StepwiseSearch) -> None:
    """Both leave noise alone: the set with fewer parameters is the answer."""
    larger = trial(stepwise, "cable_spring@pan", "declared_value:c_x_payload")
    assert stepwise.is_white(larger)
    found, _ = by_effects_alone(stepwise, larger, [])
    assert found.keys == ("cable_spring@pan",)


def test_declared_values_that_make_up_for_each_other_are_taken_out_together(
    stepwise: StepwiseSearch,
) -> None:
    """None of two that make up for each other can be done without alone."""
    declared = ("declared_value:c_x_payload", "declared_value:m_payload")
    larger = trial(stepwise, "cable_spring@pan", *declared)
    assert stepwise.is_white(larger)
    found, _ = by_effects_alone(stepwise, larger, [])
    assert found.keys == ("cable_spring@pan",)


def test_effects_that_leave_noise_alone_are_not_searched_again(stepwise: StepwiseSearch) -> None:
    alone = trial(stepwise, "cable_spring@pan")
    assert stepwise.is_white(alone)
    found, _ = by_effects_alone(stepwise, alone, [])
    assert found is alone


def test_a_better_place_that_a_third_candidate_shows_is_kept(stepwise: StepwiseSearch) -> None:
    """The spring at half its stiffness, as a fit may end in a valley: another candidate leads out
    of it, is taken out again, and what it led to stays.
    """
    problem = stepwise.problem
    full = trial(stepwise, "cable_spring@pan")
    valley = full.values | {"k1_cable_pan": 0.5 * STIFFNESS}
    poor = fitted(problem, full.candidates, valley, full.fit.z, 0)
    assert not stepwise.is_white(poor)
    found, _ = extended(stepwise, poor, [])
    assert found.keys == poor.keys
    assert found.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)


def test_a_spring_without_a_cubic_part_is_found_as_a_linear_one(stepwise: StepwiseSearch) -> None:
    (found,) = simplified(stepwise, trial(stepwise, "cable_spring@pan")).candidates
    assert [f.name for f in found.free] == ["k1_cable_pan", "theta0_cable_pan"]


def test_a_spring_in_a_poor_place_finds_its_own_without_a_wrong_declared_value(
    stepwise: StepwiseSearch,
) -> None:
    """Half of the stiffness beside a centre of mass that makes up for a part of the rest."""
    wrong, right = (
        trial(stepwise, "declared_value:c_x_payload"),
        trial(stepwise, "cable_spring@pan"),
    )
    half = right.values | {"k1_cable_pan": 0.5 * STIFFNESS}
    both = fitted(stepwise.problem, [*wrong.candidates, *right.candidates], half, right.fit.z)
    left = stepwise.without(both, wrong.candidates[0])
    assert left.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)


@pytest.mark.parametrize(("part", "open_yet"), [(0.01, False), (0.96, True), (1.0, False)])
def test_what_a_fit_short_of_its_end_leaves_decides_nothing(
    stepwise: StepwiseSearch, part: float, open_yet: bool
) -> None:
    """A spring of part of the stiffness: of a hundredth of it no fit to the end is asked, for that
    leaves nearly all; with 96 % the rest may be the fit's; at its end nothing is gained.
    """
    right = trial(stepwise, "cable_spring@pan")
    values = right.values | {"k1_cable_pan": part * right.values["k1_cable_pan"]}
    smaller = fitted(stepwise.problem, right.candidates, values, right.fit.z)
    assert gain(right, smaller).share >= (MOST if part < 1.0 else 0.0)
    assert stepwise.is_decided_at_end_of(smaller, right) is open_yet


def test_what_stays_takes_over_what_the_others_did(stepwise: StepwiseSearch) -> None:
    """Half of the spring told as a base that leans: without it the spring begins whole."""
    problem = stepwise.problem
    both = trial(stepwise, "cable_spring@pan", "base_tilt")
    values = both.values | {"k1_cable_pan": 0.5 * STIFFNESS, "beta_base": 0.2}
    halved = fitted(problem, both.candidates, values, both.fit.z)
    as_it_is, led = taken_over(problem, halved.candidates[:1], halved)
    assert as_it_is.values["k1_cable_pan"] == 0.5 * STIFFNESS
    assert led.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.05)
    assert led.values["beta_base"] == as_it_is.values["beta_base"] == 0.0
    assert led.fit.cost < 0.01 * as_it_is.fit.cost


def test_a_stuck_inertia_takes_over_what_a_moved_payload_made_up_for(tmp_path: Path) -> None:
    """A machine of which nothing is missing: m d^2 holds what the inertia lacks."""
    with spring_table(tmp_path, stiffness=0.0) as problem:
        (moved,) = (c for c in problem.candidates if c.id == "declared_value:c_x_payload")
        lack = INERTIA - PAYLOAD - 0.005
        values = problem.fixed | {"J_pan": 0.005, "b_pan": DAMPING}
        values["c_x_payload"] = math.sqrt((PAYLOAD + lack) / MASS)
        made_up = fitted(problem, [moved], values, None)
        as_it_is, led = taken_over(problem, (), made_up)
        assert as_it_is.values["J_pan"] == 0.005
        assert led.values["c_x_payload"] == 0.1
        assert led.values["J_pan"] == pytest.approx(0.005 + lack, rel=0.25)
        assert led.fit.cost < 0.2 * as_it_is.fit.cost
        found = declared_from(
            problem, made_up, as_it_is, propagated_input_noise(problem, made_up.fit)
        )
        assert found is not None
        assert found.values["J_pan"] == pytest.approx(INERTIA - PAYLOAD, rel=1e-3)


def test_forward_selection_meets_the_set_that_another_road_ended_with(
    stepwise: StepwiseSearch,
) -> None:
    end = trial(stepwise, "cable_spring@pan")
    found, steps = extended(stepwise, stepwise.declared, [], end)
    assert found.keys == ("cable_spring@pan",)
    assert [s.candidate.key for s in steps] == ["cable_spring@pan"]


def test_poor_fits_of_one_set_are_led_to_one_place(stepwise: StepwiseSearch) -> None:
    """A spring at half its stiffness is led to its place; another at a third takes that end."""
    full = trial(stepwise, "cable_spring@pan")
    fresh = StepwiseSearch(
        stepwise.problem, stepwise.declared, stepwise.proposals, stepwise.propagated
    )
    first, second = (
        fresh.restarted(
            fitted(stepwise.problem, full.candidates, full.values | {"k1_cable_pan": k}, full.fit.z)
        )
        for k in (0.5 * STIFFNESS, 0.3 * STIFFNESS)
    )
    assert first is second
    assert first.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)


def test_trials_far_behind_are_kept_with_half_the_memory_and_gain_what_they_gained(
    stepwise: StepwiseSearch,
) -> None:
    """Of a set twice the better stays; a spring of a tenth of the stiffness is far behind."""
    best, far = trial(stepwise, "cable_spring@pan"), trial(stepwise, "constant_torque@pan")
    weak = best.values | {"k1_cable_pan": 0.1 * STIFFNESS}
    poor = fitted(stepwise.problem, best.candidates, weak, best.fit.z)
    kept = best_of_each_set([poor, far, best], best)
    assert kept[0] is best and [t.keys for t in kept] == [best.keys, far.keys]
    sizes = [sum(e.by_parameter.nbytes for e in t.fit.evaluations) for t in (far, kept[1])]
    assert sizes[1] == 0.5 * sizes[0]
    before, after = (gain(t, stepwise.declared) for t in (far, kept[1]))
    assert after.share == pytest.approx(before.share, abs=1e-4)
    assert best_of_each_set(kept, best) == kept


def test_what_a_trial_far_behind_gains_is_told_where_its_columns_hardly_differ(
    stepwise: StepwiseSearch,
) -> None:
    """The last column is a sum of the others: products of them rounded to single precision belong
    to no matrix of information, most of twenty times.
    """
    far = trial(stepwise, "constant_torque@pan")
    for seed in range(20):
        rng = np.random.default_rng(seed)
        steep = 1e9  # so that no prior keeps parameters in place
        tables = [steep * rng.standard_normal(e.by_parameter.shape) for e in far.fit.evaluations]
        for table in tables:
            table[:, -1] = table[:, :-1].sum(axis=1)
        before, after = (
            gain(replace(far, fit=replace(far.fit, evaluations=alike)), stepwise.declared)
            for alike in (
                [
                    replace(e, by_parameter=t.astype(kind), by_start=e.by_start.astype(kind))
                    for e, t in zip(far.fit.evaluations, tables, strict=True)
                ]
                for kind in (np.float64, np.float32)
            )
        )
        assert after.share == pytest.approx(before.share, abs=1e-4)
