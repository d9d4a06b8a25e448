"""Short runs of the independent pan drive, as logs and prepared for the committed model of it."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import ptp_symbolic
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, free_parameter
from ptp_symbolic.numeric.identify.evaluate import Tolerance
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters
from ptp_symbolic.numeric.identify.least_squares import Effort
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import read_platform
from tests.independent.pan_drive import CURRENT, LOAD_ANGLE, PanDrive, simulate
from tests.independent.pan_logs import COUNT, CURRENT_NOISE, PERIOD, VOLTAGE_NOISE

Floats = NDArray[np.float64]

PLATFORM = read_platform(Path(__file__).parents[1] / "platforms" / "fieldlog_pan.toml")
MODEL = ptp_symbolic.load("pan_drive")
TRUTH = {
    "J_pan": 0.1,
    "b_pan": 2.0,
    "d_shaft_pan": 1.5,
    "F_c_pan": 0.24,
    "F_s_pan": 0.65,
    "v_s_pan": 0.016,
    "F_v_pan": 14.0,
}
GAP = math.radians(1.49)
SAME_BOTH_WAYS = {f"a_{name}_pan": 0.0 for name in ("F_c", "F_s", "v_s", "F_v")}
KNOWN = {**MODEL.defaults, **SAME_BOTH_WAYS, "gap_pan": GAP}

FLOOR = 1.0 / math.sqrt(12.0)  # what rounding leaves, counts rms
COARSE_STEPS, FINE_STEPS = Effort(15, 1e-3), Effort(30, 1e-6, Tolerance(1e-5, 1e-7))


@dataclass(frozen=True)
class Made:
    """Runs, and per run the true angle of the load in rad and place in the gap (-1 to 1)."""

    runs: tuple[Run, ...]
    angles: tuple[float, ...]
    places: tuple[float, ...]


def seconds(duration: float) -> Floats:
    """Sample times [k]."""
    return PERIOD * np.arange(round(duration / PERIOD))


def crawl() -> Floats:
    """Voltage [k] that creeps both ways."""
    t = seconds(8.0)
    return 1.2 * np.where(t < 4.0, 1.0, -1.0) * np.minimum(t % 4.0, 1.0)


def stairs() -> Floats:
    """Voltage [k] in steps of one second, ending at rest."""
    return np.repeat([3.0, 6.0, 12.0, 0.0, -3.0, -12.0, 0.0], round(1.0 / PERIOD))


def sine() -> Floats:
    """Two periods of a voltage [k] that crosses the gap often."""
    return 12.0 * np.sin(2 * np.pi * 0.5 * seconds(4.0))


THREE = (crawl, stairs, sine)


def make_runs(drive: PanDrive, voltages: list[Floats], seed: int) -> Made:
    """Simulate `drive` from random places in its gap, add noise, round the angle to counts."""
    rng = np.random.default_rng(seed)
    logs, angles, places = [], [], []
    for number, voltage in enumerate(voltages):
        start = np.zeros(6)
        start[LOAD_ANGLE] = rng.uniform(-0.45, 0.45) * COUNT
        places.append(float(rng.uniform(-0.9, 0.9)))
        start[2] = start[LOAD_ANGLE] + places[-1] * drive.gap / 2
        angles.append(float(start[LOAD_ANGLE]))
        states, _ = simulate(drive, voltage, start)
        k = len(voltage)
        current = states[:, CURRENT] + CURRENT_NOISE * rng.standard_normal(k)
        angle = np.rint(states[:, LOAD_ANGLE] / COUNT) * COUNT
        noisy = voltage + VOLTAGE_NOISE * rng.standard_normal(k)
        outputs = np.column_stack([current, angle])
        logs.append(Log(f"run_{number}", PERIOD * np.arange(k), noisy[:, None], outputs))
    return Made(prepare_runs(MODEL, PLATFORM, logs), tuple(angles), tuple(places))


def starts_off(truth: dict[str, float], seed: int) -> tuple[FreeParameter, ...]:
    """Every parameter started 30 to 50 % above, or below by the same factor."""
    rng = np.random.default_rng(seed)
    factors = rng.uniform(1.3, 1.5, len(truth)) ** rng.choice([-1.0, 1.0], len(truth))
    return tuple(
        free_parameter(name, value * float(factor), 0.0, 100.0)
        for (name, value), factor in zip(truth.items(), factors, strict=True)
    )


def unfree(names: dict[str, float]) -> dict[str, float]:
    """Known values without those of `names`."""
    return {name: value for name, value in KNOWN.items() if name not in names}


def fitted(
    runs: tuple[Run, ...],
    free: tuple[FreeParameter, ...],
    fixed: dict[str, float],
    z: list[Floats] | None = None,
) -> Fit:
    """Fit coarsely, from the starts `z` where they are given, then finely from there."""
    first = fit_parameters(MODEL, runs, free, fixed, z, COARSE_STEPS)
    begin = tuple(
        free_parameter(f.name, first.values[f.name], f.lower, f.upper, None, f.tied) for f in free
    )
    return fit_parameters(MODEL, runs, begin, fixed, first.z, FINE_STEPS)
