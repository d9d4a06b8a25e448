"""Design the next experiment: the input that tells rival models apart, or shows parameters best."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.diagnose.preparation import SEEN
from ptp_symbolic.numeric.experiment.machine import (
    Conditions,
    Played,
    play,
    read_limits,
    refuse_rest_outside,
)
from ptp_symbolic.numeric.experiment.prediction import (
    Found,
    Worth,
    least_separation,
    precision,
    predicted_curves,
    predicted_pairs,
    predicted_spreads,
    search,
)
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import Platform
from ptp_symbolic.report.experiment_figure import experiment_figure
from ptp_symbolic.workflows.experiment_rivals import Rivals, rivals_of
from ptp_symbolic.workflows.preparation import material_of, workers
from ptp_symbolic.workflows.result import SCHEMA_VERSION, Output, Progress, json_text

FloatArray = NDArray[np.float64]

FEWEST_SAMPLES, MOST_SAMPLES = 100, 200_000
FEWEST_TRIES = 60


@dataclass(frozen=True)
class Request:
    """What is asked for: rival sets of effects `between`, each ``effect@axis`` or several joined by
    ``+``, the likeliest first; or `parameters`. `known` are values of parameters in SI that are
    known better than the platform says, such as those of a diagnosis.

    `limits` are texts such as ``u_pan=12 V``, `initial` states in SI; `duration` and `period` are
    in s (None: the period of the logs).
    """

    between: tuple[str, ...]
    parameters: tuple[str, ...]
    limits: tuple[str, ...]
    duration: float
    period: float | None
    initial: Mapping[str, float]
    known: Mapping[str, float]
    tries: int
    seed: int


def design_experiment(
    platform: Platform,
    request: Request,
    logs: Sequence[Path | str] = (),
    progress: Progress = lambda text: None,
) -> Output:
    """The input that is worth most within the limits of `request`, beside what `logs` show.

    Raises InputError for names, limits, states and times that do not fit the platform.
    """
    _refuse_odd(request)
    with workers() as executor:
        rivals = rivals_of(
            platform,
            request.between,
            request.parameters,
            request.known,
            logs,
            executor,
            progress,
        )
        conditions = _conditions(request, rivals)
        for contender in rivals.contenders:
            refuse_rest_outside(contender, conditions)
        found = _found(request, rivals, conditions, executor, progress)
        played = play(rivals.contenders[0], conditions, found.wave)
        assert played is not None  # the worth of what cannot be played is not finite
        return _write_up(request, rivals, conditions, found, played)


def _refuse_odd(request: Request) -> None:
    if bool(request.between) == bool(request.parameters):
        raise InputError(
            "Say what the experiment is for: either `between` two effects or more (or `diagnosis`),"
            " or `parameters`."
        )
    if len(set(request.between)) == 1:
        raise InputError(f"`between` {request.between[0]}: give two effects or more to separate.")
    if request.tries < FEWEST_TRIES:
        raise InputError(f"`tries` {request.tries}: give at least {FEWEST_TRIES}.")


def _conditions(request: Request, rivals: Rivals) -> Conditions:
    period = rivals.period if request.period is None else request.period
    for option, value in (("duration", request.duration), ("period", period)):
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(f"`{option}` {value:g} s: give a time above zero.")
    count = round(request.duration / period) + 1
    if not FEWEST_SAMPLES <= count <= MOST_SAMPLES:
        raise InputError(
            f"`duration` {request.duration:g} s has {count} samples of {period:g} s; give"
            f" {FEWEST_SAMPLES} to {MOST_SAMPLES} by `duration` or `period`."
        )
    t = np.linspace(0.0, (count - 1) * period, count)
    limits = read_limits(request.limits, rivals.contenders[0].model)
    return Conditions(rivals.platform, t, limits, request.initial)


def _found(
    request: Request,
    rivals: Rivals,
    conditions: Conditions,
    executor: Executor,
    progress: Progress,
) -> Found:
    """The best input: of those that are worth most in the search, the one that keeps the rivals
    furthest apart whichever is the machine.
    """
    contenders = rivals.contenders
    worth: Worth = partial(precision, contenders[0], request.parameters, conditions)
    if request.between:
        worth = partial(least_separation, contenders, conditions)

    def report(count: int, best: Found) -> None:
        value = f", the best separates by {best.worth:.3g} sigmas" if request.between else ""
        progress(f"{count} of {request.tries} inputs tried{value}: {best.family}")

    inputs = len(contenders[0].model.input_names)
    best = search(worth, conditions.t, inputs, request.tries, request.seed, executor, report)
    if not np.isfinite(best[0].worth):
        raise InputError(
            f"None of {request.tries} inputs keeps to the limits and shows anything; widen them,"
            " change `initial`, or give a longer `duration`."
        )
    if not request.between:
        return best[0]
    progress("predicting what the best inputs show, whichever model is the machine")
    again = partial(least_separation, contenders, conditions, thorough=True)
    values = list(executor.map(again, [found.wave for found in best]))
    k = int(np.argmax(values))
    return Found(best[k].family, best[k].wave, values[k])


def _write_up(
    request: Request, rivals: Rivals, conditions: Conditions, found: Found, played: Played
) -> Output:
    contenders = rivals.contenders
    model = contenders[0].model
    pairs = predicted_pairs(contenders, conditions, found.wave)
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": rivals.platform.name, "title": rivals.platform.title},
        "between": list(request.between),
        "for_parameters": list(request.parameters),
        "separable": min(p.run for p in pairs) >= SEEN if pairs else None,
        "separation": [pair.as_dict() for pair in pairs],
        "share_needed": material_of(rivals.platform),
        "parameters": {c.name: predicted_spreads(c, conditions, found.wave) for c in contenders},
        "input": {
            "kind": found.family,
            "duration": float(conditions.t[-1]),
            "period": float(conditions.t[1]),
            "initial": dict(request.initial),
            "signals": {
                name: {
                    "lowest": low,
                    "highest": high,
                    "limits": [conditions.limits[name].lower, conditions.limits[name].upper],
                    "unit": model.units[name],
                }
                for name, (low, high) in played.reached.items()
            },
        },
        "samples_before": rivals.samples,
        "tries": request.tries,
        "seed": request.seed,
        "remarks": list(rivals.remarks),
    }
    curves = predicted_curves(contenders, request.parameters, conditions, found.wave)
    files: dict[str, str | bytes] = {
        "input.csv": _input_text(rivals.platform, model, conditions.t, played.inputs),
        "experiment.png": experiment_figure(curves),
        "experiment.json": json_text(summary),
    }
    return Output(summary, files)


def _input_text(platform: Platform, model: Model, t: FloatArray, inputs: FloatArray) -> str:
    """The CSV of inputs [k, nu] at t [k] in s, under the columns that `platform` declares."""
    columns = {s.signal: s.column for s in platform.signals}
    heads = [f"{columns.get(n, n)} [{model.units[n]}]" for n in model.input_names]
    decimals = max(0, 1 - int(np.floor(np.log10(t[1]))) + 3)
    rows = [
        ",".join([f"{time:.{decimals}f}", *(repr(float(v)) for v in row)])
        for time, row in zip(t, inputs, strict=True)
    ]
    return "\n".join([",".join(["time [s]", *heads]), *rows]) + "\n"
