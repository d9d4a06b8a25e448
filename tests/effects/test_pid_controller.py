"""Sampled PID controller: a hand-written loop, exact between the samples, as the LM629 counts."""

import math
from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.linalg import expm

from ptp_symbolic import sensitivity, simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import InputSignal, ramp, step
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.symbolic.effects import EFFECTS

J, L, R, KT, JM, N = 0.05, 6.9e-3, 12.9, 0.0724, 1.1e-5, 500.0
COUNT = 2 * math.pi / 7200
FINE = {"n_u_pan": 1e12, "J_pan": J}
GAINS = {"K_p_pan": 300.0, "K_i_pan": 900.0, "K_d_pan": 4.0}


def servo(*more: str) -> Model:
    names = ("rigid_bodies", "dc_motor", "pid_controller", *more)
    of_axes = {effect.id for effect in EFFECTS if effect.on_axis}
    effects = (EffectDeclaration(n, "pan" if n in of_axes else None, None) for n in names)
    return emission.emit(Platform("servo", "Servo", ("pan",), 9.81, tuple(effects), (), ()))


@dataclass
class Controller:
    """The filter of the LM629 data sheet in volts and radians."""

    kp: float
    ki: float
    kd: float
    period: float
    every: int = 1
    limit: float = 24.0
    full: float = 24.0
    steps: float = 1e12
    count: float = 0.0
    integral: float = 0.0
    derivative: float = 0.0
    last: float = 0.0
    commands: list[float] = field(default_factory=list)

    def sample(self, k: int, wanted: float, angle: float) -> float:
        if self.count:
            angle = self.count * math.floor(angle / self.count + 0.5)
        error = wanted - angle
        if k % self.every == 0:
            self.derivative = (error - self.last) / (self.every * self.period)
            self.last = error
        self.integral += self.period * error
        part = max(-self.limit, min(self.limit, self.ki * self.integral))
        one = self.full / self.steps
        asked = one * math.floor((self.kp * error + part + self.kd * self.derivative) / one + 0.5)
        self.commands.append(max(-self.full, min(self.full, asked)))
        return self.commands[-1]


def exact(controller: Controller, wanted: InputSignal | float, samples: int) -> np.ndarray:
    """Angle, rate and current [samples + 1, 3] at the samples, from the matrix exponential."""
    inertia = J + JM * N**2
    a = np.array([[0, 1, 0, 0], [0, 0, KT * N / inertia, 0], [0, -KT * N / L, -R / L, 1 / L]])
    over = expm(np.vstack([a, np.zeros(4)]) * controller.period)
    x, found = np.zeros(3), [np.zeros(3)]
    for k in range(samples):
        t = k * controller.period
        goal = wanted if isinstance(wanted, float) else value_at(wanted, t)
        u = controller.sample(k, goal, x[0])
        x = (over @ np.append(x, u))[:3]
        found.append(x)
    return np.array(found)


def value_at(signal: InputSignal, t: float) -> float:
    k = int(np.clip(np.searchsorted(signal.breaks, t, "right") - 1, 0, len(signal.breaks) - 2))
    s = min(max(t, signal.breaks[0]), signal.breaks[-1]) - signal.breaks[k]
    return float(np.polyval(signal.coefficients[k][::-1], s))


@pytest.fixture(scope="module")
def model() -> Model:
    return servo()


@pytest.fixture(scope="module")
def counted() -> Model:
    return servo("encoder_quantization")


def test_defaults_are_those_of_the_lm629(model: Model) -> None:
    assert model.input_names == ("setpoint_pan",)
    assert model.defaults["t_sample_pan"] == pytest.approx(341.3e-6, rel=1e-3)
    assert model.defaults["n_u_pan"] == 128.0


@pytest.mark.parametrize("method", ["rosenbrock", "runge_kutta"])
@pytest.mark.parametrize("every", [1, 4])
def test_every_sample_is_that_of_a_loop_written_by_hand(
    model: Model, method: str, every: int
) -> None:
    """A step that meets a sample, then a ramp; limits of command and integral are reached."""
    t_s, samples = 1e-3, 400
    for signal in (step(0.0, 0.3, 0.05), ramp(0.0, 0.25, 0.1, 0.3)):
        controller = Controller(300.0, 900.0, 4.0, t_s, every, limit=6.0)
        truth = exact(controller, signal, samples)
        values = {**GAINS, **FINE, "t_sample_pan": t_s, "n_d_pan": every, "u_i_max_pan": 6.0}
        times = np.arange(samples + 1) * t_s
        found = simulate(
            model, times, {"setpoint_pan": signal}, values, rtol=1e-12, atol=1e-12, method=method
        )
        assert found.x[:, :2] == pytest.approx(truth[:, :2], abs=1e-9)
        assert found["command_pan"][:-1] == pytest.approx(controller.commands, abs=1e-6)


