"""Friction by the torques of motor and load: a load lifted, lowered, and broken away both ways."""

import math

import pytest
from scipy.optimize import brentq

from ptp_symbolic import simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, ramp
from ptp_symbolic.platform import EffectDeclaration, Platform

LOAD, DRY, STATIC = 9.0, 0.6, 0.8
BY_MOTOR, BY_LOAD, MOTOR_REST, LOAD_REST, MOTOR_SQUARE, LOAD_SQUARE = (
    0.05,
    0.12,
    0.04,
    0.07,
    6e-3,
    9e-3,
)
INERTIA, SHAFT, ROTOR = 0.5, 5000.0, 1.1e-5
R, L, K_T, N = 12.9, 6.9e-3, 0.0724, 500.0
GAIN = K_T * N
VALUES = {
    "J_pan": INERTIA,
    "F_c_pan": DRY,
    "F_s_pan": STATIC,
    "v_s_pan": 1e-3,
    "F_v_pan": 0.0,
    "tau0_pan": -LOAD,
    "mu_motor_pan": BY_MOTOR,
    "mu_outer_pan": BY_LOAD,
    "mu_motor_rest_pan": MOTOR_REST,
    "mu_outer_rest_pan": LOAD_REST,
    "q_motor_rest_pan": MOTOR_SQUARE,
    "q_outer_rest_pan": LOAD_SQUARE,
}
LIFTING = (LOAD * (1 + BY_LOAD) + DRY) / (1 - BY_MOTOR)  # torque of the motor at a steady rate
LOWERING = (LOAD * (1 - BY_LOAD) - DRY) / (1 + BY_MOTOR)


def held(motor: float) -> float:
    """Torque in N m that rest holds against a motor of `motor` N m, written from the paper."""
    opposed = abs(BY_MOTOR * motor + BY_LOAD * LOAD) + abs(MOTOR_REST * motor + LOAD_REST * LOAD)
    square = LOAD_SQUARE * LOAD**2 if motor > LOAD else MOTOR_SQUARE * motor**2
    return STATIC + opposed + square


def beyond(motor: float) -> float:
    """Torque beyond what rest holds, in N m."""
    return abs(motor - LOAD) - held(motor)


UPWARDS = brentq(beyond, LOAD + 1e-9, 5 * LOAD)
DOWNWARDS = brentq(beyond, 0.0, LOAD - 1e-9)


def machine(drive: tuple[str, ...], site: str | None) -> Model:
    effects = (*drive, "csvs_friction", "directional_load_friction", "constant_torque")
    placed = tuple(
        EffectDeclaration(e, "pan", site if e == "csvs_friction" else None) for e in effects
    )
    body = EffectDeclaration("rigid_bodies", None, None)
    return emission.emit(Platform("load", "", ("pan",), 9.81, (body, *placed), (), ()))


@pytest.fixture(scope="module")
def geared() -> Model:
    return machine(("dc_motor", "shaft_compliance"), "gear")


@pytest.fixture(scope="module")
def behind() -> Model:
    return machine(("dc_motor", "shaft_compliance"), "joint")


@pytest.fixture(scope="module")
def plain() -> Model:
    return machine((), None)


@pytest.mark.parametrize("site", ["geared", "behind"])
@pytest.mark.parametrize(("sign", "torque"), [(1.0, LIFTING), (-1.0, LOWERING)])
def test_a_lifted_load_costs_more_than_a_lowered_one_gives(
    site: str, sign: float, torque: float, request: pytest.FixtureRequest
) -> None:
    """At a steady rate the motor bears the load and the friction of both torques, whether at the
    gear or at the joint, where the torque of the shaft is that of the motor.
    """
    driven = request.getfixturevalue(site)
    rate = 0.3 * sign
    volts = R * torque / GAIN + GAIN * rate
    values = {**VALUES, "k_shaft_pan": SHAFT, "d_shaft_pan": 30.0}
    start = {"omega_pan": rate, "omega_gear_pan": rate, "i_pan": torque / GAIN}
    start["theta_gear_pan"] = LOAD / SHAFT
    found = simulate(driven, [0.0, 1.0], {"u_pan": constant(volts)}, values, start)
    assert found["omega_pan"][-1] == pytest.approx(rate, rel=1e-6)
    assert found["i_pan"][-1] == pytest.approx(torque / GAIN, rel=1e-6)


