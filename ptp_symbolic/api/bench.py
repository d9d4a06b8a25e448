"""How fast a machine is simulated here: in one process, with medians, beside SciPy."""

from __future__ import annotations

import os
import platform
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from ptp_symbolic.api.batch import simulate_batch
from ptp_symbolic.api.machine import Machine, Source, load
from ptp_symbolic.api.scipy_peer import beyond_scipy, simulate_with_scipy
from ptp_symbolic.api.simulation import sensitivity, simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.simulation.inputs import InputSignal, as_signals
from ptp_symbolic.numeric.simulation.integration import (
    EXPLICIT,
    default_method,
    tolerance_weights,
)
from ptp_symbolic.numeric.simulation.kernels.records import KERNEL
from ptp_symbolic.numeric.simulation.lanes import cores
from ptp_symbolic.numeric.simulation.run import input_table

FloatArray = NDArray[np.float64]

TOLERANCES = (1e-6, 1e-9)  # rtol, and atol in rad
TIGHT = 1e-12  # of the run that errors are taken against
REPEATS, QUICK_REPEATS = 11, 3
CALLS = 20_000  # of the right-hand side, in a row
MOST_PARAMETERS = 6  # that sensitivities are by
BATCH_SECONDS = 0.5  # that a batch should take
FEWEST, MOST = 64, 20_000  # runs of a batch
SPREAD = 0.01  # of the parameter that differs between runs, relative
DRIVEN = {"V": "multisine:24@0.3", "N m": "multisine:0.1@0.3", "N": "multisine:10@0.3"}
MASSES = ("kg m^2", "kg")
LIBRARIES = ("ptp-symbolic", "numpy", "numba", "llvmlite", "scipy")


@dataclass(frozen=True)
class Timing:
    """One figure: what was timed, its median in `unit`, and where there is one the `peer`, its
    figure on the same problem and the `ratio` of the peer's time to ours.

    `error` and `peer_error` are the largest differences of the final state in rad (m, rad/s, ...)
    from a run at a tolerance of 1e-12.
    """

    what: str
    value: float
    unit: str
    error: float | None = None
    peer: str | None = None
    peer_value: float | None = None
    peer_error: float | None = None
    ratio: float | None = None


@dataclass(frozen=True)
class Speed:
    """The figures of a machine on this computer: its `model`, the inputs of the runs over
    `duration` s, the `computer` by name of the fact, and the `timings`.
    """

    model: str
    duration: float
    inputs: Mapping[str, str]
    computer: Mapping[str, str | int]
    timings: tuple[Timing, ...]


def measure_speed(
    source: Source,
    inputs: Mapping[str, str | InputSignal] | None = None,
    duration: float = 10.0,
    quick: bool = False,
    progress: Callable[[str], None] = lambda text: None,
) -> Speed:
    """Measure what `source`, which `load` takes, costs here: first run, right-hand side, runs of
    `duration` s at two tolerances, sensitivities and a batch, beside SciPy's `solve_ivp`.

    Without `inputs` (signals or profiles by name) every voltage, torque and force is a sine of
    0.3 Hz. `quick` takes fewer repeats and runs. Raises InputError as `simulate` does, and
    SimulationError where the machine does not reach the end.
    """
    if not 0.0 < duration < float("inf"):
        raise InputError(f"Duration {duration:g} s; give a positive number of seconds.")
    here, begun = computer(), time.perf_counter()
    machine = load(source)
    loaded = time.perf_counter() - begun
    given = _default_inputs(machine) if inputs is None else dict(inputs)
    run = _Run(machine, dict(as_signals(machine.input_names, given, duration)), duration)
    repeats = QUICK_REPEATS if quick else REPEATS
    progress("first run")
    timings = [Timing("model loaded or derived", loaded, "s"), *_first_runs(run)]
    progress("right-hand side")
    timings.append(_right_hand_side(machine, repeats))
    progress("runs beside SciPy")
    exact = run.final(TIGHT)
    timings += [_one_run(run, tolerance, exact, repeats) for tolerance in TOLERANCES]
    progress("sensitivities")
    alone = next(each.value for each in timings if each.error is not None) * 1e-3
    timings.append(_sensitivities(run, alone, repeats))
    progress("batch")
    timings.append(_batch(run, alone, quick, repeats))
    shown = {name: str(text) for name, text in given.items() if isinstance(text, str)}
    return Speed(machine.name, duration, shown, here, tuple(timings))


