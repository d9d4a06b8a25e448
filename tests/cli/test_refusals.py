"""What the user gets wrong: one line, exit code 2, nothing written.

Most is asked of the command line in this process; what libraries may print is looked for in others.
"""

import subprocess
import sys
from pathlib import Path

import pytest

from ptp_symbolic.cli.commands import commands, in_options
from tests.cli.conftest import Call, Done

SAMPLE = Path(__file__).parents[2] / "ptp_symbolic" / "samples" / "tilted_base"
CODE = "import sys; from ptp_symbolic.cli import main; sys.argv[0] = 'ptp-symbolic'; main()"


def apart(*arguments: object) -> Done:
    """What `call` does, in a process of its own."""
    command = [sys.executable, "-c", CODE, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return Done(done.returncode, done.stdout, done.stderr)


def refused(call: Call, *arguments: str) -> str:
    done = call(*arguments)
    assert done.code == 2, done.err
    assert done.err.count("\n") == 1, done.err
    return done.err


def changed_platform(folder: Path, old: str, new: str) -> str:
    text = (SAMPLE / "platform.toml").read_text(encoding="utf-8")
    assert old in text
    path = folder / "platform.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    return str(path)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('effect = "payload"', 'effect = "paylod"', "Unknown effect 'paylod'"),
        ('effect = "payload"', 'effect = "payload"\naxis = "roll"', "roll"),
        ('axes = ["pan", "tilt"]', 'axes = ["pan", "tilt"', "platform.toml"),
        ("value = 4.992", "value = nan", "nan"),
        ("value = 4.992", "value = -4.992", "m_payload"),
        ('unit = "kg"', 'unit = "m"', "m_payload"),
    ],
)
def test_platforms(call, tmp_path: Path, old: str, new: str, expected: str) -> None:
    platform, out = changed_platform(tmp_path, old, new), tmp_path / "out"
    logs = ("--train", str(SAMPLE / "train"), "--validate", str(SAMPLE / "validate"))
    arguments = ("diagnose", "--platform", platform, *logs, "--out", str(out))
    assert expected in refused(call, *arguments)
    assert not out.exists()


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("", "empty"),
        ("time [s],tau [N*m]\n0,1\n", "pan"),
        ("\x00\x01", "text"),
    ],
)
def test_logs(call, tmp_path: Path, content: str, expected: str) -> None:
    assert expected in log_refused(call, tmp_path, content)


def test_a_log_in_a_process_of_its_own(tmp_path: Path) -> None:
    assert "empty" in log_refused(apart, tmp_path, "")


def log_refused(call: Call, tmp_path: Path, content: str) -> str:
    log, out = tmp_path / "log.csv", tmp_path / "out"
    log.write_text(content, encoding="utf-8")
    platform = str(SAMPLE / "platform.toml")
    arguments = ("diagnose", "--platform", platform, "--train", str(log), "--validate", str(log))
    said = refused(call, *arguments, "--out", str(out))
    assert not out.exists()
    return said


@pytest.mark.parametrize("limit", ["0", "-3", "nan"])
@pytest.mark.parametrize(("option", "said"), [("--time-limit", " s is no time"), ("--effort", "")])
def test_a_limit_that_is_none(call, tmp_path: Path, limit: str, option: str, said: str) -> None:
    out = tmp_path / "out"
    logs = ("--train", str(SAMPLE / "train"), "--validate", str(SAMPLE / "validate"))
    arguments = ("--platform", str(SAMPLE / "platform.toml"), *logs, "--out", str(out))
    words = refused(call, "diagnose", *arguments, option, limit)
    assert f"{option}: {limit}{said}" in words and "such as" in words
    assert not out.exists()


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        ('role = "output"', 'role = "input"', "has no output signal to compare with"),
        ("counts_per_revolution = 7200", "", "has neither counts_per_revolution nor noise"),
    ],
)
def test_signals_that_cannot_be_compared_name_the_file(
    call, tmp_path: Path, old: str, new: str, wanted: str
) -> None:
    platform = tmp_path / "platform.toml"
    text = (SAMPLE / "platform.toml").read_text(encoding="utf-8")
    platform.write_text(text.replace(old, new), encoding="utf-8")
    done = call("fit", "--platform", platform, SAMPLE / "train", "--out", tmp_path / "out")
    assert done.code == 2
    told = done.err.splitlines()[-1]  # after phases, on a machine that is slow
    assert told.startswith(f"ptp-symbolic: {platform}: ") and wanted in told


