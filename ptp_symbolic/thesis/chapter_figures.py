"""The figures of the thesis that can be recomputed, chapter by chapter."""

from collections.abc import Callable, Mapping

import numpy as np
from matplotlib.axes import Axes

from ptp_symbolic.thesis import printed, ramp_test, rigid, tilt_drive
from ptp_symbolic.thesis.chapter_2_figures import backlash_figures, friction_figures
from ptp_symbolic.thesis.figures import Line, ThesisFigure, panel
from ptp_symbolic.thesis.friction import (
    duty_and_torque,
    estimated,
    mean_friction,
    steady_friction,
)
from ptp_symbolic.thesis.items import Kind
from ptp_symbolic.thesis.response_figures import response_figures

# End in s of the curves of the rigid platform.
SHOWN = 10.0


def _friction_map() -> list[Line]:
    speeds = np.linspace(0.002, 0.55, 500)
    direct = mean_friction("positive")
    apparent = np.array([duty_and_torque(s, direct)[1] for s in speeds])
    lines = [
        Line(
            rf"PWM drive, Table 4.1, $\omega$ {sign} 0",
            speeds,
            steady_friction(speeds, estimated(direction)),
        )
        for direction, sign in zip(printed.DIRECTIONS, "><", strict=True)
    ]
    lines.append(Line("DC drive, mean of Table 4.2", speeds, steady_friction(speeds, direct)))
    return [*lines, Line("DC friction times duty at 24 V", speeds, apparent)]


def _ramp_fit() -> list[Line]:
    found = ramp_test.estimates("positive")[0].x
    data = ramp_test.measured_angle(printed.TABLE_4_2["positive"][0])
    model = ramp_test.model_angle(found, printed.APPENDIX_C_MOTOR_INERTIA)
    return [
        Line("data made from test 1", ramp_test.TIMES, data),
        Line("fitted model", ramp_test.TIMES, model),
    ]


def _ramp_residual() -> list[Line]:
    data, model = _ramp_fit()
    return [Line("", data.x, (data.y - model.y) / ramp_test.COUNT)]


def _inertia_profile(axes: Axes) -> None:
    inertia, residual = ramp_test.inertia_profile().T
    axes.axvspan(
        printed.APPENDIX_C_LOWER[0],
        printed.APPENDIX_C_UPPER[0],
        color="#f0d9c8",
        label="bounds of Appendix C",
    )
    curve = Line("residual", inertia, residual, samples=True)
    panel("J in kg m$^2$", "rms residual in counts", lambda: [curve])(axes)
    axes.set_ylim(0.0, 0.25)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderpad=0.1)


def estimation_figures() -> list[ThesisFigure]:
    """Chapter 4: friction map, ramp fit, profile of the inertia."""
    return [
        ThesisFigure(
            "fig_4_3",
            "Steady friction against speed (Fig. 4.3), Table 4.1 as recovered, and the PWM duty.",
            (panel("speed in rad/s", "friction torque in N m", _friction_map),),
            Kind.ROUND_TRIP,
        ),
        ThesisFigure(
            "fig_4_6",
            "Ramp test of section 4.3 (Fig. 4.6): data made from the printed row of test 1, and the"
            " model fitted to them; below, their difference.",
            (
                panel("time in s", "pan angle in rad", _ramp_fit),
                panel("time in s", "residual in counts", _ramp_residual),
            ),
            Kind.ROUND_TRIP,
        ),
        ThesisFigure(
            "fig_4_6_profile",
            "Ramp test: residual against the inertia that is fixed,"
            " everything else refitted (erratum 16).",
            (_inertia_profile,),
            Kind.ROUND_TRIP,
        ),
    ]


def _ideal(axis: str, start: float = 0.0) -> Callable[[], list[Line]]:
    shown = (start <= rigid.TIMES) & (rigid.TIMES <= SHOWN)
    return lambda: [Line(axis, rigid.TIMES[shown], getattr(rigid.ideal(), axis)[shown])]


def _payload(axis: str) -> Callable[[], list[Line]]:
    shown = rigid.TIMES <= SHOWN
    return lambda: [
        Line(
            f"payload at {name} m", rigid.TIMES[shown], getattr(rigid.payload(offset), axis)[shown]
        )
        for name, offset in rigid.OFFSETS.items()
    ]


