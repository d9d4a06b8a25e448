"""Equations of motion of pan-tilt platforms: derived, proved, compiled, fitted, diagnosed."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ptp_symbolic.numeric.runtime.model import Model
    from ptp_symbolic.numeric.sensitivities.forward import sensitivity
    from ptp_symbolic.numeric.simulation.run import simulate

__version__ = "0.1.0"
__all__ = ["__version__", "inverse_dynamics", "load", "sensitivity", "simulate"]

# Imported when they are first asked for: importing the package stays free of SymPy and numba. Some
# of them stand above rooms that import this file, so that not even a type checker may follow them.
_HOMES = {
    "inverse_dynamics": "ptp_symbolic.models.inverse_dynamics",
    "sensitivity": "ptp_symbolic.numeric.sensitivities.forward",
    "simulate": "ptp_symbolic.numeric.simulation.run",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ptp_symbolic' has no attribute '{name}'")
    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})


def load(source: str | Path) -> Model:
    """Load a model by the name of a committed one, a packaged preset, or a platform file.

    Raises InputError when there is no such model, or the platform cannot be used.
    """
    from ptp_symbolic.numeric.runtime.loader import load_model, model_names

    if str(source) in model_names():
        return load_model(str(source))
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.models.emission import emit

    return emit(declared_platform(source))
