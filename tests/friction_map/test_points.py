"""Points as people write them become SI units, or are refused in one line."""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.friction_map.points import Columns, read_points

ROWS = ((-60.0, -30.0), (-30.0, -20.0), (30.0, 20.0), (60.0, 30.0))


def written(folder: Path, heading: str, rows: tuple[tuple[float, ...], ...] = ROWS) -> Path:
    path = folder / "points.csv"
    lines = [heading, *(",".join(map(str, row)) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("rate", "torque", "nominal", "turn", "force"),
    [
        ("rpm", "mN m", None, 2.0 * np.pi / 60.0, 1e-3),
        ("deg/s", "N m", None, np.pi / 180.0, 1.0),
        ("rad/s", "%", "9.84 mN m", 1.0, 9.84e-5),
        ("rad/s", "% of 2 N m", None, 1.0, 0.02),
    ],
)
def test_units_are_those_of_the_heading(
    rate: str, torque: str, nominal: str | None, turn: float, force: float, tmp_path: Path
) -> None:
    path = written(tmp_path, f"rate [{rate}],torque [{torque}]")
    points = read_points(path, Columns(nominal=nominal))
    assert points.rate == pytest.approx([turn * row[0] for row in ROWS])
    assert points.torque == pytest.approx([force * row[1] for row in ROWS])


def test_a_torque_at_rest_has_the_direction_of_its_sign(tmp_path: Path) -> None:
    rows = (*ROWS, (0.0, -40.0), (0.0, 40.0))
    points = read_points(written(tmp_path, "rate [rpm],torque [mN m]", rows), Columns())
    assert points.sign.tolist() == [-1, -1, 1, 1, -1, 1]


@pytest.mark.parametrize(
    ("heading", "rows", "columns", "message"),
    [
        ("speed [rpm],torque [N m]", ROWS, Columns(), "Unknown column 'rate'"),
        ("rate,torque [N m]", ROWS, Columns(), r"write 'rate \[rad/s\]'"),
        ("rate [mm],torque [N m]", ROWS, Columns(), "is in mm; give rad/s"),
        ("rate [rpm],torque [N]", ROWS, Columns(), "is in N; give N m"),
        ("rate [rpm],torque [%]", ROWS, Columns(), "add `nominal`"),
        ("rate [rpm],torque [%]", ROWS, Columns(nominal="9.84"), "no nominal torque"),
        ("rate [rpm],torque [%]", ROWS, Columns(nominal="0 N m"), "no nominal torque"),
        ("rate [rpm],torque [%]", ROWS, Columns(nominal="1 fish"), "no nominal torque|not a unit"),
        ("rate [rpm],torque [N m]", ROWS[:3], Columns(), "has 3 points"),
        (
            "rate [rpm],torque [N m]",
            ((1.0, 1e300), *ROWS),
            Columns(),
            r"of 1e\+300 N m is no",
        ),
        (
            "rate [rpm],torque [N m]",
            ((1.0, 1e-300), *ROWS),
            Columns(),
            "of 1e-300 N m is none",
        ),
        ("rate [rad/s],torque [N m]", ((1e-200, 1.0), *ROWS), Columns(), "rate of 1e-200 rad/s is"),
        ("rate [rpm],torque [N m]", ((5.0, 1.0),) * 4, Columns(), "at 1 speeds"),
        (
            "rate [rpm],torque [N m]",
            tuple((v, -t) for v, t in ROWS),
            Columns(),
            "brake the motion",
        ),
        ("rate [rpm],torque [N m]", (*ROWS, (0.0, 0.0)), Columns(), "csv:6: both rate and torque"),
        (
            "rate [rpm],torque [N m],std [N m]",
            tuple((*row, 0.0) for row in ROWS),
            Columns(spread="std"),
            "standard deviation is 0 N m",
        ),
        (
            "rate [rpm],torque [N m],std [N m]",
            tuple((*row, 1e-300) for row in ROWS),
            Columns(spread="std"),
            "a standard deviation of 1e-300 N m is none of a machine; give at least 1e-12",
        ),
        (
            "rate [rpm],torque [N m],std [N m]",
            ((*ROWS[0], 1e-3), *((*row, 1e-11) for row in ROWS[1:])),
            Columns(spread="std"),
            r"csv:3: the standard deviation is 1e-11 N m beside torques of up to .* leave out `spr",
        ),
    ],
)
def test_points_that_cannot_be_used_are_refused(
    heading: str,
    rows: tuple[tuple[float, ...], ...],
    columns: Columns,
    message: str,
    tmp_path: Path,
) -> None:
    with pytest.raises(InputError, match=message):
        read_points(written(tmp_path, heading, rows), columns)
