"""Linear actuator: linkage by coordinates, screw by Eq. 3.12, motion against a hand-written one."""

import math
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

import ptp_symbolic
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, table
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, read_platform
from ptp_symbolic.symbolic.mechanisms.linkage import Linkage
from ptp_symbolic.symbolic.mechanisms.screw import Screw, ScrewFriction
from ptp_symbolic.symbolic.symbols import real
from tests.independent import rigid_platform, tilt_drive
from tests.independent.tilt_drive import TiltDrive

GROUND, ARM, SHORTEST = 0.19755, 0.0634133, 0.139
STROKES = {"thesis-tilt-drive": 0.0405022, "thesis-tilt-drive-stroke-48": 0.0485}
CORNERS, VOLTS = (0.0, 0.5, 2.5, 3.0, 4.0), (0.0, 24.0, 24.0, 0.0, 0.0)
ANGLE = sp.Symbol("theta", real=True)


def linkage(start: float) -> Linkage:
    return Linkage(*(sp.Float(length, 30) for length in (GROUND, SHORTEST, ARM, start)))


def by_coordinates(start: float, angle: float) -> tuple[float, float]:
    """Length of the actuator, and lever of a pushing rod, from the places of foot and pin."""
    opened = math.acos((ARM**2 + GROUND**2 - (SHORTEST + start) ** 2) / (2 * ARM * GROUND))
    foot, turned = np.array([GROUND, 0.0]), opened - angle
    pin = ARM * np.array([math.cos(turned), math.sin(turned)])
    rod = (pin - foot) / np.linalg.norm(pin - foot)
    # The joint angle falls as the pin turns away from the foot.
    return float(np.linalg.norm(pin - foot)), -float(pin[0] * rod[1] - pin[1] * rod[0])


@pytest.mark.parametrize("start", STROKES.values())
def test_stroke_and_lever_against_coordinates(start: float) -> None:
    machine = linkage(start)
    for angle in np.linspace(-1.5, 0.9, 13):
        length, lever = by_coordinates(start, float(angle))
        assert float(machine.stroke(angle)) == pytest.approx(length - SHORTEST, abs=1e-15)
        assert float(machine.ratio(ANGLE).subs(ANGLE, angle)) == pytest.approx(lever, abs=1e-15)
        stroke = machine.stroke(sp.Float(angle, 30))
        assert float(machine.angle(stroke)) == pytest.approx(angle, abs=1e-12)


@pytest.mark.parametrize(("start", "degrees"), [(0.0405022, 7.0), (0.0485, 0.4)])
def test_erratum_19_either_stroke_starts_near_the_perpendicular(
    start: float, degrees: float
) -> None:
    lever = -float(linkage(start).ratio(ANGLE).subs(ANGLE, 0))
    assert math.degrees(math.acos(lever / ARM)) == pytest.approx(degrees, abs=0.05)


def test_erratum_9_the_printed_force_misses_the_power() -> None:
    """The printed force is right times cos^2 of the angle from the perpendicular."""
    machine = linkage(0.0405022)
    for stroke, missing in ((0.0405022, 0.015), (0.0, 0.79)):
        angle = machine.angle(sp.Float(stroke, 30))
        lever = float(machine.ratio(ANGLE).subs(ANGLE, angle))
        assert 1.0 - (lever / ARM) ** 2 == pytest.approx(missing, abs=0.002)


def test_dead_centres_are_where_the_lever_vanishes() -> None:
    machine = linkage(0.0405022)
    strokes = [machine.stroke(angle) for angle in machine.dead_centres()]
    for stroke, flat in zip(strokes, reversed(machine.stroke_limits()), strict=True):
        assert float(stroke) == pytest.approx(float(flat), abs=1e-14)
    for angle in machine.dead_centres():
        assert abs(float(machine.ratio(ANGLE).subs(ANGLE, angle))) < 1e-12
    symbolic = Linkage(*sp.symbols("l_ground l_min r_arm s_start", positive=True))
    lower, upper = symbolic.dead_centres()
    assert sp.simplify(upper - lower - sp.pi) == 0


def test_named_functions_of_the_ratio_are_the_ratio() -> None:
    machine = linkage(0.0405022)
    terms, ratio = machine.ratio_terms(ANGLE, "tilt")
    for symbol, term in reversed(terms.items()):
        ratio = ratio.xreplace({symbol: term})
    difference = sp.lambdify(ANGLE, ratio - machine.ratio(ANGLE))(np.linspace(-1.5, 0.9, 9))
    assert np.abs(difference).max() < 1e-15


