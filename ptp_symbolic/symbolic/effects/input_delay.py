"""A command that reaches the machine late."""

from ptp_symbolic.symbolic.effects.effect import Contribution, Effect, Place
from ptp_symbolic.symbolic.parameters import Parameter

PARAMETERS = (
    Parameter(
        "t_delay_{axis}",
        "s",
        0.0,
        0.0,
        1.0,
        "delay of the {axis} input",
        vanishes=0.0,
        starts=(0.002,),
    ),
)


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return tuple(p.at_axis(place.axis) for p in PARAMETERS)


def _contribute(place: Place) -> Contribution:
    return Contribution(delays={place.own_axis: place.parameter("t_delay_{axis}")})


INPUT_DELAY = Effect(
    id="input_delay",
    title="delay of the input",
    reference="Franklin, Powell and Workman (1998), section 4: delay of a sampled input",
    parameters=_parameters,
    contribute=_contribute,
    separating_experiment="Loop the command back into the logger, or excite with a 10 to 40 Hz"
    " chirp: the phase of a delay is a straight line over frequency, a compliance resonates.",
)
