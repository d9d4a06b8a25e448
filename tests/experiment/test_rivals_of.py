"""The models that an experiment is for, fitted to the logs so far."""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows.experiment_rivals import rivals_of
from ptp_symbolic.workflows.preparation import workers
from tests.experiment.table_contender import PERIOD, PLATFORM, VALUES, motion

SOFT = 0.01  # N m/rad


def test_a_rival_is_fitted_where_the_measured_motion_leads(tmp_path: Path) -> None:
    """A spring that is a hundredth of what a search begins with, on a table that turns far: begun
    there alone its fit ends at another stiffness. An offset in its place leaves far more.
    """
    path = tmp_path / "table.toml"
    path.write_text(PLATFORM)
    time = PERIOD * np.arange(1000)
    torque = np.sin(2.0 * np.pi * np.outer(time, [0.31, 0.83, 1.71])).sum(axis=1)
    soft = SOFT - VALUES["k1_cable_pan"]
    log = tmp_path / "run.csv"
    rows = np.column_stack([time, torque, motion(torque, 0.3, k=soft)])
    head = "time [s],torque [N m],angle [rad]"
    np.savetxt(log, rows, delimiter=",", header=head, comments="", fmt="%.12g")
    with workers() as executor:
        found = rivals_of(
            read_platform(path),
            ("cable_spring@pan", "constant_torque@pan"),
            (),
            {},
            [log],
            executor,
            lambda text: None,
        )
    spring, offset = found.contenders
    assert spring.values["k1_cable_pan"] == pytest.approx(SOFT, rel=5e-2)
    assert spring.values["b_pan"] == pytest.approx(VALUES["b_pan"], rel=1e-2)
    assert offset.left > 100.0 * spring.left
    assert any("constant_torque@pan leaves" in text for text in found.remarks)
