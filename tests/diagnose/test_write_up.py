"""What is written where the machine that was found cannot exist as it is declared."""

from pathlib import Path

import pytest

from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.write_up import _module_of

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
