"""The contact of the pan drive: its mode, its impact, and whether its ringing is numerical."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

import ptp_symbolic
from ptp_symbolic.numeric.simulation.inputs import step
from ptp_symbolic.thesis.backlash_laws import restitution
from ptp_symbolic.thesis.friction import drive_values
from ptp_symbolic.thesis.items import Item, unprinted
from ptp_symbolic.thesis.responses import as_printed, pan_drive

FloatArray = NDArray[np.float64]
TOLERANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
RINGING = 0.4


@dataclass(frozen=True)
class Mode:
    """An oscillation: natural frequency in Hz and damping ratio."""

    frequency: float
    damping: float


def contact_mode() -> Mode:
    """The oscillation of load against motor while the gap is closed, friction at its viscous part.

    Eigenvalues of load angle and rate, motor angle and rate at the gear output, and current.
    """
    p = drive_values() | as_printed()
    gear_constant = p["K_t_pan"] * p["N_pan"]
    motor, load, k = p["J_motor_pan"] * p["N_pan"] ** 2, p["J_pan"], p["k_shaft_pan"]
    matrix = np.array(
        [
            [0.0, 1.0, 0.0, 0.0, 0.0],
            [-k / load, -p["b_pan"] / load, k / load, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, 0.0],
            [k / motor, 0.0, -k / motor, -p["F_v_pan"] / motor, gear_constant / motor],
            [0.0, 0.0, 0.0, -gear_constant / p["L_pan"], -p["R_pan"] / p["L_pan"]],
        ]
    )
    values = np.linalg.eigvals(matrix)
    pair = max(values, key=lambda value: value.imag)
    return Mode(float(abs(pair) / (2.0 * np.pi)), float(-pair.real / abs(pair)))


def twist_after_step(tolerance: float, **changes: float) -> tuple[FloatArray, FloatArray]:
    """Times in s and twist of the shaft in rad after a step of 24 V, without the gap angle."""
    times = np.linspace(0.0, RINGING, 4_001)
    run = ptp_symbolic.simulate(
        pan_drive(), times, {"u_pan": step(0.0, 24.0, 0.0)}, as_printed() | changes, rtol=tolerance
    )
    return times, run["theta_gear_pan"] - run["theta_pan"]


@cache
def convergence() -> FloatArray:
    """Rows [k, 2]: tolerance, and largest change of the twist in rad against the finest one.

    A ringing that the integrator makes itself would change with its step.
    """
    curves = [twist_after_step(tolerance)[1] for tolerance in TOLERANCES]
    return np.array(
        [
            [tolerance, float(np.max(np.abs(curve - curves[-1])))]
            for tolerance, curve in zip(TOLERANCES[:-1], curves, strict=False)
        ]
    )


def ringing_frequency() -> float:
    """Frequency in Hz of the ringing in the simulation of a step without a gap."""
    times, twist = twist_after_step(1e-9, gap_pan=0.0)
    late = times > 0.05
    rate = np.gradient(twist, times)[late]
    crossings = times[late][1:][np.diff(np.sign(rate)) > 0]
    return float((len(crossings) - 1) / (crossings[-1] - crossings[0]))


def items() -> list[Item]:
    """All items of this file."""
    mode = contact_mode()
    rows = convergence()
    return [
        unprinted(
            "section_5_4.contact_frequency",
            "Contact mode of the pan drive, frequency",
            mode.frequency,
            "Hz",
            "eigenvalues of the closed contact (erratum 25)",
        ),
        unprinted(
            "section_5_4.contact_damping",
            "Contact mode of the pan drive, damping ratio",
            mode.damping,
            "1",
            "eigenvalues of the closed contact (erratum 25)",
        ),
        unprinted(
            "section_5_4.ringing_frequency",
            "Ringing after the step, gap closed",
            ringing_frequency(),
            "Hz",
            "zero crossings of the simulated twist rate",
        ),
        unprinted(
            "section_5_4.ringing_change",
            "Change of the ringing from tolerance 1e-6 to 1e-9",
            float(rows[TOLERANCES.index(1e-6), 1]),
            "rad",
            "largest difference of the twist; it shrinks with the tolerance (erratum 25)",
        ),
        unprinted(
            "section_5_4.restitution",
            "Restitution of one impact, undamped spring alone",
            restitution(0.0),
            "1",
            "simulation of the pan drive, its motor held: one impact across the gap (erratum 26)",
        ),
        unprinted(
            "section_5_4.restitution_damped",
            "Restitution with the joint's friction",
            restitution(drive_values()["b_pan"]),
            "1",
            "simulation of the pan drive, its motor held: one impact across the gap (erratum 26)",
        ),
    ]
