"""What the weak-form regression proposes: initial values of the declared model, and sets to try.

A current that follows its voltage within a sample shows a delay in whole samples only: between them
the rows do not change, and no difference quotient at a small delay points to a large one. Whole
numbers are compared instead.
"""

import itertools
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.diagnose.candidates import FAR_OFF, Candidate
from ptp_symbolic.numeric.diagnose.fitted_model import SearchProblem, restarted
from ptp_symbolic.numeric.diagnose.regression import (
    Regression,
    Subset,
    is_no_worse,
    lines,
    ranked_subsets,
    regression,
    reweighted,
)
from ptp_symbolic.numeric.diagnose.signatures import (
    Rows,
    Signature,
    brought,
    locked_signatures,
    rows_around,
    signatures,
)
from ptp_symbolic.numeric.identify.constants import (
    CYCLES,
    DECLARED_AMOUNT,
    DEVIATIONS,
    FAR,
    ITERATIONS,
    LARGEST,
    LITTLE,
    REFINEMENTS,
    STEP,
    TRIED,
)
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, nearest_possible, to_search
from ptp_symbolic.numeric.identify.equation_fit import (
    Linearised,
    blocks_in_time,
    fit_equations,
    linearised,
    robust_scale,
)
from ptp_symbolic.numeric.identify.equation_space import EquationSpace, prepare_equation_space
from ptp_symbolic.numeric.identify.least_squares import all_values, all_values_at_start
from ptp_symbolic.numeric.identify.run import Run, usual_period

FloatArray = NDArray[np.float64]


def declared_start(problem: SearchProblem) -> dict[str, float]:
    """All parameters at the declared starts, every candidate at its vanishing value."""
    return {**problem.fixed, **all_values_at_start(problem.free)}


def equation_space(
    problem: SearchProblem,
    start: Mapping[str, float],
    runs: Sequence[Run] | None = None,
    shortest: bool = False,
    half_width: float | None = None,
) -> EquationSpace | None:
    """The equation space of the whole training runs, or of other `runs`, in windows as short as
    noise allows with `shortest`, or of a `half_width` in s. None where angles are missing, states
    are sampled or switched, or rows are too few for the free parameters.
    """
    vector = problem.model.parameter_vector
    varied = dict(start)
    for candidate in problem.candidates:
        for f in candidate.free:
            amount = f.start
            if candidate.is_declared_value:
                amount = min((1.0 + DECLARED_AMOUNT) * f.start, f.upper)
            varied.update(dict.fromkeys(f.names, amount))
    others = []
    for f in problem.free:
        for factor in (FAR_OFF, 1.0 / FAR_OFF):
            value = float(np.clip(f.start * factor, f.lower, f.upper))
            others.append(vector({**start, **dict.fromkeys(f.names, value)}))
    try:
        space = prepare_equation_space(
            problem.model,
            problem.whole if runs is None else runs,
            vector(dict(start)),
            others,
            vector(varied),
            shortest,
            half_width,
        )
    except InputError:
        return None
    total = sum(int(rows.kept.sum()) for rows in space.rows_of)
    return space if total > 4 * (len(problem.free) + 1) else None


def possible(
    problem: SearchProblem, free: Sequence[FreeParameter], values: Mapping[str, float]
) -> dict[str, float]:
    """`values` with `free` projected onto the boundary of every relation of the machine that they
    break, as a fit does with its start.
    """

    def parameters(phi: FloatArray) -> FloatArray:
        return problem.model.parameter_vector({**values, **all_values(free, phi)})

    phi = to_search(free, values)
    found = nearest_possible(problem.model, free, parameters, phi)
    return dict(values) if found is phi else {**values, **all_values(free, found)}


def first_fit(
    problem: SearchProblem, space: EquationSpace, start: Mapping[str, float]
) -> dict[str, float]:
    """All parameters of the declared model fitted to its rows, those left out in turn in which a
    joint has left the face of its gap by far more than the rows scatter.
    """
    first = fit_equations(space, problem.free, start, ITERATIONS, problem.executor)
    values = possible(problem, problem.free, {**start, **first})
    for _ in range(CYCLES):
        p = problem.model.parameter_vector(values)
        rows, (equation, _, _) = space.rows(p), space.labels()
        scale = dict(zip(equation, robust_scale(rows, equation), strict=True))
        margin = FAR * np.array([scale.get(a, np.inf) for a in range(len(space.layout.angle))])
        if not space.leave_out_pulled(p, margin):
            break
        first = fit_equations(space, problem.free, values, ITERATIONS, problem.executor)
        values = possible(problem, problem.free, {**values, **first})
    return values


