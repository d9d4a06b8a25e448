"""Run a fit or a diagnosis on a declared platform and its logs, and write up what was found."""

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from ptp_symbolic import loop
from ptp_symbolic.codegen.effect_equations import effect_equations
from ptp_symbolic.codegen.module import module_text
from ptp_symbolic.data import Log, read_logs, read_split_logs
from ptp_symbolic.derivation.assembly import assemble
from ptp_symbolic.diagnose.candidates import find_candidates, vanished
from ptp_symbolic.diagnose.curves import curves_of
from ptp_symbolic.diagnose.residual_tests import residual_tests
from ptp_symbolic.diagnose.rounds import Diagnosis, diagnose
from ptp_symbolic.diagnose.search import HELD_OUT, fit_declared
from ptp_symbolic.diagnose.summary import (
    cause,
    error_table,
    fit_table,
    headline,
    ranking,
)
from ptp_symbolic.diagnose.trial import Task, Trial
from ptp_symbolic.diagnose.verdict import EXPLAINED, PARTLY, UP_TO_GROUP
from ptp_symbolic.identify.fit import all_values_at_start, fit_parameters
from ptp_symbolic.identify.intervals import Estimate, estimates
from ptp_symbolic.identify.run import prepare_runs
from ptp_symbolic.identify.windows import cut, window_length
from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    naming_file,
    platform_text,
)
from ptp_symbolic.report.diagnosis import render_diagnosis, write_curves_csv
from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.runtime.model import Model

Progress = Callable[[str], None]
SCHEMA_VERSION = 1
FAR_FROM_FLOOR = 3.0  # input noise may double the floor where runs are cut into windows


@dataclass(frozen=True)
class Output:
    """A result as data (`summary`) and every file to be written, by name."""

    summary: dict[str, Any]
    files: Mapping[str, str | bytes]


@contextmanager
def _workers() -> Iterator[Executor]:
    """One thread per core for runs side by side; threads of the linear algebra would be in their
    way.
    """
    with threadpool_limits(limits=1), ThreadPoolExecutor(os.cpu_count()) as executor:
        yield executor


def effect_keys(platform: Platform) -> list[str]:
    """Keys of the declared effects, ``effect`` or ``effect@axis``."""
    return [e.effect if e.axis is None else f"{e.effect}@{e.axis}" for e in platform.effects]


def fit_platform(
    platform: Platform, paths: Iterable[Path | str], progress: Progress = lambda text: None
) -> Output:
    """Fit the free parameters of `platform` to all logs in `paths`.

    The error before is that at the declared start values (None where they do not simulate), as
    after with the state at the start of every run fitted. Raises InputError for logs and platforms
    that do not fit each other.
    """
    logs = read_logs(paths, platform)
    model = loop.emit(platform)
    with _workers() as executor:
        task = _task(platform, model, logs, logs, {}, executor, progress)
        begun = _as_declared(task)
        trial = fit_declared(task) if task.free else begun
    error = error_table(begun, trial, None)["train"]
    left, floor = (error[when]["total"]["rmse_counts"] for when in ("after", "noise_floor"))
    cut_up = len(task.train) > len(logs)
    fitted = loop.extended(platform, (), trial.train.values, ())
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "parameters": fit_table(trial),
        "error": error | ({"before": None} if begun.train.failed else {}),
        "far_from_floor": trial.train.failed is not None or left > FAR_FROM_FLOOR * floor,
        "windows": {"count": len(task.train), "seconds": _mean_length(task)} if cut_up else None,
    }
    files = {"fit.json": _json(summary), "platform.toml": platform_text(fitted)}
    return Output(summary, files)


def _as_declared(task: Task) -> Trial:
    """The declared start values, with nothing but the starts of the runs fitted."""
    values = {**task.fixed, **all_values_at_start(task.free)}
    return Trial(
        (), fit_parameters(task.model, task.train, (), values, None, HELD_OUT, task.executor)
    )


def _mean_length(task: Task) -> float:
    return sum(float(run.time[-1] - run.time[0]) for run in task.train) / len(task.train)


def diagnose_platform(
    platform: Platform,
    train: Iterable[Path | str],
    validate: Iterable[Path | str],
    progress: Progress = lambda text: None,
) -> Output:
    """Fit `platform` to the `train` logs, find what it lacks, judge on the `validate` logs.

    Raises InputError for logs and platforms that do not fit each other, and for a run in both.
    """
    train_logs, validate_logs = read_split_logs(train, validate, platform)
    progress("deriving the equations of the platform and its candidates")
    model = loop.emit(loop.with_candidates(platform))
    declared = effect_keys(platform)
    known = loop.known_values(platform, model)
    off = vanished(model, declared)
    with _workers() as executor:
        task = _task(platform, model, train_logs, validate_logs, off, executor, progress)
        found = diagnose(task, find_candidates(model, declared, known))
    return _write_up(platform, found)


