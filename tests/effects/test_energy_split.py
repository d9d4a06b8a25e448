"""What the ledger books where: supply and losses of every effect, integrated here from the states
of a run by laws that are written down here.

Power in is that of torques at joints, of voltages at the terminals of motors, of a prescribed
motion and of a base that shakes. Everything else that leaves the machine is lost; what a spring or
a field gives back was stored.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from ptp_symbolic import simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import multisine
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.symbolic.effects import EFFECTS

PLATFORMS = Path(__file__).parents[1] / "platforms"

DURATION, STEP = 1.5, 2e-5  # s
CLOSE = 2e-5  # of all that went through: the quadrature, over jumps of friction and contact
WAVES = {  # amplitudes, and frequencies in Hz
    "tau_pan": ([1.2, 0.5], [0.9, 3.1]),
    "tau_tilt": ([6.0, 1.0], [0.7, 2.3]),
    "u_pan": ([14.0, 6.0], [0.8, 3.7]),
    "u_tilt": ([14.0, 6.0], [0.8, 3.7]),
    "setpoint_pan": ([0.4, 0.1], [0.6, 2.1]),
    "alpha_pan": ([9.0, 4.0], [0.8, 2.2]),
    "temperature_pan": ([10.0], [0.3]),
    **{f"acceleration_{k}_base": ([2.0, 1.0], [0.6 + 0.2 * n, 2.7]) for n, k in enumerate("xyz")},
    **{f"omega_{k}_base": ([0.8], [0.5 + 0.3 * n]) for n, k in enumerate("xyz")},
    **{f"alpha_{k}_base": ([1.5], [0.4 + 0.3 * n]) for n, k in enumerate("xyz")},
}


@dataclass(frozen=True)
class Run:
    """A trajectory, and its parameters by name; states are attributes."""

    found: Trajectory
    p: Mapping[str, float]

    def __getattr__(self, name: str) -> np.ndarray:
        return self.found[name]

    def __getitem__(self, name: str) -> float:
        return self.p[name]

    def given(self, name: str, late: float = 0.0) -> np.ndarray:
        """An input as it was given, some time ago; as at the start before that."""
        then = np.maximum(self.found.t - late, 0.0)
        return sum(a * np.sin(2.0 * np.pi * f * then) for a, f in zip(*WAVES[name], strict=True))


Power = Callable[[Run], np.ndarray]


def nothing(run: Run) -> np.ndarray:
    return np.zeros(len(run.found.t))


# --- power in, in W ------------------------------------------------------------------------------
def torques(pan: Power, tilt: Power = lambda r: r.given("tau_tilt")) -> Power:
    def power(run: Run) -> np.ndarray:
        both = "omega_tilt" in run.found.state_names
        return pan(run) * run.omega_pan + (tilt(run) * run.omega_tilt if both else 0.0)

    return power


def voltage(applied: Power = lambda r: r.given("u_pan")) -> Power:
    return lambda run: applied(run) * run.i_pan


as_given = torques(lambda r: r.given("tau_pan"))
at_terminals = voltage()


def shaken(run: Run) -> np.ndarray:
    """A base that accelerates by a(t) carries the weight m a(t) along: its rate of change is power
    that comes in, at the payload's distance from the pan axis along the motion.
    """
    turn = 2.0 * np.pi * run["f_base"]
    jerk = run["a_base"] * turn * np.cos(turn * run.found.t + run["phi_base"])
    reach = run["c_x_payload"] * np.cos(run.theta_tilt) * np.cos(run.theta_pan - run["psi_base"])
    return as_given(run) + run["m_payload"] * jerk * reach


def reach(run: Run) -> np.ndarray:
    """Centre of mass [3, n] of the pan body from the axis, in the axes of the base, in m."""
    cos, sin = np.cos(run.theta_pan), np.sin(run.theta_pan)
    x, y = run["c_x_pan"], run["c_y_pan"]
    return np.array([x * cos - y * sin, x * sin + y * cos, run.p.get("c_z_pan", 0.0) + 0.0 * cos])


def along(run: Run) -> np.ndarray:
    """Speed [3, n] of that centre of mass relative to the base, in m/s."""
    x, y, _ = reach(run)
    return np.array([-y * run.omega_pan, x * run.omega_pan, 0.0 * x])


def pushed(run: Run) -> np.ndarray:
    """In the axes of a base that accelerates, what the force -m a does along the motion there."""
    force = -run["m_pan_body"] * np.array([run.given(f"acceleration_{k}_base") for k in "xyz"])
    return run.given("tau_pan") * run.omega_pan + np.sum(force * along(run), axis=0)


def turned(run: Run) -> np.ndarray:
    """In the axes of a base that turns: Euler and centrifugal force along the motion (that of
    Coriolis does no work), and the torque about the axis that the body's own inertia takes.
    """
    w, slope = (np.array([run.given(f"{a}_{k}_base") for k in "xyz"]) for a in ("omega", "alpha"))
    r, mass = reach(run), run["m_pan_body"]
    euler, spin = np.cross(slope, r, axis=0), np.cross(w, np.cross(w, r, axis=0), axis=0)
    cos, sin = np.cos(run.theta_pan), np.sin(run.theta_pan)
    first, second = w[0] * cos + w[1] * sin, w[1] * cos - w[0] * sin  # rates in the body's axes
    own = run["J_pan"] * slope[2] + (run["J_y_pan"] - run["J_x_pan"]) * first * second
    torque = run.given("tau_pan") - own
    return torque * run.omega_pan - mass * np.sum((euler + spin) * along(run), axis=0)


# --- losses, in W --------------------------------------------------------------------------------
def viscous(run: Run, axis: str) -> np.ndarray:
    return run[f"b_{axis}"] * run.found[f"omega_{axis}"] ** 2


def dry(
    run: Run, axis: str, rate: str = "", coulomb=0.0, factor=1.0, exponent=2.0, thinner=1.0
) -> np.ndarray:
    """Coulomb, static, viscous and Stribeck friction; `coulomb` is added to both dry levels."""
    w = run.found[rate or f"omega_{axis}"]
    fallen = np.exp(-((np.abs(w) / run[f"v_s_{axis}"]) ** exponent))
    f_c, f_s = (run[f"{name}_{axis}"] * factor + coulomb for name in ("F_c", "F_s"))
    return (f_c + (f_s - f_c) * fallen) * np.abs(w) + run[f"F_v_{axis}"] * thinner * w**2


def joints(extra: Power = nothing, **changed: Callable[[Run], object]) -> Power:
    """Losses of both joints of the machine that torques drive; friction of pan as `changed`."""

    def power(run: Run) -> np.ndarray:
        own = {name: change(run) for name, change in changed.items()}
        tilt = viscous(run, "tilt") + dry(run, "tilt")
        return viscous(run, "pan") + dry(run, "pan", **own) + tilt + extra(run)

    return power


def shaft(run: Run) -> np.ndarray:
    """Of a shaft with play: what its faces press with, less what the spring takes up."""
    error, slope = gear_error(run)
    apart = run.theta_gear_pan + error - run.theta_pan
    speed = run.omega_gear_pan * (1.0 + slope) - run.omega_pan
    face = np.where(np.abs(apart) > run["gap_pan"] / 2.0, np.sign(apart), 0.0)
    spring = run["k_shaft_pan"] * (apart - face * run["gap_pan"] / 2.0) * np.abs(face)
    pressed = face * np.maximum(face * (spring + run["d_shaft_pan"] * speed), 0.0)
    return (pressed - spring) * speed * np.abs(face)


def gear_error(run: Run) -> tuple[np.ndarray, np.ndarray]:
    sine, cosine = run.p.get("g_sin_pan", 0.0), run.p.get("g_cos_pan", 0.0)
    angle = run.theta_gear_pan
    error = sine * np.sin(angle) + cosine * np.cos(angle)
    return error, sine * np.cos(angle) - cosine * np.sin(angle)


def copper(run: Run) -> np.ndarray:
    return run["R_pan"] * run.i_pan**2


def drive(extra: Power = nothing, winding: Power = copper, **changed) -> Power:
    """Losses of the geared motor with a shaft, its friction at the gear."""

    def power(run: Run) -> np.ndarray:
        own = {name: change(run) for name, change in changed.items()}
        friction = dry(run, "pan", "omega_gear_pan", **own)
        return winding(run) + shaft(run) + viscous(run, "pan") + friction + extra(run)

    return power


def end_stops(run: Run) -> np.ndarray:
    """Hunt and Crossley: the damping goes with the depth, and the stop never pulls."""
    lost = nothing(run)
    upper, lower = run["theta_stop_upper_pan"], run["theta_stop_lower_pan"]
    for depth, speed in (
        (run.theta_pan - upper, run.omega_pan),
        (lower - run.theta_pan, -run.omega_pan),
    ):
        spring = run["k_stop_pan"] * np.maximum(depth, 0.0)
        lost += spring * np.maximum(run["c_stop_pan"] * speed, -1.0) * speed
    return lost


def geared(run: Run) -> np.ndarray:
    """What a gear that loses a share of the torque takes, as far as the losses have come up."""
    carried, z = run.given("tau_pan"), run.z_loss_pan
    share = run["mu_avg_pan"] * np.abs(carried) * z + run["mu_dif_pan"] * carried * z**2
    return share * run.omega_pan


def bristles(run: Run) -> np.ndarray:
    """What slips past the bristles, what their bending damps, and the viscous part."""
    w, z, stiff = run.omega_pan, run.bristle_pan, run["sigma0_pan"]
    fallen = np.exp(-((w / run["v_s_pan"]) ** 2))
    level = run["F_c_pan"] + (run["F_s_pan"] - run["F_c_pan"]) * fallen
    bending = w - stiff * np.abs(w) / level * z
    return (
        stiff**2 * np.abs(w) / level * z**2
        + (run["sigma1_pan"] * bending * w)
        + (run["sigma2_pan"] * w**2)
    )


def slipping(run: Run) -> np.ndarray:
    """Elements that carry their most, and are driven on."""
    lost = nothing(run)
    for k in (1, 2, 3):
        most, bend = run[f"F_slip{k}_pan"], run[f"k_slip{k}_pan"] * run.found[f"z_slip{k}_pan"]
        slips = (np.abs(bend) > most * (1.0 - 1e-6)) & (bend * run.omega_pan > 0.0)
        lost += most * np.abs(run.omega_pan) * slips
    return lost


def harmonic(run: Run) -> np.ndarray:
    speed = run.omega_gear_pan - run.omega_pan
    most, inside = run["T_hyst_pan"], run["k_hyst_pan"] * run.z_hyst_pan
    slips = (np.abs(inside) > most * (1.0 - 1e-6)) & (inside * speed > 0.0)
    return copper(run) + run["d_drive_pan"] * speed**2 + most * np.abs(speed) * slips


def clip(value: np.ndarray, most: float) -> np.ndarray:
    return np.clip(value, -most, most)


def dead(value: np.ndarray, width: float) -> np.ndarray:
    return np.sign(value) * np.maximum(np.abs(value) - width, 0.0)


def directed(run: Run) -> np.ndarray:
    """Coulomb friction alone differs: Stribeck's part of the difference falls off with the rest."""
    fallen = np.exp(-((run.omega_pan / run["v_s_pan"]) ** 2))
    return run["F_c_pan"] * run["a_F_c_pan"] * np.sign(run.omega_pan) * (1.0 - fallen)


