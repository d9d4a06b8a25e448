"""An encoder at the motor: it shows the gear output, not the joint behind a shaft."""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import Place


def _contribute(place: Place) -> Contribution:
    apart = place.gear_angle - place.angle
    return Contribution(changes={f"reading_{place.angle}": Change(addition=apart)})


MOTOR_ENCODER = Effect(
    id="motor_encoder",
    title="encoder at the motor",
    reference="collocated sensing: Spong (1987), section 2; De Luca and Book (2016), 11.1",
    parameters=(),
    contribute=_contribute,
    structural=True,
    separating_experiment="Lock the motor and push the joint: an encoder there shows nothing.",
)
