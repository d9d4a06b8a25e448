"""The archive of an FMU: sources compiled for every system for which there is a compiler."""

import importlib.util
import io
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ptp_symbolic.errors import InputError

EARLIEST = (1980, 1, 1, 0, 0, 0)  # of a zip archive: the same bytes at any time


@dataclass(frozen=True)
class System:
    """A system that FMUs run on: its name, folder in FMI 2.0 and 3.0, the ending of its libraries,
    what the `zig` compiler calls it, and its names in Python where it is this one.
    """

    name: str
    folders: tuple[str, str]
    suffix: str
    zig: str
    here: tuple[str, str]


SYSTEMS = (
    System(
        "Linux", ("linux64", "x86_64-linux"), ".so", "x86_64-linux-gnu.2.17", ("Linux", "x86_64")
    ),
    System("Windows", ("win64", "x86_64-windows"), ".dll", "x86_64-windows-gnu", ("Windows", "")),
    System("macOS", ("darwin64", "x86_64-darwin"), ".dylib", "x86_64-macos", ("Darwin", "x86_64")),
    System(
        "macOS (ARM)",
        ("darwin64-arm", "aarch64-darwin"),
        ".dylib",
        "aarch64-macos",
        ("Darwin", "arm64"),
    ),
)
OPTIONS = ["-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fvisibility=hidden"]


def systems() -> list[System]:
    """Systems for which there is a compiler here."""
    return [system for system in SYSTEMS if _compiler(system)]


def missing_systems() -> list[str]:
    """Names of the systems for which there is none."""
    return [system.name for system in SYSTEMS if not _compiler(system)]


def archive(files: Mapping[str, str], name: str, source: str, built: Sequence[System]) -> bytes:
    """The archive of `files` with binaries that are built from ``sources/<source>``.

    Raises InputError where a compiler fails.
    """
    content = {inside: text.encode() for inside, text in files.items()}
    version = 0 if source == "fmi2.c" else 1
    with tempfile.TemporaryDirectory() as folder:
        for inside, data in content.items():
            path = Path(folder, inside)
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)
        for system in built:
            if version == 0 and system.folders[0] == "darwin64-arm":
                continue  # FMI 2.0 has no folder for it
            made = _compiled(system, Path(folder, "sources"), name, source)
            content[f"binaries/{system.folders[version]}/{name}{system.suffix}"] = made
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as zipped:
        for inside, data in content.items():
            entry = zipfile.ZipInfo(inside, EARLIEST)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            zipped.writestr(entry, data)
    return buffer.getvalue()


def _compiler(system: System) -> list[str]:
    """The command that compiles C for a system; empty where there is none."""
    if system.here == (platform.system(), platform.machine()):
        for own in ("gcc", "cc", "clang"):
            if shutil.which(own):
                return [own]
    if importlib.util.find_spec("ziglang") is None:
        return []
    return [sys.executable, "-m", "ziglang", "cc", "-target", system.zig]


def _compiled(system: System, folder: Path, name: str, source: str) -> bytes:
    library = folder / f"{name}{system.suffix}"
    options = list(OPTIONS) if system.name == "Windows" else [*OPTIONS, "-fPIC"]
    if system.name == "Linux":
        options.append("-Wl,-Bsymbolic")
    command = [*_compiler(system), *options, source, "-o", str(library), "-lm"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode or not library.is_file():
        first = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr)
        raise InputError(
            f"The C of the FMU does not compile for {system.name}: {first.strip()[:300]}"
        )
    return library.read_bytes()
