"""Smooth models, LANES trajectories side by side: one instruction computes several of them.

The method is DOP853 (Dormand and Prince, order 8 with the error estimate of orders 5 and 3 of
Hairer, Norsett and Wanner, *Solving Ordinary Differential Equations I*, section II.10, and its
dense output of order 7). Every lane has a step length of its own, ends its steps where its inputs
jump, and takes the next trajectory when it has reached the end. Lanes do not exchange numbers: a
trajectory has the same bits in any lane and beside any others.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import lru_cache

import numpy as np
from numba import njit, types
from numpy.typing import NDArray
from scipy.integrate import DOP853

from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.integration import EXPLICIT, Accuracy, default_method
from ptp_symbolic.numeric.simulation.signals.inputs import InputTable

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

STAGES = 12
NEW, EXTRA = 12, 13  # rows of the slopes: at the end of the step, then three for dense output
ALL = 16
BLOCK = 4  # slopes that are added at once
LEAST_ERROR = 1e-8  # scaled; the step grows no further below
SHORTEST_STEP = 1e-11  # s
LARGEST_STATE = 1e12
PATIENCE = 100_000  # steps of a trajectory, after which the runner with events takes it
AMPLITUDE, PHASE, TURN, CHIRP, ORIGIN, BEGIN, END = range(7)
WAVE = 7


def suits(model: Model, method: str | None, accuracy: Accuracy) -> bool:
    """Whether runs of `model` are smooth, and an explicit method is right or asked for."""
    chosen = default_method(model) if method is None else method
    smooth = not model.mode_names and not model.limits and not np.any(model.input_delays >= 0)
    return chosen == EXPLICIT and smooth and "lane_derivative" in vars(model.module)


def _blocks(rows: FloatArray) -> tuple[FloatArray, IntArray, IntArray]:
    """The non-zero weights of every row [r, s], where they stand, and their number rounded up to a
    multiple of BLOCK by weights of zero.
    """
    width = BLOCK * -(-int((rows != 0.0).sum(axis=1).max()) // BLOCK)
    weights, stages = np.zeros((len(rows), width)), np.zeros((len(rows), width), np.int64)
    counts = np.zeros(len(rows), np.int64)
    for row, values in enumerate(rows):
        where = np.flatnonzero(values)
        weights[row, : len(where)], stages[row, : len(where)] = values[where], where
        counts[row] = BLOCK * -(-len(where) // BLOCK)
    return weights, stages, counts


@lru_cache(maxsize=1)
def tableau() -> tuple[FloatArray, IntArray, IntArray, FloatArray]:
    """DOP853 as `run_lanes` takes it: rows 1 to 11 of the stages, 12 the solution, 13 to 15 the
    stages of dense output, 16 and 17 the errors of order 5 and 3, 18 to 21 the dense output; and
    the nodes [16].
    """
    rows = np.zeros((22, ALL))
    rows[:STAGES, :STAGES] = DOP853.A
    rows[NEW, :STAGES] = DOP853.B
    rows[EXTRA:ALL] = DOP853.A_EXTRA
    rows[16, : STAGES + 1], rows[17, : STAGES + 1] = DOP853.E5, DOP853.E3
    rows[18:] = DOP853.D
    nodes = np.concatenate([DOP853.C, [1.0], DOP853.C_EXTRA])
    return *_blocks(rows), nodes


_V, _I = types.float64[::1], types.int64[::1]
_M, _T, _C = types.float64[:, ::1], types.int64[:, ::1], types.float64[:, :, ::1]
_IN_PLACE = types.FunctionType(types.void(_V))
_PREPARE = types.FunctionType(types.void(_V, _V))
_OPTIONS = {"nogil": True, "error_model": "numpy"}
_inlined = njit(forceinline=True, **_OPTIONS)


@_inlined
def _weigh(row, weights, stages, counts, k, width, total):
    """Write the weighted sum of the slopes k [16, width] of a row of the tableau into total."""
    for q in range(width):
        total[q] = 0.0
    for first in range(0, counts[row], BLOCK):
        w0, w1 = weights[row, first], weights[row, first + 1]
        w2, w3 = weights[row, first + 2], weights[row, first + 3]
        k0, k1 = stages[row, first] * width, stages[row, first + 1] * width
        k2, k3 = stages[row, first + 2] * width, stages[row, first + 3] * width
        for q in range(width):
            total[q] += (w0 * k[k0 + q] + w1 * k[k1 + q]) + (w2 * k[k2 + q] + w3 * k[k3 + q])


@_inlined
def _find_pieces(lanes, nu, first, time, table, cursor, base, cubic, waves, active):
    """Take the cubic of every input [nu] that holds from `time` [lanes] on, and the waves."""
    breaks, coefficients, offsets = table
    count = waves.shape[1]
    for lane in range(lanes):
        t = time[lane]
        for j in range(nu):
            signal, q = first[lane] + j, j * lanes + lane
            begin, pieces = offsets[signal], offsets[signal + 1] - offsets[signal]
            at, k = begin + signal, cursor[q]
            while k < pieces and breaks[at + k + 1] <= t:
                k += 1
            while k >= 0 and breaks[at + k] > t:
                k -= 1
            cursor[q] = k
            row = begin + min(max(k, 0), pieces - 1)
            base[q] = breaks[at + min(max(k, 0), pieces - 1)]
            moving = 1.0 if 0 <= k < pieces else 0.0
            for c in range(4):
                cubic[(4 * j + c) * lanes + lane] = coefficients[row, c] * (moving if c else 1.0)
            if k >= pieces:
                s, c = breaks[at + pieces] - base[q], coefficients[row]
                cubic[4 * j * lanes + lane] = c[0] + s * (c[1] + s * (c[2] + s * c[3]))
            for i in range(count):
                wave = waves[signal, i]
                on = wave[BEGIN] <= t < wave[END]
                active[(count * j + i) * lanes + lane] = wave[AMPLITUDE] if on else 0.0


@_inlined
def _evaluate(lanes, nu, node, time, h, base, cubic, count, wave, active, angle, sines, w, at):
    """Write times and inputs at the fraction `node` of the steps into w, from row 0 and `at` on."""
    for lane in range(lanes):
        w[lane] = time[lane] + node * h[lane]
    for j in range(nu):
        a, b = 4 * j * lanes, j * lanes
        for lane in range(lanes):
            s = w[lane] - base[b + lane]
            w[at + b + lane] = cubic[a + lane] + s * (
                cubic[a + lanes + lane]
                + s * (cubic[a + 2 * lanes + lane] + s * cubic[a + 3 * lanes + lane])
            )
    if count == 0:
        return
    rows = nu * count * lanes
    for first in range(0, rows, lanes):
        for lane in range(lanes):
            q = first + lane
            s = w[lane] - wave[3 * rows + q]
            angle[q] = wave[q] + s * (wave[rows + q] + s * wave[2 * rows + q])
    sines(angle)
    for j in range(nu):
        for i in range(count):
            first = (count * j + i) * lanes
            for lane in range(lanes):
                w[at + j * lanes + lane] += active[first + lane] * angle[first + lane]


@_inlined
def _dense(row, t, old, length, lanes, n, lane, h, x, new, k, rows, out):
    """Write the state at time t inside the step of a lane that began at `old` into out [n]."""
    width, z = n * lanes, (t - old) / length
    for a in range(n):
        q = a * lanes + lane
        change, slope, end = new[q] - x[q], h[q] * k[q], h[q] * k[NEW * width + q]
        y = h[q] * rows[3 * width + q] * z
        y = (y + h[q] * rows[2 * width + q]) * (1.0 - z)
        y = (y + h[q] * rows[width + q]) * z
        y = (y + h[q] * rows[q]) * (1.0 - z)
        y = (y + 2.0 * change - (end + slope)) * z
        y = (y + slope - change) * (1.0 - z)
        out[a] = x[q] + (y + change) * z


@njit(
    types.void(
        types.UniTuple(_IN_PLACE, 2),  # derivative, sines
        _PREPARE,
        types.Tuple((_M, _T, _I, _V)),  # tableau
        types.Tuple((_V, _M, _I)),  # pieces of all signals
        _C,  # waves of all signals
        types.Tuple((_V, _I)),  # stops of every kind of drive, and where these begin
        _M,  # parameters
        _M,  # initial states
        _I,  # kind of drive
        _I,  # trajectories to integrate
        types.Tuple((_V, _V, _V)),  # times; rtol, largest step, most steps; atol
        types.UniTuple(types.int64, 3),  # lanes, inputs, prepared
        _C,  # states at the times
        _I,  # steps
        types.boolean[::1],  # reached the end
    ),
    cache=True,
    **_OPTIONS,
)
def run_lanes(
    functions,
    prepare,
    method,
    table,
    waves,
    all_stops,
    p,
    start,
    drive,
    todo,
    rules,
    sizes,
    out,
    steps,
    done,
):
    """Integrate the trajectories `todo`; writes states, steps, and whether the end was reached."""
    derivative, sines = functions
    weights, stages, counts, nodes = method
    stops, stop_offsets = all_stops
    times, limits, atol = rules
    lanes, nu, prepared = sizes
    n, parameters, count = start.shape[1], p.shape[1], waves.shape[1]
    width, rows = n * lanes, nu * count * lanes
    at_u, at_p = (1 + n) * lanes, (1 + n + nu) * lanes
    at_c = at_p + parameters * lanes
    at_dx = at_c + prepared * lanes
    w, k = np.zeros(at_dx + width), np.zeros(ALL * width)
    x, new, total, h_all = np.zeros(width), np.zeros(width), np.zeros(width), np.zeros(width)
    dense, error5 = np.zeros(4 * width), np.zeros(width)
    time, plan, h, norm = np.zeros(lanes), np.zeros(lanes), np.zeros(lanes), np.zeros(lanes)
    who, stop, output = np.full(lanes, -1), np.zeros(lanes, np.int64), np.zeros(lanes, np.int64)
    first, cursor = np.zeros(lanes, np.int64), np.zeros(nu * lanes, np.int64)
    base, cubic = np.zeros(nu * lanes), np.zeros(4 * nu * lanes)
    wave, active, angle = np.zeros(4 * rows), np.zeros(rows), np.zeros(rows)
    given, ready = np.zeros(parameters), np.zeros(prepared)
    ends = np.zeros(lanes, np.bool_)
    after, open_lanes = 0, 0
    while True:
        for lane in range(lanes):
            if who[lane] >= 0 or after == len(todo):
                continue
            b = todo[after]
            after += 1
            open_lanes += 1
            who[lane], time[lane], plan[lane], output[lane] = b, times[0], limits[1], 0
            stop[lane], first[lane] = stop_offsets[drive[b]], drive[b] * nu
            for a in range(n):
                x[a * lanes + lane] = start[b, a]
                out[b, 0, a] = start[b, a]
            output[lane] = 1
            for a in range(parameters):
                given[a] = p[b, a]
                w[at_p + a * lanes + lane] = p[b, a]
            prepare(given, ready)
            for a in range(prepared):
                w[at_c + a * lanes + lane] = ready[a]
            for j in range(nu):
                cursor[j * lanes + lane] = 0
                for i in range(count):
                    q, row = (count * j + i) * lanes + lane, waves[first[lane] + j, i]
                    wave[q], wave[rows + q] = row[PHASE], row[TURN]
                    wave[2 * rows + q], wave[3 * rows + q] = row[CHIRP], row[ORIGIN]
        if open_lanes == 0:
            return
        for lane in range(lanes):
            b = who[lane]
            h[lane] = 0.0
            if b >= 0:
                last = stop_offsets[drive[b] + 1]
                end = stops[stop[lane]] if stop[lane] < last else times[-1]
                left, planned = end - time[lane], min(plan[lane], limits[1])
                ends[lane] = planned >= left
                h[lane] = left if ends[lane] else left / np.ceil(left / planned)
                steps[b] += 1
        for a in range(n):
            for lane in range(lanes):
                h_all[a * lanes + lane] = h[lane]
        _find_pieces(lanes, nu, first, time, table, cursor, base, cubic, waves, active)
        for stage in range(STAGES):
            _evaluate(
                lanes, nu, nodes[stage], time, h, base, cubic, count, wave, active, angle, sines, w,
                at_u,
            )
            if stage:
                _weigh(stage, weights, stages, counts, k, width, total)
                for q in range(width):
                    w[lanes + q] = x[q] + h_all[q] * total[q]
            else:
                for q in range(width):
                    w[lanes + q] = x[q]
            derivative(w)
            for q in range(width):
                k[stage * width + q] = w[at_dx + q]
        _weigh(NEW, weights, stages, counts, k, width, total)
        for q in range(width):
            new[q] = x[q] + h_all[q] * total[q]
        _weigh(16, weights, stages, counts, k, width, error5)
        _weigh(17, weights, stages, counts, k, width, total)
        for lane in range(lanes):
            norm[lane] = 0.0
        for a in range(n):
            for lane in range(lanes):
                q = a * lanes + lane
                e5, e3 = error5[q] * error5[q], total[q] * total[q]
                scale = atol[a] + limits[0] * max(abs(x[q]), abs(new[q]))
                error = h[lane] * e5 / (np.sqrt(e5 + 0.01 * e3) + 1e-300) / scale
                norm[lane] = norm[lane] if norm[lane] >= error else error
        inside = False
        for lane in range(lanes):
            b = who[lane]
            if b < 0:
                continue
            for a in range(n):
                if not abs(new[a * lanes + lane]) < LARGEST_STATE:
                    norm[lane] = np.inf
            ahead = time[lane] + h[lane]
            inside = inside or (output[lane] < len(times) and times[output[lane]] < ahead)
        if inside:
            for stage in range(NEW, ALL):
                if stage == NEW:
                    for q in range(width):
                        w[lanes + q] = new[q]
                else:
                    _weigh(stage, weights, stages, counts, k, width, total)
                    for q in range(width):
                        w[lanes + q] = x[q] + h_all[q] * total[q]
                _evaluate(
                    lanes, nu, nodes[stage], time, h, base, cubic, count, wave, active, angle,
                    sines, w, at_u,
                )
                derivative(w)
                for q in range(width):
                    k[stage * width + q] = w[at_dx + q]
            for row in range(4):
                _weigh(18 + row, weights, stages, counts, k, width, total)
                for q in range(width):
                    dense[row * width + q] = total[q]
        for lane in range(lanes):
            b = who[lane]
            if b < 0:
                continue
            size = max(norm[lane], LEAST_ERROR)
            factor = 0.9 / np.sqrt(np.sqrt(np.sqrt(size)))
            if not norm[lane] <= 1.0:
                plan[lane] = h[lane] * max(0.2, factor)
                if plan[lane] < SHORTEST_STEP or steps[b] >= limits[2]:
                    who[lane] = -1
                    open_lanes -= 1
                continue
            grown = h[lane] * min(6.0, factor)
            plan[lane] = grown if plan[lane] <= h[lane] else max(plan[lane], grown)
            old, t = time[lane], time[lane] + h[lane]
            if ends[lane]:
                last = stop_offsets[drive[b] + 1]
                t = stops[stop[lane]] if stop[lane] < last else times[-1]
                stop[lane] += 1
            while output[lane] < len(times) and times[output[lane]] < t:
                _dense(
                    0, times[output[lane]], old, h[lane], lanes, n, lane, h_all, x, new, k, dense,
                    out[b, output[lane]],
                )
                output[lane] += 1
            time[lane] = t
            for a in range(n):
                x[a * lanes + lane] = new[a * lanes + lane]
            if output[lane] < len(times) and times[output[lane]] == t:
                for a in range(n):
                    out[b, output[lane], a] = x[a * lanes + lane]
                output[lane] += 1
            if t >= times[-1] or steps[b] >= limits[2]:
                done[b] = t >= times[-1]
                who[lane] = -1
                open_lanes -= 1


def waves_of(table: InputTable) -> FloatArray:
    """Sines and sweeps [s, r, 7] of every signal, as many rows r as the one with most has:
    amplitude, phase in rad, rad/s, rad/s^2, origin, begin and end in s.
    """
    signals = len(table.offsets) - 1
    parts = []
    for j in range(signals):
        sines = table.sines[table.sine_offsets[j] : table.sine_offsets[j + 1]]
        sweeps = table.sweeps[table.sweep_offsets[j] : table.sweep_offsets[j + 1]]
        rows = [[a, phase, 2 * np.pi * f, 0.0, 0.0, -np.inf, np.inf] for a, f, phase in sines]
        for a, lowest, highest, t0, t1 in sweeps:
            chirp = np.pi * (highest - lowest) / (t1 - t0)
            rows.append([a, 0.0, 2 * np.pi * lowest, chirp, t0, t0, t1])
        parts.append(rows)
    most = max(map(len, parts), default=0)
    waves = np.zeros((signals, most, WAVE))
    for j, rows in enumerate(parts):
        if rows:
            waves[j, : len(rows)] = rows
    return waves


def integrate_in_lanes(
    model: Model,
    times: FloatArray,
    table: InputTable,
    stops: Sequence[FloatArray],
    accuracy: Accuracy,
    p: FloatArray,
    x: FloatArray,
    drive: IntArray,
    todo: IntArray,
    threads: int,
    out: FloatArray,
    steps: IntArray,
) -> IntArray:
    """Integrate the trajectories `todo` of p [b, np] and x [b, n] over `times` [k] into out
    [b, k, n], and count their steps [b]; returns those that did not reach the end.

    `table` holds the signals of all kinds of drive one after the other, `stops` the times in s at
    which those of each jump, `drive` [b] the kind of every trajectory.
    """
    module = model.module
    inner = [s[(s > times[0]) & (s < times[-1])] for s in stops]
    offsets = np.cumsum([0, *map(len, inner)], dtype=np.int64)
    most = min(accuracy.most_steps, PATIENCE)
    rules = (times, np.array([accuracy.relative, accuracy.largest_step, most]), accuracy.absolute)
    done = np.zeros(len(p), np.bool_)

    def portion(rows: IntArray) -> None:
        run_lanes(
            (module.lane_derivative, module.lane_sines),
            module.prepare,
            tableau(),
            (table.breaks, table.coefficients, table.offsets),
            waves_of(table),
            (np.concatenate([np.empty(0), *inner]), offsets),
            p,
            x,
            drive,
            rows,
            rules,
            (module.LANES, len(model.input_names), module.PREPARED),
            out,
            steps,
            done,
        )

    with ThreadPoolExecutor(threads) as pool:
        for _ in pool.map(portion, [part for part in np.array_split(todo, threads) if len(part)]):
            pass
    left = todo[~done[todo]]
    out[left], steps[left] = np.nan, 0
    return left
