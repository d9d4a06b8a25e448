"""The archive of an FMU: sources compiled for every system for which there is a compiler."""

import importlib.util
import io
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ptp_symbolic.errors import InputError

EARLIEST = (1980, 1, 1, 0, 0, 0)  # of a zip archive: the same bytes at any time


@dataclass(frozen=True)
class System:
    """A system that FMUs run on: its name, the folder of its binaries in FMI 3.0 and in 2.0 (None
    where that has none), their ending, what the `zig` compiler calls it, and its names in Python.
    """

    name: str
    folder: str
    old_folder: str | None
    suffix: str
    zig: str
    here: tuple[str, str]

    def folder_of(self, version: str) -> str | None:
        """The folder of its binaries in a version of the interface."""
        return self.old_folder if version == "2.0" else self.folder


LINUX = System(
    "Linux", "x86_64-linux", "linux64", ".so", "x86_64-linux-gnu.2.17", ("Linux", "x86_64")
)
LINUX_ARM = System(
    "Linux on ARM", "aarch64-linux", None, ".so", "aarch64-linux-gnu.2.17", ("Linux", "aarch64")
)
WINDOWS = System(
    "Windows", "x86_64-windows", "win64", ".dll", "x86_64-windows-gnu", ("Windows", "AMD64")
)
MACOS = System("macOS", "x86_64-darwin", "darwin64", ".dylib", "x86_64-macos", ("Darwin", "x86_64"))
MACOS_ARM = System(
    "macOS on ARM", "aarch64-darwin", None, ".dylib", "aarch64-macos", ("Darwin", "arm64")
)
SYSTEMS = (LINUX, LINUX_ARM, WINDOWS, MACOS, MACOS_ARM)
OPTIONS = ["-std=c99", "-O2", "-ffp-contract=off", "-shared", "-fvisibility=hidden"]


def systems(version: str) -> list[System]:
    """Systems of a version of the interface for which there is a compiler here."""
    return [system for system in SYSTEMS if system.folder_of(version) and _compiler(system)]


def missing_systems(version: str) -> list[str]:
    """Names of those for which there is none."""
    own = [system for system in SYSTEMS if system.folder_of(version)]
    return [system.name for system in own if not _compiler(system)]


def archive(
    files: Mapping[str, str],
    name: str,
    version: str,
    built: Sequence[System],
    say: Callable[[str], None] = lambda _: None,
) -> bytes:
    """The archive of `files` of a version of the interface, with binaries for the systems `built`;
    for which it compiles is said before.

    Raises InputError where a compiler fails.
    """
    content = {inside: text.encode() for inside, text in files.items()}
    with tempfile.TemporaryDirectory() as folder:
        for inside, data in content.items():
            path = Path(folder, inside)
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)
        for system in built:
            say(f"compiling for {system.name}")
            made = _compiled(system, Path(folder, "sources"), name, f"fmi{version[0]}.c")
            content[f"binaries/{system.folder_of(version)}/{name}{system.suffix}"] = made
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
    options = [*OPTIONS] if system is WINDOWS else [*OPTIONS, "-fPIC"]
    if system in (LINUX, LINUX_ARM):
        options.append("-Wl,-Bsymbolic")
    command = [*_compiler(system), *options, source, "-o", str(library), "-lm"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode or not library.is_file():
        first = next((line for line in done.stderr.splitlines() if "error" in line), done.stderr)
        raise InputError(
            f"The C of the FMU does not compile for {system.name}: {first.strip()[:300]}"
        )
    return library.read_bytes()
