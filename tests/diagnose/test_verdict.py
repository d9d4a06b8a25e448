"""The verdict, as a table of errors on held-out runs in counts; the floor is 0.29."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.diagnose import scores, verdict
from ptp_symbolic.diagnose.verdict import EXPLAINED, NOTHING_MISSING, PARTLY, UNEXPLAINED

FLOOR = 0.29
TASK: Any = SimpleNamespace()


def trial(rms: float, *keys: str) -> Any:
    judged = SimpleNamespace(pairs=lambda: rms, failed=None)
    return SimpleNamespace(
        candidates=keys, keys=keys, validate=judged, train=SimpleNamespace(free=keys)
    )


@pytest.mark.parametrize(
    ("before", "after", "improved", "word"),
    [
        (31.0, 0.29, 1.0, EXPLAINED),
        (31.0, 0.40, 1.0, EXPLAINED),
        (0.40, 0.30, 0.9, EXPLAINED),
        (0.280, 0.247, 1.0, EXPLAINED),  # a joint at rest is known better than the floor
        (0.280, 0.275, 1.0, NOTHING_MISSING),
        (0.280, 0.247, 0.7, NOTHING_MISSING),
        (1.00, 0.55, 1.0, PARTLY),
        (31.0, 0.70, 1.0, UNEXPLAINED),
        (31.0, 0.29, 0.7, UNEXPLAINED),
        (0.40, 0.379, 1.0, UNEXPLAINED),
    ],
)
def test_word(
    monkeypatch: pytest.MonkeyPatch, before: float, after: float, improved: float, word: str
) -> None:
    monkeypatch.setattr(scores, "mean_square", lambda rms: rms**2)
    monkeypatch.setattr(verdict, "held_out_cost", lambda t: t.validate.pairs() ** 2)
    monkeypatch.setattr(verdict, "share_improved", lambda *_: improved)
    monkeypatch.setattr(verdict, "_noise_floor", lambda *_: FLOOR)
    monkeypatch.setattr(verdict, "_away_from_zero", lambda *_: True)
    found = verdict.decide(TASK, trial(before), [trial(after, "effect")])
    assert found.word == word
    assert (found.accepted is None) == (word in (NOTHING_MISSING, UNEXPLAINED))


@pytest.mark.parametrize(
    ("lower", "upper", "only_with", "without", "away"),
    [
        (0.9, 1.1, (), 5.0, True),
        (-0.1, 1.1, (), 5.0, False),
        (4.0e-12, 4.4e-12, (), 1.0, False),  # the logarithm of nothing has an interval too
        (0.0, 50.0, ("b",), 5.0, True),  # a declared friction stands in for a part of it
        (0.0, 50.0, ("b",), 1.0, False),
        (0.0, 50.0, ("c",), 5.0, False),
        (0.0, 50.0, ("d",), 5.0, False),  # the other effect of the pair stands in for it
    ],
)
def test_an_effect_is_away_from_zero_where_it_is_felt(
    monkeypatch: pytest.MonkeyPatch, lower: float, upper: float, only_with: tuple[str, ...],
    without: float, away: bool,
) -> None:  # fmt: skip
    """`without`: sum of squares with the effect switched off, 1 with it."""
    model = SimpleNamespace(parameters=[SimpleNamespace(name=n, vanishes=0.0) for n in "cd"])
    pair = tuple(SimpleNamespace(is_declared_value=False, parameters=(n,)) for n in "cd")
    fitted: Any = SimpleNamespace(train=SimpleNamespace(model=model), candidates=pair)

    def simulated(task: Any, fit: Any, values: Any) -> list[Any]:
        return [SimpleNamespace(failed=None, residual=np.sqrt([without if values else 1.0]))]

    interval = SimpleNamespace(name="c", lower=lower, upper=upper, only_with=only_with)
    other = SimpleNamespace(name="d", lower=0.9, upper=1.1, only_with=())
    monkeypatch.setattr(verdict, "estimates", lambda _: (interval, other))
    monkeypatch.setattr(verdict, "simulated", simulated)
    assert verdict._away_from_zero(TASK, fitted) == away
