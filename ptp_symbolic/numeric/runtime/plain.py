"""Emitted modules run as plain Python: what a formula says is seen without compiling it."""

from dataclasses import replace
from types import FunctionType, ModuleType
from typing import TypeVar

from numba.core.registry import CPUDispatcher

from ptp_symbolic.numeric.runtime.model import Model

AnyModel = TypeVar("AnyModel", bound=Model)


def as_python(model: AnyModel) -> AnyModel:
    """`model` with functions that are not compiled, and call each other as such."""
    plain = ModuleType(model.module.__name__)
    space = vars(plain)
    space.update(vars(model.module))
    for name, function in vars(model.module).items():
        if isinstance(function, CPUDispatcher):
            space[name] = FunctionType(function.py_func.__code__, space, name)
    return replace(model, module=plain)
