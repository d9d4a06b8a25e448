"""A run that is fitted judges nothing, under whatever name it comes."""

import math
from pathlib import Path

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import read_split_logs
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


def swing(frequency: float, first: int = 0, count: int = 400) -> str:
    """A machine at rest for half a second, then swinging; the samples from `first` on."""
    rows = []
    for k in range(first, first + count):
        phase = frequency * 0.005 * max(k - 100, 0)
        angle = round(math.sin(phase) * 7200) / 7200
        rows.append(f"{0.005 * (k - first):.4f},{math.cos(phase):.6f},{angle:.9f}")
    return "\n".join(["time [s],pan_voltage [V],pan_angle [rad]", *rows, ""])


def test_a_part_of_a_fitted_run_judges_nothing(tmp_path: Path) -> None:
    whole = write(tmp_path, "whole.csv", swing(3.0))
    for name, first, count in (("middle", 150, 60), ("end", 320, 200), ("start", 0, 200)):
        part = write(tmp_path, f"{name}.csv", swing(3.0, first, count))
        with pytest.raises(InputError, match=f"{name}.csv: holds samples of .*whole.csv, which"):
            read_split_logs([whole], [part], PLATFORM)


def test_runs_that_rest_alike_are_two(tmp_path: Path) -> None:
    whole = write(tmp_path, "whole.csv", swing(3.0))
    for name, content in (("other", swing(3.1)), ("resting", swing(3.0, 0, 100))):
        read_split_logs([whole], [write(tmp_path, f"{name}.csv", content)], PLATFORM)
