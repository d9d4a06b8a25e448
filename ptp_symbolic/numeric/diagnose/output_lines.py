"""The frequency of a wave by what it changes in the simulated outputs.

Where a machine rests, or lies in a gap, most of the time, few rows are left, and no line stands out
in them. The outputs still know it: waves of all frequencies are simulated in turn.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.linear import projected_off, stacked_jacobian, stacked_residual
from ptp_symbolic.numeric.diagnose.responses import response_columns
from ptp_symbolic.numeric.diagnose.signatures import at_line, axes_of, band
from ptp_symbolic.numeric.diagnose.trial import Task, Trial
from ptp_symbolic.numeric.identify.constants import (
    CYCLES_APART,
    MOST,
    REACH,
    ROWS_PER_WINDOW,
    SCANNED,
)
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.row_motion import row_motion

FloatArray = NDArray[np.float64]


def at_lines_of_outputs(
    task: Task, space: EquationSpace | None, trial: Trial, waves: Sequence[Candidate]
) -> tuple[Candidate, ...]:
    """Those of the candidates `waves` of which a line stands out in what a trial leaves of the
    outputs, by linear prediction; at that line, in all their forms. None without the `space` of
    rows, which tells how far to look; and none of a wave of which the rows tell all frequencies.
    """
    found: list[Candidate] = []
    if space is None:
        return ()
    for key in dict.fromkeys(c.key for c in waves):
        forms = [c for c in waves if c.key == key]
        line = None if key in trial.keys else _line(task, space, trial, forms[0])
        placed = [at_line(form, *line) for form in forms] if line is not None else []
        found += [c for c in placed if c is not None]
    return tuple(found)


def _line(
    task: Task, space: EquationSpace, trial: Trial, candidate: Candidate
) -> tuple[float, float, int] | None:
    """The frequency of the strongest line of a candidate, in Hz or cycles per turn, the lowest that
    is a line, and how many can be told from one another; None where none takes away a material
    share, and twice what any other does: what drifts looks like many slow waves. And where there
    are more rows, those that overlap counted once, than frequencies, or too many to simulate.

    A step of half of what tells two apart dims a line between by a fifth; then it is looked for
    beside the strongest.
    """
    span, usual, rows = _place(space, trial, candidate)
    lowest, highest = band(space, candidate, span, usual)
    apart = int((highest - lowest) * span)
    if not rows / ROWS_PER_WINDOW < apart <= SCANNED:
        return None
    task.progress(f"simulating {candidate.key} at all frequencies, {apart} of which are resolved")
    away = stacked_jacobian(trial.fit)
    residual = projected_off(stacked_residual(trial.fit)[:, None], away)[:, 0]

    def left(frequency: float) -> float:
        return _left(task, trial, candidate, frequency, residual, away)

    steps = np.arange(lowest, highest, MOST / span)
    shares = np.array(list(task.executor.map(left, steps)))
    best = float(steps[int(np.argmin(shares))])
    others = shares[np.abs(steps - best) > 1.0 / span]
    close = np.clip(best + CYCLES_APART / span * np.array([-1.0, 0.0, 1.0]), lowest, highest)
    shares = np.array(list(task.executor.map(left, close)))
    taken, by_others = 1.0 - shares.min(), 1.0 - others.min(initial=1.0)
    if taken < task.material or by_others > MOST * taken:
        return None
    return float(close[int(np.argmin(shares))]), 0.9 * lowest, apart


def _place(space: EquationSpace, trial: Trial, candidate: Candidate) -> tuple[float, float, int]:
    """How far the place goes that a wave is locked to, in s or turns, how fast it usually goes as
    it moves, per s (an axis without rows: 1 rad/s), and how many rows tell of it.
    """
    assert candidate.locked is not None
    runs, own = trial.fit.runs, axes_of(space, candidate)
    rows = int(np.isin(space.labels()[0], own).sum())
    if candidate.locked[1] == "time":
        return max(run.time[-1] for run in runs) - min(run.time[0] for run in runs), 1.0, rows
    columns = [run.measured[:, run.signals.index(f"theta_{candidate.axis}")] for run in runs]
    rate = np.abs(row_motion(space, own[0]).rate) if rows else np.ones(1)
    turns = float(np.ptp(np.concatenate(columns))) / (2.0 * np.pi)
    return turns, float(np.median(rate)) / (2.0 * np.pi), rows


def _left(
    task: Task,
    trial: Trial,
    candidate: Candidate,
    frequency: float,
    residual: FloatArray,
    away: FloatArray,
) -> float:
    """Share of the square of a `residual` [n] that is left beside a wave of some frequency in any
    of its shapes; both projected off the columns `away` [n, nf].
    """
    assert candidate.locked is not None
    most = REACH * float(np.linalg.norm(residual))
    shapes = [{**shape, candidate.locked[0]: frequency} for shape in candidate.shapes]
    found = [response_columns(task, trial, candidate, shape, most) for shape in shapes]
    tables = [columns.table for columns in found if columns is not None]
    if not tables:
        return 1.0
    wave = projected_off(np.column_stack(tables), away)
    rest = projected_off(residual[:, None], wave)
    return float(np.sum(rest**2) / max(np.sum(residual**2), 1e-300))
