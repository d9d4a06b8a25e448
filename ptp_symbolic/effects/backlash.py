"""Free play between gear output and load: a dead zone in the shaft's twist."""

from ptp_symbolic.effects.effect import Change, Contribution, Effect, Place
from ptp_symbolic.parameters import Parameter

GAP = Parameter(
    "gap_{axis}", "rad", 0.026005, 0.0, 1.0, "whole gap between the two faces",
    vanishes=0.0, starts=(0.005, 0.02),
)  # fmt: skip


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return (GAP.at_axis(place.axis),)


def _contribute(place: Place) -> Contribution:
    half = place.parameter("gap_{axis}") / 2
    return Contribution(changes={f"half_gap_{place.axis}": Change(addition=half)})


BACKLASH = Effect(
    id="backlash",
    title="backlash",
    reference="thesis Eq. 2.16 (dead zone), Table 5.7; contact that cannot pull",
    parameters=_parameters,
    contribute=_contribute,
    needs=("half_gap_{axis}",),
    separating_experiment="Reverse slowly with and without a known preload torque on the joint:"
    " backlash disappears under preload, presliding does not.",
)
