"""Unit texts convert to SI as pint does, and nothing but a unit text gets as far as pint."""

import math
import subprocess
import sys

import pint
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import units
from ptp_symbolic.platform.units import compatible, to_si

REGISTRY: pint.UnitRegistry = pint.UnitRegistry()


@pytest.mark.parametrize(
    ("text", "factor", "si"),
    [
        ("N m s/rad", 1.0, "N m s/rad"),
        ("N*m", 1.0, "N m"),
        ("N·m", 1.0, "N m"),
        ("Nm", 1.0, "N m"),
        ("mNm s/rad", 1e-3, "N m s/rad"),
        ("kg*m**2", 1.0, "kg m^2"),
        ("kg·m²", 1.0, "kg m^2"),
        ("deg", math.pi / 180, "rad"),
        ("°", math.pi / 180, "rad"),
        ("mN m s/deg", 0.18 / math.pi, "N m s/rad"),
        ("mm", 1e-3, "m"),
        ("mH", 1e-3, "H"),
        ("µm", 1e-6, "m"),
        ("rpm", math.pi / 30, "rad/s"),
        ("turn/min", math.pi / 30, "rad/s"),
        ("kHz", 1e3, "Hz"),
        ("g mm^2", 1e-9, "kg m^2"),
        ("Ω", 1.0, "ohm"),
        ("%", 0.01, "1"),
        ("count", 1.0, "count"),
        ("1/min", 1 / 60, "1/s"),
        ("W h", 3600.0, "W s"),
        ("V/(rad/s)", 1.0, "V s/rad"),
        ("N m/(mrad s)", 1e3, "N m/(rad s)"),
        ("lbf inch", 0.45359237 * 9.80665 * 0.0254, "N m"),
    ],
)
def test_a_unit_becomes_its_si_equivalent(text: str, factor: float, si: str) -> None:
    got_factor, got_si = to_si(text)
    assert got_si == si
    assert got_factor == pytest.approx(factor, rel=1e-15)
    assert to_si(got_si) == (1.0, si)


@pytest.mark.parametrize("text", sorted(units._SI_UNITS | set(units._DEGREES)))
def test_the_short_table_agrees_with_pint(text: str) -> None:
    factor, si = to_si(text)
    quantity, other = (
        REGISTRY.Quantity(1.0, "dimensionless" if unit == "1" else unit) for unit in (text, si)
    )
    ratio = (quantity / other).to_base_units()
    assert ratio.units == REGISTRY.Unit("dimensionless")
    assert ratio.magnitude == pytest.approx(factor, rel=1e-15)
    assert other.to_base_units().magnitude == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize(
    "text",
    [
        "",
        " ",
        "V A/",
        "/s",
        "(",
        ")",
        "m)",
        "NM",
        "furlongs per",
        "import os",
        "2 m",
        "m^x",
        "m^0.5",
        "9^9",
        "9**9**9**9",
        "m^9^9",
        "((((m^9)^9)^9)^9)^9",
        "m" * 61,
        "a" * 59 + "!",
        "__import__('os')",
        "m;s",
        "Ym^9 Em^9",
        "inf",
        "nan",
        "1e3 m",
        "m'",
        "\\",
        "x" * 10**6,
    ],
)
def test_what_is_no_unit_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="is not a unit; write factors and whole exponents") as no:
        to_si(text)
    assert len(str(no.value)) < 250


@pytest.mark.parametrize("text", ["degC", "dB", "degF", "dB^3", "dBm^2", "decade^2"])
def test_a_unit_with_an_offset_or_a_logarithm_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="has an offset or a logarithm"):
        to_si(text)


@pytest.mark.parametrize("text", ["N m/rad s", "V/m s", "N/m*s"])
def test_a_unit_with_two_readings_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="can be read in two ways; put what is below the stroke"):
        to_si(text)


@pytest.mark.parametrize(
    ("unit", "other", "fits"),
    [
        ("N m", "N m", True),
        ("mN m", "N m", True),
        ("J", "N m", True),
        ("deg", "rad", True),
        ("1", "rad", True),
        ("rpm", "rad/s", True),
        ("N m s", "N m s/rad", True),
        ("V s/rad", "N m/A", True),
        ("Hz", "1/s", True),
        ("Hz", "rad/s", False),
        ("count", "rad", False),
        ("V", "A", False),
        ("N m", "N", False),
        ("kg m^2", "kg m", False),
    ],
)
def test_units_fit_if_their_dimensions_do(unit: str, other: str, fits: bool) -> None:
    assert compatible(unit, other) is fits
    assert compatible(other, unit) is fits


@settings(max_examples=300, deadline=None)
@given(st.text(st.sampled_from(list("NmskgradVAHzKJWohm0123456789^*/() ·²°µ.-'\"\\")), max_size=70))
def test_any_text_is_a_unit_or_refused(text: str) -> None:
    try:
        factor, si = to_si(text)
    except InputError as refusal:
        assert "\n" not in str(refusal)
    else:
        assert 0 < factor < math.inf
        assert si


def test_common_platforms_and_logs_do_without_pint() -> None:
    code = (
        "import sys; from ptp_symbolic.platform import read_platform, preset_names\n"
        "for name in preset_names(): read_platform(name)\n"
        "assert not {'pint', 'sympy'} & set(sys.modules)"
    )
    root = str(units.__file__).rsplit("ptp_symbolic", 1)[0]
    subprocess.run([sys.executable, "-c", code], check=True, cwd=root)
