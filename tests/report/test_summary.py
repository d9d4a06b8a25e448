"""What a diagnosis says in words, tables and tests, from fits with known residuals."""

from collections.abc import Mapping
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose import summary
from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.remainder import residual_tests
from ptp_symbolic.numeric.diagnose.stepwise import Tried
from ptp_symbolic.numeric.diagnose.summary import curves_of, error_of, sizes_of
from ptp_symbolic.numeric.diagnose.verdict import EXPLAINED, NOTHING_MISSING, PARTLY, UNEXPLAINED
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.intervals import Estimate
from tests.diagnose.test_subsets import BLOCKS, ROWS, rows_of, signature
from tests.identify.straight import run_of

DECLARED = 6.5e-4
COUNT = 1e-3  # rad
UNITS = {"theta_pan": "rad", "theta_tilt": "rad", "i_pan": "A", "J_y_tilt": "kg m^2"}


def _candidate(identity: str, axis: str | None = None, declared: float = 0.0) -> Candidate:
    free = free_parameter("J_y_tilt", DECLARED, 0.0, 1.0)
    return Candidate(identity, axis, "a cause", "an experiment", (free,), {"J_y_tilt": declared})


def _fit(
    left: np.ndarray,
    counts: tuple[float, ...] = (COUNT, COUNT),
    inputs: np.ndarray | None = None,
    signals: tuple[str, ...] = ("theta_pan", "theta_tilt"),
    value: float = DECLARED,
    windows: int = 2,
) -> Any:
    """Windows of 4 s of one run, with residuals `left` [k, ny] in the units of the signals, which
    have a weight of one per count.
    """
    weight = np.array([1.0 / c if np.isfinite(c) else 10.0 for c in counts])
    runs = tuple(
        replace(
            run_of(len(left), left.shape[1], inputs, f"run#{number}"),
            time=4.0 * number + np.linspace(0.0, 4.0, len(left)),
            measured=np.ones_like(left),
            weight=weight,
            counts=np.array(counts),
            signals=signals,
        )
        for number in range(windows)
    )
    residual = (left * weight).ravel()
    evaluation = SimpleNamespace(
        residual=residual,
        by_parameter=np.zeros((residual.size, 0)),
        by_start=np.zeros((residual.size, 0)),
        failed=None,
    )
    parameter = SimpleNamespace(name="J_y_tilt", meaning="inertia of the tilt body about y")
    return SimpleNamespace(
        runs=runs,
        evaluations=(evaluation,) * windows,
        cost=float(residual @ residual),
        pairs=lambda: [(run, evaluation) for run in runs],
        model=SimpleNamespace(parameters=(parameter,), units=UNITS, input_names=()),
        values={"J_y_tilt": value},
        free=(),
        failed=None,
    )


def _trial(*candidates: Candidate, value: float = DECLARED, left: float = 1.0) -> FittedModel:
    return FittedModel(candidates, _fit(np.full((20, 2), left * COUNT), value=value))


def _verdict(word: str, final: FittedModel, **more: Any) -> Any:
    usual = {
        "confusable": {},
        "closest": None,
        "alternatives": (),
        "refused": {},
        "is_along_motion": False,
    }
    return SimpleNamespace(word=word, final=final, compared=final, **{**usual, **more})


def _errors(counts: float | None = 0.5) -> dict[str, Any]:
    stage = {"total": {"rmse_counts": counts, "rmse": 5.4321e-4, "unit": "rad"}, "without": None}
    stages = {"before": stage, "after": stage, "noise_floor": stage}
    return {"train": stages, "validate": stages}


@pytest.mark.parametrize(
    ("share", "words", "small"),
    [
        (-7e-5, "wrong by -0.007 %", True),
        (0.034, "wrong by +3.4 %", False),
        (0.5, "wrong by +50.0 %", False),
        (0.0099, "wrong by +0.99 %", True),
    ],
)
def test_a_declared_value_is_wrong_by_so_many_percent(
    share: float, words: str, small: bool
) -> None:
    candidate = _candidate("declared_value:J_y_tilt", declared=DECLARED)
    trial = _trial(candidate, value=DECLARED * (1.0 + share))
    text = summary.headline(_verdict(EXPLAINED, trial), _errors(), {})
    assert text.startswith(f"Declared value of J_y_tilt is {words} (inertia of the tilt body")
    assert ("statistically significant but small" in text) == small


