"""An actuator whose torque ends at a ceiling."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "tau_max_{axis}",
        "N m",
        1e6,
        1e-6,
        1e6,
        "largest torque of the {axis} actuator",
        vanishes=1e6,
        starts=(0.5, 5.0),
    ),
)


def _contribute(place: Place) -> Contribution:
    largest = place.parameter("tau_max_{axis}")

    def through(torque: sp.Expr) -> sp.Expr:
        return sp.Max(sp.Min(torque, largest), -largest)

    return Contribution(changes={f"command_torque_{place.axis}": Change(through=through)})


TORQUE_SATURATION = Effect(
    id="torque_saturation",
    title="actuator whose torque ends at a ceiling",
    reference="saturation of the current loop; Leonhard (2001), section 5 (limited reference)",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("command_torque_{axis}",),
    separating_experiment="Lock the joint on a torque sensor and raise the command: beyond the"
    " ceiling the torque stays.",
)
