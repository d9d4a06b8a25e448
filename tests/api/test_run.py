"""Inputs as a program gives them, runs as objects, a controller in the loop."""

import math
import pickle
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm, solve_continuous_are

import ptp_symbolic as ptp
from ptp_symbolic.numeric.simulation.inputs import ramp

J, B = 0.6, 0.4
TILT = {"J_x_tilt": 0.01, "J_y_tilt": 0.2, "J_z_tilt": 1e-12, "b_tilt": B}
ONE_AXIS = {"J_pan": J, "b_pan": B, **TILT}


@pytest.fixture(scope="module")
def ideal() -> ptp.Machine:
    return ptp.load("ideal")


def turned(torque: object, times: np.ndarray) -> np.ndarray:
    """J w' = tau(t) - b w, by SciPy."""

    def slopes(t: float, y: np.ndarray) -> list[float]:
        return [y[1], (torque(t) - B * y[1]) / J]  # type: ignore[operator]

    found = solve_ivp(
        slopes, (0.0, times[-1]), [0.0, 0.0], t_eval=times, rtol=1e-11, atol=1e-13, max_step=1e-3
    )
    return found.y[0]


def staircase(t: float) -> float:
    return 0.3 * math.floor(t / 0.2 + 1e-12) - 0.4


TIMES = np.linspace(0.0, 1.0, 51)
STEPS = np.arange(0.0, 1.0, 0.2)
STAIRS = np.array([staircase(t) for t in STEPS])


@pytest.mark.parametrize(
    ("given", "torque"),
    [
        (0.7, lambda t: 0.7),
        ("700 mN m", lambda t: 0.7),
        ("step:0.7@0.5", lambda t: 0.7 * (t >= 0.5)),
        (lambda t: math.sin(7.0 * t) + t**2, lambda t: math.sin(7.0 * t) + t**2),
        (lambda t: 0.7 if t > 0.317 else -0.2, lambda t: 0.7 if t > 0.317 else -0.2),
        ((STEPS, STAIRS), staircase),
        (np.array([staircase(t) for t in TIMES]), staircase),
        (ramp(0.0, 1.0, 0.0, 1.0), lambda t: t),
    ],
)
def test_an_input_of_any_kind_moves_the_machine_as_scipy_says(
    given: object, torque: object, ideal: ptp.Machine
) -> None:
    run = ideal.simulate(TIMES, tau_pan=given, **ONE_AXIS)
    assert run["theta_pan"] == pytest.approx(turned(torque, TIMES), abs=2e-8)
    assert run["tau_pan"][12] == pytest.approx(torque(TIMES[12]), abs=1e-9)  # type: ignore[operator]


def test_tables_drive_a_machine_by_their_columns(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    machine = ptp.load("ideal")
    frame = pandas.DataFrame({"tau_pan": STAIRS}, index=STEPS)
    wanted = machine.simulate(TIMES, tau_pan=(STEPS, STAIRS))["theta_pan"]
    assert np.array_equal(machine.simulate(TIMES, inputs=frame)["theta_pan"], wanted)
    assert np.array_equal(machine.simulate(TIMES, tau_pan=frame)["theta_pan"], wanted)


def test_a_log_drives_a_machine_as_long_as_it_lasts(tmp_path: Path) -> None:
    folder = ptp.sample("tilted_base")
    path = sorted((folder / "train").glob("*.csv"))[0]
    log = ptp.read_log(path, folder / "platform.toml")
    machine = ptp.load(folder / "platform.toml")
    run = machine.simulate(inputs=log)
    assert run.t[-1] == pytest.approx(log.time[-1] - log.time[0])
    assert np.array_equal(machine.simulate(inputs=str(path)).x, run.x)
    name = machine.input_names[0]
    at = len(log.time) // 2
    since = log.time[at] - log.time[0]
    assert run.inputs_at(np.array([since + 1e-9]))[0, 0] == log[name][at]


def test_values_with_units_are_those_in_si(ideal: ptp.Machine) -> None:
    plain = ideal.simulate(0.1, x0=[0.0, math.radians(30.0), 0.0, 0.0], J_pan=3e-4)
    units = ideal.simulate(0.1, x0={"theta_tilt": "30 deg"}, J_pan="3 kg cm^2")
    assert plain.x == pytest.approx(units.x, rel=1e-12, abs=1e-15)
    assert units.parameters["J_pan"] == pytest.approx(3e-4, rel=1e-15)


def test_a_pair_of_times_is_a_span_and_a_list_is_times(ideal: ptp.Machine) -> None:
    assert ideal.simulate((0.5, 1.0)).t == pytest.approx(np.linspace(0.5, 1.0, 501))
    assert ideal.simulate([0.5, 1.0]).t.tolist() == [0.5, 1.0]


def test_a_run_hands_out_what_it_holds(ideal: ptp.Machine) -> None:
    run = ptp.simulate("payload", 0.5, tau_pan=0.3)
    assert set(run.outputs) == {"theta_pan", "theta_tilt"}
    assert np.array_equal(run.outputs["theta_tilt"], run["theta_tilt"])
    assert run.inputs["tau_pan"].tolist() == [0.3] * 501
    energy = run.energy
    change = energy["stored"] - energy["stored"][0]
    assert change == pytest.approx(energy["supplied"] - energy["dissipated"], abs=1e-7)
    with pytest.raises(KeyError, match="Unknown signal 'theta_pen': did you mean 'theta_pan'"):
        run["theta_pen"]
    assert "501 samples" in repr(run)
    assert "<td>theta_pan</td>" in run._repr_html_()
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.x, run.x)
    assert np.array_equal(again["tau_pan"], run["tau_pan"])