def around(run: Run) -> np.ndarray:
    angle = run.theta_pan
    return 1.0 + run["f_sin_pan"] * np.sin(angle) + run["f_cos_pan"] * np.cos(angle)


@dataclass(frozen=True)
class Case:
    """An effect at work with `values` on a machine, its power in and its losses."""

    effect: str
    machine: str
    power_in: Power
    lost: Power
    values: Mapping[str, float]


def on_joints(effect: str, lost: Power, power_in: Power = as_given, **values: float) -> Case:
    return Case(effect, "joints", power_in, lost, values)


def on_drive(effect: str, lost: Power, power_in: Power = at_terminals, **values: float) -> Case:
    return Case(effect, "drive", power_in, lost, values)


CASES = (
    on_joints("rigid_bodies", joints()),
    on_joints("payload", joints()),
    on_joints("viscous_friction", joints(), b_pan=0.3),
    on_joints("csvs_friction", joints(), F_c_pan=0.2, F_s_pan=0.4, v_s_pan=0.2, F_v_pan=0.2),
    on_joints("payload_com_offset", joints(), c_y_payload=0.02),
    on_joints("product_of_inertia", joints(), J_xy_tilt=1e-3),
    on_joints("axis_offset", joints(), a_tilt=0.05),
    on_joints("imu", joints()),
    on_joints("motor_encoder", joints()),
    on_joints("rotor_inertia", joints(), J_rotor_pan=0.03),
    on_joints("pan_com_offset", joints(), m_pan_body=2.0, c_x_pan=0.05, c_y_pan=0.02),
    on_joints("base_tilt", joints(), beta_base=0.1, alpha_base=0.4),
    on_joints("base_motion", joints(), shaken, a_base=2.0, f_base=1.7, phi_base=0.3, psi_base=0.5),
    on_joints("direction_dependent_friction", joints(coulomb=directed), a_F_c_pan=0.3, F_s_pan=0.1),
    on_joints(
        "load_dependent_friction",
        joints(coulomb=lambda r: r["mu_load_pan"] * np.abs(r.given("tau_pan"))),
        mu_load_pan=0.1,
    ),
    on_joints(
        "torque_proportional_loss", joints(geared), mu_avg_pan=0.2, mu_dif_pan=0.1, h_loss_pan=0.05
    ),
    on_joints("position_dependent_friction", joints(factor=around), f_sin_pan=0.5, f_cos_pan=0.2),
    on_joints("rate_dependent_breakaway", joints(), a_rest_pan=0.5, t_rest_pan=0.1),
    on_joints(
        "stribeck_exponent",
        joints(exponent=lambda r: r["gamma_pan"]),
        gamma_pan=1.0,
        F_s_pan=0.4,
        v_s_pan=0.3,
    ),
    on_joints(
        "friction_drift",
        joints(factor=lambda r: 1.0 + r["a_drift_pan"] * -np.expm1(-r.found.t / r["t_drift_pan"])),
        a_drift_pan=0.6,
        t_drift_pan=0.5,
    ),
    on_joints(
        "temperature_dependent_friction",
        joints(
            factor=lambda r: np.exp(-r["k_T_dry_pan"] * r.given("temperature_pan")),
            thinner=lambda r: np.exp(-r["k_T_viscous_pan"] * r.given("temperature_pan")),
        ),
        k_T_dry_pan=0.05,
        k_T_viscous_pan=0.08,
        F_v_pan=0.2,
    ),
    on_joints(
        "shear_thinning_friction",
        joints(lambda r: r["F_t_pan"] * r.omega_pan**2 / (r["v_t_pan"] + np.abs(r.omega_pan))),
        F_t_pan=0.3,
    ),
    on_joints(
        "quadratic_drag",
        joints(lambda r: r["c_drag_pan"] * np.abs(r.omega_pan) ** 3),
        c_drag_pan=0.1,
    ),
    on_joints("cogging", joints(), T_sin_pan=0.3, n_cog_pan=5.0),
    on_joints("cable_spring", joints(), k1_cable_pan=0.5, k3_cable_pan=0.3),
    on_joints("magnetic_detent", joints(), T_detent_pan=0.3, w_detent_pan=0.2),
    on_joints("constant_torque", joints(), tau0_pan=0.4),
    on_joints(
        "end_stop",
        joints(end_stops),
        theta_stop_upper_pan=0.2,
        theta_stop_lower_pan=-0.1,
        k_stop_pan=100.0,
        c_stop_pan=0.3,
    ),
    on_joints(
        "torque_saturation",
        joints(),
        torques(lambda r: clip(r.given("tau_pan"), r["tau_max_pan"])),
        tau_max_pan=0.7,
    ),
    on_joints(
        "input_delay",
        joints(),
        torques(lambda r: r.given("tau_pan", r["t_delay_pan"])),
        t_delay_pan=0.03,
    ),
    on_joints("encoder_eccentricity", joints(), e_sin_pan=0.05),
    on_drive("dc_motor", drive()),
    on_drive("shaft_compliance", drive(), k_shaft_pan=300.0, d_shaft_pan=3.0),
    on_drive("backlash", drive(), gap_pan=0.05),
    on_drive("gear_eccentricity", drive(), g_sin_pan=0.05, g_cos_pan=0.02),
    on_drive(
        "drive_deadband",
        drive(),
        voltage(lambda r: dead(r.given("u_pan"), r["u_dead_pan"])),
        u_dead_pan=3.0,
    ),
    on_drive(
        "voltage_offset", drive(), voltage(lambda r: r.given("u_pan") + r["u0_pan"]), u0_pan=2.0
    ),
    on_drive(
        "voltage_saturation",
        drive(),
        voltage(lambda r: clip(r.given("u_pan"), r["u_max_pan"])),
        u_max_pan=8.0,
    ),
    on_drive(
        "winding_heating",
        drive(winding=lambda r: (1.0 + r.heat_pan) * copper(r)),
        k_heat_pan=0.05,
        t_heat_pan=1.0,
    ),
    Case(
        "base_acceleration",
        "pan_com_offset base_acceleration",
        pushed,
        nothing,
        {"m_pan_body": 2.0, "c_x_pan": 0.05, "c_y_pan": 0.03},
    ),
    Case(
        "base_rotation",
        "pan_com_offset base_rotation",
        turned,
        nothing,
        {"m_pan_body": 2.0, "c_x_pan": 0.05, "c_y_pan": 0.03, "c_z_pan": 0.04}
        | {"J_x_pan": 0.03, "J_y_pan": 0.05},
    ),
    Case("lugre_friction", "lugre_friction", as_given, bristles, {"sigma0_pan": 100.0}),
    Case("maxwell_slip_friction", "maxwell_slip_friction", as_given, slipping, {}),
    Case(
        "actuator_lag",
        "actuator_lag",
        torques(lambda r: r.tau_actuator_pan),
        nothing,
        {"t_actuator_pan": 0.05},
    ),
    Case("measurement_lag", "measurement_lag", as_given, nothing, {"t_lag_pan": 0.05}),
    Case("encoder_quantization", "encoder_quantization", as_given, nothing, {}),
    Case(
        "prescribed_motion",
        "prescribed_motion viscous_friction",
        lambda r: (r["J_pan"] * r.given("alpha_pan") + r["b_pan"] * r.omega_pan) * r.omega_pan,
        lambda r: viscous(r, "pan"),
        {},
    ),
    Case(
        "harmonic_drive",
        "dc_motor harmonic_drive",
        voltage(),
        harmonic,
        {"T_hyst_pan": 0.5, "k_hyst_pan": 500.0},
    ),
    Case(
        "pwm_drive",
        "dc_motor pwm_drive",
        voltage(lambda r: clip(r.given("u_pan"), r["u_supply_pan"])),
        copper,
        {"u_supply_pan": 12.0},
    ),
    Case("pid_controller", "dc_motor pid_controller", voltage(lambda r: r.command_pan), copper, {}),
    Case(
        "controller_delay",
        "dc_motor pid_controller controller_delay",
        voltage(lambda r: r.u_acting_pan),
        copper,
        {},
    ),
)


