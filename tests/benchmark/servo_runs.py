"""Runs of the machines that a servo drives: references, feedforward and gains."""

import math

import numpy as np

from tests.benchmark import references
from tests.benchmark.machine import Floats, Run, Values, stalls, unit_pushes
from tests.benchmark.profiles import times
from tests.benchmark.truth_drive import GRAVITY
from tests.benchmark.variation import Variation
from tests.independent.rigid_runs import Servo

SHORT_ARC = math.radians(9.0)
RESTS = (0.1, 0.4, 0.8, 0.2, 1.5, 0.3)  # s
TWO_AXIS_TONES = (0.13, 0.31, 0.54, 1.1)  # Hz
TWO_AXIS_SIZES = ((1.9, 0.5, 0.2, 0.07), (0.5, 0.28, 0.17, 0.05))  # rad, pan and tilt
TRACKING = 2 * math.pi * 3.0  # rad/s, natural frequency of a torque servo
DAMPING = 0.8
# rad/s; a torque servo slips and sticks where friction falls with the rate, and stays above that.
CRAWLS = {"tilt_servo": (0.03, 0.06, 0.12), "direct_drive": (0.12, 0.2, 0.35)}
NO_LIMIT = 1e3
BOTH = ("pan", "tilt")
BODY = {"pan": "J_pan", "tilt": "J_y_tilt"}  # inertia of an axis without its payload


def _motor_servo(
    axes: tuple[str, ...], values: Values, variation: Variation
) -> tuple[Servo, Floats]:
    """Position servo of voltage-driven motors, and volts per rad/s [joints] for its feedforward."""
    gains, volts = np.zeros(2), np.zeros(len(axes))
    lever = values["m_payload"] * values["c_x_payload"] ** 2
    for number, axis in enumerate(axes):
        constant = values[f"K_t_{axis}"] * values[f"N_{axis}"]
        damping = constant**2 / values[f"R_{axis}"] + values.get(f"F_v_{axis}", 0.0)
        inertia = lever + values[BODY[axis]]
        inertia += values[f"J_motor_{axis}"] * values[f"N_{axis}"] ** 2
        stiffness = min(0.1 * damping**2 / inertia, 0.4 * damping / variation.period)
        gains[BOTH.index(axis)] = stiffness * values[f"R_{axis}"] / constant
        volts[number] = damping * values[f"R_{axis}"] / constant
    supply = 24.0 if variation.heavy else 12.0
    count, zero = 2 * math.pi / variation.counts, np.zeros(2)
    return Servo(gains, zero, zero, np.full(2, supply), count), volts


def _torque_servo(inertia: Floats, weight: float, variation: Variation) -> Servo:
    """Tracking servo of torque-driven joints with inertias [2]."""
    stiffness, rate = inertia * TRACKING**2, inertia * 2 * DAMPING * TRACKING
    count = 2 * math.pi / variation.counts
    return Servo(stiffness, rate, np.array([0.0, weight]), np.full(2, NO_LIMIT), count)


def _single_references(
    name: str, rng: np.random.Generator, variation: Variation
) -> dict[str, Floats]:
    """Angles [n] of every run of a machine with one axis."""
    short = variation.short_arc
    reach = SHORT_ARC if short else float(rng.uniform(2.6, 2.8))
    speed = 0.6 if short else float(rng.uniform(1.0, 1.5))
    slow = tuple(float(one) for one in rng.uniform(0.8, 1.2, 3) * CRAWLS[name])
    stops = tuple(float(s) * reach for s in (-1.0, -0.55, -0.1, 0.35, 0.7, 1.0, 0.2, -0.6))
    rests = tuple(float(rest) for rest in rng.permutation(RESTS))
    period = variation.period

    def at(duration: float) -> Floats:
        return times(duration, period)

    def wave(duration: float) -> Floats:
        t = at(duration)
        return references.faded_in(t, references.waves(t, rng, reach, 1.3 * speed, short))

    def crawl(duration: float, sign: float) -> Floats:
        centre = 0.0 if short else float(rng.uniform(-0.7, 0.7)) * reach
        motion = references.crawl(at(duration), 0.0, slow, 0.9 if short else 1.6)
        return centre + sign * motion

    longer = 1.25 if name == "tilt_servo" else 1.0
    many = {
        "train/waves": wave(8.0 * longer),
        "train/crawl": crawl(8.0 * longer, 1.0),
        "train/creeps": references.creeps(at(8.0 * longer), -reach, reach, rests),
        "validate/waves": wave(7.0 * longer),
        "validate/creeps": references.creeps(at(7.0 * longer), reach, -reach, rests[::-1]),
    }
    if name == "tilt_servo":
        many["train/moves"] = references.moves(at(8.0), stops, (0.4, 0.15), speed)
        ends = (-0.9 * reach, 0.9 * reach)
        many["train/steps"] = references.moves(at(5.0), ends, (0.3, 0.6), 1.5 * speed)
        many["validate/crawl"] = crawl(6.0, -1.0)
    if variation.repeat:
        many["train/creeps"] = many["train/waves"]
    order = sorted(many, key=lambda path: path.startswith("validate"))
    return {path: references.rounded(many[path], period) for path in order}


