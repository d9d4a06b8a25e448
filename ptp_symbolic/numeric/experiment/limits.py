"""What the machine may do in an experiment: limits of inputs, states and measured signals."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform.units import compatible, to_si

FloatArray = NDArray[np.float64]

_NUMBER = r"[+-]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d+)?"
_LIMIT = re.compile(rf"({_NUMBER})(?:\.\.({_NUMBER}))?\s*(.*)")


@dataclass(frozen=True)
class Limit:
    """The signal `name` stays between `lower` and `upper`, in its SI unit."""

    name: str
    lower: float
    upper: float


def read_limits(texts: Sequence[str], model: Model) -> dict[str, Limit]:
    """Limits by name, of texts such as ``u_pan=12 V`` (both ways) and ``theta_pan=-90..45 deg``.

    Raises InputError for unknown names, wrong units, empty ranges and inputs without a limit.
    """
    known = (*model.input_names, *model.state_names, *model.output_names)
    found: dict[str, Limit] = {}
    for text in texts:
        name, _, value = text.partition("=")
        if name not in known:
            raise unknown("signal", name, tuple(dict.fromkeys(known)))
        found[name] = _limit(name, value.strip(), model.units[name])
    missing = [name for name in model.input_names if name not in found]
    if missing:
        name, unit = missing[0], model.units[missing[0]]
        raise InputError(
            f"Input {name} has no limit; say how far it may go in {unit}, such as"
            f" `limits` '{name}=10 {unit}'."
        )
    return found


def _limit(name: str, value: str, unit: str) -> Limit:
    match = _LIMIT.fullmatch(value)
    if match is None:
        raise InputError(
            f"Limit '{name}={value}': write {name}=HIGH or {name}=LOW..HIGH, with a unit that fits"
            f" {unit}."
        )
    given = match[3] or unit
    if not compatible(given, unit):
        raise InputError(
            f"Limit '{name}={value}': {given} does not fit {unit}, the unit of {name}."
        )
    factor = to_si(given)[0]
    first = factor * float(match[1])
    lower, upper = (-first, first) if match[2] is None else (first, factor * float(match[2]))
    if not lower < upper:
        raise InputError(
            f"Limit '{name}={value}': leaves no room from {lower:g} to {upper:g} {unit}; give the"
            " lower end first."
        )
    return Limit(name, lower, upper)


def rest_of(limit: Limit) -> float:
    """The value of an input at rest: zero, or what is nearest to it."""
    return float(np.clip(0.0, limit.lower, limit.upper))


def excess(limits: Mapping[str, Limit], signals: Mapping[str, FloatArray]) -> tuple[float, str]:
    """By which factor `signals` (each [k]) come further from where they begin than they may, and
    the name of the one that does so most; infinite where one begins outside.
    """
    worst, name = 0.0, ""
    for limit in limits.values():
        values = signals[limit.name]
        begin = float(values[0])
        if not limit.lower <= begin <= limit.upper:
            return np.inf, limit.name
        room = max(limit.upper - begin, 1e-300), max(begin - limit.lower, 1e-300)
        factor = max((values.max() - begin) / room[0], (begin - values.min()) / room[1])
        if factor > worst:
            worst, name = float(factor), limit.name
    return worst, name
