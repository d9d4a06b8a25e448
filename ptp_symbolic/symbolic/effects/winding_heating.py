"""A motor winding whose resistance rises as it heats."""

import sympy as sp

from ptp_symbolic.symbolic.effects.effect import Change, Contribution, Effect, Place, State
from ptp_symbolic.symbolic.parameters import Parameter

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


def _parameters(place: Place) -> tuple[Parameter, ...]:
    return tuple(p.at_axis(place.axis) for p in PARAMETERS)


def _contribute(place: Place) -> Contribution:
    gain, time = (place.parameter(p.name) for p in PARAMETERS)
    heat = sp.Symbol(f"heat_{place.axis}", real=True)
    current = sp.Symbol(f"i_{place.axis}", real=True)
    loss = place.quantity("winding_resistance_{axis}") * current**2
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
    parameters=_parameters,
    contribute=_contribute,
    needs=("winding_resistance_{axis}",),
    separating_experiment="Repeat the same run cold and after minutes of load, and measure the"
    " winding's resistance before and after.",
)
