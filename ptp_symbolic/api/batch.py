"""Thousands of runs of one machine at once, and a machine as a function of arrays."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ptp_symbolic.api.batch_results import WORDS, Batch
from ptp_symbolic.api.inputs import Input, Inputs, input_signals
from ptp_symbolic.api.machine import Machine, Source, load, machine_of
from ptp_symbolic.api.reductions import SETTLING, Reduction, is_reduction, reductions
from ptp_symbolic.api.simulation import STATES
from ptp_symbolic.api.values import parameter_values, state_vector
from ptp_symbolic.errors import InputError, unknown, wrong_type
from ptp_symbolic.numeric.simulation import lanes
from ptp_symbolic.numeric.simulation.inputs import InputSignal, constant
from ptp_symbolic.numeric.simulation.integration import METHODS, checked_accuracy
from ptp_symbolic.numeric.simulation.lanes import (
    BatchProblem,
    BatchStates,
    integrate_batch,
    outputs_along,
)
from ptp_symbolic.numeric.simulation.run import chosen_method, output_times
from ptp_symbolic.platform.units import quantity

FloatArray = NDArray[np.float64]
Column = float | str | ArrayLike
Columns = Mapping[str, Column]
_Integrate = Callable[[BatchProblem, FloatArray, FloatArray, NDArray[np.int64]], BatchStates]

FINAL, ALL = "final", "all"
PROCESSOR, GPU = "cpu", "gpu"
CHUNK_BYTES = 64e6  # of states that are in memory beside the results
SHARE = 0.5  # of the memory of the machine that results may take
LARGEST_STEP = 0.1  # s, as `simulate` has it
LARGEST_SMOOTH_STEP = 1.0  # s: nothing is looked for inside the steps of a smooth model


def simulate_batch(
    model: Source,
    times: float | ArrayLike,
    inputs: Inputs | Sequence[Mapping[str, Input]] | None = None,
    parameters: Columns | None = None,
    initial: Columns | None = None,
    seeds: int | ArrayLike | None = None,
    outputs: str | Sequence[str] = FINAL,
    noise: Mapping[str, float | str] | None = None,
    rtol: float = 1e-8,
    atol: float = 1e-9,
    largest_step: float | None = None,
    method: str | None = None,
    threads: int | None = None,
    *,
    x0: Columns | None = None,
    sensitivities: Sequence[str] = (),
    device: str = PROCESSOR,
    step: float = 1e-4,
    **values: Any,
) -> Batch:
    """Simulate a machine n times, on all cores: `parameters` and `initial` states (`x0`) by name,
    each one value for all runs or an array [n], in SI or as texts with units.

    `model`, `times`, `inputs` and what follows by name are as `simulate` takes them; `inputs` may
    also be a list of n mappings, one per run. `outputs` is "final" (the states at the end), "all"
    (all states at the times), or a list of signals at the times and of reductions, such as
    "largest(theta_pan)", "rms(omega_pan)", "final(theta_tilt)", "settling_time(theta_pan; 1 mrad)",
    "rms_error(theta_pan; step:0.3@0.5)", "pointing_error(theta_pan = 0.3; theta_tilt = 0)".
    `noise` adds white noise of a standard deviation to signals, of a generator of its own per run;
    `seeds` is the first seed (0), or all of them [n]. `sensitivities` names parameters and initial
    states by which all outputs are differentiated, exactly and through events; a settling time has
    no derivative. `device` "gpu" runs a trajectory per thread of an NVIDIA GPU and keeps final
    states: smooth machines as here, others in steps of `step` s.

    A run equals that of `simulate` without ledger: for smooth models within the tolerances, bit for
    bit for all others; with sensitivities it equals that of `sensitivity` bit for bit. A run that
    fails leaves NaN and its reason, and the others finish. Raises InputError for what is wrong for
    all runs, and for results that do not fit into memory.

    >>> import ptp_symbolic as ptp
    >>> batch = ptp.simulate_batch("ideal", 1.0, tau_pan=0.1, J_pan=[5e-4, -1.0, 6e-4])
    >>> batch.status.tolist()
    ['done', 'impossible', 'done']
    >>> batch = ptp.simulate_batch("ideal", 1.0, tau_pan=0.1, J_pan=[5e-4, 6e-4],
    ...                            sensitivities=["J_pan"])
    >>> batch.sensitivity("omega_pan", "J_pan").shape
    (2,)
    """
    machine = load(model)
    if x0 is not None and initial is not None:
        raise InputError("`x0` and `initial` are both the state at the start; give one of them.")
    t = output_times(times)
    given, drives = _drives(machine, inputs, values, t)
    start: Columns = ({} if initial is None else initial) if x0 is None else x0
    for what, part in (("`parameters`", parameters or {}), ("Initial states", start)):
        if not isinstance(part, Mapping):
            raise wrong_type(what, part, "a value or an array [n] by name")
    columns = {**(parameters or {}), **given}
    count = _count(columns, start, seeds, drives)
    wanted = _Wanted.of(machine, outputs, noise or {}, t, tuple(dict.fromkeys(sensitivities)))
    wanted.refuse_too_large(count, len(t))
    p, p_given = _matrix(machine, columns, machine.parameter_names, "Parameter", count)
    x, x_given = _matrix(machine, start, machine.state_names, "Initial state", count)
    wanted.refuse_device(device)
    on_gpu = device == GPU
    chosen = method if method is None or on_gpu else chosen_method(machine, method, METHODS)
    accuracy = checked_accuracy(machine, rtol, atol, largest_step or LARGEST_STEP)
    side_by_side = not wanted.by and lanes.suits(machine, chosen, accuracy)
    if largest_step is None and (on_gpu or side_by_side):
        accuracy = replace(accuracy, largest_step=LARGEST_SMOOTH_STEP)
    kinds = [[kind.get(n, constant(0.0)) for n in machine.input_names] for kind in drives]
    grid = t if wanted.grid else t[[0, -1]]
    problem = BatchProblem(machine, grid, kinds, chosen, accuracy)
    drive = np.zeros(count, np.int64) if len(kinds) == 1 else np.arange(count)
    integrate: _Integrate = partial(integrate_batch, threads=threads)
    if on_gpu:
        integrate = partial(_on_gpu, rtol=rtol, atol=atol, step=step)
    elif wanted.by:
        integrate = wanted.with_tangents(machine, threads)
    result = _run(problem, wanted, p, x, drive, _seeds(seeds, count), integrate)
    return replace(result, t=t, given={**p_given, **x_given})


@dataclass(frozen=True, eq=False)
class _Wanted:
    """What is kept of every run: names of final states, signals, reductions; the noise by signal,
    its standard deviation in SI; whether the times between start and end are needed; what outputs
    are differentiated by.
    """

    final: tuple[str, ...]
    signals: tuple[str, ...]
    reductions: tuple[Reduction, ...]
    noise: Mapping[str, float]
    grid: bool
    by: tuple[str, ...] = ()

    @staticmethod
    def of(
        machine: Machine,
        outputs: str | Sequence[str],
        noise: Mapping[str, Any],
        t: FloatArray,
        by: tuple[str, ...] = (),
    ) -> _Wanted:
        """What `outputs` request, and derivatives of it. Raises InputError for unknown names, and
        for what has no derivative.
        """
        for name in by:
            if name not in (*machine.parameter_names, *machine.state_names):
                options = (*machine.parameter_names, *machine.state_names)
                raise unknown("parameter or state", name, options)
        known = tuple(dict.fromkeys((*machine.state_names, *machine.output_names)))
        for name in noise:
            if name not in known:
                raise unknown("signal", name, known)
        sd = {n: quantity(v, machine.units[n], f"Noise of '{n}'") for n, v in noise.items()}
        if isinstance(outputs, str):
            if outputs == FINAL:
                return _Wanted(machine.state_names, (), (), sd, False, by)
            outputs = list(machine.state_names) if outputs in (ALL, STATES) else [outputs]
        signals = tuple(text for text in outputs if not is_reduction(text))
        for name in signals:
            if name not in known:
                raise unknown("output", name, ("final", "all", *known), "; or a reduction")
        found = reductions(machine, [text for text in outputs if is_reduction(text)], known, t)
        for each in found:
            if by and each.kind == SETTLING:
                raise InputError(
                    f"Output '{each.text}' jumps from one output time to another and has no"
                    " derivative; leave it out, or leave out `sensitivities`."
                )
        grid = bool(signals) or any(each.kind != FINAL for each in found)
        return _Wanted((), signals, tuple(found), sd, grid, by)

    @property
    def read(self) -> tuple[str, ...]:
        """Names of all signals that are read."""
        of_reductions = (name for each in self.reductions for name in each.signals)
        return tuple(dict.fromkeys((*self.final, *self.signals, *of_reductions)))

    def refuse_device(self, device: str) -> None:
        """Raise InputError for a device that is unknown or does not keep what is wanted."""
        if device not in (PROCESSOR, GPU):
            raise unknown("device", device, (PROCESSOR, GPU))
        if device == GPU and self.grid:
            raise InputError(
                "A GPU keeps final states alone; request the outputs 'final' or 'final(SIGNAL)', or"
                " leave `device` out."
            )
        if device == GPU and self.by:
            raise InputError("A GPU computes no sensitivities; leave `device` out.")

    def with_tangents(self, machine: Machine, threads: int | None) -> _Integrate:
        """What integrates runs with their derivatives, those of outputs where these are read."""
        from ptp_symbolic.numeric.sensitivities import directions, integrate_batch_tangents

        states = [name for name in self.by if name in machine.state_names]
        along = directions(machine, [n for n in self.by if n not in states], states)
        return partial(
            integrate_batch_tangents,
            along=along,
            of_outputs=self.reads_outputs(machine),
            threads=threads,
        )

    def reads_outputs(self, machine: Machine) -> bool:
        """Whether signals are read that are no states."""
        return not set(self.read) <= set(machine.state_names)

    def refuse_too_large(self, count: int, k: int) -> None:
        """Raise InputError where the results do not fit into memory."""
        need = 8.0 * count * (len(self.signals) * k + len(self.final) + len(self.reductions))
        need *= 1 + len(self.by)
        have = machine_memory()
        if need > SHARE * have:
            raise InputError(
                f"{count} runs with {len(self.signals)} signals at {k} times need"
                f" {need / 1e9:.3g} GB, and this machine has {have / 1e9:.3g} GB; ask for"
                " reductions or fewer times, or let `ptp-symbolic sweep` write them to disk."
            )


def machine_memory() -> float:
    """Memory of this machine in bytes; without bound where the system does not say."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return np.inf


