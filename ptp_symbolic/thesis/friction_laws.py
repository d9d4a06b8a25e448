"""Section 2.3.2.1: the friction of Figs. 2.7 to 2.16 as the emitted effects have it.

A body with one joint carries the effects; friction torques are what its emitted equations take from
it, and motions are simulations of it. The thesis prints no numbers for these figures: dry friction
is the mean of Table 4.2, omega > 0, and what no table holds is chosen here.
"""

from collections.abc import Mapping
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import bisect, minimize_scalar

import ptp_symbolic
from ptp_symbolic.models.emission import emit
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import InputSignal, ramp, table
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.thesis import printed
from ptp_symbolic.thesis.friction import mean_friction
from ptp_symbolic.thesis.items import Item, unprinted

FloatArray = NDArray[np.float64]
Values = Mapping[str, float]

DRY_EFFECTS = (
    EffectDeclaration("csvs_friction", "pan", "joint"),
    EffectDeclaration("rate_dependent_breakaway", "pan", None),
    EffectDeclaration("viscous_friction", "pan", None),
    EffectDeclaration("cable_spring", "pan", None),
)
BRISTLE_EFFECTS = (EffectDeclaration("lugre_friction", "pan", "joint"),)
# Growth of the breakaway torque per e-fold of rest, and the rest in s after which it grows.
REST_GROWTH, REST_TIME = 0.1, 0.01
TORQUE_RATES = np.geomspace(0.1, 1e3, 33)  # N m/s
# A spring of this stiffness in N m/rad, its free end drawn with this speed in rad/s.
SPRING, DRAWING_SPEED, DRAWING_TIME = 50.0, 0.01, 30.0
# Bristles, in N m/rad and N m s/rad: 0.7 mrad of bend at breakaway, well damped.
BRISTLE_STIFFNESS, BRISTLE_DAMPING = 1e4, 100.0
# The speed of Fig. 2.11 in rad/s is imposed by a body of this inertia in kg m^2.
IMPOSING_INERTIA = 1e4
LAG_MEAN, LAG_SWING, LAG_FREQUENCIES = 0.04, 0.035, (1.0, 4.0, 16.0)


def _model(name: str, effects: tuple[EffectDeclaration, ...]) -> Model:
    body = EffectDeclaration("rigid_bodies", None, None)
    return emit(Platform(name, "Friction of chapter 2", ("pan",), 9.81, (body, *effects), (), ()))


@cache
def dry_model() -> Model:
    """Body with dry friction, growing breakaway, viscous friction and a spring to the frame."""
    return _model("dry_friction", DRY_EFFECTS)


@cache
def bristle_model() -> Model:
    """Body with LuGre friction."""
    return _model("bristle_friction", BRISTLE_EFFECTS)


def dry_values(**changes: float) -> dict[str, float]:
    """Parameters of `dry_model`: friction of Table 4.2, everything else off, then `changes`."""
    f = mean_friction("positive")
    values = {f"{name}_pan": getattr(f, name) for name in ("F_c", "F_s", "v_s", "F_v")}
    values |= {"a_rest_pan": 0.0, "b_pan": 0.0, "k1_cable_pan": 0.0, "k3_cable_pan": 0.0}
    return values | {"J_pan": printed.APPENDIX_C_MOTOR_INERTIA + printed.INERTIA} | changes


def bristle_values(**changes: float) -> dict[str, float]:
    """Parameters of `bristle_model`, friction of Table 4.2."""
    dry = dry_values()
    values = {name: dry[name] for name in ("F_c_pan", "F_s_pan", "v_s_pan", "J_pan")}
    values |= {"sigma0_pan": BRISTLE_STIFFNESS, "sigma1_pan": BRISTLE_DAMPING}
    return values | {"sigma2_pan": dry["F_v_pan"]} | changes


def friction_torque(model: Model, states: FloatArray, values: Values) -> FloatArray:
    """Friction torque [k] in N m against motion at `states` [k, n]: what the body loses without
    any other torque.
    """
    p, no_input = model.parameter_vector(values), np.zeros(len(model.input_names))
    rate, inertia = model.state_names.index("omega_pan"), values["J_pan"]
    return np.array([-inertia * model.rhs(0.0, x, no_input, p)[rate] for x in states])


def sliding_friction(rates: FloatArray, values: Values) -> FloatArray:
    """Friction torque [k] in N m of `dry_model` at `rates` [k] in rad/s, none of them zero."""
    model = dry_model()
    states = np.zeros((len(rates), len(model.state_names)))
    states[:, model.state_names.index("omega_pan")] = rates
    return friction_torque(model, states, values)


def breakaway_torque(values: Values) -> float:
    """Largest torque in N m under which the body of `dry_model` stays at rest, without a dwell."""
    model = dry_model()
    p, x = model.parameter_vector(values), np.zeros(len(model.state_names))
    rate = model.state_names.index("omega_pan")

    def moves(torque: float) -> float:
        return 1.0 if model.rhs(0.0, x, [torque], p)[rate] > 0.0 else -1.0

    return float(bisect(moves, 0.0, 2.0 * values["F_s_pan"] + 1.0, xtol=1e-10))


def stribeck_minimum() -> tuple[float, float]:
    """Rate in rad/s and torque in N m where the steady friction is least."""
    values = dry_values()
    found = minimize_scalar(
        lambda rate: float(sliding_friction(np.array([rate]), values)[0]),
        bounds=(values["v_s_pan"], 10.0 * values["v_s_pan"]),
        method="bounded",
        options={"xatol": 1e-9},
    )
    return float(found.x), float(found.fun)