@pytest.mark.parametrize(("counts", "shown"), [(0.5, "0.500 counts"), (None, "0.000543 rad")])
def test_an_effect_is_called_missing(counts: float | None, shown: str) -> None:
    text = summary.headline(_verdict(EXPLAINED, _trial(_candidate("x"))), _errors(counts), {})
    assert text == f"Missing: a cause; validation error {shown} rms to {shown} rms."


def test_the_size_is_that_of_the_parameter_clearest_of_zero_in_degrees() -> None:
    """0.1 rad is 5.73 deg and ten widths from zero; 0.2 is one width."""
    free = tuple(free_parameter(name, 0.1, -1.0, 1.0) for name in ("theta_tilt", "theta_pan"))
    candidate = Candidate("x", None, "a cause", "", free, {"theta_tilt": 0.0, "theta_pan": 0.0})
    intervals = {
        "theta_tilt": Estimate("theta_tilt", 0.2, 0.1, 0.3, False, True),
        "theta_pan": Estimate("theta_pan", 0.1, 0.095, 0.105, False, True),
    }
    sizes = sizes_of(_trial(candidate), intervals)
    assert sizes == {"x": "theta_pan = 5.73 deg"}
    text = summary.headline(_verdict(EXPLAINED, _trial(candidate)), _errors(), sizes)
    assert text.startswith("Missing: a cause (theta_pan = 5.73 deg); validation error")


def test_the_size_of_a_wave_is_its_amplitude_with_its_cycles() -> None:
    """sqrt(0.3^2 + 0.4^2) = 0.5; the second harmonic is five times as clear in the other case."""
    names = ("T_sin_pan", "T_cos_pan", "T_sin2_pan", "T_cos2_pan", "n_cog_pan")
    free = tuple(free_parameter(name, 0.1, -99.0, 99.0) for name in names)
    off = dict.fromkeys(names[:4], 0.0)
    candidate = Candidate("x", "pan", "a cause", "", free, off, locked=("n_cog_pan", "angle"))
    trial = _trial(candidate)
    trial.fit.model.units = {**trial.fit.model.units, **dict.fromkeys(names, "N m"), names[4]: "1"}
    widths = {False: (0.01, 0.02, 0.1, 0.1, 1.0), True: (0.1, 0.1, 0.01, 0.01, 1.0)}
    for second, words in ((False, "amplitude = 0.5 N m"), (True, "amplitude of harmonic 2 = 0.13")):
        values = zip(names, (0.3, -0.4, 0.05, 0.12, 24.0), widths[second], strict=True)
        intervals = {n: Estimate(n, v, v - w, v + w, False, True) for n, v, w in values}
        found = sizes_of(trial, intervals)["x@pan"]
        assert found.startswith(words)
        assert found.endswith(", n_cog_pan = 24")


def test_the_headline_says_where_one_window_holds_most_of_the_error() -> None:
    """Two windows leave one count, the third 100: sqrt(10002 / 3) in all."""
    fit = _fit(np.full((20, 2), COUNT), windows=3)
    far = SimpleNamespace(
        **{**vars(fit.evaluations[0]), "residual": 100.0 * fit.evaluations[0].residual}
    )
    pairs = [*fit.pairs()[:2], (fit.runs[2], far)]
    stage = error_of(SimpleNamespace(runs=fit.runs, pairs=lambda: pairs), UNITS)
    assert stage["total"]["rmse_counts"] == pytest.approx(np.sqrt(10002.0 / 3.0))
    assert stage["without"]["run"] == "run#2"
    assert stage["without"]["rmse_counts"] == pytest.approx(1.0)
    errors = {"validate": {"before": stage, "after": stage, "noise_floor": stage}}
    text = summary.headline(_verdict(EXPLAINED, _trial(_candidate("x"))), errors, {})
    assert text.endswith("Most of that lies in run#2; the error of the others is 1.000 counts rms.")
    even = SimpleNamespace(runs=fit.runs, pairs=fit.pairs)
    assert error_of(even, UNITS)["without"] is None