def _run(
    problem: BatchProblem,
    wanted: _Wanted,
    p: FloatArray,
    x: FloatArray,
    drive: NDArray[np.int64],
    seeds: NDArray[np.int64],
    integrate: _Integrate,
) -> Batch:
    """All runs, chunk by chunk: only what is wanted is kept."""
    machine, count, k = machine_of(problem.model), len(p), len(problem.times)
    numbers = {name: np.empty(count) for name in wanted.final}
    numbers |= {each.text: np.empty(count) for each in wanted.reductions}
    signals = {name: np.empty((count, k)) for name in wanted.signals}
    status, steps = np.empty(count, np.int64), np.empty(count, np.int64)
    outputs, m = {**numbers, **signals}, len(wanted.by)
    slopes = {name: np.empty((*v.shape, m)) for name, v in outputs.items()} if m else {}
    reasons: dict[int, str] = {}
    fewest = 1 if m else lanes_together(machine)
    columns = x.shape[1] + (len(machine.output_names) if wanted.reads_outputs(machine) else 0)
    rows = max(fewest, int(CHUNK_BYTES / (8.0 * k * columns * (1 + m))))
    for first in range(0, count, rows):
        part = slice(first, min(first + rows, count))
        found = integrate(problem, p[part], x[part], drive[part])
        status[part], steps[part] = found.status, found.steps
        reasons |= {first + b: why for b, why in enumerate(found.reasons) if why}
        own = _signals(problem, wanted, p[part], drive[part], found.x, seeds[part])
        for name in wanted.final:
            numbers[name][part] = own[name][:, -1]
        for each in wanted.reductions:
            numbers[each.text][part] = each(problem.times, own)
        for name in wanted.signals:
            signals[name][part] = own[name]
        if m:
            for name, found_slopes in _slopes(machine, wanted, own, found).items():
                slopes[name][part] = found_slopes
    units = {name: machine.units[name] for name in (*wanted.final, *wanted.signals)}
    units |= {each.text: each.unit for each in wanted.reductions}
    words = np.array([WORDS[int(each)] for each in status])
    return Batch(
        machine,
        problem.times,
        numbers,
        signals,
        units,
        {},
        words,
        reasons,
        seeds,
        steps,
        wanted.by,
        slopes,
    )


