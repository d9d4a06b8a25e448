"""The rounds: an effect earns nothing where it only led the declared model out of a bad place."""

from types import SimpleNamespace
from typing import Any

import pytest

from ptp_symbolic.diagnose import rounds
from ptp_symbolic.diagnose.verdict import EXPLAINED, NOTHING_MISSING


def trial(cost: float, *candidates: str) -> Any:
    train = SimpleNamespace(cost=cost, failed=None, rms_counts=lambda: cost)
    return SimpleNamespace(train=train, validate=None, candidates=candidates, keys=candidates)


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
