"""An actuator of first order: its torque lags the command, as behind a current loop.

The torque is a state that begins at zero; the ledger counts it, not the command, as supplied.
"""

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


def _contribute(place: Place) -> Contribution:
    (time,) = place.symbols(PARAMETERS)
    torque = real(f"tau_actuator_{place.axis}")
    rate = (place.quantity("command_torque_{axis}") - torque) / time
    return Contribution(
        changes={f"input_torque_{place.axis}": Change(through=lambda _: torque)},
        states=(State(torque.name, "N m", f"torque of the {place.axis} actuator", rate),),
    )


ACTUATOR_LAG = Effect(
    id="actuator_lag",
    title="actuator behind a lag of first order",
    reference="equivalent time constant of a closed current loop; Leonhard (2001), section 7",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
    needs=("input_torque_{axis}",),
    structure=Structure(needs=("input_torque_{axis}",)),
    separating_experiment="Step the command by two sizes: behind a lag the torque sets out at once"
    " and settles as an exponential of one time constant at both, a delay shifts the whole"
    " response, a ceiling caps the larger step alone.",
)
