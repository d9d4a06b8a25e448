"""Equations of motion of pan-tilt platforms: derived, proved, compiled, fitted, diagnosed."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ptp_symbolic.runtime.model import Model

__version__ = "0.1.0"
__all__ = ["__version__", "inverse_dynamics", "load", "sensitivity", "simulate"]


def load(source: str | Path) -> Model:
    """Load a model by the name of a committed one, a packaged preset, or a platform file.

    Raises InputError when there is no such model, or the platform cannot be used.
    """
    from ptp_symbolic.runtime.loader import load_model, model_names

    if str(source) in model_names():
        return load_model(str(source))
    from ptp_symbolic.errors import InputError
    from ptp_symbolic.platform import preset_names, read_platform

    if not Path(source).suffix and str(source) not in preset_names():
        choices = ", ".join((*model_names(), *preset_names()))
        raise InputError(
            f"Unknown model '{source}'. Choose one of: {choices}; or give a TOML file."
        )
    from ptp_symbolic.loop import emit

    return emit(read_platform(source))


def simulate(model: Model, *args: Any, **kwargs: Any) -> Any:
    """Simulate `model`; see `ptp_symbolic.simulation.run.simulate` for the arguments."""
    return importlib.import_module("ptp_symbolic.simulation.run").simulate(model, *args, **kwargs)


def sensitivity(model: Model, *args: Any, **kwargs: Any) -> Any:
    """Forward sensitivities of `model`; see `ptp_symbolic.sensitivities.forward.sensitivity`."""
    return importlib.import_module("ptp_symbolic.sensitivities.forward").sensitivity(
        model, *args, **kwargs
    )


def inverse_dynamics(machine: Any, *args: Any, **kwargs: Any) -> Any:
    """Torques that a motion takes; see `ptp_symbolic.joint_torques.inverse_dynamics`."""
    return importlib.import_module("ptp_symbolic.joint_torques").inverse_dynamics(
        machine, *args, **kwargs
    )