def _on_gpu(
    problem: BatchProblem,
    p: FloatArray,
    x: FloatArray,
    drive: NDArray[np.int64],
    rtol: float,
    atol: float,
    step: float,
) -> BatchStates:
    """The first and the last state of every run, as `integrate_on_gpu` has it."""
    from ptp_symbolic.numeric.gpu.batch import integrate_on_gpu

    found = integrate_on_gpu(
        problem.model,
        p,
        x,
        problem.drives,
        drive,
        (float(problem.times[0]), float(problem.times[-1])),
        problem.method,
        step,
        rtol,
        atol,
        problem.accuracy.largest_step,
    )
    ends = np.stack([x, found.x], axis=1)
    return BatchStates(found.status, found.reasons, found.steps, ends)


def lanes_together(machine: Machine) -> int:
    """Runs that are integrated side by side."""
    return int(vars(machine.module).get("LANES", 1))


def _signals(
    problem: BatchProblem,
    wanted: _Wanted,
    p: FloatArray,
    drive: NDArray[np.int64],
    x: FloatArray,
    seeds: NDArray[np.int64],
) -> dict[str, FloatArray]:
    """The signals [b, k] that are read, with their noise."""
    machine = problem.model
    found = {
        n: x[:, :, machine.state_names.index(n)] for n in wanted.read if n in machine.state_names
    }
    rest = [name for name in wanted.read if name not in found]
    if rest:
        y = outputs_along(problem, p, drive, x)
        found |= {name: y[:, :, machine.output_names.index(name)] for name in rest}
    noisy = [name for name in wanted.read if name in wanted.noise]
    found |= {name: found[name].copy() for name in noisy}
    for b, seed in enumerate(seeds if noisy else ()):
        generator = np.random.default_rng(int(seed))
        for name in noisy:
            found[name][b] += wanted.noise[name] * generator.standard_normal(x.shape[1])
    return found