def _task(
    platform: Platform,
    model: Model,
    train: Iterable[Log],
    validate: Iterable[Log],
    off: Mapping[str, float],
    executor: Executor,
    progress: Progress,
) -> Task:
    progress("preparing the simulation (compiles for about a minute once on a new machine)")
    loop.refuse_unknown_signals(platform, model)
    free = loop.free_parameters(platform, model)
    fixed = {**model.defaults, **off, **loop.known_values(platform, model)}
    with naming_file(platform):
        runs = [prepare_runs(model, platform, tuple(logs)) for logs in (train, validate)]
    start = {**fixed, **{name: f.start for f in free for name in (f.name, *f.tied)}}
    noises = {s.signal: s.noise for s in platform.signals}
    noise = tuple(noises[name] for name in model.input_names)
    length = window_length(model, runs[0], model.parameter_vector(start), noise)
    cut_train, cut_validate = (cut(model, part, length) for part in runs)
    return Task(model, cut_train, cut_validate, free, fixed, executor, progress, noise)


def _write_up(platform: Platform, found: Diagnosis) -> Output:
    accepted = found.verdict.accepted
    named = found.verdict.word in (EXPLAINED, UP_TO_GROUP, PARTLY)
    after = accepted if named and accepted is not None else found.base
    extended = _extended(platform, after)
    files: dict[str, str | bytes] = {}
    equations = []
    for candidate in after.candidates:
        if not candidate.is_declared_value:
            equations += effect_equations(extended, candidate.id, candidate.axis)
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "verdict": found.verdict.word,
        "summary": headline(found),
        "added": _added(found, after),
        "ranking": ranking(found),
        "error": error_table(found.base, after, found.verdict.floor),
        "residual_tests": residual_tests(after, after.train.model.input_names),
        "fit": {
            "before": {"parameters": fit_table(found.base)},
            "after": {"parameters": fit_table(after)},
        },
        "not_visible": [
            {"effect": c.id, "axis": c.axis, "why": "absorbed by the declared parameters"}
            for c in found.invisible
        ],
        "equations": equations,
    }
    curves = curves_of(found.base, after)
    files["diagnosis.json"] = _json(summary)
    files["platform.toml"] = platform_text(extended)
    files["equations.tex"] = _equations_tex(equations)
    files[f"{extended.name}.py"] = module_text(assemble(extended))
    files["report.html"] = render_diagnosis(summary, curves)
    files.update({f"curves/{name}": text for name, text in write_curves_csv(curves).items()})
    return Output(summary, files)


def _json(value: object) -> str:
    return json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _equations_tex(equations: list[dict[str, Any]]) -> str:
    """The added equations as a fragment to be included in a document that loads amsmath."""
    if not equations:
        return "% No effect was added to the equations.\n"
    rows = [f"\\[\n{e['latex']}\n\\]\n" for e in equations]
    titles = [escaped(f"{e['title'][:1].upper()}{e['title'][1:]}") for e in equations]
    text = "\n".join(f"{title}:\n{row}" for title, row in zip(titles, rows, strict=True))
    return f"% \\usepackage{{amsmath}}\n{text}"


def _added(found: Diagnosis, after: Trial) -> list[dict[str, Any]]:
    values = {e.name: e for e in estimates(after.train)}
    units = after.train.model.units
    rivals = sorted({key for r in found.verdict.rivals for key in r.keys} - set(after.keys))
    return [
        {
            "effect": c.id,
            "title": cause(c, after),
            "axis": c.axis,
            "parameters": {name: _value(values[name], units[name]) for name in c.parameters},
            "confusable_with": rivals if found.verdict.word == UP_TO_GROUP else [],
            "separating_experiment": c.separating_experiment,
        }
        for c in after.candidates
    ]


def _value(estimate: Estimate, unit: str) -> dict[str, Any]:
    return {
        "value": estimate.value, "ci95": [estimate.lower, estimate.upper], "unit": unit,
    }  # fmt: skip


def _extended(platform: Platform, after: Trial) -> Platform:
    """`platform` with the accepted effects, and every fitted value as the new start."""
    model = after.train.model
    bounds = {p.name: p for p in model.parameters}
    added = [
        EffectDeclaration(c.id, c.axis, None) for c in after.candidates if not c.is_declared_value
    ]
    fitted = [
        ParameterDeclaration(
            name, bounds[name].unit, after.train.values[name], True, bounds[name].lower,
            bounds[name].upper,
        )
        for c in after.candidates
        for name in c.parameters
    ]  # fmt: skip
    return loop.extended(platform, added, after.train.values, fitted)
