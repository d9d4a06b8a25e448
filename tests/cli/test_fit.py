"""Fitting at the command line: what it says, and what it writes."""

import json
import re
from pathlib import Path
from typing import Any

import pytest

from ptp_symbolic.cli.diagnose import _print_diagnosis, _print_fit
from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.fit import _what_to_check

SAMPLE = Path(__file__).parents[2] / "ptp_symbolic" / "samples" / "tilted_base"
PHASE = r"(?m)^\[ *\d+\.\d s\] .+\n"
LOG = SAMPLE / "train" / "tracking_1.csv"


def changed(folder: Path, *pairs: tuple[str, str]) -> Path:
    text = (SAMPLE / "platform.toml").read_text(encoding="utf-8")
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    path = folder / "declared.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_fit_far_from_the_floor_says_so(call, tmp_path: Path) -> None:
    out = tmp_path / "out"
    low = 'start = 0.05\nunit = "N m s/rad"\nbounds = [0.0, 5.0]\n\n[parameters.b_tilt]'
    path = changed(tmp_path, (low, low.replace("5.0]", "0.06]")))
    done = call("fit", "--platform", path, LOG, "--out", out)
    assert done.code == 0 and not re.sub(PHASE, "", done.err)
    # Rounding, 0.289 counts, and what the noise of the torques adds to it.
    far = r", noise floor (\S+): the model does not fit these logs; run diagnose"
    (floor,) = re.findall(far, done.out)
    assert 0.288 < float(floor) < 0.31
    assert "Runs were cut into 8 windows of 1 s on average, each with its own" in done.out
    assert "b_pan = 0.06 N m s/rad" in done.out

    summary = json.loads((out / "fit.json").read_text(encoding="utf-8"))
    before, after = (summary["error"][w]["total"]["rmse_counts"] for w in ("before", "after"))
    assert before > 1.05 * after
    assert f"{after:.4g} counts rms over all runs ({before:.4g} at the start values)" in done.out
    assert summary["windows"] == {"count": 8, "seconds": pytest.approx(1.0, abs=0.01)}
    assert summary["far_from_floor"] is True
    assert summary["provenance"]["command"].startswith("ptp-symbolic fit --platform ")
    assert [log["part"] for log in summary["provenance"]["logs"]] == ["fit"]

    fitted = read_platform(out / "platform.toml")
    values = {p.name: p.value for p in fitted.parameters if p.free}
    assert values["b_pan"] == 0.06
    assert values == pytest.approx({n: p["value"] for n, p in summary["parameters"].items()})
    assert fitted.effects == read_platform(path).effects


def test_nothing_to_fit_and_what_was_not_declared_are_said(call, tmp_path: Path) -> None:
    centred = '[parameters.c_y_payload]\nvalue = 0.0\nunit = "m"\n'
    path = changed(tmp_path, ("start = 0.05", "value = 0.05"), (centred, ""))
    done = call("fit", "--platform", path, "--train", LOG, "--out", tmp_path / "out")
    assert done.code == 0
    assert "Nothing is free; give a parameter 'start' in place of 'value' to fit it." in done.out
    assert done.err.endswith("Not declared, at their natural default: c_y_payload = 0 m.\n")
    summary = json.loads((tmp_path / "out" / "fit.json").read_text(encoding="utf-8"))
    assert summary["error"]["before"] == summary["error"]["after"]
    assert summary["parameters"] == {}


def test_a_log_to_fit_is_no_log_to_judge_by(call, tmp_path: Path) -> None:
    copy = tmp_path / "other_name.csv"
    copy.write_bytes(LOG.read_bytes())
    platform = ("diagnose", "--platform", SAMPLE / "platform.toml", "--train", SAMPLE / "train")
    for leak in (LOG, SAMPLE / "train", copy):
        done = call(*platform, "--validate", leak, "--out", tmp_path / "out")
        assert done.code == 2
        assert done.err.count("\n") == 1
        assert f"holds the same run as {LOG}, which is given to be fitted" in done.err
        assert not (tmp_path / "out").exists()


def diagnosis(counts: float | None, angle: float) -> dict[str, Any]:
    """What is printed of a diagnosis, the same error everywhere."""
    error = {"rmse_counts": counts, "rmse": angle}
    stage = {"total": error, "by_run": {"log": error}}
    part = {"before": stage, "after": stage, "noise_floor": stage}
    return {
        "verdict": "explained",
        "summary": "Missing: x.",
        "added": [],
        "refused": {},
        "remarks": [],
        "hints": [],
        "black_box": None,
        "windows": None,
        "fit": {"after": {"parameters": {}}},
        "error": {"definition": "root mean square", "train": part, "validate": part},
    }


@pytest.mark.parametrize(
    ("counts", "angle", "unit", "shown"),
    [(0.3, 5e-4, "counts", "0.300"), (None, 5.1234e-4, "rad", "0.000512")],
)
def test_errors_are_in_counts_or_where_there_is_no_encoder_in_rad(
    counts: float | None, angle: float, unit: str, shown: str, capsys
) -> None:
    _print_diagnosis(diagnosis(counts, angle))
    text = capsys.readouterr().out
    for part in ("train (fitted)", "validate (never fitted)"):
        assert f"{part}, {unit} rms" in text
    assert re.findall(r"^ total +(\S+)", text, re.MULTILINE) == [shown, shown]
    assert "Error: root mean square." in text


