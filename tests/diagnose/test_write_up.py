"""Remarks of a report: a machine that cannot exist as it is declared, noise of the inputs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.floor import Floor
from ptp_symbolic.numeric.diagnose.left_over import Carried
from ptp_symbolic.platform import ParameterDeclaration, Platform, SignalDeclaration, read_platform
from ptp_symbolic.workflows.write_up import _carried_remarks, _module_of, _tied_remarks

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
    ("noise", "carried", "said"), [(None, 1.5, 1), (None, 0.5, 0), (0.0, 1.5, 0)]
)
def test_noise_of_an_input_that_rules_is_said_unless_it_is_declared(
    noise: float | None, carried: float, said: int
) -> None:
    """A torque that a controller computes from a noisy angle is known exactly."""
    torque = SignalDeclaration("tau_pan", "tau_pan", "N m", "input", noise=noise)
    platform = Platform("arm", "Arm", ("pan",), 9.81, (), (), (torque,))
    one = np.ones(1)
    floor = Floor(one, one, Carried(*[carried * one] * 3))
    found = _carried_remarks(platform, floor)
    assert len(found) == said
    assert all("tau_pan" in text and "noise = 0.0" in text for text in found)
    assert _carried_remarks(replace(platform, signals=()), floor) == []


def test_a_tie_that_may_be_wrong_is_said() -> None:
    """Friction at rest that is declared to be that in motion is never found to be more."""
    own = ParameterDeclaration("F_c_pan", "N m", 0.1)
    tied = ParameterDeclaration("F_s_pan", "N m", 0.1, same_as="F_c_pan")
    platform = Platform("arm", "Arm", ("pan",), 9.81, (), (own, tied), ())
    (text,) = _tied_remarks(platform)
    assert text.startswith("F_s_pan is declared the same as F_c_pan")
    assert _tied_remarks(replace(platform, parameters=(own,))) == []