@pytest.mark.parametrize(("sign", "torque"), [(1.0, UPWARDS), (-1.0, DOWNWARDS)])
def test_a_driven_joint_breaks_away_where_its_torques_outdo_the_rest(
    plain: Model, sign: float, torque: float
) -> None:
    """A ramp of torque from the balance of the load, up and down."""
    ramped = {"tau_pan": ramp(LOAD, LOAD + sign * 10.0, 0.0, 1.0)}
    found = simulate(plain, 1.0, ramped, VALUES)
    assert found.events[0].time == pytest.approx(abs(torque - LOAD) / 10.0, abs=1e-8)


@pytest.mark.parametrize(("sign", "torque"), [(1.0, LIFTING), (-1.0, LOWERING)])
def test_a_driven_joint_accelerates_with_what_friction_leaves(
    plain: Model, sign: float, torque: float
) -> None:
    """A newton metre beyond the steady torque accelerates, less what it costs in friction."""
    values = {**VALUES, "v_s_pan": 1e-6}
    driven = {"tau_pan": constant(torque + 1.0)}
    found = simulate(plain, [0.0, 0.1], driven, values, {"omega_pan": 0.5 * sign})
    gained = (1.0 - sign * BY_MOTOR) * 0.1 / INERTIA
    assert found["omega_pan"][-1] == pytest.approx(0.5 * sign + gained, rel=1e-7)


def test_a_motor_at_the_gear_breaks_a_load_away_late(geared: Model) -> None:
    """The current of a voltage ramp follows through R and L; the gear holds until the balance."""
    hold, slope = R * LOAD / GAIN, 4.0
    driven = {"u_pan": ramp(hold, hold + slope, 0.0, 1.0)}
    values = {**VALUES, "k_shaft_pan": SHAFT, "d_shaft_pan": 30.0}
    start = {"theta_pan": -LOAD / SHAFT, "i_pan": LOAD / GAIN}

    def motor(t: float) -> float:
        return LOAD + GAIN / R * slope * (t - L / R * (1.0 - math.exp(-t * R / L)))

    found = simulate(geared, 1.0, driven, values, start)
    assert found.events[0].time == pytest.approx(
        brentq(lambda t: beyond(motor(t)), 1e-6, 1.0), abs=1e-6
    )


def test_torques_that_pull_together_take_their_difference(plain: Model) -> None:
    """Motor and a small load the same way: no squares, and what they cost cancels in part."""
    load = 0.5

    def margin(motor: float) -> float:
        slid = abs(BY_MOTOR * motor - BY_LOAD * load)
        rested = abs(MOTOR_REST * motor - LOAD_REST * load)
        return motor + load - (STATIC + slid + rested)

    values = {**VALUES, "tau0_pan": -load}
    found = simulate(plain, 1.0, {"tau_pan": ramp(0.0, -2.0, 0.0, 1.0)}, values)
    assert found.events[0].time == pytest.approx(brentq(margin, 0.0, 2.0) / 2.0, abs=1e-8)


@pytest.mark.parametrize("torque", [14.0, 11.5])
def test_what_rest_adds_falls_off_with_the_rate(plain: Model, torque: float) -> None:
    """At the Stribeck speed 1/e of it is left: the first acceleration, from its law."""
    rate = 0.4
    steady = DRY + BY_MOTOR * torque + BY_LOAD * LOAD
    added = held(torque) - steady
    accelerated = (torque - LOAD - steady - added * math.exp(-1.0)) / INERTIA
    values = {**VALUES, "v_s_pan": rate}
    found = simulate(plain, [0.0, 1e-5], {"tau_pan": constant(torque)}, values, {"omega_pan": rate})
    assert (found["omega_pan"][-1] - rate) / 1e-5 == pytest.approx(accelerated, rel=1e-4)


def test_two_laws_of_one_load_are_refused() -> None:
    with pytest.raises(InputError, match="Two frictions on the tilt axis depend on the load"):
        effects = ("linear_actuator", "csvs_friction", "directional_load_friction")
        body = EffectDeclaration("rigid_bodies", None, None)
        placed = tuple(EffectDeclaration(e, "tilt", None) for e in effects)
        emission.emit(Platform("load", "", ("tilt",), 9.81, (body, *placed), (), ()))
