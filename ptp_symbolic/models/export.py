"""A platform exported: its equations in the language of another tool, as files."""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from ptp_symbolic.atomic_files import check_writable, write_files_atomically
from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.models.emission import possible_equations
from ptp_symbolic.platform import Platform
from ptp_symbolic.symbolic.program.program import program
from ptp_symbolic.symbolic.targets import TARGETS
from ptp_symbolic.symbolic.targets.target import Packed, Target


def target_named(name: str) -> Target:
    """The target called `name`. Raises InputError where there is none."""
    own = {target.name: target for target in TARGETS}
    if name not in own:
        raise unknown("target", name, own)
    return own[name]


@dataclass(frozen=True)
class Exported:
    """Contents of the `files` of a platform for a target, by name, and what to know of them."""

    files: Mapping[str, str | bytes]
    remarks: tuple[str, ...]


def exported(
    platform: Platform, target: str, say: Callable[[str], None] = lambda _: None
) -> Exported:
    """`platform` in the language of a target; the phases that begin are said.

    Raises InputError for an unknown target, for a machine that cannot exist, and for one that the
    target cannot express, with the effects that are in the way.
    """
    own = target_named(target)
    say("deriving the equations")
    equations = possible_equations(platform)
    say("sharing their terms")
    whole = program(equations)
    why = own.refuse(whole)
    if why is not None:
        raise InputError(f"Target '{target}' cannot express platform '{platform.name}': {why}")
    name = identifier(platform.name)
    say("writing the text")
    texts = own.files(whole, name)
    files: Mapping[str, str | bytes] = texts
    if isinstance(own, Packed):
        try:
            files = own.pack(texts, name, say)
        except OSError as error:
            place = error.filename or "The folder for temporary files"
            raise InputError(
                f"{place} cannot be written: {error.strerror}. Make room, or set TMPDIR to another"
                " folder."
            ) from error
    return Exported(files, tuple(own.remarks(whole)))


def export(
    platform: Platform, target: str, folder: Path, say: Callable[[str], None] = lambda _: None
) -> tuple[list[Path], tuple[str, ...]]:
    """Write `platform` for a target into `folder`; all files or none. Returns their paths, and what
    to know of them; the phases that begin are said.

    Raises InputError as `exported` does, and where the folder cannot be written.
    """
    check_writable(folder)
    found = exported(platform, target, say)
    write_files_atomically(folder, dict(found.files))
    return [folder / name for name in found.files], found.remarks


def identifier(name: str) -> str:
    """`name` as an identifier in every language: letters, digits and underscores of ASCII."""
    plain = re.sub(r"[^0-9A-Za-z]+", "_", name).strip("_") or "model"
    return plain if plain[0].isalpha() else f"model_{plain}"
