"""Forces put into the measured force of EMPS: a machine that has one needs so much more for the
same motion, so that its logs are those of EMPS with the force added.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat, savemat
from scipy.signal import butter, filtfilt

from ptp_symbolic.platform import SignalDeclaration

Floats = NDArray[np.float64]

STIFFNESS, MIDDLE = 7.26, 0.123  # N/m, m
AMPLITUDE = 0.6 * np.sqrt(2.0)  # N: 0.6 N rms
COGS, WAVES = 2.0 * np.pi / 0.02, 150.0  # rad/m
SLOW = 0.002  # m/s; rate over which friction turns its sign


@dataclass(frozen=True)
class Injected:
    """A force in N by the position [k, 1] in m, what it is called, and the effect that it is.

    `size` in `unit` is what went in, `found` what fitted values make of it; `wave` names the
    parameter with its wave number in rad/m, None where it has none.
    """

    title: str
    effect: str
    law: Callable[[Floats], Floats]
    size: float
    unit: str
    found: Callable[[Mapping[str, float]], float]
    wave: tuple[str, float] | None = None


def _rate(position: Floats) -> Floats:
    """Rate [k, 1] in m/s of a position sampled at 1 kHz, without what is faster than 50 Hz."""
    smooth = filtfilt(*butter(4, 0.1), position, axis=0)
    return np.asarray(np.gradient(smooth, 1e-3, axis=0))


def _friction(position: Floats) -> Floats:
    wave = AMPLITUDE * np.sin(WAVES * position + 0.4)
    return np.asarray(wave * np.tanh(_rate(position) / SLOW))


SPRING = Injected(
    "a spring about 123 mm",
    "cable_spring",
    lambda x: STIFFNESS * (x - MIDDLE),
    STIFFNESS,
    "N/m",
    lambda v: v["k1_cable_pan"],
)
COGGING = Injected(
    "cogging every 20 mm",
    "cogging",
    lambda x: np.asarray(AMPLITUDE * np.sin(COGS * x + 0.7)),
    AMPLITUDE,
    "N",
    lambda v: float(np.hypot(v["T_sin_pan"], v["T_cos_pan"])),
    ("n_cog_pan", COGS),
)
FRICTION = Injected(
    "friction with a wave of 42 mm",
    "position_dependent_friction",
    _friction,
    AMPLITUDE,
    "N",
    lambda v: float(np.hypot(v["f_sin_pan"], v["f_cos_pan"])) * v["F_c_pan"],
    ("n_F_pan", WAVES),
)
INJECTED = (SPRING, COGGING, FRICTION)


def write_injected(force: Injected, driving: SignalDeclaration, source: Path, target: Path) -> None:
    """Write the file `source` of EMPS to `target` with a force put into its `driving` signal."""
    columns = {k: np.asarray(v) for k, v in loadmat(source).items() if not k.startswith("__")}
    scale = 1.0 if driving.scale is None else driving.scale
    columns[driving.column] = columns[driving.column] + force.law(columns["qm"]) / scale
    savemat(target, columns)
