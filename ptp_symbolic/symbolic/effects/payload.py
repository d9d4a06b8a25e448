"""A rigid payload on the tilt body (on the pan body where there is no tilt axis)."""

import sympy as sp

from ptp_symbolic.symbolic.effects.effect import Contribution, Effect, Place
from ptp_symbolic.symbolic.mechanics.bodies import Body
from ptp_symbolic.symbolic.parameters import Parameter

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


def _parameters(place: Place) -> tuple[Parameter, ...]:
    turning = {"pan": "z", "tilt": "y"}
    if len(place.axes) == 1:
        about = turning[place.axes[0]]
        inertias = tuple(p for p in INERTIAS if p.name == f"J_{about}_payload")
        return (MASS, *inertias, *(p for p in OFFSETS if p.name != f"c_{about}_payload"))
    return (MASS, *INERTIAS, *OFFSETS)


def _contribute(place: Place) -> Contribution:
    declared = {p.name for p in _parameters(place)}

    def symbol(name: str) -> sp.Expr:
        return place.parameter(name) if name in declared else sp.Integer(0)

    offset = {f"payload_com_{k}": symbol(f"c_{k}_payload") for k in "xyz"}
    body = Body(
        name="payload",
        frame=place.payload_frame,
        mass=place.parameter("m_payload"),
        com=sp.ImmutableMatrix([place.quantity(name) for name in offset]),
        inertia=sp.ImmutableMatrix(sp.diag(*(symbol(f"J_{k}_payload") for k in "xyz"))),
    )
    return Contribution(quantities=offset, bodies=(body,))


PAYLOAD = Effect(
    id="payload",
    title="payload",
    reference="thesis section 3.2.2, Table 5.3 with erratum 18",
    parameters=_parameters,
    contribute=_contribute,
    on_axis=False,
    structural=True,
)
