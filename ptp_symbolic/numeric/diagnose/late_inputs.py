"""Where a candidate begins that lets an input act late.

A current that follows its voltage within a sample tells of a delay only how many samples it lasts:
between whole numbers of them the rows stay as they are, and no difference quotient at a small delay
leads to a large one. Whole numbers are compared instead.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.signatures import Rows, brought
from ptp_symbolic.numeric.identify.constants import STEP
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.sample_averages import usual_period

FloatArray = NDArray[np.float64]


def at_best_delays(
    space: EquationSpace, candidates: Sequence[Candidate], rows: Rows, weight: FloatArray
) -> tuple[Candidate, ...]:
    """The candidates, effects that delay an input begun at a whole number of samples where that
    leaves less of the `rows` (see `rows_around`), each counted by its `weight` [n], than their
    tangent does. The number is doubled as long as that leaves less, within the windows of the rows,
    then found by halving: most inputs are smooth, or change seldom, over such times.
    """
    delays = {
        space.model.parameter_names[index] for index in space.model.input_delays if index >= 0
    }
    by_key = {c.key: c for c in reversed(candidates)}

    def begun(candidate: Candidate) -> Candidate:
        if candidate.is_declared_value:
            return candidate
        base = brought(candidate, by_key)
        free = tuple(
            _at_best(space, f, base, candidate.vanishing[f.name], rows, weight)
            if f.name in delays and f.name in candidate.vanishing
            else f
            for f in candidate.free
        )
        late = {f.name for f, one in zip(free, candidate.free, strict=True) if f != one}
        return replace(candidate, free=free, whole_only=frozenset(late)) if late else candidate

    return tuple(map(begun, candidates))


def _at_best(
    space: EquationSpace,
    f: FreeParameter,
    base: Mapping[str, float],
    zero: float,
    rows: Rows,
    weight: FloatArray,
) -> FreeParameter:
    """A delay `f` that vanishes at `zero`, where its candidate begins (see `at_best_delays`);
    `base` are the values of what that brings along.
    """
    period = usual_period(space.runs)
    most = int(min(space.half_width, f.upper - zero) / period + 1e-6)

    def late(delay: float) -> FloatArray:
        return rows({**base, **dict.fromkeys(f.names, zero + delay)})

    def loss(samples: int) -> float:
        return float(weight @ late(samples * period) ** 2) if 0 <= samples <= most else np.inf

    without, small = late(0.0), STEP * (f.start - zero)
    column = late(small) - without
    taken = float(weight @ (column * without)) ** 2 / max(float(weight @ column**2), 1e-300)
    best, least = 0, float(weight @ without**2)
    by_tangent = least - taken
    doubled = 1
    while (left := loss(doubled)) < least:
        best, least, doubled = doubled, left, 2 * doubled
    step = best
    while step > 1:
        step //= 2
        left, at = min((loss(samples), samples) for samples in (best - step, best + step))
        if left < least:
            best, least = at, left
    if least >= by_tangent:
        return f
    return replace(f, start=zero + best * period, scale=best * period)