def _slopes(
    machine: Machine, wanted: _Wanted, own: Mapping[str, FloatArray], found: BatchStates
) -> dict[str, FloatArray]:
    """Derivatives [b, m] of numbers and [b, k, m] of signals, at the signals `own` [b, k]."""
    is_state = [name in machine.state_names for name in wanted.by]
    order = np.argsort(np.argsort(is_state, kind="stable"))  # tangents by parameters come first
    tangents = {
        name: found.tangents[:, :, machine.state_names.index(name)][..., order]
        if name in machine.state_names
        else found.output_tangents[:, :, machine.output_names.index(name)][..., order]
        for name in wanted.read
    }
    slopes = {name: tangents[name][:, -1] for name in wanted.final}
    slopes |= {each.text: each.slopes(own, tangents) for each in wanted.reductions}
    return slopes | {name: tangents[name] for name in wanted.signals}


def _drives(
    machine: Machine,
    inputs: Inputs | Sequence[Mapping[str, Input]] | None,
    values: Mapping[str, Any],
    t: FloatArray,
) -> tuple[dict[str, Any], list[dict[str, InputSignal]]]:
    """Parameters among `values`, and the inputs of every kind of run: one, or one per run."""
    known = (*machine.input_names, *machine.parameter_names)
    for name in values:
        if name not in known:
            raise unknown("input, parameter or argument", name, known)
    own = {n: v for n, v in values.items() if n in machine.parameter_names}
    common = input_signals(machine, {n: v for n, v in values.items() if n not in own}, t)
    several: Sequence[Any] = inputs if isinstance(inputs, list | tuple) else [inputs]
    kinds = [input_signals(machine, each, t) for each in several]
    return own, [{**common, **kind} for kind in kinds]


def _count(
    columns: Columns, start: Columns, seeds: Any, drives: Sequence[Mapping[str, Any]]
) -> int:
    """Number of runs. Raises InputError where arrays have different lengths."""
    lengths = {
        f"'{n}'": np.shape(v)[0] for n, v in (*columns.items(), *start.items()) if np.ndim(v)
    }
    if np.ndim(seeds):
        lengths["seeds"] = np.shape(seeds)[0]
    if len(drives) > 1:
        lengths["inputs"] = len(drives)
    if len(set(lengths.values())) > 1:
        said = ", ".join(f"{name} has {length}" for name, length in lengths.items())
        raise InputError(f"Values of different numbers of runs: {said}; give as many of each.")
    return next(iter(lengths.values()), 1)


