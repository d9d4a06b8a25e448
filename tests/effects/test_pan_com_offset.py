"""A pan body off its axis: a pendulum under a leaning base, and what else gravity acts on."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp
from scipy.special import ellipk

import ptp_symbolic as ptp
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


LEAN, AZIMUTH, DAMPING, TRUTH = 0.12, 0.4, 0.05, {"c_x_pan": 0.031, "c_y_pan": -0.017}


def swing(t: float, x: np.ndarray, torque: float) -> list[float]:
    """Newton's second law of the pan body about its axis, gravity along the slope of the base."""
    angle, rate = x
    slope = GRAVITY * np.sin(LEAN) * np.array([np.cos(AZIMUTH), np.sin(AZIMUTH)])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    centre = np.array([TRUTH["c_x_pan"], TRUTH["c_y_pan"]])
    x_c, y_c = turn @ centre
    moment = MASS * (x_c * slope[1] - y_c * slope[0])
    total = INERTIA + MASS * float(centre @ centre)
    return [rate, (moment + torque - DAMPING * rate) / total]


def test_a_fit_finds_the_centre_of_mass_under_a_leaning_base(tmp_path: Path) -> None:
    """A log that SciPy made, the platform balanced at the start of the fit."""
    period, noise, rng = 0.01, 2e-4, np.random.default_rng(2)
    x, rows = np.zeros(2), []
    for t in np.arange(0.0, 12.0, period):
        torque = 0.3 * np.sin(2.1 * t)
        rows.append([t, torque, x[0] + noise * rng.normal()])
        x = solve_ivp(swing, (t, t + period), x, args=(torque,), rtol=1e-9, atol=1e-11).y[:, -1]
    header = "time [s],torque [N m],angle [rad]"
    np.savetxt(tmp_path / "swing.csv", rows, delimiter=",", header=header, comments="")
    (tmp_path / "pan.toml").write_text(
        '[platform]\nname = "pan"\naxes = ["pan"]\n'
        + "".join(f'[[effects]]\neffect = "{e}"\n' for e in ("rigid_bodies", "pan_com_offset"))
        + '[[effects]]\neffect = "base_tilt"\n'
        + '[[effects]]\neffect = "viscous_friction"\naxis = "pan"\n[parameters]\n'
        + f"J_pan = {{ value = {INERTIA} }}\nm_pan_body = {{ value = {MASS} }}\n"
        + f"beta_base = {{ value = {LEAN} }}\nalpha_base = {{ value = {AZIMUTH} }}\n"
        + "b_pan = { start = 0.1, bounds = [0.0, 1.0] }\n"
        + "".join(f"{name} = {{ start = 0.0, bounds = [-0.2, 0.2] }}\n" for name in TRUTH)
        + '[signals]\ntau_pan = { role = "input", column = "torque", unit = "N m" }\n'
        + f'theta_pan = {{ role = "output", column = "angle", unit = "rad", noise = {noise} }}\n'
    )
    found = ptp.fit(tmp_path / "pan.toml", [tmp_path / "swing.csv"])
    for name, truth in {**TRUTH, "b_pan": DAMPING}.items():
        lower, upper = found.parameters[name].interval
        assert lower is not None and upper is not None, name
        assert abs(found.parameters[name].value - truth) <= upper - lower, (name, found)
        assert upper - lower < 0.1 * abs(truth), (name, found)
