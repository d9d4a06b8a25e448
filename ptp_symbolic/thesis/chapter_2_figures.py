"""The figures of friction and backlash in chapter 2, drawn from the emitted effects."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes

from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.thesis import backlash_laws, friction_laws
from ptp_symbolic.thesis.backlash_laws import HALF_GAP, HYSTERESIS_TIMES, IMPACT_RATE
from ptp_symbolic.thesis.figures import GREY, Line, Panel, ThesisFigure, draw_lines, panel
from ptp_symbolic.thesis.friction import drive_values

SPEED, TORQUE, SECONDS = "rate in rad/s", "friction torque in N m", "time in s"
# Rates in rad/s up to which the laws are drawn, and the presliding levels of Fig. 2.9.
FASTEST, SLOWEST = 0.3, 1e-5
PRESLIDING_SHARES = (0.5, 0.95)
TABLE = "friction of Table 4.2"


def _both_ways(**changes: float) -> list[Line]:
    """A steady friction law over both directions, with the torques that hold at rest."""
    values = friction_laws.dry_values(**changes)
    forward = np.geomspace(SLOWEST, FASTEST, 300)
    rates = np.concatenate([-forward[::-1], forward])
    friction = friction_laws.sliding_friction(rates, values)
    holds = friction_laws.breakaway_torque(values)
    middle = len(forward)
    return [
        Line(
            "",
            np.insert(rates, middle, [0.0, 0.0]),
            np.insert(friction, middle, [-holds, holds]),
        )
    ]


def _law(**changes: float) -> Panel:
    return panel(SPEED, TORQUE, partial(_both_ways, **changes))


def _breakaway() -> list[Line]:
    return [Line("", friction_laws.TORQUE_RATES, friction_laws.breakaway_by_rate(), samples=True)]


def _regimes(axes: Axes) -> None:
    """The Stribeck curve on a logarithmic rate, with the ends of its regimes."""
    rates = np.geomspace(1e-3, 1.0, 300)
    values = friction_laws.dry_values()
    curve = Line("", rates, friction_laws.sliding_friction(rates, values))
    panel(SPEED, TORQUE, lambda: [curve], logarithmic=True)(axes)
    least, _ = friction_laws.stribeck_minimum()
    ends = [rates[0], 0.5 * values["v_s_pan"], least, rates[-1]]
    names = ("II boundary lubrication", "III partial lubrication", "IV full film")
    for name, low, high in zip(names, ends, ends[1:], strict=False):
        axes.text(
            np.sqrt(low * high), 1.02, name, transform=axes.get_xaxis_transform(), ha="center"
        )
    for end in ends[1:-1]:
        axes.axvline(end, color=GREY, linestyle=":")
    axes.scatter(
        rates[0], friction_laws.breakaway_torque(values), marker="<", color="black", clip_on=False
    )
    axes.annotate(
        "I stiction, up to here",
        (rates[0], friction_laws.breakaway_torque(values)),
        xytext=(8, 6),
        textcoords="offset points",
    )


def _presliding() -> list[Line]:
    lines = []
    for share in PRESLIDING_SHARES:
        angle, friction = friction_laws.presliding(share)
        lines.append(Line(f"torque to {100 * share:.0f} % of F$_s$", 1e3 * angle, friction))
    return lines


def _stick_slip_ways() -> list[Line]:
    run = friction_laws.stick_slip()
    free_end = friction_laws.DRAWING_SPEED * run.t
    return [Line("free end of the spring", run.t, free_end), Line("body", run.t, run["theta_pan"])]


def _stick_slip_rate() -> list[Line]:
    run = friction_laws.stick_slip()
    return [Line("", run.t, run["omega_pan"])]


def _lag() -> list[Line]:
    lines = []
    for frequency in friction_laws.LAG_FREQUENCIES:
        rate, friction = friction_laws.frictional_lag(frequency)
        lines.append(Line(f"{frequency:g} Hz", rate, friction))
    slowest = friction_laws.LAG_MEAN - friction_laws.LAG_SWING
    rates = np.linspace(slowest, friction_laws.LAG_MEAN + friction_laws.LAG_SWING)
    steady = friction_laws.sliding_friction(rates, friction_laws.dry_values())
    return [*lines, Line("steady", rates, steady)]


def _bend() -> list[Line]:
    run = friction_laws.bristle_bend()
    return [
        Line("bend of the bristles", run.t, 1e3 * run["bristle_pan"]),
        Line("angle of the body", run.t, 1e3 * run["theta_pan"]),
    ]


def _bend_panel(axes: Axes) -> None:
    draw_lines(axes, _bend())
    bend = friction_laws.bristle_bend()["bristle_pan"]
    axes.set(xlabel=SECONDS, ylabel="angle in mrad", ylim=(0.0, 2.5e3 * float(np.max(bend))))


def friction_figures() -> list[ThesisFigure]:
    """Figs. 2.7 to 2.16."""
    f = friction_laws.dry_values()
    chosen = "chosen here; the thesis prints no numbers"
    rows: Sequence[tuple[str, str, tuple[Panel, ...]]] = (
        (
            "fig_2_7",
            "Breakaway torque against the rate of the applied torque (Fig. 2.7): simulated ramps on"
            f" a body whose breakaway torque grows by {friction_laws.REST_GROWTH:g} per e-fold of"
            f" the rest beyond {friction_laws.REST_TIME:g} s ({chosen}).",
            (
                panel(
                    "torque rate in N m/s", "breakaway torque in N m", _breakaway, logarithmic=True
                ),
            ),
        ),
        (
            "fig_2_8",
            f"Stribeck curve with its regimes (Fig. 2.8), {TABLE}; regime II is drawn up to half"
            " the Stribeck speed, regime IV from the least friction on.",
            (_regimes,),
        ),
        (
            "fig_2_9",
            "Friction before sliding (Fig. 2.9): LuGre friction while the torque goes up and down,"
            f" bristles of {friction_laws.BRISTLE_STIFFNESS:g} N m/rad ({chosen}).",
            (panel("angle in mrad", TORQUE, _presliding),),
        ),
        (
            "fig_2_10",
            f"Stick-slip (Fig. 2.10): a body drawn by a spring of {friction_laws.SPRING:g} N m/rad"
            f" whose free end moves with {friction_laws.DRAWING_SPEED:g} rad/s ({chosen}),"
            f" {TABLE}.",
            (
                panel(SECONDS, "angle in rad", _stick_slip_ways),
                panel(SECONDS, SPEED, _stick_slip_rate),
            ),
        ),
        (
            "fig_2_11",
            "Frictional lag (Fig. 2.11): LuGre friction over one period of a rate that swings with"
            " three frequencies; friction is higher while the rate grows.",
            (panel(SPEED, TORQUE, _lag),),
        ),
        (
            "fig_2_12",
            "Coulomb friction (Fig. 2.12), F_c of Table 4.2: sign(v) is the signum (erratum 1)."
            " The vertical line covers the torques that keep the body at rest.",
            (_law(F_s_pan=f["F_c_pan"], F_v_pan=0.0),),
        ),
        (
            "fig_2_13",
            "Viscous friction (Fig. 2.13), F_v of Table 4.2.",
            (_law(F_c_pan=0.0, F_s_pan=0.0, F_v_pan=0.0, b_pan=f["F_v_pan"]),),
        ),
        (
            "fig_2_14",
            "Stribeck part of friction (Fig. 2.14), F_s - F_c of Table 4.2, with the sign of the"
            " rate (erratum 28).",
            (_law(F_c_pan=0.0, F_s_pan=f["F_s_pan"] - f["F_c_pan"], F_v_pan=0.0),),
        ),
        (
            "fig_2_15",
            f"Coulomb, static, viscous and Stribeck friction (Fig. 2.15), {TABLE}, with the sign of"
            " the rate (erratum 3).",
            (_law(),),
        ),
        (
            "fig_2_16",
            "Bristles (Fig. 2.16): their mean deflection follows the angle and stops growing"
            " where it slides; the torque grows to 110 % of F_s in 1 s.",
            (_bend_panel,),
        ),
    )
    return [ThesisFigure(name, caption, panels) for name, caption, panels in rows]


def _transmitted() -> list[Line]:
    reach = 1.5 * drive_values()["gap_pan"]
    twist = np.linspace(-reach, reach, 601)
    return [Line("", np.degrees(twist), backlash_laws.transmitted_torque(twist))]


def _angles_behind_gap() -> list[Line]:
    friction, inertia = (
        backlash_laws.hysteresis(f"hysteresis_{kind}") for kind in ("friction", "inertia")
    )
    times, shown = HYSTERESIS_TIMES, slice(None, None, 40)
    curves = {
        "held by friction, Eq. 2.17": friction["theta_pan"],
        "Eq. 2.18 as printed": backlash_laws.printed_inertia_driven(),
        "coasting, Eq. 2.18 with erratum 29": inertia["theta_pan"],
        "drive": friction["theta_gear_pan"],
    }
    return [Line(label, times[shown], curve[shown]) for label, curve in curves.items()]


def _loops() -> list[Line]:
    """Load against drive angle over the second period, when the loop has closed."""
    lines = []
    for kind, label in (("friction", "held by friction"), ("inertia", "coasting")):
        run = backlash_laws.hysteresis(f"hysteresis_{kind}")
        later = slice(len(run.t) // 2, None, 40)
        lines.append(Line(label, run["theta_gear_pan"][later], run["theta_pan"][later]))
    return lines


def _impacts(quantity: str, factor: float) -> Callable[[], list[Line]]:
    def make() -> list[Line]:
        runs: dict[str, Trajectory] = {
            "dead zone, undamped shaft": backlash_laws.sprung_impact(),
            "rigid faces, e = 1": backlash_laws.rigid_impact(1.0),
            "e = 0.5": backlash_laws.rigid_impact(0.5),
            "e = 0 (plastic)": backlash_laws.rigid_impact(0.0),
        }
        return [Line(label, 1e3 * run.t, factor * run[quantity]) for label, run in runs.items()]

    return make


def backlash_figures() -> list[ThesisFigure]:
    """Figs. 2.18 and 2.19, and the impact across the gap that sections 1.6 and 5.4.2 speak of."""
    return [
        ThesisFigure(
            "fig_2_18",
            "Torque that the pan drive transmits across its gap (Fig. 2.18), Table 5.7.",
            (panel("twist in deg", "shaft torque in N m", _transmitted),),
        ),
        ThesisFigure(
            "fig_2_18_impact",
            f"A load that turns with {IMPACT_RATE:g} rad/s in the gap of the pan drive, the motor"
            " at rest: behind the dead zone it comes back as fast as it came (erratum 26); rigid"
            " faces with three coefficients of restitution e beside it.",
            (
                panel("time in ms", "load angle in deg", _impacts("theta_pan", np.degrees(1.0))),
                panel("time in ms", "load rate in rad/s", _impacts("omega_pan", 1.0)),
            ),
        ),
        ThesisFigure(
            "fig_2_19",
            f"Load behind a gap of {2 * HALF_GAP:g} rad, drive angle sin(2 pi t) (Fig. 2.19): held"
            " by friction, coasting, and Eq. 2.18 as printed, which is Eq. 2.17 (erratum 29);"
            " below, the loops of the second period.",
            (
                panel(SECONDS, "angle in rad", _angles_behind_gap),
                panel("drive angle in rad", "load angle in rad", _loops),
            ),
        ),
    ]
