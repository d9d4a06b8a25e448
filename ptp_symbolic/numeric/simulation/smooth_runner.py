"""The compiled runner for smooth motion: adaptive steps of order 8, without events or tangents.

Steps end at every stop (sample of a zero-order hold, break of a profile). The ledger is two more
states, the work supplied and dissipated in J, integrated beside the others; its balance is checked
at the end of every step. Outputs inside a step come from the interpolant, which takes three slopes
more and is made only where one is asked for.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import njit, types

from ptp_symbolic.numeric.simulation.ahead import SMOOTH_RUNNER, made_once
from ptp_symbolic.numeric.simulation.input_values import evaluate_inputs
from ptp_symbolic.numeric.simulation.kernels.calls import call
from ptp_symbolic.numeric.simulation.kernels.records import (
    DIVERGED,
    DONE,
    EXHAUSTED,
    INNER,
    INTEGERS,
    KERNEL,
    LARGEST_STATE,
    MATRIX,
    SHORTEST,
    TABLE,
    TIME_RESOLUTION,
    TOO_FAST,
    VECTOR,
    clear,
    copy,
    flush,
    source_stamp,
)
from ptp_symbolic.numeric.simulation.methods.dormand_prince import (
    ALL_STAGES,
    ERROR_3,
    ERROR_5,
    INTERPOLANT,
    POWERS,
    STAGES,
    A,
    C,
)

# Rows of the work: slopes of the stages, interpolant, state at both ends, argument of a stage,
# and slope of the interpolant.
DENSE, START, END = ALL_STAGES, ALL_STAGES + POWERS, ALL_STAGES + POWERS + 1
POINT, PROBED, ROWS = END + 1, END + 2, END + 3
LANES = 4
AT_START = np.array([0, 1])
OF_STEP_STAGES, INSIDE_STAGES = np.array([1, STAGES + 1]), np.array([STAGES + 1, ALL_STAGES])
# Of the clock [5] and the counts [4].
REACHED, LENGTH, STORED = 0, 1, 2
OUTPUT, TRIED, UNBALANCED, SOURCES = 0, 1, 2, 3

NEXT_TO_NONE = 1e-9  # of a step: rounding in what remains makes no step of its own
SAFETY, LEAST, MOST = 0.9, 0.2, 5.0  # factors from one step length to the next
PROBE = 2.0 / 3.0  # of a step: where the slope of the interpolant is off most
OF_DEFECT = 0.2  # error of the interpolant over that of its slope between its roots nearby
INSIDE = 5.0  # tolerances: errors there do not add up
SMALLEST_ERROR, LARGEST_ERROR = (
    1e-6,
    1e10,
)  # over the tolerance; beyond, the factors are LEAST, MOST
OF_STEP, OF_RUN, ROUNDING = 10.0, 0.01, 1e-14  # of the balance, by energy in the step and before
SHORTEST_FOR_LEDGER, MOST_UNBALANCED = 1e-9, 100  # s, steps

CONTRACTED = INNER | {"fastmath": {"contract"}}  # products and sums in one operation
kernel, inlined = njit(**CONTRACTED), njit(forceinline=True, **CONTRACTED)
merged = njit(inline="always", **CONTRACTED)


class Motion(NamedTuple):
    """A model, its inputs and its tolerances: arguments of the runner, see SIGNATURE."""

    functions: Any
    p: Any
    m: Any
    prepared: Any
    table: Any
    cursor: Any
    held: Any
    u: Any
    limits: Any
    atol: Any
    work: Any
    clock: Any
    counts: Any


@inlined
def add_slopes(weights, count, h, work, start, out):
    """Write row `start` of the work plus h times the weighted sum of its first `count` rows into
    out [w], four states at a time.
    """
    for a in range(0, len(out), LANES):
        w0, w1, w2, w3 = 0.0, 0.0, 0.0, 0.0
        for j in range(count):
            weight = weights[j]
            w0 += weight * work[j, a]
            w1 += weight * work[j, a + 1]
            w2 += weight * work[j, a + 2]
            w3 += weight * work[j, a + 3]
        out[a] = start[a] + h * w0
        out[a + 1] = start[a + 1] + h * w1
        out[a + 2] = start[a + 2] + h * w2
        out[a + 3] = start[a + 3] + h * w3


@merged
def fill_slopes(stages, motion, t, h):
    """Evaluate the slopes of `stages`, the first and the one after the last, of the step of h s
    from t: rows of the work [27, w].

    With a ledger both powers in W follow the n states, and the stored energy in J is in the clock.
    """
    work, u, n, point = motion.work, motion.u, len(motion.atol), motion.work[POINT]
    energies = motion.clock[STORED:]
    for i in range(stages[0], stages[1]):
        time = t + C[i] * h
        add_slopes(A[i], i, h, work, work[START], point)
        if not motion.held:
            evaluate_inputs(time, -1 if C[i] == 1.0 else 1, *motion.table, motion.cursor, u)
        call(motion.functions[0], time, point, u, motion.p, motion.m, motion.prepared, work[i])
        if motion.functions[1] != 0:
            call(motion.functions[1], time, point, u, motion.p, motion.m, energies)
            work[i, n], work[i, n + 1] = energies[1], energies[2]


@merged
def local_error(h, motion):
    """Estimated local error of a step over its tolerance: that of order 5, with less weight where
    that of order 3 is much larger; NaN where a state is.
    """
    work, atol = motion.work, motion.atol
    fifth, third = 0.0, 0.0
    for a in range(len(atol)):
        e5, e3 = 0.0, 0.0
        for i in range(STAGES):
            e5 += ERROR_5[i] * work[i, a]
            e3 += ERROR_3[i] * work[i, a]
        largest = max(abs(work[START, a]), abs(work[END, a]))
        tolerance = atol[a] + motion.limits[0] * largest
        if not abs(e5) + abs(e3) < np.inf:
            return np.inf
        fifth, third = max(fifth, abs(e5) / tolerance), max(third, abs(e3) / tolerance)
    if fifth == 0.0:
        return 0.0
    return h * fifth * fifth / np.sqrt(fifth * fifth + 0.01 * third * third)


@merged
def imbalance(h, stored, motion):
    """Residual of the energy balance of a step over its tolerance; `stored` in J at its start.

    Where many of the shortest steps do not balance, the energies of the model do not, and steps are
    no longer shortened for them.
    """
    work, rtol, size = motion.work, motion.limits[0], abs(motion.clock[STORED])
    n = len(motion.atol)
    supplied, dissipated = work[END, n] - work[START, n], work[END, n + 1] - work[START, n + 1]
    change = motion.clock[STORED] - stored
    through = abs(supplied) + abs(dissipated) + abs(change)
    before = size + abs(work[START, n]) + abs(work[START, n + 1])
    missing = abs(change - supplied + dissipated) - ROUNDING * size
    if missing <= rtol * (OF_STEP * through + OF_RUN * before):
        return 0.0
    if h < SHORTEST_FOR_LEDGER:
        motion.counts[UNBALANCED] += 1
    if h < SHORTEST_FOR_LEDGER or motion.counts[UNBALANCED] > MOST_UNBALANCED:
        return 0.0
    return missing / (rtol * (OF_STEP * through + OF_RUN * before))


@merged
def plan(error, h, clock):
    """Plan the next step from the error of one of h s over its tolerance; False to repeat that.

    A step that a stop has cut short says that longer ones are possible, not how long: the plan
    stays where it is longer.
    """
    factor = LEAST
    if error < SMALLEST_ERROR:
        factor = MOST
    elif error < LARGEST_ERROR:
        factor = min(MOST, max(LEAST, SAFETY / np.sqrt(np.sqrt(np.sqrt(error)))))
    if not error <= 1.0:
        clock[LENGTH] = h * min(factor, SAFETY)
        return False
    clock[LENGTH] = h * factor if clock[LENGTH] <= h else max(clock[LENGTH], h * factor)
    return True


@merged
def try_step(motion, t, h, times):
    """Try a step of h s from t; False where it must be repeated, as planned."""
    clock, stored = motion.clock, motion.clock[STORED]
    motion.counts[TRIED] += 1
    fill_slopes(OF_STEP_STAGES, motion, t, h)
    copy(motion.work[POINT], motion.work[END])
    after = clock[STORED]
    error = local_error(h, motion)
    if error <= 1.0 and motion.functions[1] != 0:
        error = max(error, imbalance(h, stored, motion))
    if error <= 1.0 and next_output(motion, times) < t + h - TIME_RESOLUTION:
        error = max(error, error_inside(motion, t, h))
    accepted = plan(error, h, clock)
    clock[STORED] = after if accepted else stored
    return accepted


@merged
def error_inside(motion, t, h):
    """Make the interpolant of a step; returns its estimated error over its tolerance.

    The slope of the interpolant is compared with that of the motion where they differ most.
    """
    work, atol, u, time = motion.work, motion.atol, motion.u, t + PROBE * h
    fill_slopes(INSIDE_STAGES, motion, t, h)
    fill_interpolant(h, work)
    interpolate(PROBE, work)
    point, slope = work[POINT], work[PROBED]
    if not motion.held:
        evaluate_inputs(time, 1, *motion.table, motion.cursor, u)
    call(motion.functions[0], time, point, u, motion.p, motion.m, motion.prepared, slope)
    worst = 0.0
    for a in range(len(atol)):
        value, by_fraction = 0.0, 0.0
        for row in range(POWERS - 1, -1, -1):
            part, sign = (PROBE, 1.0) if row % 2 == 0 else (1.0 - PROBE, -1.0)
            value += work[DENSE + row, a]
            by_fraction = by_fraction * part + value * sign
            value *= part
        tolerance = atol[a] + motion.limits[0] * abs(point[a])
        worst = max(worst, abs(by_fraction - h * slope[a]) / tolerance)
    return worst * OF_DEFECT / INSIDE


@merged
def fill_interpolant(h, work):
    """Write the coefficients [7, w] of the interpolant of a step, in the order of `interpolate`."""
    for a in range(work.shape[1]):
        change = work[END, a] - work[START, a]
        work[DENSE, a] = change
        work[DENSE + 1, a] = h * work[0, a] - change
        work[DENSE + 2, a] = 2.0 * change - h * (work[STAGES, a] + work[0, a])
    clear(work[DENSE + 3])
    for row in range(POWERS - 1, 2, -1):
        add_slopes(INTERPOLANT[row - 3], ALL_STAGES, h, work, work[DENSE + 3], work[DENSE + row])


@kernel
def interpolate(fraction, work):
    """Evaluate the interpolant at a fraction of the step into the argument of a stage."""
    for a in range(work.shape[1]):
        value = 0.0
        for row in range(POWERS - 1, -1, -1):
            part = fraction if row % 2 == 0 else 1.0 - fraction
            value = (value + work[DENSE + row, a]) * part
        work[POINT, a] = work[START, a] + value


@kernel
def write_output(motion, t, state, out, ledger):
    """Write a state [w] at t in s, and its energies, into the next row of the outputs."""
    row, n = motion.counts[OUTPUT], out.shape[1]
    copy(state, out[row])
    if len(ledger) > 0:
        call(motion.functions[1], t, state, motion.u, motion.p, motion.m, ledger[row])
        ledger[row, 1], ledger[row, 2] = state[n], state[n + 1]
    motion.counts[OUTPUT] = row + 1


@merged
def write_inside(motion, t, h, t_new, times, out, ledger):
    """Write the outputs at the `times` [k] between t and t_new in s, ends of a step."""
    while next_output(motion, times) < t_new - TIME_RESOLUTION:
        time = times[motion.counts[OUTPUT]]
        interpolate((time - t) / h, motion.work)
        write_output(motion, time, motion.work[POINT], out, ledger)


@kernel
def next_output(motion, times):
    """Time of the next output in s; infinite after the last."""
    row = motion.counts[OUTPUT]
    return times[row] if row < len(times) else np.inf


@merged
def advance(motion, stop, times, out, ledger):
    """Integrate up to `stop` in s, the state in row START of the work; returns a status."""
    work, clock, limits = motion.work, motion.clock, motion.limits
    fill_slopes(AT_START, motion, clock[REACHED], 0.0)
    while stop - clock[REACHED] > TIME_RESOLUTION:
        if motion.counts[TRIED] >= limits[2]:
            return EXHAUSTED
        t, h = clock[REACHED], min(clock[LENGTH], limits[1])
        remaining = stop - t
        h = remaining if h >= remaining else remaining / np.ceil(remaining / h - NEXT_TO_NONE)
        if not try_step(motion, t, h, times):
            if clock[LENGTH] < SHORTEST:
                return TOO_FAST
            continue
        for a in range(len(motion.atol)):
            if not abs(work[END, a]) < LARGEST_STATE:
                return DIVERGED
        t_new = stop if h == remaining else t + h
        write_inside(motion, t, h, t_new, times, out, ledger)
        clock[REACHED] = t_new
        flush(work[END])
        copy(work[END], work[START])
        copy(work[STAGES], work[0])
    clock[REACHED] = stop
    return DONE


SIGNATURE = types.int64(
    INTEGERS,  # addresses of the derivative and of the energies, the latter 0 without a ledger
    VECTOR,  # parameters
    VECTOR,  # modes, of which there are none
    VECTOR,  # what is prepared of the parameters
    TABLE,
    INTEGERS,  # cursor [nu]
    types.boolean,  # inputs are constant between stops
    VECTOR,  # inputs [nu]
    VECTOR,  # rtol, largest step, most steps
    VECTOR,  # atol [n]
    MATRIX,  # work [27, w], w a multiple of LANES: n states, work supplied and dissipated, zeros
    VECTOR,  # clock: time reached, planned step, stored energy and both powers
    INTEGERS,  # counts: outputs, steps tried, steps that do not balance, stamp of the sources
    VECTOR,  # stops, the first is the start
    VECTOR,  # output times [k]
    MATRIX,  # outputs [k, n]
    MATRIX,  # ledger [k, 3], or no rows
)


def compiled_runner(sources: int) -> Callable[..., int]:
    """The compiled runner, stamped with the `sources` it comes from (see `source_stamp`)."""

    @njit(SIGNATURE, cache=True, fastmath={"contract"}, **KERNEL)
    def run(
        functions,
        p,
        m,
        prepared,
        table,
        cursor,
        held,
        u,
        limits,
        atol,
        work,
        clock,
        counts,
        stops,
        times,
        out,
        ledger,
    ):
        """Integrate from the first to the last stop, the state in row START; returns a status."""
        counts[SOURCES] = sources
        motion = Motion(
            functions,
            p,
            m,
            prepared,
            table,
            cursor,
            held,
            u,
            limits,
            atol,
            work,
            clock,
            counts,
        )
        clock[REACHED], clock[LENGTH] = stops[0], limits[1]
        for stop in stops:
            status = advance(motion, stop, times, out, ledger)
            if status != DONE:
                return status
            while next_output(motion, times) <= stop + TIME_RESOLUTION:
                write_output(motion, stop, work[START], out, ledger)
            evaluate_inputs(stop, 1, *table, cursor, u)
        return DONE

    return run


@lru_cache(maxsize=1)
def runner() -> Callable[..., int]:
    """The runner, compiled when it is first needed: some seconds once on a new machine."""
    return made_once(SMOOTH_RUNNER, lambda: compiled_runner(source_stamp()))
