"""Gear out of true: the joint leads and lags the gear once per turn, and no energy is lost; on a
rigid gear the motor's inertia and lever change with the angle.
"""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    *(
        EffectDeclaration(e, "pan", None)
        for e in (
            "viscous_friction",
            "dc_motor",
            "shaft_compliance",
            "backlash",
            "gear_eccentricity",
        )
    ),
)
PLATFORM = Platform("wheel", "Pan axis with a gear out of true", ("pan",), 9.81, EFFECTS, (), ())
# The torque constant is next to nothing, so that rotor and load move freely.
J_GEAR, J_LOAD, K, GAP = 2.75, 0.05, 5000.0, 0.02
SIN, COS = 0.008, -0.006
WHEEL = {
    "J_pan": J_LOAD,
    "b_pan": 0.0,
    "K_t_pan": 1e-9,
    "J_motor_pan": J_GEAR / 500.0**2,
    "k_shaft_pan": K,
    "d_shaft_pan": 0.0,
    "gap_pan": GAP,
    "g_sin_pan": SIN,
    "g_cos_pan": COS,
}


def error(angle: float | np.ndarray) -> float | np.ndarray:
    return SIN * np.sin(angle) + COS * np.cos(angle)


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_flywheel_drags_the_joint_through_the_error_of_every_turn(
    model: Model, sign: float
) -> None:
    """Behind the face by the twist b w/k: an error of 0.01 rad, once per turn."""
    rate, damping = 0.8 * sign, 1.0
    heavy = WHEEL | {"J_motor_pan": 100.0, "b_pan": damping, "d_shaft_pan": 1.0}
    behind = sign * GAP / 2 + damping * rate / K
    start = {
        "omega_gear_pan": rate,
        "omega_pan": rate * (1 + SIN),
        "theta_pan": COS - behind,
    }
    found = simulate(model, np.linspace(0.0, 16.0, 161), None, heavy, start)
    gear = found["theta_gear_pan"]
    assert gear == pytest.approx(rate * found.t, abs=1e-5)
    lead = found["theta_pan"] - gear + behind
    assert lead == pytest.approx(error(gear), abs=5e-6)
    assert np.ptp(lead) == pytest.approx(0.02, rel=2e-3)
    assert found.events == ()


@pytest.mark.parametrize("gear", [-2.0, 0.3, 1.7])
@pytest.mark.parametrize(("beyond", "side"), [(-1e-6, 1.0), (1e-3, 1.0), (1e-3, -1.0)])
def test_the_gap_lies_about_the_error(
    model: Model, gear: float, beyond: float, side: float
) -> None:
    """The reaction on the gear carries its slope, so that power in equals power out."""
    names = model.state_names
    x = np.zeros(len(names))
    x[names.index("theta_gear_pan")] = gear
    x[names.index("theta_pan")] = gear + error(gear) - side * (GAP / 2 + beyond)
    dx = model.rhs(0.0, x, np.zeros(1), model.parameter_vector(WHEEL))
    torque, slope = side * K * max(beyond, 0.0), 1 + SIN * np.cos(gear) - COS * np.sin(gear)
    assert J_LOAD * dx[names.index("omega_pan")] == pytest.approx(torque, abs=1e-9)
    assert J_GEAR * dx[names.index("omega_gear_pan")] == pytest.approx(-slope * torque, abs=1e-9)


def test_energy_stays_while_the_load_rattles(model: Model) -> None:
    large = WHEEL | {"g_sin_pan": 0.16, "g_cos_pan": -0.12}
    start = {"omega_gear_pan": 2.0, "theta_pan": -0.12}
    found = simulate(model, 2.0, None, large, start, rtol=1e-11, atol=1e-12)
    gear = found["theta_gear_pan"]
    twist = gear + 20 * error(gear) - found["theta_pan"]
    beyond = np.maximum(np.abs(twist) - GAP / 2, 0.0)
    energy = J_GEAR / 2 * found["omega_gear_pan"] ** 2 + J_LOAD / 2 * found["omega_pan"] ** 2
    assert energy + K / 2 * beyond**2 == pytest.approx([J_GEAR / 2 * 4.0] * len(gear), abs=1e-6)
    assert len(found.events) > 4


RIGID = Platform(
    "rigid wheel",
    "Pan axis on a rigid gear out of true",
    ("pan",),
    9.81,
    (
        EFFECTS[0],
        *(e for e in EFFECTS if e.effect in ("viscous_friction", "dc_motor", "gear_eccentricity")),
    ),
    (),
    (),
)
N, J_MOTOR, K_T, R, L, B = 50.0, 4e-5, 0.0724, 12.9, 6.9e-3, 0.02
LARGE = {"g_sin": 0.12, "g_cos": -0.05, "g_sin2": 0.03, "g_cos3": 0.02}
MOTOR = {
    "J_pan": J_LOAD,
    "b_pan": B,
    "N_pan": N,
    "J_motor_pan": J_MOTOR,
    "K_t_pan": K_T,
    "R_pan": R,
    "L_pan": L,
} | {f"{name}_pan": value for name, value in LARGE.items()}


