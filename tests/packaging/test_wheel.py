"""Wheel and source distribution hold what they should, and work outside of the checkout."""

import importlib.util
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

NOT_INSTALLED = shutil.ignore_patterns("__pycache__", "*.egg-info", "_build", "compiled")


SOURCES = ("ptp_symbolic", "generated", "docs", "scripts", "tests")
BESIDE = (
    "pyproject.toml",
    "MANIFEST.in",
    "README.md",
    "LICENSE",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
)


def built(kind: str, source: Path) -> Path:
    """The distribution of a `kind`, wheel or sdist, built from the folder `source`."""
    build = f"from setuptools.build_meta import build_{kind}; print(build_{kind}('dist'))"
    command = [sys.executable, "-c", build]
    ran = subprocess.run(command, cwd=source, check=True, capture_output=True, text=True)
    return source / "dist" / ran.stdout.splitlines()[-1]


@pytest.fixture(scope="module")
def sdist(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A source distribution, unpacked; built from a copy of the checkout, so that no stale build
    folder can help.
    """
    source = tmp_path_factory.mktemp("source")
    for file in BESIDE:
        shutil.copy(checkout / file, source)
    for folder in SOURCES:
        shutil.copytree(checkout / folder, source / folder, ignore=NOT_INSTALLED)
    archive = built("sdist", source)
    with tarfile.open(archive) as packed:
        packed.extractall(source / "unpacked", filter="data")
    (folder,) = (source / "unpacked").iterdir()
    return folder


@pytest.fixture(scope="module")
def wheel(sdist: Path) -> Path:
    """A wheel built from the source distribution, as `pip install` of it does."""
    return built("wheel", sdist)


def test_the_source_distribution_holds_what_the_checkout_does(checkout: Path, sdist: Path) -> None:
    assert [file for file in BESIDE if not (sdist / file).is_file()] == []
    for folder in SOURCES:
        expected = files_below(checkout / folder, folder)
        assert expected <= files_below(sdist / folder, folder), "adapt MANIFEST.in"


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
        if path.is_file() and not {"__pycache__", "compiled"} & set(path.parts)
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


@pytest.mark.parametrize(
    ("arguments", "shown"),
    [
        (("platforms",), "thesis-payload"),
        (("effects", "cable_spring"), "k1_cable_<axis>"),
        (("diagnose", "--help"), "--validate"),
    ],
)
def test_commands_run_from_the_wheel_alone(
    arguments: tuple[str, ...], shown: str, unpacked: Path, tmp_path: Path
) -> None:
    ran = subprocess.run(
        [sys.executable, "-m", "ptp_symbolic", *arguments],
        cwd=tmp_path,
        env={"PYTHONPATH": str(unpacked), "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PATH": ""},
        capture_output=True,
        text=True,
    )
    assert ran.returncode == 0, ran.stderr
    assert shown in ran.stdout


def test_what_one_build_compiled_is_kept_for_the_next_of_the_same_sources(
    checkout: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spec = importlib.util.spec_from_file_location(
        "build_backend", checkout / "scripts" / "build_backend.py"
    )
    assert spec is not None and spec.loader is not None
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    here, compiled, made = tmp_path / "checkout", tmp_path / "compiled", []
    for part in build.DECIDING:
        (here / part).parent.mkdir(parents=True, exist_ok=True)
        (here / part).write_bytes(b"") if "." in part else (here / part).mkdir()
    shutil.copy(checkout / "pyproject.toml", here)
    kernel = here / "generated" / "model.py"

    def compiler(folder: Path, scratch: Path) -> bool:
        made.append(kernel.read_text())
        if made[-1] != "an error":
            (folder / "run.code").write_text(f"machine code of {made[-1]}")
        (folder / "fit.code").write_text("machine code of a fit")
        return made[-1] != "an error"

    monkeypatch.setattr(build, "CHECKOUT", here)
    monkeypatch.setattr(build, "COMPILED", compiled)
    monkeypatch.setattr(build, "compiled_into", compiler)
    monkeypatch.setattr(build.dist.Distribution, "has_ext_modules", lambda self: False)
    monkeypatch.setenv(build.KEPT, str(tmp_path / "kept"))
    monkeypatch.delenv("PTP_SYMBOLIC_AHEAD", raising=False)
    for source in ("a kernel", "another", "a kernel", "another"):
        kernel.write_text(source)
        needed = build.compilers()
        assert any(name.startswith("numba") for name in needed) == (source not in made)
        build.compile_ahead()
        assert (compiled / "run.code").read_text() == f"machine code of {source}"
    assert made == ["a kernel", "another"]
    for _ in range(2):
        kernel.write_text("an error")
        build.compile_ahead()
        assert [path.name for path in compiled.iterdir()] == ["fit.code"]
    assert made[2:] == ["an error"] * 2


@pytest.mark.long
def test_what_the_build_compiled_runs_where_nothing_was_compiled(
    sdist: Path, tmp_path: Path
) -> None:
    build = "import sys; sys.path.insert(0, 'scripts'); import build_backend as b;"
    command = [sys.executable, "-c", build + "print(b.build_wheel('dist'))"]
    ran = subprocess.run(command, cwd=sdist, check=True, capture_output=True, text=True)
    wheel = sdist / "dist" / ran.stdout.splitlines()[-1]
    assert not wheel.name.endswith("-any.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "unpacked")
    program = "import ptp_symbolic as ptp; print(ptp.simulate('pan_drive', 1.0, u_pan=6.0).events)"
    cache = tmp_path / "cache"
    environment = {
        "PYTHONPATH": str(tmp_path / "unpacked"),
        "NUMBA_CACHE_DIR": str(cache),
        "PATH": "",
    }
    command = [sys.executable, "-c", program]
    subprocess.run(command, cwd=tmp_path, env=environment, check=True)
    assert not list(cache.rglob("*.nbc"))
