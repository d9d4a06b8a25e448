"""Which roads a search takes: the short one where it ends at the noise, else that over windows; on
logs whose motion is known in closed form.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from ptp_symbolic.numeric.diagnose import search as roads
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.declared_fit import over_whole_runs
from ptp_symbolic.numeric.diagnose.findings import Step
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.left_over import carried_noise
from ptp_symbolic.numeric.diagnose.proposals import Proposal, Proposals, propose, start_for
from ptp_symbolic.numeric.diagnose.refits import is_near_floor
from ptp_symbolic.numeric.diagnose.search import floated
from ptp_symbolic.numeric.diagnose.seeker import Seeker
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, fitted
from ptp_symbolic.numeric.identify.constants import TRIED
from ptp_symbolic.numeric.identify.work import Allowance
from tests.diagnose.spring_table import STIFFNESS, spring_table

STUCK = 1.0002


@pytest.fixture(scope="module")
def begun(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Task, Trial, Proposals]]:
    with spring_table(tmp_path_factory.mktemp("spring")) as task:
        proposals = propose(task)
        yield (*over_whole_runs(task, proposals), proposals)


@pytest.fixture
def seeker(begun: tuple[Task, Trial, Proposals]) -> Seeker:
    """A search of its own for every test: tests change what it has found and what it may take."""
    task, declared, proposals = begun
    return Seeker(task, declared, proposals, carried_noise(task, declared.fit))


def test_what_leaves_only_noise_is_found_without_windows(
    tmp_path: Path,
) -> None:
    with spring_table(tmp_path) as task:
        found = roads.search(task)
    assert found.chosen.keys == ("cable_spring@pan",)
    assert found.chosen.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)
    assert not found.is_led and not found.is_cut_short


@pytest.mark.long
def test_a_spring_is_found_over_windows_where_no_set_leaves_only_noise(tmp_path: Path) -> None:
    """Gusts that no log holds, of a tenth of a second."""
    with spring_table(tmp_path, gust=0.05, lasting=10) as task:
        found = roads.search(task)
    assert found.is_led
    assert "cable_spring@pan" in found.chosen.keys


def test_a_search_whose_time_is_over_ends_with_what_the_rows_proposed(
    tmp_path: Path,
) -> None:
    """Gusts hide the spring, so that a search with time goes on over windows."""
    with spring_table(tmp_path, gust=0.05, lasting=10) as task:
        found = roads.search(replace(task, allowance=Allowance(seconds=1e-3)))
    assert found.is_cut_short and not found.is_led
    assert found.chosen.keys == ("cable_spring@pan",)
    assert not found.task.is_over  # the verdict takes what time it needs


def test_moves_of_a_search_whose_time_is_over_begin_nothing(seeker: Seeker) -> None:
    """A torque instead of the spring, which every move would better."""
    torque = alone(seeker, "constant_torque@pan")
    moves = [seeker.grown(torque), seeker.exchanged(torque)]
    assert not seeker.task.is_over and any(moves)
    seeker.task = replace(seeker.task, allowance=Allowance(seconds=-1.0))
    assert seeker.task.is_over
    assert seeker.grown(torque) is None and seeker.exchanged(torque) is None
    assert seeker.restarted(torque) is torque and not seeker.unseen(torque)


def full_form(task: Task, key: str) -> Candidate:
    """A candidate with all that it can do."""
    return max((c for c in task.candidates if c.key == key), key=lambda c: len(c.free))


def proposing(seeker: Seeker, first: str, then: str) -> Seeker:
    """The seeker whose rows propose one candidate first, and another one next."""
    sets = [
        (Proposal((one,), start_for(seeker.task, seeker.proposals, (one,), {})),)
        for one in (full_form(seeker.task, key) for key in (first, then))
    ]
    seeker.proposals = replace(seeker.proposals, sets=sets[0], further=lambda: sets[1])
    return seeker


def test_sets_that_the_rows_put_next_are_tried_where_the_first_leave_more_than_noise(
    seeker: Seeker,
) -> None:
    """Rows that a gap spoils put the right set behind others; here a torque before the spring."""
    found = roads._proposed(proposing(seeker, "constant_torque@pan", "cable_spring@pan"))
    assert found[-1].keys == ("cable_spring@pan",)
    assert seeker.is_at_noise(found[-1])
    assert found[-1].values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)


def test_no_further_sets_are_tried_where_one_leaves_only_noise(seeker: Seeker) -> None:
    seeker = proposing(seeker, "cable_spring@pan", "constant_torque@pan")
    tried: list[str] = []
    seeker.proposals = replace(seeker.proposals, further=lambda: tried.append("further") or ())
    (found,) = roads._proposed(seeker)
    assert found.keys == ("cable_spring@pan",)
    assert not tried


def test_the_rows_put_other_sets_next_than_first(seeker: Seeker) -> None:
    first, then = (
        [frozenset(c.key for c in p.candidates) for p in sets]
        for sets in (seeker.proposals.sets, seeker.proposals.further())
    )
    assert first and then and all(then)
    assert len(then) == len(set(then)) <= 4 * TRIED
    assert not set(first) & set(then)


def test_a_set_near_the_floor_is_led_to_its_end(seeker: Seeker) -> None:
    """A spring 2e-4 too stiff, which is where its fit has ended: four times the noise is left."""
    spring = full_form(seeker.task, "cable_spring@pan")
    end = alone(seeker, spring.key)
    stiff = end.values | {"k1_cable_pan": end.values["k1_cable_pan"] * STUCK}
    stuck = fitted(seeker.task, (spring,), stiff, end.fit.z, 0)
    assert is_near_floor(stuck) and not seeker.is_at_noise(stuck)
    assert seeker.is_at_noise(seeker.restarted(stuck))


def test_what_was_found_and_not_chosen_is_remembered(seeker: Seeker) -> None:
    """A set that cannot be told from the chosen one is looked for among those."""
    torque, spring = (alone(seeker, key) for key in ("constant_torque@pan", "cable_spring@pan"))
    seeker.tried.others.clear()
    begun, _ = roads._begun(seeker, [torque, spring])
    assert begun.keys == spring.keys
    assert torque.keys in {t.keys for t in seeker.tried.others}


def test_a_torque_that_is_not_there_is_taken_out_beside_the_spring(seeker: Seeker) -> None:
    task = seeker.task
    both = tuple(full_form(task, key) for key in ("cable_spring@pan", "constant_torque@pan"))
    start = seeker.declared.values | {f.name: f.start for c in both for f in c.free}
    whole = seeker.polished(fitted(task, both, start, None))
    assert seeker.is_at_noise(whole)
    found, _ = seeker.pruned(whole)
    assert found.keys == ("cable_spring@pan",)


def alone(seeker: Seeker, key: str) -> Trial:
    """One candidate in its fullest form, fitted to its end."""
    one = full_form(seeker.task, key)
    start = seeker.declared.values | {f.name: f.start for f in one.free}
    return seeker.polished(fitted(seeker.task, (one,), start, None))


def test_a_torque_that_stands_for_a_spring_ends_as_the_spring(seeker: Seeker) -> None:
    found = roads._from_declared(seeker, [alone(seeker, "constant_torque@pan")])
    assert found.chosen.keys == ("cable_spring@pan",)
    assert found.chosen.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)


def test_what_made_up_for_a_fit_that_was_stuck_is_taken_out(tmp_path: Path) -> None:
    """A machine of which nothing is missing, fitted with twice its damping; the spring that makes
    up for a part of that has no gain once the fit comes to its end.
    """
    with spring_table(tmp_path, stiffness=0.0) as task:
        proposals = propose(task)
        task, end = over_whole_runs(task, proposals)
        stuck = fitted(task, (), end.values | {"b_pan": 0.2}, None)
        seeker = Seeker(task, stuck, proposals, carried_noise(task, end.fit))
        spring = max((c for c in task.candidates if c.id == "cable_spring"), key=lambda c: c.member)
        values = stuck.values | {f.name: f.start for f in spring.free}
        found = roads._from_declared(seeker, [fitted(task, (spring,), values, None, 1)])
    assert not found.chosen.candidates
    assert found.declared.values["b_pan"] == pytest.approx(end.values["b_pan"], rel=1e-3)


def test_a_torque_gives_way_to_what_explains_more_than_it_does(seeker: Seeker) -> None:
    """One move alone: the torque is left out, and no candidate, while another is looked for."""
    torque, spring = (alone(seeker, key) for key in ("constant_torque@pan", "cable_spring@pan"))
    steps = [Step(torque.candidates[0], gain(torque, seeker.declared), 0.0, seeker.declared)]
    found, _ = floated(seeker, torque, steps)
    assert found.candidates and "constant_torque@pan" not in found.keys
    assert gain(found, torque).share >= seeker.task.material
    assert floated(seeker, spring, steps) == (spring, steps)
