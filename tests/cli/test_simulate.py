"""Simulating at the command line: what comes in, what is refused, what can be fed back."""

import csv
import json
import re
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from ptp_symbolic.cli.simulate import given_signals
from ptp_symbolic.numeric.data import read_inputs, read_log
from ptp_symbolic.platform import platform_file, read_platform

IDEAL = ("simulate", "--platform", "thesis-ideal")
UNDECLARED = """[platform]
name = "bare"
axes = ["pan", "tilt"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "payload"
"""
DECLARED = """[parameters]
J_pan = { value = 0.1 }
J_x_tilt = { value = 0.1 }
J_y_tilt = { value = 0.1 }
J_z_tilt = { value = 0.1 }
m_payload = { value = 2.0 }
J_x_payload = { value = 0.01 }
J_y_payload = { value = 0.01 }
J_z_payload = { value = 0.01 }
c_x_payload = { value = 0.1 }
"""


def columns(path: Path) -> dict[str, np.ndarray]:
    with path.open(encoding="utf-8", newline="") as file:
        head, *rows = list(csv.reader(file))
    return dict(zip(head, np.array(rows, dtype=float).T, strict=True))


def test_a_trajectory_is_a_log_of_its_platform(call, tmp_path: Path) -> None:
    given = ("--input", "tau_pan=step:0.2@0.1", "--initial", "theta_tilt=0.3")
    first = tmp_path / "first"
    done = call(*IDEAL, *given, "--duration", 0.5, "--every", 0.002, "--plot", "--out", first)
    assert (done.code, done.err) == (0, "")
    assert (first / "trajectory.png").read_bytes().startswith(b"\x89PNG")
    found = columns(first / "trajectory.csv")
    assert len(found["time [s]"]) == 251
    assert found["theta_tilt [rad]"][0] == 0.3
    assert np.array_equal(found["pan_torque [N m]"], 0.2 * (found["time [s]"] >= 0.1))
    assert np.array_equal(found["tilt_angle [rad]"], found["theta_tilt [rad]"])

    log = read_log(first / "trajectory.csv", read_platform("thesis-ideal"))
    assert np.array_equal(log.outputs[:, 0], found["theta_pan [rad]"])
    again = ("--input", first / "trajectory.csv", "--initial", "theta_tilt=0.3")
    call(*IDEAL, *again, "--every", 0.002, "--out", tmp_path / "again")
    second = columns(tmp_path / "again" / "trajectory.csv")
    assert list(second) == list(found)
    for name, values in found.items():
        assert second[name] == pytest.approx(values, rel=1e-6, abs=1e-8), name


def test_a_trajectory_is_a_log_of_raw_and_late_columns(call, tmp_path: Path) -> None:
    text = platform_file("thesis-ideal").read_text(encoding="utf-8")
    for column, more in (
        ("pan_torque", 'scale = 1e-3\noffset = 512\ndelay = "30 ms"'),
        ("pan_angle", 'scale = -1e-4\ndelay = "20 ms"'),
        ("tilt_angle", 'offset = 0.25\ndelay = "20 ms"'),
    ):
        at = f'column = "{column}"'
        assert at in text
        text = text.replace(at, f"{at}\n{more}")
    path = tmp_path / "raw.toml"
    path.write_text(text, encoding="utf-8")
    given = ("--input", "tau_pan=step:0.2@0.1", "--initial", "theta_tilt=0.3")
    ends = ("--duration", 0.5, "--every", 0.01, "--out", tmp_path)
    assert call("simulate", "--platform", path, *given, *ends).code == 0
    found = columns(tmp_path / "trajectory.csv")
    time, theta = found["time [s]"], found["theta_pan [rad]"]
    assert found["pan_torque [1]"] == pytest.approx(512 + 200 * (time >= 0.07 - 1e-9))
    assert found["pan_angle [1]"][2:] == pytest.approx(-1e4 * theta[:-2])
    assert found["tilt_angle [rad]"][0] == pytest.approx(0.55)
    log = read_log(tmp_path / "trajectory.csv", read_platform(path))
    assert log.inputs[:, 0] == pytest.approx(0.2 * (log.time >= 0.1 - 1e-9))
    assert log.outputs[:, 0] == pytest.approx(np.interp(log.time, time, theta), abs=1e-12)


