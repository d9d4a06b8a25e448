"""The JSON Schema of a platform TOML, so that editors complete and check it.

Effects, their kinds, sites and parameters are those of the catalogue. What a schema cannot
say, such as a parameter whose effect is not declared, `ptp-symbolic check` does.
"""

from collections.abc import Iterator, Sequence

from ptp_symbolic.formats.json_schema import (
    DRAFT,
    NUMBER,
    TEXT,
    WHOLE,
    Schema,
    list_of,
    one_of,
    record,
    said,
)
from ptp_symbolic.platform import AXES, INTERPOLATIONS, JOINTS, SITES, STANDARD_GRAVITY
from ptp_symbolic.symbolic.derivation.placement import GRAVITY
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

TITLE = "Platform of ptp-symbolic"
NAME = "^[A-Za-z][A-Za-z0-9_]{0,63}$"
UNIT = said(TEXT, 'Unit of the numbers of this entry, such as "N m", "deg", "g cm^2", "rpm".')
TIME = said(TEXT, 'A time with its unit, such as "0.5 s" or "20 ms".')


def platform_schema(effects: Sequence[Effect]) -> Schema:
    """The schema of a platform file that may declare `effects`."""
    return {
        "$schema": DRAFT,
        "title": TITLE,
        "description": "A pan-tilt platform: its effects, its parameters and the columns of its"
        " logs.",
        **record(
            {
                "platform": _platform(),
                "effects": _effects(effects),
                "parameters": _parameters(effects),
                "signals": _signals(),
                "log": _log(),
                "fit": _fit(),
            },
            optional=("parameters", "signals", "log", "fit"),
        ),
        "definitions": {"parameter": _parameter()},
    }


def _platform() -> Schema:
    joints = {axis: one_of(JOINTS) for axis in AXES}
    entries = {
        "name": {"type": "string", "pattern": NAME, "description": "Name of the model in code."},
        "title": said(TEXT, "One line for reports."),
        "axes": {
            "type": "array",
            "items": {"enum": list(AXES)},
            "minItems": 1,
            "uniqueItems": True,
            "description": "The axes, base first.",
        },
        "joints": record(
            joints, tuple(joints), 'Kinds of the joints; "linear" for a carriage on a screw.'
        ),
        "gravity": {
            "type": "number",
            "minimum": 0.0,
            "description": f"Gravity in m/s^2, {STANDARD_GRAVITY} unless given.",
        },
    }
    return record(entries, optional=("title", "joints", "gravity"), description="What it is.")


def _effects(effects: Sequence[Effect]) -> Schema:
    names = [effect.id for effect in effects]
    entry = record(
        {
            "effect": {
                "enum": names,
                "description": "Name of the effect; `ptp-symbolic effects NAME` explains it.",
                "x-taplo": {"docs": {"enumValues": [effect.title for effect in effects]}},
            },
            "axis": one_of(AXES, "The axis on which it sits."),
            "site": one_of(SITES, "Where on the drive train: at the gear output or at the joint."),
            "kind": said(TEXT, "Which of its kinds; its usual one unless given."),
        },
        optional=("axis", "site", "kind"),
    )
    entry["allOf"] = [_of_effect(effect) for effect in effects]
    return {**list_of(entry, "What acts on the machine, a table each."), "minItems": 1}


def _of_effect(effect: Effect) -> Schema:
    """What holds of an entry that names `effect`: whether it has an axis, a site, a kind."""
    allowed: Schema = {"properties": {}}
    if effect.on_axis:
        allowed["required"] = ["axis"]
    else:
        allowed["properties"]["axis"] = False
    if not effect.sites:
        allowed["properties"]["site"] = False
    kinds = [kind.kind for kind in (effect, *effect.kinds) if kind.kind is not None]
    allowed["properties"]["kind"] = {"enum": kinds} if kinds else False
    return {
        "if": {"properties": {"effect": {"const": effect.id}}, "required": ["effect"]},
        "then": allowed,
    }


