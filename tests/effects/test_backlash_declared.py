"""Kinds of backlash as a platform declares them: read, written, refused."""

from dataclasses import replace
from pathlib import Path

import pytest

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.platform import read_platform
from ptp_symbolic.platform.writer import platform_text
from tests.effects.test_backlash_kinds import FREE, METHODS, platform


def test_the_kind_is_read_and_written(tmp_path: Path) -> None:
    given = platform("hysteresis_friction")
    path = tmp_path / "platform.toml"
    path.write_text(platform_text(given))
    assert 'kind = "hysteresis_friction"' in path.read_text()
    assert read_platform(path) == given
    usual = emission.emit(platform(None, "shaft_compliance"))
    assert emission.emit(platform("dead_zone", "shaft_compliance")).module is usual.module


def test_what_does_not_go_together_is_refused() -> None:
    bouncing = emission.emit(platform("elastic_impact"))
    choices = "dead_zone, elastic_impact, hysteresis_friction, hysteresis_inertia"
    refused = [
        (platform("plastic"), rf"'backlash' has no kind 'plastic'\. Choose one of: {choices}\."),
        (platform("elastic_impact", "shaft_compliance"), "beside a shaft; remove shaft_compliance"),
        (platform("elastic_impact", "csvs_friction", "load_dependent_friction"), "torque that it"),
    ]
    bare = platform("elastic_impact")
    without_motor = tuple(e for e in bare.effects if e.effect != "dc_motor")
    refused += [(replace(bare, effects=without_motor), "gear output without inertia; declare")]
    motor = replace(bare.effects[1], kind="elastic_impact")
    refused += [(replace(bare, effects=(motor,)), "'dc_motor' has no kinds; remove kind")]
    for wrong, message in refused:
        with pytest.raises(InputError, match=message):
            emission.emit(wrong)
    for method in (*METHODS, "fixed_step"):
        with pytest.raises(InputError, match=r"starts 0\.02 rad ahead of the joint, beyond a"):
            simulate(
                bouncing, 1.0, parameters=FREE, initial={"theta_gear_pan": 0.02}, method=method
            )
    held = emission.emit(platform("hysteresis_friction"))
    with pytest.raises(InputError, match="in the gap, where friction holds the joint"):
        simulate(held, 1.0, parameters=FREE, initial={"omega_pan": 0.02})