@pytest.mark.parametrize("command", ["simulate", "fit"])
def test_unknown_signals_get_the_nearest(call, tmp_path: Path, command: str) -> None:
    logs = [str(SAMPLE / "train")] if command == "fit" else []
    for old, new, wanted in (
        (
            "[signals.tau_pan]",
            "[signals.tau_pam]",
            "input signal 'tau_pam': did you mean 'tau_pan'",
        ),
        (
            "[signals.theta_tilt]",
            "[signals.theta_tlt]",
            "signal 'theta_tlt': did you mean 'theta_t",
        ),
    ):
        platform = changed_platform(tmp_path, old, new)
        done = call(command, "--platform", platform, *logs, "--out", tmp_path / "out")
        assert done.code == 2
        assert f"{platform}: Unknown " in done.err and wanted in done.err


def test_output_that_cannot_be_written(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("", encoding="utf-8")
    arguments = ("simulate", "--platform", "thesis-ideal", "--duration", "0.1")
    refused(apart, *arguments, "--out", str(blocked / "out"))


def test_unknown_command_and_missing_option() -> None:
    assert "No such command" in refused(apart, "diagnoze")
    assert "--platform" in refused(apart, "diagnose")


def test_arguments_of_functions_become_options_of_commands() -> None:
    said = in_options("`time_limit` or `black_box`, `parameters` but `nothing`", commands)
    assert said == "--time-limit or --black-box, --parameter but `nothing`"
    assert in_options("`time_limit`", commands.commands["fit"]) == "`time_limit`"


def test_what_is_missing_or_misspelt_points_to_the_help(call) -> None:
    for words, said in (
        (
            ("fit", "--platform", "x", "--out", "y"),
            "Missing argument 'LOGS...'. See 'ptp-symbolic fit --help'.",
        ),
        (("simulate",), "Missing option '--platform'. See 'ptp-symbolic simulate --help'."),
        (("fit", "--platfrom", "x"), "Did you mean '--platform'? See 'ptp-symbolic fit --help'."),
        (("bench", "--zzz"), "No such option '--zzz'. See 'ptp-symbolic bench --help'."),
        (("nope",), "No such command 'nope'. See 'ptp-symbolic --help'."),
    ):
        done = call(*words)
        assert done.code == 2
        assert done.err.rstrip().endswith(said)


def test_without_a_command_the_commands_are_listed_line_by_line(call) -> None:
    done = call()
    assert done.code == 2
    lines = done.err.splitlines()
    assert any(line.split()[:1] == ["diagnose"] for line in lines)


def test_an_empty_argument_is_no_folder(call: Call, tmp_path: Path, monkeypatch) -> None:
    """As an unset variable of a shell leaves it; an empty path would be the working folder."""
    monkeypatch.chdir(tmp_path)
    sample = str(SAMPLE / "platform.toml")
    told = refused(call, "fit", "--platform", sample, str(SAMPLE / "train"), "--out", "")
    assert "What follows --out is empty" in told
    assert "What follows --platform is empty" in refused(call, "check", "--platform", "")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", ["fit", "diagnose"])
def test_the_platform_that_is_read_is_not_replaced(
    call: Call, tmp_path: Path, command: str
) -> None:
    path = changed_platform(tmp_path, "declared level", "declared level")
    before = Path(path).read_bytes()
    logs = [str(SAMPLE / "train")]
    if command == "diagnose":
        logs = ["--train", *logs, "--validate", str(SAMPLE / "validate")]
    told = refused(call, command, "--platform", path, *logs, "--out", str(tmp_path))
    assert "its platform.toml is the platform that is read" in told
    assert Path(path).read_bytes() == before


def test_an_input_without_a_profile(call: Call, tmp_path: Path) -> None:
    given = ("simulate", "--platform", "ideal", "--input", "tau_pan", "--out", str(tmp_path / "o"))
    assert "Input 'tau_pan' has no profile; write tau_pan=constant:3." in refused(call, *given)
