"""Rigid backlash: restitution, a load that friction holds, a load that coasts."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic import sensitivity, simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.events.impacts import RESTING_SPEED
from ptp_symbolic.numeric.simulation.inputs import constant, multisine
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import EffectDeclaration, Platform
from tests.independent.rigid_platform import accelerations, mass_matrix

METHODS = ("rosenbrock", "runge_kutta")
KINDS = ("elastic_impact", "hysteresis_friction", "hysteresis_inertia")
JOINT, GEAR, GAP = 0.05, 0.02, 0.026
REDUCED = JOINT * GEAR / (JOINT + GEAR)
# A motor of unit ratio: free to turn, driven by its voltage, or by a torque of 1e-4 N m/V.
BODIES = {"J_pan": JOINT, "J_motor_pan": GEAR, "N_pan": 1.0, "gap_pan": GAP, "L_pan": 1e-3}
FREE = {**BODIES, "K_t_pan": 1e-9}
DRIVEN = {**BODIES, "K_t_pan": 0.1, "R_pan": 1.0, "b_pan": 0.02}
UNDAMPED = {name: value for name, value in DRIVEN.items() if name != "b_pan"}
DRY = UNDAMPED | {"F_c_pan": 0.05, "F_s_pan": 0.08, "F_v_pan": 0.01, "v_s_pan": 0.05}
PUSHED = {**BODIES, "K_t_pan": 1e-3, "R_pan": 10.0}
VOLTAGE = {"u_pan": multisine([6.0, 3.0], [0.7, 1.9])}
PAYLOAD = {
    "J_x_tilt": 0.02,
    "J_y_tilt": 0.03,
    "J_z_tilt": 0.025,
    "m_payload": 1.0,
    "J_x_payload": 0.004,
    "J_y_payload": 0.005,
    "J_z_payload": 0.006,
    "c_x_payload": 0.12,
    "c_y_payload": 0.09,
    "c_z_payload": 0.05,
}


def platform(kind: str | None, *more: str, site: str | None = None) -> Platform:
    """Pan axis with rotor, backlash and what else is named; with a tilt axis under a payload."""
    effects = [EffectDeclaration("rigid_bodies", None, None)]
    effects += [EffectDeclaration("dc_motor", "pan", None)]
    effects += [EffectDeclaration("backlash", "pan", None, kind)]
    effects += [
        EffectDeclaration(e, None if e == "payload" else "pan", site if "friction" in e else None)
        for e in more
    ]
    axes = ("pan", "tilt") if "payload" in more else ("pan",)
    return Platform("play", "Pan axis with play", axes, 9.81, tuple(effects), (), ())


@pytest.fixture(scope="module")
def bouncing() -> Model:
    return emission.emit(platform("elastic_impact"))


def approach(found: Trajectory) -> np.ndarray:
    return found["omega_gear_pan"] - found["omega_pan"]


def assert_sound(found: Trajectory) -> None:
    """The ledger closes, nothing comes out of dissipation, the faces do not pass each other."""
    missing = found.stored - found.stored[0] - found.supplied + found.dissipated
    assert np.abs(missing).max() < 1e-6 * (np.abs(found.supplied).max() + found.stored.max())
    assert np.diff(found.dissipated).min() >= -1e-15
    assert np.abs(found["theta_gear_pan"] - found["theta_pan"]).max() < GAP / 2 + 1e-10


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("e", [0.5, 1.0])
def test_bounces_between_the_faces_in_closed_form(bouncing: Model, e: float, method: str) -> None:
    speed, count = 0.3, 8
    powers = e ** np.arange(1.0, count + 1)
    times = GAP / 2 / speed + GAP / speed * np.cumsum([0.0, *1.0 / powers[:-1]])
    after = times + GAP / speed / powers / 2
    start = {"omega_gear_pan": speed}
    found = simulate(bouncing, [0.0, *after], None, {**FREE, "e_gap_pan": e}, start, method=method)
    struck = [event.time for event in found.events if "bounces" in event.mode]
    assert struck == pytest.approx(times, abs=1e-8)
    assert np.abs(approach(found)[1:]) == pytest.approx(speed * powers, rel=1e-7)
    momentum = JOINT * found["omega_pan"] + GEAR * found["omega_gear_pan"]
    assert momentum == pytest.approx(GEAR * speed, rel=1e-7)
    lost = REDUCED * speed**2 * (1.0 - powers**2) / 2
    assert found.dissipated[1:] == pytest.approx(lost, rel=1e-6, abs=1e-11)
    assert_sound(found)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("e", [0.0, 0.3, 0.8])
def test_bounces_end_at_the_limit_of_their_sum(bouncing: Model, e: float, method: str) -> None:
    """A constant torque on the gear: a ball on a plate, which then both turn as one body."""
    torque = 0.05
    pull = torque / GEAR
    limit = math.sqrt(GAP / pull) * (1.0 + e) / (1.0 - e)
    found = simulate(
        bouncing,
        1.0,
        {"u_pan": constant(500.0)},
        {**PUSHED, "e_gap_pan": e},
        {"i_pan": 50.0},
        method=method,
    )
    (rest,) = [event.time for event in found.events if "touches" in event.mode]
    assert rest == pytest.approx(limit, abs=2.0 * RESTING_SPEED / pull / (1.0 - e) + 2e-8)
    assert found.events[-1].time == rest
    joined = found.t > rest
    assert np.abs(approach(found)[joined]).max() < 1e-11
    gained = torque / (GEAR + JOINT) * (found.t[joined] - limit)
    after = torque * limit / (GEAR + JOINT) + gained
    assert found["omega_pan"][joined] == pytest.approx(after, rel=1e-5)
    assert_sound(found)


def test_a_strike_keeps_the_momentum_of_every_coupled_body() -> None:
    model = emission.emit(platform("elastic_impact", "payload"))
    parameters = {**FREE, **PAYLOAD, "e_gap_pan": 0.7}
    start = {"theta_tilt": 0.5, "omega_tilt": -0.4, "theta_gear_pan": GAP / 2 - 1e-9}
    start |= {"omega_gear_pan": 0.6, "omega_pan": -0.2}
    found = simulate(model, [0.0, 2e-9], None, parameters, start)
    mass = mass_matrix([0.0, 0.5], parameters)
    before, after = ([row[i] for i in (2, 3)] for row in found.x)
    change = mass @ (np.array(after) - before)
    assert change[1] == pytest.approx(0.0, abs=1e-8)
    gear = found["omega_gear_pan"]
    assert change[0] == pytest.approx(GEAR * (gear[0] - gear[1]), rel=1e-6)
    assert abs(found["omega_tilt"][1] - found["omega_tilt"][0]) > 3e-3
    assert approach(found)[1] == pytest.approx(-0.7 * approach(found)[0], rel=1e-6)


def test_a_coupled_platform_bounces_as_in_a_piecewise_integration() -> None:
    model = emission.emit(platform("elastic_impact", "payload"))
    parameters = {**FREE, **PAYLOAD, "e_gap_pan": 0.9}
    end, x = 0.6, np.array([0.0, 0.5, -0.2, -0.4, 0.0, 0.6])
    found = simulate(
        model,
        [0.0, end],
        None,
        parameters,
        dict(zip(model.state_names[:6], x, strict=True)),
        rtol=1e-10,
        atol=1e-12,
    )

    def slope(_: float, x: np.ndarray) -> np.ndarray:
        swing = accelerations(x[:2], x[2:4], np.zeros(2), parameters)
        return np.array([*x[2:4], *swing, x[5], 0.0])

    def inside(_: float, x: np.ndarray) -> float:
        return GAP / 2 - abs(x[4] - x[0])

    inside.terminal, inside.direction = True, -1.0  # type: ignore[attr-defined]
    t, strikes = 0.0, 0
    while t < end:
        flight = solve_ivp(slope, (t, end), x, "DOP853", events=inside, rtol=1e-11, atol=1e-12)
        t, x = flight.t[-1], flight.y[:, -1].copy()
        if flight.status == 1:
            strikes += 1
            response = np.linalg.solve(mass_matrix(x[:2], parameters), [1.0, 0.0])
            impulse = 1.9 * (x[5] - x[2]) / (response[0] + 1.0 / GEAR)
            x[2:4] += response * impulse
            x[5] -= impulse / GEAR
    assert strikes >= 5
    assert strikes == sum("bounces" in event.mode for event in found.events)
    assert found.x[-1, :6] == pytest.approx(x, abs=2e-7)


@pytest.mark.parametrize("method", METHODS)
def test_a_held_load_is_the_play_operator(method: str) -> None:
    """Equation 2.17, at the angles that the gear output took."""
    model = emission.emit(platform("hysteresis_friction", "viscous_friction"))
    found = simulate(model, np.linspace(0.0, 4.0, 40001), VOLTAGE, DRIVEN, method=method)
    expected = [0.0]
    for gear in found["theta_gear_pan"][1:]:
        expected.append(min(max(expected[-1], gear - GAP / 2), gear + GAP / 2))
    assert len(found.events) > 10
    assert found["theta_pan"] == pytest.approx(np.array(expected), abs=5e-8)
    in_gap = np.abs(found["theta_gear_pan"] - found["theta_pan"]) < GAP / 2 - 1e-9
    assert np.all(found["omega_pan"][in_gap] == 0.0)
    assert_sound(found)


@pytest.mark.parametrize("method", METHODS)
def test_a_coasting_load_follows_a_piecewise_integration(method: str) -> None:
    """Equation 2.18 with erratum 29: joined while the torque pushes, of one speed when struck."""
    model = emission.emit(platform("hysteresis_inertia"))
    found = simulate(model, [0.0, 3.0], VOLTAGE, UNDAMPED, method=method, rtol=1e-10, atol=1e-11)
    side, t, x = 0, 0.0, np.zeros(5)

    def voltage(t: float) -> float:
        return sum(a * math.sin(2 * math.pi * f * t) for a, f in ((6.0, 0.7), (3.0, 1.9)))

    def slope(t: float, x: np.ndarray) -> np.ndarray:
        push = 0.1 * x[4]
        apart, joined = np.array([0.0, push / GEAR]), np.full(2, push / (GEAR + JOINT))
        joint, gear = joined if side else apart
        current = (voltage(t) - x[4] - 0.1 * x[3]) / 1e-3
        return np.array([x[1], joint, x[3], gear, current])

    def over(_: float, x: np.ndarray) -> float:
        return side * x[4] if side else GAP / 2 - abs(x[2] - x[0])

    over.terminal, over.direction = True, -1.0  # type: ignore[attr-defined]
    while t < 3.0:
        run = solve_ivp(slope, (t, 3.0), x, "LSODA", events=over, rtol=1e-10, atol=1e-12)
        t, x = run.t[-1], run.y[:, -1].copy()
        if run.status == 1 and side:
            x[2] = x[0] + side * (GAP / 2 - 1e-12)
            side = 0
        elif run.status == 1:
            side = 1 if x[2] > x[0] else -1
            x[1] = x[3] = (JOINT * x[1] + GEAR * x[3]) / (JOINT + GEAR)
    assert sum("touches" in event.mode for event in found.events) >= 4
    assert found.x[-1, :4] == pytest.approx(x[:4], abs=5e-7)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("site", ["gear", "joint"])
def test_dry_friction_beside_rigid_faces(kind: str, site: str) -> None:
    """Bodies that rest are struck loose and come to rest again; both methods see the same."""
    model = emission.emit(platform(kind, "csvs_friction", site=site))
    runs = [simulate(model, 4.0, VOLTAGE, DRY, method=method) for method in METHODS]
    for found in runs:
        assert_sound(found)
    assert runs[0].x[-1, :4] == pytest.approx(runs[1].x[-1, :4], abs=1e-5)
    pressed = simulate(model, 50.0, {"u_pan": constant(0.4)}, DRY)
    assert site == "gear" or pressed.events[-1].mode == "sticks"
    assert np.ptp(pressed["theta_pan"][10000:]) == 0.0


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_strikes_on_one_axis_reach_the_play_of_the_other(kind: str) -> None:
    given = platform(kind, "payload")
    tilt = tuple(replace(e, axis="tilt") for e in given.effects if e.effect == "dc_motor")
    tilt += (EffectDeclaration("backlash", "tilt", None, "elastic_impact"),)
    model = emission.emit(replace(given, effects=(*given.effects, *tilt)))
    axes = {"N_tilt": 1.0, "J_motor_tilt": 0.03, "K_t_tilt": 0.3, "gap_tilt": 0.02, "R_tilt": 1.0}
    parameters = UNDAMPED | PAYLOAD | axes
    inputs = VOLTAGE | {"u_tilt": multisine([9.0, 4.0], [0.8, 2.3])}
    runs = [
        simulate(model, 1.0, inputs, parameters, method=method, rtol=1e-10, atol=1e-11)
        for method in METHODS
    ]
    for found in runs:
        assert_sound(found)
        assert {event.element for event in found.events} == {"contact pan", "contact tilt"}
    assert runs[0].x[-1] == pytest.approx(runs[1].x[-1], abs=2e-5)


@pytest.mark.parametrize("kind", KINDS)
def test_tangents_through_strikes(kind: str) -> None:
    model = emission.emit(platform(kind, "viscous_friction"))
    names = [n for n in ("J_pan", "gap_pan", "K_t_pan", "e_gap_pan") if n in model.parameter_names]
    parameters = {**DRIVEN, **({"e_gap_pan": 0.9} if kind == "elastic_impact" else {})}
    end = {"elastic_impact": 0.2}.get(kind, 2.0)
    found = sensitivity(
        model, [0.0, end], VOLTAGE, parameters, by_parameters=names, rtol=1e-10, atol=1e-11
    )
    alone = sensitivity(model, [0.0, end], VOLTAGE, parameters, by_parameters=names[:1])
    assert alone.states[-1, :4, 0] == pytest.approx(found.states[-1, :4, 0], rel=2e-4)
    for index, name in enumerate(names):
        h = 1e-4 * parameters[name]
        above, below = (
            simulate(
                model,
                [0.0, end],
                VOLTAGE,
                {**parameters, name: parameters[name] + s * h},
                rtol=1e-12,
                atol=1e-13,
                method="runge_kutta",
            ).x[-1, :4]
            for s in (1.0, -1.0)
        )
        difference = (above - below) / (2.0 * h)
        size = np.abs(difference).max()
        assert found.states[-1, :4, index] == pytest.approx(difference, abs=2e-6 * size)
