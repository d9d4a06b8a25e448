"""Spectral lines of a residual: where to start a frequency that is locked to time or to an angle.

A fit finds a frequency only from nearby, so the starts of such parameters are the strongest lines
of the residual's rate of change (Lomb, 1976, Astrophysics and Space Science 39).
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lombscargle

from ptp_symbolic.diagnose.candidates import Candidate
from ptp_symbolic.diagnose.floor import encoder_columns, residual_counts
from ptp_symbolic.diagnose.trial import Task
from ptp_symbolic.identify.evaluate import Evaluation
from ptp_symbolic.identify.fit import Fit
from ptp_symbolic.identify.run import Run

FloatArray = NDArray[np.float64]

LAG, LINES, CYCLES, FINENESS = 4, 2, 3.0, 3.0
MOST_FREQUENCIES = 1000


def with_lines(task: Task, fit: Fit, candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """`candidates` with locked frequencies started at the strongest residual lines of `fit`."""
    return tuple(task.executor.map(lambda candidate: _placed(task, fit, candidate), candidates))


def _placed(task: Task, fit: Fit, candidate: Candidate) -> Candidate:
    locks = {p.name: p.locked_to for p in task.model.parameters if p.locked_to is not None}
    starts = candidate.starts
    for index, free in enumerate(candidate.starts[0]):
        if free.name not in locks:
            continue
        found = [
            frequency
            for frequency in strongest_lines(fit, locks[free.name] == "angle", candidate.axis)
            if free.lower < frequency < free.upper
        ]
        starts = tuple(
            (*start[:index], replace(start[index], start=frequency), *start[index + 1 :])
            for start in starts
            for frequency in (found or [free.start])
        )
    return replace(candidate, starts=starts)


def strongest_lines(fit: Fit, by_angle: bool, axis: str | None) -> list[float]:
    """The strongest frequencies in Hz, or in cycles per turn of the measured angle of `axis`."""
    series = [s for run, e in fit.pairs() for s in _rates(run, e, by_angle, axis)]
    spans = [float(np.ptp(place)) for place, _ in series]
    if not spans or max(spans) == 0.0:
        return []
    unit = 2.0 * np.pi if by_angle else 1.0
    lowest, step = CYCLES / max(spans), 1.0 / (FINENESS * max(spans))
    fastest = max(lowest, 0.25 / max(_spacing(place) for place, _ in series))
    count = int(min(MOST_FREQUENCIES, (fastest - lowest) / step + 1))
    grid = lowest + step * np.arange(count)
    power = sum(
        lombscargle(place, rate - rate.mean(), 2.0 * np.pi * grid) * len(rate)
        for place, rate in series
    )
    return [float(unit * grid[k]) for k in _peaks(np.asarray(power))[:LINES]]


def _rates(
    run: Run, evaluation: Evaluation, by_angle: bool, axis: str | None
) -> list[tuple[FloatArray, FloatArray]]:
    """Place (time in s or angle in rad) and rate of change of every encoder residual."""
    found = []
    for column in encoder_columns(run):
        if axis is not None and not run.signals[column].endswith(axis):
            continue
        residual = residual_counts(run, evaluation, column)
        place = run.measured[:, column] if by_angle else run.time
        moving = np.abs(run.measured[LAG:, column] - run.measured[:-LAG, column]) > 0
        keep = moving if by_angle else np.ones(len(moving), dtype=bool)
        if keep.sum() > 10 * LAG:
            found.append((place[LAG:][keep], (residual[LAG:] - residual[:-LAG])[keep]))
    return found


def _spacing(place: FloatArray) -> float:
    """Typical distance between neighbours."""
    gaps = np.abs(np.diff(place))
    return float(np.median(gaps[gaps > 0])) if np.any(gaps > 0) else np.inf


def _peaks(power: FloatArray) -> list[int]:
    """Indices of local maxima, strongest first."""
    inner = np.flatnonzero((power[1:-1] >= power[:-2]) & (power[1:-1] >= power[2:])) + 1
    return [int(k) for k in inner[np.argsort(power[inner])[::-1]]]
