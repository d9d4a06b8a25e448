"""The signals of a platform TOML: columns of a log, their units and resolution."""

from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import fields
from ptp_symbolic.platform.declaration import SignalDeclaration
from ptp_symbolic.platform.quantity import scaled, unit_of

ROLES = ("input", "output")
# How the resolution of an encoder is given: for which unit, what that is, whether it is whole.
RESOLUTIONS = {
    "counts_per_revolution": ("rad", "an angle", True),
    "counts_per_metre": ("m", "the position of a linear joint", False),
}


def signals_of(given: object, file: str) -> tuple[SignalDeclaration, ...]:
    """Return the signals of a `[signals]` table, their units and noise in SI.

    Raises InputError for one that is not declared as it must be, and for two of one column.
    """
    found: dict[str, SignalDeclaration] = {}
    for name, entry in fields.table(given, f"{file}: signals").items():
        where = f"{file}: signals.{fields.name(name, f'{file}: signals')}"
        signal = _signal(name, entry, where)
        if signal.column in found:
            raise InputError(
                f"{where}.column: {fields.shown(signal.column)} is also the column of "
                f"{found[signal.column].signal}; give each signal its own."
            )
        found[signal.column] = signal
    return tuple(found.values())


def _signal(name: str, given: object, where: str) -> SignalDeclaration:
    allowed = ("role", "column", "unit", *RESOLUTIONS, "noise")
    entry = fields.table(given, where, allowed)
    role = fields.choice(fields.required(entry, "role", where), ROLES, f"{where}.role")
    column = fields.text(fields.required(entry, "column", where), f"{where}.column")
    if column != column.strip() or column == "time" or any(mark in column for mark in '[],"'):
        raise InputError(
            f"{where}.column: {fields.shown(column)}: give the CSV column without its [unit], "
            "without quotes and commas; 'time' is the time base."
        )
    fields.required(entry, "unit", where)
    factor, unit = unit_of(entry, where)
    turn, metre = (_resolution(entry, key, unit, where) for key in RESOLUTIONS)
    noise = scaled(entry["noise"], factor, f"{where}.noise") if "noise" in entry else None
    if noise is not None and noise < 0:
        raise InputError(f"{where}.noise: {entry['noise']} {entry['unit']} rms is negative.")
    whole = None if turn is None else int(turn)
    return SignalDeclaration(name, column, unit, role, whole, noise, metre)


def _resolution(entry: dict[str, Any], key: str, unit: str, where: str) -> float | None:
    """Counts of an encoder per turn of an angle, a whole number, or per metre of a position."""
    if key not in entry:
        return None
    counts, (of, what, wholly) = entry[key], RESOLUTIONS[key]
    number = type(counts) is int or (type(counts) is float and not wholly)
    if not number or not 1 <= counts <= 2**40:
        said = "a whole number above 0" if wholly else "a number from 1 to 2^40"
        raise InputError(f"{where}.{key}: {fields.shown(counts)} is not {said}.")
    if unit != of:
        other = next((k for k, row in RESOLUTIONS.items() if row[0] == unit), None)
        instead = f"; write {other}" if other else ""
        raise InputError(f"{where}.{key}: only for {what}, not for [{unit}]{instead}.")
    return float(counts)
