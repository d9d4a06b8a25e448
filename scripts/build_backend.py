"""Build the package with setuptools, and compile its kernels ahead: a PEP 517 backend.

The runners and the committed models are compiled for any processor of the last ten years, which
takes a minute or two, and their code goes into the wheel, which is then one for this Python and
this kind of machine. Where that is not possible, or PTP_SYMBOLIC_AHEAD=0 says not to, the wheel
holds Python alone, and every machine compiles what it runs. In a folder that
PTP_SYMBOLIC_AHEAD_KEPT names, what one build compiled is kept for the next one of the same sources.
"""

from __future__ import annotations

import hashlib
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

from setuptools import build_meta, dist

CHECKOUT = Path(__file__).resolve().parent.parent
COMPILED = CHECKOUT / "ptp_symbolic" / "compiled"
KEPT = "PTP_SYMBOLIC_AHEAD_KEPT"
# What decides on the machine code. Were it too little, code that does not fit would be passed over.
DECIDING = (
    "pyproject.toml",
    "scripts/build_backend.py",
    "generated",
    "ptp_symbolic/numeric/identify",
    "ptp_symbolic/numeric/simulation",
    "ptp_symbolic/numeric/runtime",
)
NEEDED = ("numba", "numpy", "scipy", "tomlkit", "markupsafe")  # to import and compile the kernels
MODELS = ("payload", "pan_drive", "full", "tilt_drive")
# The checkout as an installation has it: emitted modules inside the package.
AS_INSTALLED = "import sys, generated; sys.modules['ptp_symbolic.generated'] = generated; "
OF_A_MODEL = AS_INSTALLED + (
    "import ptp_symbolic as ptp;"
    "from ptp_symbolic.numeric.simulation.kernels import calls;"
    "model = ptp.load({name!r}); ptp.simulate(model, 0.01);"
    "calls.output_addresses(model.module); calls.addresses(model.module)"
)
# Outputs with their derivatives. What stands side by side in a batch is left out: compiled for the
# processor at hand it is 1.5 times as fast, which the five seconds that it takes once are worth.
OF_DERIVATIVES = AS_INSTALLED + (
    "import ptp_symbolic as ptp;"
    "ptp.simulate_batch('payload', 0.01, outputs=['theta_pan'], sensitivities=['m_payload'])"
)


def is_wanted() -> bool:
    """Whether kernels are to be compiled ahead."""
    return os.environ.get("PTP_SYMBOLIC_AHEAD", "1") != "0"


def get_requires_for_build_wheel(config_settings: Any = None) -> list[str]:
    """What setuptools needs, and what compiles the kernels, as `pyproject.toml` has it."""
    return [*build_meta.get_requires_for_build_wheel(config_settings), *compilers()]


def get_requires_for_build_editable(config_settings: Any = None) -> list[str]:
    """As for a wheel."""
    return [*build_meta.get_requires_for_build_editable(config_settings), *compilers()]


def kept() -> Path | None:
    """The folder for what is compiled of these sources by this Python; None where none is named."""
    named = os.environ.get(KEPT)
    if not named:
        return None
    digest = hashlib.sha256(f"{sys.version} {platform.platform()}".encode())
    for part in DECIDING:
        path = CHECKOUT / part
        for source in sorted(path.rglob("*.py")) if path.is_dir() else [path]:
            digest.update(source.read_bytes())
    return Path(named, digest.hexdigest()[:16])


def is_kept() -> bool:
    """Whether an earlier build has compiled these sources."""
    folder = kept()
    return folder is not None and folder.is_dir()


def compilers() -> list[str]:
    """The requirements of the package that its kernels are compiled with; none where they need not
    be compiled.
    """
    if not is_wanted() or is_kept():
        return []
    with (CHECKOUT / "pyproject.toml").open("rb") as file:
        required: list[str] = tomllib.load(file)["project"]["dependencies"]
    return [r for r in required if r.startswith(NEEDED)]


def build_wheel(
    wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None
) -> str:
    """A wheel with compiled kernels, where these could be compiled."""
    compile_ahead()
    return build_meta.build_wheel(wheel_directory, config_settings, metadata_directory)


def build_editable(
    wheel_directory: str, config_settings: Any = None, metadata_directory: str | None = None
) -> str:
    """An editable installation; kernels are compiled until their sources are changed."""
    compile_ahead()
    return build_meta.build_editable(wheel_directory, config_settings, metadata_directory)


def compile_ahead() -> None:
    """Fill the folder of compiled kernels anew with what compiles; keep it where all of it does."""
    shutil.rmtree(COMPILED, ignore_errors=True)
    if not is_wanted():
        return
    folder = kept()
    if folder is not None and folder.is_dir():
        shutil.copytree(folder, COMPILED)
    else:
        with tempfile.TemporaryDirectory() as scratch:
            made = Path(scratch, "compiled")
            made.mkdir()
            whole = compiled_into(made, Path(scratch))
            if not any(made.iterdir()):
                return
            shutil.copytree(made, COMPILED)
        if whole and folder is not None:
            keep(COMPILED, folder)
    # A wheel with machine code is one for this kind of machine.
    dist.Distribution.has_ext_modules = lambda self: True


def keep(made: Path, folder: Path) -> None:
    """Copy what was made to the folder, whole or not at all; where it cannot be, it is not kept."""
    with suppress(OSError):
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent) as scratch:
            shutil.copytree(made, Path(scratch, "whole")).rename(folder)


def compiled_into(folder: Path, scratch: Path) -> bool:
    """Compile every runner and model, one process for each, into a folder; whether all compiled."""
    sys.path.insert(0, str(CHECKOUT))
    try:
        from ptp_symbolic.numeric.identify.ahead import COMPILE_FIT
        from ptp_symbolic.numeric.runtime.shipped import WRITE_INTO, baseline
        from ptp_symbolic.numeric.simulation.ahead import COMPILE
    except ImportError as error:
        print(f"kernels are not compiled ahead: {error}")
        return False
    target = baseline()
    if target is None:
        return False
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join([str(CHECKOUT), *filter(None, sys.path)]),
        "NUMBA_CPU_NAME": target.cpu,
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_CACHE_DIR": str(scratch / "numba"),
        WRITE_INTO: str(folder),
    }

    def is_compiled(code: str) -> bool:
        ran = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True)
        if ran.returncode:
            print(ran.stderr.decode(errors="replace")[-2000:])
        return ran.returncode == 0

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        runners = list(pool.map(is_compiled, COMPILE.values()))
        others = [OF_A_MODEL.format(name=name) for name in MODELS]
        rest = pool.map(is_compiled, [COMPILE_FIT, *others, OF_DERIVATIVES])
        done = all([*runners, *rest])
    for mark in (scratch / "numba").glob("*-of-*"):
        shutil.copy(mark, folder)
    return done
