"""What importing the package costs and needs, seen from a fresh interpreter."""

import subprocess
import sys
from pathlib import Path

import pytest

NUMERIC_WING = ("runtime", "data", "simulation", "sensitivities", "identify", "diagnose")
SYMBOLIC_WING = (
    "mechanics",
    "mechanisms",
    "effects",
    "derivation",
    "simplify",
    "program",
    "targets",
    "documents",
)


def run_python(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a fresh interpreter in `folder`, where nothing of the checkout is in sight."""
    command = [sys.executable, *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def test_import_raises_no_warning(tmp_path: Path) -> None:
    ran = run_python(tmp_path, "-W", "error", "-c", "import ptp_symbolic")
    assert (ran.returncode, ran.stderr) == (0, "")


def test_import_leaves_sympy_alone(tmp_path: Path) -> None:
    ran = run_python(
        tmp_path, "-c", "import ptp_symbolic, sys; print(sorted({'sympy'} & set(sys.modules)))"
    )
    assert ran.stdout == "[]\n", ran.stderr


def test_import_is_free_of_what_takes_time(tmp_path: Path) -> None:
    """Numba comes with the first name that needs it; a committed model needs no SymPy."""
    program = (
        "import sys, ptp_symbolic as ptp; heavy = {'sympy', 'numba', 'matplotlib'};"
        "print(sorted(heavy & set(sys.modules)));"
        "ptp.load('ideal').rhs([0.0] * 4); print(sorted((heavy - {'numba'}) & set(sys.modules)))"
    )
    ran = run_python(tmp_path, "-c", program)
    assert ran.stdout == "[]\n[]\n", ran.stderr


def test_a_simulation_loads_what_it_runs_and_no_more(tmp_path: Path) -> None:
    """Once compiled, it needs neither numba's compiler nor what reads, draws and derives."""
    program = (
        "import sys, ptp_symbolic as ptp; ptp.simulate('pan_drive', 0.01, u_pan='step:1@0');"
        "heavy = {'sympy', 'pandas', 'matplotlib', 'click', 'rich', 'tomlkit', 'scipy.ndimage',"
        " 'scipy.stats', 'scipy.linalg', 'numba.np.linalg', 'ptp_symbolic.numeric.data'};"
        "print(sorted(heavy & set(sys.modules)))"
    )
    run_python(tmp_path, "-c", program)
    ran = run_python(tmp_path, "-c", program)
    assert ran.stdout == "[]\n", ran.stderr


@pytest.mark.parametrize("room", NUMERIC_WING)
def test_numeric_wing_works_where_sympy_is_missing(room: str, tmp_path: Path) -> None:
    program = f"import sys; sys.modules['sympy'] = None; import ptp_symbolic.numeric.{room}"
    ran = run_python(tmp_path, "-c", program)
    assert ran.returncode == 0, ran.stderr


@pytest.mark.parametrize("room", SYMBOLIC_WING)
def test_symbolic_wing_works_where_numba_is_missing(room: str, tmp_path: Path) -> None:
    program = f"import sys; sys.modules['numba'] = None; import ptp_symbolic.symbolic.{room}"
    ran = run_python(tmp_path, "-c", program)
    assert ran.returncode == 0, ran.stderr
