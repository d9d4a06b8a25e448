"""Print a platform as TOML that reads back to the same platform."""

from typing import Any

from ptp_symbolic.platform.declaration import ParameterDeclaration, Platform, SignalDeclaration


def platform_text(platform: Platform) -> str:
    """Return the TOML text of `platform`, in the order of its fields, floats to the last bit.

    Raises ValueError for a parameter with one bound alone, which a TOML cannot say.
    """
    import tomlkit

    sections = {
        "platform": {
            "name": platform.name,
            "title": platform.title,
            "axes": list(platform.axes),
            **_joints(platform),
            "gravity": float(platform.gravity),
        },
        "effects": [
            _given(effect=e.effect, axis=e.axis, site=e.site, kind=e.kind) for e in platform.effects
        ],
        "parameters": {p.name: _parameter(p) for p in platform.parameters},
        "signals": {s.signal: _signal(s) for s in platform.signals},
        "log": _given(time=platform.clock.column, time_unit=platform.clock.unit),
        "fit": _given(
            window=None if platform.window is None else f"{platform.window!r} s",
            material=platform.material,
        ),
    }
    return tomlkit.dumps({name: section for name, section in sections.items() if section})


def _joints(platform: Platform) -> dict[str, Any]:
    """The kinds of the joints, said where one is linear."""
    if not platform.linear_axes:
        return {}
    import tomlkit

    kinds = tomlkit.inline_table()
    kinds.update({axis: "linear" for axis in platform.linear_axes})
    return {"joints": kinds}


def _parameter(parameter: ParameterDeclaration) -> dict[str, Any]:
    if parameter.same_as is not None:
        return {"same_as": parameter.same_as}
    bounds = (parameter.lower, parameter.upper)
    if bounds.count(None) == 1:
        raise ValueError(f"Parameter {parameter.name!r} has one bound alone; give both or none.")
    return {
        "start" if parameter.free else "value": float(parameter.value),
        **_given(
            unit=parameter.unit,
            bounds=[float(b) for b in bounds if b is not None] or None,
            uncertainty=_decimal(parameter.uncertainty),
        ),
    }


def _signal(signal: SignalDeclaration) -> dict[str, Any]:
    return _given(
        role=signal.role,
        column=signal.column,
        unit=signal.unit,
        counts_per_revolution=signal.counts_per_revolution,
        counts_per_metre=_decimal(signal.counts_per_metre),
        noise=_decimal(signal.noise),
        scale=_decimal(signal.scale),
        offset=float(signal.offset) if signal.offset else None,
        delay=f"{float(signal.delay)!r} s" if signal.delay else None,
        column_unit=signal.column_unit,
        interpolation=signal.interpolation,
    )


def _decimal(value: float | None) -> float | None:
    return None if value is None else float(value)


def _given(**fields: Any) -> dict[str, Any]:
    """The `fields` that have a value."""
    return {name: value for name, value in fields.items() if value is not None}
