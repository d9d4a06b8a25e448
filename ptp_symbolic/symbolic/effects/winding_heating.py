"""A motor winding whose resistance rises as it heats."""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import real

PARAMETERS = (
    Parameter(
        "k_heat_{axis}",
        "1/W",
        0.0,
        0.0,
        1e3,
        "relative rise of resistance per watt, settled",
        vanishes=0.0,
        starts=(0.05,),
    ),
    Parameter(
        "t_heat_{axis}",
        "s",
        30.0,
        1e-2,
        1e5,
        "thermal time constant of the winding",
        starts=(5.0, 60.0),
    ),
)


def _contribute(place: Place) -> Contribution:
    gain, time = place.symbols(PARAMETERS)
    heat = real(f"heat_{place.axis}")
    loss = place.quantity("winding_loss_{axis}")
    return Contribution(
        changes={f"winding_resistance_{place.axis}": Change(factor=1 + heat)},
        states=(
            State(
                str(heat),
                "1",
                f"relative rise of the {place.axis} winding's resistance",
                (gain * loss - heat) / time,
            ),
        ),
    )


WINDING_HEATING = Effect(
    id="winding_heating",
    title="winding that heats",
    reference="first-order thermal model of the winding, Kenjo and Nagamori (1985), section 5",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("winding_resistance_{axis}", "winding_loss_{axis}"),
    separating_experiment="Repeat the same run cold and after minutes of load, and measure the"
    " winding's resistance before and after.",
)
