"""Read the signals that a platform declares: which column of a log is which quantity."""

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import fields
from ptp_symbolic.platform.declaration import SignalDeclaration

ROLES = ("input", "output")


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
    allowed = ("role", "column", "unit", "counts_per_revolution", "noise")
    entry = fields.table(given, where, allowed)
    role = fields.choice(fields.required(entry, "role", where), ROLES, f"{where}.role")
    column = fields.text(fields.required(entry, "column", where), f"{where}.column")
    if column != column.strip() or column == "time" or any(mark in column for mark in '[],"'):
        raise InputError(
            f"{where}.column: {fields.shown(column)}: give the CSV column without its [unit], "
            "without quotes and commas; 'time' is the time base."
        )
    factor, unit = fields.unit(entry, where)
    counts = entry.get("counts_per_revolution")
    if counts is not None and (type(counts) is not int or not 1 <= counts <= 2**40):
        raise InputError(
            f"{where}.counts_per_revolution: {fields.shown(counts)} is not a whole number above 0."
        )
    if counts is not None and unit != "rad":
        raise InputError(f"{where}.counts_per_revolution: only for an angle, not for [{unit}].")
    noise = fields.scaled(entry["noise"], factor, f"{where}.noise") if "noise" in entry else None
    if noise is not None and noise < 0:
        raise InputError(f"{where}.noise: {entry['noise']} {entry['unit']} rms is negative.")
    return SignalDeclaration(name, column, unit, role, counts, noise)
