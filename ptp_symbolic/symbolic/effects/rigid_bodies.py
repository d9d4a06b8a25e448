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

BODIES = {
    "pan": (("J_pan", "z", 5.3e-4), ("J_x_pan", "x", 5.3e-4), ("J_y_pan", "y", 8.7e-4)),
    "tilt": (("J_x_tilt", "x", 4.1e-4), ("J_y_tilt", "y", 6.5e-4), ("J_z_tilt", "z", 2.7e-4)),
}
PARAMETERS = tuple(
    Parameter(name, "kg m^2", value, 1e-12, 1e4, f"inertia of the {axis} body about {k}")
    for axis, inertias in BODIES.items()
    for name, k, value in inertias
)
SLIDING = Parameter("m_pan", "kg", 1.0, 1e-9, 1e6, "mass that slides on the linear joint")
ALONE = {"pan": "J_pan", "tilt": "J_y_tilt"}  # what matters of the first body on a base at rest


def _has(place: Place, parameter: Parameter) -> bool:
    if place.linear or parameter is SLIDING:
        return place.linear and parameter is SLIDING
    axis = parameter.name.rpartition("_")[2]
    whole = place.base_turns or axis != place.axes[0]
    return axis in place.axes and (whole or parameter.name == ALONE[axis])


def _contribute(place: Place) -> Contribution:
    at_axes = sp.ImmutableMatrix([0, 0, 0])
    if place.linear:
        none = sp.ImmutableMatrix(sp.zeros(3))
        return Contribution(bodies=(Body("pan_body", "pan", SLIDING.symbol, at_axes, none),))
    defined: dict[str, sp.Expr] = {}
    for axis in place.axes:
        names = [f"{axis}_body_mass", *(f"{axis}_body_com_{k}" for k in "xyz")]
        defined |= dict.fromkeys(names if axis == "pan" else names[:1], ZERO)
    if len(place.axes) > 1:
        names = [*(f"tilt_product_{pair}" for pair in ("xy", "xz", "yz")), "tilt_axis_offset"]
        defined |= dict.fromkeys(names, ZERO)
    bodies = []
    for axis in place.axes:
        inertia = sp.zeros(3)
        for parameter in (p for p in PARAMETERS if _has(place, p)):
            for k in (k for name, k, _ in BODIES[axis] if name == parameter.name):
                inertia["xyz".index(k), "xyz".index(k)] = parameter.symbol
        for name in (n for n in defined if n.startswith(f"{axis}_product")):
            i, j = ("xyz".index(letter) for letter in name[-2:])
            inertia[i, j] = inertia[j, i] = place.quantity(name)
        centre = [place.quantity(n) for n in defined if n.startswith(f"{axis}_body_com")]
        com = sp.ImmutableMatrix(centre) if centre else at_axes
        mass = place.quantity(f"{axis}_body_mass")
        bodies.append(Body(f"{axis}_body", axis, mass, com, sp.ImmutableMatrix(inertia)))
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