def at_best_delays(
    space: EquationSpace, candidates: Sequence[Candidate], rows: Rows, weight: FloatArray
) -> tuple[Candidate, ...]:
    """The candidates, effects that delay an input started at a whole number of samples where that
    reduces the sum of squares of the `rows` (see `rows_around`), each counted by its `weight` [n],
    more than their tangent does. The number is doubled as long as that helps, within the windows of
    the rows, then found by halving: most inputs are smooth, or change seldom, over such times.
    """
    delays = {
        space.model.parameter_names[index] for index in space.model.input_delays if index >= 0
    }
    by_key = {c.key: c for c in reversed(candidates)}

    def begun(candidate: Candidate) -> Candidate:
        if candidate.is_declared_value:
            return candidate
        base = brought(candidate, by_key)
        free = tuple(
            _at_best(space, f, base, candidate.vanishing[f.name], rows, weight)
            if f.name in delays and f.name in candidate.vanishing
            else f
            for f in candidate.free
        )
        late = {f.name for f, one in zip(free, candidate.free, strict=True) if f != one}
        return replace(candidate, free=free, whole_only=frozenset(late)) if late else candidate

    return tuple(map(begun, candidates))


def _at_best(
    space: EquationSpace,
    f: FreeParameter,
    base: Mapping[str, float],
    zero: float,
    rows: Rows,
    weight: FloatArray,
) -> FreeParameter:
    """A delay `f` that vanishes at `zero`, at its initial value (see `at_best_delays`); `base` are
    the values of what that brings along.
    """
    period = usual_period(space.runs)
    most = int(min(space.half_width, f.upper - zero) / period + 1e-6)

    def late(delay: float) -> FloatArray:
        return rows({**base, **dict.fromkeys(f.names, zero + delay)})

    def loss(samples: int) -> float:
        return float(weight @ late(samples * period) ** 2) if 0 <= samples <= most else np.inf

    without, small = late(0.0), STEP * (f.start - zero)
    column = late(small) - without
    taken = float(weight @ (column * without)) ** 2 / max(float(weight @ column**2), 1e-300)
    best, least = 0, float(weight @ without**2)
    by_tangent = least - taken
    doubled = 1
    while (left := loss(doubled)) < least:
        best, least, doubled = doubled, left, 2 * doubled
    step = best
    while step > 1:
        step //= 2
        left, at = min((loss(samples), samples) for samples in (best - step, best + step))
        if left < least:
            best, least = at, left
    if least >= by_tangent:
        return f
    return replace(f, start=zero + best * period, scale=best * period)


Candidates = tuple[Candidate, ...]


@dataclass(frozen=True, eq=False)
class ProposedSet:
    """A set of candidates and the values of all parameters at which to start it."""

    candidates: Candidates
    values: dict[str, float]


@dataclass(frozen=True, eq=False)
class ProposedSets:
    """The start of the declared model, sets to try, and candidates `without_influence` on the rows.

    `further` gives the sets to try where the residual of the best of `sets` exceeds the noise.
    `waves` are all candidates with a frequency, also those of which the rows show no line.
    `is_any_preferred`: whether the rows prefer any set to the null model. `space` is None where the
    machine has no equation space; then only the simulation searches.
    """

    start: dict[str, float]
    sets: tuple[ProposedSet, ...]
    further: Callable[[], tuple[ProposedSet, ...]]
    without_influence: Candidates
    waves: Candidates
    is_any_preferred: bool
    space: EquationSpace | None
    regression: Regression | None


