"""The compiled loop over trajectories that stand side by side, one step of all of them at a time.

Everything that it calls stands here: numba keeps compiled code until this file changes.
"""

import math
import warnings
from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import NumbaExperimentalFeatureWarning, njit, types

from ptp_symbolic.numeric.simulation.kernels.records import INNER, KERNEL

STAGES = 12
NEW, EXTRA = 12, 13  # rows of the slopes: at the end of the step, then three for dense output
ALL = 16
ERROR_5, ERROR_3, DENSE = 16, 17, 18  # rows of the tableau
BLOCK = 4  # slopes that are added at once
TINY = 1e-200  # products with tolerances must not be denormal
MOST_SHRINK, MOST_GROWTH = 0.2, 6.0  # of a step
LEAST_ERROR = 1e-8  # scaled; the step grows no further below
SHORTEST_STEP = 1e-11  # s
LARGEST_STATE = 1e12
AMPLITUDE, PHASE, TURN, CHIRP, ORIGIN, BEGIN, END = range(7)

# numba warns of functions as arguments at every compilation; what it has of them is enough here.
warnings.filterwarnings("ignore", "First-class function type", NumbaExperimentalFeatureWarning)
_V, _I = types.float64[::1], types.int64[::1]
_M, _T = types.float64[:, ::1], types.int64[:, ::1]
_IN_PLACE = types.FunctionType(types.void(_V))
_PREPARE = types.FunctionType(types.void(_V, _V))
_RUNS = (_M, _M, _I, _I, _V, _V, _V, _I, types.float64[:, :, ::1], _I, types.boolean[::1])
_C = types.float64[:, :, ::1]
_LANES = (*[_V] * 4, _M, _M, _M, *[_V] * 3, _M, *[_V] * 3, _M, *[_V] * 5, _M, _C, _C, _M, _M, _V)
_LANES += (*[_I] * 5, _T, _M, _V, _V)
_kernel = njit(**INNER)
_inlined = njit(forceinline=True, **INNER)  # per lane: records are long arguments


class Lanes(NamedTuple):
    """What stands side by side: rows of L numbers, one per trajectory, in flat arrays.

    w: what the emitted derivative reads and writes, and in it t, state, u, constants, dx; k
    [16, n]: slopes; x, new, total (by rows: errors), error5, length, atol [n]: states at both ends
    of the step, weighted slopes, step length in s, tolerance; dense [4, n]; time, plan, h, norm,
    factor: time, planned and present step in s, scaled error and what it makes of the step; base
    [nu], cubic [4, nu]: pieces of the inputs; wave [4, r nu], active, angle [r nu]: their sines;
    who, stop, output, first, ends: trajectory or -1, indices of the next stop, output time and
    signal, whether the step ends at a stop; cursor, until [nu]: pieces found last, and their ends;
    given, ready: a parameter vector and what is prepared of it.
    """

    w: Any
    t: Any
    state: Any
    dx: Any
    u: Any
    constants: Any
    k: Any
    x: Any
    new: Any
    total: Any
    errors: Any
    error5: Any
    length: Any
    atol: Any
    dense: Any
    time: Any
    plan: Any
    h: Any
    norm: Any
    factor: Any
    base: Any
    cubic: Any
    wave: Any
    active: Any
    angle: Any
    angles: Any
    who: Any
    stop: Any
    output: Any
    first: Any
    ends: Any
    cursor: Any
    until: Any
    given: Any
    ready: Any


class Runs(NamedTuple):
    """The trajectories: parameters p [b, np], start [b, n], kind of drive [b], which are `todo`,
    times [k] in s, limits [3]: rtol, largest step in s, most steps; stops in s of every
    kind of drive, where these begin; states out [b, k, n], steps [b], whether the end was reached.
    """

    p: Any
    start: Any
    drive: Any
    todo: Any
    times: Any
    limits: Any
    stops: Any
    stop_offsets: Any
    out: Any
    steps: Any
    done: Any


@_kernel
def _copy(source, target):
    for q in range(len(target)):
        target[q] = source[q]


