"""A model that may be the machine, with what the logs so far know of its parameters."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.responses import stacked_jacobian
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, limits, slopes, to_search
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import project_out
from ptp_symbolic.numeric.identify.least_squares import (
    Effort,
    Problem,
    all_values,
    minimise,
    problem_of,
    simulations_of,
)
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]

TOLERANCE = Tolerance()
FIRM = 1e-3  # relative gain of an iteration at which a refit has ended
SINGULAR = 1e-12  # of the largest eigenvalue: below, nothing is known of a direction


@dataclass(frozen=True, eq=False)
class Contender:
    """A model with its `free` parameters and the `values` of all.

    `memory` [m, nf] is a root of the information of the logs so far about the search coordinates at
    `values`, in 1/sigma, no rows without logs; `left` is the sum of squares that it leaves of them,
    in squared sigmas.
    """

    name: str
    model: Model
    free: tuple[FreeParameter, ...]
    values: Mapping[str, float]
    memory: FloatArray
    left: float = 0.0

    @property
    def phi(self) -> FloatArray:
        """Search coordinates [nf] of the values."""
        return to_search(self.free, self.values)

    def drawn(self, shift: FloatArray) -> "Contender":
        """The same model with values that the logs so far allow: `shift` [nf] standard deviations
        away, in directions that are independent of one another.
        """
        if not len(self.memory):
            return self
        lower, upper = limits(self.free)
        away = np.linalg.lstsq(self.memory, shift[: len(self.memory)], rcond=SINGULAR)[0]
        phi = np.clip(self.phi + away, lower, upper)
        return replace(self, values={**self.values, **all_values(self.free, phi)})


def without_logs(
    name: str, model: Model, free: Sequence[FreeParameter], values: Mapping[str, float]
) -> Contender:
    """A contender of which nothing is known but its `values`."""
    return Contender(name, model, tuple(free), values, np.zeros((0, len(free))))


def from_fit(name: str, fit: Fit) -> Contender:
    """A contender as it was fitted to the logs so far."""
    table = stacked_jacobian(fit)
    left = sum(float(e.residual @ e.residual) for e in fit.evaluations)
    memory = np.asarray(np.linalg.qr(table, mode="r"))
    return Contender(name, fit.model, fit.free, fit.values, memory, left)


@dataclass(frozen=True, eq=False)
class Refit:
    """How near a contender comes to a run: the `evaluation` of the run, and the squared distance in
    sigmas to which it moves away from the `logs` so far.
    """

    evaluation: Evaluation
    logs: float


def refitted(contender: Contender, run: Run, place: float, iterations: int) -> Refit | None:
    """Fit a contender to `run` and to what it knows of the logs; None where it does not simulate.

    The start of the run is fitted with it, from `place` in every gap, in half gaps.
    """
    effort = Effort(iterations, FIRM, TOLERANCE)
    simulations = simulations_of(
        contender.model, [run], contender.free, contender.values, effort, None
    )
    problem, z = problem_of(simulations, effort), [_start(run, place)]
    if len(contender.memory):
        problem, z = _remembering(problem, contender), [*z, np.zeros(0)]
    best = minimise(problem, contender.phi, z, iterations, effort.gain)
    if best.failed:
        return None
    logs = sum(float(e.residual @ e.residual) for e in best.evaluations[1:])
    return Refit(best.evaluations[0], logs)


def _remembering(problem: Problem, contender: Contender) -> Problem:
    """`problem` with the logs so far as one more run, linear and without a start."""
    centre, memory = contender.phi, contender.memory
    by_start, nothing = np.zeros((len(memory), 0)), np.zeros(0)

    def both(
        phi: FloatArray,
        z: Sequence[FloatArray],
        tangents: bool,
        only: Sequence[int] | None = None,
    ) -> list[Evaluation]:
        logs = Evaluation(memory @ (phi - centre), memory, by_start)
        asked = range(len(z)) if only is None else only
        simulated = [k for k in asked if k < len(z) - 1]
        found = problem.evaluate(phi, z[:-1], tangents, simulated) if simulated else []
        return [*found, *(logs for k in asked if k == len(z) - 1)]

    return replace(
        problem,
        evaluate=both,
        start_lower=[*problem.start_lower, nothing],
        start_upper=[*problem.start_upper, nothing],
        start_sigma=[*problem.start_sigma, nothing],
    )


def _start(run: Run, place: float) -> FloatArray:
    """The guess of the start unknowns [nz], with `place` in every gap."""
    gaps = np.array([u.contact is not None for u in run.unknowns], dtype=bool)
    return np.where(gaps, place, run.guess)


def as_it_is(contender: Contender, run: Run, place: float) -> Evaluation | None:
    """A contender at its values along `run`, begun at `place` in every gap, with Jacobians; None
    where it does not simulate.
    """
    effort = Effort(0, FIRM, TOLERANCE)
    simulations = simulations_of(
        contender.model, [run], contender.free, contender.values, effort, None
    )
    (e,) = simulations.evaluate(contender.phi, [_start(run, place)], True)
    return None if e.failed else e


def information(contender: Contender, run: Run, place: float) -> FloatArray | None:
    """Information [nf, nf] about the search coordinates in `run` and in the logs so far, the start
    of the run unknown; None where it cannot be simulated.
    """
    e = as_it_is(contender, run, place)
    if e is None:
        return None
    seen = project_out(e.by_parameter, e.by_start)
    return np.asarray(seen.T @ seen + contender.memory.T @ contender.memory)


def spreads(contender: Contender, known: FloatArray) -> dict[str, float]:
    """Standard deviation of every free parameter in its unit, where `known` [nf, nf] is the
    information about the search coordinates; infinite where there is none.
    """
    units = np.abs(slopes(contender.free, contender.phi))
    return {
        f.name: float(units[k] * np.exp(-0.5 * log_information(known, [k])))
        for k, f in enumerate(contender.free)
    }


def log_information(known: FloatArray, wanted: Sequence[int]) -> float:
    """Logarithm of the determinant of the information about the coordinates `wanted`, all others
    unknown (Ds-optimality: Atkinson and Donev, 1992); -inf where one of them cannot be known.
    """
    size = np.sqrt(np.diag(known))
    if not np.all(size[list(wanted)] > 0.0):
        return -np.inf
    seen = size > 0.0
    unit = known[np.ix_(seen, seen)] / np.outer(size[seen], size[seen])
    places = np.flatnonzero(np.isin(np.flatnonzero(seen), list(wanted)))
    rest = np.delete(np.arange(len(unit)), places)
    inner, across = unit[np.ix_(places, places)], unit[np.ix_(places, rest)]
    left = inner - across @ np.linalg.pinv(unit[np.ix_(rest, rest)], SINGULAR, True) @ across.T
    shares = np.linalg.eigvalsh(left)
    if not shares[0] > SINGULAR:
        return -np.inf
    return float(np.sum(np.log(shares)) + 2.0 * np.sum(np.log(size[list(wanted)])))
