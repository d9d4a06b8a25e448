"""Kernels compiled by other processes while this one derives equations.

numba compiles each on one core, for up to half a minute, once on a new machine, and keeps it where
every process finds it. What goes wrong there costs time alone: it is compiled where it is needed.
"""

import atexit
import contextlib
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numba

from ptp_symbolic.numeric.runtime import shipped
from ptp_symbolic.numeric.simulation.kernels.records import source_stamp

RUNNER, SAMPLED_RUNNER, HELD_SAMPLES = "runner", "sampled-runner", "held-samples"
LEAN_RUNNER = "lean-runner"
FIXED_RUNNER, SMOOTH_RUNNER = "fixed-runner", "smooth-runner"
PACKAGE = "ptp_symbolic.numeric.simulation"
COMPILE = {
    RUNNER: f"from {PACKAGE}.hybrid import runner; runner(False)",
    LEAN_RUNNER: f"from {PACKAGE}.hybrid import runner; runner(False, True)",
    SAMPLED_RUNNER: f"from {PACKAGE}.hybrid import runner; runner(True)",
    HELD_SAMPLES: f"from {PACKAGE}.sampling import loop; loop()",
    SMOOTH_RUNNER: f"from {PACKAGE}.smooth_runner import runner; runner()",
    FIXED_RUNNER: f"from {PACKAGE}.fixed_runner import runner; runner()",
}
MARKS = Path(numba.config.CACHE_DIR or Path(__file__).parent / "__pycache__")

_begun: dict[str, "subprocess.Popen[bytes]"] = {}


def compile_ahead(*kernels: str) -> None:
    """Begin to compile `kernels` (keys of COMPILE), each in a process of its own, unless that was
    done before or is under way.
    """
    for kernel in kernels:
        begin(kernel, COMPILE[kernel])


def begin(kernel: str, code: str) -> None:
    """Begin to compile the kernel by `code` in another process, as `compile_ahead` does."""
    known = kernel in _begun or _mark(kernel).exists() or _came_along(kernel)
    if known or not sys.executable:  # embedded in another program
        return
    command = [sys.executable, "-P", "-c", code]
    nothing = subprocess.DEVNULL
    with contextlib.suppress(OSError):
        process = subprocess.Popen(command, stdin=nothing, stdout=nothing, stderr=nothing)
        atexit.register(process.kill)
        _begun[kernel] = process


def wait_until_compiled(kernel: str) -> None:
    """Return when no process that `compile_ahead` began is at work on the kernel."""
    process = _begun.get(kernel)
    if process is not None:
        process.wait()


def made_once(kernel: str, make: Callable[[], Callable[..., int]]) -> Callable[..., int]:
    """The kernel that `make` compiles, or finds compiled, when no process that `compile_ahead`
    began is at work on it; it is noted.
    """
    wait_until_compiled(kernel)
    made = make()
    note_compiled(kernel)
    return made


def note_compiled(kernel: str) -> None:
    """Leave a mark for `compile_ahead`, in the place of those of other sources. Where nothing may
    be written there is none, and every process begins another, which finds the kernel soon.
    """
    mark = _mark(kernel)
    with contextlib.suppress(OSError):
        mark.touch()
    for old in mark.parent.glob(f"{kernel}-of-*"):
        if old != mark:
            with contextlib.suppress(OSError):
                old.unlink()


def _mark(kernel: str) -> Path:
    """A file that tells by its name for which sources, numba and Python a kernel was compiled; if
    it has been taken away since, that costs time alone.
    """
    return MARKS / _mark_name(kernel)


def _mark_name(kernel: str) -> str:
    version = f"{numba.__version__}-{sys.implementation.cache_tag}"
    return f"{kernel}-of-{source_stamp():x}-{version}"


def _came_along(kernel: str) -> bool:
    """Whether the kernel came with the installation."""
    return shipped.fits() and (shipped.FOLDER / _mark_name(kernel)).exists()
