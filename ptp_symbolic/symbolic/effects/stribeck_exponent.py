"""A Stribeck curve that falls with another power of the rate than its square.

The square of the rate over the Stribeck speed is taken `NEAR_REST`^2 above zero: a power below 2
has no finite curvature at rest, one below 1 no finite slope. At rest the curve is 0.4 % of its
height below the static torque with the smallest exponent, and 1e-8 with an exponent of 1.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

NEAR_REST = sp.Rational(1, 10**8)  # rate over Stribeck speed
PARAMETERS = (
    Parameter(
        "gamma_{axis}",
        "1",
        2.0,
        0.3,
        4.0,
        "exponent of the Stribeck curve",
        vanishes=2.0,
        starts=(1.0, 0.5),
    ),
)


def _contribute(place: Place) -> Contribution:
    (exponent,) = place.symbols(PARAMETERS)

    def through(square: sp.Expr) -> sp.Expr:
        return (square + NEAR_REST**2) ** (exponent / 2)

    return Contribution(changes={f"stribeck_square_{place.axis}": Change(through=through)})


STRIBECK_EXPONENT = Effect(
    id="stribeck_exponent",
    title="Stribeck curve that falls with another power of the rate",
    reference="thesis Eq. 2.11 with erratum 3 (gamma); Armstrong-Helouvry (1991)",
    parameters=PARAMETERS,
    contribute=_contribute,
    needs=("stribeck_square_{axis}",),
    separating_experiment="Run at ten or more steady rates from a tenth of the Stribeck speed to"
    " ten times it: the exponent shows in how wide the fall is, whatever its depth.",
)
