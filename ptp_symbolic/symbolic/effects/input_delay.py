"""A command that reaches the machine late."""

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

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


def _contribute(place: Place) -> Contribution:
    return Contribution(delays={place.own_axis: place.parameter("t_delay_{axis}")})


INPUT_DELAY = Effect(
    id="input_delay",
    title="delay of the input",
    reference="Franklin, Powell and Workman (1998), section 4: delay of a sampled input",
    parameters=PARAMETERS,
    contribute=_contribute,
    separating_experiment="Loop the command back into the logger, or excite with a 10 to 40 Hz"
    " chirp: the phase of a delay is a straight line over frequency, a compliance resonates.",
)
