"""Table 2.2 derived from the mass matrix, and Eq. 3.8 term by term."""

import sympy as sp

from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.coupling import (
    ALWAYS,
    ASYMMETRIC,
    AT_SPEED,
    BALANCED,
    C_X,
    MASS,
    OFFSET,
    PARTIALLY,
    SYMMETRIC,
    UNCOUPLED,
    axes_with,
    coupling,
    linearity,
)
from ptp_symbolic.symbolic.derivation.coupling import (
    J_XY as J_XY,
)
from ptp_symbolic.symbolic.derivation.coupling import (
    J_YZ as J_YZ,
)
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration, RigidEquations
from ptp_symbolic.thesis.items import Item, Kind, plain, same_text, unprinted

GRAVITY = sp.Symbol("g", positive=True)
# Row of the table: name, inertia of the tilt body, its centre of mass, what is printed, erratum.
ROWS = (
    ("completely_symmetric_balanced", SYMMETRIC, BALANCED, f"non-linear; {UNCOUPLED}", 11),
    ("partially_symmetric_balanced", PARTIALLY, BALANCED, f"non-linear; {AT_SPEED}", None),
    ("symmetric_imbalanced", SYMMETRIC, OFFSET, f"non-linear; {ALWAYS}", None),
    ("asymmetric_balanced", ASYMMETRIC, BALANCED, f"non-linear; {AT_SPEED}", 27),
    ("asymmetric_imbalanced", ASYMMETRIC, OFFSET, f"non-linear; {ALWAYS}", None),
)


def configuration(inertia: sp.Matrix, com: sp.Matrix) -> RigidEquations:
    """Rigid equations of a level platform whose tilt body has this inertia [3, 3] and com [3]."""
    pan_inertia = sp.diag(*sp.symbols("J_xp J_yp J_zp", positive=True))
    bodies = (
        Body(
            "pan",
            "pan",
            sp.Integer(0),
            sp.ImmutableMatrix(BALANCED),
            sp.ImmutableMatrix(pan_inertia),
        ),
        Body("tilt", "tilt", MASS, sp.ImmutableMatrix(com), sp.ImmutableMatrix(inertia)),
    )
    gravity = sp.ImmutableMatrix([0, 0, -GRAVITY])
    return lagrange(RigidConfiguration(kinematics.AXES, bodies, gravity))


def gravity_axes(equations: RigidEquations) -> str:
    """The axes whose equation holds gravity."""
    return ", ".join(axes_with(GRAVITY, equations)) or "none"


def table_2_2() -> list[Item]:
    """One item per row of Table 2.2, and the axes that gravity enters."""
    items = []
    for name, inertia, com, printed, erratum in ROWS:
        equations = configuration(inertia, com)
        found = f"{linearity(equations)}; {coupling(equations)}"
        left = normal_form(equations.mass_matrix[0, 1])
        check = (
            "derived by Lagrange's equations: linear if M is constant and f linear; coupled if"
            f" M_pt is not 0 (here M_pt = {plain(left)}), at speed if only products of rates pass"
        )
        title = f"Table 2.2, {name.replace('_', ' ')}"
        items.append(same_text(f"table_2_2.{name}", title, printed, found, check, erratum))
    general = configuration(ASYMMETRIC, OFFSET)
    axes = gravity_axes(general)
    items.append(
        same_text(
            "table_2_2.cause",
            "Section 2.3.1.1: what couples the axes of an imbalanced body",
            "gravity",
            "inertia" if axes == "tilt" else "gravity",
            f"derivative of the forcing by g, products of inertia and offset present: gravity"
            f" enters the equation of {axes} alone, the rest of the coupling holds m c^2 and J",
            27,
        )
    )
    return items


def printed_equation_3_8() -> dict[str, sp.Expr]:
    """Entries of Eq. 3.8 as the thesis prints them, in the symbols of the packaged platform."""
    names = "J_pan J_x_tilt J_y_tilt J_z_tilt b_pan b_tilt"
    J_zp, J_xt, J_yt, J_zt, b_p, b_t = sp.symbols(names, real=True)
    theta, pan_rate, tilt_rate = (
        kinematics.angle("tilt"),
        kinematics.rate("pan"),
        kinematics.rate("tilt"),
    )
    cos, sin = sp.cos(theta), sp.sin(theta)
    pan_entry = -b_p + 2 * J_zt * cos * sin * tilt_rate
    return {
        "mass_pan": J_zp + J_zt * cos**2 + J_xt * sin**2,
        "mass_tilt": J_yt,
        "mass_pan_tilt": sp.Integer(0),
        "torque_pan": -2 * J_xt * cos * sin * pan_rate * tilt_rate + pan_entry * pan_rate,
        "torque_tilt": -b_t * tilt_rate + cos * sin * pan_rate * (J_xt - J_zt) * pan_rate,
    }


def derived_equation_3_8() -> dict[str, sp.Expr]:
    """The same entries as this program derives them from the packaged ideal platform."""
    equations = assemble(read_platform("thesis-ideal"))
    pan, tilt = (
        force - kinematics.torque(axis)
        for force, axis in zip(equations.forcing, kinematics.AXES, strict=True)
    )
    mass = equations.mass_matrix
    return {
        "mass_pan": mass[0, 0],
        "mass_tilt": mass[1, 1],
        "mass_pan_tilt": mass[0, 1],
        "torque_pan": sp.expand(pan),
        "torque_tilt": sp.expand(tilt),
    }


def equation_3_8() -> list[Item]:
    """One item per entry of Eq. 3.8; it agrees where the symbolic difference is zero."""
    derived = derived_equation_3_8()
    items = []
    for name, printed in printed_equation_3_8().items():
        left = normal_form(derived[name] - printed)
        items.append(
            Item(
                f"eq_3_8.{name}",
                Kind.COMPUTED,
                f"Eq. 3.8, {name.replace('_', ' ')}",
                plain(printed),
                plain(derived[name]),
                "kg m^2" if name.startswith("mass") else "N m",
                left == 0,
                None,
                f"symbolic difference in normal form: {plain(left)}",
            )
        )
    return items


def offset_along_boresight() -> list[Item]:
    """The payload of Table 5.3, the special case without inertia coupling."""
    equations = configuration(SYMMETRIC, sp.Matrix([C_X, 0, 0]))
    pan_rate, tilt_rate = equations.rates
    term = normal_form(equations.forcing[0]).coeff(pan_rate * tilt_rate)
    return [
        unprinted(
            "table_2_2.offset_along_boresight",
            "Symmetric body, offset along the boresight alone",
            f"{linearity(equations)}; {coupling(equations)}",
            "",
            "as for Table 2.2: M_pt vanishes for this offset, the products of rates stay",
        ),
        unprinted(
            "table_2_2.offset_coupling",
            "Pan torque per product of rates, offset along boresight",
            plain(term),
            "kg m^2",
            "coefficient of omega_pan omega_tilt in the pan equation; it holds m c^2 and no g",
        ),
    ]


def items() -> list[Item]:
    """All items of this file."""
    return [*table_2_2(), *offset_along_boresight(), *equation_3_8()]
