"""An encoder that counts: the reading is the nearest whole count."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Change, Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place

PARAMETERS = (
    Parameter(
        "q_count_{axis}",
        "rad",
        8.726646259971648e-4,
        1e-12,
        1.0,
        "angle of one encoder count",
        linear={"default": 1e-6, "meaning": "travel of one encoder count"},
    ),
)


class NearestCount(sp.Function):
    """The multiple of `count` nearest to an angle; its slope is that of the angle, 1."""

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return 1 by the angle (what a fit needs, on average), 0 by the count."""
        return sp.Integer(1 if argindex == 1 else 0)

    def _eval_rewrite_as_floor(self, angle: sp.Expr, count: sp.Expr, **_: object) -> sp.Expr:
        return count * sp.floor(angle / count + sp.Rational(1, 2))


def _contribute(place: Place) -> Contribution:
    count = place.parameter("q_count_{axis}")
    counted = Change(through=lambda shown: NearestCount(shown, count))
    return Contribution(changes={f"reading_{place.angle}": counted})


ENCODER_QUANTIZATION = Effect(
    id="encoder_quantization",
    title="encoder that counts",
    reference="thesis 3.2.3.1 (7200 counts per turn) and 4.2.2 (1800 lines, four edges each)",
    parameters=PARAMETERS,
    contribute=_contribute,
    structural=True,
)
