"""What a platform file says of its joints, and of encoders along a line."""

from pathlib import Path

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.platform.units import to_si

HEAD = """
[platform]
name = "slide"
axes = ["pan"]
joints = {{ pan = "{kind}" }}
[[effects]]
effect = "rigid_bodies"
[signals.theta_pan]
role = "output"
column = "x"
unit = "{unit}"
{resolution}
"""


def platform(folder: Path, kind: str, unit: str, resolution: str) -> Platform:
    path = folder / "slide.toml"
    path.write_text(HEAD.format(kind=kind, unit=unit, resolution=resolution), encoding="utf-8")
    return read_platform(path)


def test_a_rotary_joint_may_be_named(tmp_path: Path) -> None:
    assert platform(tmp_path, "rotary", "rad", "").linear_axes == ()
    assert platform(tmp_path, "linear", "m", "").linear_axes == ("pan",)


def test_a_count_is_the_turn_or_the_metre_over_its_counts(tmp_path: Path) -> None:
    (turning,) = platform(tmp_path, "rotary", "deg", "counts_per_revolution = 7200").signals
    (sliding,) = platform(tmp_path, "linear", "mm", "counts_per_metre = 819.2e3").signals
    assert turning.count == pytest.approx(8.726646259971648e-4, rel=1e-15)
    assert sliding.count == pytest.approx(1.220703125e-6, rel=1e-15)
    assert platform(tmp_path, "linear", "m", "noise = 1e-6").signals[0].count is None


@pytest.mark.parametrize(
    ("unit", "resolution", "said"),
    [
        ("deg", "counts_per_metre = 7200", "not for .rad.; write counts_per_revolution"),
        ("mm", "counts_per_revolution = 7200", "not for .m.; write counts_per_metre"),
        ("N", "counts_per_metre = 7200", r"not for .N.\."),
        ("m", "counts_per_metre = 0", "0 is not a number from 1 to 2.40"),
        ("m", "counts_per_metre = nan", "nan is not a number from 1 to 2.40"),
        ("rad", "counts_per_revolution = 7200.0", "7200.0 is not a whole number above 0"),
    ],
)
def test_a_resolution_that_does_not_fit_its_signal_is_refused(
    unit: str, resolution: str, said: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=said):
        platform(tmp_path, "linear" if unit == "m" else "rotary", unit, resolution)


@pytest.mark.parametrize("unit", ["cycle/mm", "turn/mm", "revolution/mm"])
def test_a_cycle_is_two_pi(unit: str) -> None:
    factor, si = to_si(unit)
    assert (factor, si) == (pytest.approx(6283.185307179586, rel=1e-14), "rad/m")
