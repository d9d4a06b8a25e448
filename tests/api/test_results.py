"""Fits, diagnoses, logs and experiments as objects."""

import json
import pickle
import re
from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.formats.diagnosis_file import diagnosis_schema
from ptp_symbolic.platform import read_platform
from tests.diagnose.spring_table import PLATFORM as TABLE

SAMPLE = ptp.sample("tilted_base")
PLATFORM = SAMPLE / "platform.toml"
COUNT = 2.0 * np.pi / 7200


@pytest.fixture(scope="module")
def fitted() -> ptp.FitResult:
    return ptp.fit(PLATFORM, SAMPLE / "train")


@pytest.fixture(scope="module")
def found() -> ptp.Diagnosis:
    return ptp.diagnose(PLATFORM, train=SAMPLE / "train", validate=SAMPLE / "validate")


NO_DIP = """
[platform]
name = "pan"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "csvs_friction"
axis = "pan"
[parameters]
J_pan = { value = 0.05, unit = "kg m^2" }
F_c_pan = { start = 0.2, unit = "N m" }
F_s_pan = { same_as = "F_c_pan" }
F_v_pan = { start = 0.4, unit = "N m s/rad" }
v_s_pan = { start = 0.05, unit = "rad/s" }
[signals]
tau_pan = { role = "input", column = "torque", unit = "N m" }
theta_pan = { role = "output", column = "angle", unit = "rad", counts_per_revolution = 7200 }
"""


@pytest.mark.long
def test_without_a_dip_the_stribeck_speed_is_not_determined(tmp_path: Path) -> None:
    """F_s tied to F_c: the law holds no v_s. Coulomb and viscous friction keep their intervals."""
    (tmp_path / "pan.toml").write_text(NO_DIP, encoding="utf-8")
    machine = ptp.load(tmp_path / "pan.toml")
    t = np.arange(0.0, 6.0, 0.01)
    torque = 0.9 * np.sin(0.8 * np.pi * t) * np.where(t < 3.0, 1.0, 0.6)
    truth = {"F_c_pan": 0.3, "F_s_pan": 0.3, "F_v_pan": 0.3, "v_s_pan": 0.02}
    run = machine.simulate(list(t), tau_pan=(t, torque), parameters=truth)
    angle = np.rint(run["theta_pan"] / COUNT) * COUNT
    header = "time [s],torque [N m],angle [rad]"
    rows = np.column_stack([t, torque, angle])
    np.savetxt(tmp_path / "run.csv", rows, delimiter=",", header=header, comments="")
    found = ptp.fit(tmp_path / "pan.toml", [tmp_path / "run.csv"]).parameters
    assert not found["v_s_pan"].identified
    assert found["v_s_pan"].interval == (None, None)
    for name in ("F_c_pan", "F_v_pan"):
        low, high = found[name].interval
        assert low - 1e-3 < truth[name] < high + 1e-3
        assert found[name].identified


@pytest.mark.long
def test_a_diagnosis_says_what_is_missing(found: ptp.Diagnosis) -> None:
    """The sample was made with a base that leans."""
    assert [a["effect"] for a in found.added] == ["base_tilt"]
    assert found.verdict in ("explained", "explained_up_to_group")
    assert found.ranking[0]["why"]
    (accepted,) = [row for row in found.ranking if row["accepted"]]
    assert accepted["effect"] == "base_tilt"
    for part in ("train", "validate"):
        error = found.error[part]
        assert error["after"]["total"]["rmse"] < error["before"]["total"]["rmse"]
    assert any(e.effect == "base_tilt" for e in found.platform.effects)
    assert set(found.added[0]["parameters"]) <= set(found.model.parameter_names)
    for name, parameter in found.added[0]["parameters"].items():
        estimate = found.parameters[name]
        assert estimate.value == parameter["value"] == found.model.defaults[name]
        assert estimate.interval[0] < estimate.value < estimate.interval[1]