def test_look_alikes_and_a_remainder_are_in_the_headline() -> None:
    alike = {"x": ("gear_eccentricity@pan", "cogging@pan"), "y": ()}
    found = _verdict(PARTLY, _trial(_candidate("x")), confusable=alike)
    text = summary.headline(found, _errors(), {})
    assert "In these logs it is indistinguishable from: gear_eccentricity@pan, cogging@pan." in text
    assert "part of the residual is unexplained" in text


def test_what_cannot_be_confirmed_is_a_hint_and_not_a_name() -> None:
    closest = _trial(_candidate("cogging", "pan"), _candidate("backlash", "tilt"))
    text = summary.headline(_verdict(UNEXPLAINED, _trial(), closest=closest), _errors(), {})
    assert text.startswith("Something is missing")
    assert "closest candidate, not confirmed: backlash@tilt + cogging@pan." in text


def test_what_is_left_where_nothing_is_missing_is_noise_or_errors_of_the_values() -> None:
    errors = _errors()
    text = summary.headline(_verdict(NOTHING_MISSING, _trial()), errors, {})
    assert text == "Nothing is missing: 0.500 counts rms on validation runs is the noise floor."
    total = {"rmse_counts": 1.0, "rmse": 1.09e-3, "unit": "rad"}
    errors["validate"]["before"] = {"total": total, "without": {"run": "waves", **total}}
    text = summary.headline(_verdict(NOTHING_MISSING, _trial()), errors, {})
    assert text == (
        "Nothing is missing: noise (0.500 counts rms) and errors of fitted values explain 1.000"
        " counts rms on validation runs. Most of that lies in waves; the error of the others"
        " is 1.000 counts rms."
    )


def test_a_declared_parameter_has_a_start_and_that_of_an_effect_has_none() -> None:
    trial = _trial(_candidate("x"))
    own = SimpleNamespace(name="J_y_tilt", declared_start=0.1)
    added = SimpleNamespace(name="i_pan", declared_start=None)
    fit: Any = trial.fit
    fit.free = (own, added)
    fit.model.parameters += (SimpleNamespace(name="i_pan", meaning="a current"),)
    found = [Estimate(name, 0.3, 0.2, np.inf, False, True) for name in ("J_y_tilt", "i_pan")]
    rows = summary.fit_table(trial, found)
    assert (rows["J_y_tilt"]["start"], rows["i_pan"]["start"]) == (0.1, None)
    assert rows["J_y_tilt"]["meaning"] == "inertia of the tilt body about y"
    assert rows["J_y_tilt"]["ci95"] == [0.2, None]


def test_the_ranking_has_every_fitted_set_by_its_error_and_the_others_after_it() -> None:
    """By itself along the motion, drag takes 0.25 of 1.25 of the squares, to 0.08; what the rows
    do not show has no figure.
    """
    first, second = _candidate("cogging", "pan"), _candidate("backlash")
    best, worse = _trial(first, left=0.5), _trial(first, second, left=0.8)
    rng = np.random.default_rng(62)
    idle = [signature(key, rng.standard_normal((ROWS, 1))) for key in ("drag", "spring")]
    rows_along = rows_of(rng, idle, {"drag": 0.5}, BLOCKS)
    search: Any = SimpleNamespace(
        declared=_trial(left=3.0),
        chosen=best,
        tried=Tried([worse, best]),
        proposals=SimpleNamespace(regression=rows_along),
    )
    refused = {"backlash": "reduces the sum of squares by 3 % only"}
    found = _verdict(EXPLAINED, best, refused=refused)
    others = (idle[0].candidate, _candidate("hidden"))
    rows = summary.ranking(search, found, (first, second, *others))
    assert [row["effect"] for row in rows] == ["cogging", "cogging + backlash", "drag", "hidden"]
    assert [row["train_error_after"] for row in rows] == pytest.approx([0.5, 0.8, None, None])
    assert [row["accepted"] for row in rows] == [True, False, False, False]
    assert rows[2]["gain_along_motion"]["share"] == pytest.approx(0.2, abs=0.08)
    assert rows[3]["gain_along_motion"] is None
    assert rows[0]["axis"] == "pan"
    assert rows[1]["why"] == "backlash reduces the sum of squares by 3 % only"
    share = rows[0]["gain"]["share"]
    assert share > rows[1]["gain"]["share"] > 0.9 and rows[2]["gain"] is None
    rows = summary.ranking(search, _verdict(UNEXPLAINED, _trial(left=3.0)), ())
    passed_by = "tried, not judged: the search went on from another set"
    assert [row["why"] for row in rows] == [passed_by] * 2


