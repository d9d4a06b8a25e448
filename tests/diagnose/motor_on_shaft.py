"""A motor, a gear that may run out of true, a flexible shaft, and a load with dry friction in
bearings of its own: integrated by the classical Runge-Kutta method in steps so short that friction
smoothed over `smooth` rad/s holds the load as a set-valued one does.
"""

import csv
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class Machine(NamedTuple):
    """Values in SI, friction at the load; `asymmetry` is the half difference of dry friction by
    direction, `error` [rad] the amplitude of the gear's error, once a turn at `phase` [rad].
    """

    resistance: float
    inductance: float
    torque_constant: float
    motor_inertia: float
    ratio: float
    inertia: float
    stiffness: float
    damping: float
    coulomb: float
    static: float
    stribeck: float
    viscous: float
    asymmetry: float
    error: float
    phase: float
    smooth: float


@njit
def slope(machine: Machine, y: Floats, u: float, out: Floats) -> None:
    """Rates of load angle, load rate, angle and rate of the gear before its error, current."""
    rate, gear_rate = y[1], y[3]
    error = machine.error * np.sin(y[2] + machine.phase)
    lead = 1.0 + machine.error * np.cos(y[2] + machine.phase)
    shaft = machine.stiffness * (y[2] + error - y[0]) + machine.damping * (lead * gear_rate - rate)
    fallen = np.exp(-((rate / machine.stribeck) ** 2))
    dry = machine.coulomb + (machine.static - machine.coulomb) * fallen
    sign = np.tanh(rate / machine.smooth)
    friction = dry * sign * (1.0 + machine.asymmetry * sign) + machine.viscous * rate
    drive = machine.torque_constant * machine.ratio
    out[0] = rate
    out[1] = (shaft - friction) / machine.inertia
    out[2] = gear_rate
    out[3] = (drive * y[4] - lead * shaft) / (machine.motor_inertia * machine.ratio**2)
    out[4] = (u - machine.resistance * y[4] - drive * gear_rate) / machine.inductance


@njit
def angles(machine: Machine, y: Floats, volts: Floats, period: float, substeps: int) -> Floats:
    """The load's angle [k] in rad at every sample of held voltages [k], from the state y [5]."""
    h, found = period / substeps, np.zeros(len(volts))
    a, b, c, d = np.zeros(5), np.zeros(5), np.zeros(5), np.zeros(5)
    for k in range(len(volts)):
        found[k] = y[0]
        for _ in range(substeps):
            slope(machine, y, volts[k], a)
            slope(machine, y + 0.5 * h * a, volts[k], b)
            slope(machine, y + 0.5 * h * b, volts[k], c)
            slope(machine, y + h * c, volts[k], d)
            y = y + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
    return found


def write_log(path: Path, period: float, volts: Floats, shown: Floats) -> None:
    """A log with voltages in V and angles in rad at every sample."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["time [s]", "voltage [V]", "angle [rad]"])
        for k, (u, angle) in enumerate(zip(volts, shown, strict=True)):
            table.writerow([f"{period * k:.6f}", f"{u:.6f}", f"{angle:.9f}"])