def propose(problem: SearchProblem) -> ProposedSets:
    """Regress the residual torques and currents along the measured motion on all candidates."""
    start = declared_start(problem)
    space = equation_space(problem, start)
    waves = tuple(c for c in problem.candidates if c.locked is not None)
    if space is None:
        return ProposedSets(start, (), tuple, problem.candidates, waves, False, None, None)
    values = first_fit(problem, space, start)
    declared, around = _declared_rows(problem, space, values), rows_around(space, values)
    candidates = at_best_delays(space, problem.candidates, around, declared.weight)
    seen, without_influence = signatures(
        space, candidates, around, declared.weight, problem.executor
    )
    rows = _regressed(problem, space, declared, seen)

    def scan(left: FloatArray) -> list[Signature]:
        return locked_signatures(space, problem.candidates, around, left, rows.weight)

    rows = _regressed(problem, space, declared, [*seen, *lines(rows, scan)])
    preferred, first, others, rows = _best_sets(rows)
    space.rows(problem.model.parameter_vector(values))
    refine = partial(_refined, problem, space, rows, values)
    sets = tuple(problem.executor.map(refine, first))

    @cache
    def further() -> tuple[ProposedSet, ...]:
        return tuple(problem.executor.map(refine, others))

    is_any_preferred = bool(preferred.candidates)
    return ProposedSets(
        values, sets, further, tuple(without_influence), waves, is_any_preferred, space, rows
    )


def in_rows_of(
    problem: SearchProblem,
    space: EquationSpace,
    values: Mapping[str, float],
    beside: Sequence[Candidate],
) -> Regression:
    """The regression of the rows of another space at `values` (all parameters) on all candidates
    whose frequency is known, with weights from the residual of the set `beside`.
    """
    declared, around = _declared_rows(problem, space, values), rows_around(space, values)
    seen, _ = signatures(space, problem.candidates, around, declared.weight, problem.executor)
    return reweighted(_regressed(problem, space, declared, seen), beside)


def _declared_rows(
    problem: SearchProblem, space: EquationSpace, values: Mapping[str, float]
) -> Linearised:
    here = {f.name: values[f.name] for f in problem.free}
    return linearised(space, problem.free, values, here, problem.executor, own_torque=True)


def _regressed(
    problem: SearchProblem, space: EquationSpace, declared: Linearised, seen: Sequence[Signature]
) -> Regression:
    equation, run, time = space.labels()
    block = blocks_in_time(run, time)
    return regression(
        declared.rows, problem.free, declared.jacobian, seen, equation, block, declared.weight
    )


def _refined(
    problem: SearchProblem,
    space: EquationSpace,
    rows: Regression,
    values: Mapping[str, float],
    candidates: Sequence[Candidate],
    executor: Executor | None = None,
) -> ProposedSet:
    """A set with the initial values that the rows give, the parameters that shape it fitted to them
    too.
    """
    begun = start_of(problem, rows, candidates, values)
    own = {(s.candidate.key, s.candidate.member): s.candidate for s in rows.signatures}
    placed = tuple(own[c.key, c.member] for c in candidates)
    free = (*problem.free, *(restarted(f, begun[f.name]) for c in placed for f in c.free))
    found = fit_equations(space, free, begun, REFINEMENTS, executor)
    return ProposedSet(placed, possible(problem, free, {**begun, **found}))


def placed_by_rows(candidates: Sequence[Candidate], found: ProposedSets) -> tuple[Candidate, ...]:
    """Candidates with the initial values of the rows: those with a frequency at the line that was
    found, or left out without one, and long delays at their number of samples.
    """
    shown = found.regression.signatures if found.regression else ()
    placed = {(s.candidate.key, s.candidate.member): s.candidate for s in shown}
    return tuple(
        placed.get((c.key, c.member), c)
        for c in candidates
        if c.locked is None or (c.key, c.member) in placed
    )


def start_for(
    problem: SearchProblem,
    found: ProposedSets,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
    linear: bool = False,
) -> dict[str, float]:
    """Where the rows start a set, also fitted in what shapes it unless taken as `linear` in all
    parameters; what the rows do not show of the candidates stays at `values`.
    """
    rows, space = found.regression, found.space
    seen = {(s.candidate.key, s.candidate.member) for s in (rows.signatures if rows else ())}
    shown = [c for c in candidates if (c.key, c.member) in seen]
    kept = {name: values[name] for c in candidates if c not in shown for name in c.names}
    if rows is None or space is None:
        return found.start | kept
    if linear:
        return start_of(problem, rows, shown, found.start) | kept
    return _refined(problem, space, rows, found.start, shown, problem.executor).values | kept