@_kernel
def _add_blocks(row, count, method, k, total):
    """Write the sum of the first `count` weighted slopes k [16, width] of a row into total."""
    weights, stages, _, _ = method
    for i in range(0, count, BLOCK):
        w0, w1, w2, w3 = (
            weights[row, i],
            weights[row, i + 1],
            weights[row, i + 2],
            weights[row, i + 3],
        )
        k0, k1 = k[stages[row, i]], k[stages[row, i + 1]]
        k2, k3 = k[stages[row, i + 2]], k[stages[row, i + 3]]
        if i == 0:
            for q in range(len(total)):
                total[q] = (w0 * k0[q] + w1 * k1[q]) + (w2 * k2[q] + w3 * k3[q])
        else:
            for q in range(len(total)):
                total[q] += (w0 * k0[q] + w1 * k1[q]) + (w2 * k2[q] + w3 * k3[q])


@_kernel
def _weigh(row, method, k, total):
    """Write the weighted sum of the slopes k [16, width] of a row of the tableau into total."""
    _add_blocks(row, method[2][row], method, k, total)


@_kernel
def _point(row, method, k, x, length, total, target):
    """Write the state x + length * weighted slopes [width] of a row of the tableau into target."""
    weights, stages, counts, _ = method
    last = counts[row] - BLOCK
    if last < 0:
        _copy(x, target)
        return
    if last > 0:
        _add_blocks(row, last, method, k, total)
    else:
        for q in range(len(total)):
            total[q] = 0.0
    w0, w1, w2, w3 = (
        weights[row, last],
        weights[row, last + 1],
        weights[row, last + 2],
        weights[row, last + 3],
    )
    k0, k1 = k[stages[row, last]], k[stages[row, last + 1]]
    k2, k3 = k[stages[row, last + 2]], k[stages[row, last + 3]]
    for q in range(len(target)):
        slope = (w0 * k0[q] + w1 * k1[q]) + (w2 * k2[q] + w3 * k3[q])
        target[q] = x[q] + length[q] * (total[q] + slope)


@_kernel
def _instant(node, time, h, t):
    """Write the times at the fraction `node` of the steps into t."""
    for lane in range(len(t)):
        t[lane] = time[lane] + node * h[lane]


@_kernel
def _cubics(t, base, cubic, u):
    """Write the cubics [4, nu, lanes] of all inputs at the times t [lanes] into u [nu, lanes]."""
    for j in range(len(u)):
        c0, c1, c2, c3 = cubic[0, j], cubic[1, j], cubic[2, j], cubic[3, j]
        begin, to = base[j], u[j]
        for lane in range(len(t)):
            s = t[lane] - begin[lane]
            to[lane] = c0[lane] + s * (c1[lane] + s * (c2[lane] + s * c3[lane]))


@_kernel
def _angles(t, wave, angle):
    """Write the angles of all waves [4, rows, lanes] at the times t [lanes]."""
    for row in range(len(angle)):
        phase, turn, chirp, origin = wave[0, row], wave[1, row], wave[2, row], wave[3, row]
        to = angle[row]
        for lane in range(len(t)):
            s = t[lane] - origin[lane]
            to[lane] = phase[lane] + s * (turn[lane] + s * chirp[lane])


