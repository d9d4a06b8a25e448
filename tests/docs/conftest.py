"""The pages, built once from a copy of their sources."""

import importlib
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

LIBRARIES = ("sphinx", "myst_nb", "pydata_sphinx_theme", "sphinxcontrib.bibtex", "sphinx_click")


@pytest.fixture(scope="session")
def docs(checkout: Path) -> Path:
    """The folder of the sources."""
    return checkout / "docs"


@pytest.fixture(scope="session")
def kept_outputs(docs: Path) -> Iterator[ModuleType]:
    """The module that keeps the outputs of the tutorials."""
    pytest.importorskip("myst_nb", reason="MyST-NB is of the extra `docs`")
    sys.path.insert(0, str(docs / "_extensions"))
    try:
        yield importlib.import_module("kept_outputs")
    finally:
        sys.path.remove(str(docs / "_extensions"))


@pytest.fixture(scope="session")
def site(docs: Path, kept_outputs: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the built pages; a build that warns or would run a notebook fails."""
    for library in LIBRARIES:
        pytest.importorskip(library, reason="Sphinx and its extensions are of the extra `docs`")
    stale = [path.name for path in kept_outputs.tutorials(docs) if kept_outputs.is_stale(path)]
    assert not stale, "run python3 scripts/docs.py, which keeps the new outputs"
    folder = tmp_path_factory.mktemp("docs")
    sources = shutil.copytree(docs, folder / "docs", ignore=shutil.ignore_patterns("_generated"))
    command = [sys.executable, "-m", "sphinx", "--quiet", "--fail-on-warning", "--keep-going"]
    built = subprocess.run(
        [*command, str(sources), str(folder / "site")], capture_output=True, text=True
    )
    assert built.returncode == 0, built.stderr
    return folder / "site"
