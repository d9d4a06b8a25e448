"""A rigid payload on the tilt body (on the pan body where there is no tilt axis)."""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.mechanics.bodies import Body
from ptp_symbolic.symbolic.symbols import ZERO

INERTIAS = tuple(
    Parameter(
        f"J_{k}_payload", "kg m^2", value, 0.0, 1e4, f"payload inertia about its own {k} axis"
    )
    for k, value in (("x", 5.3e-3), ("y", 6.8e-3), ("z", 6.8e-3))
)
OFFSETS = tuple(
    Parameter(f"c_{k}_payload", "m", value, -10.0, 10.0, f"{k} of the payload's centre of mass")
    for k, value in (("x", 0.1), ("y", 0.0), ("z", 0.0))
)
MASS = Parameter("m_payload", "kg", 4.992, 0.0, 1e5, "payload mass")


def _has(place: Place, parameter: Parameter) -> bool:
    """About a single axis on a base that does not turn one inertia matters, no offset along it."""
    if len(place.axes) > 1 or place.base_turns or parameter is MASS:
        return True
    about = {"pan": "z", "tilt": "y"}[place.axes[0]]
    return (parameter.name == f"J_{about}_payload") == (parameter in INERTIAS) and (
        parameter.name != f"c_{about}_payload"
    )


def _contribute(place: Place) -> Contribution:
    def value(parameter: Parameter) -> sp.Expr:
        return parameter.symbol if _has(place, parameter) else ZERO

    offset = {f"payload_com_{p.name[2]}": value(p) for p in OFFSETS}
    body = Body(
        name="payload",
        frame=place.payload_frame,
        mass=MASS.symbol,
        com=sp.ImmutableMatrix([place.quantity(name) for name in offset]),
        inertia=sp.ImmutableMatrix(sp.diag(*map(value, INERTIAS))),
    )
    return Contribution(quantities=offset, bodies=(body,))


PAYLOAD = Effect(
    id="payload",
    title="payload",
    reference="thesis section 3.2.2, Table 5.3 with erratum 18",
    parameters=(MASS, *INERTIAS, *OFFSETS),
    has=_has,
    contribute=_contribute,
    on_axis=False,
    structural=True,
    instead_on_linear="its mass is part of m_pan",
)
