"""The models that an experiment is for, as the platform and the logs so far know them."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.models import variants
from ptp_symbolic.models.declared import free_parameters, known_values, refuse_unknown_signals
from ptp_symbolic.numeric.data import read_logs
from ptp_symbolic.numeric.diagnose.candidates import Candidate, find_candidates, vanished
from ptp_symbolic.numeric.diagnose.fitted_model import SearchProblem, fitted, halving, restarted
from ptp_symbolic.numeric.diagnose.noise_floor import propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import ProposedSets, placed_by_rows, propose
from ptp_symbolic.numeric.diagnose.refits import fit_declared, from_rows, polished
from ptp_symbolic.numeric.experiment.machine import Contender, from_fit, without_logs
from ptp_symbolic.numeric.identify.constants import ROUNDING
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.least_squares import all_values_at_start
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import Platform
from ptp_symbolic.workflows.preparation import effect_keys, look_at, model_of, problem_for
from ptp_symbolic.workflows.result import Progress

USUAL_PERIOD = 5e-3  # s; between samples where no log says another
WELL_FITTED = 1.5  # times the noise, rms; a model that leaves more is not the machine


@dataclass(frozen=True, eq=False)
class Rivals:
    """The `contenders`, the likeliest first (one alone where parameters are asked for), the
    `platform` with the noise of its signals as the logs show it, `samples` measured so far, and the
    `period` in s between them.
    """

    contenders: tuple[Contender, ...]
    platform: Platform
    samples: int
    period: float
    remarks: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Known:
    """What is declared, and the logs so far as a problem, with what their motion proposes (None: no
    logs).
    """

    model: Model
    free: tuple[FreeParameter, ...]
    values: Mapping[str, float]
    candidates: tuple[Candidate, ...]
    problem: SearchProblem | None
    proposals: ProposedSets | None


def rivals_of(
    platform: Platform,
    between: Sequence[str],
    parameters: Sequence[str],
    known: Mapping[str, float],
    logs: Sequence[Path | str],
    executor: Executor,
    progress: Progress,
) -> Rivals:
    """The sets of effects `between`, keys joined by ``+``, or the declared model alone, fitted to
    `logs` if there are any: from the values in `known`, and from where the measured motion leads.

    Raises InputError for unknown names and logs that do not fit.
    """
    own = set(effect_keys(platform))
    for key in (key for keys in between for key in keys.split("+")):
        if key in own:
            raise InputError(
                f"`between` {key}: {platform.source or platform.name} declares it already; give the"
                " platform without the effects to separate."
            )
    progress("deriving the equations")
    model = model_of(variants.with_candidates(platform) if between else platform)
    declared = effect_keys(platform) if between else ()
    noted: tuple[str, ...] = ()
    problem = None
    if logs:
        read = read_logs(logs, platform)
        noted = look_at(platform, read, read, progress)
        problem = problem_for(platform, model, read, read, declared, executor, progress)
    here = _declared(platform, model, declared, problem)
    problem = here.problem
    for name in parameters:
        if name not in {f.name for f in here.free}:
            raise unknown("free parameter", name, [f.name for f in here.free])
    sets = [_effects(here, keys) for keys in between] or [()]
    contenders = []
    for label, effects in zip(between or (platform.name,), sets, strict=True):
        progress(f"fitting {label} to the logs" if logs else f"taking {label} as it is declared")
        contenders.append(_contender(here, label, effects, known, executor))
    noted += tuple(_remark(c, problem) for c in contenders if problem and _is_off(c, problem))
    if problem is None:
        noted += tuple(_assumed(c, e, known) for c, e in zip(contenders, sets, strict=True) if e)
    runs = () if problem is None else problem.whole
    return Rivals(
        tuple(contenders),
        _with_noise(platform, runs),
        sum(run.size for run in runs),
        float(np.median(np.diff(runs[0].time))) if runs else USUAL_PERIOD,
        noted,
    )


def _declared(
    platform: Platform, model: Model, declared: Sequence[str], problem: SearchProblem | None
) -> _Known:
    if problem is not None:
        proposals = propose(problem)
        problem = replace(problem, candidates=placed_by_rows(problem.candidates, proposals))
        problem, trial = fit_declared(problem, proposals)
        return _Known(model, problem.free, trial.values, problem.candidates, problem, proposals)
    refuse_unknown_signals(platform, model)
    free, known = free_parameters(platform, model), known_values(platform, model)
    off = vanished(model, declared) if declared else {}
    fixed = {**model.defaults, **off, **{name: value for name, (value, _) in known.items()}}
    candidates = find_candidates(model, declared, known) if declared else ()
    return _Known(model, free, {**fixed, **all_values_at_start(free)}, candidates, None, None)


def _effects(here: _Known, keys: str) -> tuple[Candidate, ...]:
    """The candidates of a set, each in its fullest form, and those that they bring along."""
    fullest: dict[str, Candidate] = {}
    for candidate in sorted(here.candidates, key=lambda c: len(c.free)):
        fullest[candidate.key] = candidate
    wanted: dict[str, Candidate] = {}
    for key in keys.split("+"):
        if key not in fullest:
            raise unknown("effect to add", key, fullest)
        for name in (*fullest[key].brings, key):
            wanted[name] = fullest[name]
    return tuple(wanted.values())


def _contender(
    here: _Known,
    label: str,
    effects: Sequence[Candidate],
    known: Mapping[str, float],
    executor: Executor,
) -> Contender:
    values = dict(here.values)
    for candidate in effects:
        given = any(name in known for name in candidate.parameters)
        for f in candidate.free:
            start = candidate.vanishing.get(f.name, f.start) if given else f.start
            values.update(dict.fromkeys(f.names, start))
    free = (*here.free, *(f for c in effects for f in c.free))
    for f in free:
        if f.name in known:
            values.update(dict.fromkeys(f.names, known[f.name]))
    if here.problem is None or here.proposals is None:
        return without_logs(label, here.model, [restarted(f, values[f.name]) for f in free], values)
    begun = fitted(here.problem, effects, values, None, executor=executor)
    rows = from_rows(here.problem, here.proposals, effects, values) if effects else []
    (trial,) = halving(here.problem, [begun, *rows], 1) or [begun]
    if trial.fit.failed is None:
        trial = polished(here.problem, trial, propagated_input_noise(here.problem, trial.fit))
    if trial.fit.failed is not None:
        raise InputError(
            f"The model {label} does not simulate the logs ({trial.fit.failed}); change its start"
            " values, or leave the logs out."
        )
    return from_fit(label, trial.fit)


def _assumed(contender: Contender, effects: Sequence[Candidate], known: Mapping[str, float]) -> str:
    """The amounts at which effects are taken without logs."""
    units, from_where = contender.model.units, "those of a search"
    if any(name in known for c in effects for name in c.parameters):
        from_where = "those of the diagnosis"
    amounts = ", ".join(
        f"{f.name} = {contender.values[f.name]:.4g} {units[f.name]}"
        for c in effects
        for f in c.defining
    )
    return f"{contender.name} is taken with {amounts}, {from_where}; logs would add information."


def _is_off(contender: Contender, problem: SearchProblem) -> bool:
    return contender.left > WELL_FITTED**2 * sum(run.size for run in problem.whole)


def _remark(contender: Contender, problem: SearchProblem) -> str:
    times = np.sqrt(contender.left / sum(run.size for run in problem.whole))
    return (
        f"{contender.name} leaves {times:.3g} times the noise on the logs so far; what is predicted"
        " for it holds for a model that fits: run fit or diagnose first."
    )


def _with_noise(platform: Platform, runs: Sequence[Run]) -> Platform:
    """`platform` with the noise of its outputs as `runs` show it."""
    if not runs:
        return platform
    sigma = dict(zip(runs[0].signals, 1.0 / runs[0].weight, strict=True))
    signals = []
    for s in platform.signals:
        if s.signal in sigma:
            counts = s.counts_per_revolution
            rounding = 2.0 * np.pi / counts * ROUNDING if counts else 0.0
            noise = float(np.sqrt(max(sigma[s.signal] ** 2 - rounding**2, 0.0)))
            s = replace(s, noise=noise or s.noise)
        signals.append(s)
    return replace(platform, signals=tuple(signals))
