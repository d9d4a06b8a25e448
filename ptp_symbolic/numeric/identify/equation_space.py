"""Residuals of the equations along the measured motion: residual torques and residual currents.

One row per chosen sample and equation: the torque in N m that an axis lacks, averaged under a test
function (see `weak_form`), or the measured minus the integrated value of a further state. The rows
are nearly linear in the parameters, so that far starts and many candidates cost next to nothing.
Rows whose window holds a joint at rest or a change of the touched face are left out: there friction
and contact are set-valued. Which parameters and states act on what is probed at random states.
"""

from collections import OrderedDict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.identify.along_motion import (
    Layout,
    equation_addresses,
    gear_ahead,
    gear_pushes,
    layout_of,
    torques_along,
)
from ptp_symbolic.numeric.identify.constants import CYCLES, LITTLE, MOST, SAME, SEED
from ptp_symbolic.numeric.identify.equation_rows import (
    FurtherStates,
    MeasuredMotion,
    RunRows,
    angles_of,
    every_row,
    half_width_of,
    measured_motion,
    resting_rates,
    rows_that_count,
    rows_without,
    states_along,
)
from ptp_symbolic.numeric.identify.run import (
    Run,
    cell_averages,
    usual_period,
)
from ptp_symbolic.numeric.identify.weak_form import averages
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import delays_of

BoolArray = NDArray[np.bool_]
FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


Key = TypeVar("Key", bound=Hashable)
Kept = TypeVar("Kept")


class Recent(Generic[Key, Kept]):
    """The values that were made last, by key; threads may share it."""

    def __init__(self) -> None:
        self._values: OrderedDict[Key, Kept] = OrderedDict()

    def of(self, key: Key, made: Callable[[], Kept], most: int) -> Kept:
        """The value of a key, `made` where it is not kept; of more than `most` the oldest go."""
        found = self._values.get(key)
        if found is None:
            found = self._values[key] = made()
        while len(self._values) > most:
            self._values.popitem(last=False)
        return found

    def clear(self) -> None:
        """Keep nothing."""
        self._values.clear()


