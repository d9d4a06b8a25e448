"""Read a platform TOML into plain data, or refuse it in one line that names file and key."""

import dataclasses
import math
import re
import tomllib
from pathlib import Path
from typing import Any

from ptp_symbolic.errors import InputError, path_of, unknown
from ptp_symbolic.platform import fields
from ptp_symbolic.platform.declaration import (
    AXES,
    JOINTS,
    SITES,
    STANDARD_GRAVITY,
    Clock,
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
)
from ptp_symbolic.platform.signals import read_signals
from ptp_symbolic.platform.text_file import read_text_bytes
from ptp_symbolic.platform.units import compatible

_MAX_BYTES = 1_000_000
# tomllib needs a time that grows with the square of the parts of a dotted key.
_MAX_LINE = 500
_DECIMAL_COMMA = re.compile(r"[=\[,]\s*([+-]?\d+,\d+)(?=\s*(?:[,}#]|$))")
_PRESETS = Path(__file__).parent / "presets"


def preset_names() -> tuple[str, ...]:
    """Return the names of the packaged platforms, sorted."""
    return tuple(sorted(path.stem for path in _PRESETS.glob("*.toml")))


def read_platform(source: str | Path) -> Platform:
    """Read the platform TOML at a path, or a packaged preset by its name.

    Numbers are converted to SI and unit texts replaced by their SI equivalents. Whether the effects
    and parameters exist is not known here. Raises InputError (one line) for a file that is missing,
    unreadable, not TOML, or says something that is not allowed.

    >>> import ptp_symbolic as ptp
    >>> ptp.read_platform("thesis-payload").axes
    ('pan', 'tilt')
    """
    path = platform_file(source)
    where = str(path)
    document = fields.table(
        _parse(path), where, ("platform", "effects", "parameters", "signals", "log", "fit")
    )
    head = fields.table(
        fields.required(document, "platform", where),
        f"{where}: platform",
        ("name", "title", "axes", "joints", "gravity"),
    )
    name = fields.name(
        fields.required(head, "name", f"{where}: platform"), f"{where}: platform.name"
    )
    axes = _axes(head, f"{where}: platform")
    window, material = _fit_settings(document.get("fit", {}), f"{where}: fit")
    return Platform(
        name=name,
        title=fields.text(head.get("title", name), f"{where}: platform.title"),
        axes=axes,
        gravity=_gravity(head, f"{where}: platform.gravity"),
        effects=_effects(fields.required(document, "effects", where), axes, where),
        parameters=_parameters(document.get("parameters", {}), where),
        signals=read_signals(document.get("signals", {}), where),
        clock=_clock_of(document.get("log", {}), f"{where}: log"),
        window=window,
        material=material,
        linear_axes=_linear_axes(head.get("joints", {}), axes, f"{where}: platform.joints"),
        source=where,
    )


def platform_file(source: str | Path, names: tuple[str, ...] = ()) -> Path:
    """Return the file of a platform: the path given, or that of a preset.

    Raises InputError where there is none; the message offers the presets and `names`.
    """
    if isinstance(source, str) and source in preset_names():
        return _PRESETS / f"{source}.toml"
    path = path_of(source, "A platform", "the path of a platform TOML, or the name of a preset")
    try:
        missing = not path.exists()
    except (OSError, ValueError):
        missing = True
    if missing and path.suffix == ".toml":
        raise InputError(
            f"{path}: there is no such file; give the path of a platform TOML, or one of"
            f" {', '.join((*names, *preset_names()))}."
        )
    if missing:
        end = "; or give the path of a platform TOML"
        raise unknown("platform", str(source), (*names, *preset_names()), end)
    return path


def _parse(path: Path) -> dict[str, Any]:
    content = read_text_bytes(path, _MAX_BYTES, "a platform TOML").decode()
    for count, line in enumerate(content.split("\n"), start=1):
        if len(line) > _MAX_LINE:
            raise InputError(f"{path}:{count}: line has more than {_MAX_LINE} characters; wrap it.")
    try:
        return tomllib.loads(content)
    except tomllib.TOMLDecodeError as error:
        raise InputError(_syntax_message(path, content, str(error))) from error
    except RecursionError as error:
        raise InputError(f"{path}: brackets are nested too deep; write plain tables.") from error
    except ValueError as error:
        raise InputError(f"{path}: is not TOML: {error}.") from error


