"""The rounds: what led out of a bad place earns no name for that, and the new place is followed."""

from types import SimpleNamespace
from typing import Any

import pytest

from ptp_symbolic.diagnose import rounds
from ptp_symbolic.diagnose.verdict import EXPLAINED, NOTHING_MISSING, UNEXPLAINED


def trial(cost: float, *candidates: Any) -> Any:
    train = SimpleNamespace(cost=cost, failed=None, rms_counts=lambda: cost)
    keys = tuple(getattr(c, "key", c) for c in candidates)
    return SimpleNamespace(train=train, validate=None, candidates=candidates, keys=keys)


def diagnosed(monkeypatch: pytest.MonkeyPatch, without: float) -> tuple[Any, list[Any]]:
    """A diagnosis in which an effect takes the cost from 100 to 1, and the declared model begun
    there leaves `without`.
    """
    bases: list[Any] = []

    def decide(task: Any, base: Any, trials: Any) -> Any:
        bases.append(base)
        missing = base.train.cost > 2.0
        accepted = trials[0] if missing else None
        return SimpleNamespace(
            word=EXPLAINED if missing else NOTHING_MISSING, accepted=accepted, rivals=()
        )

    monkeypatch.setattr(rounds, "fit_declared", lambda task: trial(100.0))
    monkeypatch.setattr(rounds, "scores", lambda *_: {})
    monkeypatch.setattr(rounds, "visible_candidates", lambda *_: [])
    monkeypatch.setattr(rounds, "try_candidates", lambda *_: [trial(1.0, "effect")])
    monkeypatch.setattr(rounds, "without", lambda *_: trial(without))
    monkeypatch.setattr(rounds, "continue_fits", lambda task, trials, effort: trials)
    monkeypatch.setattr(rounds, "escape", lambda task, trial: trial)
    monkeypatch.setattr(rounds, "judge", lambda task, trial: trial)
    monkeypatch.setattr(rounds, "decide", decide)
    task: Any = SimpleNamespace(progress=lambda text: None)
    return rounds.diagnose(task, ()), bases


def test_a_declared_model_that_does_as_well_from_there_takes_the_name_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found, bases = diagnosed(monkeypatch, without=1.0)
    assert [base.train.cost for base in bases] == [100.0, 1.0]
    assert found.verdict.word == NOTHING_MISSING
    assert found.base.train.cost == 1.0


def test_an_effect_that_the_declared_model_cannot_do_without_keeps_its_name(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found, bases = diagnosed(monkeypatch, without=99.0)
    assert len(bases) == 1
    assert found.verdict.word == EXPLAINED


def test_an_effect_that_a_pair_led_to_a_better_place_is_tried_with_the_others_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Alone "b" ends at 60, where the pair with "c" left it at 10, and with "a" from there at 1."""
    a, b, c = (SimpleNamespace(key=key, is_declared_value=False) for key in "abc")
    searches = iter([[trial(50.0, a), trial(60.0, b)], [trial(40.0, b, c)], [trial(1.0, a, b)]])
    begun: list[list[float]] = []

    def try_candidates(task: Any, bases: Any, candidates: Any) -> list[Any]:
        begun.append([base.train.cost for base in bases])
        return next(searches)

    def decide(task: Any, base: Any, trials: Any) -> Any:
        best = min(trials, key=lambda t: t.train.cost)
        word = EXPLAINED if best.train.cost <= 1.0 else UNEXPLAINED
        return SimpleNamespace(word=word, accepted=best if word == EXPLAINED else None, rivals=())

    monkeypatch.setattr(rounds, "fit_declared", lambda task: trial(100.0))
    monkeypatch.setattr(rounds, "scores", lambda *_: {})
    monkeypatch.setattr(rounds, "visible_candidates", lambda *_: [a, b, c])
    monkeypatch.setattr(rounds, "try_candidates", try_candidates)
    alone = {"bb": trial(70.0, c), "bc": trial(10.0, b), "aa": trial(9.0, b), "ab": trial(50.0, a)}
    monkeypatch.setattr(
        rounds, "without", lambda task, pair, idle, _: alone[pair.keys[0] + idle.key]
    )
    monkeypatch.setattr(rounds, "judge", lambda task, trial: trial)
    monkeypatch.setattr(rounds, "held_out_cost", lambda trial: trial.train.cost)
    monkeypatch.setattr(rounds, "decide", decide)
    task: Any = SimpleNamespace(progress=lambda text: None)
    found = rounds.diagnose(task, ())
    assert begun == [[100.0], [50.0, 60.0], [10.0]]
    assert found.verdict.accepted is not None
    assert found.verdict.accepted.keys == ("a", "b")
