"""Typed access to the entries of a parsed TOML table; every refusal names the file and the key."""

import keyword
import math
import re
import unicodedata
from collections.abc import Collection, Mapping
from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform.units import to_si

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
_LONGEST_TEXT = 200


def shown(value: object) -> str:
    """Return `value` as one short printable piece of a message."""
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # an integer too long to print, a table nested too deep
        text = f"({type(value).__name__})"
    return text if len(text) <= 70 else text[:67] + "..."


def table(value: object, where: str, allowed: Collection[str] | None = None) -> dict[str, Any]:
    """Return `value` as a table whose keys are all in `allowed` (None: any key)."""
    if not isinstance(value, dict):
        raise InputError(
            f"{where}: {shown(value)} is not a table; write it as a TOML table, {{ key = value }}."
        )
    for key in value:
        if allowed is not None and key not in allowed:
            choices = ", ".join(sorted(allowed))
            raise InputError(f"{where}: unknown key {shown(key)}; allowed are {choices}.")
    return value


def name(value: object, where: str) -> str:
    """Return `value` as an identifier that is safe in generated code."""
    if not isinstance(value, str) or not _NAME.fullmatch(value):
        raise InputError(
            f"{where}: {shown(value)} is not a name; use 1 to 64 letters, digits and "
            "underscores, starting with a letter."
        )
    if keyword.iskeyword(value):
        raise InputError(f"{where}: {value!r} is a Python keyword; choose another name.")
    return value


def text(value: object, where: str) -> str:
    """Return `value` as one line of printable text."""
    if not isinstance(value, str):
        raise InputError(f"{where}: {shown(value)} is not a text; write it in quotes.")
    if not value.strip() or len(value) > _LONGEST_TEXT:
        raise InputError(f"{where}: {shown(value)} must have 1 to {_LONGEST_TEXT} characters.")
    if any(
        unicodedata.category(character)[0] == "C" or character in "\u2028\u2029"
        for character in value
    ):
        raise InputError(f"{where}: {shown(value)} has control characters; write one plain line.")
    return value


def number(value: object, where: str) -> float:
    """Return `value` as a finite float; true and false are no numbers."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(f"{where}: {shown(value)} is not a number; write it without quotes.")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise InputError(f"{where}: {shown(value)} is not a finite number; give its value.")
    return result


def time(value: object, where: str, lowest: float = -math.inf) -> float:
    """Return a time such as "0.5 s" or "20 ms" in s, above `lowest` (zero, or none)."""
    above = " above zero" if lowest == 0.0 else ""
    wrong = InputError(f'{where}: {shown(value)} is not a time{above}; write "0.5 s" or "500 ms".')
    given, _, name = value.strip().partition(" ") if isinstance(value, str) else ("", "", "")
    try:
        factor, si = to_si(name.strip())
        result = float(given) * factor
    except (InputError, ValueError) as error:
        raise wrong from error
    if si != "s" or not lowest < result < math.inf:
        raise wrong
    return result


def choice(value: object, choices: Collection[str], where: str) -> str:
    """Return `value` if it is one of `choices`."""
    if not isinstance(value, str) or value not in choices:
        raise InputError(f"{where}: {shown(value)} is not one of {', '.join(choices)}.")
    return value


def required(entries: Mapping[str, Any], key: str, where: str) -> Any:
    """Return the entry of `key`, which must be there."""
    if key not in entries:
        raise InputError(f"{where}: '{key}' is missing; add it.")
    return entries[key]


def unit(entry: Mapping[str, Any], where: str) -> tuple[float, str]:
    """Return (factor, SI unit) of the entry 'unit', which must be a unit text."""
    given = text(required(entry, "unit", where), f"{where}.unit")
    try:
        return to_si(given)
    except InputError as error:
        raise InputError(f"{where}.unit: {error}") from error


def scaled(value: object, factor: float, where: str) -> float:
    """Return the number `value` times `factor`, finite."""
    result = number(value, where) * factor
    if not math.isfinite(result):
        raise InputError(f"{where}: {shown(value)} is too large in SI units.")
    return result
