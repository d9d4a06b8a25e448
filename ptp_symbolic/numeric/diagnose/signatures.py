"""What every candidate would change in the weak-form rows.

A candidate's signature is a set of columns: the rows with a finite amount of each parameter that
switches it on, minus the rows without, at every set of values of the parameters that shape it. Its
span holds, or nearly holds, everything that the candidate can do. A frequency is scanned.
"""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.identify.constants import (
    ATTENUATED,
    BINS_PER_CYCLE,
    CYCLES_APART,
    DECLARED_AMOUNT,
    LEAST_CYCLES,
    SAME,
    STEP,
    TRIED,
)
from ptp_symbolic.numeric.identify.equation_space import EquationSpace, row_motion

FloatArray = NDArray[np.float64]
Rows = Callable[[Mapping[str, float]], FloatArray]  # see `rows_around`


@dataclass(frozen=True, eq=False)
class Signature:
    """What a candidate, with its frequency, changes in the rows.

    `slopes` gives, for every set of shaping values and every defining parameter, the difference
    quotient [n] of the rows by it; `finite` the defining parameters that show only at the whole
    amount with which their search begins. `columns` [n, c] span all of that, orthonormal when rows
    count by their weight.
    """

    candidate: Candidate
    slopes: tuple[tuple[FloatArray, ...], ...]
    finite: frozenset[str]
    columns: FloatArray


def rows_around(space: EquationSpace, values: Mapping[str, float]) -> Rows:
    """The rows of `space` at the parameter `values` with some of them changed, each set of changes
    evaluated once; beyond their bounds too, for a frequency of zero. The torque is the model's own
    one at `values`.
    """
    vector = space.model.parameter_vector(dict(values))
    own = space.own_torque(vector)
    number = {name: k for k, name in enumerate(space.model.parameter_names)}
    known: dict[tuple[tuple[str, float], ...], FloatArray] = {}

    def rows(changed: Mapping[str, float]) -> FloatArray:
        key = tuple(sorted(changed.items()))
        if key not in known:
            p = vector.copy()
            for name, value in changed.items():
                p[number[name]] = value
            known[key] = space.rows(p, own)
        return known[key]

    return rows


def signatures(
    space: EquationSpace,
    candidates: Sequence[Candidate],
    rows: Rows,
    weight: FloatArray,
    executor: Executor | None = None,
) -> tuple[list[Signature], list[Candidate]]:
    """Signatures of candidates without a frequency, or with a known one, by the `rows` of `space`
    (see `rows_around`), each row counted by its `weight` [n]; and candidates that change nothing
    along the measured motion.
    """
    by_key = {c.key: c for c in reversed(candidates)}

    def signature(candidate: Candidate) -> Signature:
        return _signature(candidate, brought(candidate, by_key), rows, weight)

    rows({})
    wanted = [c for c in candidates if c.locked is None or has_its_frequency(c)]
    run = executor.map if executor else map
    found = list(run(signature, wanted))
    space.forget()
    seen = [s for s in found if s.columns.shape[1]]
    keys = {s.candidate.key for s in seen}
    return seen, [c for c in wanted if c.key not in keys]


def brought(candidate: Candidate, by_key: Mapping[str, Candidate]) -> dict[str, float]:
    """Start values of the candidates that `candidate` brings along, so that it has what to act
    on.
    """
    return {name: f.start for key in candidate.brings for f in by_key[key].free for name in f.names}


def _signature(
    candidate: Candidate,
    base: Mapping[str, float],
    rows: Rows,
    weight: FloatArray,
) -> Signature:
    """Difference quotients of `rows` by every defining parameter at every set of shaping values."""
    finite: set[str] = set()
    slopes = []
    for shape in candidate.shapes:
        without, columns = rows({**base, **shape}), []
        for f in candidate.defining:
            zero, whole = candidate.vanishing[f.name], f.start
            if candidate.is_declared_value:
                whole = min(f.start * (1.0 + DECLARED_AMOUNT), 0.5 * (f.start + f.upper))
            column = np.zeros(len(weight))
            small = zero + STEP * (whole - zero)
            for amount in (whole,) if f.name in candidate.whole_only else (small, whole):
                changed = dict.fromkeys(f.names, amount)
                column = (rows({**base, **shape, **changed}) - without) / (amount - zero)
                if amount == whole:
                    finite.add(f.name)
                if np.any(column):
                    break
            columns.append(column)
        slopes.append(tuple(columns))
    span = _orthonormal(np.column_stack([c for columns in slopes for c in columns]), weight)
    return Signature(candidate, tuple(slopes), frozenset(finite), span)


def _orthonormal(columns: FloatArray, weight: FloatArray) -> FloatArray:
    """The span of `columns` [n, k], orthonormal when rows count by `weight`."""
    root = np.sqrt(weight)[:, None]
    weighted = columns * root
    size = np.linalg.norm(weighted, axis=0)
    weighted = weighted[:, size > 0.0] / size[size > 0.0]
    if not weighted.shape[1]:
        return np.zeros((len(weight), 0))
    left, values, _ = np.linalg.svd(weighted, full_matrices=False)
    return left[:, values > SAME * values[0]] / root


