"""Settings of matplotlib that lie about change no figure and break none."""

import subprocess
import sys
from pathlib import Path

import pytest

PROGRAM = """import hashlib, io
from ptp_symbolic.report.experiment_figure import drawn_in  # as the figures themselves import
from ptp_symbolic.report.figures import STYLE
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
with drawn_in(STYLE):
    figure, buffer = Figure(), io.BytesIO()
    FigureCanvasAgg(figure)
    figure.subplots().plot([1.0, 3.0, 2.0])
    figure.savefig(buffer, format="png", metadata={"Software": None})
print(hashlib.sha256(buffer.getvalue()).hexdigest())
"""


def drawn(folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], cwd=folder, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


@pytest.fixture(scope="module")
def without_settings(tmp_path_factory: pytest.TempPathFactory) -> str:
    return drawn(tmp_path_factory.mktemp("empty"))


@pytest.mark.parametrize(
    "settings",
    [
        b"font.size: 40\naxes.facecolor: red\nlines.linewidth: 9\nimage.cmap: magma\n",
        b"text.usetex: True\nsavefig.dpi: 20\nfigure.dpi: 20\n",
        b"\xff\xfe\x00 no text",
        b"no.such.key: 3\nfont.size = broken\n",
    ],
)
def test_a_matplotlibrc_of_the_folder_is_not_read(
    settings: bytes, without_settings: str, tmp_path: Path
) -> None:
    (tmp_path / "matplotlibrc").write_bytes(settings)
    assert drawn(tmp_path) == without_settings


def test_a_program_that_draws_by_itself_keeps_its_settings() -> None:
    import matplotlib

    from ptp_symbolic.report.style import drawn_in

    with matplotlib.rc_context({"font.size": 31.0, "axes.linewidth": 7.0}):
        with drawn_in({"font.size": 8.0}):
            assert matplotlib.rcParams["font.size"] == 8.0
            assert matplotlib.rcParams["axes.linewidth"] == 0.8
        assert matplotlib.rcParams["font.size"] == 31.0
        assert matplotlib.rcParams["axes.linewidth"] == 7.0
