"""The experiment as it would be played: inputs, what the machine does, what its sensors show.

What the machine may do in an experiment: limits of inputs, states and measured signals.

A model that may be the machine, with what the logs so far know of its parameters.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose.responses import stacked_jacobian
from ptp_symbolic.numeric.identify.constants import SEED
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, limits, slopes, to_search
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import project_out
from ptp_symbolic.numeric.identify.least_squares import (
    Effort,
    Problem,
    all_values,
    minimise,
    problem_of,
    simulations_of,
)
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.numeric.identify.start import put_into_gap
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import table
from ptp_symbolic.numeric.simulation.run import SimulationError, simulate, start_of
from ptp_symbolic.platform import Platform
from ptp_symbolic.platform.units import compatible, to_si

FloatArray = NDArray[np.float64]


TOLERANCE = Tolerance()
FIRM = 1e-3  # relative gain of an iteration at which a refit has ended
SINGULAR = 1e-12  # of the largest eigenvalue: below, nothing is known of a direction


@dataclass(frozen=True, eq=False)
class Contender:
    """A model with its `free` parameters and the `values` of all.

    `memory` [m, nf] is a root of the information of the logs so far about the search coordinates at
    `values`, in 1/sigma, no rows without logs; `left` is the sum of squares that it leaves of them,
    in squared sigmas.
    """

    name: str
    model: Model
    free: tuple[FreeParameter, ...]
    values: Mapping[str, float]
    memory: FloatArray
    left: float = 0.0

    @property
    def phi(self) -> FloatArray:
        """Search coordinates [nf] of the values."""
        return to_search(self.free, self.values)

    def drawn(self, shift: FloatArray) -> "Contender":
        """The same model with values that the logs so far allow: `shift` [nf] standard deviations
        away, in directions that are independent of one another.
        """
        if not len(self.memory):
            return self
        lower, upper = limits(self.free)
        away = np.linalg.lstsq(self.memory, shift[: len(self.memory)], rcond=SINGULAR)[0]
        phi = np.clip(self.phi + away, lower, upper)
        return replace(self, values={**self.values, **all_values(self.free, phi)})


def without_logs(
    name: str, model: Model, free: Sequence[FreeParameter], values: Mapping[str, float]
) -> Contender:
    """A contender of which nothing is known but its `values`."""
    return Contender(name, model, tuple(free), values, np.zeros((0, len(free))))


def from_fit(name: str, fit: Fit) -> Contender:
    """A contender as it was fitted to the logs so far."""
    table = stacked_jacobian(fit)
    left = sum(float(e.residual @ e.residual) for e in fit.evaluations)
    memory = np.asarray(np.linalg.qr(table, mode="r"))
    return Contender(name, fit.model, fit.free, fit.values, memory, left)


@dataclass(frozen=True, eq=False)
class Refit:
    """How near a contender comes to a run: the `evaluation` of the run, and the squared distance in
    sigmas to which it moves away from the `logs` so far.
    """

    evaluation: Evaluation
    logs: float


def refitted(contender: Contender, run: Run, place: float, iterations: int) -> Refit | None:
    """Fit a contender to `run` and to what it knows of the logs; None where it does not simulate.

    The start of the run is fitted with it, from `place` in every gap, in half gaps.
    """
    effort = Effort(iterations, FIRM, TOLERANCE)
    simulations = simulations_of(
        contender.model, [run], contender.free, contender.values, effort, None
    )
    problem, z = problem_of(simulations, effort), [_start(run, place)]
    if len(contender.memory):
        problem, z = _remembering(problem, contender), [*z, np.zeros(0)]
    best = minimise(problem, contender.phi, z, iterations, effort.gain)
    if best.failed:
        return None
    logs = sum(float(e.residual @ e.residual) for e in best.evaluations[1:])
    return Refit(best.evaluations[0], logs)


def _remembering(problem: Problem, contender: Contender) -> Problem:
    """`problem` with the logs so far as one more run, linear and without a start."""
    centre, memory = contender.phi, contender.memory
    by_start, nothing = np.zeros((len(memory), 0)), np.zeros(0)

    def both(
        phi: FloatArray,
        z: Sequence[FloatArray],
        tangents: bool,
        only: Sequence[int] | None = None,
    ) -> list[Evaluation]:
        logs = Evaluation(memory @ (phi - centre), memory, by_start)
        asked = range(len(z)) if only is None else only
        simulated = [k for k in asked if k < len(z) - 1]
        found = problem.evaluate(phi, z[:-1], tangents, simulated) if simulated else []
        return [*found, *(logs for k in asked if k == len(z) - 1)]

    return replace(
        problem,
        evaluate=both,
        start_lower=[*problem.start_lower, nothing],
        start_upper=[*problem.start_upper, nothing],
        start_sigma=[*problem.start_sigma, nothing],
    )


def _start(run: Run, place: float) -> FloatArray:
    """The guess of the start unknowns [nz], with `place` in every gap."""
    gaps = np.array([u.contact is not None for u in run.unknowns], dtype=bool)
    return np.where(gaps, place, run.guess)


def as_it_is(contender: Contender, run: Run, place: float) -> Evaluation | None:
    """A contender at its values along `run`, begun at `place` in every gap, with Jacobians; None
    where it does not simulate.
    """
    effort = Effort(0, FIRM, TOLERANCE)
    simulations = simulations_of(
        contender.model, [run], contender.free, contender.values, effort, None
    )
    (e,) = simulations.evaluate(contender.phi, [_start(run, place)], True)
    return None if e.failed else e


def information(contender: Contender, run: Run, place: float) -> FloatArray | None:
    """Information [nf, nf] about the search coordinates in `run` and in the logs so far, the start
    of the run unknown; None where it cannot be simulated.
    """
    e = as_it_is(contender, run, place)
    if e is None:
        return None
    seen = project_out(e.by_parameter, e.by_start)
    return np.asarray(seen.T @ seen + contender.memory.T @ contender.memory)


def spreads(contender: Contender, known: FloatArray) -> dict[str, float]:
    """Standard deviation of every free parameter in its unit, where `known` [nf, nf] is the
    information about the search coordinates; infinite where there is none.
    """
    units = np.abs(slopes(contender.free, contender.phi))
    return {
        f.name: float(units[k] * np.exp(-0.5 * log_information(known, [k])))
        for k, f in enumerate(contender.free)
    }


def log_information(known: FloatArray, wanted: Sequence[int]) -> float:
    """Logarithm of the determinant of the information about the coordinates `wanted`, all others
    unknown (Ds-optimality: Atkinson and Donev, 1992); -inf where one of them cannot be known.
    """
    size = np.sqrt(np.diag(known))
    if not np.all(size[list(wanted)] > 0.0):
        return -np.inf
    seen = size > 0.0
    unit = known[np.ix_(seen, seen)] / np.outer(size[seen], size[seen])
    places = np.flatnonzero(np.isin(np.flatnonzero(seen), list(wanted)))
    rest = np.delete(np.arange(len(unit)), places)
    inner, across = unit[np.ix_(places, places)], unit[np.ix_(places, rest)]
    left = inner - across @ np.linalg.pinv(unit[np.ix_(rest, rest)], SINGULAR, True) @ across.T
    shares = np.linalg.eigvalsh(left)
    if not shares[0] > SINGULAR:
        return -np.inf
    return float(np.sum(np.log(shares)) + 2.0 * np.sum(np.log(size[list(wanted)])))


_NUMBER = r"[+-]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d+)?"
_LIMIT = re.compile(rf"({_NUMBER})(?:\.\.({_NUMBER}))?\s*(.*)")


@dataclass(frozen=True)
class Limit:
    """The signal `name` stays between `lower` and `upper`, in its SI unit."""

    name: str
    lower: float
    upper: float


def read_limits(texts: Sequence[str], model: Model) -> dict[str, Limit]:
    """Limits by name, of texts such as ``u_pan=12 V`` (both ways) and ``theta_pan=-90..45 deg``.

    Raises InputError for unknown names, wrong units, empty ranges and inputs without a limit.
    """
    known = (*model.input_names, *model.state_names, *model.output_names)
    found: dict[str, Limit] = {}
    for text in texts:
        name, _, value = text.partition("=")
        if name not in known:
            raise unknown("signal", name, tuple(dict.fromkeys(known)))
        found[name] = _limit(name, value.strip(), model.units[name])
    missing = [name for name in model.input_names if name not in found]
    if missing:
        name, unit = missing[0], model.units[missing[0]]
        raise InputError(
            f"Input {name} has no limit; say how far it may go in {unit}, such as"
            f" `limits` '{name}=10 {unit}'."
        )
    return found


def _limit(name: str, value: str, unit: str) -> Limit:
    match = _LIMIT.fullmatch(value)
    if match is None:
        raise InputError(
            f"Limit '{name}={value}': write {name}=HIGH or {name}=LOW..HIGH, with a unit that fits"
            f" {unit}."
        )
    given = match[3] or unit
    if not compatible(given, unit):
        raise InputError(
            f"Limit '{name}={value}': {given} does not fit {unit}, the unit of {name}."
        )
    factor = to_si(given)[0]
    first = factor * float(match[1])
    lower, upper = (-first, first) if match[2] is None else (first, factor * float(match[2]))
    if not lower < upper:
        raise InputError(
            f"Limit '{name}={value}': leaves no room from {lower:g} to {upper:g} {unit}; give the"
            " lower end first."
        )
    return Limit(name, lower, upper)


def rest_of(limit: Limit) -> float:
    """The value of an input at rest: zero, or what is nearest to it."""
    return float(np.clip(0.0, limit.lower, limit.upper))


def excess(limits: Mapping[str, Limit], signals: Mapping[str, FloatArray]) -> tuple[float, str]:
    """By which factor `signals` (each [k]) come further from where they begin than they may, and
    the name of the one that does so most; infinite where one begins outside.
    """
    worst, name = 0.0, ""
    for limit in limits.values():
        values = signals[limit.name]
        begin = float(values[0])
        if not limit.lower <= begin <= limit.upper:
            return np.inf, limit.name
        room = max(limit.upper - begin, 1e-300), max(begin - limit.lower, 1e-300)
        factor = max((values.max() - begin) / room[0], (begin - values.min()) / room[1])
        if factor > worst:
            worst, name = float(factor), limit.name
    return worst, name


RELATIVE, ABSOLUTE = 1e-6, 1e-8  # tolerances (1, rad) of what is taken for the machine
NO_COLUMNS = np.zeros(0, dtype=np.int64)
DIGITS = 4  # of an input, below its limit
TRIES = 8  # to bring an input within the limits
UNSURE = 1e-3  # of the range of an input whose noise is not declared; rms
INSIDE = 0.98  # of the limit at which such an input is aimed
COASTING = 40  # samples after the run, for as long as it took: the machine does not stop at its end


@dataclass(frozen=True, eq=False)
class Conditions:
    """How the experiment is run: sample times `t` [k] in s, limits, and the states at the start.

    `platform` names the signals, with the noise of each.
    """

    platform: Platform
    t: FloatArray
    limits: Mapping[str, Limit]
    initial: Mapping[str, float]


@dataclass(frozen=True, eq=False)
class Scenario:
    """What nobody knows before the run: the `place` in every gap at the start, in half gaps, the
    noise of the inputs, and how far the parameters are from their values.
    """

    place: float
    seed: int

    def machine(self, contender: Contender) -> Contender:
        """The machine, if it is of the kind of `contender`."""
        rng = np.random.default_rng([SEED, self.seed])
        return contender.drawn(rng.normal(size=len(contender.free)))


SCENARIOS = tuple(Scenario(place, k) for k, place in enumerate((-0.5, 0.5, 0.0, -0.25)))


@dataclass(frozen=True, eq=False)
class Played:
    """A run that keeps to the limits: the state at its `start` [n], inputs [k, nu], outputs [k, ny]
    of the model, and the lowest and highest value of every signal that is limited, by name.
    """

    start: FloatArray
    inputs: FloatArray
    outputs: FloatArray
    reached: Mapping[str, tuple[float, float]]


def play(
    machine: Contender, conditions: Conditions, wave: FloatArray, place: float = 0.0
) -> Played | None:
    """Play `wave` [k, nu], of which -1 and 1 are the limits of the inputs, scaled back until
    everything stays within its limits, and does so for as long again with inputs at rest; None
    where no try does. The run begins at `place` in every gap.
    """
    begin, scale, count = _started(machine, conditions, place), 1.0, len(conditions.t)
    for _ in range(TRIES):
        inputs = inputs_of(machine.model, conditions, scale * wave)
        signals = _signals(machine, conditions, inputs, begin)
        if signals is None:
            scale *= 0.5
            continue
        worst, _ = excess(conditions.limits, signals)
        if worst <= 1.0:
            outputs = [signals[name][:count] for name in machine.model.output_names]
            limited = {name: signals[name] for name in conditions.limits}
            reached = {n: (float(v.min()), float(v.max())) for n, v in limited.items()}
            start = np.array(list(begin.values()))
            return Played(start, inputs, np.column_stack(outputs), reached)
        scale *= INSIDE / worst
    return None


def refuse_rest_outside(machine: Contender, conditions: Conditions) -> None:
    """Raise InputError where the machine begins outside its limits, leaves them with its inputs at
    rest (a body that nothing balances falls), or does not simulate: every input rests at its ends.
    """
    rest = np.zeros((len(conditions.t), len(machine.model.input_names)))
    inputs = inputs_of(machine.model, conditions, rest)
    signals = _signals(machine, conditions, inputs, _started(machine, conditions, 0.0))
    if signals is None:
        raise InputError(
            f"The model {machine.name} does not simulate from where the experiment begins; change"
            " `initial`."
        )
    worst, name = excess(conditions.limits, signals)
    if np.isinf(worst):
        limit, unit = conditions.limits[name], machine.model.units[name]
        raise InputError(
            f"The experiment begins with {name} = {signals[name][0]:.4g} {unit}, outside its limits"
            f" {limit.lower:.4g} to {limit.upper:.4g} {unit}; change `initial` or `limits`."
        )
    if worst > 1.0:
        raise InputError(_moves_at_rest(machine, conditions, signals, name))


def _moves_at_rest(
    machine: Contender, conditions: Conditions, signals: Mapping[str, FloatArray], name: str
) -> str:
    """That the signal of this `name` leaves its limits while inputs rest: when, and what to do."""
    limit, units, t = conditions.limits[name], machine.model.units, _with_coasting(conditions.t)
    values = signals[name]
    first = int(np.flatnonzero((values < limit.lower) | (values > limit.upper))[0])
    given = [conditions.limits[n] for n in machine.model.input_names]
    inputs = ", ".join(f"{i.name} = {rest_of(i):.4g} {units[i.name]}" for i in given)
    end = limit.upper if values[first] > limit.upper else limit.lower
    axis = name.rpartition("_")[2]
    holding = next((n for n in machine.model.input_names if n.endswith(f"_{axis}")), given[-1].name)
    return (
        f"With its inputs at rest ({inputs}), {machine.name} does not stay where the experiment"
        f" begins: {name} is past its limit of {end:.4g} {units[name]} after {t[first]:.3g} s, and"
        f" every input rests at its ends. Begin where {axis} stays by itself (--initial), widen"
        f" --limit {name}, or give an input limits whose end nearest to zero holds it, such as"
        f" --limit '{holding}=LOW..HIGH {units[holding]}'."
    )


def inputs_of(model: Model, conditions: Conditions, wave: FloatArray) -> FloatArray:
    """Inputs [k, nu] in their units of `wave` [k, nu]; zero is rest, -1 and 1 are the limits."""
    columns = []
    for name, part in zip(model.input_names, wave.T, strict=True):
        limit = conditions.limits[name]
        rest = rest_of(limit)
        value = rest + np.where(part > 0.0, limit.upper - rest, rest - limit.lower) * part
        decimals = DIGITS - int(np.ceil(np.log10(max(abs(limit.lower), abs(limit.upper)))))
        columns.append(np.clip(np.round(value, decimals), limit.lower, limit.upper) + 0.0)
    return np.column_stack(columns)


def _started(machine: Contender, conditions: Conditions, place: float) -> dict[str, float]:
    """The states at the start by name: those that are given, and every gear at `place` in its
    gap.
    """
    model, p = machine.model, machine.model.parameter_vector(dict(machine.values))
    x, rest = start_of(model, conditions.initial), np.zeros(len(model.input_names))
    for contact in range(len(model.module.CONTACT_ANGLES)):
        half = put_into_gap(model, contact, x, np.zeros((len(x), 0)), rest, p, NO_COLUMNS)
        x[model.module.CONTACT_ANGLES[contact][0]] += place * half
    return dict(zip(model.state_names, x.tolist(), strict=True))


def _with_coasting(t: FloatArray) -> FloatArray:
    """Sample times t [k] in s, and those after the run; the last input is held for a period."""
    return np.concatenate([t, t[-1] + np.linspace(t[1] - t[0], t[-1] - t[0], COASTING)])


def _signals(
    machine: Contender, conditions: Conditions, u: FloatArray, begin: Mapping[str, float]
) -> dict[str, FloatArray] | None:
    """Inputs, states and outputs by name, each [k + COASTING], from the states `begin`, the last of
    them after the run; None where it cannot be simulated.
    """
    model = machine.model
    t = _with_coasting(conditions.t)
    u = np.vstack([u, inputs_of(model, conditions, np.zeros((COASTING, u.shape[1])))])
    held = {n: table(t, c, "hold") for n, c in zip(model.input_names, u.T, strict=True)}
    try:
        found = simulate(
            model,
            t,
            held,
            machine.values,
            begin,
            rtol=RELATIVE,
            atol=ABSOLUTE,
            ledger=False,
        )
    except SimulationError:
        return None
    p, y = model.parameter_vector(dict(machine.values)), np.zeros((len(t), len(model.output_names)))
    for row, time, x, given in zip(y, t, found.x, u, strict=True):
        model.module.outputs(time, x, given, p, row)
    states = dict(zip(model.state_names, found.x.T, strict=True))
    measured = dict(zip(model.output_names, y.T, strict=True))
    return {**dict(zip(model.input_names, u.T, strict=True)), **states, **measured}


def logged(machine: Contender, conditions: Conditions, played: Played, seed: int = 0) -> Run:
    """The run as it would be logged: its inputs with their noise, its outputs without theirs, and
    its true start as the guess of it.

    Where bounces and breakaways amplify the noise of the inputs, no model can follow the machine.
    """
    platform, model = conditions.platform, machine.model
    rng = np.random.default_rng([SEED, seed])
    given = [s.signal for s in platform.signals if s.role == "input"]
    noises = {s.signal: s.noise for s in platform.signals}
    shown = [s.signal for s in platform.signals if s.role == "output"]
    inputs = np.zeros((len(conditions.t), len(given)))
    for k, name in enumerate(model.input_names):
        limit, noise = conditions.limits[name], noises[name]
        size = UNSURE * (limit.upper - limit.lower) if noise is None else noise
        column = played.inputs[:, k] + size * rng.normal(size=len(inputs))
        inputs[:, given.index(name)] = column
    outputs = played.outputs[:, [model.output_names.index(name) for name in shown]]
    log = Log("experiment", conditions.t, inputs, np.ascontiguousarray(outputs))
    (run,) = prepare_runs(model, platform, (log,))
    return replace(run, start=played.start)
