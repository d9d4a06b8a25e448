"""Levenberg-Marquardt over several runs, the unknown initial states eliminated run by run.

Shared parameters phi meet all runs, the unknowns z of the initial state of a run meet only that
run: the normal equations are bordered block diagonal and solved by a Schur complement (Golub and
Pereyra, 1973, call the elimination variable projection), within the box that one step may reach.

Finite differences replace derivatives that mislead. Zero-order-hold inputs let a friction break
away at one sample or the next: the residual is then a staircase of the parameter, and its
derivative is that of a tread. Bounces in a gap that appear and vanish do the same. A difference
over a finite step sees both.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.blocks import Block, blocks_of, loss, robust_tuning, shares
from ptp_symbolic.numeric.identify.constants import (
    CYCLES,
    ITERATIONS,
    LARGEST_STEP,
    MISLEADING,
    NEARBY,
    SAME,
    STEP,
    WIDE_STEP,
)
from ptp_symbolic.numeric.identify.coordinates import (
    Allow,
    FreeParameter,
    keep_possible,
    limits,
    slopes,
    to_values,
)
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance, evaluate, residual_of
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.lanes import in_portions

FloatArray = NDArray[np.float64]


SHARE_TO_BOUND = -np.expm1(-LARGEST_STEP)  # of the way there in one step


def reach(distance: FloatArray) -> FloatArray:
    """How far one step may go [nf] towards bounds at `distance` [nf].

    A parameter that one step takes from its start to zero takes the others to where no step leads
    back: the share is that of an interior point method (Coleman and Li, 1996).
    """
    share = np.where(distance > WIDE_STEP, SHARE_TO_BOUND, 1.0)
    return np.minimum(LARGEST_STEP, share * distance)


def box(
    phi: FloatArray, lower: FloatArray, upper: FloatArray, logarithmic: NDArray[np.bool_] | bool
) -> tuple[FloatArray, FloatArray]:
    """How far down and up one step may go [nf] from phi [nf], as `taken` takes it."""
    down, up = -reach(phi - lower), reach(upper - phi)
    return (
        np.where(logarithmic, np.expm1(down), down),
        np.where(logarithmic, np.expm1(up), up),
    )


def taken(phi: FloatArray, step: FloatArray, logarithmic: NDArray[np.bool_] | bool) -> FloatArray:
    """The search coordinates after a step [nf], which is straight in the values, whose logarithms
    some coordinates are: an inertia and the damping beside it trade places along a straight valley,
    and one that bends allows short steps only.
    """
    share = np.where(logarithmic, step, 0.0)
    return phi + np.where(logarithmic, np.log1p(share), step)


def limited_step(
    matrix: FloatArray, right: FloatArray, size: FloatArray, low: FloatArray, high: FloatArray
) -> FloatArray:
    """Solve matrix @ step = right with low <= step <= high [nf]; `size` scales them [nf].

    The one that wants furthest beyond is fixed there and the others solved anew: scaling all alike
    would let a parameter on its way to zero stop the rest.
    """
    step, moves = np.zeros(len(right)), np.ones(len(right), dtype=np.bool_)
    matrix, right = matrix / np.outer(size, size), right / size
    while moves.any():
        rest = right[moves] - matrix[np.ix_(moves, ~moves)] @ (size * step)[~moves]
        found = np.linalg.lstsq(matrix[np.ix_(moves, moves)], rest, rcond=1e-14)[0]
        step[moves] = found / size[moves]
        allowed = np.clip(step, low, high)
        worst = int(np.argmax(np.abs(step - allowed)))
        if step[worst] == allowed[worst]:
            break
        step[worst] = allowed[worst]
        moves[worst] = False
    return step


Shift = tuple[int, int]
Residual = Callable[[int, FloatArray, FloatArray], FloatArray | None]


@dataclass(eq=False)
class Secants:
    """Replaces misleading columns of the Jacobians by phi [nf] with finite differences.

    `residual(run, phi, z)` simulates one run (None: it failed); `upper` [nf] bounds phi. The first
    call compares every column of every run, later ones only those that misled, `chosen`; `step` is
    that of the differences, in search coordinates, or one for each of them [nf]. A simulation that
    failed or flew off replaces nothing.
    """

    residual: Residual
    upper: FloatArray
    executor: Executor | None = None
    chosen: list[Shift] | None = None
    step: float | FloatArray = STEP

    def __call__(
        self, phi: FloatArray, z: Sequence[FloatArray], evaluations: Sequence[Evaluation]
    ) -> list[Evaluation]:
        """`evaluations` at (phi, z) with their derivatives by phi refined."""
        every = [(r, c) for r in range(len(evaluations)) for c in range(len(phi))]
        shifts = every if self.chosen is None else self.chosen
        steps = np.broadcast_to(self.step, phi.shape)

        def difference(shift: Shift) -> FloatArray:
            run, column = shift
            step = float(steps[column])
            step = step if phi[column] + step <= self.upper[column] else -step
            shifted = phi.copy()
            shifted[column] += step
            after = self.residual(run, shifted, z[run])
            if after is None or not np.max(np.abs(after), initial=0.0) < BIGGEST * abs(step):
                return evaluations[run].by_parameter[:, column]
            return (after - evaluations[run].residual) / step

        columns = in_portions(difference, shifts, self.executor)
        if self.chosen is None:
            self.chosen = [
                (r, c)
                for (r, c), column in zip(shifts, columns, strict=True)
                if _misleads(evaluations[r].by_parameter[:, c], column)
            ]
        return _replaced(evaluations, shifts, columns)


def _misleads(tangent: FloatArray, secant: FloatArray) -> bool:
    return bool(np.linalg.norm(tangent - secant) > MISLEADING * np.linalg.norm(secant))


def _replaced(
    evaluations: Sequence[Evaluation], shifts: Sequence[Shift], columns: Sequence[FloatArray]
) -> list[Evaluation]:
    jacobians = [e.by_parameter.copy() for e in evaluations]
    for (run, column), values in zip(shifts, columns, strict=True):
        jacobians[run][:, column] = values
    return [replace(e, by_parameter=j) for e, j in zip(evaluations, jacobians, strict=True)]


BIGGEST = np.reciprocal(np.finfo(float).eps)  # beyond, a simulation has no information


class Evaluate(Protocol):
    """Simulates the runs of a problem."""

    def __call__(
        self,
        phi: FloatArray,
        z: Sequence[FloatArray],
        tangents: bool,
        only: Sequence[int] | None = None,
    ) -> list[Evaluation]:
        """Evaluations of the runs `only` (all unless given) at phi [nf] from their starts z, each
        [nz], with Jacobians where `tangents` is true.
        """
        ...


@dataclass(frozen=True)
class Problem:
    """What to minimise: `evaluate(phi, z, tangents)`, bounds of phi [nf], bounds and prior of z
    [nz].

    `refine`, where given, corrects the Jacobians from which steps are taken: those that come out
    are always the ones at the point, which intervals need. `allow` projects steps to where no
    machine is possible. `blocks` are, run by run, the blocks of rows that the robust loss weighs
    (see `identify.blocks`): whole runs, unless given; `robust_below` is that of
    `robust_tuning`. `logarithmic` marks logarithms of values, in which steps are to be straight.
    """

    evaluate: Evaluate
    lower: FloatArray
    upper: FloatArray
    start_lower: Sequence[FloatArray]
    start_upper: Sequence[FloatArray]
    start_sigma: Sequence[FloatArray]
    prior_centre: FloatArray
    prior_precision: FloatArray
    refine: Secants | None = None
    allow: Allow | None = None
    blocks: Sequence[Block] | None = None
    robust_below: float = NEARBY
    logarithmic: NDArray[np.bool_] | bool = False


@dataclass(frozen=True)
class Optimum:
    """Where the search ended; `cost` is the sum of squared weighted residuals and priors."""

    phi: FloatArray
    z: list[FloatArray]
    cost: float
    evaluations: list[Evaluation] = field(repr=False, default_factory=list)
    failed: str | None = None


def cost_of(
    problem: Problem,
    evaluations: Sequence[Evaluation],
    z: Sequence[FloatArray],
    tuning: float = np.inf,
    scale: float = 1.0,
) -> float:
    """Robust loss (squares, if `tuning` is infinite) and prior of z; infinite where a simulation
    failed or has no finite Jacobian.
    """
    if any(e.failed for e in evaluations):
        return np.inf
    fit = sum(loss(e, block, tuning) for e, block in _pairs(problem, evaluations))
    steepest = max(
        (np.max(np.abs(j), initial=0.0) for e in evaluations for j in (e.by_parameter, e.by_start)),
        default=0.0,
    )
    if not np.isfinite(fit) or not steepest < BIGGEST:
        return np.inf
    return fit + sum(
        scale * float(np.sum((a / s) ** 2)) for a, s in zip(z, problem.start_sigma, strict=True)
    )


def minimise(
    problem: Problem,
    phi: FloatArray,
    z: Sequence[FloatArray],
    iterations: int = 30,
    gain: float = 1e-5,
    rejections: int = 5,
    begun: Sequence[Evaluation] | None = None,
) -> Optimum:
    """Minimise from phi [nf] and z [nz] until two steps in a row gain less than the share `gain`,
    or until `rejections` ever shorter steps in a row gain nothing. `begun` are the evaluations
    there, with Jacobians, where they are known.

    Priors of phi and z are weighed by the mean square residual: strong while the model is far off,
    so that declared parameters and starts do not absorb the lack of an effect, and weak at the
    noise floor.
    """
    at = _Point(np.clip(phi, problem.lower, problem.upper), [a.copy() for a in z], [])
    at = replace(at, evaluations=list(begun or problem.evaluate(at.phi, at.z, True)))
    cost = cost_of(problem, at.evaluations, at.z)
    if not np.isfinite(cost):
        why = next((e.failed for e in at.evaluations if e.failed), "not finite")
        return Optimum(at.phi, at.z, np.inf, at.evaluations, why)
    damping, quiet = SAME, 0  # the first step is that of Gauss and Newton, but for next to nothing
    for _ in range(iterations):
        refined = at
        if problem.refine is not None:
            refined = replace(at, evaluations=problem.refine(at.phi, at.z, at.evaluations))
        weights = _weigh(problem, at)
        before = cost_of(problem, at.evaluations, at.z, weights.tuning, weights.scale)
        found = _better(problem, refined, weights, damping, before, rejections)
        if found is None:
            cost = before
            break
        at, cost, damping = found
        quiet = quiet + 1 if abs(before - cost) / before < gain else 0
        if quiet >= 2:
            break
    return Optimum(at.phi, at.z, cost, at.evaluations)


@dataclass(frozen=True)
class _Point:
    phi: FloatArray
    z: list[FloatArray]
    evaluations: list[Evaluation] = field(repr=False)


@dataclass(frozen=True)
class _Weights:
    """Tuning constant of the robust loss, precision [nf] of the prior of phi, weight of that of
    z.
    """

    tuning: float
    prior: FloatArray
    scale: float


def _pairs(
    problem: Problem, evaluations: Sequence[Evaluation]
) -> list[tuple[Evaluation, Block | None]]:
    if problem.blocks is None:
        return [(e, None) for e in evaluations]
    return list(zip(evaluations, problem.blocks, strict=True))


def _weigh(problem: Problem, at: _Point) -> _Weights:
    pairs = _pairs(problem, at.evaluations)
    tuning = robust_tuning(pairs, problem.robust_below)
    size = sum(e.residual.size for e in at.evaluations)
    mean_square = sum(loss(e, block, tuning) for e, block in pairs) / size
    return _Weights(tuning, problem.prior_precision * mean_square, max(1.0, mean_square))


def _better(
    problem: Problem, at: _Point, weights: _Weights, damping: float, cost: float, rejections: int
) -> tuple[_Point, float, float] | None:
    """The first of ever shorter steps that gains, its cost and the next damping; None if none.

    After a rejection the next step is tried without derivatives: most of them are rejected too. A
    run that its start makes worse keeps the one that it has: a gear that begins at rest, or next to
    a face, has no derivative to follow, and would hold back the parameters of all.
    """
    for attempt in range(rejections):
        step, steps_z = _step(problem, at, damping, weights)
        phi = np.clip(taken(at.phi, step, problem.logarithmic), problem.lower, problem.upper)
        if problem.allow is not None:
            phi = problem.allow(at.phi, phi)
        bounds = zip(at.z, steps_z, problem.start_lower, problem.start_upper, strict=True)
        z = [np.clip(a + b, low, high) for a, b, low, high in bounds]
        enough = cost + _prior(problem, weights.prior, at.phi) - _prior(problem, weights.prior, phi)
        for tangents in (True,) if attempt == 0 else (False, True):
            trial = _Point(phi, z, problem.evaluate(phi, z, tangents))
            after = cost_of(problem, trial.evaluations, z, weights.tuning, weights.scale)
            if attempt > 0 and not after < enough:
                trial = _with_kept_starts(problem, at, trial, weights, tangents)
                z = trial.z
                after = cost_of(problem, trial.evaluations, z, weights.tuning, weights.scale)
            if not after < enough:
                break
        else:
            return trial, after, max(damping / 10.0, 1e-12)
        damping *= 10.0
    return None


def _with_kept_starts(
    problem: Problem, at: _Point, trial: _Point, weights: _Weights, tangents: bool
) -> _Point:
    """The trial, runs that it makes worse with their starts of `at` where these fit better."""
    before, after = (_losses(problem, point, weights) for point in (at, trial))
    worse = [k for k, own in enumerate(at.z) if len(own) and not after[k] <= before[k]]
    if not worse:
        return trial
    z, evaluations = list(trial.z), list(trial.evaluations)
    for k in worse:
        z[k] = at.z[k]
    kept = problem.evaluate(trial.phi, z, tangents, worse)
    for k, e in zip(worse, kept, strict=True):
        evaluations[k] = e
    other = _Point(trial.phi, z, evaluations)
    for k, own in enumerate(_losses(problem, other, weights)):
        if k in worse and not own < after[k]:
            z[k], evaluations[k] = trial.z[k], trial.evaluations[k]
    return other


def _losses(problem: Problem, at: _Point, weights: _Weights) -> list[float]:
    """Robust loss of every run with the prior of its start; infinite where it failed."""
    pairs = zip(_pairs(problem, at.evaluations), at.z, problem.start_sigma, strict=True)
    return [
        np.inf
        if e.failed
        else loss(e, block, weights.tuning) + weights.scale * float(np.sum((a / s) ** 2))
        for (e, block), a, s in pairs
    ]


def _prior(problem: Problem, weight: FloatArray, phi: FloatArray) -> float:
    return float(np.sum(weight * (phi - problem.prior_centre) ** 2))


def _step(
    problem: Problem, at: _Point, damping: float, weights: _Weights
) -> tuple[FloatArray, list[FloatArray]]:
    phi, weight, scale = at.phi, weights.prior, weights.scale
    nf = len(phi)
    schur, right = np.diag(weight), -weight * (phi - problem.prior_centre)
    diagonal = weight.copy()
    blocks = []
    for (e, block), a, sigma, low, high in zip(
        _pairs(problem, at.evaluations),
        at.z,
        problem.start_sigma,
        problem.start_lower,
        problem.start_upper,
        strict=True,
    ):
        root = np.sqrt(shares(e, block, weights.tuning))
        j, k, r = root[:, None] * e.by_parameter, root[:, None] * e.by_start, root * e.residual
        jj, jk, kk = j.T @ j, j.T @ k, k.T @ k
        kk = kk + np.diag(scale / sigma**2)
        kk = kk + damping * np.diag(np.diag(kk))
        gr, gz = -(j.T @ r), -(k.T @ r) - scale * a / sigma**2
        moves = ~(((a <= low) & (gz < 0)) | ((a >= high) & (gz > 0)))
        inverse = np.zeros_like(kk)
        inverse[np.ix_(moves, moves)] = np.linalg.inv(kk[np.ix_(moves, moves)])
        schur += jj - jk @ inverse @ jk.T
        right += gr - jk @ inverse @ gz
        diagonal += np.diag(jj)
        blocks.append((jk, inverse, gz))
    active = ((phi <= problem.lower) & (right < 0)) | ((phi >= problem.upper) & (right > 0))
    free = ~active & (diagonal > 0)
    step = np.zeros(nf)
    if free.any():
        matrix = schur[np.ix_(free, free)] + np.diag(damping * diagonal[free])
        low, high = box(phi, problem.lower, problem.upper, problem.logarithmic)
        step[free] = limited_step(
            matrix, right[free], np.sqrt(diagonal[free]), low[free], high[free]
        )
    return step, [inverse @ (gz - jk.T @ step) for jk, inverse, gz in blocks]


DEFAULT_TOLERANCE = Tolerance()
POLISH = CYCLES * ITERATIONS  # iterations of a fit that goes to its end


@dataclass(frozen=True)
class Effort:
    """How to search: iterations, relative gain at which to stop, simulation tolerance, and how many
    steps in a row may be rejected.

    `secants` is the step, in search coordinates, of the finite differences that replace derivatives
    which mislead (see `Secants`); None: none are replaced. The robust loss weighs blocks
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
        return in_portions(one, pairs, self.executor)


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
