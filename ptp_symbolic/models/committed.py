"""Emit the committed models into `generated/`, or check that they are what would be emitted."""

import importlib.metadata
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ptp_symbolic.atomic_files import write_text_if_changed
from ptp_symbolic.errors import InputError
from ptp_symbolic.models.emission import module_of
from ptp_symbolic.numeric.runtime.model import COMMITTED, generated_folder
from ptp_symbolic.platform import Platform, platform_file, read_platform
from ptp_symbolic.symbolic.derivation.placement import refuse_undeclared

# Packages that emitted modules and those who call them import, installed here or not.
IMPORTED = (
    "casadi fmpy generated h5py jax mujoco numba numpy pandas pip pytest ruff scipy setuptools"
    " sklearn sympy torch wheel"
)
# Files that Python itself, pytest, setuptools, nox, doit, fabric and torch run where they lie.
RUN_UNASKED = (
    "__init__ __main__ conftest dodo fabfile hubconf noxfile setup sitecustomize tasks"
    " usercustomize"
)
DEVICES = "aux con nul prn" + "".join(f" com{k} lpt{k}" for k in range(1, 10))


def declared_platform(source: str | Path) -> Platform:
    """Read the platform of a committed model, a preset or a file.

    Raises InputError for what is none of them, for a file that cannot be used, and for one that
    leaves out a parameter without a natural default.
    """
    platform = platform_as_written(source)
    refuse_undeclared(platform)
    return platform


def platform_as_written(source: str | Path) -> Platform:
    """As `declared_platform`, for what needs no values: parameters may be missing."""
    name = COMMITTED.get(str(source), source)
    return read_platform(platform_file(name, tuple(COMMITTED)))


@dataclass(frozen=True)
class Outcome:
    """Modules that were written (or, when checking, would be), by file name."""

    changed: tuple[str, ...]
    unchanged: tuple[str, ...]


def regenerate(models: Sequence[str] = (), check: bool = False) -> Outcome:
    """Emit committed `models` (all without a name); with `check` nothing is written.

    Raises InputError for an unknown model.
    """
    for model in models:
        if model not in COMMITTED:
            declared_platform(model)  # refuses what is no platform either
            raise InputError(
                f"'{model}' is a platform, not one of the committed models"
                f" {', '.join(COMMITTED)}; add --out FOLDER to emit its module there."
            )
    texts = {model: module_of(read_platform(COMMITTED[model])) for model in models or COMMITTED}
    return _write(texts, generated_folder(), check)


def regenerate_into(folder: Path, platforms: Sequence[Platform], check: bool = False) -> Outcome:
    """Emit a module for each of `platforms` into `folder`, named as they are.

    With `check` nothing is written. Raises InputError for a machine that cannot exist, for two
    platforms of one name, and for a name that would hide another module.
    """
    names = [platform.name for platform in platforms]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"Two platforms are called '{name}'; change the name of one.")
        if fate := _taken(name):
            raise InputError(
                f"A module called {name}.py would be {fate}; change the name of the platform."
            )
    texts = {platform.name: module_of(platform) for platform in platforms}
    return _write(texts, folder, check)


def _taken(name: str) -> str:
    """What would become of a module called `name`, where that name is another's, else nothing.

    Where upper and lower case are one, as on Windows, so are their names.
    """
    installed = importlib.metadata.packages_distributions()
    for taken, fate in (
        (
            {*sys.stdlib_module_names, *installed, *IMPORTED.split()},
            "imported in place of '{}' by whatever runs in its folder",
        ),
        (RUN_UNASKED.split(), "run unasked, as every '{}' is"),
        (DEVICES.split(), "a device of Windows, as every '{}' is"),
    ):
        for other in taken:
            if name.lower() == other.lower():
                return fate.format(other)
    return ""


def _write(texts: Mapping[str, str], folder: Path, check: bool) -> Outcome:
    changed: list[str] = []
    unchanged: list[str] = []
    for name, text in texts.items():
        path = folder / f"{name}.py"
        same = path.is_file() and path.read_bytes() == text.encode()
        (unchanged if same else changed).append(path.name)
        if not same and not check:
            write_text_if_changed(path, text)
    return Outcome(tuple(changed), tuple(unchanged))


def stray_modules(folder: Path) -> tuple[str, ...]:
    """Modules in `folder` that no committed model emits."""
    known = {"__init__", *COMMITTED}
    return tuple(sorted(p.name for p in folder.glob("*.py") if p.stem not in known))
