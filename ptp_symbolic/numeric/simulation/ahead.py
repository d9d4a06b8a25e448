"""The runner compiled by another process while this one derives equations.

numba compiles it on one core for most of a minute, once on a new machine, and keeps it where every
process finds it. What goes wrong there costs time alone: the runner is compiled where it is needed.
"""

import atexit
import contextlib
import subprocess
import sys
from pathlib import Path

from ptp_symbolic.numeric.simulation.kernels.records import source_stamp

COMPILE = "from ptp_symbolic.numeric.simulation.hybrid import runner; runner({sampled})"

_begun: dict[bool, "subprocess.Popen[bytes]"] = {}


def compile_ahead(sampled: bool = False) -> None:
    """Begin to compile the runner for machines with samplers (`sampled`), or for those without,
    unless that was done before or is under way.
    """
    if sampled in _begun or _mark(sampled).exists():
        return
    command = [sys.executable, "-c", COMPILE.format(sampled=sampled)]
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
    """Leave a mark for `compile_ahead`; where nothing may be written, there is none."""
    mark = _mark(sampled)
    with contextlib.suppress(OSError):
        for old in mark.parent.glob(f"{_name(sampled)}*"):
            old.unlink()
        mark.touch()


def _mark(sampled: bool) -> Path:
    """Beside the compiled kernels, with a number of their sources in its name."""
    return Path(__file__).parent / "__pycache__" / f"{_name(sampled)}{source_stamp():x}"


def _name(sampled: bool) -> str:
    return f"{'sampled-' if sampled else ''}runner-of-"
