"""Cogging: torque of the angle alone, conservative, and the period of a swing in one notch."""

import math

import numpy as np
import pytest
import sympy as sp
from scipy.special import ellipk

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

BODY = EffectDeclaration("rigid_bodies", None, None)
COGGING = EffectDeclaration("cogging", "pan", None)
PLATFORM = Platform("notches", "Pan axis with cogging", ("pan",), 9.81, (BODY, COGGING), (), ())
J, SIN, COS, NOTCHES = 0.05, 0.3, -0.4, 24.0
NOTCHED = {"J_pan": J, "T_sin_pan": SIN, "T_cos_pan": COS, "n_cog_pan": NOTCHES}


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


def test_period_and_amplitude_of_the_torque(model: Model) -> None:
    """Torque T_sin sin + T_cos cos of n times the angle: n notches a turn, the root of squares."""
    angles = np.linspace(0.0, 2 * np.pi, 1 + 24 * 40)
    p = model.parameter_vector(NOTCHED)
    torque = np.array([J * model.rhs(0.0, np.array([a, 0.0]), np.zeros(1), p)[1] for a in angles])
    expected = SIN * np.sin(NOTCHES * angles) + COS * np.cos(NOTCHES * angles)
    assert torque == pytest.approx(expected, abs=1e-12)
    assert np.max(torque) == pytest.approx(0.5, rel=4e-3)
    assert torque[40:] == pytest.approx(torque[:-40], abs=1e-12)
    assert np.sum(torque[:40]) == pytest.approx(0.0, abs=1e-11)


def test_it_acts_at_the_gear_output_of_a_motor() -> None:
    drive = tuple(EffectDeclaration(e, "pan", None) for e in ("dc_motor", "shaft_compliance"))
    with_motor = Platform("notches", "", ("pan",), 9.81, (BODY, *drive, COGGING), (), ())
    a, b, n, gear = sp.symbols("T_sin_pan T_cos_pan n_cog_pan theta_gear_pan", real=True)
    on_load, on_gear = assemble(with_motor).forcing
    assert sp.expand(on_gear.diff(a) - sp.sin(n * gear)) == 0
    assert sp.expand(on_gear.diff(b) - sp.cos(n * gear)) == 0
    assert on_load.has(a, b, n) is False


def test_a_swing_in_a_notch_keeps_its_energy_and_the_time_of_a_pendulum(model: Model) -> None:
    """The angle times n obeys the pendulum with n T/J for g/l."""
    swing, slow = 2.0, math.sqrt(NOTCHES * 0.6 / J)
    half_period = 2.0 * ellipk(math.sin(swing / 2) ** 2) / slow
    notch = NOTCHED | {"T_sin_pan": -0.6, "T_cos_pan": 0.0}
    times, start = np.linspace(0.0, half_period, 21), {"theta_pan": swing / NOTCHES}
    found = simulate(model, times, None, notch, start, rtol=1e-11, atol=1e-13)
    assert found["theta_pan"][-1] == pytest.approx(-swing / NOTCHES, abs=1e-9)
    assert found["omega_pan"][-1] == pytest.approx(0.0, abs=1e-7)
    height = 0.6 / NOTCHES * (np.cos(NOTCHES * found["theta_pan"]) - math.cos(swing))
    assert J / 2 * found["omega_pan"] ** 2 == pytest.approx(height, abs=1e-10)
    assert found.dissipated == pytest.approx(0.0, abs=0.0)


def test_at_no_frequency_the_torque_is_that_of_the_cosine(model: Model) -> None:
    """A scan for the frequency begins there; a potential over the frequency has no value."""
    p = model.parameter_vector(NOTCHED)
    p[model.parameter_names.index("n_cog_pan")] = 0.0
    for angle in (0.0, 0.7, -2.0):
        rate = model.rhs(0.0, np.array([angle, 0.0]), np.zeros(1), p)
        assert J * rate[1] == pytest.approx(COS, rel=1e-12)
