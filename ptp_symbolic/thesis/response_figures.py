"""The figures of the pan drive in section 5.4."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.thesis import contact, responses
from ptp_symbolic.thesis.figures import Line, ThesisFigure, panel
from ptp_symbolic.thesis.friction import drive_values

FloatArray = NDArray[np.float64]

# Start and end in s of the parts of the responses in which the load rings on its shaft.
RINGING = {"step": (1.75, 2.25), "slow_ramp": (0.6, 1.2), "trapezoid": (0.0, 0.6)}


def friction_of(run: responses.Trajectory) -> FloatArray:
    """Friction torque [k] in N m at the gear, at rest as well: what the emitted pan drive would
    accelerate with without friction, less what it does.
    """
    model, p = responses.pan_drive(), drive_values()
    rate = model.state_names.index("omega_gear_pan")
    # the voltage acts on the current alone
    still = np.zeros(len(model.input_names))
    given = responses.as_printed()
    without = given | {name: 0.0 for name in ("F_c_pan", "F_s_pan", "F_v_pan")}
    free, held = (
        np.array([model.rhs(0.0, x, still, vector)[rate] for x in run.x])
        for vector in map(model.parameter_vector, (without, given))
    )
    return p["J_motor_pan"] * p["N_pan"] ** 2 * (free - held)


def _angles(name: str) -> Callable[[], list[Line]]:
    shown = {
        "Table 4.1": None,
        "DC friction": "dc_friction",
        "no joint friction": "without_joint_friction",
    }
    return lambda: [
        Line(label, (run := responses.response(name, variant)).t, run["theta_pan"])
        for label, variant in shown.items()
    ]


def _rates(name: str) -> Callable[[], list[Line]]:
    """Rates of load and motor where they differ."""

    def make() -> list[Line]:
        run = responses.response(name)
        start, end = RINGING.get(name, (run.t[0], run.t[-1]))
        shown = (run.t >= start) & (run.t <= end)
        return [
            Line("load", run.t[shown], run["omega_pan"][shown]),
            Line("motor at the gear output", run.t[shown], run["omega_gear_pan"][shown]),
        ]

    return make


def _friction(name: str) -> Callable[[], list[Line]]:
    return lambda: [Line("", (run := responses.response(name)).t, friction_of(run))]


def _ringing() -> list[Line]:
    return [
        Line(rf"tolerance $10^{{{round(np.log10(tolerance))}}}$", times, 1e3 * twist)
        for tolerance in (1e-9, 1e-4)
        for times, twist in (contact.twist_after_step(tolerance, gap_pan=0.0),)
    ]


def response_figures() -> list[ThesisFigure]:
    """Section 5.4."""
    seconds = "time in s"
    return [
        *(
            ThesisFigure(
                f"fig_{number.replace('.', '_')}",
                f"Pan drive, {name.replace('_', ' ')} input (Fig. {number}): angle with friction"
                " of Table 4.1, with the mean of Table 4.2 (DC friction, erratum 21) and without"
                " the friction of the joint (erratum 23); with Table 4.1, rates"
                f"{' while the load rings on its shaft' if name in RINGING else ''}, and friction"
                " at the gear output.",
                (
                    panel(seconds, "pan angle in rad", _angles(name)),
                    panel(seconds, "rate in rad/s", _rates(name)),
                    panel(seconds, "friction in N m", _friction(name)),
                ),
            )
            for name, number in responses.FIGURES.items()
        ),
        ThesisFigure(
            "fig_5_15_ringing",
            "Shaft twist after a step of 24 V without a gap: the oscillation"
            " does not depend on the tolerance (erratum 25).",
            (panel(seconds, "shaft twist in mrad", _ringing),),
        ),
    ]