def _parameter() -> Schema:
    entries = {
        "value": said(NUMBER, "Known: it stays as it is."),
        "start": said(NUMBER, "Free: a fit begins here."),
        "same_as": said(TEXT, "Tied: the name of the parameter whose value it takes."),
        "unit": UNIT,
        "bounds": list_of(NUMBER, "Lower and upper bound, in `unit`.", 2),
        "uncertainty": {
            "type": "number",
            "minimum": 0.0,
            "description": "By how much a known value may be off at most, in `unit`.",
        },
    }
    entry = record(entries, optional=tuple(entries))
    entry["oneOf"] = [
        {"required": ["value"]},
        {"required": ["start"]},
        {"required": ["same_as"], "maxProperties": 1},
    ]
    return entry


def _parameters(effects: Sequence[Effect]) -> Schema:
    known = {p.name: p for p in (GRAVITY, *_known(effects))}
    entries = {
        name: {"allOf": [{"$ref": "#/definitions/parameter"}], "description": _described(p)}
        for name, p in sorted(known.items())
    }
    return record(entries, tuple(entries), "Values of the machine.")


def _known(effects: Sequence[Effect]) -> Iterator[Parameter]:
    """Parameters of all effects and kinds at all places; those of a rotary joint last."""
    for linear, axes in ((True, AXES[:1]), (False, AXES), *((False, (axis,)) for axis in AXES)):
        for effect in effects:
            if linear and effect.instead_on_linear:
                continue
            for kind in (effect, *effect.kinds):
                for axis in axes if effect.on_axis else (None,):
                    for site in kind.sites or (None,):
                        yield from kind.parameters_at(Place(axes, axis, site, frozenset(), linear))


def _described(parameter: Parameter) -> str:
    unit = "" if parameter.unit == "1" else f" in {parameter.unit}"
    text = f"{parameter.meaning[:1].upper()}{parameter.meaning[1:]}{unit}"
    text += f", {parameter.lower:g} to {parameter.upper:g}"
    return f"{text}; {parameter.default:g} unless given." if _natural(parameter) else f"{text}."


def _natural(parameter: Parameter) -> bool:
    return parameter.has_natural_default or parameter.name == GRAVITY.name


def _signals() -> Schema:
    entries = {
        "role": one_of(("input", "output"), "Whether it drives the machine or is measured on it."),
        "column": said(TEXT, "Column of the log, without its [unit]."),
        "unit": UNIT,
        "counts_per_revolution": {
            **WHOLE,
            "minimum": 1,
            "description": "Counts of the encoder per turn of the joint.",
        },
        "counts_per_metre": {
            **NUMBER,
            "minimum": 1,
            "description": "Counts of the encoder per metre of a linear joint.",
        },
        "noise": {
            **NUMBER,
            "minimum": 0.0,
            "description": "Noise of the signal, rms in `unit`.",
        },
        "scale": {
            **NUMBER,
            "not": {"const": 0},
            "description": "`unit` per number of the column; negative to invert the sign.",
        },
        "offset": said(NUMBER, "Taken off: numbers of the column with a scale, else in `unit`."),
        "delay": said(TIME, "An output stamped t was measured this much earlier."),
        "column_unit": said(TEXT, "Unit of a column whose heading has none."),
        "interpolation": one_of(
            INTERPOLATIONS,
            "What an input is between its samples; linear for rates and accelerations, hold for"
            " other inputs unless given.",
        ),
    }
    optional = tuple(name for name in entries if name not in ("role", "column", "unit"))
    return {
        "type": "object",
        "propertyNames": {"pattern": NAME},
        "additionalProperties": record(entries, optional),
        "description": "Which column of a log is which quantity: inputs such as u_pan or tau_pan,"
        " outputs such as theta_pan, omega_pan or i_pan.",
    }


def _log() -> Schema:
    entries = {
        "time": said(TEXT, "Column of the times; `time` or `t` unless given."),
        "time_unit": said(TEXT, "Unit of times whose heading has none."),
    }
    return record(entries, tuple(entries), "The times of a log.")


def _fit() -> Schema:
    entries = {
        "window": said(TIME, "Length of the windows into which runs are cut."),
        "material": {
            "type": "number",
            "exclusiveMinimum": 0,
            "exclusiveMaximum": 1,
            "description": "Share of the squared error that an effect has to explain for a name;"
            " 0.1 unless given.",
        },
    }
    return record(entries, tuple(entries), "Settings of fit and diagnose.")
