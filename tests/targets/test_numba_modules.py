"""Emitted modules as numba compiles them: nothing is allocated, single precision stays single."""

import ast
import math
import re
from functools import cache
from types import ModuleType

import numpy as np
import pytest
from numba import njit, types
from numba.core.runtime import _nrt_python, rtsys

import ptp_symbolic
from ptp_symbolic.symbolic.program.kernel import Kernel
from ptp_symbolic.symbolic.targets.numba.language import FLOAT
from ptp_symbolic.symbolic.targets.numba.literals import INNER_WIDTH, UNBROKEN, WIDTH, tuple_text
from ptp_symbolic.symbolic.targets.numba.module import written
from tests.targets.machines import NAMES, Sampled, program_of
from tests.targets.test_every_target import exact

MACHINES = [
    name if name == "thesis-pan-servo" else pytest.param(name, marks=pytest.mark.long)
    for name in NAMES
]
ROUNDING = 8.0 * float(np.finfo(np.float32).eps)  # of sums and products one after the other
# What numba's wrapper does with the time, a float of Python, before it calls the function.
OF_THE_CALLER = re.compile(r"@PyFloat_AsDouble\(|fptrunc double %\S+ to float")
OF_LIBM = re.compile(r"@(?:sin|cos|exp|log|acos|pow)\(")


@pytest.mark.parametrize("name", ["pan_drive", "tilt_drive", "full"])
def test_nothing_is_allocated_at_a_call(name: str) -> None:
    """Numba counts what its memory manager hands out, as it does for an array that is made."""
    _nrt_python.memsys_enable_stats()
    model = ptp_symbolic.load(name)
    p, m = model.parameter_vector(), np.empty(len(model.mode_names))
    x, u = np.full(len(model.state_names), 0.1), np.ones(len(model.input_names))
    dx = np.empty_like(x)

    def allocations(*calls: tuple) -> int:
        for function, *arguments in calls:
            function(*arguments)  # compiled
        before = rtsys.get_allocation_stats().alloc
        for function, *arguments in calls:
            function(*arguments)
        return int(rtsys.get_allocation_stats().alloc - before)

    module = model.module
    assert allocations((njit(lambda n: np.empty(n).sum()), 3)) >= 1
    assert (
        allocations(
            (module.initial_modes, 0.0, x, u, p, m), (module.state_derivative, 0.0, x, u, p, dx)
        )
        == 0
    )


@cache
def single(name: str) -> ModuleType:
    """The module of a machine in single precision, compiled by numba when it is called."""
    module = ModuleType("single")
    text = written(program_of(name), FLOAT).replace("cache=True, ", "")
    exec(compile(text, "single", "exec"), module.__dict__)
    return module


def signature(kernel: Kernel) -> tuple[types.Type, ...]:
    """Types of the arguments of a kernel in single precision."""
    return tuple(
        types.float32 if a == "t" else types.Array(types.float32, len(kernel.vectors.shape(a)), "C")
        for a in kernel.arguments
    )


@pytest.mark.parametrize("name", MACHINES)
def test_single_precision_is_never_promoted(name: str) -> None:
    """No variable that numba infers is a double, but for the digits that `float32` rounds; no
    instruction that it compiles has one.
    """
    module, vector = single(name), types.Array(types.float32, 1, "C")
    called = {kernel.name: signature(kernel) for kernel in program_of(name).kernels}
    called |= dict.fromkeys(("initial_modes", "state_derivative"), (types.float32, *[vector] * 4))
    for function, given in called.items():
        getattr(module, function).compile(given)
        code = getattr(module, function).inspect_llvm(given)
        found = [
            line
            for line in code.splitlines()
            if re.search(r"\bdouble\b", line) and not OF_THE_CALLER.search(line)
        ]
        assert found == [] and not OF_LIBM.search(code), function
    for function in vars(module).values():
        for compiled in getattr(function, "overloads", {}).values():
            inferred = compiled.type_annotation.typemap.items()
            wide = [v for v, kind in inferred if "float64" in str(kind) and v[0] != "$"]
            assert wide == [] and len(inferred) > 0, function


@pytest.mark.parametrize("name", MACHINES)
def test_single_precision_is_that_of_the_equations(name: str) -> None:
    """To its own rounding, beside 50 digits; a time that is a float of Python promotes nothing."""
    if program_of(name).has_rigid_contacts:
        pytest.skip("rigid contacts join rows")
    module = single(name)
    for seed in (1, 2, 3):
        given = Sampled(name, seed)
        rounded = {a: getattr(given, a).astype(np.float32) for a in "xupm"}
        for array, values in rounded.items():
            setattr(given, array, values.astype(float))
        given.t = float(np.float32(given.t))
        field, outputs = exact(name, given)
        dx, y = np.zeros(len(field), np.float32), np.zeros(len(outputs), np.float32)
        x, u, p, m = rounded.values()
        module.mode_derivative(given.t, x, u, p, m, dx)
        module.outputs(given.t, x, u, p, y)
        for found, truth in ((dx, field), (y, outputs)):
            scale = max(1.0, *map(abs, truth))
            worst = max(abs(float(a) - b) for a, b in zip(found, truth, strict=True))
            assert worst <= ROUNDING * scale and math.isfinite(worst), name


@pytest.mark.parametrize("count", range(1, 30))
def test_a_statement_with_many_targets_is_broken_where_it_may_be(count: int) -> None:
    """Python has no line that begins with an equals sign: fifteen guards of a joint with slip
    elements ended up so.
    """
    call = f"{UNBROKEN}={UNBROKEN}guard_values({', '.join(f'given_{k}' for k in range(count))})"
    text = tuple_text("", [f"g[{k}]" for k in range(count)], INNER_WIDTH, call)
    (statement,) = ast.parse(text).body
    assert isinstance(statement, ast.Assign) and isinstance(statement.targets[0], ast.Tuple)
    assert len(statement.targets[0].elts) == count
    assert all(len(line) <= WIDTH for line in text.splitlines())
