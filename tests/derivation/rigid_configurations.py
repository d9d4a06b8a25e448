"""Rigid configurations for the tests, and random but physical values of their symbols."""

import numpy as np
import sympy as sp

from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration

AXES = (("pan", "tilt"), ("pan",), ("tilt",))
LOADS = ("balanced", "payload", "payload on a tilted base")
G = sp.Rational(981, 100)
ORIGIN = sp.ImmutableMatrix([0, 0, 0])
LEVEL = sp.ImmutableMatrix([0, 0, -G])


def symbol(name: str) -> sp.Symbol:
    return sp.Symbol(name, real=True)


def tensor(body: str) -> sp.ImmutableMatrix:
    """Full symmetric inertia tensor of `body`."""
    return sp.ImmutableMatrix(
        3, 3, lambda i, j: symbol(f"J_{''.join(sorted('xyz'[i] + 'xyz'[j]))}_{body}")
    )


def offset(body: str) -> sp.ImmutableMatrix:
    return sp.ImmutableMatrix([symbol(f"c_{k}_{body}") for k in "xyz"])


def tilted_gravity() -> sp.ImmutableMatrix:
    beta, alpha = symbol("beta_base"), symbol("alpha_base")
    across = [sp.sin(beta) * sp.cos(alpha), sp.sin(beta) * sp.sin(alpha)]
    return sp.ImmutableMatrix([G * c for c in (*across, -sp.cos(beta))])


def thesis_bodies() -> tuple[Body, Body]:
    """The balanced pan and tilt bodies of the thesis, principal axes along the joints."""
    pan = sp.ImmutableMatrix(sp.diag(0, 0, symbol("J_pan")))
    tilt = sp.ImmutableMatrix(sp.diag(*(symbol(f"J_{k}_tilt") for k in "xyz")))
    none = sp.Integer(0)
    return Body("pan_body", "pan", none, ORIGIN, pan), Body("tilt_body", "tilt", none, ORIGIN, tilt)


def payload_model() -> RigidConfiguration:
    """Both axes and a payload with principal inertias and an offset of three components."""
    inertia = sp.ImmutableMatrix(sp.diag(*(symbol(f"J_{k}_payload") for k in "xyz")))
    payload = Body("payload", "tilt", symbol("m_payload"), offset("payload"), inertia)
    return RigidConfiguration(("pan", "tilt"), (*thesis_bodies(), payload), LEVEL)


def configuration(axes: tuple[str, ...], load: str) -> RigidConfiguration:
    """One of LOADS on a platform with `axes`; every inertia tensor is full."""
    pan, tilt = (
        Body(f"{axis}_body", axis, sp.Integer(0), ORIGIN, tensor(axis)) for axis in ("pan", "tilt")
    )
    bodies = [body for body in (pan, tilt) if body.frame in axes]
    if load != "balanced":
        frame = axes[-1]
        bodies.append(
            Body("payload", frame, symbol("m_payload"), offset("payload"), tensor("payload"))
        )
    gravity = tilted_gravity() if load == "payload on a tilted base" else LEVEL
    return RigidConfiguration(axes, tuple(bodies), gravity)


def inertia_values(body: str, spread: np.ndarray) -> dict[str, float]:
    """Tensor of a cloud of points: `spread` [3, 3] times its transpose holds second moments."""
    second = spread @ spread.T
    inertia = np.trace(second) * np.eye(3) - second
    return {f"J_{'xyz'[i]}{'xyz'[j]}_{body}": inertia[i, j] for i in range(3) for j in range(i, 3)}


def physical_values(seed: int) -> dict[str, float]:
    """Values in SI units for every symbol of `configuration`, by name."""
    random = np.random.default_rng(seed)
    values = {"m_payload": 4.992, "beta_base": 0.2, "alpha_base": 0.8}
    values |= {f"c_{k}_payload": random.uniform(-0.2, 0.2) for k in "xyz"}
    for body, size in (("pan", 0.02), ("tilt", 0.02), ("payload", 0.1)):
        values |= inertia_values(body, size * random.normal(size=(3, 3)))
    return values


def by_symbol(values: dict[str, float]) -> dict[sp.Symbol, float]:
    return {symbol(name): float(value) for name, value in values.items()}