@cache
def breakaway_by_rate() -> FloatArray:
    """Torque [k] in N m at which the body starts to slide, for every rate of TORQUE_RATES."""
    values = dry_values(a_rest_pan=REST_GROWTH, t_rest_pan=REST_TIME)
    highest = 10.0 * values["F_s_pan"]
    found = []
    for rate in TORQUE_RATES:
        end = highest / rate
        run = ptp_symbolic.simulate(
            dry_model(), [0.0, end], {"tau_pan": ramp(0.0, highest, 0.0, end)}, values
        )
        start = next(e.time for e in run.events if e.mode == "slides forward")
        found.append(rate * start)
    return np.array(found)


@cache
def stick_slip() -> Trajectory:
    """A body drawn over dry friction by a spring whose free end moves steadily (Fig. 2.10).

    The spring is fixed to the frame, and the torque that grows with its stiffness times the speed
    of the free end stands for the way that end has moved.
    """
    highest = SPRING * DRAWING_SPEED * DRAWING_TIME
    return ptp_symbolic.simulate(
        dry_model(),
        np.linspace(0.0, DRAWING_TIME, 6_001),
        {"tau_pan": ramp(0.0, highest, 0.0, DRAWING_TIME)},
        dry_values(k1_cable_pan=SPRING),
    )


def dwell_and_slip() -> tuple[float, float]:
    """Dwell time and slip time in s of the last whole cycle of `stick_slip`."""
    events = stick_slip().events
    starts = [e.time for e in events if e.mode == "slides forward"]
    stops = [e.time for e in events if e.mode == "sticks"]
    last = starts[-2]
    stop = next(t for t in stops if t > last)
    return starts[-1] - stop, stop - last


def _bristles(
    torque: InputSignal, times: FloatArray, **start: float
) -> tuple[Trajectory, FloatArray]:
    """Motion of `bristle_model` under a torque, and its friction torque [k] in N m."""
    values = bristle_values()
    run = ptp_symbolic.simulate(bristle_model(), times, {"tau_pan": torque}, values, start)
    return run, friction_torque(bristle_model(), run.x, values)


@cache
def presliding(share: float) -> tuple[FloatArray, FloatArray]:
    """Angle in rad and friction torque in N m, each [k], the torque going up and down to a `share`
    of the static friction (Fig. 2.9).
    """
    peak = share * bristle_values()["F_s_pan"]
    corners = np.array([0.0, 1.0, 3.0, 5.0, 7.0])
    torque = table(corners, peak * np.array([0.0, 1.0, -1.0, 1.0, -1.0]), "linear")
    run, friction = _bristles(torque, np.linspace(0.0, corners[-1], 1_401))
    return run["theta_pan"], friction


@cache
def bristle_bend() -> Trajectory:
    """Bend of the bristles while the torque grows through breakaway (Fig. 2.16)."""
    peak = 1.1 * bristle_values()["F_s_pan"]
    return _bristles(ramp(0.0, peak, 0.0, 1.0), np.linspace(0.0, 1.2, 1_201))[0]


@cache
def frictional_lag(frequency: float) -> tuple[FloatArray, FloatArray]:
    """Rate in rad/s and friction torque in N m, each [k], over one period of a rate that swings
    with `frequency` in Hz about a mean (Fig. 2.11).
    """
    values = bristle_values(J_pan=IMPOSING_INERTIA)
    circular, period = 2.0 * np.pi * frequency, 1.0 / frequency
    mean_torque = float(sliding_friction(np.array([LAG_MEAN]), dry_values())[0])
    swing = [IMPOSING_INERTIA * LAG_SWING * circular, frequency, np.pi / 2.0]
    steady = np.array([[mean_torque, 0.0, 0.0, 0.0]])
    torque = InputSignal(np.array([0.0, 1.0]), steady, sines=np.array([swing]))
    run = ptp_symbolic.simulate(
        bristle_model(),
        np.concatenate([[0.0], np.linspace(2.0 * period, 3.0 * period, 401)]),
        {"tau_pan": torque},
        values,
        {"omega_pan": LAG_MEAN},
        largest_step=0.01 * period,
    )
    return run["omega_pan"][1:], friction_torque(bristle_model(), run.x, values)[1:]


def items() -> list[Item]:
    """What Figs. 2.7, 2.8 and 2.10 show, in numbers."""
    rate, least = stribeck_minimum()
    dwell, slip = dwell_and_slip()
    breakaway = breakaway_by_rate()
    slow, fast = (f"breakaway at {rate:g} N m/s" for rate in TORQUE_RATES[[0, -1]])
    ramps = (
        f"simulated torque ramp; rate_dependent_breakaway with {REST_GROWTH:g} per e-fold of the"
        f" rest beyond {REST_TIME:g} s (chosen here), mean F_s of Table 4.2"
    )
    curve = "least friction of the emitted law, mean friction of Table 4.2"
    drawn = (
        f"events of the simulation: spring of {SPRING:g} N m/rad, free end at {DRAWING_SPEED:g}"
        " rad/s (chosen here), mean friction of Table 4.2, inertia of Appendix C"
    )
    rows = (
        ("fig_2_7", "breakaway_slow", slow, breakaway[0], "N m", ramps),
        ("fig_2_7", "breakaway_fast", fast, breakaway[-1], "N m", ramps),
        ("fig_2_8", "least_friction_rate", "rate of the least friction", rate, "rad/s", curve),
        ("fig_2_8", "least_friction", "least friction", least, "N m", curve),
        ("fig_2_10", "dwell_time", "dwell time", dwell, "s", drawn),
        ("fig_2_10", "slip_time", "slip time", slip, "s", drawn),
    )
    return [
        unprinted(
            f"{figure}.{what}",
            f"Fig. {figure[4:].replace('_', '.')}, {title}",
            float(value),
            unit,
            check,
        )
        for figure, what, title, value, unit, check in rows
    ]
