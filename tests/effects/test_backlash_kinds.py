"""Rigid backlash: restitution, play held by friction, a load that coasts; against closed forms."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic import loop, sensitivity, simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.runtime.model import Model
from ptp_symbolic.simulation.inputs import constant, multisine
from ptp_symbolic.simulation.run import Trajectory

METHODS = ("rosenbrock", "runge_kutta")
JOINT, GEAR, GAP = 0.05, 0.02, 0.026
REDUCED = JOINT * GEAR / (JOINT + GEAR)
# The motor: unit ratio and a winding without inductance to speak of, so that torque is K u / R.
DRIVE = {
    "J_pan": JOINT, "J_motor_pan": GEAR, "N_pan": 1.0, "gap_pan": GAP, "R_pan": 1.0,
    "L_pan": 1e-3, "K_t_pan": 1e-9,
}  # fmt: skip
DRIVEN = {**DRIVE, "K_t_pan": 0.1}


def platform(kind: str | None, *more: EffectDeclaration, axes: tuple[str, ...] = ("pan",)):
    declared = (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("dc_motor", "pan", None),
        EffectDeclaration("backlash", "pan", None, kind),
    )
    return Platform("play", "Pan axis with play", axes, 9.81, (*declared, *more), (), ())


DAMPING = EffectDeclaration("viscous_friction", "pan", None)
TABLE = EffectDeclaration("base_tilt", None, None)
PAYLOAD = EffectDeclaration("payload", None, None)


@pytest.fixture(scope="module")
def bouncing() -> Model:
    return loop.emit(platform("elastic_impact"))


def speeds(found: Trajectory) -> np.ndarray:
    return found["omega_gear_pan"] - found["omega_pan"]


def ledger_gap(found: Trajectory) -> float:
    """What the ledger misses, over the throughput."""
    missing = found.stored - found.stored[0] - found.supplied + found.dissipated
    return float(np.abs(missing).max() / (np.abs(found.supplied).max() + found.stored.max()))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("e", [0.5, 1.0])
def test_bounces_between_the_faces_in_closed_form(bouncing: Model, e: float, method: str) -> None:
    speed, count = 0.3, 8
    start = {"theta_gear_pan": 0.0, "omega_gear_pan": speed}
    times = GAP / 2 / speed + GAP / speed * np.cumsum([0.0, *e ** -np.arange(1.0, count)])
    after = times + 0.5 * GAP / speed * e ** -np.arange(1.0, count + 1)
    found = simulate(
        bouncing, [0.0, *after], None, {**DRIVE, "e_gap_pan": e}, start, method=method
    )
    struck = [event.time for event in found.events if "bounces" in event.mode]
    assert struck == pytest.approx(times, abs=1e-9)
    assert np.abs(speeds(found)[1:]) == pytest.approx(speed * e ** np.arange(1.0, count + 1), rel=1e-9)
    momentum = JOINT * found["omega_pan"] + GEAR * found["omega_gear_pan"]
    assert momentum == pytest.approx(GEAR * speed, rel=1e-9)
    lost = 0.5 * REDUCED * speed**2 * (1.0 - e ** (2.0 * np.arange(count + 1)))
    assert found.dissipated == pytest.approx(lost, rel=1e-8, abs=1e-15)
    assert ledger_gap(found) < 1e-12


