"""Friction maps of real machines: three screw drives, and the pan joint of the thesis.

The drives are from Mablekos-Alexiou et al., IEEE T-RO 37(4), 2021, who report Stribeck friction at
6.4 rad/s in drive 1, none in drive 2, and at 0.69 rad/s in drive 3.
"""

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.numeric.friction_map.points import Columns, read_points
from ptp_symbolic.numeric.friction_map.summary import friction_map
from tests.friction_map.laws import Side, drawn


@pytest.fixture
def drives(shared: Path) -> Path:
    path = shared / "measured" / "screw_drives" / "derived_steady_state_points.csv"
    if not path.is_file():
        pytest.skip(f"'{path}' is not there")
    return path


def map_of(number: str, drives: Path, folder: Path) -> dict[str, Any]:
    with drives.open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["drive"] == number]
    path = folder / f"drive_{number}.csv"
    lines = [f"{row['v_mean_rpm_raw_sign']},{row['torque_mean_pct_raw_sign']}" for row in rows]
    path.write_text("\n".join(["rate [rpm],torque [% of 9.84 mN m]", *lines]) + "\n")
    return friction_map(read_points(path, Columns()), "pan", 0.95)


@pytest.mark.parametrize(
    ("number", "published", "before", "after"),
    [("1", 6.4, 0.104e-3, 0.055e-3), ("3", 0.69, 0.076e-3, 0.043e-3)],
)
def test_the_published_stribeck_speed_is_in_the_interval(
    number: str, published: float, before: float, after: float, drives: Path, tmp_path: Path
) -> None:
    found = map_of(number, drives, tmp_path)
    assert found["parts"] == ["Coulomb", "Stribeck", "viscous"]
    speed = found["parameters"]["v_s_pan"]
    assert speed["low"] <= published <= speed["high"]
    assert found["rms"]["without_rise"] == pytest.approx(before, rel=0.02)
    assert found["rms"]["law"] <= after


def test_no_curve_is_named_where_none_is_published(drives: Path, tmp_path: Path) -> None:
    found = map_of("2", drives, tmp_path)
    assert found["parts"] == ["Coulomb", "viscous"]
    curved = [row["rms"] for row in found["members"] if "Stribeck" in row["member"]]
    assert min(curved) > 0.94 * found["rms"]["law"]


# Table 4.1 of the thesis, which does not print the points: these are made from it.
TABLE_4_1 = (Side(0.2267, 0.5578, 0.0159, 13.5844), Side(0.2535, 0.7922, 0.0161, 14.3004))
RATES = np.geomspace(0.004, 0.55, 24)


def test_points_of_table_4_1_give_its_parameters_back() -> None:
    rate = np.concatenate([-RATES, RATES])
    found = friction_map(drawn(7, *TABLE_4_1, rate, scatter=0.01), "pan", 0.99)
    assert found["parts"] == ["Coulomb", "Stribeck", "viscous"]
    for direction, side in zip(("positive", "negative"), TABLE_4_1, strict=True):
        fitted = found["by_direction"][direction]
        for name in ("F_c", "F_s", "F_v"):
            assert fitted[name]["low"] <= getattr(side, name) <= fitted[name]["high"], name
