"""Unit texts such as "N m s/rad": their conversion to SI and the check that two fit together."""

import functools
import math
import re
from typing import Any

from ptp_symbolic.errors import InputError, wrong_type

# The units the project itself writes. They need no conversion, so that common platforms and logs
# are read without importing pint.
_SI_UNITS = frozenset(
    (
        "1",
        "rad",
        "rad/s",
        "rad/s^2",
        "1/rad",
        "rad s",
        "s",
        "1/s",
        "Hz",
        "m",
        "m/s",
        "m/s^2",
        "kg",
        "kg m",
        "kg m^2",
        "N",
        "N m",
        "N m/rad",
        "N m/rad^2",
        "N m/rad^3",
        "N m/s",
        "N m s",
        "N m s/rad",
        "N m s^2/rad^2",
        "N/m",
        "N/m^3",
        "N s/m",
        "N s^2/m^2",
        "rad/m",
        "m s",
        "N m/A",
        "V",
        "V/rad",
        "V/(rad s)",
        "V s/rad",
        "V/m",
        "V/(m s)",
        "V s/m",
        "A",
        "ohm",
        "ohm/K",
        "H",
        "K",
        "1/K",
        "K/W",
        "J",
        "J/K",
        "W",
    )
)
_DEGREES = {"deg": "rad", "deg/s": "rad/s", "deg/s^2": "rad/s^2"}

# Symbols for single factors, tried in this order: "kWh" becomes J, not N m.
_SYMBOLS = ("rad", "s", "m", "kg", "A", "K", "N", "V", "ohm", "H", "W", "J", "Pa", "C", "F", "T")
_BASE_SYMBOLS = {
    "kilogram": "kg",
    "meter": "m",
    "second": "s",
    "ampere": "A",
    "kelvin": "K",
    "radian": "rad",
}

# Only integer exponents and no bare numbers, so that nothing in a file can make pint compute.
_FACTOR = r"[A-Za-zµμΩΩ°%][A-Za-z_]*+(?:\^-?[1-9])?"
_GRAMMAR = re.compile(rf"(?:1(?=/)|\(|{_FACTOR})(?:[ /()]|{_FACTOR})*+")
_QUANTITY = re.compile(r"([+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)", re.ASCII)
_AMBIGUOUS = re.compile(r"/ ?[^ /()]+ [^ /)]")


def to_si(text: str) -> tuple[float, str]:
    """Return (factor, SI unit text): a number in `text` times `factor` is in the SI unit.

    The SI text keeps the shape of the input: "mN m s/deg" becomes "N m s/rad".
    Raises InputError for a text that is not a unit or has an offset (degC) or logarithm (dB).
    """
    tidy = _tidy(text)
    if tidy in _SI_UNITS:
        return 1.0, tidy
    if tidy in _DEGREES:
        return math.radians(1.0), _DEGREES[tidy]
    factor, powers = 1.0, dict[str, int]()
    for name, exponent in _factors(tidy):
        name_factor, symbols = _single(name)
        try:
            factor *= name_factor**exponent
        except OverflowError as error:
            raise _unknown(tidy) from error
        for symbol, power in symbols.items():
            powers[symbol] = powers.get(symbol, 0) + power * exponent
    if not 0 < factor < math.inf:
        raise _unknown(tidy)
    return factor, _unit_text(powers)


def compatible(unit: str, other: str) -> bool:
    """Tell whether the two units measure the same dimension, so that one converts to the other.

    An angle has no dimension: "N m s" fits "N m s/rad" and "1/s" fits "rad/s". Counts and hertz do
    not fit radians, because the factor between them is not one. Raises InputError as `to_si` does.
    """
    first, second = to_si(unit)[1], to_si(other)[1]
    if first == second:
        return True
    if {"Hz", "rad"} <= set(re.findall("Hz|rad", first + " " + second)):
        return False
    return _dimension(first) == _dimension(second)