def _two_axis_references(rng: np.random.Generator, variation: Variation) -> dict[str, Floats]:
    """Angles [n, 2] of every run of the platform, in motion from the start."""
    many = {}
    for path in ("train/tracking_1", "train/tracking_2", "validate/tracking_3"):
        t = times(8.0, variation.period)
        columns = []
        for sizes in TWO_AXIS_SIZES:
            size = np.array(sizes) * rng.uniform(0.85, 1.1, 4)
            tones = 2 * math.pi * np.array(TWO_AXIS_TONES) * rng.uniform(0.95, 1.05, 4)
            phases = rng.uniform(0, 2 * math.pi, 4)
            columns.append((size * np.sin(np.outer(t, tones) + phases)).sum(axis=1))
        many[path] = np.column_stack(columns)
    if variation.repeat:
        many["train/tracking_2"] = many["train/tracking_1"]
    return many


def _drive_by(
    name: str, axes: tuple[str, ...], values: Values, variation: Variation
) -> tuple[Servo, Floats, Floats]:
    """The servo, and its feedforward per rate and per acceleration wanted, each [joints]."""
    if name in ("tilt_servo", "two_axis_servo"):
        servo, volts = _motor_servo(axes, values, variation)
        return servo, volts, np.zeros(len(axes))
    lever = values["m_payload"] * values["c_x_payload"]
    if name == "direct_drive":
        inertia = values["J_pan"] + lever * values["c_x_payload"]
        return _torque_servo(np.full(2, inertia), 0.0, variation), np.zeros(1), np.array([inertia])
    inertia = lever * values["c_x_payload"] + 0.0133
    servo = _torque_servo(np.full(2, inertia), lever * GRAVITY, variation)
    return servo, np.zeros(2), np.full(2, inertia)


def make_runs(
    name: str,
    axes: tuple[str, ...],
    rng: np.random.Generator,
    values: Values,
    variation: Variation,
) -> tuple[Run, ...]:
    """The runs of the machine `name`, training first; from rest, or both axes in motion."""
    if len(axes) == 1:
        single = _single_references(name, rng, variation)
        angles = {path: angle[:, None] for path, angle in single.items()}
    else:
        angles = _two_axis_references(rng, variation)
    servo, per_rate, per_acceleration = _drive_by(name, axes, values, variation)
    correlation, made = float(rng.uniform(0.3, 2.0)), []
    for path, angle in angles.items():
        rate = np.gradient(angle, variation.period, axis=0)
        acceleration = np.gradient(rate, variation.period, axis=0)
        samples = len(angle)
        kept = stalls(rng, samples, variation.stalls)
        gust, switch = unit_pushes(rng, samples, variation.period, correlation, len(axes))
        inside = rng.uniform(-0.5, 0.5, len(axes)) * 2 * math.pi / variation.counts
        start = np.array([angle[0] + inside, rate[0] * (len(axes) > 1)])
        made.append(
            Run(
                path,
                variation.period,
                per_rate * rate + per_acceleration * acceleration,
                start,
                kept,
                gust,
                switch,
                np.dstack([angle[:, :, None], rate[:, :, None]]),
                servo,
            )
        )
    return tuple(made)
