"""Emitted functions compiled anew for the parameters that are zero.

A model that carries candidates evaluates the terms of all of them, though most are at zero: four
fifths of its arithmetic. LLVM leaves these out where it is told which numbers are zero, and which
columns of a Jacobian are read; what is left gives the same bits. That takes a few hundredths of a
second, which pays after some runs.
"""

import re
import threading
from dataclasses import dataclass
from functools import lru_cache
from types import ModuleType

import llvmlite.binding as llvm
import numpy as np
from numba.core.compiler_lock import global_compiler_lock
from numpy.typing import NDArray

from ptp_symbolic.numeric.simulation.kernels.calls import (
    DERIVATIVE,
    GUARDS,
    LINEARIZE,
    SIGNATURES,
    addresses,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

PAYS_AFTER = 50_000  # samples; each is integrated about 1 us faster
SPECIALISED = {"prepared_derivative": DERIVATIVE, "linearize": LINEARIZE, "guards": GUARDS}
# A product with zero is zero, whatever its sign: nothing that is finite changes its value.
ZERO_ANNIHILATES = (r"\b(fmul|fadd|fsub|fdiv) double", r"\1 nnan nsz double")
MEMSET = "declare void @llvm.memset.p0.i64(ptr, i8, i64, i1)"


@dataclass(frozen=True, eq=False)
class Zeros:
    """Which entries of the arguments x [n], p [np] and c of emitted functions are zero, and which
    `columns` [nc] of the Jacobian by p are read.
    """

    x: BoolArray
    p: BoolArray
    c: BoolArray
    columns: IntArray

    @property
    def key(self) -> tuple[bytes, ...]:
        """Equal where the same functions will do."""
        return tuple(a.tobytes() for a in (self.x, self.p, self.c, self.columns))


def zeros_of(x: FloatArray, acting: int, p: FloatArray, c: FloatArray, columns: IntArray) -> Zeros:
    """The zeros of a run: states after the first `acting` stay where they are in x [n]; parameters
    in `columns` are not taken for zero, for their derivatives count.
    """
    zero_p = p == 0.0
    zero_p[columns] = False
    zero_x = x == 0.0
    zero_x[:acting] = False
    return Zeros(zero_x, zero_p, c == 0.0, columns)


@lru_cache(maxsize=256)
def specialised(module: ModuleType) -> "Specialised":
    """What has been compiled for zeros of an emitted module."""
    return Specialised(module)


class Specialised:
    """The functions of an emitted module for the zeros that were met often enough."""

    def __init__(self, module: ModuleType) -> None:
        self.module = module
        self.samples: dict[tuple[bytes, ...], int] = {}
        self.ready: dict[tuple[bytes, ...], IntArray] = {}
        self.compiling = threading.Lock()
        self.machine = _target_machine()
        self.engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _target_machine())

    def addresses(self, zeros: Zeros, samples: int) -> IntArray:
        """Addresses as `calls.addresses` gives them, for a run of so many `samples`."""
        key = zeros.key
        found = self.ready.get(key)
        if found is not None:
            return found
        usual = addresses(self.module)
        seen = self.samples[key] = self.samples.get(key, 0) + samples
        if seen < PAYS_AFTER or not self.compiling.acquire(blocking=False):
            return usual
        try:
            with global_compiler_lock:
                own = usual.copy()
                for name, place in SPECIALISED.items():
                    own[place] = self._compiled(name, f"{name}_{len(self.ready)}", zeros)
            self.ready[key] = own
        finally:
            self.compiling.release()
        return own

    def _compiled(self, name: str, own: str, zeros: Zeros) -> int:
        """The address of the function `name` compiled for `zeros` as one of its `own` name.

        Only its object code is kept, all of it in one engine: one of its own would hold 0.8 MB for
        some kB of code.
        """
        emitted = getattr(self.module, name).get_compile_result(SIGNATURES[name])
        text = str(emitted.library._get_module_for_linking())
        code = llvm.parse_assembly(_for_zeros(text, emitted.fndesc.llvm_func_name, own, zeros))
        code.verify()
        options = llvm.create_pipeline_tuning_options(speed_level=3)
        options.slp_vectorization = False
        passes = llvm.create_pass_builder(self.machine, options)
        passes.getModulePassManager().run(code, passes)
        found = llvm.ObjectFileRef.from_data(self.machine.emit_object(code))
        self.engine.add_object_file(found)
        self.engine.finalize_object()
        return int(self.engine.get_function_address(own))