def test_without_a_platform_of_signals_inputs_have_the_names_of_the_model(
    call, tmp_path: Path
) -> None:
    path = tmp_path / "bare.toml"
    path.write_text(UNDECLARED + DECLARED, encoding="utf-8")
    done = call("simulate", "--platform", path, "--duration", 0.01, "--out", tmp_path / "out")
    assert done.code == 0
    assert "tau_tilt [N m]" in columns(tmp_path / "out" / "trajectory.csv")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--duration", "1e9"), "1e+12 samples, at most 5000000 are allowed; shorten the duration"),
        (("--step", "1e-3"), "--step 0.001 is for --method fixed_step alone; add that, or leave"),
        (("--step", "1e-3", "--method", "rosenbrock"), "--step 0.001 is for --method fixed_step"),
        (("--every", "0"), "Output every 0 s; give a positive number of seconds"),
        (
            ("--initial", "theta_pan=high"),
            "Initial state 'theta_pan' = 'high'; write a number, or a",
        ),
        (("--initial", "omega_pan"), "Initial state 'omega_pan' = ''; write a number, or a"),
        (("--initial", "omega_pan=nan"), "Initial state 'omega_pan' = 'nan'; write a number"),
        (("--initial", "teta_pan=1"), "Unknown state 'teta_pan': did you mean 'theta_pan'?"),
        (("--input", "tau_pam=step:1@0"), "Unknown input 'tau_pam': did you mean 'tau_pan'?"),
        (("--input", "tau_pan=step:nan@0.5"), "nan is no finite number; use one of constant:3"),
    ],
)
def test_refusals(call, tmp_path: Path, arguments: tuple[str, ...], message: str) -> None:
    done = call(*IDEAL, *arguments, "--out", tmp_path / "out")
    assert done.code == 2
    assert message in done.err
    assert done.err.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_the_help_lists_every_profile(call) -> None:
    for command in ("simulate", "sensitivity"):
        text = call(command, "--help").out
        for form in ("step:24@0.5", "ramp:0..24@0..10", "trapezoid:24,0.5,2.5,0.5", "multisine:"):
            assert form in text


def test_sensitivities_carry_units(call, tmp_path: Path) -> None:
    wanted = ("--by", "b_pan", "--by-initial", "theta_tilt", "--duration", "0.01")
    call("sensitivity", "--platform", "ideal", *wanted, "--out", tmp_path)
    heads = list(columns(tmp_path / "sensitivity.csv"))
    assert heads[:3] == [
        "time [s]",
        "d theta_pan / d b_pan [rad/(N m s/rad)]",
        "d theta_pan / d theta_tilt [1]",
    ]


def test_inputs_are_written_as_they_are_held(call, tmp_path: Path) -> None:
    call(*IDEAL, "--input", "tau_tilt=ramp:0..1@0..0.1", "--duration", 0.1, "--out", tmp_path)
    time, inputs = read_inputs(tmp_path / "trajectory.csv", read_platform("thesis-ideal"))
    assert inputs[:, 1] == pytest.approx(10.0 * time)


def test_all_natural_defaults_in_use_are_named(call, tmp_path: Path) -> None:
    path = tmp_path / "bare.toml"
    cogging = '[[effects]]\neffect = "cogging"\naxis = "pan"\n'
    text = UNDECLARED + cogging + DECLARED + "n_cog_pan = { value = 24 }\n"
    path.write_text(text, encoding="utf-8")
    done = call("simulate", "--platform", path, "--duration", 0.01, "--out", tmp_path / "out")
    assert done.code == 0
    waves = [f"T_{part}{order}_pan = 0 N m" for order in ("", 2, 3) for part in ("sin", "cos")]
    named = ["c_y_payload = 0 m", "c_z_payload = 0 m", *waves]
    left = done.err.removeprefix("Not declared, at their natural default: ").rstrip(".\n")
    assert set(left.split(", ")) == set(named)