def test_counts_and_coarse_steps_are_kept_exactly(counted: Model) -> None:
    """7200 counts a turn, 128 steps of the command: the same whole numbers at every sample."""
    controller = Controller(300.0, 900.0, 4.0, 1e-3, steps=128.0, count=COUNT)
    truth = exact(controller, 0.3, 300)
    found = simulate(
        counted,
        np.arange(301) * 1e-3,
        {"setpoint_pan": step(0.3, 0.3, 1.0)},
        {**GAINS, "J_pan": J, "t_sample_pan": 1e-3, "q_count_pan": COUNT},
        rtol=1e-12,
        atol=1e-12,
    )
    assert found["theta_pan"] == pytest.approx(truth[:, 0], abs=1e-9)
    assert found["command_pan"][:-1] == pytest.approx(controller.commands, abs=1e-12)


def test_fixed_steps_agree_in_second_order(model: Model) -> None:
    truth = exact(Controller(300.0, 900.0, 4.0, 1e-3), 0.02, 200)
    values, errors = {**GAINS, **FINE, "t_sample_pan": 1e-3}, []
    for h in (1e-4, 5e-5):
        found = simulate(
            model,
            np.arange(201) * 1e-3,
            {"setpoint_pan": step(0.02, 0.02, 1.0)},
            values,
            method="fixed_step",
            step=h,
        )
        errors.append(np.max(np.abs(found["theta_pan"] - truth[:, 0])))
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)


def test_commands_change_at_the_samples_and_nowhere_else(model: Model) -> None:
    t_s = 2048 / 6e6
    instants = np.arange(1, 200) * t_s
    times = np.sort(np.concatenate([[0.0], instants - 1e-9, instants, instants + 0.5 * t_s]))
    found = simulate(model, times, {"setpoint_pan": step(1e-3, 1e-3, 1.0)}, GAINS | FINE)
    before, at, after = found["command_pan"][1:].reshape(-1, 3).T
    assert np.all(at == after)
    assert np.all(before[1:] == at[:-1])
    assert np.count_nonzero(at != before) > 150


def test_integral_action_leaves_no_error_against_a_torque() -> None:
    loaded = servo("constant_torque")
    values = {**FINE, "K_p_pan": 300.0, "K_i_pan": 2000.0, "tau0_pan": 5.0, "t_sample_pan": 1e-3}
    for gain, left in ((2000.0, 0.0), (0.0, 5.0 * R / (KT * N * 300.0))):
        found = simulate(
            loaded, [0.0, 6.0], {"setpoint_pan": step(0.1, 0.1, 1.0)}, {**values, "K_i_pan": gain}
        )
        assert found["theta_pan"][-1] - 0.1 == pytest.approx(left, abs=1e-8)
        assert found["omega_pan"][-1] == pytest.approx(0.0, abs=1e-8)


def test_the_integral_part_stops_at_its_limit() -> None:
    """Too small a limit leaves the error that proportional action alone must bear."""
    loaded = servo("constant_torque")
    held, limit = 5.0 * R / (KT * N), 0.4
    values = {**FINE, "K_p_pan": 300.0, "K_i_pan": 2000.0, "tau0_pan": 5.0, "u_i_max_pan": limit}
    found = simulate(loaded, [0.0, 3.0], {"setpoint_pan": step(0.1, 0.1, 1.0)}, values)
    assert found["theta_pan"][-1] - 0.1 == pytest.approx((held - limit) / 300.0, abs=1e-8)


def test_it_hovers_on_the_edge_of_a_count(counted: Model) -> None:
    """Whole counts only: integral action drives to where the reading flips, and stays there."""
    values = {**GAINS, "J_pan": J, "t_sample_pan": 1e-3, "q_count_pan": COUNT}
    found = simulate(counted, 6.0, {"setpoint_pan": step(0.1, 0.1, 1.0)}, values)
    late = found["theta_pan"][3000:] / COUNT
    edge = math.floor(0.1 / COUNT) + 0.5
    assert np.max(np.abs(late - edge)) < 0.05
    assert np.ptp(found["command_pan"][3000:]) > 0.0