def _syntax_message(path: Path, content: str, message: str) -> str:
    place = re.search(r" \(at line (\d+), column (\d+)\)$", message)
    if place:
        line, column = place.groups()
        message = message[: place.start()]
    else:
        lines = content.split("\n")
        line, column = str(len(lines)), str(len(lines[-1]) + 1)
    where = f"{path}:{line}:{column}"
    written = content.split("\n")[int(line) - 1]
    comma = _DECIMAL_COMMA.search(written)
    if comma:
        point = comma[1].replace(",", ".")
        return f"{where}: {comma[1]} has a decimal comma; write {point}, with a point."
    if message.startswith("Cannot overwrite"):
        key = written.partition("=")[0].strip() or written.strip()
        return f"{where}: is not TOML: {fields.shown(key)} is there twice; remove one."
    return f"{where}: is not TOML: {message}."


def _axes(head: dict[str, Any], where: str) -> tuple[str, ...]:
    given = fields.required(head, "axes", where)
    if not isinstance(given, list) or not given:
        raise InputError(f"{where}.axes: {fields.shown(given)}: write a list of {', '.join(AXES)}.")
    for axis in given:
        fields.choice(axis, AXES, f"{where}.axes")
    if len(set(given)) != len(given):
        raise InputError(f"{where}.axes: {fields.shown(given)} names an axis twice.")
    return tuple(axis for axis in AXES if axis in given)


def _linear_axes(given: object, axes: tuple[str, ...], where: str) -> tuple[str, ...]:
    """Those of `axes` whose joint is said to be linear; it must be the pan axis, alone."""
    kinds = fields.table(given, where, axes)
    for axis, kind in kinds.items():
        fields.choice(kind, JOINTS, f"{where}.{axis}")
    linear = tuple(axis for axis in axes if kinds.get(axis) == "linear")
    if linear and axes != ("pan",):
        raise InputError(
            f"{where}.{linear[0]}: a linear joint is the only one of its platform, with axes ="
            f' ["pan"]; the axes here are {" and ".join(axes)}: leave out the others.'
        )
    return linear


def _gravity(head: dict[str, Any], where: str) -> float:
    gravity = fields.number(head.get("gravity", STANDARD_GRAVITY), where)
    if gravity < 0:
        raise InputError(f"{where}: {gravity!r} m/s^2 is negative; give its magnitude (downwards).")
    return gravity


def _effects(given: object, axes: tuple[str, ...], file: str) -> tuple[EffectDeclaration, ...]:
    if not isinstance(given, list) or not given:
        raise InputError(f"{file}: effects: write at least one [[effects]] table.")
    found: dict[tuple[str, str | None, str | None], EffectDeclaration] = {}
    for position, entry in enumerate(given, start=1):
        where = f"{file}: effects[{position}]"
        entry = fields.table(entry, where, ("effect", "axis", "site", "kind"))
        effect = fields.name(fields.required(entry, "effect", where), f"{where}.effect")
        where = f"{where} {effect}"
        axis = fields.choice(entry["axis"], axes, f"{where}.axis") if "axis" in entry else None
        site = fields.choice(entry["site"], SITES, f"{where}.site") if "site" in entry else None
        kind = fields.name(entry["kind"], f"{where}.kind") if "kind" in entry else None
        if (effect, axis, kind) in found:
            on_axis = f" on axis {axis}" if axis else ""
            raise InputError(f"{where}: is declared twice{on_axis}; remove one of the two.")
        found[effect, axis, kind] = EffectDeclaration(effect, axis, site, kind)
    return tuple(found.values())


def _parameters(given: object, file: str) -> tuple[ParameterDeclaration, ...]:
    entries = {
        name: fields.table(
            entry,
            f"{file}: parameters.{fields.name(name, f'{file}: parameters')}",
            ("value", "start", "same_as", "unit", "bounds", "uncertainty"),
        )
        for name, entry in fields.table(given, f"{file}: parameters").items()
    }
    for name, entry in entries.items():
        kinds = [key for key in ("value", "start", "same_as") if key in entry]
        if len(kinds) != 1:
            raise InputError(
                f"{file}: parameters.{name}: has {' and '.join(kinds) or 'no value'}; give exactly "
                "one of value (known), start (free) and same_as (tied)."
            )
    blank = [
        name
        for name, entry in entries.items()
        if any(isinstance(entry.get(k), float) and math.isnan(entry[k]) for k in ("value", "start"))
    ]
    if blank:
        raise InputError(f"{file}: parameters: nan is no value; give that of {', '.join(blank)}.")
    independent = {
        name: _independent(name, entry, f"{file}: parameters.{name}")
        for name, entry in entries.items()
        if "same_as" not in entry
    }
    return tuple(
        independent[name]
        if name in independent
        else _tied(name, entry, independent, f"{file}: parameters.{name}")
        for name, entry in entries.items()
    )