@dataclass(frozen=True)
class Stored:
    """An effect whose losses the states do not show (friction goes with a load that goes with the
    acceleration, faces strike in no time): what its machine stores is known instead.
    """

    effect: str
    kind: str | None
    axis: str
    energy: Power
    values: Mapping[str, float]


def motor(run: Run, rate: str = "omega_pan") -> np.ndarray:
    """Energy in J of joint, rotor and winding."""
    rotor = run["J_motor_pan"] * run["N_pan"] ** 2 * run.found[rate] ** 2 / 2
    return run["J_pan"] * run.omega_pan**2 / 2 + rotor + run["L_pan"] * run.i_pan**2 / 2


def actuated(run: Run) -> np.ndarray:
    """Body, screw and winding: the screw turns as the third side of a triangle grows."""
    ground, arm = run["l_ground_tilt"], run["r_arm_tilt"]
    start = run["l_min_tilt"] + run["s_start_tilt"]
    opening = np.arccos((ground**2 + arm**2 - start**2) / (2.0 * ground * arm)) - run.theta_tilt
    length = np.sqrt(ground**2 + arm**2 - 2.0 * ground * arm * np.cos(opening))
    lever = ground * arm * np.sin(opening) / length
    turns = run["N_tilt"] * 2.0 * np.pi / run["lead_tilt"] * lever
    inertia = run["J_y_tilt"] + run["J_motor_tilt"] * turns**2
    return inertia * run.omega_tilt**2 / 2 + run["L_tilt"] * run.i_tilt**2 / 2


