"""Leave local minima: breakaways and bounces in a gap make the cost piecewise smooth."""

import numpy as np

from ptp_symbolic.diagnose.floor import floor_counts
from ptp_symbolic.diagnose.trial import (
    FINE,
    LAST,
    NEXT,
    Task,
    Trial,
    continue_fits,
    start_afresh,
)
from ptp_symbolic.identify.fit import Effort, Fit, run_counts

AGAIN, ROUNDS = Effort(8, 1e-3, FINE, secants=True), 3
UNEVEN, NEAR, FAR = 1.2, 3.0, 30.0


def escape(task: Task, trial: Trial) -> Trial:
    """Leave a local minimum near the floor: some run is worse than rounding alone explains."""
    best = _from_table(task, trial)
    for _ in range(ROUNDS):
        if not _is_uneven(best.train):
            break
        before = best.train.cost
        best = continue_fits(task, [best], AGAIN)[0]
        task.progress(f"leaving a local minimum: {best.train.rms_counts():.3f} counts rms")
        if best.train.cost > 0.998 * before:
            break
    return best


def _from_table(task: Task, trial: Trial) -> Trial:
    """Refit with the declared parameters back at their table start, the effect kept."""
    if not trial.candidates or not _is_uneven(trial.train, FAR):
        return trial
    again = start_afresh(task, trial, NEXT)
    if again.train.cost >= 0.998 * trial.train.cost:
        return trial
    return continue_fits(task, [again], LAST)[0]


def _is_uneven(fit: Fit, near: float = NEAR) -> bool:
    """Near the floor in total, but not in every run."""
    floor = floor_counts(fit.pairs())
    if fit.rms_counts() > near * floor:
        return False
    worst = max(float(np.sqrt(np.mean(run_counts(r, e) ** 2))) for r, e in fit.pairs())
    return worst > UNEVEN * floor
