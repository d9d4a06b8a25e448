"""Compiled functions that come with an installation.

The build of a wheel compiles the runners and the committed models for any processor of the last
ten years, and puts their code beside the source: the first run of a new machine need not wait for
a compiler. What was compiled from other sources, by another numba or Python, or for a processor
that this one is not, is passed over, and compiled where it is needed.
"""

import hashlib
import platform
import sys
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import FunctionType
from typing import Any

import llvmlite
import llvmlite.binding as llvm
import numba

PACKAGE = Path(__file__).parents[2]
FOLDER = PACKAGE / "compiled"
# What a source says whose functions are compiled into others.
COMPILED = (b"@kernel", b"@inlined", b"@merged", b"njit", b"jitable", b"@intrinsic")
WRITE_INTO = "PTP_SYMBOLIC_COMPILE_INTO"  # variable that names the folder to be filled by a build


@dataclass(frozen=True)
class Baseline:
    """The processor that code is compiled for, as LLVM calls it, and what one must have for it."""

    cpu: str
    features: frozenset[str]


V3_FEATURES = frozenset({"avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"})
X86_64_V3 = Baseline("x86-64-v3", V3_FEATURES)
BASELINES = {"x86_64": X86_64_V3, "amd64": X86_64_V3} | dict.fromkeys(
    ("aarch64", "arm64"), Baseline("generic", frozenset())
)


def baseline() -> Baseline | None:
    """The baseline of this kind of machine; None where code is not compiled ahead for it."""
    return BASELINES.get(platform.machine().lower())


@lru_cache(maxsize=1)
def fits() -> bool:
    """Whether code for the baseline runs here."""
    known = baseline()
    if known is None or not FOLDER.is_dir():
        return False
    features = llvm.get_host_cpu_features()
    return all(features.get(name, False) for name in known.features)


def name_of(function: FunctionType, signature: Any, code: Any) -> str:
    """Name of the file of a function for a signature; `code` is what numba knows it by.

    It changes with numba, Python, the kind of machine and the sources; compiled functions hold the
    constants of their folder as they were.
    """
    source = Path(function.__code__.co_filename)
    own = source.read_bytes() + _constants_in(source.parent)
    facts = (function.__module__, str(signature), repr(code), hashlib.sha256(own).hexdigest())
    digest = hashlib.sha256(repr((*facts, *_surroundings())).encode()).hexdigest()
    return f"{function.__name__}-{digest[:24]}.code"


@lru_cache(maxsize=64)
def _constants_in(folder: Path) -> bytes:
    constants = folder / "constants.py"
    return constants.read_bytes() if constants.is_file() else b""


@lru_cache(maxsize=1)
def _surroundings() -> tuple[str, ...]:
    versions = numba.__version__, llvmlite.__version__, str(sys.implementation.cache_tag)
    return *versions, llvm.get_process_triple(), _digest_of_kernels()


def _digest_of_kernels() -> str:
    """Digest of the sources that inner kernels come from."""
    digest = hashlib.sha256()
    paths = sorted((PACKAGE / "numeric/simulation").rglob("*.py"))
    for path in (*paths, PACKAGE / "numeric/runtime/element_layout.py"):
        source = path.read_bytes()
        if any(word in source for word in COMPILED):
            digest.update(source)
    return digest.hexdigest()