def test_friction_makes_it_hunt_by_a_count_or_two() -> None:
    """Stiction and integral action: a slow limit cycle, stick and slip, that stays small."""
    stuck = servo("encoder_quantization", "csvs_friction")
    values = {"K_p_pan": 300.0, "K_i_pan": 3000.0, "F_c_pan": 5.5, "F_s_pan": 7.5, "v_s_pan": 0.04}
    values |= {"F_v_pan": 5.5, "J_pan": J, "t_sample_pan": 1e-3, "q_count_pan": COUNT}
    found = simulate(stuck, 20.0, {"setpoint_pan": step(0.1, 0.1, 1.0)}, values)
    swing = (found["theta_pan"][5000:] - 0.1) / COUNT
    assert np.ptp(swing) > 0.3
    assert np.max(np.abs(swing)) < 2.0
    assert sum(e.mode == "sticks" for e in found.events if e.time > 5.0) > 2


def test_tangents_jump_with_the_update(model: Model) -> None:
    """Gains, sampling time (which moves the instants) and motor, against central differences."""
    values = {**GAINS, "t_sample_pan": 1.03e-3, "n_d_pan": 3.0, **FINE}
    driven, times = {"setpoint_pan": ramp(0.0, 0.02, 0.0101, 0.0603)}, [0.0, 0.0407, 0.0999]
    names = ["K_p_pan", "K_i_pan", "K_d_pan", "t_sample_pan", "R_pan", "J_pan"]
    kept = {"rtol": 1e-11, "atol": 1e-11}
    found = sensitivity(model, times, driven, values, by_parameters=names, **kept)
    for k, name in enumerate(names):
        base = values.get(name, model.defaults[name])
        h = base * (1e-5 if name == "t_sample_pan" else 1e-4)
        ends = [
            simulate(model, times, driven, {**values, name: base + s * h}, **kept).x
            for s in (1, -1)
        ]
        slope = (ends[0] - ends[1]) / (2 * h)
        size = np.max(np.abs(slope[:, :3]), axis=0) + 1e-12
        assert np.max(np.abs(found.states[:, :3, k] - slope[:, :3]) / size) < 2e-4, name


def test_tangents_know_of_a_late_set_point_and_look_through_the_counts(counted: Model) -> None:
    """By the delay along a ramp; rounding to a count has the slope 1 of what is rounded."""
    late, values = servo("input_delay"), {**GAINS, **FINE, "t_sample_pan": 1e-3}
    driven, times = {"setpoint_pan": ramp(0.0, 0.02, 0.01, 0.3)}, [0.0, 0.0777, 0.1555]
    kept = {"rtol": 1e-11, "atol": 1e-11}
    found = sensitivity(
        late,
        times,
        driven,
        {**values, "t_delay_pan": 0.0123},
        by_parameters=["t_delay_pan"],
        **kept,
    )
    ends = [
        simulate(late, times, driven, {**values, "t_delay_pan": 0.0123 + h}, **kept).x
        for h in (1e-5, -1e-5)
    ]
    slope = ((ends[0] - ends[1]) / 2e-5)[1:, :3]
    assert found.states[1:, :3, 0] == pytest.approx(slope, rel=1e-4)
    by = {"by_parameters": ["K_p_pan"], **kept}
    plain = sensitivity(servo(), times, driven, values, **by)
    seen = sensitivity(counted, times, driven, {**values, "q_count_pan": 1e-9}, **by)
    assert seen.states[:, :3] == pytest.approx(plain.states[:, :3], rel=1e-3, abs=1e-12)


@pytest.mark.parametrize(("period", "duration"), [(0.5, 0.2), (1e-6, 20.0)])
def test_a_sampling_time_that_does_not_fit_is_refused(
    model: Model, period: float, duration: float
) -> None:
    for method in ("rosenbrock", "fixed_step"):
        with pytest.raises(InputError, match=r"Sampling time .* s \(t_sample_pan, n_d_pan\)"):
            simulate(model, [0.0, duration], {}, {"t_sample_pan": period}, method=method)
    with pytest.raises(InputError, match=r"'t_sample_pan' = 0 s lies outside its bounds"):
        simulate(model, [0.0, 1.0], {}, {"t_sample_pan": 0.0})


def test_without_a_motor_it_has_nothing_to_command() -> None:
    effects = (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("pid_controller", "pan", None),
    )
    with pytest.raises(InputError, match="acts on 'command_pan', which no declared effect defines"):
        emission.emit(Platform("servo", "", ("pan",), 9.81, effects, (), ()))
