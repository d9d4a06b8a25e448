"""Remarks of a report: a machine that cannot exist as it is declared, noise of the inputs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models.structures import structures
from ptp_symbolic.numeric.diagnose.fitted_model import fitted
from ptp_symbolic.numeric.diagnose.noise_floor import NoiseFloor, PropagatedNoise
from ptp_symbolic.numeric.diagnose.proposals import declared_start
from ptp_symbolic.platform import ParameterDeclaration, Platform, SignalDeclaration, read_platform
from ptp_symbolic.workflows.write_up import (
    _bound_hints,
    _module_of,
    _propagated_remarks,
    _tied_remarks,
    _untried_hints,
)
from tests.diagnose.spring_table import PLATFORM, spring_table

GIMBAL = """[platform]
name = "gimbal"
axes = ["pan", "tilt"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "product_of_inertia"
[parameters]
J_x_tilt = {{ value = 0.004 }}
J_y_tilt = {{ value = 0.006 }}
J_z_tilt = {{ value = 0.005 }}
J_yz_tilt = {{ start = {product} }}
"""


@pytest.mark.parametrize(("product", "exists"), [(0.0012, True), (0.0022, False)])
def test_a_tensor_that_no_body_has_is_said_and_gives_no_module(
    product: float, exists: bool, tmp_path: Path
) -> None:
    """Principal moments are 4, and 5.5 +- (0.25 + product^2)^0.5, in g m^2; none may exceed the sum
    of the others.
    """
    path = tmp_path / "gimbal.toml"
    path.write_text(GIMBAL.format(product=product))
    files, doubts = _module_of(read_platform(path))
    assert list(files) == (["gimbal.py"] if exists else [])
    assert [("J_yz_tilt" in text and "exclude each other" in text) for text in doubts] == (
        [] if exists else [True]
    )


@pytest.mark.parametrize(
    ("noise", "propagated", "said"), [(None, 1.5, 1), (None, 0.5, 0), (0.0, 1.5, 0)]
)
def test_noise_of_an_input_that_rules_is_said_unless_it_is_declared(
    noise: float | None, propagated: float, said: int
) -> None:
    """A torque that a controller computes from a noisy angle is known exactly."""
    torque = SignalDeclaration("tau_pan", "tau_pan", "N m", "input", noise=noise)
    platform = Platform("arm", "Arm", ("pan",), 9.81, (), (), (torque,))
    one = np.ones(1)
    floor = NoiseFloor(one, one, PropagatedNoise(*[propagated * one] * 3))
    found = _propagated_remarks(platform, floor)
    assert len(found) == said
    assert all("tau_pan" in text and "noise = 0.0" in text for text in found)
    assert _propagated_remarks(replace(platform, signals=()), floor) == []


def test_a_tie_that_may_be_wrong_is_said() -> None:
    """Friction at rest that is declared to be that in motion is never found to be more."""
    own = ParameterDeclaration("F_c_pan", "N m", 0.1)
    tied = ParameterDeclaration("F_s_pan", "N m", 0.1, same_as="F_c_pan")
    platform = Platform("arm", "Arm", ("pan",), 9.81, (), (own, tied), ())
    (text,) = _tied_remarks(platform)
    assert text.startswith("F_s_pan is declared the same as F_c_pan")
    assert _tied_remarks(replace(platform, parameters=(own,))) == []


def test_a_declared_value_at_the_end_of_its_range_gets_the_entry_to_write(tmp_path: Path) -> None:
    """A payload of 2 kg is looked for up to twice that; it may be twice as far off: up to 6 kg."""
    with spring_table(tmp_path) as problem:
        platform = read_platform(tmp_path / "table.toml")
        (mass,) = (c for c in problem.candidates if c.key == "declared_value:m_payload")
        ends = [
            fitted(problem, (mass,), declared_start(problem) | {"m_payload": kg}, None)
            for kg in (4.0, 3.9)
        ]
    (said,) = _bound_hints(platform, [ends[0]], {})
    assert "m_payload, 2 kg, ended at its bound of 4 kg, the end of a factor of two" in said
    entry = 'm_payload = { value = 2, unit = "kg", uncertainty = 4 }'
    assert entry in said
    assert _bound_hints(platform, [ends[1]], {}) == []
    assert _bound_hints(platform, [ends[1], ends[0]], {}) == []
    assert _bound_hints(platform, [ends[1], ends[0]], {mass.key: "ends at its bound"}) == [said]
    old = '[parameters.m_payload]\nvalue = 2.0\nunit = "kg"\n'
    assert old in PLATFORM
    path = tmp_path / "wider.toml"
    path.write_text(PLATFORM.replace(old, f"[parameters]\n{entry}\n"))
    (wider,) = (p for p in read_platform(path).parameters if p.name == "m_payload")
    assert (wider.value, wider.uncertainty) == (2.0, 4.0)


TORQUE_DRIVEN = """[platform]
name = "turntable"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
"""
MOTOR = '[[effects]]\neffect = "dc_motor"\naxis = "pan"\n'


def test_what_was_not_tried_is_said_with_what_would_have_to_be_declared(tmp_path: Path) -> None:
    path = tmp_path / "turntable.toml"
    path.write_text(TORQUE_DRIVEN)
    platform = read_platform(path)
    said = _untried_hints(platform, structures(platform)[1])
    (motor,) = (text for text in said if "winding_heating@pan" in text)
    assert not any("backlash@pan" in text or "shaft_compliance@pan" in text for text in said)
    assert "for want of dc_motor or linear_actuator on pan, not declared" in motor
    assert any("gear_eccentricity@pan" in text for text in said)
    assert not any("payload" in text and "offset" not in text for text in said)
    path.write_text(TORQUE_DRIVEN + MOTOR)
    driven = read_platform(path)
    said = _untried_hints(driven, structures(driven)[1])
    assert not any(key in text for text in said for key in ("backlash", "shaft", "heating"))


def test_a_candidate_that_could_not_be_fitted_is_said_with_the_reason(tmp_path: Path) -> None:
    path = tmp_path / "turntable.toml"
    path.write_text(TORQUE_DRIVEN + MOTOR)
    why = "the platform with it cannot be fitted: no machine has that"
    found = _untried_hints(read_platform(path), {"shaft_compliance@pan": why})
    assert found == [f"Not tried: shaft_compliance@pan ({why})."]