def test_errors_are_printed_with_the_windows_that_they_were_taken_over(capsys) -> None:
    """Training and validation runs may be cut differently: their errors are no pair then."""
    found = diagnosis(0.3, 5e-4)
    for part, windows in (("train", {"count": 3, "seconds": 10.0}), ("validate", None)):
        found["error"][part] = {
            when: {**stage, "windows": windows} for when, stage in found["error"][part].items()
        }
    _print_diagnosis(found)
    text = capsys.readouterr().out
    assert "train (fitted), counts rms, over 3 windows of 10 s:" in text
    assert "validate (never fitted), counts rms, over whole runs:" in text


def test_hints_are_printed(capsys) -> None:
    _print_diagnosis({**diagnosis(0.3, 5e-4), "hints": ["The residual torque steps at 10 s."]})
    assert "Hint: The residual torque steps at 10 s." in capsys.readouterr().out.splitlines()


def test_what_was_refused_and_remarks_on_the_logs_are_printed(capsys) -> None:
    refused = {"gear_eccentricity@pan": "reduces the sum of squares by 3 % only"}
    _print_diagnosis({**diagnosis(0.3, 5e-4), "refused": refused, "remarks": ["An axis rests."]})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "Note: An axis rests."
    at = lines.index("Improved the fit, but rejected:")
    assert lines[at + 1] == "  gear_eccentricity@pan: reduces the sum of squares by 3 % only"


def test_a_fit_without_an_encoder_is_reported_in_rad(capsys) -> None:
    def error(rms: float) -> dict[str, Any]:
        return {"total": {"rmse_counts": None, "rmse": rms}}

    errors = {"before": error(0.02), "after": error(5e-4), "noise_floor": error(4e-4)}
    summary = {"parameters": {}, "windows": None, "error": errors, "remarks": []}
    _print_fit({**summary, "far_from_floor": False})
    text = "0.0005 rad rms over all runs (0.02 at the start values), noise floor 0.0004."
    assert text in capsys.readouterr().out


def test_a_diagnosis_prints_what_the_logs_do_not_settle(capsys) -> None:
    def fitted(value: float, identified: bool, at_bound: bool = False) -> dict[str, object]:
        return {
            "value": value,
            "ci95": [0.0, 1.0],
            "unit": "N m",
            "identified": identified,
            "at_bound": at_bound,
        }

    parameters = {
        "b_pan": fitted(0.1, True),
        "F_c_pan": fitted(0.2, False),
        "F_s_pan": fitted(0.3, True, at_bound=True),
        "beta_base": fitted(0.07, True),
        "alpha_base": fitted(-0.6, False),
        "F_v_pan": fitted(0.4, False) | {"only_with": ["b_pan"]},
    }
    added = [
        {
            "parameters": {"beta_base": {}, "alpha_base": {}},
            "confusable_with": ["cable_spring@pan"],
            "separating_experiment": "Turn further.",
        }
    ]
    fit = {"after": {"parameters": parameters}}
    _print_diagnosis({**diagnosis(0.3, 5e-4), "added": added, "fit": fit})
    lines = capsys.readouterr().out.splitlines()
    assert "  beta_base = 0.07 N m  [0, 1]" in lines
    assert "  alpha_base = -0.6 N m  [0, 1]  (not identified)" in lines
    assert "  Experiment that separates them: Turn further." in lines
    told = lines[lines.index("Declared parameters that these logs do not identify:") + 1 :]
    assert told[0] == "  F_c_pan = 0.2 N m  [0, 1]  (not identified)"
    assert told[1] == "  F_s_pan = 0.3 N m  [0, 1]  (at its bound)"
    assert told[2] == "  F_v_pan = 0.4 N m  [0, 1]  (identifiable only together with b_pan)"
    assert not any("  b_pan" in line for line in lines)


def test_thousands_of_counts_are_first_a_matter_of_the_signals(capsys) -> None:
    """Not hundreds of a coarse encoder, nor those of a fine one that are little of the motion."""

    def error(counts: float, share: float) -> dict[str, Any]:
        percent = 100.0 * (1.0 - share)
        return {"rmse_counts": counts, "rmse": 1e-3, "unit": "rad", "fit_percent": percent}

    assert _what_to_check(error(700.0, 2.0)) == _what_to_check(error(9e5, 0.01)) == ()
    (text,) = _what_to_check(error(39_800.0, 1.39))
    assert text.startswith(
        "The residual is 3.98e+04 counts rms, 139 % of the motion: check the unit,"
    )
    errors = {w: {"total": error(4e4, 1.4)} for w in ("before", "after", "noise_floor")}
    summary = {"parameters": {}, "windows": None, "error": errors, "remarks": [text]}
    _print_fit({**summary, "far_from_floor": True})
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == f"Note: {text}"
    assert lines[-1].endswith("the model does not fit these logs; check the signals as said above.")
