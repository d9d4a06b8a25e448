"""Steps of fixed length against closed forms, located events and an independent simulation."""

import math

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.simulation.inputs import constant, multisine, ramp, step, table
from tests.independent.pan_drive import PanDrive
from tests.independent.pan_drive import simulate as simulate_independently
from tests.simulation.block import F_C, F_S, J, K, block


@pytest.fixture(scope="module")
def body():
    return block()


@pytest.fixture(scope="module")
def drive():
    return ptp_symbolic.load("pan_drive")


def run(model, times, inputs=None, size=1e-3, **rest):
    return ptp_symbolic.simulate(model, times, inputs, method="fixed_step", step=size, **rest)


def test_order_two_in_smooth_motion(body, figure) -> None:
    rate, errors = math.sqrt(K / J), []
    for size in (2e-3, 1e-3):
        found = run(
            body,
            [0.0, 3.0],
            None,
            size,
            parameters={"F_c": 0.0, "F_s": 0.0},
            initial={"theta_pan": 0.5, "omega_pan": 0.2},
        )
        exact = 0.5 * math.cos(3.0 * rate) + 0.2 / rate * math.sin(3.0 * rate)
        errors.append(abs(found["theta_pan"][-1] - exact))
    assert figure("order", math.log2(errors[0] / errors[1])) == pytest.approx(2.0, abs=0.1)


def test_constant_acceleration_to_machine_precision(figure) -> None:
    ideal = ptp_symbolic.load("ideal")
    found = run(ideal, 10.0, {"tau_tilt": constant(0.3)}, 1e-3, parameters={"b_tilt": 0.0})
    acceleration = 0.3 / ideal.defaults["J_y_tilt"]
    exact = 0.5 * acceleration * found.t[1:] ** 2
    assert figure("relative error", np.abs(found["theta_tilt"][1:] / exact - 1).max()) <= 1e-12


def test_nothing_creeps_for_100_s_under_a_load_below_breakaway(body, drive, figure) -> None:
    held = run(body, [0.0, 100.0], {"tau_pan": constant(0.99 * F_S)}, 1e-3)
    assert figure("creep in 100 s, rad and rad/s", np.abs(held.x).max()) == 0.0
    assert held.events == ()
    found = run(drive, [0.0, 1.0, 100.0], {"u_pan": step(0.0, 0.1, 0.0)}, 1e-3)
    assert np.all(found["theta_gear_pan"] == 0.0)
    assert np.all(found["omega_gear_pan"] == 0.0)


def test_a_block_on_a_slope_stops_where_its_energy_is_spent(body, figure) -> None:
    way, errors = J * 2.0**2 / (2.0 * F_C), []
    for size in (4e-3, 1e-3):
        found = run(body, 5.0, None, size, parameters={"k": 0.0}, initial={"omega_pan": 2.0})
        errors.append(abs(found["theta_pan"][-1] - way))
        assert found["omega_pan"][-1] == 0.0
        assert [e.mode for e in found.events] == ["sticks"]
        assert found.events[0].time == pytest.approx(J * 2.0 / F_C, abs=1.01 * size)
    assert figure("error of the way, rad", errors[1]) < F_C / J * 1e-3**2


def test_free_flight_across_the_gap(drive) -> None:
    gap, speed, size = drive.defaults["gap_pan"], 0.02, 1e-4
    found = run(drive, 0.9, None, size, parameters={"b_pan": 0.0}, initial={"omega_pan": speed})
    touch = found.events[0]
    flying = found.t < touch.time - size
    assert touch.time == pytest.approx(0.5 * gap / speed, abs=1.01 * size)
    assert found["theta_pan"][flying] == pytest.approx(speed * found.t[flying], abs=1e-13)


SIGNALS = {
    "step": step(0.0, 24.0, 0.5),
    "ramp": ramp(0.0, 2.0, 0.0, 4.0),
    "multisine": multisine([5.0, 4.0, 3.0], [0.5, 1.7, 4.1]),
}


@pytest.mark.parametrize("name", SIGNALS)
def test_agreement_with_located_events_grows_with_shorter_steps(drive, name: str, figure) -> None:
    located = ptp_symbolic.simulate(drive, 4.0, {"u_pan": SIGNALS[name]})
    errors = []
    for size in (5e-4, 5e-5):
        found = run(drive, 4.0, {"u_pan": SIGNALS[name]}, size)
        errors.append(np.abs(found["theta_pan"] - located["theta_pan"]).max())
    count = 2.0 * math.pi / 7200
    assert figure("off located events at 50 us, counts", errors[1] / count) < 0.01
    assert errors[1] < errors[0] / 5.0


def drive_of(model) -> PanDrive:
    """The independent drive with the defaults of the emitted one."""
    v = model.defaults
    both = {
        f"{name}_{way}": v[f"{name}_pan"] * (1.0 + sign * v[f"a_{name}_pan"])
        for name in ("F_c", "F_s", "v_s", "F_v")
        for way, sign in (("forward", 1.0), ("backward", -1.0))
    }
    own = {
        "L": "L_pan",
        "R": "R_pan",
        "K_t": "K_t_pan",
        "J_motor": "J_motor_pan",
        "N": "N_pan",
        "k_shaft": "k_shaft_pan",
        "d_shaft": "d_shaft_pan",
        "gap": "gap_pan",
        "J_load": "J_pan",
        "b_load": "b_pan",
    }
    return PanDrive(**{name: v[place] for name, place in own.items()}, **both)


@pytest.mark.parametrize("method", ["fixed_step", "rosenbrock", "runge_kutta"])
def test_agreement_with_an_independent_simulation(drive, method: str, figure) -> None:
    time = np.arange(400) * 5e-3
    voltage = 6.0 * np.sin(2 * math.pi * 0.9 * time) + 4.0 * np.sin(2 * math.pi * 2.3 * time)
    truth, _ = simulate_independently(drive_of(drive), voltage, np.zeros(6))
    found = ptp_symbolic.simulate(
        drive, time, {"u_pan": table(time, voltage, "hold")}, method=method, step=2e-5
    )
    tolerance = 2e-6 if method == "fixed_step" else 1e-8
    off = np.abs(found["theta_pan"] - truth[:, 0]).max()
    assert figure("off the independent simulator, rad", off) < tolerance


def test_the_ledger_closes_with_the_step(drive) -> None:
    gaps = []
    for size in (1e-4, 2e-5):
        found = run(drive, 2.0, {"u_pan": multisine([12.0], [0.8])}, size)
        gap = found.stored - found.stored[0] - found.supplied + found.dissipated
        gaps.append(np.abs(gap).max() / found.dissipated[-1])
        assert np.diff(found.dissipated).min() >= 0.0
    assert gaps[1] < 2e-5
    assert gaps[1] < gaps[0] / 3.0


def test_a_step_that_does_not_fit_is_refused(drive) -> None:
    for size in (0.0, -1e-3, math.nan, math.inf, 1e-12):
        with pytest.raises(InputError, match=r"Step .* s for 2 s; give a positive number"):
            run(drive, 2.0, None, size)
