"""A run that is fitted judges nothing, under whatever name it comes."""

from pathlib import Path

import pytest

from ptp_symbolic.data import read_split_logs
from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform, SignalDeclaration

SIGNALS = (
    SignalDeclaration("theta_pan", "pan_angle", "rad", "output", 7200),
    SignalDeclaration("u_pan", "pan_voltage", "V", "input"),
)
PLATFORM = Platform("bench", "bench", ("pan",), 9.81, (), (), SIGNALS)


def text(volts: float = 4.5, start: float = 0.0, end: str = "\n") -> str:
    rows = [f"{start + 0.005 * k:.4f},{volts * (k == 3):.2f},{0.1 * k:.6f}" for k in range(12)]
    return end.join(["time [s],pan_voltage [V],pan_angle [rad]", *rows, ""])


def write(folder: Path, name: str, content: str) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / name
    path.write_bytes(content.encode())
    return path


def test_a_run_is_never_both_fitted_and_judged_by(tmp_path: Path) -> None:
    first, other = write(tmp_path, "first.csv", text()), write(tmp_path, "other.csv", text(4.75))
    same = (
        first,
        write(tmp_path / "copies", "copy.csv", text()),
        tmp_path / "copies",
        write(tmp_path, "windows.csv", text(end="\r\n")),
        write(tmp_path, "later.csv", text(start=7.0)),
    )
    for leak in same:
        with pytest.raises(InputError, match="holds the same run as") as refused:
            read_split_logs([other, first], [leak], PLATFORM)
        assert str(refused.value).startswith(str(leak))
        assert f"as {first}, which is given to be fitted" in str(refused.value)


def test_runs_that_differ_in_one_sample_are_two(tmp_path: Path) -> None:
    first, other = write(tmp_path, "first.csv", text()), write(tmp_path, "other.csv", text(4.51))
    fitted, judging = read_split_logs([other], [first], PLATFORM)
    assert [log.name for log in (*fitted, *judging)] == ["other", "first"]