def _target_machine() -> llvm.TargetMachine:
    return llvm.Target.from_triple(llvm.get_process_triple()).create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=3,
        jit=True,
        codemodel="jitdefault",
    )


def _for_zeros(text: str, symbol: str, own: str, zeros: Zeros) -> str:
    """LLVM code of a function named `own` that calls the one named `symbol` in `text` with copies
    of x, p and c in which zeros are constants, and copies back the columns that are read.
    """
    begun = re.search(rf"^define [^\n]*@{re.escape(symbol)}\(", text, re.MULTILINE)
    assert begun is not None
    head, rest = text[begun.end() : text.index("\n}\n", begun.end())].split("\n", 1)
    arguments = _arguments(head)
    listed = ", ".join(f"{kind} {name}" for kind, name in arguments)
    given = {name: name for _, name in arguments}
    lines: list[str] = []
    for array, zero in (("x", zeros.x), ("p", zeros.p), ("c", zeros.c)):
        if f"%arg.{array}.4" in given:
            lines += _copied(array, zero)
            given[f"%arg.{array}.4"] = f"%own.{array}"
    back: list[str] = []
    if "%arg.fp.4" in given:
        rows, width = len(zeros.x), len(zeros.p)
        lines += [
            f"%own.fp = alloca [{rows * width} x double]",
            f"call void @llvm.memset.p0.i64(ptr %own.fp, i8 0, i64 {8 * rows * width}, i1 false)",
        ]
        given |= {"%arg.fp.4": "%own.fp", "%arg.fp.5.1": str(width)}
        back = _copied_back(rows, width, zeros.columns)
    call = ", ".join(f"{kind} {given[name]}" for kind, name in arguments)
    whole = text.split("\n")
    beside = [line for line in whole if line.startswith(("declare", "attributes", "!"))]
    if "@llvm.memset" not in "\n".join(beside):
        beside.append(MEMSET)
    return "\n".join(
        [
            *(line for line in whole if line.startswith("target")),
            f"define i32 @{own}({listed}) {{",
            "entry:",
            *lines,
            f"%status = call i32 @emitted({call})",
            *back,
            "ret i32 %status",
            "}",
            f"define internal i32 @emitted({listed}) alwaysinline {{",
            re.sub(*ZERO_ANNIHILATES, rest),
            "}",
            *beside,
            "",
        ]
    )


def _arguments(head: str) -> list[tuple[str, str]]:
    """Type and name of every argument in the rest of a line that defines a function."""
    depth, texts = 0, [""]
    for letter in head:
        depth += (letter == "(") - (letter == ")")
        if depth < 0:
            break
        if letter == "," and depth == 0:
            texts.append("")
        else:
            texts[-1] += letter
    return [(text.split()[0], text.split()[-1]) for text in texts]


def _copied(array: str, zero: BoolArray) -> list[str]:
    """Code that copies an argument, its zeros as constants."""
    lines = [f"%own.{array} = alloca [{max(len(zero), 1)} x double]"]
    for k, is_zero in enumerate(zero):
        value, place = f"%value.{array}.{k}", f"%place.{array}.{k}"
        lines.append(f"{place} = getelementptr double, ptr %own.{array}, i64 {k}")
        if is_zero:
            value = "0.0"
        else:
            lines += [
                f"%given.{array}.{k} = getelementptr double, ptr %arg.{array}.4, i64 {k}",
                f"{value} = load double, ptr %given.{array}.{k}",
            ]
        lines.append(f"store double {value}, ptr {place}")
    return lines


def _copied_back(rows: int, width: int, columns: IntArray) -> list[str]:
    """Code that copies columns of the Jacobian by p to where they are asked for, each once."""
    lines, asked = [], np.unique(columns)
    for k in (row * width + int(column) for row in range(rows) for column in asked):
        lines += [
            f"%from.{k} = getelementptr double, ptr %own.fp, i64 {k}",
            f"%entry.{k} = load double, ptr %from.{k}",
            f"%to.{k} = getelementptr double, ptr %arg.fp.4, i64 {k}",
            f"store double %entry.{k}, ptr %to.{k}",
        ]
    return lines
