"""Which roads a search takes: the short one where it ends at the noise, else that over windows; on
logs whose motion is known in closed form.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from ptp_symbolic.numeric.diagnose import search as roads
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, SearchProblem, fitted
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.noise_floor import propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import ProposedSet, ProposedSets, propose, start_for
from ptp_symbolic.numeric.diagnose.refits import is_near_noise_floor, over_whole_runs
from ptp_symbolic.numeric.diagnose.search import floated
from ptp_symbolic.numeric.diagnose.stepwise import Step, StepwiseSearch
from ptp_symbolic.numeric.identify.constants import TRIED
from ptp_symbolic.numeric.identify.evidence import Allowance
from tests.diagnose.spring_table import STIFFNESS, spring_table

STUCK = 1.0002


@pytest.fixture(scope="module")
def begun(
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[tuple[SearchProblem, FittedModel, ProposedSets]]:
    with spring_table(tmp_path_factory.mktemp("spring")) as problem:
        proposals = propose(problem)
        yield (*over_whole_runs(problem, proposals), proposals)


@pytest.fixture
def stepwise(begun: tuple[SearchProblem, FittedModel, ProposedSets]) -> StepwiseSearch:
    """A search of its own for every test: tests change what it has found and what it may take."""
    problem, declared, proposals = begun
    return StepwiseSearch(
        problem, declared, proposals, propagated_input_noise(problem, declared.fit)
    )


def test_what_leaves_only_noise_is_found_without_windows(
    tmp_path: Path,
) -> None:
    with spring_table(tmp_path) as problem:
        found = roads.search(problem)
    assert found.chosen.keys == ("cable_spring@pan",)
    assert found.chosen.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)
    assert not found.is_over_windows and not found.is_cut_short


@pytest.mark.long
def test_a_spring_is_found_over_windows_where_no_set_leaves_only_noise(tmp_path: Path) -> None:
    """Gusts that no log holds, of a tenth of a second."""
    with spring_table(tmp_path, gust=0.05, lasting=10) as problem:
        found = roads.search(problem)
    assert found.is_over_windows
    assert "cable_spring@pan" in found.chosen.keys


def test_a_brief_search_goes_on_to_what_the_whole_one_finds(tmp_path: Path) -> None:
    with spring_table(tmp_path, gust=0.05, lasting=10) as problem:
        brief = roads.search(problem, brief=True)
        found = roads.continued(problem, brief)
    assert brief.is_brief and not brief.is_over_windows
    assert found.is_over_windows and not found.is_brief
    assert "cable_spring@pan" in found.chosen.keys


def test_a_brief_search_that_found_all_is_not_gone_on_with(tmp_path: Path) -> None:
    with spring_table(tmp_path) as problem:
        brief = roads.search(problem, brief=True)
        assert roads.continued(problem, brief) is brief
    assert brief.chosen.keys == ("cable_spring@pan",)


def test_a_search_whose_time_is_over_ends_with_what_the_rows_proposed(
    tmp_path: Path,
) -> None:
    """Gusts hide the spring, so that a search with time goes on over windows."""
    with spring_table(tmp_path, gust=0.05, lasting=10) as problem:
        found = roads.search(replace(problem, allowance=Allowance(seconds=1e-3)))
    assert found.is_cut_short and not found.is_over_windows
    assert found.chosen.keys == ("cable_spring@pan",)
    assert not found.problem.is_over  # the verdict takes what time it needs


def test_moves_of_a_search_whose_time_is_over_begin_nothing(stepwise: StepwiseSearch) -> None:
    """A torque instead of the spring, which every move would better."""
    torque = alone(stepwise, "constant_torque@pan")
    assert not stepwise.problem.is_over and stepwise.grown(torque)
    stepwise.problem = replace(stepwise.problem, allowance=Allowance(seconds=-1.0))
    assert stepwise.problem.is_over
    assert stepwise.grown(torque) is None
    assert stepwise.restarted(torque) is torque and not stepwise.without_influence(torque)


def full_form(problem: SearchProblem, key: str) -> Candidate:
    """A candidate with all that it can do."""
    return max((c for c in problem.candidates if c.key == key), key=lambda c: len(c.free))


def proposing(stepwise: StepwiseSearch, first: str, then: str) -> StepwiseSearch:
    """The seeker whose rows propose one candidate first, and another one next."""
    sets = [
        (ProposedSet((one,), start_for(stepwise.problem, stepwise.proposals, (one,), {})),)
        for one in (full_form(stepwise.problem, key) for key in (first, then))
    ]
    stepwise.proposals = replace(stepwise.proposals, sets=sets[0], further=lambda: sets[1])
    return stepwise


def test_sets_that_the_rows_put_next_are_tried_where_the_first_leave_more_than_noise(
    stepwise: StepwiseSearch,
) -> None:
    """Rows that a gap spoils put the right set behind others; here a torque before the spring."""
    found = roads._proposed(proposing(stepwise, "constant_torque@pan", "cable_spring@pan"))
    assert found[-1].keys == ("cable_spring@pan",)
    assert stepwise.is_white(found[-1])
    assert found[-1].values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)


def test_no_further_sets_are_tried_where_one_leaves_only_noise(stepwise: StepwiseSearch) -> None:
    stepwise = proposing(stepwise, "cable_spring@pan", "constant_torque@pan")
    tried: list[str] = []
    stepwise.proposals = replace(stepwise.proposals, further=lambda: tried.append("further") or ())
    (found,) = roads._proposed(stepwise)
    assert found.keys == ("cable_spring@pan",)
    assert not tried


def test_the_rows_put_other_sets_next_than_first(stepwise: StepwiseSearch) -> None:
    first, then = (
        [frozenset(c.key for c in p.candidates) for p in sets]
        for sets in (stepwise.proposals.sets, stepwise.proposals.further())
    )
    assert first and then and all(then)
    assert len(then) == len(set(then)) <= 4 * TRIED
    assert not set(first) & set(then)


def test_a_set_near_the_floor_is_led_to_its_end(stepwise: StepwiseSearch) -> None:
    """A spring 2e-4 too stiff, which is where its fit has ended: four times the noise is left."""
    spring = full_form(stepwise.problem, "cable_spring@pan")
    end = alone(stepwise, spring.key)
    stiff = end.values | {"k1_cable_pan": end.values["k1_cable_pan"] * STUCK}
    stuck = fitted(stepwise.problem, (spring,), stiff, end.fit.z, 0)
    assert is_near_noise_floor(stuck) and not stepwise.is_white(stuck)
    assert stepwise.is_white(stepwise.restarted(stuck))


def test_what_was_found_and_not_chosen_is_remembered(stepwise: StepwiseSearch) -> None:
    """A set that cannot be told from the chosen one is looked for among those."""
    torque, spring = (alone(stepwise, key) for key in ("constant_torque@pan", "cable_spring@pan"))
    stepwise.tried.others.clear()
    begun, _ = roads._begun(stepwise, [torque, spring])
    assert begun.keys == spring.keys
    assert torque.keys in {t.keys for t in stepwise.tried.others}


def test_a_torque_that_is_not_there_is_taken_out_beside_the_spring(
    stepwise: StepwiseSearch,
) -> None:
    problem = stepwise.problem
    both = tuple(full_form(problem, key) for key in ("cable_spring@pan", "constant_torque@pan"))
    start = stepwise.declared.values | {f.name: f.start for c in both for f in c.free}
    whole = stepwise.polished(fitted(problem, both, start, None))
    assert stepwise.is_white(whole)
    found, _ = stepwise.pruned(whole)
    assert found.keys == ("cable_spring@pan",)


def alone(stepwise: StepwiseSearch, key: str) -> FittedModel:
    """One candidate in its fullest form, fitted to its end."""
    one = full_form(stepwise.problem, key)
    start = stepwise.declared.values | {f.name: f.start for f in one.free}
    return stepwise.polished(fitted(stepwise.problem, (one,), start, None))


def test_a_torque_that_stands_for_a_spring_ends_as_the_spring(stepwise: StepwiseSearch) -> None:
    found = roads._from_declared(stepwise, [alone(stepwise, "constant_torque@pan")])
    assert found.chosen.keys == ("cable_spring@pan",)
    assert found.chosen.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)


def test_what_made_up_for_a_fit_that_was_stuck_is_taken_out(tmp_path: Path) -> None:
    """A machine of which nothing is missing, fitted with twice its damping; the spring that makes
    up for a part of that has no gain once the fit comes to its end.
    """
    with spring_table(tmp_path, stiffness=0.0) as problem:
        proposals = propose(problem)
        problem, end = over_whole_runs(problem, proposals)
        stuck = fitted(problem, (), end.values | {"b_pan": 0.2}, None)
        stepwise = StepwiseSearch(
            problem, stuck, proposals, propagated_input_noise(problem, end.fit)
        )
        spring = max(
            (c for c in problem.candidates if c.id == "cable_spring"), key=lambda c: c.member
        )
        values = stuck.values | {f.name: f.start for f in spring.free}
        found = roads._from_declared(stepwise, [fitted(problem, (spring,), values, None, 1)])
    assert not found.chosen.candidates
    assert found.declared.values["b_pan"] == pytest.approx(end.values["b_pan"], rel=1e-3)


def test_a_torque_gives_way_to_what_explains_more_than_it_does(stepwise: StepwiseSearch) -> None:
    """One move alone: the torque is left out, and no candidate, while another is looked for."""
    torque, spring = (alone(stepwise, key) for key in ("constant_torque@pan", "cable_spring@pan"))
    steps = [Step(torque.candidates[0], gain(torque, stepwise.declared), 0.0, stepwise.declared)]
    found, _ = floated(stepwise, torque, steps)
    assert found.candidates and "constant_torque@pan" not in found.keys
    assert gain(found, torque).share >= stepwise.problem.material
    assert floated(stepwise, spring, steps) == (spring, steps)
