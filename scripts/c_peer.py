"""The emitted right-hand side as C, and the time gcc's code for it takes."""

import ast
import ctypes
import inspect
import shutil
import subprocess
import tempfile
import textwrap
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.runtime.model import Model

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
    """C of the emitted `mode_derivative`, line by line, with the two loops that time it."""
    source = textwrap.dedent(inspect.getsource(model.module.mode_derivative.py_func))
    function = ast.parse(source[source.index("def ") :]).body[0]
    assert isinstance(function, ast.FunctionDef)
    lines = []
    for statement in function.body:
        if not isinstance(statement, ast.Assign):
            continue
        target, value = ast.unparse(statement.targets[0]), ast.unparse(statement.value)
        if "**" in value:
            raise ValueError(f"no C for {value}")
        kind = "" if target.startswith("dx[") else "const double "
        lines.append(f"    {kind}{target} = {value.replace('math.', '')};")
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
