"""Exported C, compiled and called."""

import ctypes
import shutil
import subprocess
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.symbolic.program.program import Program
from ptp_symbolic.symbolic.targets.c99 import C99

FloatArray = NDArray[np.float64]
STRICT = ["-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror", "-pedantic"]
COMPILERS = [c for c in ("gcc", "clang") if shutil.which(c)]


def compiled(
    program: Program, name: str, target: C99, folder: Path, compiler: str, *options: str
) -> Path:
    """The shared library of a program, built without one warning; no fused operations, which a
    compiler may else make of a product and a sum.
    """
    for file, text in target.files(program, name).items():
        (folder / file).write_text(text)
    library = folder / f"{name}-{compiler}.so"
    command = [compiler, *STRICT, *(options or ("-O0",)), "-ffp-contract=off", "-shared", "-fPIC"]
    done = subprocess.run(
        [*command, f"{name}.c", "-o", str(library), "-lm"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[:2000]
    return library


def pointer(array: FloatArray) -> ctypes.c_void_p:
    """The address of an array."""
    return array.ctypes.data_as(ctypes.c_void_p)


class Stepped:
    """A machine of an exported library, taken in fixed steps."""

    def __init__(self, library: Path, name: str, p: FloatArray) -> None:
        self.functions, self.name, self.p = ctypes.CDLL(str(library)), name, p
        self.room = ctypes.create_string_buffer(1 << 18)

    def call(self, function: str, *given: FloatArray | float) -> int:
        """Status of a function of the machine."""
        values = [ctypes.c_double(g) if isinstance(g, float) else pointer(g) for g in given]
        return int(getattr(self.functions, f"{self.name}_{function}")(self.room, *values))

    def run(self, x: FloatArray, times: FloatArray, inputs: FloatArray, step: float) -> FloatArray:
        """States [k, n] at `times` [k]; inputs [k, nu] are held from each to the next."""
        x = x.copy()
        assert self.call("begin", float(times[0]), x, np.ascontiguousarray(inputs[0]), self.p) == 0
        found = [x.copy()]
        samples = hasattr(self.functions, f"{self.name}_sample_now")
        for k in range(len(times) - 1):
            u, ahead = (np.ascontiguousarray(inputs[j]) for j in (k, k + 1))
            status = self.call("advance", float(times[k]), float(times[k + 1]), step, x, u, self.p)
            assert status == 0, (times[k], status)
            if samples:  # what is seen at an instant is what its samplers have set
                self.call("sample_now", float(times[k + 1]), x, ahead, self.p)
            found.append(x.copy())
        return np.array(found)