@pytest.mark.long
def test_a_diagnosis_is_read_drawn_and_saved(found: ptp.Diagnosis, tmp_path: Path) -> None:
    assert repr(found).startswith(found.verdict)
    assert "noise floor" in found._repr_html_()
    assert len(found.plot().axes) >= 2
    assert found.report(tmp_path / "report.html").read_text().startswith("<!DOCTYPE html>")
    folder = found.save(tmp_path / "all")
    assert json.loads((folder / "diagnosis.json").read_text())["verdict"] == found.verdict
    assert read_platform(folder / "platform.toml").effects == found.platform.effects
    assert pickle.loads(pickle.dumps(found)).verdict == found.verdict


@pytest.mark.long
def test_a_diagnosis_is_what_its_schema_says(found: ptp.Diagnosis) -> None:
    """Read back from the file, and with mistakes in it."""
    jsonschema = pytest.importorskip("jsonschema", reason="jsonschema is of the extra `test`")
    validator = jsonschema.Draft7Validator(diagnosis_schema())
    summary = json.loads(json.dumps(found.summary))
    assert [error.message for error in validator.iter_errors(summary)] == []
    for wrong in (
        {**summary, "verdict": "perhaps"},
        {**summary, "mood": "good"},
        {**summary, "added": [{**summary["added"][0], "axis": "roll"}]},
        {name: value for name, value in summary.items() if name != "error"},
    ):
        assert not validator.is_valid(wrong)


def test_fitted_parameters_come_with_interval_and_unit(fitted: ptp.FitResult) -> None:
    declared = {p.name: p for p in read_platform(PLATFORM).parameters}
    assert set(fitted.parameters) == {name for name, p in declared.items() if p.free}
    for name, e in fitted.parameters.items():
        assert e.unit == fitted.model.units[name]
        assert e.start == declared[name].value
        assert fitted.model.defaults[name] == e.value
    assert fitted.error["after"]["total"]["rmse"] <= fitted.error["before"]["total"]["rmse"]


def test_a_fit_is_read_drawn_and_saved(fitted: ptp.FitResult, tmp_path: Path) -> None:
    for name in fitted.parameters:
        assert name in repr(fitted)
    runs = len(fitted.error["after"]["by_run"])
    figure = fitted.plot()
    assert len(figure.axes) % runs == 0
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels == ["measured", "before", "after"]
    folder = fitted.save(tmp_path / "fit")
    assert sorted(p.name for p in folder.iterdir()) == ["fit.json", "platform.toml"]
    assert pickle.loads(pickle.dumps(fitted)).summary == fitted.summary


def test_logs_that_were_read_are_fitted_as_their_files_are(fitted: ptp.FitResult) -> None:
    logs = [ptp.read_log(p, PLATFORM) for p in sorted((SAMPLE / "train").glob("*.csv"))]
    again = ptp.fit(ptp.load(PLATFORM), logs)
    assert {n: e.value for n, e in again.parameters.items()} == {
        n: e.value for n, e in fitted.parameters.items()
    }


def test_frames_are_logs_whatever_the_columns_of_files(
    fitted: ptp.FitResult, tmp_path: Path
) -> None:
    logs = [ptp.read_log(p, PLATFORM) for p in sorted((SAMPLE / "train").glob("*.csv"))]
    frames = [log.to_pandas() for log in logs]
    raw = re.sub(r'column = "([^"]+)"', r'column = "raw \1"', PLATFORM.read_text())
    head, signal, rest = raw.partition('role = "output"')
    scaled = tmp_path / "scaled.toml"
    scaled.write_text(f"{head}{signal}\nscale = -0.125\noffset = 3.0{rest}")
    for platform in (PLATFORM, scaled):
        again = ptp.fit(platform, frames)
        assert list(again.error["after"]["by_run"]) == ["frame_1", "frame_2"]
        for name, known in fitted.parameters.items():
            low, high = known.interval
            assert again.parameters[name].value == pytest.approx(
                known.value, abs=1e-3 * (high - low)
            )
    with pytest.raises(ptp.InputError, match="name columns in SI theta_pan"):
        ptp.fit(PLATFORM, frames[0].drop(columns="theta_pan"))


