"""Compiled functions on disk that were damaged are compiled again, and nobody hears of it."""

import hashlib
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from ptp_symbolic.numeric.runtime.model import TRAILER

MODULE = """from numba import njit


@njit(cache=True)
def cube(x):
    return x * x * x


"""
PROGRAM = """import sys
from pathlib import Path
from ptp_symbolic.numeric.runtime.model import load_module
module = load_module(Path(sys.argv[1]), "ptp_model_cube").module
print(module.cube(3.0), sum(module.cube.stats.cache_hits.values()))
"""
DAMAGES: dict[str, tuple[str, Callable[[bytes], bytes]]] = {
    "emptied data": ("*.nbc", lambda _: b""),
    "cut data": ("*.nbc", lambda content: content[: len(content) // 2]),
    "zeroed data": ("*.nbc", lambda content: bytes(len(content))),
    "a zeroed page of the data": (
        "*.nbc",
        lambda content: content[:2048] + bytes(4096) + content[6144:],
    ),
    "emptied index": ("*.nbi", lambda _: b""),
    "an index that is text": ("*.nbi", lambda _: b"\xff\xfe\x00index"),
}


@pytest.fixture
def module(tmp_path: Path) -> Path:
    path = tmp_path / "ptp_model_cube.py"
    path.write_text(f"{MODULE}{TRAILER}{hashlib.sha256(MODULE.encode()).hexdigest()}\n")
    return path


def run(module: Path, folder: Path | None = None) -> tuple[str, int]:
    """What the program printed: a value, and how many functions it found compiled, beside the
    module or in a `folder`.
    """
    environment = {k: v for k, v in os.environ.items() if k != "NUMBA_CACHE_DIR"}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(module)],
        capture_output=True,
        text=True,
        check=False,
        env=environment | ({} if folder is None else {"NUMBA_CACHE_DIR": str(folder)}),
    )
    assert (done.returncode, done.stderr) == (0, "")
    value, found = done.stdout.split()
    return value, int(found)


@pytest.mark.long
def test_a_damaged_file_is_compiled_again_and_kept(module: Path) -> None:
    assert run(module) == ("27.0", 0)
    assert run(module) == ("27.0", 1)
    for what, (pattern, damage) in DAMAGES.items():
        (path,) = (module.parent / "__pycache__").glob(pattern)
        path.write_bytes(damage(path.read_bytes()))
        assert run(module) == ("27.0", 0), what
        assert run(module) == ("27.0", 1), what


def test_a_folder_that_keeps_nothing_costs_time_alone(module: Path) -> None:
    """Its files cannot be written: folders have their names."""
    assert run(module) == ("27.0", 0)
    for path in (module.parent / "__pycache__").iterdir():
        path.unlink()
        path.mkdir()
    assert run(module) == ("27.0", 0)


def test_functions_of_others_are_kept_as_numba_does() -> None:
    from numba import njit
    from numba.core.caching import FunctionCache

    from ptp_symbolic.numeric.runtime import compiled

    def square(x):
        return x * x

    square.__module__ = "somebody_else"
    assert type(njit(cache=True)(square)._cache) is FunctionCache
    square.__module__ = "ptp_symbolic.numeric"
    assert type(njit(cache=True)(square)._cache) is compiled.SealedCache


def test_a_folder_of_the_caller_serves_every_place_where_the_module_lies(
    module: Path, tmp_path: Path
) -> None:
    """The second copy finds what the first compiled; one with other content does not."""
    folder, copy, other = tmp_path / "kept", tmp_path / "a" / module.name, tmp_path / "b"
    copy.parent.mkdir()
    copy.write_bytes(module.read_bytes())
    assert run(module, folder) == ("27.0", 0)
    assert run(copy, folder) == ("27.0", 1)
    squared = MODULE.replace("x * x * x", "x * x")
    other.mkdir()
    edited = other / module.name
    edited.write_text(f"{squared}{TRAILER}{hashlib.sha256(squared.encode()).hexdigest()}\n")
    assert run(edited, folder) == ("9.0", 0)
