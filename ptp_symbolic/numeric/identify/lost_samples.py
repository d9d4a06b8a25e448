"""Runs of which samples are missing: where it matters what the inputs did meanwhile, a new part."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.data.continuity import IntArray, after_lost, parted
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.run import Run, with_start
from ptp_symbolic.numeric.identify.windows import piece_of
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.signals.inputs import held_values, stack, table

FloatArray = NDArray[np.float64]


def parted_at_lost_samples(model: Model, run: Run, p: FloatArray) -> tuple[Run, ...]:
    """The run, or its parts where the signals depend on what the inputs did while samples were
    missing, at p [np]: held until the next sample, or changed right after the last one, they would
    move some signal by more than its noise.
    """
    gaps = after_lost(run.time)
    parts = parted(run.time, gaps) if gaps.size else []
    if len(parts) < 2 or not _matters(model, run, p, gaps):
        return (run,)
    return tuple(
        with_start(model, piece_of(run, part, number), underway=part.start > 0)
        for number, part in enumerate(parts, start=1)
    )


def _matters(model: Model, run: Run, p: FloatArray, gaps: IntArray) -> bool:
    """Whether inputs that change at the beginning of the gaps before the samples `gaps`, not at
    their ends, move a signal by more than its noise.
    """
    none = np.zeros(0, dtype=np.int64)
    at_end, at_begin = (
        evaluate(model, one, p, run.guess, none, False, Tolerance())
        for one in (run, _changed_at_begin(run, gaps))
    )
    if at_end.failed or at_begin.failed:
        return True
    moved = (at_end.residual - at_begin.residual).reshape(run.measured.shape)
    return bool(np.any(np.mean(moved**2, axis=0) > 1.0))


def _changed_at_begin(run: Run, gaps: IntArray) -> Run:
    """The run with inputs that change right after the last samples before the gaps."""
    signals = []
    for times, values in held_values(run.inputs):
        earlier = values.copy()
        for gap in gaps:
            inside = (times >= run.time[gap - 1]) & (times < run.time[gap])
            held = max(0, int(np.searchsorted(times, run.time[gap], side="right")) - 1)
            earlier[inside] = values[held]
        signals.append(table(times, earlier, "hold"))
    return replace(run, inputs=stack(signals))
