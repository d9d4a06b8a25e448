"""Both event-locating methods against motions that can be written down."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ptp_symbolic
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.simulation.inputs import constant, multisine, ramp, step
from ptp_symbolic.platform import read_platform
from tests.simulation.block import F_C, F_S, J, K, block

METHODS = ("rosenbrock", "runge_kutta")


@pytest.fixture(scope="module")
def body():
    return block()


@pytest.fixture(scope="module")
def drive():
    return ptp_symbolic.load("pan_drive")


@pytest.mark.parametrize("method", METHODS)
def test_constant_acceleration_to_machine_precision(method: str, figure) -> None:
    ideal = ptp_symbolic.load("ideal")
    found = ptp_symbolic.simulate(
        ideal, 10.0, {"tau_tilt": constant(0.3)}, {"b_tilt": 0.0}, method=method
    )
    acceleration = 0.3 / ideal.defaults["J_y_tilt"]
    exact = 0.5 * acceleration * found.t**2
    assert found["theta_tilt"] == pytest.approx(exact, rel=4e-14)
    every = slice(
        100, None, 100
    )  # from the end of a step on; before it rounding is that of its end
    off = np.abs(found["theta_tilt"][every] / exact[every] - 1.0).max()
    assert figure("relative error", off) <= 4e-14


@pytest.mark.parametrize("method", METHODS)
def test_a_block_on_a_slope_stops_where_its_energy_is_spent(body, method: str, figure) -> None:
    pull = 0.1
    found = ptp_symbolic.simulate(
        body, 5.0, {"tau_pan": constant(-pull)}, {"k": 0.0}, {"omega_pan": 2.0}, method=method
    )
    way = J * 2.0**2 / (2.0 * (F_C + pull))
    assert figure("relative error of the way", abs(found["theta_pan"][-1] / way - 1)) <= 1e-10
    assert [e.mode for e in found.events] == ["sticks"]
    assert found.events[0].time == pytest.approx(J * 2.0 / (F_C + pull), abs=1e-9)
    assert found["omega_pan"][-1] == 0.0


@pytest.mark.parametrize("method", METHODS)
def test_a_mass_on_a_belt_sticks_and_slips_in_its_limit_cycle(body, method: str, figure) -> None:
    """The belt pulls the spring at constant speed; stretch and times of a cycle in closed form."""
    speed, rate = 0.05, math.sqrt(K / J)
    found = ptp_symbolic.simulate(
        body, 20.0, {"tau_pan": ramp(0.0, K * speed * 30.0, 0.0, 30.0)}, method=method
    )
    drop = (F_S - F_C) / K
    slip = (2.0 * math.pi - 2.0 * math.atan(drop * rate / speed)) / rate
    turn = rate * slip
    left = F_C / K + drop * math.cos(turn) + speed / rate * math.sin(turn)
    stick = (F_S / K - left) / speed
    starts = [e.time for e in found.events if e.mode == "slides forward"]
    stops = [e.time for e in found.events if e.mode == "sticks"]
    assert len(stops) > 4
    assert starts[0] == pytest.approx(F_S / K / speed, abs=1e-9)
    assert np.array(stops) - starts[: len(stops)] == pytest.approx(slip, abs=2e-7)
    assert figure("error of a period, s", np.abs(np.diff(starts) - slip - stick).max()) <= 2e-7


def spring_with_friction(t: float, start: float) -> float:
    """Angle of the block let go at `start`: half cosines about points that friction shifts."""
    rate, angle = math.sqrt(K / J), start
    while True:
        centre = math.copysign(F_C / K, angle)
        if abs(angle) <= F_S / K:
            return angle
        if t < math.pi / rate:
            return centre + (angle - centre) * math.cos(rate * t)
        t, angle = t - math.pi / rate, 2.0 * centre - angle


@pytest.mark.parametrize("method", METHODS)
def test_a_block_on_a_spring_swings_out_in_half_cosines(body, method: str, figure) -> None:
    times = np.linspace(0.0, 4.0, 81)
    found = ptp_symbolic.simulate(
        body, times, initial={"theta_pan": 0.9}, rtol=1e-10, atol=1e-11, method=method
    )
    exact = [spring_with_friction(t, 0.9) for t in times]
    assert len(found.events) > 3
    assert figure("error, rad", np.abs(found["theta_pan"] - exact).max()) <= 1e-9


@pytest.mark.parametrize("method", METHODS)
def test_free_flight_across_the_gap_and_elastic_impact(drive, method: str, figure) -> None:
    """The gear holds; the load flies over the gap, bounces off a spring and comes back as fast."""
    gap, inertia, speed = drive.defaults["gap_pan"], drive.defaults["J_pan"], 0.02
    stiffness = drive.defaults["k_shaft_pan"]
    found = ptp_symbolic.simulate(
        drive,
        3.0,
        parameters={"b_pan": 0.0, "d_shaft_pan": 0.0},
        initial={"omega_pan": speed},
        rtol=1e-9,
        atol=1e-11,
        method=method,
    )
    contact = math.pi * math.sqrt(inertia / stiffness)
    times = [e.time for e in found.events]
    flight = 0.5 * gap / speed
    assert times[0] == pytest.approx(flight, abs=1e-9)
    assert figure("error of the impact, s", abs(times[1] - flight - contact)) <= 1e-8
    assert times[2] == pytest.approx(flight + contact + gap / speed, abs=1e-6)
    before = (found.t > times[1]) & (found.t < times[2])
    assert found["omega_pan"][before] == pytest.approx(-speed, rel=1e-7)
    assert np.all(found["theta_gear_pan"] == 0.0)


def test_a_smooth_stiff_machine_against_radau(tmp_path, figure) -> None:
    source = tmp_path / "smooth.toml"
    effects = ("rigid_bodies", "viscous_friction", "dc_motor", "shaft_compliance")
    blocks = "".join(
        f'[[effects]]\neffect = "{e}"\n' + ("" if e == "rigid_bodies" else 'axis = "pan"\n')
        for e in effects
    )
    source.write_text(f'[platform]\nname = "smooth"\ntitle = "Smooth"\naxes = ["pan"]\n{blocks}')
    model = emission.emit(read_platform(source))  # at the values of the thesis
    times, p = np.linspace(0.0, 2.0, 101), model.parameter_vector()
    found = ptp_symbolic.simulate(model, times, {"u_pan": multisine([12.0], [0.8])})
    truth = solve_ivp(
        lambda t, x: model.rhs(t, x, np.array([12.0 * np.sin(1.6 * np.pi * t)]), p),
        (0.0, 2.0),
        np.zeros(5),
        method="Radau",
        t_eval=times,
        rtol=1e-10,
        atol=1e-12,
    )
    off = np.abs(found.x - truth.y.T)[:, [0, 2]].max()
    assert figure("off scipy Radau, rad", off) < 1e-8
    assert np.abs(found.x - truth.y.T).max() < 1e-6


@pytest.mark.parametrize("method", METHODS)
def test_ledger_and_dissipation_with_everything_on(drive, method: str, figure) -> None:
    for signal in (step(0.0, 24.0, 0.5), multisine([12.0, 5.0], [0.8, 2.1])):
        found = ptp_symbolic.simulate(drive, 4.0, {"u_pan": signal}, method=method)
        gap = found.stored - found.stored[0] - found.supplied + found.dissipated
        missing = np.abs(gap).max() / np.abs(found.dissipated).max()
        assert figure("missing in the ledger, of throughput", missing) <= 1e-6
        assert np.diff(found.dissipated).min() >= -1e-12


@pytest.mark.parametrize("method", METHODS)
def test_energy_is_kept_without_friction(method: str, figure) -> None:
    found = ptp_symbolic.simulate(
        ptp_symbolic.load("payload"),
        60.0,
        parameters={"b_pan": 0.0, "b_tilt": 0.0},
        initial={"omega_pan": 1.0, "theta_tilt": 0.3},
        rtol=1e-12,
        atol=1e-13,
        method=method,
    )
    drift = np.ptp(found.stored) / np.abs(found.stored).max()
    assert figure("relative drift of energy over 60 s", drift) <= 1e-9