def test_tables_of_a_run_hold_names_and_units() -> None:
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    run = ptp.simulate("ideal", 0.1, tau_pan=0.3)
    frame, data = run.to_pandas(), run.to_xarray()
    assert isinstance(frame, pandas.DataFrame) and isinstance(data, xarray.Dataset)
    assert frame.loc[0.1, "theta_pan"] == run["theta_pan"][-1]
    assert frame.attrs["units"]["omega_pan"] == "rad/s"
    assert float(data["theta_pan"].sel(time=0.1)) == run["theta_pan"][-1]
    assert data["tau_pan"].attrs["units"] == "N m"


def test_a_plot_has_a_panel_per_unit() -> None:
    figure = ptp.simulate("pan_drive", 0.2, u_pan=24.0).plot("theta_pan", "theta_gear_pan", "i_pan")
    assert [axes.get_ylabel() for axes in figure.axes] == ["rad", "A"]
    assert [len(axes.get_legend().get_texts()) for axes in figure.axes] == [2, 1]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            {"tau_pen": 1.0},
            "parameter or argument 'tau_pen': did you mean 'tau_pan'",
        ),
        ({"metod": "runge_kutta"}, "argument 'metod': did you mean 'method'"),
        ({"tau_pan": "3 kg"}, "Input 'tau_pan' = '3 kg': kg does not fit its unit N m"),
        ({"tau_pan": "stop:3"}, "Profile 'stop:3' is not understood; use one of constant"),
        ({"tau_pan": [1.0, 2.0]}, r"has shape \(2,\), and there are 101 output times"),
        ({"tau_pan": lambda t: float("inf")}, "Input 'tau_pan': The input function returns inf at"),
        ({"tau_pan": object()}, "Input 'tau_pan' is of type object"),
        ({"J_pan": "nan"}, "Parameter 'J_pan' = 'nan'"),
        ({"x0": {"theta_pan": 1}, "initial": {"theta_pan": 1}}, "`x0` and `initial` are both"),
        ({"period": 1e-3}, "`period` and `feedback` are of a `controller`"),
        ({"controller": lambda t, y: y}, "give its `period` in s"),
        ({"controller": lambda t, y: 1.0, "period": 1e-2}, r"must return finite numbers \[2\]"),
        ({"controller": lambda t, y: None, "period": 1e-2}, "The controller returned None at 0 s"),
        ({"controller": lambda t, y: {"u": 1}, "period": 1e-2}, "Unknown input 'u'"),
        ({"controller": lambda t, y: y, "period": 9.0}, "`period` = 9 s in a run of 0.1 s"),
        (
            {"controller": lambda t, y: y, "period": 1e-2, "feedback": ["omega"]},
            "Unknown measured signal 'omega'",
        ),
    ],
)
def test_what_does_not_fit_is_refused_in_one_line(
    given: dict[str, object], message: str, ideal: ptp.Machine
) -> None:
    with pytest.raises(ptp.InputError, match=message) as found:
        ideal.simulate(0.1, **given)
    assert "\n" not in str(found.value)
    assert "--" not in str(found.value)


