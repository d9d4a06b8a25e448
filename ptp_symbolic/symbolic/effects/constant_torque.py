"""A constant torque on a joint: mean wind, a counterweight, a pulling cable."""

from ptp_symbolic.symbolic.effects.effect import Contribution, Effect, Place
from ptp_symbolic.symbolic.parameters import Parameter

TORQUE = Parameter(
    "tau0_{axis}",
    "N m",
    0.0,
    -1e4,
    1e4,
    "constant torque on the {axis} joint",
    vanishes=0.0,
    starts=(-0.3, 0.3),
)


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return (TORQUE.at_axis(place.axis),)


def _contribute(place: Place) -> Contribution:
    return Contribution(torques={place.rate: place.parameter("tau0_{axis}")})


CONSTANT_TORQUE = Effect(
    id="constant_torque",
    title="constant torque on the joint",
    reference="wind mean or preload; thesis section 1.2 names the outdoor load",
    parameters=_parameters,
    contribute=_contribute,
    separating_experiment="Drive the same speeds in both directions with the motor leads swapped:"
    " a torque on the joint keeps its sign, an electrical offset turns with the leads.",
)
