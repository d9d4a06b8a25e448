"""How the axes of a rigid platform act on each other, read off M(q) and h(q, q')."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.trigonometry import TrigonometricRing, normal_form
from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from ptp_symbolic.symbolic.symbols import ZERO

UNCOUPLED, AT_SPEED, ALWAYS = "un-coupled", "coupled at higher speeds", "coupled"
ROUNDING = 1e-12  # of sums that would be zero, relative to what is summed (in m of a centre)
LINEAR, NON_LINEAR = "linear", "non-linear"

MASS = sp.Symbol("m", positive=True)
J_X, J_Y, J_Z = sp.symbols("J_x J_y J_z", positive=True)
J_XY, J_XZ, J_YZ = sp.symbols("J_xy J_xz J_yz", real=True)
C_X, C_Y, C_Z = sp.symbols("c_x c_y c_z", real=True)

# Inertia of all that tilts, about its centre of mass. J_xy, J_xz, J_yz are entries of the tensor:
# the negative integrals of x y, x z, y z over the mass.
SYMMETRIC = sp.diag(J_X, J_Y, J_X)
PARTIALLY = sp.diag(J_X, J_Y, J_Z)
ASYMMETRIC = sp.Matrix([[J_X, J_XY, J_XZ], [J_XY, J_Y, J_YZ], [J_XZ, J_YZ, J_Z]])
BALANCED, OFFSET = sp.zeros(3, 1), sp.Matrix([C_X, C_Y, C_Z])


@dataclass(frozen=True)
class MassDistribution:
    """Of all that tilts: inertia [3, 3] about its centre of mass, which is at `com` [3]."""

    name: str
    inertia: sp.Matrix
    com: sp.Matrix


@dataclass(frozen=True)
class Condition:
    """An `expression` in parameters that couples the axes unless it is zero, and how it does."""

    expression: sp.Expr
    kind: str


# the rows of thesis Table 2.2
DISTRIBUTIONS = (
    MassDistribution("completely symmetric, balanced", SYMMETRIC, BALANCED),
    MassDistribution("partially symmetric, balanced", PARTIALLY, BALANCED),
    MassDistribution("symmetric, imbalanced", SYMMETRIC, OFFSET),
    MassDistribution("asymmetric, balanced", ASYMMETRIC, BALANCED),
    MassDistribution("asymmetric, imbalanced", ASYMMETRIC, OFFSET),
)


def distributed(rigid: RigidConfiguration, mass: MassDistribution) -> RigidEquations:
    """Equations of the machine `rigid` in which one body of this kind is all that tilts."""
    tilting = Body(
        "tilt_body",
        "tilt",
        MASS,
        sp.ImmutableMatrix(mass.com),
        sp.ImmutableMatrix(mass.inertia),
    )
    panning = tuple(body for body in rigid.bodies if body.frame != "tilt")
    return lagrange(replace(rigid, bodies=(*panning, tilting)))


def linearity(equations: RigidEquations) -> str:
    """`linear` where the mass matrix is constant and the forcing linear in angles and rates."""
    state = (*equations.coordinates, *equations.rates)
    constant = all(normal_form(m.diff(s)) == 0 for m in equations.mass_matrix for s in state)
    curved = (f.diff(a).diff(b) for f in equations.forcing for a in state for b in state)
    return LINEAR if constant and all(normal_form(c) == 0 for c in curved) else NON_LINEAR


def coupling(equations: RigidEquations) -> str:
    """How two axes act on each other.

    `coupled` where the acceleration of one axis needs a torque on the other, or the torque at rest
    depends on the other angle: both at any speed. `coupled at higher speeds` where all that passes
    is a product of rates.
    """
    return strongest(condition.kind for condition in conditions(equations))


def strongest(kinds: Iterable[str]) -> str:
    """The strongest of several ways to be coupled; `un-coupled` where there is none."""
    found = {*kinds}
    return next((kind for kind in (ALWAYS, AT_SPEED) if kind in found), UNCOUPLED)


def conditions(equations: RigidEquations) -> tuple[Condition, ...]:
    """What must vanish for two axes to be uncoupled: functions of parameters alone.

    They are the coefficients of different functions of angles and rates in the entry of M that
    couples the axes, and in what the forcing of each takes from angle and rate of the other; each
    once, up to a number.
    """
    mass = equations.mass_matrix[0, 1]
    terms = [mass, *_passing(equations)]
    ring = TrigonometricRing(terms)
    moving = {*equations.coordinates, *equations.rates, TIME}
    varies = [bool(g.free_symbols & moving) for g in ring.generators]
    turning = [g in equations.rates for g in ring.generators]
    found: dict[sp.Expr, str] = {}
    for term in terms:
        groups: dict[tuple[int, ...], sp.Expr] = defaultdict(lambda: ZERO)
        for monomial, value in ring.reduced(term).items():
            key = tuple(power if v else 0 for power, v in zip(monomial, varies, strict=True))
            rest = tuple(0 if v else power for power, v in zip(monomial, varies, strict=True))
            groups[key] += value * ring.product(rest)
        for key, coefficient in groups.items():
            if coefficient != 0:
                at_speed = any(power for power, t in zip(key, turning, strict=True) if t)
                own = _primitive(coefficient)
                found[own] = strongest((found.get(own, AT_SPEED), AT_SPEED if at_speed else ALWAYS))
    return tuple(Condition(expression, kind) for expression, kind in found.items())


def _passing(equations: RigidEquations) -> Iterator[sp.Expr]:
    """Slopes of the forcing of each axis over angle and rate of the other."""
    for own, other in ((0, 1), (1, 0)):
        for symbol in (equations.coordinates[other], equations.rates[other]):
            yield equations.forcing[own].diff(symbol)


def axes_with(symbol: sp.Symbol, equations: RigidEquations) -> tuple[str, ...]:
    """The axes in whose equation of motion `symbol` is."""
    return tuple(
        axis
        for axis, force in zip(equations.axes, equations.forcing, strict=True)
        if normal_form(force.diff(symbol)) != 0
    )


def _primitive(expression: sp.Expr) -> sp.Expr:
    """`expression` without a factor that is a number, its first term positive."""
    whole = sp.expand(sp.expand(expression).as_content_primitive()[1])
    first = whole.as_ordered_terms(order="lex")[0]
    written = sp.factor(-whole if first.could_extract_minus_sign() else whole)
    return written if written.is_Mul else sp.expand(written)


def distribution_of(
    rigid: RigidConfiguration, values: Mapping[sp.Symbol, float]
) -> MassDistribution:
    """Which of DISTRIBUTIONS all that tilts on the machine `rigid` has, at these parameters."""
    mass, first, tensor = 0.0, np.zeros(3), np.zeros((3, 3))
    numbers = dict(values)
    for body in (body for body in rigid.bodies if body.frame == "tilt"):
        own = float(body.mass.xreplace(numbers))
        com = np.array(body.com.xreplace(numbers).tolist(), float)[:, 0]
        about = np.array(body.inertia.xreplace(numbers).tolist(), float)
        mass, first = mass + own, first + own * com
        tensor += about + own * (com @ com * np.eye(3) - np.outer(com, com))
    centre = first / mass if mass else first
    tensor -= mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    small = ROUNDING * float(np.abs(tensor).max())
    aligned = np.abs(tensor - np.diag(np.diag(tensor))).max() <= small
    even = aligned and abs(tensor[0, 0] - tensor[2, 2]) <= small
    balanced = not np.any(np.abs(centre) > ROUNDING)
    complete, partial, symmetric, asymmetric, neither = DISTRIBUTIONS
    if balanced:
        return complete if even else partial if aligned else asymmetric
    return symmetric if aligned else neither
