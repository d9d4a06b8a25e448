"""Logs as CSV: what the sensors make of a recording."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tests.benchmark.machine import (
    CURRENT_NOISE,
    Floats,
    Machine,
    Recording,
    Values,
    autoregression,
)
from tests.benchmark.variation import Variation

INPUT_UNITS = {True: ("voltage", "V"), False: ("torque", "N*m")}  # by voltage_driven


def encoder_noise(rng: np.random.Generator, samples: int, variation: Variation) -> Floats:
    """Noise [samples] in rad before rounding, white or coloured, stationary from the start."""
    size = variation.noise_counts * 2 * np.pi / variation.counts
    shocks = rng.normal(size=samples)
    if variation.noise_kind == "coloured":
        shocks[1:] *= np.sqrt(1.0 - variation.noise_pole**2)
        shocks = autoregression(shocks, variation.noise_pole)
    return size * shocks


def header(machine: Machine, variation: Variation) -> str:
    """The line of column names."""
    quantity, unit = INPUT_UNITS[machine.voltage_driven]
    columns = ["time [s]", *(f"{axis}_{quantity} [{unit}]" for axis in machine.axes)]
    if machine.voltage_driven and variation.current:
        columns += [f"{axis}_current [A]" for axis in machine.axes]
    return ",".join([*columns, *(f"{axis}_angle [rad]" for axis in machine.axes)])


def log_rows(
    machine: Machine,
    values: Values,
    recording: Recording,
    variation: Variation,
    input_noise: float,
    rng: np.random.Generator,
) -> Floats:
    """Columns [rows, columns] of a log: rows in which the computer stalls are missing."""
    samples, joints = len(recording.inputs), len(machine.axes)
    inputs = recording.inputs + input_noise * rng.normal(size=recording.inputs.shape)
    read = machine.readings(values, recording.states, variation)
    count = 2 * np.pi / variation.counts
    angles = np.empty((samples, joints))
    for k in range(joints):
        noisy = read[:, k] + encoder_noise(rng, samples, variation)
        angles[:, k] = np.rint(noisy / count) * count + 0.0
    currents = read[:, joints:] + CURRENT_NOISE * rng.normal(size=(samples, read.shape[1] - joints))
    columns = np.column_stack([recording.run.time, inputs, currents, angles])
    return columns[recording.run.kept]


def write_log(path: Path, title: str, columns: Floats, angles: int) -> None:
    """Write a CSV; the last `angles` columns with nine decimals."""
    path.parent.mkdir(parents=True, exist_ok=True)
    form = ["%.6f", *["%.8g"] * (columns.shape[1] - 1 - angles), *["%.9f"] * angles]
    row = ",".join(form)
    lines = [row % tuple(values) for values in columns.tolist()]
    path.write_text("\n".join([title, *lines]) + "\n")


def write_logs(
    folder: Path,
    machine: Machine,
    values: Values,
    recordings: Sequence[Recording],
    variation: Variation,
    input_noise: float,
    seed: int,
) -> None:
    """Write a CSV per recording, each with noise of its own."""
    title = header(machine, variation)
    for number, recording in enumerate(recordings):
        rng = np.random.default_rng([seed, 6, number])
        columns = log_rows(machine, values, recording, variation, input_noise, rng)
        write_log(folder / f"{recording.run.path}.csv", title, columns, len(machine.axes))
