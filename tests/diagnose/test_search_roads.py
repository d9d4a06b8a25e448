"""Which roads a search takes: the short one where it ends at the noise, else that over windows; on
logs whose motion is known in closed form.
"""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose import search as roads
from ptp_symbolic.numeric.diagnose import through_windows
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.declared_fit import led_over_windows, over_whole_runs
from ptp_symbolic.numeric.diagnose.findings import Step
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.left_over import Carried, carried_noise
from ptp_symbolic.numeric.diagnose.nested import declared_from
from ptp_symbolic.numeric.diagnose.proposals import Proposal, propose, start_for
from ptp_symbolic.numeric.diagnose.refits import is_near_floor
from ptp_symbolic.numeric.diagnose.seeker import Seeker
from ptp_symbolic.numeric.diagnose.stepwise import floated
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, fitted
from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, TRIED
from tests.diagnose.spring_table import STIFFNESS, spring_table

STUCK = 1.0002


@pytest.fixture
def over_windows(monkeypatch: pytest.MonkeyPatch) -> list[Task]:
    """The tasks whose declared model was led over windows."""
    tasks: list[Task] = []

    def noted(task: Task, *rest: Any) -> tuple[Task, Trial]:
        tasks.append(task)
        return led_over_windows(task, *rest)

    monkeypatch.setattr(roads, "led_over_windows", noted)
    return tasks


@pytest.fixture
def seeker(tmp_path: Path) -> Iterator[Seeker]:
    with spring_table(tmp_path) as task:
        proposals = propose(task)
        task, declared = over_whole_runs(task, proposals)
        yield Seeker(task, declared, proposals, carried_noise(task, declared.fit))


def test_what_leaves_only_noise_is_found_without_windows(
    tmp_path: Path, over_windows: list[Task]
) -> None:
    with spring_table(tmp_path) as task:
        found = roads.search(task)
    assert found.chosen.keys == ("cable_spring@pan",)
    assert found.chosen.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)
    assert not over_windows and not found.is_cut_short


