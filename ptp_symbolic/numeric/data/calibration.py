"""Columns of a log made into signals: units converted, raw numbers scaled, zeros taken off."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import SignalDeclaration
from ptp_symbolic.platform.units import compatible, to_si

FloatArray = NDArray[np.float64]


def factor_of(where: str, signal: SignalDeclaration, unit: str | None) -> float:
    """Return by what a number of the column is multiplied: its unit in SI, or the declared scale.

    `unit` is that of the heading, if it has one; `where` begins a refusal. With a scale the numbers
    are taken as they stand, whatever unit the heading gives them. Raises InputError for a column
    without unit or scale, a wrong unit, and a scale that contradicts the unit of the heading.
    """
    if signal.scale is None:
        hint = f", or give the scale of {signal.signal} in {signal.unit} per count"
        return unit_factor(where, signal.column, signal.signal, signal.unit, unit, hint)
    if unit and _fits(unit, signal.unit):
        factor = to_si(unit)[0]
        if factor != 1.0 and abs(math.log(abs(signal.scale))) < abs(
            math.log(abs(signal.scale / factor))
        ):
            raise InputError(
                f"{where} is in {unit}, of which its scale makes {signal.scale:g} {signal.unit}"
                f' each; write unit = "{unit}" beside the scale, which then multiplies them.'
            )
    return signal.scale


def unit_factor(
    where: str, column: str, signal: str, wanted: str, unit: str | None, hint: str = ""
) -> float:
    """Return the factor from the `unit` of a heading to the `wanted` SI unit of the signal.

    Raises InputError, begun by `where`, for no unit (with a `hint`) and for one that does not fit.
    """
    if not unit:
        raise InputError(f"{where} has no unit; write '{column} [{wanted}]'{hint}.")
    try:
        fits = compatible(unit, wanted)
        factor = to_si(unit)[0]
    except InputError as error:
        raise InputError(f"{where}: {error}") from error
    if not fits:
        raise InputError(
            f"{where} is in {unit}, but {signal} is in {wanted}; correct the header "
            "or the platform."
        )
    return factor


def calibrated(
    numbers: FloatArray, signals: Sequence[SignalDeclaration], factors: Sequence[float]
) -> FloatArray:
    """Return the signals [n, s] in SI whose columns hold `numbers` [n, s], see `factor_of`."""
    values = np.ascontiguousarray(numbers)
    raw = np.array([0.0 if s.scale is None else s.offset for s in signals])
    zero = np.array([s.offset if s.scale is None else 0.0 for s in signals])
    if any(factor != 1.0 for factor in factors) or any(s.offset for s in signals):
        values = (values - raw) * np.array(factors) - zero
    return values


def raw_numbers(signal: SignalDeclaration, values: FloatArray) -> FloatArray:
    """Return the numbers [n] of the column that says that the signal has the `values` [n] in SI:
    in SI themselves, unless the signal has a scale.
    """
    if signal.scale is None:
        return values + signal.offset
    return values / signal.scale + signal.offset


def _fits(unit: str, wanted: str) -> bool:
    try:
        return compatible(unit, wanted)
    except InputError:  # degC, or a word such as counts: numbers as they stand
        return False
