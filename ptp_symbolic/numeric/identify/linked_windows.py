"""Windows of a log that follow one another: each begins where the simulated one before it ended."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import FAR
from ptp_symbolic.numeric.identify.evaluate import start_state
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


def linked(runs: Sequence[Run]) -> list[list[int]]:
    """Indices of the runs: windows that begin with the last sample of the one before, and have a
    gap of which no sensor tells the place, together; all others alone.
    """
    series: list[list[int]] = []
    for index, run in enumerate(runs):
        if series and _follows(run, runs[series[-1][-1]]):
            series[-1].append(index)
        else:
            series.append([index])
    return series


def has_linked(runs: Sequence[Run]) -> bool:
    """Whether any run is a window that follows another (see `linked`)."""
    return len(linked(runs)) < len(runs)


def _follows(run: Run, before: Run) -> bool:
    return (
        run.source == before.source
        and run.time[0] == before.time[-1]
        and any(unknown.contact is not None for unknown in run.unknowns)
    )


def carried_start(model: Model, run: Run, p: FloatArray, end: FloatArray) -> FloatArray:
    """Start unknowns [nz] of a window, at p [np], with all that is hidden as it was in the state
    `end` [n] of the one before. What sensors show is as it was too, as far as the noise of the
    guess allows: a joint that came to rest rests.
    """
    states, z = list(model.state_names), run.guess
    for index, unknown in enumerate(run.unknowns):
        if unknown.contact is not None:
            z[index] = 0.0
            z[index] = _place(model, run, p, z, index, unknown.contact, end)
        elif unknown.name.startswith("omega_gear_"):
            gear = states.index(unknown.name)
            joint = states.index(unknown.name.replace("omega_gear_", "omega_"))
            z[index] = (end[gear] - end[joint]) - (run.start[gear] - run.start[joint])
        else:
            state = states.index(unknown.name)
            moved = float(end[state] - run.start[state])
            z[index] = moved if abs(moved) <= FAR * unknown.sigma else 0.0
    return z


def _place(
    model: Model,
    run: Run,
    p: FloatArray,
    z: FloatArray,
    index: int,
    contact: int,
    end: FloatArray,
) -> float:
    """Place in the gap of a `contact`, unknown `index` of z, at which the gear is as far ahead of
    its joint as at the `end`; the middle of a gap that has no width. `z` has the gear in the
    middle, and all unknowns of its joint.
    """
    unknown = run.unknowns[index]
    gear, joint = model.module.CONTACT_ANGLES[contact]
    x, tangents = start_state(model, run, p, z, np.zeros(0, dtype=np.int64))
    ahead = (end[gear] - end[joint]) - (x[gear] - x[joint])
    half = tangents[gear, index]
    return float(np.clip(ahead / half, unknown.lower, unknown.upper)) if half > 0.0 else 0.0
