"""Emit the committed models into `generated/`, or check that they are what would be emitted."""

import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ptp_symbolic.atomic import write_text_if_changed
from ptp_symbolic.codegen.module import module_text, sealed
from ptp_symbolic.derivation.assembly import assemble
from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import read_platform
from ptp_symbolic.runtime.loader import generated_folder

COMMITTED = {
    "ideal": "thesis-ideal",
    "payload": "thesis-payload",
    "pan_drive": "thesis-pan-drive",
    "tilt_drive": "thesis-tilt-drive",
    "full": "thesis-full",
}
LINE_LENGTH = 100


@dataclass(frozen=True)
class Outcome:
    """Modules that were written (or, when checking, would be), by file name."""

    changed: tuple[str, ...]
    unchanged: tuple[str, ...]


def regenerate(models: Sequence[str] = (), check: bool = False) -> Outcome:
    """Emit `models` (all without a name); with `check` nothing is written.

    Raises InputError for an unknown model.
    """
    for model in models:
        if model not in COMMITTED:
            raise InputError(f"Unknown model '{model}'. Choose from: {', '.join(COMMITTED)}.")
    folder = generated_folder()
    changed: list[str] = []
    unchanged: list[str] = []
    for model in models or COMMITTED:
        path = folder / f"{model}.py"
        text = committed_text(model)
        same = path.is_file() and path.read_text(encoding="utf-8") == text
        (unchanged if same else changed).append(path.name)
        if not same and not check:
            write_text_if_changed(path, text)
    return Outcome(tuple(changed), tuple(unchanged))


def committed_text(model: str) -> str:
    """Text of a committed module, formatted and sealed with its checksum."""
    text = module_text(assemble(read_platform(COMMITTED[model])))
    return sealed(formatted(text))


def formatted(text: str) -> str:
    """`text` as ruff formats it, whatever the configuration of the machine."""
    command = [sys.executable, "-m", "ruff", "format", "--isolated", "--stdin-filename", "model.py"]
    command += ["--config", f"line-length={LINE_LENGTH}", "-"]
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        reason = done.stderr.strip().splitlines()
        raise InputError(f"ruff could not format a module: {reason[-1] if reason else 'no ruff'}.")
    return done.stdout


def stray_modules(folder: Path) -> tuple[str, ...]:
    """Modules in `folder` that no committed model emits."""
    known = {"__init__", *COMMITTED}
    return tuple(sorted(p.name for p in folder.glob("*.py") if p.stem not in known))
