"""The runs of a fit as functions of its search coordinates and of their start unknowns."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import CYCLES, ITERATIONS, NEARBY
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, limits, slopes, to_values
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance, evaluate
from ptp_symbolic.numeric.identify.gap_places import residual_of
from ptp_symbolic.numeric.identify.least_squares import Problem, Secants
from ptp_symbolic.numeric.identify.requirements import keep_possible
from ptp_symbolic.numeric.identify.robust_loss import blocks_of
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]

DEFAULT_TOLERANCE = Tolerance()
POLISH = CYCLES * ITERATIONS  # iterations of a fit that goes to its end


@dataclass(frozen=True)
class Effort:
    """How to search: iterations, relative gain at which to stop, simulation tolerance, and how many
    steps in a row may be rejected.

    `secants` is the step, in search coordinates, of the finite differences that replace derivatives
    which mislead (see `identify.secants`); None: none are replaced. The robust loss weighs blocks
    of `block` s, whole runs unless given; `robust_below` is that of `robust_tuning`. Steps that are
    `straight` are so in the values of parameters that are searched in logarithms: these end a fit
    in its valley, along which logarithms bend; a search that is not yet in the right one goes far
    along a wrong one with them.
    """

    iterations: int = 30
    gain: float = 1e-5
    tolerance: Tolerance = DEFAULT_TOLERANCE
    secants: float | None = None
    block: float = np.inf
    robust_below: float = NEARBY
    straight: bool = False
    rejections: int = 5


def all_values(free: Sequence[FreeParameter], phi: FloatArray) -> dict[str, float]:
    """Values of the free parameters at phi [nf], and of those tied to them."""
    own = to_values(free, phi)
    return own | {name: own[f.name] for f in free for name in f.tied}


def all_values_at_start(free: Sequence[FreeParameter]) -> dict[str, float]:
    """Start values of the free parameters and of those tied to them."""
    return {name: f.start for f in free for name in f.names}


@dataclass(frozen=True, eq=False)
class Simulations:
    """All runs as functions of the search coordinates phi [nf] and the start unknowns z.

    `owner` is the coordinate of every parameter in `columns`: tied ones share theirs.
    """

    model: Model
    runs: Sequence[Run]
    free: Sequence[FreeParameter]
    base: FloatArray
    columns: NDArray[np.int64]
    owner: NDArray[np.int64]
    tolerance: Tolerance
    executor: Executor | None

    def parameters(self, phi: FloatArray) -> FloatArray:
        """All parameters [np]."""
        p, names = self.base.copy(), self.model.parameter_names
        for name, value in all_values(self.free, phi).items():
            p[names.index(name)] = value
        return p

    def residual(self, index: int, phi: FloatArray, z: FloatArray) -> FloatArray | None:
        """Residual of one run; None where the simulation fails."""
        run = self.runs[index]
        return residual_of(self.model, self.parameters(phi), self.tolerance, run, z)

    def evaluate(
        self,
        phi: FloatArray,
        z: Sequence[FloatArray],
        tangents: bool,
        only: Sequence[int] | None = None,
    ) -> list[Evaluation]:
        """Evaluations of the runs `only`, all unless given, their Jacobians by phi."""
        p = self.parameters(phi)
        by_phi = np.zeros((len(self.columns), len(self.free)))
        if len(self.free):
            by_phi[np.arange(len(self.columns)), self.owner] = slopes(self.free, phi)[self.owner]

        def one(pair: tuple[Run, FloatArray]) -> Evaluation:
            run, start = pair
            e = evaluate(self.model, run, p, start, self.columns, tangents, self.tolerance)
            return replace(e, by_parameter=e.by_parameter @ by_phi) if tangents else e

        pairs = list(zip(self.runs, z, strict=True))
        pairs = pairs if only is None else [pairs[k] for k in only]
        return list(self.executor.map(one, pairs)) if self.executor else [one(a) for a in pairs]


def simulations_of(
    model: Model,
    runs: Sequence[Run],
    free: Sequence[FreeParameter],
    fixed: Mapping[str, float],
    effort: Effort,
    executor: Executor | None,
) -> Simulations:
    """`runs` as functions of `free`, all other parameters at `fixed`. Raises InputError for values
    out of bounds.
    """
    names = list(model.parameter_names)
    owned = [(i, names.index(name)) for i, f in enumerate(free) for name in f.names]
    owner, columns = np.array(owned, dtype=np.int64).reshape(-1, 2).T
    return Simulations(
        model,
        runs,
        free,
        model.parameter_vector(dict(fixed)),
        columns.copy(),
        owner.copy(),
        effort.tolerance,
        executor,
    )


def problem_of(simulations: Simulations, effort: Effort) -> Problem:
    """Least squares over the runs of `simulations`, within the bounds of its parameters."""
    free, runs, length = simulations.free, simulations.runs, effort.block
    lower, upper = limits(free)
    blocks = [blocks_of(r.time, len(r.signals), length) for r in runs] if length < np.inf else None
    return Problem(
        simulations.evaluate,
        lower,
        upper,
        [np.array([u.lower for u in run.unknowns]) for run in runs],
        [np.array([u.upper for u in run.unknowns]) for run in runs],
        [np.array([u.sigma for u in run.unknowns]) for run in runs],
        np.zeros(len(free)),
        np.zeros(len(free)),
        None
        if effort.secants is None
        else Secants(simulations.residual, upper, simulations.executor, step=effort.secants),
        keep_possible(simulations.model, free, simulations.parameters),
        blocks,
        effort.robust_below,
        np.array([effort.straight and f.logarithmic for f in free], dtype=np.bool_),
    )
