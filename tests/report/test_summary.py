"""What a diagnosis says in words and tests, from trials with known numbers."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.diagnose import summary
from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.curves import curves_of
from ptp_symbolic.diagnose.residual_tests import residual_tests
from ptp_symbolic.diagnose.verdict import EXPLAINED
from ptp_symbolic.identify.coordinates import free_parameter

DECLARED = 6.5e-4


def _candidate(identity: str, *starts: float) -> Candidate:
    free = tuple((free_parameter("J_y_tilt", start, 0.0, 1.0),) for start in starts)
    return Candidate(identity, None, "a cause", "an experiment", free)


def _trial(candidate: Candidate, value: float) -> Any:
    parameter = SimpleNamespace(name="J_y_tilt", meaning="inertia of the tilt body about y")
    model = SimpleNamespace(parameters=(parameter,), units={"J_y_tilt": "kg m^2"})
    train = SimpleNamespace(values={"J_y_tilt": value}, model=model, free=candidate.starts[0])
    validate = SimpleNamespace(pairs=list)
    return SimpleNamespace(candidates=(candidate,), train=train, validate=validate, keys=())


def _headline(monkeypatch: pytest.MonkeyPatch, candidate: Candidate, value: float) -> str:
    trial = _trial(candidate, value)
    monkeypatch.setattr(summary, "held_out_cost", lambda _: 0.25)
    verdict = SimpleNamespace(word=EXPLAINED, accepted=trial, rivals=(), floor=0.3)
    found: Any = SimpleNamespace(base=trial, verdict=verdict)
    return summary.headline(found)


@pytest.mark.parametrize(
    ("share", "words", "small"),
    [(-7e-5, "wrong by -0.007 %", True), (0.034, "wrong by +3.4 %", False),
     (0.5, "wrong by +50.0 %", False), (0.0099, "wrong by +0.99 %", True)],
)  # fmt: skip
def test_a_declared_value_is_wrong_by_so_many_percent(
    monkeypatch: pytest.MonkeyPatch, share: float, words: str, small: bool
) -> None:
    candidate = _candidate("declared_value:J_y_tilt", DECLARED)
    text = _headline(monkeypatch, candidate, DECLARED * (1.0 + share))
    assert text.startswith(f"Declared value of J_y_tilt is {words} (inertia of the tilt body")
    assert ("statistically clear but small" in text) == small


def test_an_effect_is_called_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    text = _headline(monkeypatch, _candidate("cable_spring", 0.1), DECLARED)
    assert text == "Missing: a cause; validation error 0.500 to 0.500 counts rms."


@pytest.mark.parametrize(("starts", "shown"), [((0.1,), 0.1), ((0.1, 0.2), None)])
def test_the_start_of_an_added_parameter_is_where_its_search_began(
    starts: tuple[float, ...], shown: float | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    trial = _trial(_candidate("cable_spring", *starts), 0.3)
    estimate = SimpleNamespace(name="J_y_tilt", value=0.3, lower=0.2, upper=0.4, at_bound=False,
                               identified=True, only_with=())  # fmt: skip
    monkeypatch.setattr(summary, "estimates", lambda _: (estimate,))
    row = summary.fit_table(trial)["J_y_tilt"]
    assert row["start"] == shown
    assert row["meaning"] == "inertia of the tilt body about y"


def _validated(left: np.ndarray, inputs: np.ndarray) -> Any:
    """Two windows with encoder residuals `left` [k, 2] in counts."""
    pairs = []
    for begin in (0.0, 4.0):
        run = SimpleNamespace(
            name="run#1", time=begin + np.linspace(0.0, 4.0, len(left)), held_inputs=inputs,
            measured=left, outputs=np.array([0, 1]), weight=np.ones(2), counts=np.ones(2),
            signals=("theta_pan", "theta_tilt"),
        )  # fmt: skip
        pairs.append((run, SimpleNamespace(residual=left.ravel(), outputs=0.0 * left)))
    fit = SimpleNamespace(runs=[pairs[0][0]], pairs=lambda: pairs, model=SimpleNamespace(
        units={"theta_pan": "rad", "theta_tilt": "rad"}))  # fmt: skip
    return SimpleNamespace(train=fit, validate=fit)


def test_every_signal_is_tested_against_every_input() -> None:
    noise = np.random.default_rng(1).standard_normal((4000, 4))
    left, inputs = noise[:, :2].copy(), noise[:, 2:]
    left[:, 1] += 0.5 * inputs[:, 0]
    rows = residual_tests(_validated(left, inputs), ("tau_pan", "tau_tilt"))
    found = {(row["signal"], row["name"]): row["passed"] for row in rows}
    assert len(found) == 6
    assert not found["theta_tilt", "independence of tau_pan"]
    assert found["theta_tilt", "whiteness"]


def test_the_curves_of_a_run_carry_the_borders_of_its_windows() -> None:
    trial = _validated(np.zeros((200, 2)), np.zeros((200, 2)))
    for curve in curves_of(trial, trial).values():
        assert curve["borders"] == [4.0]
        assert curve["signals"]["theta_tilt"]["unit"] == "rad"
