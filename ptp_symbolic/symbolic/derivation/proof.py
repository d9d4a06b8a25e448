"""Are two derivations the same equations? Symbolically for certain, numerically at many states."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp

from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics.bodies import RigidEquations


@dataclass(frozen=True)
class EqualityProof:
    """What is left of the entries of M and f that differ; empty where the equations are equal.

    `remainders` maps an entry, such as ``mass_matrix[0, 1]`` or ``forcing[1]``, to the normal form
    of the difference.
    """

    remainders: Mapping[str, sp.Expr]

    @property
    def equal(self) -> bool:
        """True when every difference is identically zero."""
        return not self.remainders


def prove_equal(a: RigidEquations, b: RigidEquations) -> EqualityProof:
    """Compare mass matrix and forcing of `a` and `b` entry by entry in trigonometric normal form.

    Raises ValueError when the equations are of different joints.
    """
    _require_same_joints(a, b)
    n = len(a.axes)
    differences = {
        f"mass_matrix[{i}, {j}]": a.mass_matrix[i, j] - b.mass_matrix[i, j]
        for i in range(n)
        for j in range(n)
    }
    differences.update({f"forcing[{i}]": a.forcing[i] - b.forcing[i] for i in range(n)})
    forms = {entry: normal_form(difference) for entry, difference in differences.items()}
    return EqualityProof({entry: form for entry, form in forms.items() if form != 0})


def compare_numerically(
    a: RigidEquations,
    b: RigidEquations,
    parameters: Mapping[sp.Symbol, float],
    states: int = 10_000,
    seed: int = 0,
) -> float:
    """Return the worst relative difference of accelerations over cond(M) at random states.

    Angles are drawn from one turn, rates in +-10 rad/s, joint torques in +-10 N m. Differences are
    relative to the accelerations that forcing and joint torques cause each on its own, so that a
    state in which they cancel counts like any other. `parameters` gives a value in SI units to
    every symbol that is neither angle nor rate. Raises ValueError when one is missing or the joints
    differ.
    """
    _require_same_joints(a, b)
    n = len(a.axes)
    random = np.random.default_rng(seed)
    angles = random.uniform(-np.pi, np.pi, (n, states))
    rates = random.uniform(-10.0, 10.0, (n, states))
    torques = random.uniform(-10.0, 10.0, (n, states))
    (mass_a, forcing_a), (mass_b, forcing_b) = (
        _evaluate(equations, parameters, angles, rates) for equations in (a, b)
    )
    ours = np.linalg.solve(mass_a, np.stack([forcing_a, torques.T], axis=2))
    theirs = np.linalg.solve(mass_b, np.stack([forcing_b, torques.T], axis=2))
    scale = np.linalg.norm(theirs, axis=1).sum(axis=1) * np.linalg.cond(mass_b)
    difference = np.linalg.norm((ours - theirs).sum(axis=2), axis=1)
    return float(np.max(difference / scale))


def _require_same_joints(a: RigidEquations, b: RigidEquations) -> None:
    if (a.coordinates, a.rates) != (b.coordinates, b.rates):
        raise ValueError(f"Equations of {a.axes} and of {b.axes} cannot be compared.")


def _evaluate(
    equations: RigidEquations,
    parameters: Mapping[sp.Symbol, float],
    angles: np.ndarray,
    rates: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix [states, n, n] and forcing [states, n] at angles and rates [n, states]."""
    n, states = angles.shape
    entries = [*equations.mass_matrix, *equations.forcing]
    known = {*equations.coordinates, *equations.rates, *parameters}
    missing = sorted(str(s) for e in entries for s in e.free_symbols if s not in known)
    if missing:
        raise ValueError(f"No value for {', '.join(dict.fromkeys(missing))}; give one to each.")
    arguments = [*equations.coordinates, *equations.rates, *parameters]
    function = sp.lambdify(arguments, entries, modules="numpy", cse=True)
    values = function(*angles, *rates, *parameters.values())
    table = np.array([np.broadcast_to(value, (states,)) for value in values], dtype=float).T
    return table[:, : n * n].reshape(states, n, n), table[:, n * n :]
