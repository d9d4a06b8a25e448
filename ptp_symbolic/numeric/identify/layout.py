"""Where angles, rates, contacts and further states lie in the arrays of a model."""

from functools import lru_cache
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.kernels.calls import (
    OUTPUT_SIGNATURES,
    SIGNATURES,
    compiled_addresses,
)
from ptp_symbolic.numeric.simulation.kernels.records import INTEGERS

IntArray = NDArray[np.int64]


class Layout(NamedTuple):
    """Where things are in the arrays of a model; -1 for what an axis does not have.

    Per axis [na]: state index of angle and rate, of those of the gear output, the row of the gear
    output in the equations, and the contact between. Per friction [f]: its axis. Per further state
    [e]: its state index, and the friction that sets it to zero at rest.
    """

    angle: IntArray
    rate: IntArray
    gear_angle: IntArray
    gear_rate: IntArray
    gear_row: IntArray
    contact: IntArray
    rigid: IntArray
    friction_axis: IntArray
    further: IntArray
    zero_at_rest: IntArray
    rows: int
    states: int
    modes: int


LAYOUT = types.NamedTuple(
    [types.int64 if kind is int else INTEGERS for kind in Layout.__annotations__.values()], Layout
)


def layout_of(model: Model) -> Layout:
    """The layout of `model`.

    Raises InputError for a model whose states are set by samplers, which have no equation of
    motion, and for one with switches, which depend on what was before.
    """
    if len(model.contacts) > len(model.module.CONTACT_ANGLES):
        raise InputError(
            f"Model '{model.name}' has switches; its torques do not follow from the motion alone."
        )
    if len(model.sampled):
        raise InputError(
            f"Model '{model.name}' has sampled states;"
            " its equations have no residual along a motion."
        )
    states, axes = list(model.state_names), model.module.AXES
    rates = [name for name in states if name.startswith("omega_")]
    contact_of = {pair[1]: k for k, pair in enumerate(model.module.CONTACT_ANGLES)}

    def index(name: str) -> int:
        return states.index(name) if name in states else -1

    angle = np.array([index(f"theta_{a}") for a in axes], dtype=np.int64)
    gear_rate = np.array([index(f"omega_gear_{a}") for a in axes], dtype=np.int64)
    owner = {
        index(f"{word}_{a}"): k for k, a in enumerate(axes) for word in ("omega", "omega_gear")
    }
    mechanical = {i for i, name in enumerate(states) if name.startswith(("theta_", "omega_"))}
    further = [i for i in range(len(states)) if i not in mechanical]
    contact = np.array([contact_of.get(i, -1) for i in angle], dtype=np.int64)
    return Layout(
        angle=angle,
        rate=np.array([index(f"omega_{a}") for a in axes], dtype=np.int64),
        gear_angle=np.array([index(f"theta_gear_{a}") for a in axes], dtype=np.int64),
        gear_rate=gear_rate,
        gear_row=np.array(
            [
                rates.index(f"omega_gear_{a}") if g >= 0 else -1
                for a, g in zip(axes, gear_rate, strict=True)
            ],
            dtype=np.int64,
        ),
        contact=contact,
        rigid=np.array([model.contacts[c, 2] if c >= 0 else 0 for c in contact], dtype=np.int64),
        friction_axis=np.array([owner[int(r)] for r in model.friction_rates], dtype=np.int64),
        further=np.array(further, dtype=np.int64),
        zero_at_rest=model.zero_at_rest[further],
        rows=len(rates),
        states=len(states),
        modes=len(model.mode_names),
    )


def equation_addresses(model: Model) -> IntArray:
    """Addresses [3] of the compiled `equation_error`, `guards` and `outputs` of `model`."""
    kernel, outputs = SIGNATURES["guards"], OUTPUT_SIGNATURES["outputs"]
    return _addresses(model.module, kernel, outputs)


@lru_cache(maxsize=16)
def _addresses(module: ModuleType, kernel: Any, outputs: Any) -> IntArray:
    wanted = {"equation_error": kernel, "guards": kernel, "outputs": outputs}
    return compiled_addresses(module, wanted)