def _best_sets(
    rows: Regression,
) -> tuple[Subset, list[Candidates], list[Candidates], Regression]:
    """The set that predicts blocks left out best, and those to try: what is no worse than the best,
    the simplest first, then the best of every size; and to try next, twice as many that predict
    best of all others, most of them triples. Scales follow the residual of that set.
    """
    chosen: Subset | None = None
    for _ in range(CYCLES):
        every = ranked_subsets(rows, LARGEST)
        close = [s for s in every if is_no_worse(s, every[0], DEVIATIONS, LITTLE)]
        close.sort(key=lambda s: (len(s.candidates), s.columns, s.loss))
        again = chosen is not None and _keys(chosen) == _keys(close[0])
        chosen = close[0]
        if again:
            break
        rows = reweighted(rows, chosen.candidates)
    kept: dict[frozenset[str], Subset] = {}
    for subset in (*close[:2], every[0], *_best_by_size(every), *close[2:]):
        if subset.candidates and len(kept) < 2 * TRIED:
            kept.setdefault(_keys(subset), subset)
    first = [s.candidates for s in kept.values()]
    for subset in every:
        if subset.candidates:
            kept.setdefault(_keys(subset), subset)
    others = [s.candidates for s in kept.values()][len(first) :]
    return close[0], first, others[: 4 * TRIED], rows


def _best_by_size(every: Sequence[Subset]) -> list[Subset]:
    """The two best single candidates, the best pair and the best triple."""
    found = []
    for size, count in ((1, 2), (2, 1), (3, 1)):
        distinct: dict[frozenset[str], Subset] = {}
        for subset in every:
            if len(subset.candidates) == size:
                distinct.setdefault(_keys(subset), subset)
        found += list(distinct.values())[:count]
    return found


def _keys(subset: Subset) -> frozenset[str]:
    return frozenset(c.key for c in subset.candidates)


def start_of(
    problem: SearchProblem,
    rows: Regression,
    candidates: Sequence[Candidate],
    values: Mapping[str, float],
) -> dict[str, float]:
    """Values at which to start a set: the amounts of a least squares fit to the rows, within
    bounds, at the best values of the parameters that shape its members; the declared parameters
    follow.
    """
    own = {(s.candidate.key, s.candidate.member): s for s in rows.signatures}
    found = [own[c.key, c.member] for c in candidates]
    root = np.sqrt(rows.weight)
    right = np.concatenate([rows.rows * root, np.zeros(len(rows.declared))])
    best, result = np.inf, dict(values)
    for shapes in itertools.product(*(range(len(s.candidate.shapes)) for s in found)):
        free: list[tuple[FreeParameter, float]] = []
        columns = [rows.base[:, k] for k in range(rows.base.shape[1])]
        for signature, shape in zip(found, shapes, strict=True):
            for f, column in zip(
                signature.candidate.defining, signature.slopes[shape], strict=True
            ):
                free.append((f, signature.candidate.vanishing[f.name]))
                columns.append(column)
        table = np.column_stack(columns) * root[:, None]
        declared = rows.declared
        prior = np.zeros((len(declared), table.shape[1]))
        prior[:, : len(declared)] = np.diag([1.0 / f.scale for f in declared])
        table = np.vstack([table, prior])
        around = [(f, values[f.name]) for f in declared] + free
        lower = np.array([f.lower - centre for f, centre in around])
        upper = np.array([f.upper - centre for f, centre in around])
        size = np.maximum(np.linalg.norm(table, axis=0), 1e-300)
        triangle = np.asarray(np.linalg.qr(np.column_stack([table / size, right]), mode="r"))
        k = int(table.shape[1])
        solved = lsq_linear(
            triangle[:, :k], -triangle[:, k], ((lower - 1e-12) * size, (upper + 1e-12) * size)
        )
        if solved.cost < best:
            best, amounts = solved.cost, solved.x / size
            result = dict(values)
            for f, amount in zip(declared, amounts, strict=False):
                value = float(np.clip(values[f.name] + amount, f.lower, f.upper))
                result.update(dict.fromkeys(f.names, value))
            for (f, zero), amount in zip(free, amounts[len(declared) :], strict=True):
                value = float(np.clip(zero + amount, f.lower, f.upper))
                if any(f.name in s.finite for s in found) and amount != 0.0:
                    value = f.start
                result.update(dict.fromkeys(f.names, value))
            for signature, shape in zip(found, shapes, strict=True):
                result.update(signature.candidate.shapes[shape])
    every = (*problem.free, *(f for s in found for f in s.candidate.free))
    return possible(problem, every, result)
