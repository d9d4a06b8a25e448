"""Candidates that the logs cannot tell from one that was chosen.

An effect of the chosen set is compared, at the fit, with what every other candidate would change in
the outputs, both without what the declared parameters and the other effects can follow (canonical
correlation: Hotelling, 1936). Those that resemble it are refitted in its place to the same depth;
the ones that predict as well form its group.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.gain import Gain, gain
from ptp_symbolic.diagnose.linear import canonical_correlation, effect_of, outside, stacked
from ptp_symbolic.diagnose.needed import MATERIAL
from ptp_symbolic.diagnose.refits import ITERATIONS, polished
from ptp_symbolic.diagnose.responses import REACH, Columns, least, response_columns
from ptp_symbolic.diagnose.trial import Task, Trial, fitted, halving, ranked
from ptp_symbolic.identify.coordinates import to_search, to_values
from ptp_symbolic.identify.fit import Fit

FloatArray = NDArray[np.float64]

SIMILAR = 0.9  # canonical correlation from which on a candidate is refitted in the place of another
MOST_REFITTED = 6  # look-alikes of one effect that are refitted, the most similar first
NEAR = 0.5  # share of its loss that a set may lose to the chosen one and still be polished


@dataclass(frozen=True, eq=False)
class Rival:
    """A set that predicts as well as the chosen one; `gain` is that of the chosen over it."""

    trial: Trial
    gain: Gain


@dataclass(frozen=True, eq=False)
class Similarity:
    """A candidate in the place of another: their correlation, and where its refit starts."""

    candidate: Candidate
    correlation: float
    values: dict[str, float]


def rivals(
    task: Task, chosen: Trial, others: Sequence[Trial], fit: Fit, carried: FloatArray
) -> list[Rival]:
    """Sets as large as the chosen one, of which these logs do not prefer the chosen one clearly and
    materially, `others` among them. `fit` is its fit with derivatives that are not blind.
    """
    begun: list[Trial] = []
    for member in chosen.candidates:
        alike = look_alikes(task, chosen, fit, member)
        kept = tuple(c for c in chosen.candidates if c is not member)
        begun += [
            fitted(task, (*kept, s.candidate), s.values, chosen.fit.z, 0, fit)
            for s in alike[:MOST_REFITTED]
        ]
    if begun:
        task.progress(f"refitting {len(begun)} sets that resemble the chosen one")
    trials = halving(task, begun, ((2 * ITERATIONS, len(begun)),))
    tried = {t.keys for t in trials} | {chosen.keys}
    for other in ranked(others):
        same_size = len(other.candidates) == len(chosen.candidates)
        fresh = same_size and other.keys not in tried and np.isfinite(other.fit.cost)
        if fresh and gain(chosen, other).share < NEAR:
            trials.append(other)
    result: dict[tuple[str, ...], Rival] = {}
    for trial in trials:
        if gain(chosen, trial).share >= NEAR:
            continue
        refitted = polished(task, trial, carried)
        rival = Rival(refitted, gain(chosen, refitted))
        if not (rival.gain.share >= MATERIAL and rival.gain.is_clear(len(trials))):
            result.setdefault(refitted.keys, rival)
    return list(result.values())


def confusable(chosen: Trial, found: Sequence[Rival]) -> dict[str, tuple[str, ...]]:
    """For every key of the chosen set the keys that may stand in its place."""
    named: dict[str, set[str]] = {key: set() for key in chosen.keys}
    for rival in found:
        other = set(rival.trial.keys) - set(chosen.keys)
        for key in set(chosen.keys) - set(rival.trial.keys):
            named[key] |= other
    return {key: tuple(sorted(keys)) for key, keys in named.items()}


def look_alikes(task: Task, trial: Trial, fit: Fit, member: Candidate) -> list[Similarity]:
    """Candidates whose response correlates above SIMILAR with the effect of `member`, best
    first.
    """
    residual = stacked(fit, [e.residual[:, None] for e in fit.evaluations])[:, 0]
    table = stacked(fit, [e.by_parameter for e in fit.evaluations])
    own = [k for k, f in enumerate(fit.free) if f.name in member.parameters]
    others = [k for k in range(len(fit.free)) if k not in own]
    effect = effect_of(fit, member, table)
    away = table[:, others]
    target = outside(effect[:, None], away)[:, 0]
    size = float(np.linalg.norm(target))
    if size == 0.0:
        return []
    off = {name: member.vanishing[f.name] for f in member.defining for name in (f.name, *f.tied)}
    base = trial.values | off
    full = {c.key: c for c in sorted(task.candidates, key=lambda c: len(c.free))}
    wanted = [(c, shape) for c in full.values() if c.key not in trial.keys for shape in c.shapes]
    most = REACH * float(np.linalg.norm(effect))

    def compare(pair: tuple[Candidate, Mapping[str, float]]) -> Similarity | None:
        candidate, shape = pair
        found = response_columns(task, trial, candidate, shape, most)
        if found is None:
            return None
        correlation = canonical_correlation(target, outside(found.table, away))
        if correlation < SIMILAR:
            return None
        values = _instead(base, fit, others, residual - effect, away, found)
        return Similarity(candidate, correlation, values | dict(found.base))

    best: dict[str, Similarity] = {}
    jobs = [s for s in task.executor.map(compare, wanted) if s is not None]
    for s in sorted(jobs, key=lambda s: -s.correlation):
        best.setdefault(s.candidate.key, s)
    return list(best.values())


def _instead(
    base: Mapping[str, float],
    fit: Fit,
    others: Sequence[int],
    residual: FloatArray,
    away: FloatArray,
    found: Columns,
) -> dict[str, float]:
    """Values of all parameters where `found` takes up the `residual` of the fit without a
    member.
    """
    amounts, _ = least(residual, away, found)
    shift = np.zeros(len(fit.free))
    shift[list(others)] = amounts[: len(others)]
    phi = to_search(fit.free, fit.values) + shift
    moved = to_values(fit.free, phi)
    values = dict(base)
    for k in others:
        f = fit.free[k]
        values.update(dict.fromkeys((f.name, *f.tied), moved[f.name]))
    values.update(found.values(amounts[len(others) :]))
    return values