def test_the_friction_of_the_screw_follows_from_its_forces_step_by_step() -> None:
    """The balance of a wedge on a slope, in numbers: each step holds with those before it, and ends
    at the torques of Eq. 3.12 and at the friction that the equations have.
    """
    lead, diameter, rub, load = 4e-3, 8e-3, 0.15, 700.0
    driving, torque, inertia, own = 9.0, -4.0, 0.05, 2.0
    symbols = sp.symbols("lead d f driving torque inertia own", real=True)
    given = dict(zip(symbols, (lead, diameter, rub, driving, torque, inertia, own), strict=True))
    own_screw = Screw(*symbols[:3])
    friction = ScrewFriction("tilt", own_screw, *symbols[3:])
    slope = math.atan(lead / (math.pi * diameter))
    known: dict[sp.Expr, float] = {real("lambda_lead_tilt"): slope, real("F_load_tilt"): load}
    values: dict[str, list[float]] = {}
    (_, tangent, ratio), *steps = friction.steps()
    assert tangent == sp.tan(real("lambda_lead_tilt"))
    assert float(ratio.subs(given)) == pytest.approx(math.tan(slope))
    for _, left, right in steps:
        if left.is_Symbol:  # else a balance, from which the next step is solved
            known[left] = float(right.subs(given).subs(known))
            values.setdefault(left.name, []).append(known[left])
    angle = math.atan(rub)
    assert values["T_raise_tilt"] == pytest.approx(
        [load * diameter / 2 * math.tan(slope + angle)] * 2
    )
    assert values["T_lower_tilt"] == pytest.approx(
        [load * diameter / 2 * math.tan(angle - slope)] * 2
    )
    (raised,), (lowered,) = values["raised_tilt"], values["lowered_tilt"]
    assert raised == pytest.approx(math.tan(slope + angle) / math.tan(slope))
    assert lowered == pytest.approx(math.tan(slope - angle) / math.tan(slope))
    # motor and joint turn together: what the motor gives, less its inertia, is what the screw takes
    for share, passed in zip((raised, lowered), values["T_passed_tilt"], strict=True):
        assert (driving - share * passed) / own == pytest.approx((torque + passed) / inertia)
    terms = {symbol: term.subs(given) for symbol, term in friction.terms.items()}
    sliding = friction.sliding(sp.Integer(1)).subs(given)
    for symbol in reversed(list(terms)):
        sliding = sliding.subs(symbol, terms[symbol])
    assert float(sliding) == pytest.approx(values["T_friction_tilt"][0])


def test_screw_is_eq_3_12_by_lead_and_friction_angle() -> None:
    lead, diameter, friction = 4e-3, 8e-3, 0.15
    screw = Screw(*map(sp.Float, (lead, diameter, friction)))
    slope, rub = math.atan(lead / (math.pi * diameter)), math.atan(friction)
    assert float(screw.raising) == pytest.approx(diameter / 2 * math.tan(slope + rub))
    assert float(screw.lowering) == pytest.approx(diameter / 2 * math.tan(rub - slope))
    assert float(screw.lowering) == pytest.approx(-3.58e-5, rel=1e-3)  # erratum 10
    drive, back = math.tan(slope) / math.tan(slope + rub), math.tan(slope - rub) / math.tan(slope)
    assert float(screw.drive_efficiency) == pytest.approx(drive)
    assert float(screw.back_drive_efficiency) == pytest.approx(back)


def test_self_locking_begins_where_friction_and_lead_angle_meet() -> None:
    just = 4e-3 / (math.pi * 8e-3)
    for friction, locks in ((0.15, False), (just * 0.999, False), (just * 1.001, True)):
        screw = Screw(sp.Float(4e-3), sp.Float(8e-3), sp.Float(friction))
        assert bool(screw.self_locking) is locks
        assert (float(screw.back_drive_efficiency) <= 0.0) is locks


def trajectory(model: Model, drive: TiltDrive, factor: float) -> tuple[np.ndarray, np.ndarray]:
    """Angle, rate and current [k, 3]: of the model, and of the hand-written simulation."""
    times = np.linspace(0.0, 4.0, 81)
    volts = factor * np.array(VOLTS)
    changed = {
        "c_x_payload": drive.c_x,
        "c_z_payload": drive.c_z,
        "f_screw_tilt": drive.f_screw,
        "b_tilt": drive.b_joint,
        "s_start_tilt": drive.s_start,
    }
    found = ptp_symbolic.simulate(
        model, times, {"u_tilt": table(CORNERS, volts, "linear")}, changed, rtol=1e-10, atol=1e-12
    )
    truth = tilt_drive.simulate(
        drive, lambda t: float(np.interp(t, CORNERS, volts)), times, CORNERS
    )
    joint = np.array([tilt_drive.joint(drive, x) for x in truth])
    assert found.stored - found.stored[0] == pytest.approx(
        found.supplied - found.dissipated, abs=1e-6 * found.supplied.max()
    )
    assert np.all(np.diff(found.dissipated) >= 0.0)
    return found.x, np.column_stack([joint, truth[:, tilt_drive.CURRENT]])