def computer() -> dict[str, str | int]:
    """What the figures depend on: processor, cores that this process may use, system, versions."""
    facts: dict[str, str | int] = {
        "processor": _processor(),
        "cores": cores(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "Python": platform.python_version(),
    }
    if hasattr(os, "getloadavg"):
        facts["load before"] = f"{os.getloadavg()[0]:.1f}"
    for name in LIBRARIES:
        try:
            facts[name] = version(name)
        except PackageNotFoundError:
            facts[name] = "not installed"
    return facts


def _processor() -> str:
    """Name of the processor; Linux has it in a file alone."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.processor() or platform.machine())


@dataclass(frozen=True, eq=False)
class _Run:
    """A run of `machine` over `duration` s, driven by `signals`, of which the end is kept."""

    machine: Machine
    signals: Mapping[str, InputSignal]
    duration: float

    @property
    def ends(self) -> FloatArray:
        """Start and end in s."""
        return np.array([0.0, self.duration])

    def final(self, tolerance: float) -> FloatArray:
        """The final state [n]."""
        found = simulate(
            self.machine, self.ends, self.signals, rtol=tolerance, atol=tolerance, ledger=False
        )
        last: FloatArray = found.x[-1]
        return last


def _median(run: Callable[[], Any], repeats: int) -> float:
    """Median time of a run in s; one run goes before, untimed."""
    run()
    taken = []
    for _ in range(repeats):
        start = time.perf_counter()
        run()
        taken.append(time.perf_counter() - start)
    return float(np.median(taken))


def _default_inputs(machine: Machine) -> dict[str, str]:
    """A profile for every input with a unit of DRIVEN."""
    named = {name: DRIVEN.get(machine.units[name]) for name in machine.input_names}
    return {name: text for name, text in named.items() if text is not None}


def _first_runs(run: _Run) -> list[Timing]:
    """The first run compiles, or reads compiled code from the cache; the second does not."""
    taken = []
    for _ in range(2):
        start = time.perf_counter()
        run.final(TOLERANCES[0])
        taken.append(time.perf_counter() - start)
    return [
        Timing("first run of this process", taken[0], "s"),
        Timing("the next run", taken[1] * 1e3, "ms"),
    ]


@njit(**KERNEL)
def _call_in_a_row(derivative, count, x, u, p, m, dx):  # type: ignore[no-untyped-def]
    for _ in range(count):
        derivative(0.0, x, u, p, m, dx)
        for a in range(len(x)):
            x[a] += 1e-12 * dx[a]


def _right_hand_side(machine: Machine, repeats: int) -> Timing:
    """One call of the compiled right-hand side in the modes of the initial state, each at the state
    that the last one led to.
    """
    start, p = np.array(machine.module.STATE_INITIAL), machine.parameter_vector()
    u, dx = np.zeros(len(machine.input_names)), np.zeros(len(start))
    m = np.zeros(len(machine.mode_names))
    machine.module.initial_modes(0.0, start, u, p, m)
    derivative = machine.module.mode_derivative

    def calls() -> None:
        _call_in_a_row(derivative, CALLS, start.copy(), u, p, m, dx)

    return Timing("right-hand side, a call", _median(calls, repeats) / CALLS * 1e9, "ns")


def _one_run(run: _Run, tolerance: float, exact: FloatArray, repeats: int) -> Timing:
    """A run by the public `simulate`, beside SciPy at the same tolerance."""
    own = _median(partial(run.final, tolerance), repeats)
    error = float(np.abs(run.final(tolerance) - exact).max())
    what = f"run of {run.duration:g} s at {tolerance:g}"
    machine = run.machine
    method = "DOP853" if default_method(machine) == EXPLICIT else "LSODA"
    why = beyond_scipy(machine)
    if why is not None:
        return Timing(what, own * 1e3, "ms", error, f"none: SciPy has no {why}")
    table = input_table(machine, run.signals, machine.parameter_vector(), run.duration)
    weights = tolerance_weights(machine)
    initial = np.array(machine.module.STATE_INITIAL)

    def peer() -> FloatArray:
        _, states, _ = simulate_with_scipy(
            machine, table, run.duration, method, tolerance, tolerance * weights, initial
        )
        return states[-1]

    try:
        other = _median(peer, 1)
    except InputError as stopped:
        return Timing(what, own * 1e3, "ms", error, f"none: {stopped}")
    name = f"SciPy {method}" + (", events" if machine.mode_names else "")
    peer_error = float(np.abs(peer() - exact).max())
    return Timing(what, own * 1e3, "ms", error, name, other * 1e3, peer_error, other / own)


def _sensitivities(run: _Run, alone: float, repeats: int) -> Timing:
    """Derivatives by the first parameters, over the time `alone` in s of the run without."""
    names = run.machine.parameter_names[:MOST_PARAMETERS]
    tolerance = TOLERANCES[0]

    def tangents() -> None:
        sensitivity(
            run.machine,
            run.ends,
            run.signals,
            by_parameters=names,
            rtol=tolerance,
            atol=tolerance,
        )

    taken = _median(tangents, repeats)
    what = f"sensitivities by {len(names)} parameters at {tolerance:g}"
    return Timing(what, taken / alone, "x the run")


def _batch(run: _Run, alone: float, quick: bool, repeats: int) -> Timing:
    """Runs per second of one core in a batch, beside a loop over `simulate`."""
    machine, tolerance = run.machine, TOLERANCES[0]
    wanted = int((0.1 if quick else 1.0) * BATCH_SECONDS / alone)
    count = FEWEST * -(-min(max(wanted, FEWEST), MOST) // FEWEST)
    name, value = _varied(machine)
    values = value * np.linspace(1.0 - SPREAD, 1.0 + SPREAD, count)

    def batch() -> Any:
        return simulate_batch(
            machine,
            run.ends,
            dict(run.signals),
            {name: values},
            rtol=tolerance,
            atol=tolerance,
            threads=1,
        )

    failed = int((~batch().ok).sum())
    rate = count / _median(batch, repeats if quick else QUICK_REPEATS)
    what = f"batch of {count} over {name}" + (f", {failed} failed" if failed else "")
    peer = "a loop over simulate"
    return Timing(what, rate, "1/s/core", None, peer, 1.0 / alone, None, rate * alone)


def _varied(machine: Machine) -> tuple[str, float]:
    """A parameter that may differ between runs, and its default: an inertia or a mass, where there
    is one, whose neighbours are not beyond its bounds.
    """
    free = [
        p
        for p in machine.parameters
        if p.default and p.lower <= p.default * (1 - SPREAD) and p.default * (1 + SPREAD) <= p.upper
    ]
    if not free:
        raise InputError(f"Model '{machine.name}' has no parameter to vary by a hundredth.")
    chosen = next((p for p in free if p.unit in MASSES), free[0])
    return chosen.name, chosen.default
