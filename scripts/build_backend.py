"""Build the package with setuptools, and compile its kernels ahead: a PEP 517 backend.

The runners and the committed models are compiled for any processor of the last ten years, which
takes a minute or two, and their code goes into the wheel, which is then one for this Python and
this kind of machine. Where that is not possible, or PTP_SYMBOLIC_AHEAD=0 says not to, the wheel
holds Python alone, and every machine compiles what it runs.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from setuptools import build_meta, dist

CHECKOUT = Path(__file__).resolve().parent.parent
COMPILED = CHECKOUT / "ptp_symbolic" / "compiled"
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
# Lanes, and outputs with their derivatives; `ideal` is smooth as `payload` is.
OF_BATCHES = AS_INSTALLED + (
    "import ptp_symbolic as ptp; ptp.simulate_batch('ideal', 0.01);"
    "ptp.simulate_batch('payload', 0.01);"
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


def compilers() -> list[str]:
    """The requirements of the package that its kernels are compiled with."""
    if not is_wanted():
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
    """Fill the folder of compiled kernels anew; leave none where that fails."""
    shutil.rmtree(COMPILED, ignore_errors=True)
    if not is_wanted():
        return
    with tempfile.TemporaryDirectory() as scratch:
        made = Path(scratch, "compiled")
        made.mkdir()
        if compiled_into(made, Path(scratch)):
            shutil.copytree(made, COMPILED)
            # A wheel with machine code is one for this kind of machine.
            dist.Distribution.has_ext_modules = lambda self: True


def compiled_into(folder: Path, scratch: Path) -> bool:
    """Compile every runner and model, one process for each, into a folder."""
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
        rest = pool.map(is_compiled, [COMPILE_FIT, *others, OF_BATCHES])
        done = all([*runners, *rest])
    for mark in (scratch / "numba").glob("*-of-*"):
        shutil.copy(mark, folder)
    return done
