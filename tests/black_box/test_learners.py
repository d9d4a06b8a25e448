"""Rivals without physics: they learn what depends on the motion, and nothing from noise."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.black_box import AxisRows, compared, folds_of, learn
from ptp_symbolic.workflows.diagnosis import diagnose_platform

pytest.importorskip("sklearn")

NAMES = ("theta_pan", "omega_pan", "u_pan")
RUNS = [f"run {k}" for k in range(5)]
Law = Callable[[np.ndarray, np.ndarray, np.ndarray], np.ndarray]


def rows(law: Law, noise: float, seed: int, runs: int = 5) -> AxisRows:
    """Runs of a joint that swings at its own pace, with the torque of a law on top of noise."""
    rng = np.random.default_rng(seed)
    phase = np.linspace(0.0, 6.0, 60)[None, :] * rng.uniform(0.7, 1.3, runs)[:, None]
    angle, rate = np.sin(phase), np.cos(phase)
    given = np.sin(2.3 * phase + rng.uniform(0.0, 6.0, runs)[:, None])
    seen = np.column_stack([angle.ravel(), rate.ravel(), given.ravel()])
    torque = law(*seen.T) + noise * rng.standard_normal(len(seen))
    run = np.repeat(np.arange(runs), 60)
    return AxisRows(NAMES, (1,), seen, run, torque, noise * rng.standard_normal(len(seen)))


def test_a_law_of_motion_is_learned_and_a_sparse_formula_shows_it() -> None:
    """Dry friction that grows with the angle, and drag: 0.8 theta sign(omega) + 0.5 omega^2."""

    def law(theta: np.ndarray, omega: np.ndarray, _: np.ndarray) -> np.ndarray:
        return 0.8 * theta * np.sign(omega) + 0.5 * omega**2

    train, validate = rows(law, 0.02, 1), rows(law, 0.02, 2)
    found = compared(train, validate, RUNS, "2 parameters", learn(train))
    models = found["models"]
    assert models["declared"]["validate"]["share"] == 0.0
    assert models["sparse"]["validate"]["rms"] < 0.03
    assert models["network"]["validate"]["rms"] < 0.1
    assert models["named"]["validate"]["rms"] == pytest.approx(0.02, rel=0.1)
    # the terms are in what was centred and scaled: the products show without their units
    scale = dict(zip(NAMES, train.seen.std(axis=0), strict=True))
    assert found["terms"]["theta_pan sign(omega_pan)"] / scale["theta_pan"] == pytest.approx(
        0.8, rel=0.1
    )
    assert found["terms"]["omega_pan^2"] / scale["omega_pan"] ** 2 == pytest.approx(0.5, rel=0.1)
    strongest = sorted(found["terms"], key=lambda name: -abs(found["terms"][name]))
    assert {"theta_pan sign(omega_pan)", "omega_pan^2"} <= set(strongest[:3])


def test_noise_teaches_nothing() -> None:
    train, validate = (rows(lambda *_: np.zeros(300), 0.1, seed) for seed in (3, 4))
    models = compared(train, validate, RUNS, None, learn(train))["models"]
    assert "named" not in models
    for rival in ("sparse", "network"):
        assert abs(models[rival]["validate"]["share"]) < 0.05


def test_blocks_that_are_left_out_are_whole_runs_or_pieces_of_the_few_there_are() -> None:
    many = np.repeat(np.arange(7), 30)
    for _, left_out in folds_of(many):
        assert len(set(many[left_out])) == 1 and len(left_out) == 30
    for learned, left_out in folds_of(np.zeros(100, dtype=np.int64)):
        assert np.all(np.diff(left_out) == 1) and len(left_out) == 20
        assert not set(learned) & set(left_out)


def test_without_the_library_the_extra_is_named_before_any_log_is_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "sklearn", None)
    with pytest.raises(InputError, match=r"pip install 'ptp-symbolic\[black-box\]'"):
        diagnose_platform(None, [Path("none")], [Path("none")], rivals=True)  # type: ignore[arg-type]