@pytest.mark.parametrize(
    ("factor", "changes"),
    [
        (1.0, {"c_x": 0.01}),
        (-1.0, {"c_x": 0.01}),
        (1.0, {"c_x": 0.0876228, "c_z": 0.0, "b_joint": 0.0}),
        (-1.0, {"c_x": 0.0876228, "c_z": 0.0, "b_joint": 0.0}),
        (-1.0, {"c_x": 0.0876228, "c_z": 0.0, "f_screw": 0.3}),
        (1.0, {"c_x": 0.01, "s_start": 0.0485}),
    ],
    ids=["out", "in", "raise", "lower", "lower-locking", "second-stroke"],
)
def test_trapezoid_against_a_simulation_in_motor_coordinates(
    factor: float, changes: dict[str, float]
) -> None:
    found, truth = trajectory(ptp_symbolic.load("tilt_drive"), TiltDrive(**changes), factor)
    assert np.abs(truth[:, 0]).max() > 0.05
    assert np.abs(found - truth).max(axis=0) == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("factor", [1.0, -1.0])
def test_dry_friction_in_the_joint_is_a_part_of_the_load(factor: float) -> None:
    """Two frictions on one rate: the screw carries what the joint's friction takes."""
    platform = read_platform("thesis-tilt-drive")
    dry = EffectDeclaration("csvs_friction", "tilt", "joint")
    values = {"F_c_tilt": 2.0, "F_s_tilt": 2.0, "F_v_tilt": 0.0}
    declared = tuple(ParameterDeclaration(name, None, v) for name, v in values.items())
    effects, parameters = (*platform.effects, dry), (*platform.parameters, *declared)
    model = emission.emit(replace(platform, effects=effects, parameters=parameters))
    drive = TiltDrive(c_x=0.05, c_z=0.02, F_joint=2.0)
    found, truth = trajectory(model, drive, factor)
    assert np.abs(found - truth).max(axis=0) == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize(("resistance", "speed"), [(17.0, 1e-6), (1e4, 2e-6)])
def test_erratum_10_the_screw_overhauls_slowly(resistance: float, speed: float) -> None:
    """Shorted and as good as open winding, the load of Table 5.6 at full lever."""
    model, per = ptp_symbolic.load("tilt_drive"), 4e-3 / (2.0 * math.pi * 93.0)
    load = {"c_x_payload": 0.0876228, "c_z_payload": 0.0, "R_tilt": resistance}
    load["L_tilt"] = resistance * 5.5e-4  # the same time constant
    found = ptp_symbolic.simulate(model, 2.0, {"u_tilt": constant(0.0)}, load)
    ratio = 0.0634133 * math.cos(math.radians(7.03)) / per
    assert abs(found["omega_tilt"][-1]) * ratio * per == pytest.approx(speed, rel=0.05)
    locked = {**load, "f_screw_tilt": 0.17}
    still = ptp_symbolic.simulate(model, 2.0, {"u_tilt": constant(0.0)}, locked)
    assert np.all(still["theta_tilt"] == 0.0)


def test_force_and_screw_torque_obey_eq_3_12_on_the_coupled_machine() -> None:
    """Of the whole machine: the load by Newton and Euler, the motor by its own balance."""
    model, rng = ptp_symbolic.load("full"), np.random.default_rng(4)
    names = model.state_names
    drive = TiltDrive()
    up, down = drive.raise_lower()
    seen = set()
    for _ in range(50):
        values = {**model.defaults, "c_y_payload": 0.05, "c_x_payload": 0.03, "b_pan": 0.0}
        x, u = 0.3 * rng.normal(size=len(names)), np.zeros(2)
        at = {name: x[i] for i, name in enumerate(names)}
        x[names.index("theta_gear_pan")] = at["theta_pan"]  # in the gap: no shaft torque
        a = model.rhs(0.0, x, u, model.parameter_vector(values))
        q, w = (
            np.array([at["theta_pan"], at["theta_tilt"]]),
            np.array([at["omega_pan"], at["omega_tilt"]]),
        )
        acceleration = a[[names.index("omega_pan"), names.index("omega_tilt")]]
        free = rigid_platform.accelerations(q, w, np.zeros(2), values)
        pan, tilt = rigid_platform.mass_matrix(q, values) @ (acceleration - free)
        assert pan == pytest.approx(0.0, abs=1e-9 * np.abs(acceleration).max())
        step = 1e-5
        levers = [by_coordinates(drive.s_start, q[1] + side)[1] for side in (-step, 0.0, step)]
        per = drive.metres_per_radian
        speed = levers[1] * w[1] / per
        slope = (levers[2] - levers[0]) / (2.0 * step)
        change = (levers[1] * acceleration[1] + slope * w[1] ** 2) / per
        motor = drive.K_t * at["i_tilt"] - drive.b_motor * speed - drive.J_motor * change
        force = tilt / levers[1]
        raising = force * speed > 0.0
        seen.add(raising)
        assert motor * drive.N == pytest.approx((up if raising else -down) * force, abs=1e-7)
    assert seen == {True, False}


