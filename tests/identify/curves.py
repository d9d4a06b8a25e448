"""Runs of one smooth curve, each with a start of its own: small enough to be solved densely.

Run r shows y(t) = z_r0 + z_r1 exp(-phi_0 t) + phi_2 sin(phi_1 t); a third of the runs start at rest
and lack z_r1, as runs of machines do.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.least_squares import Problem

Floats = NDArray[np.float64]
Fails = Callable[[Floats], bool]

PHI = np.array([0.7, 2.3, 1.4])
NOISE, SIGMA = 0.02, 0.03  # rms, and what the fit believes
PRIOR = 0.8  # of every start unknown


def evaluation(residual: Floats, by_phi: Floats, by_z: Floats, failed: str | None = None):
    """What a simulation would return."""
    return Evaluation(residual, by_phi, by_z, failed)


@dataclass(frozen=True)
class Curves:
    """Measured runs: `time` [k], `measured` [runs, k], `unknowns` per run (1 or 2)."""

    time: Floats
    measured: Floats
    unknowns: tuple[int, ...]

    def shapes(self, phi: Floats) -> Floats:
        """What the start unknowns are multiplied with [k, 2]."""
        return np.column_stack([np.ones_like(self.time), np.exp(-phi[0] * self.time)])

    def residual(self, run: int, phi: Floats, z: Floats) -> Floats:
        """Measured less simulated, over SIGMA [k]."""
        curve = self.shapes(phi)[:, : len(z)] @ z + phi[2] * np.sin(phi[1] * self.time)
        return (self.measured[run] - curve) / SIGMA

    def evaluate(self, run: int, phi: Floats, z: Floats, failed: str | None) -> Evaluation:
        """Residual of a run with the derivatives worked out by hand."""
        t, shapes = self.time, self.shapes(phi)
        decay = -t * shapes[:, 1] * z[1] if len(z) > 1 else np.zeros_like(t)
        wave = np.sin(phi[1] * t)
        by_phi = np.column_stack([decay, phi[2] * t * np.cos(phi[1] * t), wave])
        by_z = shapes[:, : len(z)]
        return evaluation(self.residual(run, phi, z), -by_phi / SIGMA, -by_z / SIGMA, failed)

    def problem(
        self,
        lower: Sequence[float] = (0.0, 0.0, 0.0),
        upper: Sequence[float] = (9.0, 9.0, 9.0),
        start_bound: float = 9.0,
        precision: Sequence[float] = (0.0, 0.0, 0.0),
        fails: Fails = lambda phi: False,
    ) -> Problem:
        """The problem as `minimise` takes it; `precision` holds phi near zero."""

        def evaluate(
            phi: Floats, z: Sequence[Floats], tangents: bool, only: Sequence[int] | None = None
        ) -> list[Evaluation]:
            failed = "the model fails here" if fails(phi) else None
            runs = range(len(z)) if only is None else only
            return [self.evaluate(r, phi, z[r], failed) for r in runs]

        return Problem(
            evaluate,
            np.array(lower),
            np.array(upper),
            [np.full(n, -start_bound) for n in self.unknowns],
            [np.full(n, start_bound) for n in self.unknowns],
            [np.full(n, PRIOR) for n in self.unknowns],
            np.zeros(3),
            np.array(precision),
        )

    def nowhere(self) -> list[Floats]:
        """Start unknowns to search from: zero."""
        return [np.zeros(n) for n in self.unknowns]

    def split(self, x: Floats) -> tuple[Floats, list[Floats]]:
        """Phi and the start unknowns of a vector that has them all."""
        return x[:3], np.split(x[3:], np.cumsum(self.unknowns)[:-1])

    def dense(
        self, problem: Problem, begin: Floats, mean_square: float = 0.0
    ) -> tuple[Floats, list[Floats], float]:
        """SciPy's solution with all unknowns side by side, and its cost without the prior of phi.

        The priors of phi and z are multiplied with the mean square residual, that of z at least 1.
        """
        held, scale = problem.prior_precision * mean_square, max(1.0, mean_square)

        def residuals(x: Floats) -> Floats:
            phi, z = self.split(x)
            runs = [self.residual(r, phi, a) for r, a in enumerate(z)]
            return np.concatenate([*runs, np.sqrt(scale) * x[3:] / PRIOR, np.sqrt(held) * phi])

        low = np.concatenate([problem.lower, *problem.start_lower])
        high = np.concatenate([problem.upper, *problem.start_upper])
        x = np.concatenate([begin, np.zeros(sum(self.unknowns))])
        tight = {"xtol": 1e-14, "ftol": 1e-14, "gtol": 1e-14}
        found = least_squares(residuals, x, "3-point", (low, high), **tight)
        phi, z = self.split(found.x)
        return phi, z, float(2.0 * found.cost - np.sum(held * phi**2))


def measure(runs: int, seed: int = 4) -> Curves:
    """Noisy runs with random starts."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0.0, 4.0, 60)
    unknowns = tuple(1 if r % 3 == 2 else 2 for r in range(runs))
    nothing = Curves(time, np.zeros((runs, len(time))), unknowns)
    starts = [rng.normal(0.0, 1.0, n) for n in unknowns]
    clean = [-SIGMA * nothing.residual(r, PHI, z) for r, z in enumerate(starts)]
    return Curves(time, np.array(clean) + NOISE * rng.normal(size=(runs, len(time))), unknowns)
