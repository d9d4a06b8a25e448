"""Values by name, in order, or as texts with units, made into the vectors of a model."""

import warnings
from collections.abc import Collection, Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform.units import quantity

FloatArray = NDArray[np.float64]
Quantity = float | str
Values = Mapping[str, Quantity] | ArrayLike


def state_vector(model: Model, given: Values | None, what: str = "State") -> FloatArray:
    """States [n] in SI: the initial ones of `model`, replaced by those `given`.

    Raises InputError for an unknown name, another number of values and what is no quantity.
    """
    return _vector(model, given, model.state_names, model.module.STATE_INITIAL, what)


def initial_vector(model: Model, given: Values | None) -> FloatArray:
    """The states [n] at the start, as `state_vector`; warns of a shaft that begins wound up because
    the gear output was not given with its joint.
    """
    start = state_vector(model, given, "Initial state")
    if isinstance(given, Mapping):
        states = dict(zip(model.state_names, start.tolist(), strict=True))
        for text in wound_up(model, given, states):
            warnings.warn(text, stacklevel=3)
    return start


def wound_up(model: Model, given: Collection[str], states: Mapping[str, float]) -> list[str]:
    """A line for every joint whose angle was `given` while that of its gear output, which was not,
    is another; `states` are all those at the start.
    """
    lines = []
    for joint in given:
        gear = joint.replace("theta_", "theta_gear_")
        if gear in states and gear not in given and states[gear] != states[joint]:
            unit = model.units[joint]
            lines.append(
                f"{joint} starts at {states[joint]:g} {unit} and {gear} at {states[gear]:g} {unit}:"
                f" a shaft between them starts wound up, a gap closed. Give {gear} too."
            )
    return lines


def input_vector(model: Model, given: Values | None) -> FloatArray:
    """Inputs [nu] in SI: zero, replaced by those `given`. Raises InputError as `state_vector`."""
    return _vector(model, given, model.input_names, [0.0] * len(model.input_names), "Input")


def parameter_values(model: Model, given: Values | None) -> dict[str, float]:
    """Those of the parameters that are `given`, in SI by name. Raises InputError for unknown names,
    another number of values and what is no quantity.
    """
    if given is None:
        return {}
    if isinstance(given, Mapping):
        return _named(model, given, model.parameter_names, "Parameter")
    vector = _vector(model, given, model.parameter_names, (), "Parameter")
    return dict(zip(model.parameter_names, map(float, vector), strict=True))


def parameter_vector(model: Model, given: Values | None) -> FloatArray:
    """Parameters [np] in SI: the defaults, replaced by those `given`.

    Raises InputError as `parameter_values`, for values out of bounds, and for values that no
    machine can have together.
    """
    values = parameter_values(model, given)
    vector = model.parameter_vector(values)
    model.refuse_impossible(vector, values)
    return vector


def _vector(
    model: Model,
    given: Values | None,
    names: Sequence[str],
    usual: Sequence[float],
    what: str,
) -> FloatArray:
    if given is None or isinstance(given, Mapping):
        values = _named(model, given or {}, names, what)
        pairs = zip(names, usual, strict=True)
        return np.array([values.get(name, float(value)) for name, value in pairs], np.float64)
    array = np.asarray(given)
    if array.shape != (len(names),):
        raise InputError(
            f"{what}s have shape {array.shape}; give [{len(names)}]: {', '.join(names)}."
        )
    pairs = zip(names, array.tolist(), strict=True)
    return np.array([quantity(v, model.units[n], f"{what} '{n}'") for n, v in pairs], np.float64)


def _named(
    model: Model, given: Mapping[str, Quantity], names: Sequence[str], what: str
) -> dict[str, float]:
    for name in given:
        if name not in names:
            raise unknown(what.lower().split()[-1], name, names)
    return {n: quantity(v, model.units[n], f"{what} '{n}'") for n, v in given.items()}
