"""Simulation against SciPy, another event simulator, closed forms and the energy ledger."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.simulation import run
from ptp_symbolic.numeric.simulation.inputs import multisine, ramp, step
from ptp_symbolic.numeric.simulation.methods.runge_kutta import ERROR, A, C


@pytest.fixture(scope="module")
def payload():
    return ptp_symbolic.load("payload")


@pytest.fixture(scope="module")
def drive():
    return ptp_symbolic.load("pan_drive")


def test_tableau_meets_the_order_conditions() -> None:
    b = A[6]
    for power in range(1, 6):
        assert b @ C ** (power - 1) == pytest.approx(1.0 / power, abs=1e-14)
    assert b @ (A @ C) == pytest.approx(1.0 / 6.0, abs=1e-14)
    assert b @ (A @ C**3) == pytest.approx(1.0 / 20.0, abs=1e-14)
    assert ERROR.sum() == pytest.approx(0.0, abs=1e-14)


def test_smooth_model_against_scipy(payload) -> None:
    times = np.linspace(0.0, 5.0, 51)
    inputs = {"tau_pan": multisine([0.3], [0.7]), "tau_tilt": multisine([1.0], [0.4])}
    found = ptp_symbolic.simulate(payload, times, inputs, rtol=1e-11, atol=1e-12)
    p = payload.parameter_vector()

    def torque(t: float) -> np.ndarray:
        return np.array([0.3 * np.sin(1.4 * np.pi * t), np.sin(0.8 * np.pi * t)])

    truth = solve_ivp(
        lambda t, x: payload.rhs(t, x, torque(t), p),
        (0.0, 5.0),
        np.zeros(4),
        method="DOP853",
        t_eval=times,
        rtol=1e-12,
        atol=1e-13,
    )
    assert np.abs(found.x - truth.y.T).max() < 1e-8


def test_energy_is_kept_without_friction(payload) -> None:
    found = ptp_symbolic.simulate(
        payload,
        60.0,
        parameters={"b_pan": 0.0, "b_tilt": 0.0},
        initial={"omega_pan": 1.0, "theta_tilt": 0.3},
        rtol=1e-12,
        atol=1e-13,
    )
    assert np.ptp(found.stored) <= 1e-9 * np.abs(found.stored).max()


def test_ledger_closes_with_everything_on(drive) -> None:
    found = ptp_symbolic.simulate(drive, 4.0, {"u_pan": multisine([12.0], [0.8])})
    gap = found.stored - found.stored[0] - found.supplied + found.dissipated
    assert np.abs(gap).max() <= 1e-6 * np.abs(found.dissipated).max()
    assert np.diff(found.dissipated).min() >= -1e-12


def test_a_motor_below_breakaway_does_not_creep(drive, figure) -> None:
    found = ptp_symbolic.simulate(drive, np.array([0.0, 1.0, 100.0]), {"u_pan": step(0, 0.1, 0.0)})
    assert figure("creep in 100 s, rad", abs(found["theta_gear_pan"][-1])) == 0.0
    assert found.events == ()


def test_events_of_a_slow_ramp_are_located(drive) -> None:
    found = ptp_symbolic.simulate(drive, 4.0, {"u_pan": ramp(0.0, 4.0, 0.0, 4.0)})
    first = found.events[0]
    values = drive.defaults
    breakaway = values["F_s_pan"] * (1.0 + values["a_F_s_pan"])
    amperes = breakaway / (values["N_pan"] * values["K_t_pan"])
    lag = values["L_pan"] / values["R_pan"]
    assert first.element == "friction pan"
    assert first.time == pytest.approx(amperes * values["R_pan"] + lag, abs=1e-5)


def test_sensitivities_against_central_differences(drive) -> None:
    times, inputs = [0.0, 1.0, 2.0], {"u_pan": step(0.0, 24.0, 0.5)}
    names = ("F_c_pan", "J_pan", "gap_pan")
    found = ptp_symbolic.sensitivity(drive, times, inputs, by_parameters=names)
    for index, name in enumerate(names):
        h = 1e-4 * drive.defaults[name]
        ends = [
            ptp_symbolic.simulate(
                drive, times, inputs, {name: drive.defaults[name] + s * h}, rtol=1e-10, atol=1e-12
            )["theta_pan"][-1]
            for s in (1.0, -1.0)
        ]
        difference = (ends[0] - ends[1]) / (2.0 * h)
        assert found.states[-1, 0, index] == pytest.approx(difference, rel=1e-5)


def test_bad_arguments_are_refused(drive) -> None:
    with pytest.raises(InputError, match="Unknown input 'tau_pan'"):
        ptp_symbolic.simulate(drive, 1.0, {"tau_pan": step(0, 1, 0)})
    with pytest.raises(InputError, match=r"'J_pan' = -1 kg m\^2 lies outside its bounds"):
        ptp_symbolic.simulate(drive, 1.0, parameters={"J_pan": -1.0})
    with pytest.raises(InputError, match="Duration -1 s"):
        ptp_symbolic.simulate(drive, -1.0)


@pytest.mark.parametrize("method", ["rosenbrock", "fixed_step"])
def test_no_event_is_dropped_where_the_room_is_small(
    drive, method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A motor to and fro: its friction lets go and holds, its gear crosses the gap, each time."""
    inputs = {"u_pan": multisine([12.0], [1.0])}
    usual = ptp_symbolic.simulate(drive, 3.0, inputs, method=method)
    assert len(usual.events) > 12
    monkeypatch.setattr(run, "EVENT_ROOM", 4)
    assert ptp_symbolic.simulate(drive, 3.0, inputs, method=method).events == usual.events


@pytest.mark.parametrize("name", ["rtol", "atol", "largest_step"])
@pytest.mark.parametrize("value", [-1.0, 0.0, np.nan])
def test_tolerances_that_mean_nothing_are_refused(drive, name: str, value: float) -> None:
    for simulated in (ptp_symbolic.simulate, ptp_symbolic.sensitivity):
        with pytest.raises(InputError, match=rf"{name} = .*; give a number above zero"):
            simulated(drive, 0.1, **{name: value})
