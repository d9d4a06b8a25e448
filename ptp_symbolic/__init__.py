"""Equations of motion of pan-tilt platforms: derived, proved, compiled, fitted, diagnosed."""

from __future__ import annotations

import importlib
from typing import Any

__version__ = "0.1.0"

# Imported when they are first asked for: importing the package stays free of SymPy and numba. The
# types are in `__init__.pyi`: they stand above rooms that import this file.
_HOMES = {
    "InputError": "ptp_symbolic.errors",
    "SimulationError": "ptp_symbolic.numeric.simulation.run",
    "Platform": "ptp_symbolic.platform",
    "read_platform": "ptp_symbolic.platform",
    "Model": "ptp_symbolic.numeric.runtime.model",
    "Machine": "ptp_symbolic.api.machine",
    "Jacobian": "ptp_symbolic.api.machine",
    "load": "ptp_symbolic.api.machine",
    "Linearization": "ptp_symbolic.api.linearization",
    "Run": "ptp_symbolic.api.run",
    "Event": "ptp_symbolic.numeric.simulation.run",
    "simulate": "ptp_symbolic.api.simulation",
    "simulate_batch": "ptp_symbolic.api.batch",
    "batch_function": "ptp_symbolic.api.batch",
    "Batch": "ptp_symbolic.api.batch_results",
    "sensitivity": "ptp_symbolic.api.simulation",
    "Sensitivities": "ptp_symbolic.numeric.sensitivities",
    "inverse_dynamics": "ptp_symbolic.models.inverse_dynamics",
    "export": "ptp_symbolic.api.export",
    "read_robot": "ptp_symbolic.formats.robots.imported",
    "ImportedPlatform": "ptp_symbolic.formats.robots.imported",
    "Log": "ptp_symbolic.api.logs",
    "read_log": "ptp_symbolic.api.logs",
    "sample": "ptp_symbolic.api.logs",
    "Estimate": "ptp_symbolic.api.results",
    "FitResult": "ptp_symbolic.api.results",
    "fit": "ptp_symbolic.api.results",
    "Diagnosis": "ptp_symbolic.api.results",
    "diagnose": "ptp_symbolic.api.results",
    "Experiment": "ptp_symbolic.api.results",
    "experiment": "ptp_symbolic.api.results",
    "FrictionMap": "ptp_symbolic.api.results",
    "friction_map": "ptp_symbolic.api.results",
    "Effect": "ptp_symbolic.symbolic.effect_interface.effect",
    "check_effect": "ptp_symbolic.api.effect_laws",
}
__all__ = ["__version__", *_HOMES]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'ptp_symbolic' has no attribute '{name}'")
    globals()[name] = found = getattr(importlib.import_module(_HOMES[name]), name)
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