def lagrangian_motion(
    volts: float, start: tuple[float, float, float], times: np.ndarray
) -> np.ndarray:
    """Angle, rate, current, and the energies supplied and lost [5, n], by Lagrange's equation of a
    load and a rotor at the angle N (theta - e(theta)), in SymPy's own mechanics, and SciPy.
    """
    t = sp.Symbol("t")
    theta = sp.Function("theta")(t)
    current, q, w = sp.symbols("i q w")
    lead = (
        LARGE["g_sin"] * sp.sin(theta)
        + LARGE["g_cos"] * sp.cos(theta)
        + LARGE["g_sin2"] * sp.sin(2 * theta)
        + LARGE["g_cos3"] * sp.cos(3 * theta)
    )
    rotor = N * (theta - lead)
    kinetic = J_LOAD * theta.diff(t) ** 2 / 2 + J_MOTOR * rotor.diff(t) ** 2 / 2
    work = K_T * current * rotor.diff(theta) - B * theta.diff(t)
    lagrange = (kinetic.diff(theta.diff(t)).diff(t) - kinetic.diff(theta) - work).expand()
    slope = sp.solve(lagrange, theta.diff(t, 2))[0]
    plain = {theta.diff(t): w, theta: q}
    acceleration, turning = (
        sp.lambdify((q, w, current), e.subs(plain)) for e in (slope, rotor.diff(t))
    )

    def slopes(_: float, y: np.ndarray) -> list[float]:
        angle, rate, amps = y[:3]
        voltage = volts - R * amps - K_T * turning(angle, rate, amps)
        lost = R * amps**2 + B * rate**2
        return [rate, acceleration(angle, rate, amps), voltage / L, volts * amps, lost]

    begin = [*start, 0.0, 0.0]
    span = (float(times[0]), float(times[-1]))
    solved = solve_ivp(slopes, span, begin, t_eval=times, rtol=1e-11, atol=1e-12, method="LSODA")
    return np.asarray(solved.y)


@pytest.fixture(scope="module")
def rigid() -> Model:
    return emission.emit(RIGID)


@pytest.mark.parametrize("volts", [12.0, -7.0])
def test_a_rigid_motor_turns_as_lagrange_says(rigid: Model, volts: float) -> None:
    times = np.linspace(0.0, 4.0, 81)
    start = {"theta_pan": 0.4, "omega_pan": -1.0, "i_pan": 0.2}
    found = simulate(rigid, times, {"u_pan": constant(volts)}, MOTOR, start, rtol=1e-10, atol=1e-11)
    angle, rate, current, supplied, lost = lagrangian_motion(volts, (0.4, -1.0, 0.2), times)
    assert np.ptp(angle) > 2.0 * np.pi
    assert found["theta_pan"] == pytest.approx(angle, abs=1e-7)
    assert found["omega_pan"] == pytest.approx(rate, abs=1e-7)
    assert found["i_pan"] == pytest.approx(current, abs=1e-7)
    assert found.supplied == pytest.approx(supplied, abs=1e-6)
    assert found.dissipated == pytest.approx(lost, abs=1e-6)


def test_a_stiff_shaft_turns_the_joint_as_a_rigid_gear_does(model: Model, rigid: Model) -> None:
    """The same small amplitudes, with a shaft and without: apart by the square of the error."""
    shared = {"J_pan": J_LOAD, "b_pan": B, "N_pan": N, "J_motor_pan": J_MOTOR}
    shared |= {"g_sin_pan": SIN, "g_cos_pan": COS}
    stiff = {"k_shaft_pan": 1e5, "d_shaft_pan": 100.0, "gap_pan": 0.0}
    times, driven = np.linspace(0.0, 3.0, 61), {"u_pan": constant(6.0)}
    begins = {"theta_pan": COS}
    behind = simulate(model, times, driven, shared | stiff, begins)["theta_pan"]
    true = simulate(rigid, times, driven, shared | {"g_sin_pan": 0.0, "g_cos_pan": 0.0}, begins)
    direct = simulate(rigid, times, driven, shared, begins)["theta_pan"]
    assert np.max(np.abs(direct - true["theta_pan"])) > 0.01
    assert direct == pytest.approx(behind, abs=4e-4)