STORED = (
    Stored("linear_actuator", None, "tilt", actuated, {}),
    Stored("directional_load_friction", None, "pan", motor, {"mu_motor_pan": 0.1}),
    Stored("pwm_drive", "switching", "pan", motor, {"f_pwm_pan": 30.0}),
    Stored("pwm_drive", "bipolar", "pan", motor, {"f_pwm_pan": 30.0}),
    *(
        Stored("backlash", kind, "pan", lambda r: motor(r, "omega_gear_pan"), {"gap_pan": 0.05})
        for kind in ("elastic_impact", "hysteresis_friction", "hysteresis_inertia")
    ),
)
BESIDE = {"directional_load_friction": "csvs_friction"}


def declared(effects: str, base: Platform | None = None) -> Platform:
    names = effects.split()
    whole = {e.id for e in EFFECTS if not e.on_axis}
    added = tuple(EffectDeclaration(n, None if n in whole else "pan", None) for n in names)
    if base is not None:
        present = {(e.effect, e.axis) for e in base.effects}
        new = tuple(e for e in added if (e.effect, e.axis) not in present)
        return replace(base, effects=(*base.effects, *new))
    body = EffectDeclaration("rigid_bodies", None, None)
    return Platform("split", "Split", ("pan",), 9.81, (body, *added), (), ())