def _matrix(
    machine: Machine, columns: Columns, names: Sequence[str], what: str, count: int
) -> tuple[FloatArray, dict[str, FloatArray]]:
    """Values [count, names] in SI, and the columns that differ between runs.

    Raises InputError for unknown names and for what is no quantity, out of bounds for all.
    """
    for name in columns:
        if name not in names:
            raise unknown(what.lower().split()[-1], name, names)
    same: dict[str, Any] = {n: v for n, v in columns.items() if not np.ndim(v)}
    if what == "Parameter":
        common = machine.parameter_vector(parameter_values(machine, same))
    else:
        common = state_vector(machine, same, what)
    matrix, varied = np.repeat(common[None], count, 0), {}
    for name, column in columns.items():
        if not np.ndim(column):
            continue
        array = np.asarray(column)
        if array.ndim != 1:
            raise InputError(f"{what} '{name}' has shape {array.shape}; give one value per run.")
        if array.dtype.kind not in "fiu":
            said = f"{what} '{name}'"
            array = np.array([quantity(v, machine.units[name], said) for v in array.tolist()])
        matrix[:, names.index(name)] = array
        varied[name] = matrix[:, names.index(name)]
    return np.ascontiguousarray(matrix), varied


def _seeds(seeds: Any, count: int) -> NDArray[np.int64]:
    """A seed per run. Raises InputError for one that is negative or no whole number."""
    array = np.asarray(0 if seeds is None else seeds)
    if array.dtype.kind not in "iu" or np.any(array < 0):
        raise InputError(f"Seeds {seeds!r}: give whole numbers of zero or more.")
    return (array + np.arange(count) if array.ndim == 0 else array).astype(np.int64)


def batch_function(
    model: Source,
    inputs: Sequence[str],
    outputs: str | Sequence[str] = FINAL,
    times: float | ArrayLike = 10.0,
    jac: bool = False,
    **common: Any,
) -> Callable[[ArrayLike], Any]:
    """A machine as a function f(X [n, p]) -> Y [n, q], as SALib, openturns, chaospy and SciPy take.

    The columns of X are the parameters and initial states named by `inputs`, in SI; those of Y are
    the final states or the reductions of `outputs` (see `simulate_batch`, which also takes what is
    `common` to all runs: signals and parameters by name, `parameters`, `x0`, tolerances). With
    `jac` it returns Y and its derivatives [n, q, p], as SciPy has it. Rows of runs that fail are
    NaN. Raises InputError as `simulate_batch`, and for outputs that are no numbers.

    >>> import ptp_symbolic as ptp
    >>> f = ptp.batch_function("ideal", ["J_pan", "b_pan"], ["final(omega_pan)"], 1.0, tau_pan=0.1)
    >>> f([[5e-4, 0.1], [5e-4, 0.2]]).round(3)
    array([[1. ],
           [0.5]])
    """
    machine, names = load(model), tuple(inputs)
    known = (*machine.parameter_names, *machine.state_names)
    for name in names:
        if name not in known:
            raise unknown("parameter or state", name, known)
    wanted = _Wanted.of(machine, outputs, {}, output_times(times), names if jac else ())
    if wanted.signals:
        raise InputError(
            f"Output '{wanted.signals[0]}' is a signal; give numbers, such as"
            f" 'final({wanted.signals[0]})' or 'largest({wanted.signals[0]})'."
        )
    given_start = dict(common.pop("x0", None) or common.pop("initial", None) or {})
    given_parameters = dict(common.pop("parameters", None) or {})

    def evaluate(points: ArrayLike) -> Any:
        """The outputs [n, q] at points [n, p], or [q] at one point [p]; and their derivatives."""
        table = np.asarray(points, dtype=np.float64)
        if table.ndim not in (1, 2) or table.shape[-1] != len(names):
            raise InputError(
                f"Points of shape {table.shape}; give [n, {len(names)}]: {', '.join(names)}."
            )
        rows = np.atleast_2d(table)
        columns = dict(zip(names, rows.T, strict=True))
        states = {n: v for n, v in columns.items() if n in machine.state_names}
        found = simulate_batch(
            machine,
            times,
            parameters={
                **given_parameters,
                **{n: v for n, v in columns.items() if n not in states},
            },
            x0={**given_start, **states},
            outputs=outputs,
            sensitivities=wanted.by,
            **common,
        )
        values = np.stack(list(found.numbers.values()), axis=1)
        values = values if table.ndim == 2 else values[0]
        if not jac:
            return values
        slopes = np.stack(list(found.sensitivities.values()), axis=1)
        return values, slopes if table.ndim == 2 else slopes[0]

    return evaluate
