"""The right-hand side as C, and the time gcc's code for it takes."""

import ctypes
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.program.program import program
from ptp_symbolic.symbolic.targets.c99.language import DOUBLE

FLAGS = ("-O3", "-march=native", "-fno-math-errno", "-shared", "-fPIC")
LOOPS = """
#include <math.h>
static inline void rhs(const double *x, const double *u, const double *p, double *dx) {
%(body)s
}
double chained(long count, double *x, const double *u, const double *p) {
    double dx[%(n)d];
    for (long i = 0; i < count; i++) {
        rhs(x, u, p, dx);
        for (int a = 0; a < %(n)d; a++) x[a] += 1e-9 * dx[a];
    }
    return x[0];
}
double independent(long count, long states, const double *x, const double *u, const double *p) {
    double dx[%(n)d], total = 0.0;
    for (long i = 0; i < count; i++) {
        rhs(x + %(n)d * (i %% states), u, p, dx);
        for (int a = 0; a < %(n)d; a++) total += dx[a];
    }
    return total;
}
"""


def c_text(model: Model) -> str:
    """C of the vector field of `model`, with the two loops that time it."""
    assert model.platform is not None
    kernel = program(assemble(model.platform)).kernel("mode_derivative")
    assert kernel is not None
    lines = [f"    const double {name} = {a}[{k}];" for name, a, k in kernel.unpacked]
    for target, expression in kernel.lines:
        kind = "" if target.startswith("dx[") else "const double "
        lines.append(f"    {kind}{target} = {DOUBLE.expression(expression)};")
    return LOOPS % {"body": "\n".join(lines), "n": len(model.state_names)}


def compile_c(model: Model) -> ctypes.CDLL | None:
    """The compiled loops, or None without gcc."""
    compiler = shutil.which("gcc")
    if compiler is None:
        return None
    folder = Path(tempfile.mkdtemp(prefix="ptp-symbolic-benchmark-"))
    (folder / "rhs.c").write_text(c_text(model), encoding="utf-8")
    command = [compiler, *FLAGS, str(folder / "rhs.c"), "-o", str(folder / "rhs.so"), "-lm"]
    subprocess.run(command, check=True)
    library = ctypes.CDLL(str(folder / "rhs.so"))
    shutil.rmtree(folder)
    library.chained.restype = library.independent.restype = ctypes.c_double
    return library


def pointer(values: NDArray[np.float64]) -> ctypes.c_void_p:
    """Address of an array for C."""
    return ctypes.c_void_p(values.ctypes.data)
