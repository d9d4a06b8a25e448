"""Torques of a prescribed motion, and the free motion of a joint beside a prescribed one."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson, solve_ivp

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission, variants
from ptp_symbolic.models.inverse_dynamics import Motion
from ptp_symbolic.numeric.runtime.model import load_model
from ptp_symbolic.numeric.simulation.inputs import constant, multisine
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from tests.independent import rigid_platform

PLATFORMS = "tests/platforms"


def driven(preset: str, *axes: str) -> Platform:
    """A packaged platform whose `axes` move as prescribed."""
    platform = read_platform(preset)
    added = (EffectDeclaration("prescribed_motion", axis, None) for axis in axes)
    return replace(platform, effects=(*platform.effects, *added))


def pulse(time: np.ndarray, rate: float, first: float, last: float) -> tuple[np.ndarray, ...]:
    """Angle, rate and acceleration of a rate that rises from zero by a cubic."""
    s, span = np.clip((time - first) / (last - first), 0.0, 1.0), last - first
    angle = rate * (span * (s**3 - s**4 / 2.0) + np.maximum(time - last, 0.0))
    return angle, rate * (3.0 * s**2 - 2.0 * s**3), rate * 6.0 * s * (1.0 - s) / span


def thesis_motion(pan: float, tilt: float) -> tuple[np.ndarray, Motion]:
    """Tables 5.2 and 5.4: tilt rate up between 0 and 0.5 s, pan rate between 2 and 2.5 s."""
    time = np.linspace(0.0, 8.0, 8001)
    columns = zip(pulse(time, pan, 2.0, 2.5), pulse(time, tilt, 0.0, 0.5), strict=True)
    return time, Motion(*(np.column_stack(pair) for pair in columns))


def test_random_motion_against_newton_euler_by_hand() -> None:
    rng, values = np.random.default_rng(3), ptp_symbolic.load("payload").defaults
    values = {**values, "c_y_payload": 0.03, "c_z_payload": -0.05}
    motion = [rng.normal(size=(200, 2)) * scale for scale in (2.0, 3.0, 20.0)]
    changed = {name: values[name] for name in ("c_y_payload", "c_z_payload")}
    found = ptp_symbolic.inverse_dynamics("payload", tuple(motion), changed)
    truth = [rigid_platform.inverse_dynamics(*row, values) for row in zip(*motion, strict=True)]
    assert found == pytest.approx(np.array(truth), rel=1e-12, abs=1e-12)


def test_forward_and_inverse_dynamics_are_inverse() -> None:
    model, rng = ptp_symbolic.load("ideal"), np.random.default_rng(5)
    q, w, a = rng.normal(size=(3, 1, 2))
    torque = ptp_symbolic.inverse_dynamics(model, (q, w, a))
    x = np.concatenate([q[0], w[0]])
    assert model.rhs(0.0, x, torque[0], model.parameter_vector())[2:] == pytest.approx(a[0])


@pytest.mark.parametrize(("offset", "pan", "tilt"), [(0.1, 0.0256, 4.95), (0.01, 0.0009, 0.54)])
def test_erratum_18_amplitudes_of_table_5_4(offset: float, pan: float, tilt: float) -> None:
    """Pan torque that the tilting costs while the pan axis turns steadily, and peak of tilt."""
    time, motion = thesis_motion(1.0, 0.5)
    found = ptp_symbolic.inverse_dynamics("payload", motion, {"c_x_payload": offset})
    coupling = (found[:, 0] - 0.1 * np.asarray(motion.rates)[:, 0])[time > 2.5]
    assert np.abs(coupling).max() == pytest.approx(pan, rel=0.04)
    assert np.abs(found[:, 1]).max() == pytest.approx(tilt, rel=0.005)


def test_drives_are_left_out_and_friction_opposes_the_motion() -> None:
    platform = read_platform("thesis-pan-drive")
    assert [e.effect for e in variants.torque_driven(platform).effects] == [
        "rigid_bodies",
        "viscous_friction",
        "csvs_friction",
        "direction_dependent_friction",
    ]
    motion = ([[0.0]] * 4, [[0.5], [-0.5], [0.0], [0.0]], [[0.0], [0.0], [1.0], [0.0]])
    forward, backward, starting, resting = ptp_symbolic.inverse_dynamics(platform, motion)[:, 0]
    assert forward == pytest.approx(0.2267 + 13.5844 * 0.5 + 2.0 * 0.5)
    assert backward == pytest.approx(-(0.2535 + 14.3004 * 0.5 + 2.0 * 0.5))
    assert starting == pytest.approx(0.5578 + 0.05)
    assert resting == 0.0
    assert ptp_symbolic.inverse_dynamics("full", ([[0.0, 0.3]], [[0.0, 0.0]], [[0.0, 0.0]]))[
        0, 1
    ] == pytest.approx(-6.3785 * 9.81 * 0.0876228 * np.sin(0.3))


@pytest.mark.parametrize(
    ("motion", "message"),
    [
        (([[0.0]], [[0.0]], [[0.0]]), r"angles have shape \(1, 1\); give \[k, 2\], a column for"),
        (([[0.0, 0.0]], [[0.0, 0.0]]), "2 arrays; give angles, rates and accelerations"),
        (([[0.0, np.nan]], [[0.0, 0.0]], [[0.0, 0.0]]), "angles are not all finite"),
        (([[0.0, 0.0]],) * 3 + ([0.0, 1.0],), r"times have shape \(2,\); give \[1\]"),
    ],
)
def test_motions_that_do_not_fit_are_refused(motion: tuple, message: str) -> None:
    with pytest.raises(InputError, match=message):
        ptp_symbolic.inverse_dynamics("ideal", motion)


def test_a_free_tilt_axis_on_a_driven_pan_axis() -> None:
    """Against SciPy with Newton and Euler by hand; the ledger counts what the pan motion takes."""
    model = emission.emit(driven("thesis-payload", "pan"))
    assert model.input_names == ("alpha_pan", "tau_tilt")
    values = {**model.defaults, "c_y_payload": 0.04}
    times, start = np.linspace(0.0, 3.0, 1501), np.array([0.0, 0.4, 1.0, 0.0])
    found = ptp_symbolic.simulate(
        model,
        times,
        {"alpha_pan": multisine([6.0], [0.5])},
        {"c_y_payload": 0.04},
        dict(zip(model.state_names, start, strict=True)),
        rtol=1e-10,
        atol=1e-12,
    )

    def derivative(t: float, x: np.ndarray) -> list[float]:
        pan = 6.0 * np.sin(np.pi * t)
        bias = rigid_platform.inverse_dynamics(x[:2], x[2:], [pan, 0.0], values)[1]
        inertia = rigid_platform.mass_matrix(x[:2], values)[1, 1]
        return [x[2], x[3], pan, -bias / inertia]

    truth = solve_ivp(derivative, (0.0, 3.0), start, "DOP853", times[::250], rtol=1e-11, atol=1e-12)
    assert found.x[::250] == pytest.approx(truth.y.T, abs=1e-8)
    alpha = np.array(
        [
            model.rhs(
                t, x, np.array([6.0 * np.sin(np.pi * t), 0.0]), model.parameter_vector(values)
            )[2:]
            for t, x in zip(times, found.x, strict=True)
        ]
    )
    torque = ptp_symbolic.inverse_dynamics(
        "payload", (found.x[:, :2], found.x[:, 2:], alpha), {"c_y_payload": 0.04}
    )
    assert torque[:, 1] == pytest.approx(0.0, abs=1e-10)
    work = cumulative_simpson(torque[:, 0] * found["omega_pan"], x=times, initial=0.0)
    assert found.supplied == pytest.approx(work, abs=1e-7)
    balance = found.stored - found.stored[0] - found.supplied + found.dissipated
    assert np.abs(balance).max() < 1e-7


def test_a_locked_pan_axis_leaves_a_pendulum() -> None:
    """Period of small swings about the hanging position; the pan angle does not move at all."""
    model = emission.emit(driven("thesis-payload", "pan"))
    values = {**model.defaults, "b_tilt": 0.0}
    found = ptp_symbolic.simulate(
        model,
        5.0,
        None,
        {"b_tilt": 0.0},
        {"theta_tilt": np.pi / 2 + 1e-3, "theta_pan": 0.7},
        rtol=1e-10,
        atol=1e-13,
    )
    inertia = values["J_y_tilt"] + values["J_y_payload"] + values["m_payload"] * 0.01
    swing = np.sqrt(values["m_payload"] * 9.81 * 0.1 / inertia)
    assert found["theta_tilt"] - np.pi / 2 == pytest.approx(
        1e-3 * np.cos(swing * found.t), abs=1e-8
    )
    assert np.all(found["theta_pan"] == 0.7)


def test_a_steadily_turning_pan_axis_lifts_the_payload() -> None:
    """Conical pendulum: the sine of the tilt is gravity over what the turning does."""
    model = emission.emit(driven("thesis-payload", "pan"))
    values, turning = model.defaults, 15.0
    spread = values["J_z_payload"] + values["J_z_tilt"] + values["m_payload"] * 0.01
    spread -= values["J_x_payload"] + values["J_x_tilt"]
    angle = np.arcsin(values["m_payload"] * 9.81 * 0.1 / (spread * turning**2))
    found = ptp_symbolic.simulate(
        model, 1.0, None, None, {"theta_tilt": float(angle), "omega_pan": turning}
    )
    assert found["theta_tilt"] == pytest.approx(angle, abs=1e-9)
    assert found["theta_pan"][-1] == pytest.approx(turning, rel=1e-12)


def test_friction_of_the_free_joint_still_sticks() -> None:
    platform = driven(f"{PLATFORMS}/fieldlog_two_axis.toml", "pan")
    model = emission.emit(platform)
    assert model.mode_names == ("slide_tilt",)
    assert "F_c_pan" not in model.parameter_names
    held = {"F_c_tilt": 5.0, "F_s_tilt": 5.0}
    found = ptp_symbolic.simulate(model, 1.0, {"alpha_pan": constant(0.2)}, held)
    assert np.all(found["theta_tilt"] == 0.0)
    assert found["omega_pan"][-1] == pytest.approx(0.2, rel=1e-12)


def test_both_joints_prescribed() -> None:
    model = emission.emit(driven("thesis-payload", "pan", "tilt"))
    inputs = {"alpha_pan": constant(2.0), "alpha_tilt": constant(-1.0)}
    found = ptp_symbolic.simulate(model, 1.0, inputs)
    assert found.x[-1] == pytest.approx([1.0, -0.5, 2.0, -1.0], rel=1e-12)


def test_a_motor_on_a_prescribed_axis_is_refused() -> None:
    with pytest.raises(InputError, match="axis 'pan' is prescribed, and a motor or a shaft works"):
        emission.emit(driven("thesis-pan-drive", "pan"))


def test_a_platform_of_ones_own_with_the_name_of_a_committed_model_is_not_taken_for_it() -> None:
    """At rest the payload of the committed model takes a torque, a balanced body none."""
    own = replace(read_platform("thesis-ideal"), name="payload")
    assert np.all(ptp_symbolic.inverse_dynamics(emission.emit(own), (np.zeros((1, 2)),) * 3) == 0.0)
    assert np.any(ptp_symbolic.inverse_dynamics("payload", (np.zeros((1, 2)),) * 3) != 0.0)


def test_a_model_that_does_not_know_its_platform_is_refused() -> None:
    with pytest.raises(InputError, match="'ideal' does not know its platform; give that instead"):
        ptp_symbolic.inverse_dynamics(
            replace(load_model("ideal"), platform=None), (np.zeros((1, 2)),) * 3
        )


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_friction_that_grows_with_the_load_adds_to_the_torque_that_carries_it(way: float) -> None:
    """Tau = J a + (F_c + mu |tau|) sign(w), so tau = (J a + F_c) / (1 - mu) where both push on."""
    inertia, coulomb, mu = 0.2, 0.3, 0.25
    effects = ("rigid_bodies", "csvs_friction", "load_dependent_friction")
    axis = (None, "pan", "pan")
    declared = tuple(EffectDeclaration(e, a, None) for e, a in zip(effects, axis, strict=True))
    platform = Platform("carrying", "Friction under load", ("pan",), 9.81, declared, (), ())
    values = {"J_pan": inertia, "F_c_pan": coulomb, "F_s_pan": coulomb, "F_v_pan": 0.0}
    values["v_s_pan"] = 0.01  # without influence, F_s being F_c
    rates, accelerations = np.array([[way], [way]]), np.array([[5.0 * way], [-5.0 * way]])
    found = ptp_symbolic.inverse_dynamics(
        platform, (np.zeros((2, 1)), rates, accelerations), values | {"mu_load_pan": mu}
    )
    driving = (inertia * 5.0 + coulomb) / (1.0 - mu)
    braking = -(inertia * 5.0 - coulomb) / (1.0 + mu)
    assert found[:, 0] == pytest.approx([way * driving, way * braking], rel=1e-12)
