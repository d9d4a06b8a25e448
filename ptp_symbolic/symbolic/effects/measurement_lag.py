"""A sensor behind a filter of first order: its reading lags what it measures.

The kind says which signal of the axis is filtered; those beside the angle must be declared as
outputs. An axis may have one of each.
"""

from dataclasses import replace

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Structure
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import real

FILTER = "time constant of the filter of the {axis}"
PARAMETERS = (Parameter("t_lag_{axis}", "s", 1e-3, 1e-6, 10.0, FILTER, starts=(3e-3, 3e-2)),)
KINDS = (
    ("rate", "omega", "rad/s"),
    ("motor_rate", "omega_motor", "rad/s"),
    ("current", "i", "A"),
    ("torque", "tau_shaft", "N m"),
)


def _contribute(place: Place) -> Contribution:
    """The state is by how much the reading is behind: zero at rest, wherever the joint is."""
    (time,) = place.symbols(PARAMETERS)
    behind = real(f"lag_{place.axis}")
    meaning = f"angle by which the {place.axis} reading is behind"
    return Contribution(
        changes={f"reading_{place.angle}": Change(addition=-behind)},
        states=(State(behind.name, "rad", meaning, place.rate - behind / time),),
    )


def _kind(kind: str, signal: str, unit: str) -> Effect:
    """The filter of a `signal` that begins each run at what it shows; its state is the reading."""
    word = kind.replace("_", " ")
    given = replace(PARAMETERS[0], name=f"t_lag_{signal}_{{axis}}", meaning=f"{FILTER} {word}")

    def contribute(place: Place) -> Contribution:
        (time,) = place.symbols((given,))
        name = f"{signal}_{place.axis}"
        shown = real(f"shown_{name}")
        rate = (place.quantity(f"measured_{name}") - shown) / time
        meaning = f"{place.axis} {word} as it is shown"
        state = State(shown.name, unit, meaning, rate, turns=kind == "motor_rate")
        return Contribution(
            changes={f"reading_{name}": Change(through=lambda _: shown)}, states=(state,)
        )

    return replace(
        MEASUREMENT_LAG,
        kind=kind,
        title=f"{word} behind a filter",
        parameters=(given,),
        contribute=contribute,
        needs=(f"reading_{signal}_{{axis}}",),
        structure=Structure(needs=(f"reading_{signal}_{{axis}}",)),
        kinds=(),
        separating_experiment="Log a step of the input beside the encoder: the reading follows the"
        " motion with one time constant, a delay shifts it whole.",
    )


MEASUREMENT_LAG = Effect(
    id="measurement_lag",
    kind="angle",
    title="encoder behind a filter",
    reference="first-order low pass; Ljung (1999), section 4.2",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
    structure=Structure(),
    separating_experiment="Turn steadily at several rates past an index mark: the reading is behind"
    " in proportion to the rate.",
)
MEASUREMENT_LAG = replace(MEASUREMENT_LAG, kinds=tuple(_kind(*each) for each in KINDS))
