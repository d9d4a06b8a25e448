"""Read the signals that a platform declares: which column of a log is which quantity."""

from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import fields
from ptp_symbolic.platform.declaration import INTERPOLATIONS, SignalDeclaration
from ptp_symbolic.platform.units import compatible, to_si

ROLES = ("input", "output")
# How the resolution of an encoder is given: for which unit, what that is, whether it is whole.
RESOLUTIONS = {
    "counts_per_revolution": ("rad", "an angle", True),
    "counts_per_metre": ("m", "the position of a linear joint", False),
}
ALLOWED = (
    "role",
    "column",
    "unit",
    *RESOLUTIONS,
    "noise",
    "scale",
    "offset",
    "delay",
    "column_unit",
    "interpolation",
)
RUN_BY_SPREADSHEETS = ("=", "+", "-", "@")  # what a formula begins with
LONGEST_DELAY = 10.0  # s: beyond it stands a slip of the unit


def read_signals(given: object, file: str) -> tuple[SignalDeclaration, ...]:
    """Return the signals that the `[signals]` table of the platform `file` declares, in SI units.

    Raises InputError that names the file and the key.
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
    entry = fields.table(given, where, ALLOWED)
    role = fields.choice(fields.required(entry, "role", where), ROLES, f"{where}.role")
    column = fields.text(fields.required(entry, "column", where), f"{where}.column")
    if column != column.strip() or column == "time" or any(mark in column for mark in '[],"'):
        raise InputError(
            f"{where}.column: {fields.shown(column)}: give the CSV column without its [unit], "
            "without quotes and commas; 'time' is the time base."
        )
    if column.startswith(RUN_BY_SPREADSHEETS):
        raise InputError(
            f"{where}.column: {fields.shown(column)} begins with {column[0]!r}, and a spreadsheet"
            " runs such a cell as a formula when it opens a log or a result; rename the column, in"
            " the log too."
        )
    factor, unit = fields.unit(entry, where)
    turn, metre = (_resolution(entry, key, unit, where) for key in RESOLUTIONS)
    noise = fields.scaled(entry["noise"], factor, f"{where}.noise") if "noise" in entry else None
    if noise is not None and noise < 0:
        raise InputError(f"{where}.noise: {entry['noise']} {entry['unit']} rms is negative.")
    return SignalDeclaration(
        name,
        column,
        unit,
        role,
        None if turn is None else int(turn),
        noise,
        metre,
        *_raw(entry, factor, where),
        _delay(entry, where),
        _column_unit(entry, unit, where),
        _interpolation(entry, role, where),
    )


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


def _column_unit(entry: dict[str, Any], unit: str, where: str) -> str | None:
    """Unit of a column whose heading has none: 'column_unit', or else 'unit'."""
    given = fields.text(entry.get("column_unit", entry["unit"]), f"{where}.column_unit")
    if not compatible(given, unit):
        raise InputError(f"{where}.column_unit: {given} is no unit of [{unit}]; correct it.")
    return None if to_si(given) == (1.0, unit) else given


def _raw(entry: dict[str, Any], factor: float, where: str) -> tuple[float | None, float]:
    """Scale in SI per number of the column, and offset: in such numbers, without a scale in SI."""
    offset = entry.get("offset", 0.0)
    if "scale" not in entry:
        return None, fields.scaled(offset, factor, f"{where}.offset")
    scale = fields.scaled(entry["scale"], factor, f"{where}.scale")
    if scale == 0.0:
        raise InputError(
            f"{where}.scale: is zero, which leaves nothing of the column; give {entry['unit']} per"
            " number in it, negative to turn the sign."
        )
    return scale, fields.number(offset, f"{where}.offset")


def _delay(entry: dict[str, Any], where: str) -> float:
    delay = fields.time(entry["delay"], f"{where}.delay") if "delay" in entry else 0.0
    if abs(delay) > LONGEST_DELAY:
        raise InputError(
            f"{where}.delay: {entry['delay']} is more than {LONGEST_DELAY:g} s; correct its unit,"
            " or the time stamps of the log."
        )
    return delay


def _interpolation(entry: dict[str, Any], role: str, where: str) -> str | None:
    if "interpolation" not in entry:
        return None
    if role == "output":
        raise InputError(
            f"{where}.interpolation: is for inputs; an output is compared at its samples alone."
        )
    return fields.choice(entry["interpolation"], INTERPOLATIONS, f"{where}.interpolation")