def locked_signatures(
    space: EquationSpace,
    candidates: Sequence[Candidate],
    rows: Rows,
    residual: FloatArray,
    weight: FloatArray,
) -> list[Signature]:
    """Signatures of candidates with a frequency by the `rows` of `space` (see `rows_around`), at
    each of the strongest lines of the weighted `residual` [n]; `weight` [n].

    A full scan over the place (time, or the angle of the candidate's axis): all frequencies from a
    few cycles over the whole range to those that the windows average away. What the wave moves may
    turn with the machine: the residual is scanned as the candidate at no frequency shows it.
    """
    by_key = {c.key: c for c in reversed(candidates)}
    found = []
    lines: dict[str, tuple[list[float], float, int]] = {}
    for candidate in candidates:
        if candidate.locked is None or has_its_frequency(candidate):
            continue
        name, _ = candidate.locked
        if candidate.key not in lines:
            still = tuple({**shape, name: 0.0} for shape in candidate.shapes)
            constant = _signature(
                replace(candidate, shapes=still), brought(candidate, by_key), rows, weight
            )
            lines[candidate.key] = _strongest(space, candidate, residual, weight, constant.columns)
        strongest, lowest, compared = lines[candidate.key]
        for frequency in strongest:
            placed = at_line(candidate, frequency, lowest, compared)
            if placed is not None:
                found.append(_signature(placed, brought(placed, by_key), rows, weight))
    return [s for s in found if s.columns.shape[1]]


def has_its_frequency(candidate: Candidate) -> bool:
    """Whether the frequency of a candidate that has one is known."""
    return candidate.locked is not None and candidate.locked[0] in candidate.shapes[0]


def at_line(
    candidate: Candidate, frequency: float, lowest: float, compared: int
) -> Candidate | None:
    """The candidate at a frequency that was found among so many `compared`, the `lowest` of which
    is its new bound; None where the frequency is out of its bounds.
    """
    assert candidate.locked is not None
    name, _ = candidate.locked
    limits = next(f for f in candidate.free if f.name == name)
    least = max(lowest, limits.lower)
    if not least < frequency < limits.upper:
        return None
    line = replace(limits, start=frequency, scale=CYCLES_APART * frequency, lower=least)
    free = tuple(line if f.name == name else f for f in candidate.free)
    shapes = tuple({**shape, name: frequency} for shape in candidate.shapes)
    return replace(candidate, free=free, shapes=shapes, frequencies_compared=compared)


def axes_of(space: EquationSpace, candidate: Candidate) -> list[int]:
    """Numbers of the axes on which a candidate acts: all of them where it has none of its own."""
    axes = space.model.module.AXES
    return [axes.index(candidate.axis)] if candidate.axis else list(range(len(axes)))


def band(
    space: EquationSpace, candidate: Candidate, span: float, speed: float
) -> tuple[float, float]:
    """The lowest frequency of which a few cycles fit into a `span` of its place, in s or turns, and
    the highest that the windows of the rows do not average away where that goes at `speed`, per s.
    """
    assert candidate.locked is not None
    limits = next(f for f in candidate.free if f.name == candidate.locked[0])
    highest = ATTENUATED / max(2.0 * space.half_width * speed, 1e-12)
    return max(LEAST_CYCLES / max(span, 1e-12), limits.lower), min(highest, limits.upper)


def _strongest(
    space: EquationSpace,
    candidate: Candidate,
    residual: FloatArray,
    weight: FloatArray,
    carriers: FloatArray,
) -> tuple[list[float], float, int]:
    """The frequencies in Hz, or in cycles per turn, of the strongest lines of the residual torques,
    the lowest that is a line, and how many can be resolved; none where the axis of the candidate
    never moves.

    `carriers` [n, m] is what the candidate does at no frequency, orthonormal when rows count by
    `weight`: over many cycles sines and cosines on them are orthogonal too, so that the squared
    transforms of the residual on each add up to what a wave of that frequency reduces its square
    by.
    """
    equation, _, time = space.labels()
    assert candidate.locked is not None
    by_angle = candidate.locked[1] == "angle"
    own = axes_of(space, candidate)
    rows = np.isin(equation, own)
    if not rows.any():  # an axis that rests throughout has no rows, and nothing moves along it
        return [], 0.0, 1
    place, speed = time[rows], np.ones(int(rows.sum()))
    if by_angle:
        place, speed, _ = row_motion(space, own[0])
    turn = 2.0 * np.pi if by_angle else 1.0
    place = (place - place.min()) / turn
    span = max(float(place.max()), 1e-12)
    lowest, highest = band(space, candidate, span, float(np.quantile(np.abs(speed), 0.1)) / turn)
    if highest <= lowest:
        return [], 0.9 * lowest, 1
    width = 1.0 / (BINS_PER_CYCLE * highest)
    bins = (place / width).astype(np.int64)
    value = residual[rows] * weight[rows]
    count = int(span / (width * CYCLES_APART)) + 1
    frequency = np.fft.rfftfreq(count, width)
    power = np.zeros(len(frequency))
    for carrier in carriers[rows].T:
        power += np.abs(np.fft.rfft(np.bincount(bins, weights=value * carrier), count)) ** 2
    power[(frequency < lowest) | (frequency > highest)] = 0.0
    apart = max(1, int((highest - lowest) * span))
    (peaks,) = np.nonzero((power[1:-1] > power[:-2]) & (power[1:-1] >= power[2:]))
    strongest = 1 + peaks[np.argsort(-power[1 + peaks])[:TRIED]]
    return [float(f) for f in frequency[strongest]], 0.9 * lowest, apart
