"""A sampled controller that needs time to compute: what acts was computed from an earlier sample.

The command of a sample acts that many sampling times later, and is held until the next one does.
The state `u_kept` has the command of the sample before, so that a delay may pass one sample.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, Sampler, State
from ptp_symbolic.symbolic.effect_interface.effect import Effect, Structure
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.symbols import ZERO

PARAMETERS = (
    Parameter(
        "n_compute_{axis}",
        "1",
        1.0,
        1e-3,
        2.0,
        "sampling times from a sample of the {axis} controller to its command",
        starts=(0.5, 1.0),
    ),
)
STATES = (
    ("u_acting_{axis}", "command of the {axis} controller that acts"),
    ("u_latest_{axis}", "command of the {axis} controller from its latest sample"),
    ("u_kept_{axis}", "command of the {axis} controller from the sample before"),
)


def _contribute(place: Place) -> Contribution:
    """A command that is due at a sample acts before that sample is taken: its sampler is first."""
    (delay,) = place.symbols(PARAMETERS)
    period, computed = map(place.quantity, ("sampling_{axis}", "computed_{axis}"))
    acting, latest, kept = (place.parameter(name) for name, _ in STATES)
    due = sp.Piecewise((latest, delay <= 1), (kept, True))
    return Contribution(
        changes={f"command_{place.axis}": Change(through=lambda _: acting)},
        states=tuple(
            State(name.format(axis=place.axis), "V", text.format(axis=place.axis), ZERO)
            for name, text in STATES
        ),
        samplers=(
            Sampler(period, {acting: due}, offset=delay * period),
            Sampler(period, {kept: latest, latest: computed}),
        ),
    )


CONTROLLER_DELAY = Effect(
    id="controller_delay",
    title="sampled controller that computes for a time",
    reference="Astrom and Wittenmark (1997), section 3.2 (delays of less and more than a sample)",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
    needs=("computed_{axis}", "sampling_{axis}"),
    structure=Structure(needs=("computed_{axis}", "sampling_{axis}")),
    separating_experiment="Log the voltage at the motor beside the encoder and step the set point:"
    " the voltage steps that time after the sample. Or raise the gain until the loop rings: a delay"
    " lowers the gain at which it does, a lag in the sensor bends the phase.",
)
