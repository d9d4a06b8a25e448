"""The runner compiled by another process while this one derives equations.

numba compiles it on one core for most of a minute, once on a new machine, and keeps it where every
process finds it. What goes wrong there costs time alone: the runner is compiled where it is needed.
"""

import atexit
import contextlib
import subprocess
import sys
from pathlib import Path

import numba

from ptp_symbolic.numeric.simulation.kernels.records import source_stamp

COMPILE = "from ptp_symbolic.numeric.simulation.hybrid import runner; runner({sampled})"

_begun: dict[bool, "subprocess.Popen[bytes]"] = {}


def compile_ahead(sampled: bool = False) -> None:
    """Begin to compile the runner for machines with samplers (`sampled`), or for those without,
    unless that was done before or is under way.
    """
    if sampled in _begun or _mark(sampled).exists():
        return
    if not sys.executable:  # embedded in another program
        return
    command = [sys.executable, "-P", "-c", COMPILE.format(sampled=sampled)]
    nothing = subprocess.DEVNULL
    with contextlib.suppress(OSError):
        process = subprocess.Popen(command, stdin=nothing, stdout=nothing, stderr=nothing)
        atexit.register(process.kill)
        _begun[sampled] = process


def wait_until_compiled(sampled: bool) -> None:
    """Return when no process that `compile_ahead` began is at work on the runner."""
    process = _begun.get(sampled)
    if process is not None:
        process.wait()


def note_compiled(sampled: bool) -> None:
    """Leave a mark for `compile_ahead`, in the place of those of other sources. Where nothing may
    be written there is none, and every process begins another, which finds the runner soon.
    """
    mark = _mark(sampled)
    with contextlib.suppress(OSError):
        mark.touch()
    for old in mark.parent.glob(f"{_name(sampled)}*"):
        if old != mark:
            with contextlib.suppress(OSError):
                old.unlink()


def _mark(sampled: bool) -> Path:
    """A file that tells by its name for which sources, numba and Python the runner was compiled; if
    it has been taken away since, that costs time alone.
    """
    version = f"{numba.__version__}-{sys.implementation.cache_tag}"
    return Path(__file__).parent / "__pycache__" / f"{_name(sampled)}{source_stamp():x}-{version}"


def _name(sampled: bool) -> str:
    return "sampled-runner-of-" if sampled else "runner-of-"