def test_an_lqr_regulates_as_the_sampled_linear_system_does(ideal: ptp.Machine) -> None:
    """The gain is SciPy's; the closed loop of the pan axis alone is linear: its exact sampled
    response is the power of exp(A h) - integral(exp(A s)) B K.
    """
    linear = ideal.linearize(p=ONE_AXIS)
    cost, effort, period = np.diag([10.0, 10.0, 1.0, 1.0]), 0.1 * np.eye(2), 1e-2
    riccati = solve_continuous_are(linear.A, linear.B, cost, effort)
    gain = np.linalg.solve(effort, linear.B.T @ riccati)
    run = ideal.simulate(
        2.0,
        x0={"theta_pan": "20 deg"},
        controller=lambda t, x: -gain @ x,
        period=period,
        feedback="states",
        **ONE_AXIS,
    )
    whole = expm(np.block([[linear.A, linear.B], [np.zeros((2, 6))]]) * period)
    closed = whole[:4, :4] - whole[:4, 4:] @ gain
    state = np.array([math.radians(20.0), 0.0, 0.0, 0.0])
    for k in range(201):
        assert run.x[10 * k] == pytest.approx(state, abs=1e-8)
        state = closed @ state
    assert abs(run["theta_pan"][-1]) < 1e-3
    assert run["tau_pan"][10 * 7 + 9] == pytest.approx(float(-gain[0] @ run.x[70]), abs=1e-9)


def test_the_gain_of_python_control_is_that_of_scipy(ideal: ptp.Machine) -> None:
    control = pytest.importorskip("control")
    system = ideal.linearize(p=ONE_AXIS).to_control()
    gain, cost, _ = control.lqr(system, np.eye(4), np.eye(2))
    wanted = solve_continuous_are(system.A, system.B, np.eye(4), np.eye(2))
    assert np.asarray(cost) == pytest.approx(wanted, rel=1e-6, abs=1e-9)
    law = {"controller": lambda t, x: -gain @ x, "period": 1e-3, "feedback": "states"}
    run = ideal.simulate(0.5, x0={"theta_pan": 0.3}, **law)
    assert abs(run["theta_pan"][-1]) < 0.3


def test_a_controller_that_always_says_the_same_is_a_constant_input() -> None:
    """Through friction, backlash and windings, with every event and the whole ledger."""
    machine = ptp.load("pan_drive")
    open_loop = machine.simulate(0.4, u_pan="step:24@0.1")
    closed = machine.simulate(0.4, controller=lambda t, y: 24.0 if t > 0.0999 else 0.0, period=1e-3)
    assert closed.x == pytest.approx(open_loop.x, abs=2e-6)
    assert closed.dissipated == pytest.approx(open_loop.dissipated, abs=1e-6)
    assert closed.supplied == pytest.approx(open_loop.supplied, abs=1e-6)
    assert [(e.element, e.mode) for e in closed.events] == [
        (e.element, e.mode) for e in open_loop.events
    ]
    assert [e.time for e in closed.events] == pytest.approx(
        [e.time for e in open_loop.events], abs=1e-6
    )


def test_a_delay_of_the_machine_holds_back_what_a_controller_says() -> None:
    """A delay of two and a half periods."""
    from ptp_symbolic.platform import EffectDeclaration, Platform

    effects = (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("viscous_friction", "pan", None),
        EffectDeclaration("input_delay", "pan", None),
    )
    machine = ptp.load(
        Platform("late", "Late", ("pan",), 9.81, effects, (), ()), catalogue_values=True
    )
    (delay,) = [n for n in machine.parameter_names if "delay" in n or n.startswith("t_")]
    values = {"J_pan": J, "b_pan": B, delay: 0.025}
    period = 0.01
    run = machine.simulate(
        TIMES, controller=lambda t, y: math.sin(9.0 * t), period=period, **values
    )

    def torque(t: float) -> float:
        sample = math.floor((t - 0.025) / period + 1e-9)
        return math.sin(9.0 * sample * period) if sample >= 0 else 0.0

    assert run["theta_pan"] == pytest.approx(turned(torque, TIMES), abs=2e-6)


