"""Figures look alike wherever they are drawn."""

import subprocess
import sys
from pathlib import Path

import pytest

POINTS = "rate [rad/s],torque [N m]\n" + "".join(
    f"{s * w},{s * (0.3 + 0.05 * w + 0.001 * (-1) ** w)}\n" for s in (1, -1) for w in range(1, 8)
)


@pytest.mark.long
def test_settings_of_matplotlib_in_the_working_folder_change_nothing(tmp_path: Path) -> None:
    """Neither valid ones, nor such that Matplotlib cannot even read."""
    pictures = []
    for number, settings in enumerate(
        (b"", b"text.usetex: True\nfont.size: 40\n", b"\xff\xfe\x00")
    ):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "points.csv").write_text(POINTS)
        if settings:
            (folder / "matplotlibrc").write_bytes(settings)
        command = [sys.executable, "-m", "ptp_symbolic", "friction-map", "points.csv", "--out", "."]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert (done.returncode, done.stderr) == (0, "")
        pictures.append((folder / "friction.png").read_bytes())
    assert pictures[0] == pictures[1] == pictures[2]
