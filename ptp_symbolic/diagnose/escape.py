"""Leave local minima: breakaways and bounces in a gap make the cost piecewise smooth."""

from dataclasses import replace

import numpy as np

from ptp_symbolic.diagnose.floor import floor_counts
from ptp_symbolic.diagnose.trial import (
    FINE,
    LAST,
    NEXT,
    Task,
    Trial,
    continue_fits,
    fixed_values,
    restarted,
)
from ptp_symbolic.identify.fit import Effort, Fit, fit_parameters, run_counts

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
    free = tuple(
        f if f.table is None else replace(f, start=f.table) for f in restarted(trial.train)
    )
    fixed, z = fixed_values(task, free), trial.train.z
    fit = fit_parameters(task.model, task.train, free, fixed, z, NEXT, task.executor)
    if fit.cost >= 0.998 * trial.train.cost:
        return trial
    return continue_fits(task, [replace(trial, train=fit)], LAST)[0]


def _is_uneven(fit: Fit, near: float = NEAR) -> bool:
    """Near the floor in total, but not in every run."""
    floor = floor_counts(fit.pairs())
    if fit.rms_counts() > near * floor:
        return False
    worst = max(float(np.sqrt(np.mean(run_counts(r, e) ** 2))) for r, e in fit.pairs())
    return worst > UNEVEN * floor
