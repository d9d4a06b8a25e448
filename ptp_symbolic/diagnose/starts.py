"""Where the search for a candidate begins: origins, grids of starts, and their elimination.

Every candidate starts from its grid, with the declared parameters at their table start and at the
declared optimum. The parameters of the candidate move alone first, so that the declared ones are
not bent to stand in for an effect that is still far from its place. Starts are tried on the runs
that tell most, and only the best go on to all runs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.lines import with_lines
from ptp_symbolic.diagnose.responses import most_promising
from ptp_symbolic.diagnose.trial import COARSE, NEARBY_COUNTS, Task, Trial, restarted
from ptp_symbolic.identify.coordinates import FreeParameter
from ptp_symbolic.identify.fit import Effort, Fit, all_values_at_start, fit_parameters

FloatArray = NDArray[np.float64]

PROBE = Effort(1, 1e-2, COARSE, rejections=2)
SEEK = Effort(2, 1e-2, COARSE, rejections=2, secants=True)
GO_ON = Effort(3, 1e-2, COARSE, rejections=2, secants=True)
CONFIRM = Effort(2, 1e-2, COARSE, rejections=2)
PROBED_SHARE, TELLING_SHARE = 0.1, 0.4
STARTS_KEPT, START_FACTOR = 2, 2.0
SOUGHT, CONFIRMED, FAR_BEHIND = 10, 5, 50.0
PROMISING, BESIDE_PROMISING = 4, 2
OPTIMUM, TABLE = "optimum", "table"


@dataclass(frozen=True, eq=False)
class _Search:
    """A candidate on its way from one start: what is held fixed, what moves, from where."""

    base: Trial
    candidate: Candidate
    free: tuple[FreeParameter, ...]
    fixed: Mapping[str, float]
    z: tuple[FloatArray, ...]
    origin: str
    fit: Fit | None = None

    @property
    def key(self) -> tuple[str, ...]:
        return tuple(sorted((*self.base.keys, self.candidate.key)))

    @property
    def cost(self) -> float:
        return np.inf if self.fit is None else self.fit.cost

    def trial(self) -> list[Trial]:
        """The search as a trial in which the declared parameters are free too; none if failed."""
        if self.fit is None:
            return []
        own = {f.name for f in self.fit.free}
        free = (*(f for f in self.base.train.free if f.name not in own), *self.fit.free)
        return [Trial((*self.base.candidates, self.candidate), replace(self.fit, free=free))]


def first_round(
    task: Task, bases: Sequence[Trial], candidates: Sequence[Candidate]
) -> tuple[list[list[Trial]], list[Trial]]:
    """The best start of every candidate after a few coarse iterations, from either origin.

    Returns those worth going on with, fitted to all train runs, as one group per origin, and the
    rest, fitted to the runs that tell most. From the table a candidate may look worse and yet lead
    to the better end, so the two origins do not compete here. At an optimum near the floor its
    response takes the place of a search (see `diagnose.responses`).
    """
    effects = len(bases[0].candidates) + 1
    candidates = with_lines(task, bases[0].train, candidates)
    near_floor = [base for base in bases if base.train.rms_counts() < NEARBY_COUNTS]
    promising, rest = most_promising(task, near_floor, candidates, PROMISING * effects)
    searches = [
        _Search(base, candidate, start, values, z, origin)
        for base in bases
        for candidate in candidates
        if candidate.key not in base.keys
        for origin, values, z in _origins(task, base, candidate, base is bases[0])
        if origin == TABLE or base not in near_floor
        for start in candidate.starts
    ]
    task.progress(f"trying {len(candidates)} candidates from {len(searches)} starts")
    probed = _advance(task, searches, _telling_runs(bases[0].train, PROBED_SHARE), PROBE)
    telling = _telling_runs(bases[0].train, TELLING_SHARE)
    sought = _leaders(_advance(task, _leaders(probed, STARTS_KEPT), telling, SEEK), 1)
    groups, left = [promising], list[_Search]()
    for origin in (OPTIMUM, TABLE):
        near, behind = _split([s for s in sought if s.origin == origin], SOUGHT)
        count = BESIDE_PROMISING if near_floor else CONFIRMED
        best, others = _split(_advance(task, near, telling, GO_ON), count)
        left += [*others, *behind]
        confirmed = _advance(task, best, tuple(range(len(task.train))), CONFIRM)
        groups.append([t for search in confirmed for t in search.trial()])
    return groups, [*(t for search in left for t in search.trial()), *rest]


def _telling_runs(fit: Fit, share: float) -> tuple[int, ...]:
    """Indices of the runs with the largest residuals, up to a share of all samples."""
    squares = [float(np.sum(e.residual**2)) for e in fit.evaluations]
    enough, taken = share * sum(run.size for run in fit.runs), 0
    found: list[int] = []
    for index in np.argsort(squares)[::-1]:
        if taken >= enough:
            break
        found.append(int(index))
        taken += fit.runs[index].size
    return tuple(sorted(found))


def _origins(
    task: Task, base: Trial, candidate: Candidate, is_best: bool
) -> list[tuple[str, dict[str, float], tuple[FloatArray, ...]]]:
    """Where searches begin: the optimum of `base`, and for the best base the declared parameters
    back at their table start, because at the optimum they stand in for the effect still missing.
    """
    optimum = (OPTIMUM, dict(base.train.values), tuple(base.train.z))
    if candidate.is_declared_value or not is_best:
        return [optimum]
    rest = tuple(np.zeros(len(run.unknowns)) for run in task.train)
    table = {**base.train.values, **all_values_at_start(task.free)}
    return [(TABLE, table, rest), optimum]


def _advance(
    task: Task, searches: Sequence[_Search], runs: Sequence[int], effort: Effort
) -> list[_Search]:
    """Let every search go on for a few iterations on some of the runs, all at the same time."""

    def go_on(search: _Search) -> _Search:
        fit = fit_parameters(
            task.model, [task.train[i] for i in runs], search.free, search.fixed,
            [search.z[i] for i in runs], effort,
        )  # fmt: skip
        if fit.failed:
            return replace(search, fit=None)
        z = list(search.z)
        for index, found in zip(runs, fit.z, strict=True):
            z[index] = found
        return replace(search, free=restarted(fit), z=tuple(z), fit=fit.lightened())

    return list(task.executor.map(go_on, searches))


def _split(searches: Sequence[_Search], count: int) -> tuple[list[_Search], list[_Search]]:
    """The best `count` searches that are not far behind the best, and the others."""
    ordered = sorted(searches, key=lambda search: search.cost)
    if not ordered:
        return [], []
    near = [s for s in ordered[:count] if s.cost <= FAR_BEHIND * ordered[0].cost]
    return near, ordered[len(near) :]


def _leaders(searches: Sequence[_Search], count: int) -> list[_Search]:
    """For every set of effects and origin the `count` best searches that are near the best."""
    leaders: list[_Search] = []
    for rival in dict.fromkeys((search.key, search.origin) for search in searches):
        own = [s for s in searches if (s.key, s.origin) == rival]
        own.sort(key=lambda search: search.cost)
        leaders += [s for s in own[:count] if s.cost <= START_FACTOR * own[0].cost]
    return leaders
