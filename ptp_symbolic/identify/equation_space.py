"""What the equations leave along the measured motion: residual torques, and residual currents.

One row per chosen sample and equation: the torque in N m that an axis lacks, averaged under a test
function (see `weak_form`), or the measured minus the integrated value of a further state. The rows
are nearly linear in the parameters, so that far starts and many candidates cost next to nothing.
Rows whose window holds a joint at rest or a change of the touched face are left out: there friction
and contact are set-valued.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.identify.along_motion import (
    LATE_PARTS,
    PARTS,
    Layout,
    Motion,
    angles_behind_sensors,
    equation_addresses,
    further_states,
    gear_ahead,
    layout_of,
    torques_along,
)
from ptp_symbolic.identify.run import Run
from ptp_symbolic.identify.weak_form import local_motion, noise_gain, weak_average
from ptp_symbolic.runtime.model import Model
from ptp_symbolic.simulation.delays import delays_of

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

ROWS_PER_WINDOW = 8  # rows overlap: more are copies of each other
SAMPLES_PER_WINDOW = 32  # on the grid: enough for the bends of the test function
RESTING = 5.0  # standard deviations of the estimated rate: slower may be at rest
CALM = 5e-3  # noise of the averaged acceleration over that of what accelerates
SENSOR_ITERATIONS = 4  # an error of 2 % of the angle is left to 2e-7 of it
MOST_COARSE = 16.0  # samples in a window: fewer do not resolve the test function
CLEAN = 1e-9  # share of a window at rest
SHIFT = 1e-3  # of an input or state, in its own unit, for a difference quotient
DRAWS, DRAW_SEED = 3, 20130801
HALF_WIDTHS = (0.08, 0.11, 0.16, 0.22)  # s


@dataclass(frozen=True, eq=False)
class RunRows:
    """The rows of a run: `grid` [g] are the samples at which torques are taken, `chosen` [c] those
    of the grid that have a row, `kept` [c, equations] the rows that count; `face` [g, na] is the
    face that every gear output touches.
    """

    grid: IntArray
    chosen: IntArray
    kept: BoolArray
    face: FloatArray


@dataclass(frozen=True, eq=False)
class _Along:
    """The motion of one run at all samples and on the grid, the averaged second derivatives [c, na]
    of its angles, and by how much the averages of angles and rates [c, 2 na] differ from those of
    the smoothed ones.
    """

    fine: Motion
    coarse: Motion
    curvature: FloatArray
    missed: FloatArray


@dataclass(frozen=True, eq=False)
class _Further:
    """Further states: what acts on the grid [g, e], measured minus integrated [k, e] at all
    samples, and by how much they settle elsewhere at another rate [k, e, na].
    """

    acting: FloatArray
    left: FloatArray
    by_rate: FloatArray


@dataclass(eq=False)
class EquationSpace:
    """Rows of the equations of `model` along the motion of `runs`, at any parameters p [np].

    `half_width` of the windows and `rate_width` of the local motion in s; `resting` [na] in rad/s;
    `measured` are the further states that a signal shows: its column, and their place in the
    layout. `sensing` and `moving` [np] tell which parameters act on sensors and on further states,
    `acting` [e] which of these act on a torque or on one another.
    """

    model: Model
    runs: tuple[Run, ...]
    layout: Layout
    half_width: float
    rate_width: float
    resting: FloatArray
    measured: tuple[tuple[int, int], ...]
    sensing: BoolArray
    moving: BoolArray
    acting: BoolArray
    rows_of: tuple[RunRows, ...] = ()
    _motions: dict[tuple[int, bytes], _Along] = field(default_factory=dict, repr=False)
    _states: dict[tuple[int, bytes, int], _Further] = field(default_factory=dict, repr=False)

    @property
    def equations(self) -> int:
        """Torque of every axis, then every measured further state."""
        return len(self.layout.angle) + len(self.measured)

    @property
    def gears(self) -> list[int]:
        """Axes whose gear output has a row of its own."""
        return [a for a, row in enumerate(self.layout.gear_row) if row >= 0]

    def labels(self) -> tuple[IntArray, IntArray, FloatArray]:
        """Equation, run and time in s of every row, each [n]."""
        parts = []
        for equation in range(self.equations):
            for number, (run, rows) in enumerate(zip(self.runs, self.rows_of, strict=True)):
                time = run.time[rows.grid[rows.chosen[rows.kept[:, equation]]]]
                parts.append((np.full(len(time), equation), np.full(len(time), number), time))
        equations, numbers, times = zip(*parts, strict=True)
        return np.concatenate(equations), np.concatenate(numbers), np.concatenate(times)

    def rows(self, p: FloatArray, own: Sequence[FloatArray] | None = None) -> FloatArray:
        """All rows [n] at parameters p, equation by equation and run by run.

        With `own`, per run what has to be added to inputs and further states (see `own_torque`),
        the torque is the model's own instead of the measured one.
        """
        given = [None] * len(self.runs) if own is None else own
        tables = [self._run_rows(k, p, o) for k, o in enumerate(given)]
        return np.concatenate(
            [
                table[rows.kept[:, equation], equation]
                for equation in range(self.equations)
                for table, rows in zip(tables, self.rows_of, strict=True)
            ]
        )

    def _run_rows(self, number: int, p: FloatArray, own: FloatArray | None) -> FloatArray:
        """Rows [c, equations] of one run."""
        run, rows = self.runs[number], self.rows_of[number]
        along, ahead, (lacking, inertia, slopes), further = self._torques(number, p, own)
        time, h, curvature = along.coarse.time, self.half_width, along.curvature
        if self.gears:
            behind = weak_average(time, ahead, h, 2, rows.chosen)[:, self.gears]
            curvature = np.column_stack([curvature, curvature[:, self.gears] + behind])
        torque = weak_average(time, lacking, h, 0, rows.chosen)
        torque += np.einsum("kar,kr->ka", inertia[rows.chosen], curvature)
        torque += np.einsum("kaj,kj->ka", slopes[rows.chosen], along.missed)
        if not self.measured:
            return torque
        at, places = rows.grid[rows.chosen], [place for _, place in self.measured]
        electric = weak_average(run.time, np.ascontiguousarray(further.left[:, places]), h, 0, at)
        rates = along.missed[:, len(self.layout.angle) :]
        electric -= np.einsum("kea,ka->ke", further.by_rate[at][:, places], rates)
        return np.column_stack([torque, electric])

    def _torques(
        self, number: int, p: FloatArray, own: FloatArray | None
    ) -> tuple[_Along, FloatArray, tuple[FloatArray, FloatArray, FloatArray], _Further]:
        """Motion, lead of the gears, what `torques_along` gives on the grid, and further states."""
        run, addresses = self.runs[number], equation_addresses(self.model)
        rows, along = self.rows_of[number], self._motion(number, p)
        delays, inputs = delays_of(self.model, p), len(self.model.input_names)
        given = np.column_stack([cell_averages(run, j, d, rows.grid) for j, d in enumerate(delays)])
        added = np.zeros((len(rows.grid), inputs + len(self.layout.further)))
        added = added if own is None else own
        motion = along.coarse._replace(inputs=given + added[:, :inputs])
        ahead, face = gear_ahead(addresses, self.layout, motion, p, self.resting, rows.face)
        further = self._further(number, p, along, added[:, :inputs])
        acting = further.acting + added[:, inputs:]
        rate = np.gradient(ahead, motion.time, axis=0) if self.gears else ahead
        torques = torques_along(
            addresses, self.layout, motion, p, self.resting, ahead, rate, face, acting
        )
        return along, ahead, torques, further

    def _motion(self, number: int, p: FloatArray) -> _Along:
        """The measured motion, errors of the sensors at p taken out."""
        key = (number, p[self.sensing].tobytes())
        if key in self._motions:
            return self._motions[key]
        run, axes, rows = self.runs[number], self.model.module.AXES, self.rows_of[number]
        columns = [run.signals.index(f"theta_{a}") for a in axes]
        shown = [self.model.output_names.index(f"theta_{a}") for a in axes]
        angles = angles_behind_sensors(
            equation_addresses(self.model), self.layout, np.array(shown), run.time,
            np.ascontiguousarray(run.measured[:, columns]), run.held_inputs, p,
            len(self.model.output_names), SENSOR_ITERATIONS if self.sensing.any() else 0,
        )  # fmt: skip
        local = local_motion(run.time, angles, self.rate_width)
        seen = np.full((len(run.time), len(self.layout.further)), np.nan)
        for column, place in self.measured:
            seen[:, place] = run.measured[:, column]
        smooth, rate, acceleration = (np.ascontiguousarray(local[:, k]) for k in range(3))
        fine = Motion(run.time, smooth, rate, acceleration, run.held_inputs, seen)
        coarse = Motion(*(np.ascontiguousarray(column[rows.grid]) for column in fine))
        at, h = rows.grid[rows.chosen], self.half_width
        curvature = weak_average(run.time, angles, h, 2, at)
        exact = [weak_average(run.time, angles, h, d, at) for d in (0, 1)]
        taken = [weak_average(coarse.time, c, h, 0, rows.chosen) for c in coarse[1:3]]
        missed = np.column_stack([e - s for e, s in zip(exact, taken, strict=True)])
        self._motions[key] = _Along(fine, coarse, curvature, missed)
        return self._motions[key]

    def _further(self, number: int, p: FloatArray, along: _Along, added: FloatArray) -> _Further:
        """Further states along the motion, with what is `added` [g, nu] to the inputs."""
        run, fine, grid = self.runs[number], along.fine, self.rows_of[number].grid
        count = len(self.layout.further)
        if not count:
            return _Further(
                np.zeros((len(grid), 0)), np.zeros((len(run.time), 0)), np.zeros((0, 0, 0))
            )
        key = (number, p[self.moving | self.sensing].tobytes(), int(np.any(added)))
        if key not in self._states:
            delays = delays_of(self.model, p)
            parts = LATE_PARTS if np.any(delays) else PARTS
            late = np.stack([part_averages(run, j, d, parts) for j, d in enumerate(delays)], axis=2)
            if np.any(added):
                more = [np.interp(run.time[:-1], run.time[grid], a) for a in added.T]
                late = late + np.column_stack(more)[:, None, :]
            shown = np.zeros(count, dtype=np.bool_)
            shown[[place for _, place in self.measured]] = True
            found, mean, by_rate = further_states(
                equation_addresses(self.model), self.layout, fine, p, self.resting, self.acting,
                shown, late,
            )  # fmt: skip
            left = fine.measured - found
            acting = np.where(np.isnan(left), mean, mean + left)
            self._states[key] = _Further(_averaged(acting, grid), np.nan_to_num(left), by_rate)
        return self._states[key]

    def decide_rows(self, p: FloatArray, others: Sequence[FloatArray]) -> None:
        """Decide anew which rows count, and at p which faces are touched.

        A row counts where no face changes at p nor at `others`: an inertia or a friction that is
        far from its true value would miss the changes, and between two faces no torque passes.
        """
        self.rows_of = tuple(_every_row(self, run) for run in self.runs)
        self.forget()
        self.rows_of = tuple(_rows_that_count(self, k, p, others) for k in range(len(self.runs)))
        self.forget()

    def forget(self) -> None:
        """Drop what is kept of motions and states: after a search over sensors or currents."""
        self._motions.clear()
        self._states.clear()

    def own_torque(self, p: FloatArray) -> list[FloatArray]:
        """Per run what inputs and measured further states [g, nu + e] lack for the torque of the
        model to be its own: as a regressor the measured one carries the residual that it should
        explain (Janot, Vandanjon and Gautier, 2014).
        """
        acting = self._acting(p)
        found = []
        for number in range(len(self.runs)):
            along, _, (lacking, inertia, _), _ = self._torques(number, p, None)
            acceleration = along.coarse.acceleration
            every = np.column_stack([acceleration, acceleration[:, self.gears]])
            torque = lacking + np.einsum("kar,kr->ka", inertia, every)
            added = np.zeros((len(torque), acting.shape[1]))
            for axis, row in enumerate(acting):
                strongest = int(np.argmax(np.abs(row)))
                if row[strongest] != 0.0:
                    added[:, strongest] -= torque[:, axis] / row[strongest]
            found.append(added)
        return found

    def _acting(self, p: FloatArray) -> FloatArray:
        """Derivative [na, nu + e] of the torque that every axis lacks by inputs and measured
        further states, seen in the middle of the first run after they were shifted for good.
        """
        inputs, further = len(self.model.input_names), len(self.layout.further)
        shown = {inputs + place for _, place in self.measured}
        none = np.zeros((len(self.rows_of[0].grid), inputs + further))
        middle = len(none) // 2
        here = self._torques(0, p, none)[2][0][middle]
        result = np.zeros((len(here), inputs + further))
        for j in range(inputs + further):
            if j < inputs or j in shown:
                moved = none.copy()
                moved[:, j] = SHIFT
                result[:, j] = (self._torques(0, p, moved)[2][0][middle] - here) / SHIFT
                self._states.clear()
        return result


def _averaged(values: FloatArray, grid: IntArray) -> FloatArray:
    """Averages [g, v] of `values` [k, v] over the samples nearest to every one of the grid."""
    edges = np.concatenate([[0], (grid[1:] + grid[:-1] + 1) // 2, [len(values)]])
    return np.add.reduceat(values, edges[:-1], axis=0) / np.diff(edges)[:, None]


def prepare_equation_space(
    model: Model,
    runs: Sequence[Run],
    p: FloatArray,
    others: Sequence[FloatArray],
    varied: FloatArray,
) -> EquationSpace:
    """The equation space of `model` over whole `runs`.

    Which rows count is decided at the parameters p [np] and at `others` (see `decide_rows`);
    `varied` are parameters that differ from p in all that may be searched, to see which of them act
    on sensors and on further states. Raises InputError for a model with sampled states, and where
    an axis has no angle among the signals.
    """
    layout = layout_of(model)
    axes = model.module.AXES
    for axis in axes:
        if any(f"theta_{axis}" not in run.signals for run in runs):
            raise InputError(f"Signal 'theta_{axis}' is not measured; torques need every angle.")
    further = [model.state_names[i] for i in layout.further]
    measured = tuple(
        (column, further.index(name))
        for column, name in enumerate(runs[0].signals)
        if name in further
    )
    depends = _dependence(model, layout, runs, p, varied)
    columns = [runs[0].signals.index(f"theta_{axis}") for axis in axes]
    noise = 1.0 / runs[0].weight[columns]
    period = float(np.median(np.concatenate([np.diff(run.time) for run in runs])))
    half_width = _half_width(runs, columns, noise, period)
    rate_width = 0.5 * half_width
    rounding = np.nan_to_num(runs[0].counts[columns]) / np.sqrt(12.0)
    samples = 2.0 * rate_width / period + 1.0
    resting = RESTING * np.hypot(noise * np.sqrt(3.0 / samples), rounding) / rate_width
    frictions = set(layout.friction_axis.tolist())
    resting = np.where([a in frictions for a in range(len(axes))], resting, 0.0)
    space = EquationSpace(
        model, tuple(runs), layout, half_width, rate_width, resting, measured, depends.sensing,
        depends.moving, depends.acting,
    )  # fmt: skip
    space.decide_rows(p, others)
    return space


def _half_width(
    runs: Sequence[Run], columns: Sequence[int], noise: FloatArray, period: float
) -> float:
    """The shortest window in which noise hardly shows beside what accelerates the joints."""
    for half_width in HALF_WIDTHS:
        if 2.0 * half_width / period < MOST_COARSE:
            continue
        gain = noise_gain(period, half_width, 2)
        curved = [
            weak_average(
                run.time, np.ascontiguousarray(run.measured[:, columns]), half_width, 2,
                np.arange(0, len(run.time), max(1, int(half_width / period))),
            )
            for run in runs
        ]  # fmt: skip
        size = np.sqrt(np.nanmean(np.concatenate(curved) ** 2, axis=0))
        if np.all(noise * gain <= CALM * size):
            return half_width
    return max(HALF_WIDTHS[-1], 0.5 * MOST_COARSE * period)


def _every_row(space: EquationSpace, run: Run) -> RunRows:
    """The grid of a run and the samples of it that have a row, all of which count for now."""
    period = float(np.median(np.diff(run.time)))
    window = 2.0 * space.half_width / period
    grid = np.arange(0, len(run.time), max(1, int(window / SAMPLES_PER_WINDOW)))
    spacing = window / max(1, int(window / SAMPLES_PER_WINDOW))
    chosen = np.arange(0, len(grid), max(1, round(spacing / ROWS_PER_WINDOW)))
    kept = np.ones((len(chosen), space.equations), dtype=np.bool_)
    return RunRows(grid, chosen, kept, np.zeros((len(grid), len(space.layout.angle))))


def _rows_that_count(
    space: EquationSpace, number: int, p: FloatArray, others: Sequence[FloatArray]
) -> RunRows:
    """Samples of a run whose windows are whole and hold neither rest nor a change of face."""
    rows, motion = space.rows_of[number], space._motion(number, p).coarse
    addresses, layout = equation_addresses(space.model), space.layout
    faces = [
        gear_ahead(addresses, layout, motion, q, space.resting, rows.face)[1] for q in (p, *others)
    ]
    resting = (np.abs(motion.rate) < space.resting).astype(np.float64)
    changed = np.zeros_like(resting)
    for face in faces:
        changed[1:] = np.maximum(changed[1:], face[1:] != face[:-1])
    both = np.column_stack([resting, changed])
    both = weak_average(motion.time, both, space.half_width, 0, rows.chosen)
    axes = resting.shape[1]
    slides = (both[:, :axes] < CLEAN) & (both[:, axes:] < CLEAN)
    electric = np.all(both[:, axes:] < CLEAN, axis=1)
    kept = np.column_stack([slides, *[electric] * len(space.measured)])
    return replace(rows, kept=kept, face=faces[0])


@dataclass(frozen=True, eq=False)
class _Dependence:
    """Which parameters [np] act on what the sensors of the angles show, which on the rates of
    further states, and which of these states [e] act on a torque or on one another.
    """

    sensing: BoolArray
    moving: BoolArray
    acting: BoolArray


def _dependence(
    model: Model, layout: Layout, runs: Sequence[Run], p: FloatArray, varied: FloatArray
) -> _Dependence:
    """What depends on what, seen at states drawn at random, with parameters p and with others."""
    rng = np.random.default_rng(DRAW_SEED)
    count = len(layout.further)
    found = _Dependence(
        np.zeros(len(p), dtype=np.bool_), np.zeros(len(p), dtype=np.bool_),
        np.zeros(count, dtype=np.bool_),
    )  # fmt: skip
    shown = [model.output_names.index(f"theta_{a}") for a in model.module.AXES]
    largest = np.max([np.max(np.abs(run.held_inputs), axis=0) for run in runs], axis=0)
    steps = np.where(varied != p, varied - p, 0.01 * p + 1e-3)

    def seen(x: FloatArray, u: FloatArray, q: FloatArray, m: FloatArray) -> tuple[FloatArray, ...]:
        r, y = np.zeros(layout.rows + count), np.zeros(len(model.output_names))
        model.module.equation_error(0.5, x, u, q, m, r)
        model.module.outputs(0.5, x, u, q, y)
        return y[shown], r[layout.rows :], r

    for base in (p, varied) * DRAWS:
        x, m = (
            rng.standard_normal(layout.states + layout.rows),
            rng.choice([-1.0, 1.0], layout.modes),
        )
        u = largest * rng.choice([-1.0, 1.0], len(largest))
        here = seen(x, u, base, m)
        for j, step in enumerate(steps if base is p else -steps):
            moved = base.copy()
            moved[j] += step
            there = seen(x, u, moved, m)
            found.sensing[j] |= bool(np.any(there[0] != here[0]))
            found.moving[j] |= bool(np.any(there[1] != here[1]))
        for e, state in enumerate(layout.further):
            moved = x.copy()
            moved[state] += 1.0
            other = seen(moved, u, base, m)[2] - here[2]
            other[layout.rows + e] = 0.0
            found.acting[e] |= bool(np.any(other))
    found.moving[[j for j in model.input_delays if j >= 0 and count]] = True
    return found


def cell_averages(run: Run, column: int, delay: float, grid: IntArray) -> FloatArray:
    """A held input [g], late by `delay` s, averaged over the cell around every sample of a grid."""
    time = run.time[grid]
    middle = 0.5 * (time[1:] + time[:-1])
    edges = np.concatenate(
        [[1.5 * time[0] - 0.5 * time[1]], middle, [1.5 * time[-1] - 0.5 * time[-2]]]
    )
    return _averages(run, column, edges - delay)


def part_averages(run: Run, column: int, delay: float, parts: int) -> FloatArray:
    """A held input, late by `delay` s, averaged over equal parts of every sample [k - 1, parts]."""
    shares = np.arange(parts) / parts
    edges = run.time[:-1, None] + np.diff(run.time)[:, None] * shares
    flat = np.append(edges.ravel(), run.time[-1])
    return _averages(run, column, flat - delay).reshape(-1, parts)


def _averages(run: Run, column: int, edges: FloatArray) -> FloatArray:
    """Averages of a held input between neighbouring `edges`; before the first sample it is that."""
    time, held = run.time, run.held_inputs[:, column]
    integral = np.concatenate([[0.0], np.cumsum(held[:-1] * np.diff(time))])
    at = np.interp(edges, time, integral)
    at += np.where(edges < time[0], (edges - time[0]) * held[0], 0.0)
    at += np.where(edges > time[-1], (edges - time[-1]) * held[-1], 0.0)
    return np.diff(at) / np.diff(edges)