def test_windows_lead_where_no_set_leaves_only_noise(
    tmp_path: Path, over_windows: list[Task], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Gusts that no log holds, of a tenth of a second."""
    monkeypatch.setattr(roads, "_from_declared", lambda *begun: begun)
    with spring_table(tmp_path, gust=0.05, lasting=10) as task:
        roads.search(task)
    assert len(over_windows) == 1


def test_a_search_whose_time_is_over_ends_with_what_the_rows_proposed(
    tmp_path: Path, over_windows: list[Task]
) -> None:
    """Gusts hide the spring, so that a search with time goes on over windows."""
    with spring_table(tmp_path, gust=0.05, lasting=10) as task:
        found = roads.search(task, 1e-3)
    assert found.is_cut_short and not over_windows
    assert found.chosen.keys == ("cable_spring@pan",)
    assert found.task.deadline == np.inf  # the verdict takes what time it needs


def test_moves_of_a_search_whose_time_is_over_begin_nothing(seeker: Seeker) -> None:
    """A torque instead of the spring, which every move would better."""
    torque = alone(seeker, "constant_torque@pan")
    moves = [seeker.grown(torque), seeker.exchanged(torque)]
    assert not seeker.task.is_over and any(moves)
    seeker.task = replace(seeker.task, deadline=0.0)
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


def test_the_better_of_all_sets_tells_what_the_noise_of_inputs_leaves(
    seeker: Seeker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not the best of those that were tried last, which is far behind and not fitted further."""
    followed: list[tuple[str, ...]] = []
    monkeypatch.setattr(Seeker, "is_at_noise", lambda *_: False)
    monkeypatch.setattr(Seeker, "follow", lambda _, trial: followed.append(trial.keys))
    found = roads._proposed(proposing(seeker, "cable_spring@pan", "constant_torque@pan"))
    assert followed == [("cable_spring@pan",)] * 2
    assert [t.keys for t in found] == [("cable_spring@pan",)]


def test_the_rows_put_other_sets_next_than_first(seeker: Seeker) -> None:
    first, then = (
        [frozenset(c.key for c in p.candidates) for p in sets]
        for sets in (seeker.proposals.sets, seeker.proposals.further())
    )
    assert first and then and all(then)
    assert len(then) == len(set(then)) <= 4 * TRIED
    assert not set(first) & set(then)


def test_a_set_near_the_floor_is_begun_anew_before_windows_are_asked(
    seeker: Seeker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A spring 2e-4 too stiff, which is where its fit has ended: four times the noise is left."""
    spring = full_form(seeker.task, "cable_spring@pan")
    end = alone(seeker, spring.key)
    stiff = end.values | {"k1_cable_pan": end.values["k1_cable_pan"] * STUCK}
    stuck = fitted(seeker.task, (spring,), stiff, end.fit.z, 0)
    assert is_near_floor(stuck) and not seeker.is_at_noise(stuck)
    monkeypatch.setattr(roads, "_proposed", lambda _: [stuck])
    monkeypatch.setattr(Seeker, "grown", lambda *_, **__: None)
    (found,) = roads._soon_found(seeker)
    assert seeker.is_at_noise(found)


def test_what_was_found_and_not_chosen_is_remembered(
    seeker: Seeker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A set that cannot be told from the chosen one is looked for among those."""
    torque, spring = (alone(seeker, key) for key in ("constant_torque@pan", "cable_spring@pan"))
    seeker.tried.others.clear()
    monkeypatch.setattr(Seeker, "have_answer", lambda *_: True)
    begun, _ = roads._begun(seeker, [torque, spring])
    assert begun.keys == spring.keys
    assert torque.keys in {t.keys for t in seeker.tried.others}


def test_no_set_is_begun_anew_without_a_candidate_that_seems_to_gain_most(
    seeker: Seeker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A spring and a torque that is not there: what the torque adds is looked at closely, but the
    motion without the spring is another one, wherever a fit begins.
    """
    task = seeker.task
    both = tuple(full_form(task, key) for key in ("cable_spring@pan", "constant_torque@pan"))
    start = seeker.declared.values | {f.name: f.start for c in both for f in c.free}
    whole = seeker.polished(fitted(task, both, start, None))
    assert seeker.is_at_noise(whole)
    brief: dict[str, bool] = {}
    step = seeker.step

    def noted(trial: Trial, candidate: Candidate, *, briefly: bool) -> Step:
        brief[candidate.key] = briefly
        return step(trial, candidate, briefly=briefly)

    monkeypatch.setattr(seeker, "step", noted)
    found, _ = seeker.pruned(whole)
    assert found.keys == ("cable_spring@pan",)
    assert brief == {"constant_torque@pan": False, "cable_spring@pan": True}


@pytest.mark.parametrize("is_white", [True, False])
def test_a_set_that_leaves_white_noise_shows_that_none_of_another_colour_is_hidden(
    seeker: Seeker, monkeypatch: pytest.MonkeyPatch, is_white: bool
) -> None:
    """Windows that a candidate leaves as they are may hold noise alone: white noise, or what noise
    of the slowest colour that is looked for hides.
    """
    most: list[np.ndarray] = []
    monkeypatch.setattr(through_windows, "_first_lead", lambda *a: most.append(a[-1]))
    task, nothing = seeker.task, Carried(*[np.zeros(1)] * 3)
    found = through_windows.each_through_windows(
        task, seeker.declared, task.candidates[:1], nothing, is_white=is_white
    )
    assert not found and len(most) == 1
    assert np.all(most[0] == ABOVE_NOISE) == is_white
    assert np.all(most[0] >= ABOVE_NOISE)


def alone(seeker: Seeker, key: str) -> Trial:
    """One candidate in its fullest form, fitted to its end."""
    one = full_form(seeker.task, key)
    start = seeker.declared.values | {f.name: f.start for f in one.free}
    return seeker.polished(fitted(seeker.task, (one,), start, None))


def test_a_set_that_took_the_place_of_another_grows_too(
    seeker: Seeker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A constant torque does not explain a spring, which can still be added to it."""
    torque, pruned = alone(seeker, "constant_torque@pan"), Seeker.pruned
    monkeypatch.setattr(Seeker, "exchanged", lambda *_: torque)
    monkeypatch.setattr(
        Seeker, "pruned", lambda self, t: (t, []) if t is torque else pruned(self, t)
    )
    found = roads._from_declared(seeker, [])
    assert found.chosen.keys == ("cable_spring@pan",)
    assert found.chosen.values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.01)


def test_what_made_up_for_a_fit_that_was_stuck_is_taken_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A machine of which nothing is missing, fitted with twice its damping; the spring that makes
    up for a part of that has no gain once the fit begins far off and comes to its end.
    """
    with spring_table(tmp_path, stiffness=0.0) as task:
        proposals = propose(task)
        task, end = over_whole_runs(task, proposals)
        stuck = fitted(task, (), end.values | {"b_pan": 0.2}, None)
        seeker = Seeker(task, stuck, proposals, carried_noise(task, end.fit))
        spring = max((c for c in task.candidates if c.id == "cable_spring"), key=lambda c: c.member)
        values = stuck.values | {f.name: f.start for f in spring.free}
        made_up = fitted(task, (spring,), values, None, 1)
        better = alone(Seeker(task, end, proposals, seeker.carried), spring.key)
        monkeypatch.setattr(Seeker, "restarted", lambda _, trial: trial)
        monkeypatch.setattr(roads, "each_through_windows", lambda *_, **__: [made_up])
        monkeypatch.setattr(roads, "extended", lambda _, begun, steps, *end: (begun, steps))
        monkeypatch.setattr(roads, "from_far_off", lambda *_: [better])

        def led(task: Task, trial: Trial, *rest: Any) -> Trial | None:
            return None if trial is made_up else declared_from(task, trial, *rest)

        monkeypatch.setattr(roads, "declared_from", led)
        monkeypatch.setattr(Seeker, "completed", lambda _, trial: trial)
        found = roads._from_declared(seeker, [made_up])
    assert not found.chosen.candidates
    assert found.declared.values["b_pan"] == pytest.approx(end.values["b_pan"], rel=1e-3)


def test_a_stand_in_gives_way_to_the_effect_that_it_hides(
    seeker: Seeker, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is taken out, and no candidate any more, while another is looked for."""
    torque, spring = (alone(seeker, key) for key in ("constant_torque@pan", "cable_spring@pan"))
    steps = [Step(torque.candidates[0], gain(torque, seeker.declared), 0.0, seeker.declared)]

    def instead(among: Seeker, trial: Trial, *, briefly: bool = False) -> Trial | None:
        free = {c.key for c in among.task.candidates}
        return spring if trial is seeker.declared and "constant_torque@pan" not in free else None

    monkeypatch.setattr(Seeker, "grown", instead)
    found, _ = floated(seeker, torque, steps)
    assert found.keys == ("cable_spring@pan",)
    assert floated(seeker, spring, steps) == (spring, steps)
    monkeypatch.setattr(Seeker, "grown", lambda *_, **__: torque)
    assert floated(seeker, torque, steps) == (torque, steps)