@cache
def machine(name: str) -> Model:
    """One of the two that carry many effects, all switched off, or one of its own."""
    bases = {"joints": "fieldlog_two_axis.toml", "drive": "fieldlog_pan.toml"}
    if name not in bases:
        return emission.emit(declared(name))
    own = " ".join(case.effect for case in CASES if case.machine == name)
    return emission.emit(declared(own, read_platform(PLATFORMS / bases[name])))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.effect)
def test_supply_and_losses_are_those_of_the_laws(case: Case, figure) -> None:
    model = machine(case.machine)
    times = np.arange(0.0, DURATION + STEP / 2, STEP)
    inputs = {name: multisine(*WAVES[name]) for name in model.input_names}
    found = simulate(model, times, inputs, case.values, rtol=1e-9, atol=1e-10)
    run = Run(
        found, dict(zip(model.parameter_names, model.parameter_vector(case.values), strict=True))
    )
    supplied, lost = (
        cumulative_trapezoid(power(run), times, initial=0.0) for power in (case.power_in, case.lost)
    )
    through = np.ptp(supplied) + np.ptp(lost)
    assert np.ptp(found["theta_pan"]) > 0.05
    for name, booked, own in (
        ("supplied", found.supplied, supplied),
        ("dissipated", found.dissipated, lost),
    ):
        off = figure(
            f"{case.effect}: {name}, off per J that went through",
            np.abs(booked - own).max() / through,
        )
        assert off <= CLOSE, name


