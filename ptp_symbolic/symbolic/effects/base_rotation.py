"""A base that turns, as a gyro on it measures: a vehicle, a ship.

Inputs are the rates of the base in its own axes (x, y, z as the pan frame at pan angle zero) and
their derivatives. The equations need both: a pan body that a yawing base leaves behind lags by the
angular acceleration. A rate table commands the derivative; of a logged rate it is the slope of a
smoothed signal, zero phase, computed before the fit. Gravity keeps its direction in the axes of
the base; where it does not (roll and pitch) declare ``base_acceleration`` of kind
``specific_force``.
"""

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution, Input
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import Place

RATES = tuple(Input(f"omega_{k}_base", "rad/s", f"rate of the base about its {k}") for k in "xyz")
SLOPES = tuple(
    Input(f"alpha_{k}_base", "rad/s^2", f"angular acceleration of the base about its {k}")
    for k in "xyz"
)


def _contribute(place: Place) -> Contribution:
    pairs = (("base_spin", RATES), ("base_spin_rate", SLOPES))
    return Contribution(
        changes={
            f"{name}_{given.name.split('_')[1]}": Change(addition=given.symbol)
            for name, inputs in pairs
            for given in inputs
        },
        inputs=(*RATES, *SLOPES),
    )


BASE_ROTATION = Effect(
    id="base_rotation",
    title="base that turns as measured",
    reference="Craig (2005), Eq. 6.45 to 6.53, with the rate of frame 0 as it is",
    parameters=(),
    contribute=_contribute,
    on_axis=False,
    structural=True,
    turns_base=True,
    separating_experiment="Let the axes coast on a turning base: they stay behind in space.",
    instead_on_linear="only joints that turn are modelled on a base that turns",
)