def _independent(name: str, entry: dict[str, Any], where: str) -> ParameterDeclaration:
    key = "start" if "start" in entry else "value"
    factor, unit = fields.unit(entry, where) if "unit" in entry else (1.0, None)
    value = fields.scaled(entry[key], factor, f"{where}.{key}")
    lower = upper = None
    if "bounds" in entry:
        bounds = entry["bounds"]
        if not isinstance(bounds, list) or len(bounds) != 2:
            raise InputError(
                f"{where}.bounds: {fields.shown(bounds)}: write two numbers, [lower, upper]."
            )
        lower, upper = (fields.scaled(bound, factor, f"{where}.bounds") for bound in bounds)
        unit_text = f" {entry['unit']}" if "unit" in entry else ""
        if lower >= upper:
            raise InputError(
                f"{where}.bounds: {fields.shown(bounds)}{unit_text}: "
                "the lower bound comes first and is less than the upper."
            )
        if not lower <= value <= upper:
            raise InputError(
                f"{where}.{key}: {fields.shown(entry[key])}{unit_text} lies outside its bounds "
                f"{fields.shown(bounds)}{unit_text}; change one of them."
            )
    uncertainty = None
    if "uncertainty" in entry:
        uncertainty = fields.scaled(entry["uncertainty"], factor, f"{where}.uncertainty")
        if key == "start" or uncertainty < 0.0:
            raise InputError(
                f"{where}.uncertainty: {fields.shown(entry['uncertainty'])}: give zero or more, and"
                " only with a value; a start is fitted within its bounds."
            )
    return ParameterDeclaration(
        name, unit, value, key == "start", lower, upper, uncertainty=uncertainty
    )


def _tied(
    name: str, entry: dict[str, Any], independent: dict[str, ParameterDeclaration], where: str
) -> ParameterDeclaration:
    if len(entry) > 1:
        others = ", ".join(sorted(set(entry) - {"same_as"}))
        raise InputError(f"{where}: a tied parameter has same_as alone; remove {others}.")
    target = entry["same_as"]
    if not isinstance(target, str) or target not in independent:
        choices = ", ".join(independent) or "none declared"
        raise InputError(
            f"{where}.same_as: {fields.shown(target)} is not a parameter with a value or start of "
            f"its own; choices: {choices}."
        )
    return dataclasses.replace(
        independent[target], name=name, free=False, lower=None, upper=None, same_as=target
    )


def _fit_settings(given: object, where: str) -> tuple[float | None, float | None]:
    """Return what a `[fit]` table says: the length in s of its windows, and the share of the error
    that an effect has to reduce to be named; None where it says nothing.

    Raises InputError for other keys, for what is no time above zero, such as "0.5 s", and for what
    is no share.
    """
    entry = fields.table(given, where, ("window", "material"))
    window = fields.time(entry["window"], f"{where}.window", 0.0) if "window" in entry else None
    if "material" not in entry:
        return window, None
    share = fields.number(entry["material"], f"{where}.material")
    if not 0.0 < share < 1.0:
        raise InputError(
            f"{where}.material: {share:g} is no share of the error; give a number between 0 and 1,"
            " such as 0.05 for 5 %."
        )
    return window, share


def _clock_of(given: object, where: str) -> Clock:
    """Return what a `[log]` table says of the times: `time`, their column, and `time_unit`.

    Raises InputError for other keys and for a unit that is none of time.
    """
    entry = fields.table(given, where, ("time", "time_unit"))
    column = fields.text(entry["time"], f"{where}.time") if "time" in entry else None
    if "time_unit" not in entry:
        return Clock(column)
    unit = fields.text(entry["time_unit"], f"{where}.time_unit")
    try:
        fits = compatible(unit, "s")
    except InputError as error:
        raise InputError(f"{where}.time_unit: {error}") from error
    if not fits:
        raise InputError(f'{where}.time_unit: {unit} is no unit of time; write "s" or "ms".')
    return Clock(column, unit)
