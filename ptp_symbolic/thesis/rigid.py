"""Sections 5.1 and 5.2: the torques that the motions of Tables 5.2 and 5.4 need (Figs. 5.1-5.6)."""

from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from ptp_symbolic.numeric.simulation.inputs import InputSignal
from ptp_symbolic.platform import AXES, read_platform
from ptp_symbolic.thesis import printed
from ptp_symbolic.thesis.items import Item, compared, unprinted
from ptp_symbolic.thesis.motion import (
    Torques,
    along,
    at_rest,
    moving,
    needed_torques,
)

FloatArray = NDArray[np.float64]

# The thesis prints neither the length of its runs nor the angles and pulses of Fig. 5.6.
TIMES = np.linspace(0.0, 15.0, 15_001)
OFFSETS = {"0.1": 0.1, "0.01": printed.PAYLOAD_OFFSET}
TILT_ANGLES_DEG = (0.0, 30.0, 60.0, 90.0)
PULSE_TIMES = (0.0, 0.5, 1.5, 2.0, 3.0, 3.5, 4.5, 5.0, 6.0)
PULSE_RATES = (0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0)
ROUGHLY = 0.1


@cache
def ideal() -> Torques:
    """Torques of the ideal platform along Table 5.2 (Figs. 5.1 to 5.3)."""
    motion = {axis: along(TIMES, printed.IDEAL_MOTION[axis]) for axis in AXES}
    return needed_torques(read_platform("thesis-ideal"), TIMES, motion)


@cache
def payload(offset: float) -> Torques:
    """Torques with the payload `offset` m ahead of the axes along Table 5.4 (Figs. 5.4, 5.5)."""
    motion = {axis: along(TIMES, printed.PAYLOAD_MOTION[axis]) for axis in AXES}
    platform = read_platform("thesis-payload")
    return needed_torques(platform, TIMES, motion, {"c_x_payload": offset})


def pulses() -> InputSignal:
    """Two pulses of the pan rate in rad/s, each edge a cubic transition."""
    lengths, changes = np.diff(PULSE_TIMES), np.diff(PULSE_RATES)
    pieces = [
        [start, 0.0, 3.0 * change / length**2, -2.0 * change / length**3]
        for start, change, length in zip(PULSE_RATES, changes, lengths, strict=False)
    ]
    return InputSignal(np.array(PULSE_TIMES), np.array(pieces))


@cache
def held_tilt(angle_deg: float) -> Torques:
    """Torques for two pulses of pan rate, the tilt axis fixed at an angle in deg (Fig. 5.6)."""
    times = np.linspace(0.0, PULSE_TIMES[-1], 6_001)
    motion = {"pan": moving(times, pulses()), "tilt": at_rest(times, float(np.radians(angle_deg)))}
    return needed_torques(read_platform("thesis-payload"), times, motion)


def variation(torque: FloatArray, times: FloatArray) -> float:
    """Half the peak-to-peak value in N m of a torque once both transitions have ended."""
    settled = torque[times >= printed.IDEAL_MOTION["pan"].t1]
    return float(np.ptp(settled) / 2.0)


def ideal_items() -> list[Item]:
    """Figs. 5.1 to 5.3."""
    torques = ideal()
    check = (
        "inverse dynamics along Table 5.2; half of peak to peak after both transitions. The text"
        " gives 'around 0.01' for both, to which 0.014 and 0.007 round at two decimals."
    )
    return [
        compared(
            f"fig_5_{number}.{axis}_coupling_amplitude",
            f"Fig. 5.{number}, coupling amplitude of the {axis} torque, ideal platform",
            printed.IDEAL_VARIATION,
            variation(getattr(torques, axis), TIMES),
            "N m",
            check,
        )
        for number, axis in ((1, "pan"), (2, "tilt"))
    ] + [
        unprinted(
            f"fig_5_3.{axis}_torque_peak",
            f"Fig. 5.3, largest {axis} torque, ideal platform",
            float(np.max(np.abs(getattr(torques, axis)))),
            "N m",
            "inverse dynamics, Table 5.2",
        )
        for axis in AXES
    ]


def payload_items() -> list[Item]:
    """Figs. 5.4 and 5.5, with the offset as printed and with the one that holds."""
    items = []
    for name, offset in OFFSETS.items():
        torques = payload(offset)
        found = variation(torques.pan, TIMES), float(np.max(np.abs(torques.tilt)))
        rows = (
            ("fig_5_4", "pan", printed.PAYLOAD_PAN_VARIATION, found[0], "half of peak to peak"),
            ("fig_5_5", "tilt", printed.PAYLOAD_TILT_VARIATION, found[1], "largest magnitude"),
        )
        for figure, axis, value, computed, measure in rows:
            check = (
                f"inverse dynamics along Table 5.4, offset {offset:g} m; {measure}; the text says"
                " 'around', taken as 10 %"
            )
            items.append(
                compared(
                    f"{figure}.{axis}_at_{name}_m",
                    f"Fig. {figure[4:].replace('_', '.')}, {axis} torque, payload at {name} m",
                    value,
                    computed,
                    "N m",
                    check,
                    ROUGHLY * value,
                    18,
                )
            )
    return items


def reported_offsets() -> tuple[float, float]:
    """Offsets in m with which pan and tilt torque reach what section 5.2 reports."""

    def pan(offset: float) -> float:
        return variation(payload(offset).pan, TIMES) - printed.PAYLOAD_PAN_VARIATION

    def tilt(offset: float) -> float:
        return float(np.max(np.abs(payload(offset).tilt))) - printed.PAYLOAD_TILT_VARIATION

    return float(brentq(pan, 0.02, 0.2, xtol=1e-5)), float(brentq(tilt, 0.02, 0.2, xtol=1e-5))


def held_items() -> list[Item]:
    """Fig. 5.6: the thesis prints the curves alone, without angles and pulses."""
    return [
        unprinted(
            f"fig_5_6.pan_peak_at_{angle:.0f}_deg",
            f"Fig. 5.6, largest pan torque, tilt fixed at {angle:.0f} deg",
            float(np.max(np.abs(held_tilt(angle).pan))),
            "N m",
            "inverse dynamics, two pulses of 1 rad/s with cubic edges of 0.5 s (chosen here; the"
            " thesis prints neither pulses nor angles), payload at 0.1 m",
        )
        for angle in TILT_ANGLES_DEG
    ]


def items() -> list[Item]:
    """All items of this file."""
    return [*ideal_items(), *payload_items(), *held_items()]
