"""Emitted modules run as plain Python: what a formula says is seen without compiling it."""

import re
from dataclasses import replace
from pathlib import Path
from types import ModuleType

from ptp_symbolic.numeric.runtime.model import Model


def module_as_python(text: str) -> ModuleType:
    """The module with this text, none of its functions compiled."""
    module = ModuleType("plain")
    exec(re.sub(r"^@njit.*?\n|^from numba.*?\n", "", text, flags=re.M), module.__dict__)
    return module


def as_python(model: Model) -> Model:
    """`model` with functions that are not compiled."""
    text = Path(str(model.module.__file__)).read_text(encoding="utf-8")
    return replace(model, module=module_as_python(text))
