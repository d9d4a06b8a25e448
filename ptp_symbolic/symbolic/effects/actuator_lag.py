"""An actuator of first order: its torque or voltage lags the command, as behind a current loop or
an amplifier.

What comes out is a state that begins at zero; the ledger counts it, not the command, as supplied.
"""

from collections.abc import Callable
from dataclasses import replace

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Structure
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import real

PARAMETERS = (
    Parameter(
        "t_actuator_{axis}",
        "s",
        5e-3,
        1e-5,
        10.0,
        "time constant of the {axis} actuator",
        starts=(2e-3, 2e-2),
    ),
)


def _lag(
    before: str, after: str, state: str, word: str, unit: str
) -> Callable[[Place], Contribution]:
    """The quantity `after` follows `before` with one time constant."""

    def contribute(place: Place) -> Contribution:
        (time,) = place.symbols(PARAMETERS)
        output = real(f"{state}_actuator_{place.axis}")
        rate = (place.quantity(f"{before}_{{axis}}") - output) / time
        return Contribution(
            changes={f"{after}_{place.axis}": Change(through=lambda _: output)},
            states=(State(output.name, unit, f"{word} of the {place.axis} actuator", rate),),
        )

    return contribute


ACTUATOR_LAG = Effect(
    id="actuator_lag",
    kind="torque",
    title="actuator behind a lag of first order",
    reference="equivalent time constant of a closed current loop; Leonhard (2001), section 7",
    parameters=PARAMETERS,
    contribute=_lag("command_torque", "input_torque", "tau", "torque", "N m"),
    structural=True,
    needs=("input_torque_{axis}",),
    structure=Structure(needs=("input_torque_{axis}",)),
    separating_experiment="Step the command by two sizes: behind a lag the torque sets out at once"
    " and settles as an exponential of one time constant at both, a delay shifts the whole"
    " response, a ceiling caps the larger step alone.",
)
VOLTAGE_LAG = replace(
    ACTUATOR_LAG,
    kind="voltage",
    title="amplifier behind a lag of first order",
    contribute=_lag("drive_voltage", "amplifier_voltage", "u", "voltage", "V"),
    needs=("amplifier_voltage_{axis}",),
    structure=Structure(needs=("amplifier_voltage_{axis}",)),
    separating_experiment="Step the command and log the voltage at the motor: it settles as an"
    " exponential; a delay shifts the whole step.",
)
ACTUATOR_LAG = replace(ACTUATOR_LAG, kinds=(VOLTAGE_LAG,))
