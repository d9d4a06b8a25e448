"""Emitted modules of a user's machines, kept by their mathematics in a folder of their own.

Writing the module of a machine with all its candidates takes many times as long as deriving its
equations: what was once written is found again by the equations and the program that wrote it.
"""

import atexit
import functools
import hashlib
import os
import re
import shutil
import stat
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from types import FunctionType

import platformdirs
import sympy as sp

from ptp_symbolic.atomic_files import write_text_if_changed
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.model import verify
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.targets.numba.module import module_text

DECIDING = ("platform", "symbolic")  # parts of this package from which a module is written
DIGITS = 16  # of a SHA-256 in a name: 64 bits
MODULE_NAME = re.compile(rf"ptp_model_[0-9a-f]{{{DIGITS}}}\.py")


def cache_folder() -> Path:
    """Folder of modules emitted for platforms of the user (PTP_SYMBOLIC_CACHE, else the usual),
    made where it is missing, and that of their compiled functions.

    Raises InputError for a folder in which another user may write: what lies there is run. Raises
    OSError where it cannot be made.
    """
    folder = _usual_folder()
    for own in (folder, folder / "__pycache__"):
        own.mkdir(mode=0o700, parents=True, exist_ok=True)
        if hasattr(os, "getuid"):
            found = own.stat()
            if found.st_uid != os.getuid() or found.st_mode & (stat.S_IWOTH | stat.S_IWGRP):
                raise InputError(
                    f"The cache folder {own} can be written by other users, and what lies there is"
                    f" run; take that right away (chmod go-w {own}), or set PTP_SYMBOLIC_CACHE to a"
                    " folder of your own."
                )
    return folder


def _usual_folder() -> Path:
    """PTP_SYMBOLIC_CACHE, else the usual place of caches, else one of the user's own where
    temporary files go.
    """
    named = os.environ.get("PTP_SYMBOLIC_CACHE")
    if named:
        return Path(named)
    usual = platformdirs.user_cache_path("ptp_symbolic", appauthor=False)
    root = usual.parent
    if os.access(root if root.exists() else root.parent, os.W_OK):
        return usual
    owner = os.getuid() if hasattr(os, "getuid") else "user"
    return Path(tempfile.gettempdir()) / f"ptp_symbolic-{owner}"


def emitted(equations: Equations, usual: Mapping[str, Parameter]) -> Path:
    """The module of `equations`, written unless it is there, and whole.

    Where the folder of modules has no room, it is written where temporary files go, for this
    process alone. Machines that differ in their numbers alone share it, and what is compiled of it:
    it has the `usual` values of all parameters.
    """
    shared = replace(
        equations,
        name="machine",
        title="Machine of a user",
        parameters=tuple(usual[p.name] for p in equations.parameters),
    )
    key = f"{_digest(_program(), described(shared))}.name"
    try:
        folder = cache_folder()
    except OSError:
        return _written(_folder_of_process(), key, module_text(shared))
    with suppress(OSError, UnicodeDecodeError, InputError):
        name = (folder / key).read_text(encoding="utf-8")
        if MODULE_NAME.fullmatch(name):
            verify(folder / name)
            return folder / name
    text = module_text(shared)
    try:
        return _written(folder, key, text)
    except InputError:
        return _written(_folder_of_process(), key, text)


def _written(folder: Path, key: str, text: str) -> Path:
    """The module of this `text` in `folder`, and a file called `key` with its name."""
    path = folder / f"ptp_model_{_digest(text)}.py"
    write_text_if_changed(path, text)
    write_text_if_changed(folder / key, path.name)
    return path


@functools.cache
def _folder_of_process() -> Path:
    """A new folder for temporary files, gone with the process."""
    folder = tempfile.mkdtemp(prefix="ptp_symbolic-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def described(value: object) -> str:
    """`value` as a text that is the same in every process: expressions, records, functions by
    their names (what effects compute stands in the equations).
    """
    if isinstance(value, sp.Basic | sp.MatrixBase):
        return str(sp.srepr(value))
    if is_dataclass(value):
        parts = [f"{f.name}={described(getattr(value, f.name))}" for f in fields(value)]
        return f"{type(value).__name__}({', '.join(parts)})"
    if isinstance(value, Mapping):
        return described(sorted((described(k), described(v)) for k, v in value.items()))
    if isinstance(value, tuple | list):
        return f"[{', '.join(map(described, value))}]"
    if isinstance(value, frozenset | set):
        return described(sorted(map(described, value)))
    if isinstance(value, FunctionType):
        return f"{value.__module__}.{value.__qualname__}"
    return repr(value)


@functools.cache
def _program() -> str:
    """Digest of the sources that decide what a module says, and of the version of SymPy."""
    root = Path(__file__).parents[1]
    sources = [path for wing in DECIDING for path in sorted((root / wing).rglob("*.py"))]
    return _digest(sp.__version__, *(path.read_text(encoding="utf-8") for path in sources))


def _digest(*texts: str) -> str:
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:DIGITS]