Torques = tuple[FloatArray, FloatArray, FloatArray]  # see `torques_along`
Change = tuple[int, bytes]  # run, what changes or is added


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
    _motions: Recent[Change, MeasuredMotion] = field(default_factory=Recent, init=False, repr=False)
    _states: Recent[Change, FurtherStates] = field(default_factory=Recent, init=False, repr=False)
    _inputs: Recent[Change, FloatArray] = field(default_factory=Recent, init=False, repr=False)

    @property
    def equations(self) -> int:
        """Number of equations: torque of every axis, then every measured further state."""
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
        """All rows [n] at parameters p [np], equation by equation and run by run, in N m or state
        units.

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
        rows = self.rows_of[number]
        along, ahead, (lacking, inertia, slopes), further = self._torques(number, p, own, rows.part)
        curvature = along.curvature
        if self.gears:
            behind = averages(rows.curved, ahead)[:, self.gears]
            curvature = np.column_stack([curvature, curvature[:, self.gears] + behind])
        torque = averages(rows.on_grid, lacking)
        torque += np.einsum("kar,kr->ka", inertia[rows.chosen], curvature)
        torque += np.einsum("kaj,kj->ka", slopes[rows.chosen], along.missed)
        if not self.measured:
            return torque
        at, places = rows.grid[rows.chosen], [place for _, place in self.measured]
        electric = averages(rows.on_samples, np.ascontiguousarray(further.left[:, places]))
        rates = along.missed[:, len(self.layout.angle) :]
        electric -= np.einsum("kea,ka->ke", further.by_rate[at][:, places], rates)
        return np.column_stack([torque, electric])

    def _torques(
        self, number: int, p: FloatArray, own: FloatArray | None, part: IntArray
    ) -> tuple[MeasuredMotion, FloatArray, Torques, FurtherStates]:
        """Motion, lead of the gears, what `torques_along` gives on the grid (of every sample the
        `part` [g] that is needed), and further states.
        """
        addresses = equation_addresses(self.model)
        rows, along = self.rows_of[number], self._motion(number, p)
        inputs = len(self.model.input_names)
        added = np.zeros((len(rows.grid), inputs + len(self.layout.further)))
        added = added if own is None else own
        motion = along.coarse._replace(inputs=self._given(number, p) + added[:, :inputs])
        wanted = np.convolve(part, np.ones(3), "same") > 0.0  # neighbours too, for the rate
        ahead, face = gear_ahead(addresses, self.layout, motion, p, self.resting, rows.face, wanted)
        further = self._further(number, p, along, added[:, :inputs])
        acting = further.acting + added[:, inputs:]
        rate = np.gradient(ahead, motion.time, axis=0) if self.gears else ahead
        torques = torques_along(
            addresses, self.layout, motion, p, self.resting, ahead, rate, face, acting, part
        )
        return along, ahead, torques, further

    def _given(self, number: int, p: FloatArray) -> FloatArray:
        """Inputs [g, nu] of a run, delayed and averaged over the cells of the grid."""
        delays = delays_of(self.model, p)
        run, grid = self.runs[number], self.rows_of[number].grid

        def averaged() -> FloatArray:
            return np.column_stack([cell_averages(run, j, d, grid) for j, d in enumerate(delays)])

        return self._inputs.of((number, delays.tobytes()), averaged, self._asked_for(delays))

    def _motion(self, number: int, p: FloatArray) -> MeasuredMotion:
        """The measured motion, errors of the sensors at p taken out."""
        run, rows, further = self.runs[number], self.rows_of[number], len(self.layout.further)

        def measured() -> MeasuredMotion:
            angles = angles_of(self.model, self.layout, run, p, bool(self.sensing.any()))
            return measured_motion(
                run, angles, further, self.measured, rows, self.half_width, self.rate_width
            )

        changing = p[self.sensing]
        return self._motions.of((number, changing.tobytes()), measured, self._asked_for(changing))

    def _further(
        self, number: int, p: FloatArray, along: MeasuredMotion, added: FloatArray
    ) -> FurtherStates:
        """Further states along the motion, with what is `added` [g, nu] to the inputs."""
        if not len(self.layout.further):
            samples = len(self.runs[number].time)
            none = np.zeros((len(added), 0)), np.zeros((samples, 0)), np.zeros((0, 0, 0))
            return FurtherStates(*none)
        changing = p[self.moving | self.sensing]
        key = (number, changing.tobytes() + added.tobytes())
        places = [place for _, place in self.measured]
        integrated = partial(
            states_along,
            self.model,
            self.layout,
            self.runs[number],
            self.rows_of[number],
            along.fine,
            p,
            added,
            self.resting,
            self.acting,
            places,
        )
        return self._states.of(key, integrated, self._asked_for(changing))

    def _asked_for(self, changing: FloatArray) -> int:
        """At how many places of so many `changing` parameters a Jacobian looks, in all runs."""
        return (len(changing) + 1) * len(self.runs)

    def decide_rows(self, p: FloatArray, others: Sequence[FloatArray]) -> None:
        """Decide anew which rows count, and at p [np] which faces are touched.

        A row counts where no face changes at p nor at `others`: an inertia or a friction that is
        far from its true value would miss the changes, and between two faces no torque passes.
        """
        axes = len(self.layout.angle)
        every = [every_row(run, self.half_width, axes, self.equations) for run in self.runs]
        self.rows_of = tuple(every)
        self.forget()
        self.rows_of = tuple(self._that_count(k, p, others) for k in range(len(self.runs)))
        self.forget()

    def leave_out_pulled(self, p: FloatArray, margin: FloatArray) -> bool:
        """Leave out rows in whose window a gear would have to pull its joint by more than `margin`
        [na] in N m at p [np]: the joint has left the face and crosses its gap. Whether any was;
        where that were most of them, p is wrong, not the face, and all stay.
        """
        if not self.gears:
            return False
        addresses, every = equation_addresses(self.model), []
        for number, rows in enumerate(self.rows_of):
            along, _, _, further = self._torques(number, p, None, rows.part)
            pushes = gear_pushes(
                addresses, self.layout, along.coarse, p, self.resting, rows.face, further.acting
            )
            every.append(rows_without(self.runs[number], rows, pushes < -margin, self.half_width))
        before, after = (sum(int(r.kept.sum()) for r in rows) for rows in (self.rows_of, every))
        if not (1.0 - MOST) * before <= after < before:
            return False
        self.rows_of = tuple(every)
        self.forget()
        return True

    def _that_count(self, number: int, p: FloatArray, others: Sequence[FloatArray]) -> RunRows:
        """The rows of a run, those that count decided anew."""
        rows, motion = self.rows_of[number], self._motion(number, p).coarse
        addresses, every = equation_addresses(self.model), np.ones(len(rows.grid), dtype=np.bool_)
        faces = [
            gear_ahead(addresses, self.layout, motion, q, self.resting, rows.face, every)[1]
            for q in (p, *others)
        ]
        run, measured = self.runs[number], len(self.measured)
        return rows_that_count(run, rows, motion, faces, self.resting, self.half_width, measured)

    def forget(self) -> None:
        """Clear all caches: after a search over sensors, currents or delays."""
        self._motions.clear()
        self._inputs.clear()
        self._states.clear()

    def own_torque(self, p: FloatArray) -> list[FloatArray]:
        """Per run what inputs and measured further states [g, nu + e] lack at p [np] for the torque
        of the model to be its own: as a regressor the measured one carries the residual that it
        should explain (Janot, Vandanjon and Gautier, 2014).
        """
        found = []
        for number in range(len(self.runs)):
            part = np.full(len(self.rows_of[number].grid), 2)
            along, _, (lacking, inertia, _), _ = self._torques(number, p, None, part)
            acceleration = along.coarse.acceleration
            every = np.column_stack([acceleration, acceleration[:, self.gears]])
            torque = lacking + np.einsum("kar,kr->ka", inertia, every)
            acting = self._acting(number, p, lacking)
            added = np.zeros((len(torque), acting.shape[2]))
            for axis, strongest in enumerate(np.argmax(np.mean(np.abs(acting), axis=0), axis=1)):
                slope = acting[:, axis, strongest]
                seen = np.abs(slope) > LITTLE * np.max(np.abs(slope), initial=0.0)
                added[seen, strongest] -= torque[seen, axis] / slope[seen]
            found.append(added)
        return found

    def drive_gains(self, p: FloatArray) -> FloatArray:
        """By how much the torque of every equation [equations] changes with its strongest input, in
        N m by the unit of that, on average over the first run at p [np]; 1 where none acts.
        """
        gains = np.ones(self.equations)
        part = np.ones(len(self.rows_of[0].grid), dtype=np.int64)
        acting = self._acting(0, p, self._torques(0, p, None, part)[2][0])
        strongest = np.max(np.mean(np.abs(acting), axis=0), axis=1, initial=0.0)
        gains[: len(strongest)] = np.where(strongest > 0.0, strongest, 1.0)
        return gains

    def _acting(self, number: int, p: FloatArray, lacking: FloatArray) -> FloatArray:
        """Derivative [g, na, nu + e] of the torque that every axis is `lacking` [g, na] in a run by
        inputs and measured further states, which are shifted for good. It differs from sample to
        sample where friction is a share of the torque.
        """
        inputs, further = len(self.model.input_names), len(self.layout.further)
        shown = {inputs + place for _, place in self.measured}
        none = np.zeros((len(self.rows_of[number].grid), inputs + further))
        part = np.ones(len(none), dtype=np.int64)
        result = np.zeros((*lacking.shape, inputs + further))
        for j in range(inputs + further):
            if j < inputs or j in shown:
                shifted = none.copy()
                shifted[:, j] = SAME
                there = self._torques(number, p, shifted, part)[2][0]
                result[:, :, j] = (there - lacking) / SAME
        return result


class RowMotion(NamedTuple):
    """Motion of an axis at its rows [n]: angle in rad, rate in rad/s, and the time in s since the
    joint turned back, nan before it first did.
    """

    angle: FloatArray
    rate: FloatArray
    since_reversal: FloatArray


def row_motion(space: EquationSpace, axis: int) -> RowMotion:
    """The measured motion of `axis` at the rows of its own equation: the angle as it was measured,
    the rate as a central difference over a window.
    """
    equation, number, time = space.labels()
    own = equation == axis
    found = np.full((3, int(own.sum())), np.nan)
    for k, run in enumerate(space.runs):
        here = number[own] == k
        if here.any():
            found[:, here] = _along(space, run, axis, time[own][here])
    return RowMotion(*found)


def _along(space: EquationSpace, run: Run, axis: int, time: FloatArray) -> FloatArray:
    """Angle, rate and time since reversal [3, n] of one run at `time` [n]."""
    column = run.signals.index(f"theta_{space.model.module.AXES[axis]}")
    measured = run.measured[:, column]
    h = space.half_width

    def rate_at(at: FloatArray) -> FloatArray:
        ahead, behind = (np.interp(at + d, run.time, measured) for d in (h, -h))
        return np.asarray((ahead - behind) / (2.0 * h))

    rate = rate_at(run.time)
    rate[np.abs(rate) <= _slowest(space, run, column)] = 0.0
    moving = np.flatnonzero(rate)
    turns = np.flatnonzero(np.diff(np.sign(rate[moving])) != 0.0)
    reversals = run.time[moving[turns + 1]]
    last = np.searchsorted(reversals, time, side="right") - 1
    since = np.full(len(time), np.nan)
    since[last >= 0] = time[last >= 0] - reversals[last[last >= 0]]
    return np.stack([np.interp(time, run.time, measured), rate_at(time), since])


def _slowest(space: EquationSpace, run: Run, column: int) -> float:
    """The rate in rad/s that noise and rounding of a signal give a joint at rest."""
    period = float(np.median(np.diff(run.time)))
    noise = 1.0 / run.weight[[column]]
    return float(resting_rates(run.counts[[column]], noise, period, space.half_width)[0])


@dataclass(frozen=True, eq=False)
class Dependence:
    """Which parameters act on what the sensors of the angles show (`sensing` [np]) and on the rates
    of further states (`moving` [np]), and which of these states act on a torque or on one another
    (`acting` [e]).
    """

    sensing: BoolArray
    moving: BoolArray
    acting: BoolArray


def dependence_of(
    model: Model, layout: Layout, runs: Sequence[Run], p: FloatArray, varied: FloatArray
) -> Dependence:
    """What depends on what, probed at random states with p [np] and with `varied` [np]
    in turn: what half of all states show is missed once in 64.
    """
    rng = np.random.default_rng(SEED)
    count = len(layout.further)
    found = Dependence(
        np.zeros(len(p), dtype=np.bool_),
        np.zeros(len(p), dtype=np.bool_),
        np.zeros(count, dtype=np.bool_),
    )
    shown = [model.output_names.index(f"theta_{a}") for a in model.module.AXES]
    largest = np.max([np.max(np.abs(run.held_inputs), axis=0) for run in runs], axis=0)
    steps = np.where(varied != p, varied - p, 0.01 * p + 1e-3)

    def seen(x: FloatArray, u: FloatArray, q: FloatArray, m: FloatArray) -> tuple[FloatArray, ...]:
        r, y = np.zeros(layout.rows + count), np.zeros(len(model.output_names))
        model.module.equation_error(0.5, x, u, q, m, r)
        model.module.outputs(0.5, x, u, q, y)
        return y[shown], r[layout.rows :], r

    for base in (p, varied) * CYCLES:
        x, m = (
            rng.standard_normal(layout.states + layout.rows),
            rng.choice([-1.0, 1.0], layout.modes),
        )
        u = largest * rng.choice([-1.0, 1.0], len(largest))
        here = seen(x, u, base, m)
        for j, step in enumerate(steps if base is p else -steps):
            shifted = base.copy()
            shifted[j] += step
            there = seen(x, u, shifted, m)
            found.sensing[j] |= bool(np.any(there[0] != here[0]))
            found.moving[j] |= bool(np.any(there[1] != here[1]))
        for e, state in enumerate(layout.further):
            shifted = x.copy()
            shifted[state] += 1.0
            other = seen(shifted, u, base, m)[2] - here[2]
            other[layout.rows + e] = 0.0
            found.acting[e] |= bool(np.any(other))
    found.moving[[j for j in model.input_delays if j >= 0 and count]] = True
    return found


def prepare_equation_space(
    model: Model,
    runs: Sequence[Run],
    p: FloatArray,
    others: Sequence[FloatArray],
    varied: FloatArray,
    shortest: bool = False,
    half_width: float | None = None,
) -> EquationSpace:
    """The equation space of `model` over whole `runs`.

    Which rows count is decided at the parameters p [np] and at `others` (see `decide_rows`);
    `varied` are parameters that differ from p in all that may be searched, to see which of them act
    on sensors and on further states; windows are as short as noise allows with `shortest`, or of a
    `half_width` in s. Raises InputError for a model with sampled states, and where an axis has no
    angle among the signals.
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
    depends = dependence_of(model, layout, runs, p, varied)
    columns = [runs[0].signals.index(f"theta_{axis}") for axis in axes]
    noise = 1.0 / runs[0].weight[columns]
    period = usual_period(runs)
    if half_width is None:
        half_width = half_width_of(runs, columns, noise, period, shortest)
    resting = resting_rates(runs[0].counts[columns], noise, period, 0.5 * half_width)
    frictions = set(layout.friction_axis.tolist())
    resting = np.where([a in frictions for a in range(len(axes))], resting, 0.0)
    widths, acts = (half_width, 0.5 * half_width), (depends.sensing, depends.moving, depends.acting)
    space = EquationSpace(model, tuple(runs), layout, *widths, resting, measured, *acts)
    space.decide_rows(p, others)
    return space
