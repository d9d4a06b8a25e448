"""Viscous friction: exponential decay, steady speed, no torque on the other axis."""

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.derivation.assembly import assemble

J, B = 5.3e-4, 0.004


def platform(axes: tuple[str, ...], axis: str) -> Platform:
    effects = (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("viscous_friction", axis, None),
    )
    return Platform("viscous", "Viscous friction", axes, 9.81, effects, (), ())


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(platform(("pan",), "pan"))


def test_rate_decays_with_the_time_constant_j_over_b(model: Model) -> None:
    found = simulate(
        model, 0.5, parameters={"b_pan": B}, initial={"omega_pan": 2.0}, rtol=1e-11, atol=1e-13
    )
    decay = np.exp(-found.t * B / J)
    assert found["omega_pan"] == pytest.approx(2.0 * decay, abs=1e-9)
    assert found["theta_pan"] == pytest.approx(2.0 * J / B * (1.0 - decay), abs=1e-9)


def test_constant_torque_ends_in_the_speed_torque_over_b(model: Model) -> None:
    found = simulate(model, [0.0, 4.0], {"tau_pan": constant(-0.01)}, {"b_pan": B})
    assert found["omega_pan"][-1] == pytest.approx(-0.01 / B, rel=1e-8)


def test_it_brakes_its_own_axis_alone() -> None:
    b, w = sp.symbols("b_tilt omega_tilt", real=True)
    pan, tilt = assemble(platform(("pan", "tilt"), "tilt")).forcing
    assert not pan.has(b)
    assert sp.expand(tilt).coeff(b) == -w
