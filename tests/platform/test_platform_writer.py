"""A platform that is written reads back the same, to the last bit."""

import keyword
import math
import tomllib
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    SignalDeclaration,
    platform_text,
    preset_names,
    read_platform,
)

names = st.from_regex(r"[A-Za-z][A-Za-z0-9_]{0,20}", fullmatch=True).filter(
    lambda name: not keyword.iskeyword(name)
)
numbers = st.floats(allow_nan=False, allow_infinity=False)
si_units = st.sampled_from(["N m", "kg m^2", "rad", "m", "N m s/rad", "1", "ohm", "Hz", "N/m^2"])
lines = st.text(
    st.characters(codec="utf-8", exclude_categories=["C", "Zl", "Zp"]), min_size=1, max_size=40
).filter(lambda text: bool(text.strip()))


@st.composite
def parameters(draw: st.DrawFn) -> tuple[ParameterDeclaration, ...]:
    found: list[ParameterDeclaration] = []
    for name in draw(st.lists(names, unique=True, max_size=6)):
        targets = [parameter for parameter in found if parameter.same_as is None]
        tied = draw(st.booleans())
        if targets and tied:
            target = draw(st.sampled_from(targets))
            found.append(ParameterDeclaration(name, target.unit, target.value, same_as=target.name))
            continue
        lower, value, upper = sorted(draw(st.tuples(numbers, numbers, numbers)))
        bounds = (lower, upper) if lower < upper and draw(st.booleans()) else (None, None)
        unit = draw(st.none() | si_units)
        found.append(ParameterDeclaration(name, unit, value, draw(st.booleans()), *bounds))
    return tuple(found)


@st.composite
def signals(draw: st.DrawFn) -> tuple[SignalDeclaration, ...]:
    found = []
    for name in draw(st.lists(names, unique=True, max_size=4)):
        unit = draw(si_units)
        counts = draw(st.none() | st.integers(1, 10**6)) if unit == "rad" else None
        noise = draw(st.none() | st.floats(0, 1e300))
        role = draw(st.sampled_from(["input", "output"]))
        per_metre = draw(st.none() | st.floats(1.0, 1e12)) if unit == "m" else None
        scale = draw(st.none() | numbers.filter(bool))
        delay = draw(st.floats(-10.0, 10.0))
        offset = draw(numbers)
        own = (role, counts, noise, scale, offset, delay, per_metre)
        found.append(SignalDeclaration(name, f"{name} col", unit, *own))
    return tuple(found)


@st.composite
def platforms(draw: st.DrawFn) -> Platform:
    axes = draw(st.sampled_from([("pan",), ("tilt",), ("pan", "tilt")]))
    effects = draw(
        st.lists(
            st.builds(
                EffectDeclaration,
                names,
                st.none() | st.sampled_from(axes),
                st.none() | st.sampled_from(["gear", "joint"]),
            ),
            min_size=1,
            max_size=5,
            unique_by=lambda effect: (effect.effect, effect.axis),
        )
    )
    gravity = draw(st.floats(0, 100))
    return Platform(
        draw(names),
        draw(lines),
        axes,
        gravity,
        tuple(effects),
        draw(parameters()),
        draw(signals()),
        draw(st.none() | st.floats(1e-6, 1e6)),
        draw(st.sampled_from([(), ("pan",)])) if axes == ("pan",) else (),
    )


@settings(
    max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(platforms())
def test_any_platform_reads_back_equal(tmp_path: Path, platform: Platform) -> None:
    path = tmp_path / "platform.toml"
    path.write_text(platform_text(platform), encoding="utf-8")
    again = read_platform(path)
    assert again == platform
    signs = [math.copysign(1, p.value) for p in platform.parameters]
    assert [math.copysign(1, p.value) for p in again.parameters] == signs
    assert platform_text(again) == platform_text(platform)


@pytest.mark.parametrize("preset", preset_names())
def test_a_preset_reads_back_equal(tmp_path: Path, preset: str) -> None:
    platform = read_platform(preset)
    path = tmp_path / "platform.toml"
    path.write_text(platform_text(platform), encoding="utf-8")
    assert read_platform(path) == platform


def test_the_text_is_plain_toml_in_the_order_of_the_platform() -> None:
    text = platform_text(read_platform("thesis-pan-drive"))
    document = tomllib.loads(text)
    assert list(document) == ["platform", "effects", "parameters", "signals"]
    assert document["parameters"]["R_pan"] == {"value": 12.9, "unit": "ohm"}
    assert text.index("[parameters.J_pan]") < text.index("[parameters.R_pan]")


def test_one_bound_alone_is_refused() -> None:
    parameter = ParameterDeclaration("b_pan", "N m s/rad", 1.0, lower=0.0)
    platform = Platform("a", "a", ("pan",), 9.81, (), (parameter,), ())
    with pytest.raises(ValueError, match="'b_pan' has one bound alone; give both or none"):
        platform_text(platform)
