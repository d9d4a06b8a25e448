"""The pan body and the tilt body, balanced, with principal axes along the joint axes; the one body
of a linear joint.
"""

import sympy as sp

from ptp_symbolic.symbolic.effect_interface.contribution import Contribution
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.parameters import Parameter
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.mechanics.bodies import Body
from ptp_symbolic.symbolic.symbols import ZERO

PARAMETERS = (
    Parameter("J_pan", "kg m^2", 5.3e-4, 1e-12, 1e4, "inertia of the pan body about z"),
    Parameter("J_x_tilt", "kg m^2", 4.1e-4, 1e-12, 1e4, "inertia of the tilt body about x"),
    Parameter("J_y_tilt", "kg m^2", 6.5e-4, 1e-12, 1e4, "inertia of the tilt body about y"),
    Parameter("J_z_tilt", "kg m^2", 2.7e-4, 1e-12, 1e4, "inertia of the tilt body about z"),
)
SLIDING = Parameter("m_pan", "kg", 1.0, 1e-9, 1e6, "mass that slides on the linear joint")
ALONE: dict[tuple[str, ...], str] = {
    ("pan",): "J_pan",
    ("tilt",): "J_y_tilt",
}  # what matters of a body with one axis


def _has(place: Place, parameter: Parameter) -> bool:
    if place.linear or parameter is SLIDING:
        return place.linear and parameter is SLIDING
    return parameter.name == ALONE.get(place.axes, parameter.name)


def _contribute(place: Place) -> Contribution:
    symbol = place.parameter
    at_axes = sp.ImmutableMatrix([0, 0, 0])
    if place.linear:
        none = sp.ImmutableMatrix(sp.zeros(3))
        return Contribution(bodies=(Body("pan_body", "pan", SLIDING.symbol, at_axes, none),))
    bodies, defined = [], {}
    if "pan" in place.axes:
        inertia = sp.ImmutableMatrix(sp.diag(0, 0, symbol("J_pan")))
        bodies.append(Body("pan_body", "pan", ZERO, at_axes, inertia))
    if "tilt" in place.axes:
        full = "pan" in place.axes
        x, z = (symbol("J_x_tilt"), symbol("J_z_tilt")) if full else (0, 0)
        inertia = sp.diag(x, symbol("J_y_tilt"), z)
        mass: sp.Expr = ZERO
        if full:
            products = [f"tilt_product_{pair}" for pair in ("xy", "xz", "yz")]
            names = (*products, "tilt_body_mass", "tilt_axis_offset")
            defined = dict.fromkeys(names, ZERO)
            mass = place.quantity("tilt_body_mass")
            for name in products:
                i, j = ("xyz".index(letter) for letter in name[-2:])
                inertia[i, j] = inertia[j, i] = place.quantity(name)
        inertia = sp.ImmutableMatrix(inertia)
        bodies.append(Body("tilt_body", "tilt", mass, at_axes, inertia))
    return Contribution(quantities=defined, bodies=tuple(bodies))


RIGID_BODIES = Effect(
    id="rigid_bodies",
    title="pan body and tilt body",
    reference="thesis Eq. 3.8, Table 5.1",
    parameters=(*PARAMETERS, SLIDING),
    has=_has,
    contribute=_contribute,
    on_axis=False,
    linear={"title": "sliding body", "reference": "Newton (1687), second law"},
    structural=True,
)
