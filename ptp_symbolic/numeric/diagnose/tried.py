"""What a search has tried: a hundred trials, whose Jacobians are large, and where sets end."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from weakref import WeakSet

import numpy as np

from ptp_symbolic.numeric.diagnose.trial import Trial, is_near, ranked


@dataclass(frozen=True, eq=False)
class Tried:
    """Trials that are not chosen, `others`; those fitted to their end; and by the forms of its
    candidates (see `forms_of`) where every set ends that was begun anew from the rows.
    """

    others: list[Trial] = field(default_factory=list)
    at_end: WeakSet[Trial] = field(default_factory=WeakSet)
    anew: dict[tuple[tuple[str, int], ...], Trial] = field(default_factory=dict)


def worth_keeping(trials: Sequence[Trial], best: Trial) -> list[Trial]:
    """The best trial of every set. Of those that are far behind `best` (see `is_near`) only tables
    still ask what they gain: single precision is enough for their Jacobians.
    """
    return [t if is_near(t, [best]) else _lighter(t) for t in ranked(trials)]


def _lighter(trial: Trial) -> Trial:
    if all(e.by_parameter.dtype == np.float32 for e in trial.fit.evaluations):
        return trial
    evaluations = tuple(
        replace(
            e,
            by_parameter=e.by_parameter.astype(np.float32),
            by_start=e.by_start.astype(np.float32),
        )
        for e in trial.fit.evaluations
    )
    return replace(trial, fit=replace(trial.fit, evaluations=evaluations))
