"""Logs of an independent simulator with something hidden: a name only where it is the right one.

The simulator (tests/independent) shares no code with the package: other equations, events located
by scipy, own noise. Takes several minutes per case.
"""

from pathlib import Path

import pytest

from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.diagnosis import diagnose_platform
from tests.independent import make_logs

PLATFORMS = Path(__file__).parents[1] / "platforms"
AXES = {"fieldlog_two_axis": "two_axis"}
SINGLE = (
    ("fieldlog_pan", "constant_torque", 105, "constant_torque"),
    ("fieldlog_pan_dc", "winding_heating", 108, "winding_heating"),
    ("fieldlog_pan_dc", "rate_dependent_breakaway", 107, "rate_dependent_breakaway"),
    ("fieldlog_pan", "wrong_gap", 111, "declared_value:gap_pan"),
    ("fieldlog_two_axis", "cable_spring_tilt", 204, "cable_spring"),
    ("fieldlog_two_axis", "product_of_inertia", 41, "product_of_inertia"),
)
PAIRS = {
    ("base_tilt", "direction_dependent_friction"): 109,
    ("cable_spring", "direction_dependent_friction"): 110,
}


def diagnosed(platform: str, effects: str, seed: int, folder: Path) -> tuple[str, set[str]]:
    """Verdict and names found in new logs with `effects` hidden."""
    options = ["--platform", AXES.get(platform, "pan"), "--seed", str(seed), "--out", str(folder)]
    make_logs.main(["--effect", effects, *options])
    declared = read_platform(PLATFORMS / f"{platform}.toml")
    found = diagnose_platform(declared, [folder / "train"], [folder / "validate"]).summary
    return found["verdict"], {added["effect"] for added in found["added"]}


@pytest.mark.long
@pytest.mark.parametrize(("platform", "hidden", "seed", "name"), SINGLE)
def test_one_hidden_effect_is_named(
    platform: str, hidden: str, seed: int, name: str, tmp_path: Path
) -> None:
    verdict, names = diagnosed(platform, hidden, seed, tmp_path)
    assert (verdict, names) == ("explained", {name})


@pytest.mark.long
@pytest.mark.parametrize("pair", PAIRS, ids="+".join)
def test_two_hidden_effects_are_named(pair: tuple[str, str], tmp_path: Path) -> None:
    verdict, names = diagnosed("fieldlog_pan", "+".join(pair), PAIRS[pair], tmp_path)
    assert (verdict, names) == ("explained", set(pair))


@pytest.mark.long
@pytest.mark.parametrize(
    ("platform", "seed"),
    [("fieldlog_pan", 104), ("fieldlog_two_axis", 201), ("fieldlog_two_axis", 309)],
)
def test_a_log_without_a_hidden_effect_names_none(platform: str, seed: int, tmp_path: Path) -> None:
    assert diagnosed(platform, "nothing", seed, tmp_path) == ("nothing_missing", set())


@pytest.mark.long
def test_an_effect_that_no_library_lists_gets_no_name(tmp_path: Path) -> None:
    verdict, names = diagnosed("fieldlog_pan", "periodic_torque", 112, tmp_path)
    assert (verdict, names) == ("unexplained", set())


@pytest.mark.long
def test_friction_that_changes_five_times_per_turn_is_not_called_something_else(
    tmp_path: Path,
) -> None:
    """The library knows friction that changes once per turn: that name, or none."""
    verdict, names = diagnosed("fieldlog_pan", "position_dependent_friction", 106, tmp_path)
    assert names <= {"position_dependent_friction"} and verdict != "nothing_missing"
