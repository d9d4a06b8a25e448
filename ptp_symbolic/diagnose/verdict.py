"""The verdict: nothing missing, explained (up to a group, partly), or unexplained."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.floor import floor_counts
from ptp_symbolic.diagnose.scores import share_explained, share_improved
from ptp_symbolic.diagnose.trial import Task, Trial, held_out_cost, simulated, squares
from ptp_symbolic.identify.intervals import estimates
from ptp_symbolic.identify.windows import propagated_noise

NOTHING_MISSING = "nothing_missing"
EXPLAINED = "explained"
UP_TO_GROUP = "explained_up_to_group"
PARTLY = "partly_explained"
UNEXPLAINED = "unexplained"

AT_FLOOR, NEAR_FLOOR, LEFT_TO_PARTLY = 1.05, 1.5, 2.0
IMPROVED, EXPLAINED_SHARE, PARTLY_SHARE = 0.85, 0.90, 0.30
TIE = 1.02
CLEAR_GAIN = 0.9
SECOND_LEAVES = 0.3
FELT = 1.02  # of the sum of squares, once an effect is switched off


@dataclass(frozen=True, eq=False)
class Verdict:
    """What the logs say: the word, the accepted trial (None: none), rivals, floor in counts."""

    word: str
    accepted: Trial | None
    rivals: tuple[Trial, ...]
    floor: float
    improved: float
    explained: float


def decide(task: Task, base: Trial, trials: Sequence[Trial]) -> Verdict:
    """Decide on held-out runs alone; `trials` are judged refits of `base`, in any order."""
    judged = sorted((t for t in trials if np.isfinite(held_out_cost(t))), key=held_out_cost)
    floor = _noise_floor(task, (base, *judged))
    before = float(np.sqrt(held_out_cost(base)))
    if not judged:
        word = NOTHING_MISSING if before <= AT_FLOOR * floor else UNEXPLAINED
        return Verdict(word, None, (), floor, 0.0, 0.0)
    winner, rivals = _choose(task, judged, floor)
    assert base.validate is not None and winner.validate is not None
    improved = share_improved(base.validate.pairs(), winner.validate.pairs(), floor)
    explained = share_explained(base.validate.pairs(), winner.validate.pairs(), floor)
    final = float(np.sqrt(held_out_cost(winner)))
    clear = held_out_cost(winner) < CLEAR_GAIN * held_out_cost(base) and improved >= IMPROVED
    seen = clear and _away_from_zero(task, winner)
    if before <= AT_FLOOR * floor and not seen:
        return Verdict(NOTHING_MISSING, None, (), floor, improved, explained)
    if not seen or final > LEFT_TO_PARTLY * floor:
        return Verdict(UNEXPLAINED, None, tuple(judged[:1]), floor, improved, explained)
    if final <= AT_FLOOR * floor or (explained >= EXPLAINED_SHARE and final <= NEAR_FLOOR * floor):
        word = UP_TO_GROUP if rivals else EXPLAINED
        return Verdict(word, winner, rivals, floor, improved, explained)
    if explained < PARTLY_SHARE:
        return Verdict(UNEXPLAINED, None, tuple(judged[:1]), floor, improved, explained)
    return Verdict(PARTLY, winner, rivals, floor, improved, explained)


def _choose(task: Task, judged: Sequence[Trial], floor: float) -> tuple[Trial, tuple[Trial, ...]]:
    """The best trial of one effect, unless one of two effects removes most of what that leaves."""
    chosen: tuple[Trial, tuple[Trial, ...]] | None = None
    for size in sorted({len(t.candidates) for t in judged}):
        best, rivals = _simplest([t for t in judged if len(t.candidates) == size])
        if chosen is None:
            chosen = best, rivals
            continue
        left = max(held_out_cost(chosen[0]) - floor**2, 0.0)
        open_ = float(np.sqrt(held_out_cost(chosen[0]))) > AT_FLOOR * floor
        most = held_out_cost(best) - floor**2 <= SECOND_LEAVES * left
        if open_ and most and _away_from_zero(task, best):
            chosen = best, rivals
    assert chosen is not None
    return chosen


def _noise_floor(task: Task, trials: Sequence[Trial]) -> float:
    """Floor in counts: rounding and encoder noise, and input noise carried to the encoder."""
    best = min(trials, key=held_out_cost)
    p = task.model.parameter_vector(dict(best.train.values))
    fit = best.validate or best.train
    carried = propagated_noise(task.model, fit.runs, fit.z, p, task.input_noise)
    measured = min(floor_counts(t.train.pairs()) for t in trials)
    return float(np.hypot(measured, carried))


def is_settled(verdict: Verdict) -> bool:
    """True when no further effect needs to be searched."""
    return verdict.word in (NOTHING_MISSING, EXPLAINED, UP_TO_GROUP)


def _simplest(judged: Sequence[Trial]) -> tuple[Trial, tuple[Trial, ...]]:
    """The winner among ties, the fewest parameters first; rivals are ties just as simple."""
    best = float(np.sqrt(held_out_cost(judged[0])))
    ties = [t for t in judged if float(np.sqrt(held_out_cost(t))) <= TIE * best]
    winner = min(ties, key=lambda t: (len(t.train.free), held_out_cost(t)))
    size = len(winner.train.free)
    rivals = [t for t in ties if t is not winner and len(t.train.free) == size]
    return winner, tuple(r for r in rivals if not set(winner.keys) <= set(r.keys))


def _away_from_zero(task: Task, trial: Trial) -> bool:
    """Every candidate of `trial` has a parameter whose interval leaves its vanishing value, and is
    felt there: the interval of a logarithm never reaches zero.

    Where the data see a parameter only together with a declared one, its interval is that of its
    bounds and says nothing: the declared model has had its chance to do as well alone. Candidates
    that are seen only together have not.
    """
    found = {e.name: e for e in estimates(trial.train)}
    own = {name for candidate in trial.candidates for name in candidate.parameters}
    for candidate in trial.candidates:
        off = _switched_off(trial, candidate)
        if all(
            found[name].lower <= zero <= found[name].upper and set(found[name].only_with) <= own
            for name, zero in off.items()
        ):
            return False
        without, with_it = (squares(simulated(task, trial.train, v)) for v in (off, {}))
        if without < FELT * with_it:
            return False
    return True


def _switched_off(trial: Trial, candidate: Candidate) -> dict[str, float]:
    """Values of the parameters of `candidate` at which it vanishes."""
    if candidate.is_declared_value:
        return {f.name: f.start for f in candidate.starts[0]}
    vanishes = {p.name: p.vanishes for p in trial.train.model.parameters}
    zeros = {name: vanishes[name] for name in candidate.parameters}
    return {name: zero for name, zero in zeros.items() if zero is not None}