def quantity(given: float | str, unit: str, what: str) -> float:
    """Return `given`, a number in the SI `unit` or a text with a unit such as "30 deg", in `unit`.

    `what` begins the message. Raises InputError for what is neither, is not finite, or has a unit
    that does not fit.
    """
    text = f"{given!r} {unit}" if isinstance(given, int | float) else repr(given)
    number, own = given, unit
    if isinstance(given, str):
        found = _QUANTITY.fullmatch(given.strip())
        if found is None:
            raise InputError(f"{what} = {text}; write a number, or a number and a unit ({unit}).")
        number, own = float(found[1]), found[2] or unit
    try:
        value = float(number)
    except (TypeError, ValueError) as error:
        raise wrong_type(what, given, f"a number in {unit}, or a text with a unit") from error
    if not math.isfinite(value):
        raise InputError(f"{what} = {text}; give a finite number.")
    if own != unit and not compatible(own, unit):
        raise InputError(
            f"{what} = {text}: {own} does not fit its unit {unit}; give a number in"
            f" {unit}, or another unit of the same kind."
        )
    return value if own == unit else value * to_si(own)[0]


def _tidy(text: str) -> str:
    text = text.replace("**", "^").replace("²", "^2").replace("³", "^3")
    text = re.sub(r"[*·⋅]", " ", text)
    # pint reads Nm as the textile unit "number metric".
    text = re.sub(r"\b([mkM]?)Nm(s?)\b", r"\1N m \2", text)
    return re.sub(r" ?([/^()]) ?", r"\1", " ".join(text.split()))


def _factors(tidy: str) -> list[tuple[str, int]]:
    """Split a tidy unit text into pint's unit names and exponents, in the order of the text."""
    if len(tidy) > 60 or not _GRAMMAR.fullmatch(tidy):
        raise _unknown(tidy)
    if _AMBIGUOUS.search(tidy):
        raise InputError(
            f"Unit {tidy!r} can be read in two ways; put what is below the stroke in "
            "parentheses, such as 'N m/(rad s)'."
        )
    try:
        container = _registry().parse_units(tidy)._units
    except Exception as error:  # pint raises its own errors, AssertionError, tokenizer errors
        raise _unknown(tidy) from error
    return [(str(name), _integer(power, tidy)) for name, power in container.items()]


def _integer(power: Any, tidy: str) -> int:
    if not isinstance(power, int | float) or power != int(power):
        raise _unknown(tidy)
    return int(power)


def _single(name: str) -> tuple[float, dict[str, int]]:
    """Return factor and SI symbols (symbol -> exponent) of one of pint's unit names."""
    registry = _registry()
    if name == "hertz" or name.endswith("hertz"):
        return float(registry.get_base_units(name)[0]), {"Hz": 1}
    try:
        is_ratio = registry._is_multiplicative(name)
    except AssertionError:  # powers of logarithmic units have names that pint itself does not know
        is_ratio = False
    if not is_ratio:
        raise InputError(f"Unit {name!r} has an offset or a logarithm; use 'K' or a plain ratio.")
    factor, root = registry.get_base_units(name)
    for symbol in _SYMBOLS:
        if registry.get_base_units(symbol)[1] == root:
            return float(factor), {symbol: 1}
    symbols = {_BASE_SYMBOLS.get(base, base): int(power) for base, power in root._units.items()}
    return float(factor), symbols


def _unit_text(powers: dict[str, int]) -> str:
    def part(symbol: str, power: int) -> str:
        return symbol if power == 1 else f"{symbol}^{power}"

    above = " ".join(part(symbol, power) for symbol, power in powers.items() if power > 0)
    below = [part(symbol, -power) for symbol, power in powers.items() if power < 0]
    if not below:
        return above or "1"
    divisor = below[0] if len(below) == 1 else f"({' '.join(below)})"
    return f"{above or '1'}/{divisor}"


def _dimension(si_text: str) -> dict[str, float]:
    """Return base unit -> exponent of an SI unit text, radians left out."""
    units = _registry().parse_units("dimensionless" if si_text == "1" else si_text)
    root = _registry().get_base_units(units)[1]._units
    return {str(name): float(power) for name, power in root.items() if name != "radian"}


def _unknown(text: str) -> InputError:
    shown = text if len(text) <= 60 else text[:57] + "..."
    return InputError(
        f"{shown!r} is not a unit; write factors and whole exponents, such as 'N m s/rad', "
        "'kg m^2', 'deg' or '1' for none."
    )


@functools.cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry()
