"""Emitted text run as plain Python, before it is a module."""

import re
from types import ModuleType

from ptp_symbolic.api.effect_laws import as_python

__all__ = ["as_python", "module_as_python"]


def module_as_python(text: str) -> ModuleType:
    """The module with this text, none of its functions compiled."""
    module = ModuleType("plain")
    exec(re.sub(r"^@njit.*?\n|^from numba.*?\n", "", text, flags=re.M), module.__dict__)
    return module