@_kernel
def _add_waves(count, active, sine, u):
    """Add the waves [rows, lanes] with these sines to the inputs u [nu, lanes]."""
    for row in range(len(sine)):
        to, amplitude, value = u[row // count], active[row], sine[row]
        for lane in range(len(to)):
            to[lane] += amplitude[lane] * value[lane]


@_kernel
def _slopes(stage, functions, method, moves, count, all_lanes):
    """Evaluate the inputs at a stage and the slopes there; the states stand in w."""
    derivative, sines = functions
    _instant(method[3][stage], all_lanes.time, all_lanes.h, all_lanes.t)
    if stage == 0 or moves or count > 0:
        _cubics(all_lanes.t, all_lanes.base, all_lanes.cubic, all_lanes.u)
    if count > 0:
        _angles(all_lanes.t, all_lanes.wave, all_lanes.angle)
        sines(all_lanes.angles)
        _add_waves(count, all_lanes.active, all_lanes.angle, all_lanes.u)
    derivative(all_lanes.w)
    _copy(all_lanes.dx, all_lanes.k[stage])


@_kernel
def _scaled(atol, relative, x, new, length, error5, error3):
    """Write the scaled errors of the steps in place of those of order 3."""
    for q in range(len(error3)):
        e5, e3 = error5[q] * error5[q], error3[q] * error3[q]
        before, after = abs(x[q]), abs(new[q])
        larger = after if after > before else before
        scale = (atol[q] + relative * larger) * (math.sqrt(e5 + 0.01 * e3) + TINY)
        error3[q] = length[q] * e5 / scale


@_kernel
def _largest(errors, norm, factor):
    """Write the largest scaled error [n, lanes] of every lane, and by what it changes the step."""
    _copy(errors[0], norm)
    for a in range(1, len(errors)):
        part = errors[a]
        for lane in range(len(part)):
            largest, error = norm[lane], part[lane]
            norm[lane] = largest if largest >= error else error
    for lane in range(len(norm)):
        size = norm[lane] if norm[lane] > LEAST_ERROR else LEAST_ERROR
        factor[lane] = 0.9 / math.sqrt(math.sqrt(math.sqrt(size)))


@_kernel
def _load(lane, b, prepare, waves, runs, all_lanes):
    """Put trajectory `b` into a lane, at its start."""
    n, nu, lanes = runs.start.shape[1], len(all_lanes.base), len(all_lanes.time)
    count, parameters, kind = waves.shape[1], runs.p.shape[1], runs.drive[b]
    all_lanes.who[lane], all_lanes.output[lane] = b, 1
    all_lanes.time[lane], all_lanes.plan[lane] = runs.times[0], runs.limits[1]
    all_lanes.stop[lane], all_lanes.first[lane] = runs.stop_offsets[kind], kind * nu
    for a in range(n):
        all_lanes.x[a * lanes + lane] = runs.start[b, a]
        runs.out[b, 0, a] = runs.start[b, a]
    for a in range(parameters):
        all_lanes.given[a] = all_lanes.constants[a, lane] = runs.p[b, a]
    prepare(all_lanes.given, all_lanes.ready)
    for a in range(len(all_lanes.ready)):
        all_lanes.constants[parameters + a, lane] = all_lanes.ready[a]
    for j in range(nu):
        all_lanes.cursor[j, lane], all_lanes.until[j, lane] = -1, -np.inf
        for i in range(count):
            for c in range(4):
                all_lanes.wave[c, count * j + i, lane] = waves[kind * nu + j, i, 1 + c]


@_inlined
def _next_stop(lane, runs, all_lanes):
    """Time in s at which the step must end at the latest."""
    kind, stop = runs.drive[all_lanes.who[lane]], all_lanes.stop[lane]
    return runs.stops[stop] if stop < runs.stop_offsets[kind + 1] else runs.times[-1]


@_kernel
def _plan(table, waves, runs, all_lanes):
    """Choose the steps of all lanes, and find the pieces of their inputs."""
    lanes, h, width = len(all_lanes.time), all_lanes.h, len(all_lanes.x)
    for lane in range(lanes):
        h[lane] = 0.0
        if all_lanes.who[lane] >= 0:
            left = _next_stop(lane, runs, all_lanes) - all_lanes.time[lane]
            planned = all_lanes.plan[lane]
            planned = planned if planned < runs.limits[1] else runs.limits[1]
            all_lanes.ends[lane] = planned >= left
            nearly = planned if 2.0 * planned <= left else 0.5 * left  # no tiny last step
            h[lane] = left if planned >= left else nearly
            runs.steps[all_lanes.who[lane]] += 1
            _find_pieces(lane, table, waves, all_lanes)
    for first in range(0, width, lanes):
        for lane in range(lanes):
            all_lanes.length[first + lane] = h[lane]


@_inlined
def _find_pieces(lane, table, waves, all_lanes):
    """Take the cubic of every input that holds from now on, and the waves, into a lane."""
    breaks, coefficients, offsets = table
    t, count, cubic = all_lanes.time[lane], waves.shape[1], all_lanes.cubic
    for j in range(len(all_lanes.base)):
        signal = all_lanes.first[lane] + j
        begin, pieces = offsets[signal], offsets[signal + 1] - offsets[signal]
        at, k = begin + signal, all_lanes.cursor[j, lane]
        for i in range(count):
            wave = waves[signal, i]
            on = wave[BEGIN] <= t < wave[END]
            all_lanes.active[count * j + i, lane] = wave[AMPLITUDE] if on else 0.0
        if t < all_lanes.until[j, lane]:
            continue
        while k < pieces and breaks[at + k + 1] <= t:
            k += 1
        all_lanes.cursor[j, lane] = k
        all_lanes.until[j, lane] = breaks[at + k + 1] if k < pieces else np.inf
        piece = min(max(k, 0), pieces - 1)
        c, start = coefficients[begin + piece], breaks[at + piece]
        s = breaks[at + pieces] - start if k >= pieces else 0.0
        moves = 1.0 if 0 <= k < pieces else 0.0
        all_lanes.base[j, lane] = start
        cubic[0, j, lane] = c[0] + s * (c[1] + s * (c[2] + s * c[3]))
        for power in range(1, 4):
            cubic[power, j, lane] = moves * c[power]


@_kernel
def _attempt(functions, method, moves, count, relative, all_lanes):
    """Try a step in every lane."""
    x, new, length, total = all_lanes.x, all_lanes.new, all_lanes.length, all_lanes.total
    for stage in range(STAGES):
        _point(stage, method, all_lanes.k, x, length, total, all_lanes.state)
        _slopes(stage, functions, method, moves, count, all_lanes)
    _point(NEW, method, all_lanes.k, x, length, total, new)
    _weigh(ERROR_5, method, all_lanes.k, all_lanes.error5)
    _weigh(ERROR_3, method, all_lanes.k, total)
    _scaled(all_lanes.atol, relative, x, new, length, all_lanes.error5, total)
    _largest(all_lanes.errors, all_lanes.norm, all_lanes.factor)


@_kernel
def _interpolate(functions, method, moves, count, all_lanes):
    """Evaluate what the dense output of the steps takes."""
    _copy(all_lanes.new, all_lanes.state)
    _slopes(NEW, functions, method, moves, count, all_lanes)
    for stage in range(EXTRA, ALL):
        _point(
            stage,
            method,
            all_lanes.k,
            all_lanes.x,
            all_lanes.length,
            all_lanes.total,
            all_lanes.state,
        )
        _slopes(stage, functions, method, moves, count, all_lanes)
    for row in range(4):
        _weigh(DENSE + row, method, all_lanes.k, all_lanes.dense[row])


@_inlined
def _write_inside(lane, end, runs, all_lanes):
    """Write the states at the output times before `end` in s, inside the step of a lane."""
    lanes, h = len(all_lanes.time), all_lanes.h[lane]
    b, i, times, dense = all_lanes.who[lane], all_lanes.output[lane], runs.times, all_lanes.dense
    while i < len(times) and times[i] < end:
        z = (times[i] - all_lanes.time[lane]) / h
        for a in range(runs.start.shape[1]):
            q = a * lanes + lane
            x, change = all_lanes.x[q], all_lanes.new[q] - all_lanes.x[q]
            slope, slope_end = h * all_lanes.k[0, q], h * all_lanes.k[NEW, q]
            y = h * dense[3, q] * z
            y = (y + h * dense[2, q]) * (1.0 - z)
            y = (y + h * dense[1, q]) * z
            y = (y + h * dense[0, q]) * (1.0 - z)
            y = (y + 2.0 * change - (slope_end + slope)) * z
            y = (y + slope - change) * (1.0 - z)
            runs.out[b, i, a] = x + (y + change) * z
        i += 1
    all_lanes.output[lane] = i


@_inlined
def _accept(lane, runs, all_lanes):
    """Take the step of a lane, or plan a shorter one; True where its trajectory has ended."""
    b, h, factor = all_lanes.who[lane], all_lanes.h[lane], all_lanes.factor[lane]
    lanes, n = len(all_lanes.time), runs.start.shape[1]
    exhausted = runs.steps[b] >= runs.limits[2]
    if not all_lanes.norm[lane] <= 1.0:
        all_lanes.plan[lane] = h * max(MOST_SHRINK, factor)
        return exhausted or all_lanes.plan[lane] < SHORTEST_STEP
    grown = h * min(MOST_GROWTH, factor)
    planned = all_lanes.plan[lane]
    all_lanes.plan[lane] = grown if planned <= h else max(planned, grown)
    t = all_lanes.time[lane] + h
    if all_lanes.ends[lane]:
        t = _next_stop(lane, runs, all_lanes)
        all_lanes.stop[lane] += 1
    _write_inside(lane, t, runs, all_lanes)
    all_lanes.time[lane] = t
    i = all_lanes.output[lane]
    at_output = i < len(runs.times) and runs.times[i] == t
    for a in range(n):
        all_lanes.x[a * lanes + lane] = all_lanes.new[a * lanes + lane]
        if at_output:
            runs.out[b, i, a] = all_lanes.new[a * lanes + lane]
    all_lanes.output[lane] += at_output
    runs.done[b] = t >= runs.times[-1]
    return exhausted or runs.done[b]


@_kernel
def _needs_output(runs, all_lanes):
    """Whether an output time lies inside any of the steps; steps to infinity are failed."""
    lanes, inside = len(all_lanes.time), False
    for lane in range(lanes):
        if all_lanes.who[lane] < 0:
            continue
        for first in range(0, len(all_lanes.new), lanes):
            if not abs(all_lanes.new[first + lane]) < LARGEST_STATE:
                all_lanes.norm[lane], all_lanes.factor[lane] = np.inf, 0.0
        i, end = all_lanes.output[lane], all_lanes.time[lane] + all_lanes.h[lane]
        inside = inside or (i < len(runs.times) and runs.times[i] < end)
    return inside


def _run_lanes(functions, prepare, method, table, moves, waves, runs, all_lanes):
    """Integrate the trajectories of `Runs` that are to do, in `Lanes`."""
    runs, all_lanes = Runs(*runs), Lanes(*all_lanes)
    lanes, count, after, open_lanes = len(all_lanes.time), waves.shape[1], 0, 0
    for lane in range(lanes):
        all_lanes.who[lane] = -1
    while True:
        for lane in range(lanes):
            if all_lanes.who[lane] < 0 and after < len(runs.todo):
                _load(lane, runs.todo[after], prepare, waves, runs, all_lanes)
                after, open_lanes = after + 1, open_lanes + 1
        if open_lanes == 0:
            return
        _plan(table, waves, runs, all_lanes)
        _attempt(functions, method, moves, count, runs.limits[0], all_lanes)
        if _needs_output(runs, all_lanes):
            _interpolate(functions, method, moves, count, all_lanes)
        for lane in range(lanes):
            if all_lanes.who[lane] >= 0 and _accept(lane, runs, all_lanes):
                all_lanes.who[lane] = -1
                open_lanes -= 1


@lru_cache(maxsize=1)
def run_lanes() -> Callable[..., None]:
    """The compiled `_run_lanes`: some seconds once on a new machine."""
    compiled = njit(
        types.void(
            types.UniTuple(_IN_PLACE, 2),  # derivative, sines
            _PREPARE,
            types.Tuple((_M, _T, _I, _V)),  # tableau
            types.Tuple((_V, _M, _I)),  # pieces of all signals
            types.boolean,  # whether these are more than constants
            types.float64[:, :, ::1],  # waves of all signals
            types.Tuple(_RUNS),
            types.Tuple(_LANES),
        ),
        cache=True,
        **KERNEL,
    )
    run: Callable[..., None] = compiled(_run_lanes)
    return run