@pytest.mark.parametrize("case", STORED, ids=lambda case: f"{case.effect} {case.kind or ''}")
def test_what_came_in_and_is_not_stored_is_lost(case: Stored, figure) -> None:
    axis = case.axis
    names = ["rigid_bodies", *([] if case.effect == "linear_actuator" else ["dc_motor"])]
    names += [BESIDE[case.effect]] if case.effect in BESIDE else []
    effects = [EffectDeclaration(n, None if n == "rigid_bodies" else axis, None) for n in names]
    own = EffectDeclaration(case.effect, axis, None, case.kind)
    platform = Platform("split", "Split", (axis,), 9.81, (*effects, own), (), ())
    model = emission.emit(platform)
    times = np.arange(0.0, DURATION + STEP / 2, STEP)
    given = {f"u_{axis}": multisine(*WAVES[f"u_{axis}"])}
    found = simulate(model, times, given, case.values, rtol=1e-9, atol=1e-10)
    run = Run(
        found, dict(zip(model.parameter_names, model.parameter_vector(case.values), strict=True))
    )
    current = found[f"i_{axis}"]
    gained = case.energy(run) - case.energy(run)[0]
    if case.effect == "pwm_drive":  # pulses end between the samples; all that is lost heats copper
        lost = cumulative_trapezoid(copper(run), times, initial=0.0)
        supplied = lost + gained
    else:
        supplied = cumulative_trapezoid(run.given(f"u_{axis}") * current, times, initial=0.0)
        lost = supplied - gained
    through = np.ptp(supplied)
    for name, booked, own in (
        ("stored", found.stored - found.stored[0], gained),
        ("supplied", found.supplied, supplied),
        ("dissipated", found.dissipated, lost),
    ):
        off = np.abs(booked - own).max() / through
        assert figure(f"{case.effect}: {name}, off per J that came in", off) <= CLOSE
    assert found.dissipated[-1] > 0.1 * through


def test_every_effect_has_its_case() -> None:
    covered = {case.effect for case in CASES} | {case.effect for case in STORED}
    assert covered == {effect.id for effect in EFFECTS}
    kinds = {(e.id, k.kind) for e in EFFECTS for k in e.kinds if e.id in ("backlash", "pwm_drive")}
    assert kinds <= {(case.effect, case.kind) for case in STORED}
