"""How well a machine repeats itself: what differs between runs with equal inputs.

No model that answers to its inputs alone can tell such runs apart, so that their difference is a
floor that needs no model: noise, and all that the machine does not do alike twice.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, FAR, MATERIAL, NOTHING
from ptp_symbolic.numeric.identify.noise import white_noise
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Repeatability:
    """Standard deviation [ny] of one run, from the differences of two with equal inputs, in the
    units of the signals, and the `names` of such runs, in pairs.
    """

    rms: FloatArray
    names: tuple[tuple[str, str], ...]


def repeatability(runs: Sequence[Run]) -> Repeatability | None:
    """The repeatability that whole `runs` show; None where no two have equal inputs and starts.

    Inputs are equal where they differ by no more than their noise, and by little beside what they
    vary; starts where they differ by less than FAR standard deviations of the signal.
    """
    pairs = [(a, b) for a, b in itertools.combinations(runs, 2) if _alike(a, b)]
    if not pairs:
        return None
    squares = np.vstack([0.5 * (a.measured - b.measured) ** 2 for a, b in pairs])
    return Repeatability(
        np.sqrt(np.mean(squares, axis=0)), tuple((a.name, b.name) for a, b in pairs)
    )


def _alike(a: Run, b: Run) -> bool:
    """Whether two runs have the same times, the same inputs and the same start."""
    if len(a.time) != len(b.time):
        return False
    period = float(np.median(np.diff(a.time)))
    if np.max(np.abs((a.time - a.time[0]) - (b.time - b.time[0]))) > 0.5 * period:
        return False
    for one, other in zip(a.held_inputs.T, b.held_inputs.T, strict=True):
        noise = ABOVE_NOISE * np.hypot(white_noise(one, a.time), white_noise(other, b.time))
        apart = float(np.sqrt(np.mean((one - other) ** 2)))
        if apart > min(noise, MATERIAL * float(np.std(one))) + NOTHING * np.max(np.abs(one)):
            return False
    far = FAR * np.sqrt(2.0) / a.weight
    return bool(np.all(np.abs(a.measured[0] - b.measured[0]) <= far))
