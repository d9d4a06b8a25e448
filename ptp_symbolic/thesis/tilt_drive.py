"""Section 5.3: the tilt drive of the packaged presets under 24 V (Figs. 5.9-5.14).

The motion is the simulation of the emitted model. Stroke, actuator force and screw are read from it
with the linkage, the screw and the joint's equation of the derivation, so nothing is typed twice.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

import ptp_symbolic
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import InputSignal, constant, trapezoid
from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanisms.linkage import Linkage
from ptp_symbolic.symbolic.mechanisms.screw import Screw
from ptp_symbolic.symbolic.symbols import real
from ptp_symbolic.thesis.items import Item, unprinted
from ptp_symbolic.thesis.printed import SUPPLY_VOLTAGE

FloatArray = NDArray[np.float64]
Function = Callable[..., Any]

# The two initial strokes of Table 5.6 in mm (erratum 19), and the presets that hold them.
PRESETS = {"40.5": "thesis-tilt-drive", "48.5": "thesis-tilt-drive-stroke-48"}
# The thesis prints the level of the trapezoid alone; its edges here are those of section 5.4.3.
TRAPEZOID = trapezoid(SUPPLY_VOLTAGE, 0.5, 2.5, 0.5)
NO_VOLTAGE = constant(0.0)
TIMES = np.linspace(0.0, 5.0, 5_001)
RTOL, ATOL = 1e-10, 1e-12
# Forces in N below this do not count as pushing or pulling, and times in s are located to this.
LEAST_FORCE = 1e-3
TIME_TOLERANCE = 1e-10
# Where the centre of mass lies at tilt angle zero, as unit vector (x, z) of the tilt frame.
COM_DIRECTIONS = {
    "above": (0.0, 1.0),
    "ahead": (1.0, 0.0),
    "below": (0.0, -1.0),
    "behind": (-1.0, 0.0),
}


@dataclass(frozen=True, eq=False)
class Actuator:
    """Functions of tilt angle in rad and rate in rad/s, from the derivation at a preset's values.

    `stroke` in m and `lever` in m (stroke speed per tilt rate, negative) of the angle; `others` in
    N m, the torque on the joint that is not the actuator's; `inertia` in kg m^2 of what turns with
    the joint. The screw takes `raising` and `lowering` in m, torque per force.
    """

    stroke: Function
    lever: Function
    lever_slope: Function
    others: Function
    inertia: float
    raising: float
    lowering: float


@dataclass(frozen=True, eq=False)
class TiltRun:
    """Figs. 5.9 to 5.14: t [k] in s, stroke and speed in m and m/s, force in N, current in A,
    tilt rate and angle in rad/s and rad, each [k].
    """

    t: FloatArray
    stroke: FloatArray
    stroke_speed: FloatArray
    force: FloatArray
    current: FloatArray
    tilt_rate: FloatArray
    tilt_angle: FloatArray


@cache
def model(name: str) -> Model:
    """The emitted model that starts at the stroke `name` of PRESETS."""
    return ptp_symbolic.load(PRESETS[name])


def com_offset(name: str) -> float:
    """Distance in m of the centre of mass from the tilt axis."""
    values = model(name).defaults
    return float(np.hypot(values["c_x_payload"], values["c_z_payload"]))


def placed(name: str, direction: str) -> dict[str, float]:
    """Parameters that put the centre of mass in a direction of COM_DIRECTIONS, as far off."""
    x, z = COM_DIRECTIONS[direction]
    return {"c_x_payload": x * com_offset(name), "c_z_payload": z * com_offset(name)}


@cache
def actuator(name: str, direction: str = "above") -> Actuator:
    """The actuator of a preset of PRESETS, the centre of mass in a direction of COM_DIRECTIONS."""
    values = model(name).defaults | placed(name, direction)
    numbers = {real(parameter): value for parameter, value in values.items()}
    angle, rate = kinematics.angle("tilt"), kinematics.rate("tilt")
    named = dict(assemble(read_platform(PRESETS[name])).terms)
    others, inertia = (named[real(f"load_{what}_tilt")] for what in ("torque", "inertia"))
    linkage = Linkage(
        *(real(f"{length}_tilt") for length in ("l_ground", "l_min", "r_arm", "s_start"))
    )
    screw = Screw(*(real(f"{what}_tilt") for what in ("lead", "d_screw", "f_screw")))
    lever = linkage.ratio(angle)

    def function(expression: sp.Expr, *arguments: sp.Symbol) -> Function:
        return sp.lambdify(arguments, expression.subs(numbers), modules="numpy")

    return Actuator(
        function(linkage.stroke(angle), angle),
        function(lever, angle),
        function(lever.diff(angle), angle),
        function(others, angle, rate),
        float(inertia.subs(numbers)),
        float(screw.raising.subs(numbers)),
        float(screw.lowering.subs(numbers)),
    )


def deviation(name: str, stroke: float | None = None) -> float:
    """Angle theta of Fig. 3.13 in rad between link and the perpendicular of the actuator.

    At a `stroke` in m, None for the initial one; negative where the arm has yet to reach the
    perpendicular.
    """
    machine, arm = actuator(name), model(name).defaults["r_arm_tilt"]
    lower, upper = model(name).domain(model(name).parameter_vector())[0]
    angle = 0.0
    if stroke is not None:
        angle = float(brentq(lambda a: machine.stroke(a) - stroke, lower, upper))
    size = float(np.arccos(min(1.0, abs(machine.lever(angle)) / arm)))
    # the lever, negative, is longest on the perpendicular, and a growing stroke lowers the angle
    return float(np.copysign(size, -machine.lever_slope(angle)))


def simulate_tilt_drive(
    name: str,
    times: FloatArray = TIMES,
    direction: str = "above",
    voltage: InputSignal = TRAPEZOID,
) -> TiltRun:
    """The tilt drive from rest at tilt angle zero, output at `times` [k] in s.

    `name` of PRESETS; `direction` of COM_DIRECTIONS tells where the centre of mass lies.
    """
    drive, machine, changes = model(name), actuator(name, direction), placed(name, direction)
    found = ptp_symbolic.simulate(
        drive, times, {"u_tilt": voltage}, changes, rtol=RTOL, atol=ATOL, ledger=False
    )
    p, still = drive.parameter_vector(changes), np.zeros(1)
    # the voltage acts on the current alone, so the acceleration is that of any voltage
    slopes = [drive.rhs(t, x, still, p) for t, x in zip(found.t, found.x, strict=True)]
    angle, rate = found["theta_tilt"], found["omega_tilt"]
    acceleration = np.array(slopes)[:, drive.state_names.index("omega_tilt")]
    lever = machine.lever(angle)
    needed = machine.inertia * acceleration - machine.others(angle, rate)
    return TiltRun(
        found.t,
        machine.stroke(angle),
        lever * rate,
        needed / lever,
        found["i_tilt"],
        rate,
        angle,
    )


@cache
def trapezoid_run(name: str, direction: str = "above") -> TiltRun:
    """The run of Figs. 5.9 to 5.14 at TIMES."""
    return simulate_tilt_drive(name, direction=direction)


def _at(name: str, direction: str, quantity: str) -> Callable[[float], float]:
    """A quantity of TiltRun as a function of time in s, each time simulated up to there."""

    def value(t: float) -> float:
        run = simulate_tilt_drive(name, np.array([0.0, t]), direction)
        return float(getattr(run, quantity)[-1])

    return value


def reversal(name: str, direction: str = "above") -> float | None:
    """Time in s at which the force, positive at first, changes its sign; None where it does not."""
    run = trapezoid_run(name, direction)
    acting = np.abs(run.force) > LEAST_FORCE
    negative = np.flatnonzero(run.force < -LEAST_FORCE)
    if not len(negative) or run.force[np.argmax(acting)] <= 0.0:
        return None
    after = negative[0]
    before = np.flatnonzero(run.force[:after] > LEAST_FORCE)[-1]
    return float(
        brentq(
            _at(name, direction, "force"),
            run.t[before],
            run.t[after],
            xtol=TIME_TOLERANCE,
        )
    )


def extremum(name: str, quantity: str, sign: float = 1.0) -> tuple[float, float]:
    """Time in s and value of the largest `sign` times a quantity of TiltRun, in its unit."""
    run, value = trapezoid_run(name), _at(name, "above", quantity)
    k = int(np.argmax(sign * getattr(run, quantity)))
    found = minimize_scalar(
        lambda t: -sign * value(t),
        bounds=(run.t[max(k - 1, 1)], run.t[min(k + 1, len(run.t) - 1)]),
        method="bounded",
        options={"xatol": TIME_TOLERANCE},
    )
    return float(found.x), -sign * float(found.fun)


def run_items(name: str) -> list[Item]:
    """What Figs. 5.9 to 5.14 show, for one of the two printed strokes."""
    run = trapezoid_run(name)
    peak_time, peak = extremum(name, "current")
    check = (
        f"simulation of {PRESETS[name]} (Tables 5.5 and 5.6, Eq. 3.12), c.g. above the axis"
        " (erratum 24); trapezoid 0.5 s up, 2.5 s at 24 V, 0.5 s down (edges not printed);"
        " reversal and extrema located in time; the thesis prints the curve alone"
    )
    rows: Mapping[str, tuple[str, float | None, str]] = {
        "largest_stroke_speed": ("fig_5_9", 1e3 * extremum(name, "stroke_speed")[1], "mm/s"),
        "largest_force": ("fig_5_10", extremum(name, "force")[1], "N"),
        "reversal_time": ("fig_5_10", reversal(name), "s"),
        "final_force": ("fig_5_10", float(run.force[-1]), "N"),
        "largest_current": ("fig_5_11", peak, "A"),
        "largest_current_time": ("fig_5_11", peak_time, "s"),
        "largest_tilt_rate": (
            "fig_5_12",
            float(np.degrees(extremum(name, "tilt_rate", -1.0)[1])),
            "deg/s",
        ),
        "final_tilt_angle": ("fig_5_14", float(np.degrees(run.tilt_angle[-1])), "deg"),
    }
    return [
        unprinted(
            f"{figure}.{what}_stroke_{name}_mm",
            f"Fig. {figure[4:].replace('_', '.')}, {what.replace('_', ' ')}, stroke {name} mm",
            value,
            unit,
            check,
        )
        for what, (figure, value, unit) in rows.items()
    ]


def items() -> list[Item]:
    """All items of this file."""
    machine = actuator("40.5")
    screw = "Eq. 3.12 with Table 5.5, torque per force"
    return [
        *(item for name in PRESETS for item in run_items(name)),
        unprinted(
            "eq_3_12.raising", "Lead screw, torque per force, raising", machine.raising, "m", screw
        ),
        unprinted(
            "eq_3_12.lowering",
            "Lead screw, torque per force, lowering",
            machine.lowering,
            "m",
            screw,
        ),
        *(
            unprinted(
                f"fig_3_13.deviation_stroke_{name}_mm",
                f"Fig. 3.13, link from the perpendicular at stroke {name} mm",
                float(np.degrees(deviation(name))),
                "deg",
                "lever of the derived linkage over the length of the arm, Table 5.6",
            )
            for name in PRESETS
        ),
    ]