def _held() -> list[Line]:
    runs = [(angle, rigid.held_tilt(angle)) for angle in rigid.TILT_ANGLES_DEG]
    return [Line(f"tilt at {angle:.0f} deg", run.t, run.pan) for angle, run in runs]


def ideal_figures() -> list[ThesisFigure]:
    """Section 5.1."""
    late = printed.IDEAL_MOTION["pan"].t1
    both = panel("time in s", "torque in N m", lambda: [*_ideal("pan")(), *_ideal("tilt")()])
    return [
        *(
            ThesisFigure(
                f"fig_5_{number}",
                f"{axis.capitalize()} torque of the ideal platform along Table 5.2 (Fig."
                f" 5.{number}); below, the coupling after both transitions.",
                tuple(
                    panel("time in s", f"{axis} torque in N m", _ideal(axis, start))
                    for start in (0.0, late)
                ),
            )
            for number, axis in ((1, "pan"), (2, "tilt"))
        ),
        ThesisFigure("fig_5_3", "Pan and tilt torque of the ideal platform (Fig. 5.3).", (both,)),
    ]


def payload_figures() -> list[ThesisFigure]:
    """Section 5.2."""
    return [
        *(
            ThesisFigure(
                f"fig_5_{number}",
                f"{axis.capitalize()} torque with the payload along Table 5.4 (Fig. 5.{number});"
                " Table 5.3 prints 0.01 m (erratum 18).",
                (panel("time in s", f"{axis} torque in N m", _payload(axis)),),
            )
            for number, axis in ((4, "pan"), (5, "tilt"))
        ),
        ThesisFigure(
            "fig_5_6",
            "Pan torque for two pulses of pan rate, the tilt axis fixed (Fig. 5.6)."
            " Pulses and angles are chosen here; the thesis does not print them.",
            (panel("time in s", "pan torque in N m", _held),),
        ),
    ]


def tilt_figures() -> list[ThesisFigure]:
    """Section 5.3."""
    rows = (
        ("fig_5_9", "Stroke speed (Fig. 5.9)", "stroke speed in mm/s", "stroke_speed", 1e3),
        ("fig_5_10", "Actuator force (Fig. 5.10)", "actuator force in N", "force", 1.0),
        ("fig_5_11", "Motor current (Fig. 5.11)", "motor current in A", "current", 1.0),
        (
            "fig_5_12",
            "Tilt rate (Figs. 5.12, 5.13)",
            "tilt rate in deg/s",
            "tilt_rate",
            float(np.degrees(1.0)),
        ),
        (
            "fig_5_14",
            "Tilt angle (Fig. 5.14)",
            "tilt angle in deg",
            "tilt_angle",
            float(np.degrees(1.0)),
        ),
    )

    def lines(quantity: str, factor: float) -> Callable[[], list[Line]]:
        return lambda: [
            Line(
                f"initial stroke {name} mm",
                (run := tilt_drive.trapezoid_run(name)).t,
                factor * getattr(run, quantity),
            )
            for name in tilt_drive.PRESETS
        ]

    def apart(quantity: str, factor: float) -> float:
        one, other = (
            factor * getattr(tilt_drive.trapezoid_run(s), quantity) for s in tilt_drive.PRESETS
        )
        return float(np.max(np.abs(one - other)))

    return [
        ThesisFigure(
            name,
            f"{title} of the tilt drive under the 24 V trapezoid, c.g. above the axis; the strokes"
            f" differ by at most {apart(quantity, factor):.1g} {label.partition(' in ')[2]}.",
            (panel("time in s", label, lines(quantity, factor)),),
        )
        for name, title, label, quantity, factor in rows
    ]


def all_figures() -> Mapping[str, list[ThesisFigure]]:
    """Every figure by the chapter or section it belongs to."""
    return {
        "Friction (2.3.2.1)": friction_figures(),
        "Backlash (2.3.2.2)": backlash_figures(),
        "Estimation (chapter 4)": estimation_figures(),
        "Rigid platform (5.1, 5.2)": [*ideal_figures(), *payload_figures()],
        "Tilt drive (5.3)": tilt_figures(),
        "Pan drive (5.4)": response_figures(),
    }
