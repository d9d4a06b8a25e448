"""A pan body off its axis: a pendulum under a leaning base, and what else gravity acts on."""

import numpy as np
import pytest
import sympy as sp
from scipy.special import ellipk

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.platform import EffectDeclaration, Platform, SignalDeclaration
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.kane import kane
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.proof import prove_equal

MASS, ARM, INERTIA, GRAVITY = 6.0, 0.05, 0.3, 9.81


def platform(*effects: str, axes: tuple[str, ...] = ("pan",), signal: str = "") -> Platform:
    declared = tuple(EffectDeclaration(e, None, None) for e in ("rigid_bodies", *effects))
    signals = (SignalDeclaration(signal, signal, "m/s^2", "output"),) if signal else ()
    return Platform("leaning", "Leaning base", axes, GRAVITY, declared, (), signals)


def test_it_swings_about_the_azimuth_like_a_pendulum() -> None:
    """Half a period of a pendulum of finite amplitude, by the complete elliptic integral."""
    beta, amplitude, azimuth, heading = 0.2, 1.1, 0.8, 0.6
    slow = np.sqrt(MASS * GRAVITY * ARM * np.sin(beta) / (INERTIA + MASS * ARM**2))
    half_period = 2.0 * ellipk(np.sin(amplitude / 2) ** 2) / slow
    found = simulate(
        emission.emit(platform("pan_com_offset", "base_tilt")),
        [0.0, half_period],
        initial={"theta_pan": azimuth - heading - amplitude},
        parameters={
            "J_pan": INERTIA,
            "m_pan_body": MASS,
            "c_x_pan": ARM * np.cos(heading),
            "c_y_pan": ARM * np.sin(heading),
            "beta_base": beta,
            "alpha_base": azimuth,
        },
        rtol=1e-11,
        atol=1e-12,
    )
    assert found["theta_pan"][-1] == pytest.approx(azimuth - heading + amplitude, abs=1e-8)


def test_on_a_level_base_it_adds_to_the_inertia_alone() -> None:
    equations = assemble(platform("pan_com_offset", axes=("pan", "tilt")))
    m, x, y, inertia = sp.symbols("m_pan_body c_x_pan c_y_pan J_pan", real=True)
    tilt = sp.symbols("J_x_tilt J_z_tilt theta_tilt", real=True)
    rest = tilt[0] * sp.sin(tilt[2]) ** 2 + tilt[1] * sp.cos(tilt[2]) ** 2
    assert sp.simplify(equations.mass_matrix[0, 0] - inertia - m * (x**2 + y**2) - rest) == 0
    assert not {m, x, y} & equations.forcing.free_symbols


@pytest.mark.parametrize(
    "effects",
    [
        ("pan_com_offset", "base_tilt"),
        ("axis_offset", "base_tilt"),
        ("pan_com_offset", "payload", "base_tilt", "base_motion"),
    ],
)
def test_three_derivations_agree_where_gravity_acts(effects: tuple[str, ...]) -> None:
    equations = assemble(platform(*effects, axes=("pan", "tilt")))
    assert sp.Symbol("beta_base", real=True) in equations.forcing.free_symbols
    for route in (kane, newton_euler):
        assert prove_equal(equations.rigid_equations, route(equations.rigid)).equal


@pytest.mark.parametrize("axes", [("pan",), ("pan", "tilt")])
def test_a_leaning_base_of_balanced_bodies_is_refused(axes: tuple[str, ...]) -> None:
    with pytest.raises(InputError, match="no declared body has a mass off its axis; declare pay"):
        assemble(platform("base_tilt", axes=axes))
    with pytest.raises(InputError, match="no declared body has a mass off its axis; declare pay"):
        assemble(platform("base_tilt", "imu", axes=axes))


def test_an_accelerometer_feels_a_leaning_base_though_no_joint_does() -> None:
    found = assemble(platform("base_tilt", "imu", signal="specific_force_x_imu"))
    assert sp.Symbol("beta_base", real=True) in found.outputs[-1][2].free_symbols
