"""Libraries that are installed on demand."""

import importlib
from types import ModuleType

from ptp_symbolic.errors import InputError


def extra_library(name: str, extra: str = "python") -> ModuleType:
    """The library `name` of an `extra` of this package. Raises InputError, with what to run, where
    it is not installed.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise InputError(
            f"{name} is not installed; run pip install 'ptp-symbolic[{extra}]'."
        ) from error
