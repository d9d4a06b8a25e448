"""What a diagnosis left open, read from its folder."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.workflows.experiment_group import group_of
from tests.diagnose.spring_table import PLATFORM


@pytest.fixture
def platform(tmp_path: Path) -> Platform:
    (tmp_path / "table.toml").write_text(PLATFORM)
    return read_platform(tmp_path / "table.toml")


def diagnosis(folder: Path, **change: Any) -> Path:
    """A diagnosis of two effects, one of them in a group."""

    def value(number: float) -> dict[str, float]:
        return {"value": number}

    found = {
        "platform": {"name": "table"},
        "added": [
            {"effect": "cogging", "axis": "pan", "confusable_with": []},
            {"effect": "base_tilt", "axis": None, "confusable_with": ["cable_spring@pan"]},
        ],
        "fit": {"after": {"parameters": {"beta_base": value(0.07), "J_pan": value(0.05)}}},
        "ranking": [
            {"effect": "cogging", "parameters": {"T_sin_pan": value(9.0)}},
            {
                "effect": "cable_spring + cogging",
                "parameters": {"k1_cable_pan": value(0.8), "T_sin_pan": value(0.3)},
            },
        ],
    }
    folder.mkdir()
    (folder / "diagnosis.json").write_text(json.dumps(found | change))
    return folder


def test_every_set_of_a_group_with_the_values_it_was_fitted_with(
    tmp_path: Path, platform: Platform
) -> None:
    group, values = group_of(diagnosis(tmp_path / "found"), platform)
    assert group == ("cogging@pan+base_tilt", "cogging@pan+cable_spring@pan")
    fitted = {"beta_base": 0.07, "J_pan": 0.05, "k1_cable_pan": 0.8, "T_sin_pan": 0.3}
    assert values == fitted


def test_the_extended_platform_is_not_the_one_that_was_diagnosed(
    tmp_path: Path, platform: Platform
) -> None:
    source = {"platform": {"file": "turret.toml", "sha256": "0"}}
    folder = diagnosis(tmp_path / "found", provenance=source)
    added = EffectDeclaration("cogging", "pan", None)
    extended = replace(platform, effects=(*platform.effects, added))
    said = (
        r"declares cogging@pan already, .* give the platform that was diagnosed, turret\.toml, in"
    )
    with pytest.raises(InputError, match=said):
        group_of(folder, extended)


def test_a_diagnosis_that_leaves_nothing_open_has_no_group(
    tmp_path: Path, platform: Platform
) -> None:
    named = [{"effect": "cogging", "axis": "pan", "confusable_with": []}]
    assert group_of(diagnosis(tmp_path / "found", added=named), platform)[0] == ()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"platform": {"name": "turret"}}, "is of platform 'turret', not of 'table'"),
        ({"added": 3}, "is no diagnosis; name the folder"),
        ({"fit": None}, "is no diagnosis; name the folder"),
    ],
)
def test_what_is_no_diagnosis_of_the_platform_is_refused(
    tmp_path: Path, platform: Platform, change: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError) as refused:
        group_of(diagnosis(tmp_path / "found", **change), platform)
    assert message in str(refused.value)
