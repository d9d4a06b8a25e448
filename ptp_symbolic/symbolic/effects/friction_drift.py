"""Dry friction that rises or falls from the beginning of a log on, as a gear runs in or warms up.

No thermometer tells: the share by which Coulomb and static torque have changed is an exponential of
the time of the log. It begins anew at time zero of every log, so that one which starts with a warm
machine has an amount of its own. Assumed: the drift goes with time, not with the work done.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.mechanics.kinematics import TIME

PARAMETERS = (
    Parameter(
        "a_drift_{axis}",
        "1",
        0.0,
        -0.95,
        10.0,
        "share by which dry friction has risen in the end",
        vanishes=0.0,
        starts=(-0.2, 0.2),
    ),
    Parameter(
        "t_drift_{axis}",
        "s",
        30.0,
        1e-2,
        1e5,
        "time constant of the drift of dry friction",
        starts=(5.0, 60.0),
    ),
)


def _contribute(place: Place) -> Contribution:
    share, time = place.symbols(PARAMETERS)
    drifted = Change(factor=1 + share * (1 - sp.exp(-TIME / time)))
    return Contribution(
        changes={f"{word}_torque_{place.axis}": drifted for word in ("coulomb", "static")}
    )


FRICTION_DRIFT = Effect(
    id="friction_drift",
    title="dry friction that drifts with time",
    reference="running-in; Czichos and Habig (2010), section 7: friction over time, first order",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("coulomb_torque_{axis}", "static_torque_{axis}"),
    separating_experiment="Repeat one slow move every few minutes for an hour, the motor at rest in"
    " between and then at work: friction that drifts with time falls in both alike.",
)
