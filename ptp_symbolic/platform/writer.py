"""Print a platform as TOML that reads back to the same platform."""

import json

from ptp_symbolic.platform.declaration import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    SignalDeclaration,
)


def platform_text(platform: Platform) -> str:
    """Return the TOML text of `platform`, in the order of its fields, floats to the last bit.

    Raises ValueError for a parameter with one bound alone, which a TOML cannot say.
    """
    head = [
        "[platform]",
        f"name = {_quoted(platform.name)}",
        f"title = {_quoted(platform.title)}",
        f"axes = [{', '.join(_quoted(axis) for axis in platform.axes)}]",
        f"gravity = {float(platform.gravity)!r}",
    ]
    blocks = [
        head,
        *(_effect_lines(effect) for effect in platform.effects),
        *(_parameter_lines(parameter) for parameter in platform.parameters),
        *(_signal_lines(signal) for signal in platform.signals),
    ]
    return "\n\n".join("\n".join(lines) for lines in blocks) + "\n"


def _effect_lines(effect: EffectDeclaration) -> list[str]:
    lines = ["[[effects]]", f"effect = {_quoted(effect.effect)}"]
    if effect.axis is not None:
        lines.append(f"axis = {_quoted(effect.axis)}")
    if effect.site is not None:
        lines.append(f"site = {_quoted(effect.site)}")
    if effect.kind is not None:
        lines.append(f"kind = {_quoted(effect.kind)}")
    return lines


def _parameter_lines(parameter: ParameterDeclaration) -> list[str]:
    lines = [f"[parameters.{parameter.name}]"]
    if parameter.same_as is not None:
        return [*lines, f"same_as = {_quoted(parameter.same_as)}"]
    lines.append(f"{'start' if parameter.free else 'value'} = {float(parameter.value)!r}")
    if parameter.unit is not None:
        lines.append(f"unit = {_quoted(parameter.unit)}")
    if (parameter.lower is None) != (parameter.upper is None):
        raise ValueError(f"Parameter {parameter.name!r} has one bound alone; give both or none.")
    if parameter.lower is not None and parameter.upper is not None:
        lines.append(f"bounds = [{float(parameter.lower)!r}, {float(parameter.upper)!r}]")
    if parameter.uncertainty is not None:
        lines.append(f"uncertainty = {float(parameter.uncertainty)!r}")
    return lines


def _signal_lines(signal: SignalDeclaration) -> list[str]:
    lines = [
        f"[signals.{signal.signal}]",
        f"role = {_quoted(signal.role)}",
        f"column = {_quoted(signal.column)}",
        f"unit = {_quoted(signal.unit)}",
    ]
    if signal.counts_per_revolution is not None:
        lines.append(f"counts_per_revolution = {signal.counts_per_revolution}")
    if signal.noise is not None:
        lines.append(f"noise = {float(signal.noise)!r}")
    return lines


def _quoted(text: str) -> str:
    # A JSON string is a TOML basic string but for the delete character.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007F")