def test_a_log_hands_out_its_signals() -> None:
    path = sorted((SAMPLE / "train").glob("*.csv"))[0]
    log = ptp.read_log(path, PLATFORM)
    head, *rows = path.read_text().splitlines()
    assert len(log.time) == len(rows)
    assert set(log.columns) == {s.signal for s in read_platform(PLATFORM).signals}
    assert log["theta_pan"].shape == log.time.shape
    with pytest.raises(KeyError, match="Unknown signal 'theta_pin': did you mean 'theta_pan'"):
        log["theta_pin"]
    assert log.name in repr(log)
    assert log.plot("theta_pan").axes[0].get_ylabel() == "rad"
    again = pickle.loads(pickle.dumps(log))
    assert np.array_equal(again["theta_pan"], log["theta_pan"])
    assert head


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ptp.fit("nope", []), "Unknown platform 'nope'"),
        (lambda: ptp.fit(PLATFORM, []), "No log is given"),
        (
            lambda: ptp.diagnose(PLATFORM, SAMPLE / "train", SAMPLE / "validate", time_limit=0.0),
            "`time_limit`: 0 s is no time",
        ),
        (
            lambda: ptp.diagnose(PLATFORM, SAMPLE / "train", SAMPLE / "train"),
            "give others to `validate`",
        ),
        (lambda: ptp.experiment(PLATFORM), "either `between` two effects or more"),
        (
            lambda: ptp.experiment("payload", parameters=["J_pan"], limits={"tau_pan": "1 N m"}),
            "Unknown free parameter 'J_pan'",
        ),
        (lambda: ptp.friction_map("points.csv", confidence=1.5), "`confidence` 1.5: give at least"),
        (lambda: ptp.sample("nope"), "Unknown sample 'nope'. Choose one of: tilted_base"),
        (lambda: ptp.load("payload").simulate(), "Say how long to simulate"),
    ],
)
def test_messages_speak_of_arguments_and_not_of_options(call: object, message: str) -> None:
    with pytest.raises(ptp.InputError, match=message) as wrong:
        call()  # type: ignore[operator]
    assert "--" not in str(wrong.value)
    assert "\n" not in str(wrong.value)


def test_the_point_map_of_coulomb_and_viscous_friction_is_named(tmp_path: Path) -> None:
    points = tmp_path / "points.csv"
    noise = (1e-4, -2e-4, 1e-4, 2e-4, -1e-4, -1e-4)
    rows = [f"{w},{0.2 + 0.05 * w + e}" for w, e in zip((1, 2, 3, 4, 5, 6), noise, strict=True)]
    points.write_text("\n".join(["rate [rad/s],torque [N m]", *rows]))
    found = ptp.friction_map(points)
    assert found.parameters["F_v_pan"]["value"] == pytest.approx(0.05, abs=5e-4)
    assert found.parameters["F_c_pan"]["value"] == pytest.approx(0.2, abs=2e-3)
    assert sorted(p.name for p in found.save(tmp_path / "out").iterdir()) == [
        "friction.json",
        "friction.png",
        "friction.toml",
    ]


def test_an_experiment_is_an_input_within_its_limits(tmp_path: Path) -> None:
    source = tmp_path / "table.toml"
    source.write_text(TABLE)
    found = ptp.experiment(
        source,
        parameters=["b_pan"],
        limits={"tau_pan": "300 mN m", "theta_pan": "-20..30 deg"},
        duration=3.0,
        period=0.01,
        tries=60,
        initial={"theta_pan": "5 deg"},
    )
    given = found.input["signals"]["tau_pan"]
    assert -0.3 <= given["lowest"] < given["highest"] <= 0.3
    assert found.input["initial"]["theta_pan"] == pytest.approx(0.0872664626)
    assert "tau_pan" in repr(found)
    folder = found.save(tmp_path / "next")
    run = ptp.simulate(
        source, inputs=folder / "input.csv", x0={"theta_pan": "5 deg"}, largest_step=0.01
    )
    assert np.degrees(run["theta_pan"]).max() <= 30.0
    assert np.degrees(run["theta_pan"]).min() >= -20.0
    assert run.t[-1] == pytest.approx(3.0)
