"""Rates that are measured without the angle: possible where nothing depends on the angle."""

from collections.abc import Collection

import numpy as np

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.model import Model


def has_angle(signals: Collection[str], rate: str) -> bool:
    """Whether the angle of a joint is among the `signals` beside its `rate`, omega_<axis>."""
    return rate.replace("omega_", "theta_", 1) in signals


def refuse_unseen_angles(model: Model, signals: Collection[str]) -> None:
    """Raise InputError where an axis of `model` has its rate among `signals` and not its angle,
    though the angle acts on the motion at the default parameters: a run could begin anywhere.
    """
    states = list(model.state_names)
    at_zero, still = np.zeros(len(states)), np.zeros(len(model.input_names))
    p = model.parameter_vector()
    for axis in model.module.AXES:
        if f"omega_{axis}" not in signals or has_angle(signals, f"omega_{axis}"):
            continue
        turned = at_zero.copy()
        for name in (f"theta_{axis}", f"theta_gear_{axis}"):
            if name in states:
                turned[states.index(name)] = 1.0
        before, after = (model.rhs(0.0, x, still, p) for x in (at_zero, turned))
        if not np.allclose(before, after, rtol=1e-9, atol=1e-12):
            raise InputError(
                f"Axis '{axis}' has a rate and no angle among its signals, and its motion depends"
                f" on the angle; measure the angle too and declare [signals.theta_{axis}]."
            )