@pytest.mark.parametrize("command", [["simulate"], ["report", "derivation"], ["regenerate"]])
def test_what_has_no_natural_default_is_missing(call, tmp_path: Path, command: list[str]) -> None:
    path, out = tmp_path / "bare.toml", tmp_path / "out"
    path.write_text(UNDECLARED, encoding="utf-8")
    source = [path] if command == ["regenerate"] else ["--platform", path]
    done = call(*command, *source, "--out", out)
    assert done.code == 2
    assert done.err.startswith(f"ptp-symbolic: {path}: Not declared, and without a natural default")
    assert done.err.count("\n") == 1
    for inertia in ("J_pan", "J_x_tilt", "J_y_tilt", "J_z_tilt", "J_x_payload", "J_z_payload"):
        assert f"{inertia} in kg m^2 (" in done.err
    assert "m_payload in kg (" in done.err and "c_x_payload in m (" in done.err
    assert "c_y_payload" not in done.err
    assert 'J_pan = { value = NUMBER, unit = "kg m^2" }' in done.err
    assert not out.exists()


def test_the_entry_that_a_refusal_asks_for_is_accepted(call, tmp_path: Path) -> None:
    path, out = tmp_path / "bare.toml", tmp_path / "out"
    text = '[platform]\nname = "bare"\naxes = ["pan"]\n[[effects]]\neffect = "rigid_bodies"\n'
    path.write_text(text, encoding="utf-8")
    run = ("simulate", "--platform", path, "--duration", 0.01, "--out", out)
    (entry,) = re.findall(r"as in (J_pan = \{.*?\})", call(*run).err)
    path.write_text(f"{text}[parameters]\n{entry.replace('NUMBER', '0.2')}\n", encoding="utf-8")
    assert call(*run).code == 0


def test_no_number_of_a_machine_is_a_default_of_the_catalogue(call) -> None:
    for effect, own in (("dc_motor", "R_<axis>"), ("csvs_friction", "F_c_<axis>")):
        kinds = json.loads(call("effects", effect, "--json").out)["kinds"]
        defaults = {p["name"]: p["default"] for p in kinds[0]["parameters"]}
        assert defaults[own] is None
    kinds = json.loads(call("effects", "cable_spring", "--json").out)["kinds"]
    assert [p["default"] for p in kinds[0]["parameters"]] == [0.0, 0.0, 0.0]


def test_a_column_with_the_name_of_an_energy_is_refused(call, tmp_path: Path) -> None:
    text = platform_file("thesis-ideal").read_text(encoding="utf-8")
    path = tmp_path / "stored.toml"
    path.write_text(text.replace("pan_angle", "stored"), encoding="utf-8")
    done = call("simulate", "--platform", path, "--duration", 0.01, "--out", tmp_path / "out")
    assert done.code == 2
    assert "Column 'stored' of theta_pan has the name of an energy in J; declare it" in done.err
    assert not (tmp_path / "out").exists()


def test_an_angle_of_several_turns_is_pointed_out_unless_it_has_a_unit(
    call, tmp_path: Path
) -> None:
    """A joint may have turned as often, so it is no error; degrees without their unit are one."""
    given = ("simulate", "--platform", "ideal", "--duration", "0.01", "--out", tmp_path)
    done = call(*given, "--initial", "theta_pan=3000")
    assert done.code == 0
    said = "Note: theta_pan starts at 3000 rad, 477 turns; write degrees as 'theta_pan=3000 deg'."
    assert said in done.err
    for own in ("theta_pan=3000 deg", "theta_pan=0.3", "omega_pan=40"):
        assert "Note" not in call(*given, "--initial", own).err
    columns = (tmp_path / "trajectory.csv").read_text(encoding="utf-8").splitlines()[1].split(",")
    assert float(columns[1]) == 0.0
    call(*given, "--initial", "theta_pan=30 deg")
    columns = (tmp_path / "trajectory.csv").read_text(encoding="utf-8").splitlines()[1].split(",")
    assert abs(float(columns[1]) - 0.5235987755982988) < 1e-15


def test_a_set_point_of_several_turns_is_pointed_out(capsys: pytest.CaptureFixture[str]) -> None:
    servo = SimpleNamespace(input_names=("setpoint_pan",), units={"setpoint_pan": "rad"})
    platform = read_platform("thesis-pan-servo")
    given_signals(platform, servo, ("setpoint_pan=step:30@0.001",), 1.0)
    said = "setpoint_pan goes to 30 rad, 4.77 turns; a profile is in rad, not in deg."
    assert said in capsys.readouterr().err
    given_signals(platform, servo, ("setpoint_pan=step:0.3@0.001",), 1.0)
    assert capsys.readouterr().err == ""
