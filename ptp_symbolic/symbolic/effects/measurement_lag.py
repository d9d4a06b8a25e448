"""An encoder behind a filter of first order: its reading lags the joint."""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import real

PARAMETERS = (
    Parameter("t_lag_{axis}", "s", 1e-3, 1e-6, 10.0, "time constant of the filter of the {axis}"),
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


MEASUREMENT_LAG = Effect(
    id="measurement_lag",
    title="encoder behind a filter",
    reference="first-order low pass; Ljung (1999), section 4.2",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
    separating_experiment="Turn steadily at several rates past an index mark: the reading is behind"
    " in proportion to the rate.",
)
