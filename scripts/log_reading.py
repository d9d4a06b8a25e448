"""Reading a log beside reading its bare numbers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from timing import Row, best

from ptp_symbolic.numeric.data import read_log
from ptp_symbolic.platform import SignalDeclaration, read_platform


def log_reading() -> list[Row]:
    """A log with the measured current of a motor, read as a platform declares it."""
    voltage = SignalDeclaration("u_pan", "pan_voltage", "V", "input")
    angle = SignalDeclaration("theta_pan", "pan_angle", "rad", "output", 7200)
    current = SignalDeclaration("i_pan", "pan_current", "A", "output", noise=0.01)
    platform = replace(read_platform("thesis-pan-drive"), signals=(voltage, angle, current))
    header = "time [s],pan_voltage [V],pan_angle [rad],pan_current [A]"
    random = np.random.default_rng(1)
    table = np.column_stack([np.arange(50_000) / 200, random.normal(size=(50_000, 3))])
    with TemporaryDirectory() as folder:
        path = Path(folder) / "run.csv"
        np.savetxt(path, table, delimiter=",", header=header, comments="")
        ours, log = best(lambda: read_log(path, platform), 5)
        theirs, numbers = best(lambda: np.loadtxt(path, delimiter=",", skiprows=1), 5)
    return [
        {
            "what": "log of 50,000 rows",
            "ms": ours * 1e3,
            "error": float(np.max(np.abs(log.outputs - numbers[:, 2:]))),
            "peer": "numpy loadtxt",
            "peer ms": theirs * 1e3,
            "ratio": ours / theirs,
        }
    ]