def test_a_jitted_controller_is_called_the_same_way(ideal: ptp.Machine) -> None:
    numba = pytest.importorskip("numba")

    def law(t: float, y: np.ndarray) -> np.ndarray:
        return -0.5 * y

    plain, jitted = (
        ideal.simulate(0.2, x0={"theta_pan": 0.4}, controller=each, period=1e-2)
        for each in (law, numba.njit(law))
    )
    assert np.array_equal(plain.x, jitted.x)


def test_a_machine_that_samples_by_itself_takes_no_second_controller() -> None:
    with pytest.raises(ptp.InputError, match="has a sampled controller of its own"):
        ptp.simulate("thesis-pan-servo", 0.1, controller=lambda t, y: 0.0, period=1e-3)


def test_a_state_is_the_motion_and_an_output_what_its_sensor_shows() -> None:
    """A sensor of first order lags behind a sine by atan(w T) and shows 1 / sqrt(1 + w^2 T^2)."""
    from ptp_symbolic.platform import EffectDeclaration, Platform

    effects = tuple(
        EffectDeclaration(name, None if name == "rigid_bodies" else "pan", None)
        for name in ("rigid_bodies", "viscous_friction", "measurement_lag")
    )
    machine = ptp.load(
        Platform("lagging", "Lagging sensor", ("pan",), 9.81, effects, (), ()),
        catalogue_values=True,
    )
    (lag,) = [p.name for p in machine.parameters if p.unit == "s"]
    rate, size, lasting = 8.0, 0.3, 3.0
    torque = lambda t: -J * rate**2 * size * math.sin(rate * t)  # noqa: E731
    run = machine.simulate(
        lasting,
        tau_pan=torque,
        x0={"omega_pan": rate * size},
        **{"J_pan": J, "b_pan": 0.0, lag: 0.05},
    )
    late = run.t > 1.0
    phase, gain = math.atan(rate * 0.05), 1.0 / math.hypot(1.0, rate * 0.05)
    t = run.t[late]
    assert run["theta_pan"][late] == pytest.approx(size * np.sin(rate * t), abs=1e-6)
    shown = gain * size * np.sin(rate * t - phase)
    assert run.outputs["theta_pan"][late] == pytest.approx(shown, abs=1e-6)


def test_a_shaft_that_begins_wound_up_is_pointed_out() -> None:
    """The gear output stays at zero unless it is given with its joint."""
    machine = ptp.load("pan_drive")
    with pytest.warns(UserWarning, match="Give theta_gear_pan too"):
        wound = machine.simulate(0.001, x0={"theta_pan": "10 deg"})
    whole = machine.simulate(0.001, x0={"theta_pan": 0.1, "theta_gear_pan": 0.1})
    assert abs(wound["omega_pan"][-1]) > 1.0 > 1e-9 > abs(whole["omega_pan"][-1])


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"tau_pan": "stp:12@0.1"}, "use one of constant:3"),
        ({"TAU_PAN": 1.0}, "did you mean 'tau_pan'?"),
    ],
)
def test_what_was_meant_is_said(given: dict[str, object], said: str, ideal: ptp.Machine) -> None:
    with pytest.raises(ptp.InputError, match=re.escape(said)):
        ideal.simulate(0.1, **given)  # type: ignore[arg-type]


def test_a_signal_that_the_machine_lacks_is_refused_when_it_is_loaded(tmp_path: Path) -> None:
    path = tmp_path / "turret.toml"
    path.write_text(
        'platform = { name = "turret", title = "Turret", axes = ["pan"] }\n'
        'effects = [{ effect = "rigid_bodies" }]\n'
        "[parameters]\nJ_pan = { value = 0.1 }\n"
        '[signals]\npan_angle = { role = "output", column = "angle", unit = "rad" }\n'
    )
    with pytest.raises(ptp.InputError, match="pan_angle"):
        ptp.load(path)