def test_the_terms_of_a_named_structure_are_accepted_with_it() -> None:
    """The final model has the structure among its effects; the search compared the terms alone."""
    term, structure = _candidate("constant_torque", "pan"), _candidate("shaft_compliance", "pan")
    terms = _trial(term, left=0.5)
    search: Any = SimpleNamespace(
        declared=_trial(left=3.0),
        chosen=terms,
        tried=Tried([]),
        proposals=SimpleNamespace(regression=None),
    )
    found = _verdict(EXPLAINED, _trial(structure, term, left=0.5))
    found.compared = terms
    (row,) = summary.ranking(search, found, (term,))
    assert row["accepted"]
    assert row["why"] == "every effect in it is significant, and no other effect improves it"


def test_errors_pool_the_angles_and_tell_every_signal_in_its_own_unit() -> None:
    left = np.tile([3.0 * COUNT, 4.0 * COUNT, 0.7], (50, 1))
    fit = _fit(left, (COUNT, COUNT, np.nan), signals=("theta_pan", "theta_tilt", "i_pan"))
    found = error_of(fit, UNITS)
    assert found["total"]["rmse_counts"] == pytest.approx(np.sqrt(12.5))
    assert found["total"]["rmse"] == pytest.approx(np.sqrt(12.5) * COUNT)
    assert found["by_run"].keys() == {"run"}
    assert found["by_signal"]["theta_tilt"]["rmse_counts"] == pytest.approx(4.0)
    assert found["by_signal"]["i_pan"] == {
        "rmse": pytest.approx(0.7),
        "unit": "A",
        "rmse_counts": None,
    }
    floor = error_of(fit, UNITS, np.array([1.0, 2.0, 1.0]))
    assert floor["by_signal"]["theta_tilt"]["rmse_counts"] == pytest.approx(2.0)
    assert floor["by_signal"]["i_pan"]["rmse"] == pytest.approx(0.1)


def test_an_angle_without_an_encoder_leaves_no_error_in_counts() -> None:
    found = error_of(_fit(np.full((50, 2), COUNT), (COUNT, np.nan)), UNITS)
    assert found["total"]["rmse_counts"] is None
    assert found["total"]["rmse"] == pytest.approx(COUNT)
    assert found["by_signal"]["theta_pan"]["rmse_counts"] == pytest.approx(1.0)


def test_every_signal_is_tested_against_every_input() -> None:
    noise = np.random.default_rng(1).standard_normal((4000, 4))
    left, inputs = noise[:, :2].copy(), noise[:, 2:]
    left[:, 1] += 0.5 * inputs[:, 0]
    rows = residual_tests(_fit(left, inputs=inputs), ("tau_pan", "tau_tilt"))
    found = {(row["signal"], row["name"]): row["passed"] for row in rows}
    assert len(found) == 6
    assert not found["theta_tilt", "independence of tau_pan"]
    assert found["theta_tilt", "whiteness"]


def test_the_curves_of_a_run_carry_the_borders_of_its_windows() -> None:
    fit = _fit(np.zeros((200, 2)))
    fit.model.input_names = ("tau_pan",)
    fit.model.units = UNITS | {"tau_pan": "N m"}
    curves: Mapping[str, Any] = curves_of({"train": (fit, fit), "validate": (fit, fit)})
    assert {name: curve["set"] for name, curve in curves.items()} == {
        "run": "train",
        "run (validate)": "validate",
    }
    for curve in curves.values():
        assert curve["run"] == "run"
        assert curve["borders"] == [4.0]
        assert len(curve["time"]) == 399
        assert curve["signals"]["theta_tilt"]["unit"] == "rad"
        assert len(curve["inputs"]["tau_pan"]["values"]) == 399
        assert curve["inputs"]["tau_pan"]["unit"] == "N m"
