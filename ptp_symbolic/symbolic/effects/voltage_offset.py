"""A drive that puts out a voltage although it is told to put out none."""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "u0_{axis}",
        "V",
        0.0,
        -1e3,
        1e3,
        "offset of the {axis} drive's voltage",
        vanishes=0.0,
        starts=(-0.3, 0.3),
    ),
)


def _contribute(place: Place) -> Contribution:
    offset = place.parameter("u0_{axis}")
    return Contribution(changes={f"motor_voltage_{place.axis}": Change(addition=offset)})


VOLTAGE_OFFSET = Effect(
    id="voltage_offset",
    title="offset of the drive's voltage",
    reference="offset of the power amplifier, in series with thesis Eq. 3.10",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("motor_voltage_{axis}",),
    separating_experiment="Swap the motor leads and repeat: an offset of the drive turns with"
    " them, a torque on the joint does not; or read the open terminals at zero command.",
)