@pytest.mark.parametrize(("preset", "above"), [*((name, True) for name in STROKES), (None, False)])
def test_erratum_24_the_force_reverses_with_the_mass_above_the_axis(
    preset: str | None, above: bool
) -> None:
    """Section 5.3: the rod first pushes, then holds the load back, and still does at the end."""
    model = ptp_symbolic.load(preset or "thesis-tilt-drive")
    below = {} if above else {"c_z_payload": -0.0876228}
    times, volts = np.linspace(0.0, 4.0, 401), table(CORNERS, VOLTS, "linear")
    found = ptp_symbolic.simulate(model, times, {"u_tilt": volts}, below)
    p = model.parameter_vector(below)
    applied = np.interp(times, CORNERS, VOLTS)
    rows = zip(times, found.x, applied, strict=True)
    change = np.array([model.rhs(t, x, np.array([u]), p)[1] for t, x, u in rows])
    motion = (found.x[:, :1], found.x[:, 1:2], change[:, None])
    torque = ptp_symbolic.inverse_dynamics(preset or "thesis-tilt-drive", motion, below)[:, 0]
    lever = [by_coordinates(STROKES[preset or "thesis-tilt-drive"], q)[1] for q in found.x[:, 0]]
    force = torque / np.array(lever)
    assert found["theta_tilt"][-1] < 0.0
    assert force[60] > 1.0
    assert bool(force[-1] < -1.0) is above


def test_sensitivities_against_differences() -> None:
    """Through sticking and reversal of the load, by parameters of linkage, screw and motor."""
    model, times = ptp_symbolic.load("tilt_drive"), np.linspace(0.0, 4.0, 9)
    inputs = {"u_tilt": table(CORNERS, VOLTS, "linear")}
    base = {"c_x_payload": 0.05, "f_screw_tilt": 0.2, "r_arm_tilt": 0.06, "J_motor_tilt": 2e-6}
    names = ("f_screw_tilt", "r_arm_tilt", "J_motor_tilt")
    found = ptp_symbolic.sensitivity(model, times, inputs, base, by_parameters=names, rtol=1e-9)
    for column, name in enumerate(names):
        step = 1e-5 * base[name]
        ends = [
            ptp_symbolic.simulate(
                model, times, inputs, {**base, name: base[name] + side}, rtol=1e-10, atol=1e-12
            ).x
            for side in (step, -step)
        ]
        difference = (ends[0] - ends[1]) / (2.0 * step)
        scale = np.abs(difference).max(axis=0)
        assert np.abs(found.states[:, :, column] - difference).max(axis=0) / scale == (
            pytest.approx(0.0, abs=1e-4)
        )


def test_behind_a_stiff_shaft_it_moves_as_without() -> None:
    platform = read_platform("thesis-tilt-drive")
    shaft = EffectDeclaration("shaft_compliance", "tilt", None)
    model = emission.emit(replace(platform, effects=(*platform.effects, shaft)))
    inputs = {"u_tilt": table(CORNERS, VOLTS, "linear")}
    stiff = {"k_shaft_tilt": 1e6, "d_shaft_tilt": 50.0, "c_x_payload": 0.01}
    times = np.linspace(0.0, 1.0, 11)
    found = ptp_symbolic.simulate(model, times, inputs, stiff)
    rigid = ptp_symbolic.simulate(
        ptp_symbolic.load("tilt_drive"), times, inputs, {"c_x_payload": 0.01}
    )
    assert found["theta_tilt"] == pytest.approx(rigid["theta_tilt"], abs=2e-6)
    assert found.stored - found.stored[0] == pytest.approx(
        found.supplied - found.dissipated, abs=1e-6 * found.supplied.max()
    )


@pytest.mark.parametrize("friction", [0.15, 0.5])
def test_friction_dissipates_everywhere_between_the_dead_centres(friction: float) -> None:
    model, rng = ptp_symbolic.load("tilt_drive"), np.random.default_rng(1)
    p = model.parameter_vector({"f_screw_tilt": friction, "b_tilt": 0.0, "b_motor_tilt": 0.0})
    p[model.parameter_names.index("R_tilt")] = 0.0
    (lower, upper), _ = model.domain(p)
    for angle in np.linspace(lower, upper, 402)[1:-1]:
        x = np.array([angle, rng.normal(), 3.0 * rng.normal()])
        m, energy = np.array([np.sign(x[1])]), np.zeros(3)
        model.module.energy(0.0, x, np.zeros(1), p, m, energy)
        assert energy[2] >= 0.0
