"""The wheel holds every file of the package, maps `generated/` inside it, claims no other name."""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

NOT_INSTALLED = shutil.ignore_patterns("__pycache__", "*.egg-info")


@pytest.fixture(scope="module")
def wheel(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel built from a copy of the checkout, so that no stale build folder can help."""
    source = tmp_path_factory.mktemp("source")
    for file in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(checkout / file, source)
    for folder in ("ptp_symbolic", "generated"):
        shutil.copytree(checkout / folder, source / folder, ignore=NOT_INSTALLED)
    build = "from setuptools.build_meta import build_wheel; build_wheel('dist')"
    subprocess.run([sys.executable, "-c", build], cwd=source, check=True, capture_output=True)
    (built,) = (source / "dist").glob("*.whl")
    return built


@pytest.fixture(scope="module")
def unpacked(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder into which the wheel was unpacked: what an installation looks like."""
    folder = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def files_below(folder: Path, name: str) -> set[str]:
    """Relative names of the files that belong to a package folder, as installed under `name`."""
    return {
        f"{name}/{path.relative_to(folder).as_posix()}"
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_wheel_claims_the_one_name_ptp_symbolic(unpacked: Path) -> None:
    names = {path.name for path in unpacked.iterdir()}
    assert names == {"ptp_symbolic", "ptp_symbolic-0.1.0.dist-info"}


def test_wheel_holds_every_file_of_the_package(checkout: Path, unpacked: Path) -> None:
    expected = files_below(checkout / "ptp_symbolic", "ptp_symbolic")
    expected |= files_below(checkout / "generated", "ptp_symbolic/generated")
    found = files_below(unpacked / "ptp_symbolic", "ptp_symbolic")
    assert found == expected, "adapt [tool.setuptools] in pyproject.toml: packages, package-data"


def test_installed_models_load_from_the_wheel_alone(unpacked: Path, tmp_path: Path) -> None:
    program = (
        "import importlib.util, ptp_symbolic.generated as emitted, ptp_symbolic;"
        "print(ptp_symbolic.__file__);"
        "print(list(emitted.__path__)[0]);"
        "print(importlib.util.find_spec('generated'));"
        "print(ptp_symbolic.load('ideal').state_names)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env={"PYTHONPATH": str(unpacked), "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PATH": ""},
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 0, ran.stderr
    package, emitted, stranger, states = ran.stdout.splitlines()
    assert Path(package).is_relative_to(unpacked)
    assert Path(emitted) == unpacked / "ptp_symbolic" / "generated"
    assert stranger == "None"
    assert states == "('theta_pan', 'theta_tilt', 'omega_pan', 'omega_tilt')"
