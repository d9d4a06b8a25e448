"""Run a fit or a diagnosis on a declared platform and its logs, and write up what was found."""

import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from ptp_symbolic.models import emission, variants
from ptp_symbolic.models.declared import free_parameters, known_values, refuse_unknown_signals
from ptp_symbolic.numeric.data import (
    Log,
    read_logs,
    read_split_logs,
    refuse_motionless,
    refuse_wrapped_angles,
    remarks,
)
from ptp_symbolic.numeric.diagnose.curves import curves_of
from ptp_symbolic.numeric.diagnose.errors import error_of
from ptp_symbolic.numeric.diagnose.findings import Search
from ptp_symbolic.numeric.diagnose.floor import carried_noise, floor_of
from ptp_symbolic.numeric.diagnose.preparation import task_of
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import fit_declared, refitted_in_windows
from ptp_symbolic.numeric.diagnose.remainder import hints, remainder
from ptp_symbolic.numeric.diagnose.residual_tests import residual_tests
from ptp_symbolic.numeric.diagnose.search import search
from ptp_symbolic.numeric.diagnose.summary import (
    added_effects,
    error_table,
    fit_table,
    gain_table,
    headline,
    ranking,
    repeatability_table,
)
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, tolerance_for
from ptp_symbolic.numeric.diagnose.verdict import Verdict, decide
from ptp_symbolic.numeric.identify.fit import (
    Effort,
    all_values_at_start,
    fit_parameters,
    with_finite_differences,
)
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.numeric.identify.run import prepare_runs
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    naming_file,
    platform_text,
)
from ptp_symbolic.report.diagnosis import render_diagnosis, write_curves_csv
from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.symbolic.codegen.effect_equations import effect_equations

Progress = Callable[[str], None]
SCHEMA_VERSION = 1
FAR_FROM_FLOOR = 3.0  # times the floor: from here on a fit is called far from it
START_ITERATIONS = 10  # for the starts of the runs at the declared values
START_SHARE = 1e-2  # error of those simulations, as a share of the noise


@dataclass(frozen=True)
class Output:
    """A result as data (`summary`) and every file to be written, by name."""

    summary: dict[str, Any]
    files: Mapping[str, str | bytes]


@contextmanager
def workers() -> Iterator[Executor]:
    """One thread per core that the process may use, for runs side by side; threads of the linear
    algebra would be in their way.
    """
    affinity = getattr(os, "sched_getaffinity", None)  # Linux alone has one
    cores = len(affinity(0)) if affinity else os.cpu_count()
    with threadpool_limits(limits=1), ThreadPoolExecutor(cores) as executor:
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
    noted = look_at(platform, logs, logs, progress)
    model = emission.emit(platform)
    with workers() as executor:
        task = task_for(platform, model, logs, logs, (), executor, progress)
        begun = _as_declared(task)
        trial = begun
        if task.free:
            progress("fitting")
            task, trial = refitted_in_windows(task, fit_declared(task, propose(task)))
            trial = replace(trial, fit=with_finite_differences(trial.fit, executor))
        floor = floor_of(task, trial, carried_noise(task, trial.fit))
    units = model.units
    error = {
        "before": None if begun.fit.failed else error_of(begun.fit, units),
        "after": error_of(trial.fit, units),
        "noise_floor": error_of(trial.fit, units, floor.level),
    }
    left, least = (error[when]["total"]["rmse"] for when in ("after", "noise_floor"))  # type: ignore[index]
    fitted = variants.extended(platform, (), trial.values, ())
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "parameters": fit_table(trial, estimates(trial.fit)),
        "error": error,
        "far_from_floor": trial.fit.failed is not None or left > FAR_FROM_FLOOR * least,
        "windows": _windows(task),
        "remarks": list(noted),
    }
    files = {"platform.toml": platform_text(fitted), "fit.json": _json(summary)}
    return Output(summary, files)


def _as_declared(task: Task) -> Trial:
    """The declared start values, with nothing but the starts of the runs fitted."""
    values = {**task.fixed, **all_values_at_start(task.free)}
    effort = Effort(START_ITERATIONS, 1e-3, tolerance_for(task, START_SHARE))
    return Trial(
        (), fit_parameters(task.model, task.train, (), values, None, effort, task.executor)
    )


def _windows(task: Task) -> dict[str, Any] | None:
    """How many windows the runs were cut into, and how long they are; None for whole runs."""
    if len(task.train) == len(task.whole):
        return None
    length = sum(float(run.time[-1] - run.time[0]) for run in task.train) / len(task.train)
    return {"count": len(task.train), "seconds": length}


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
    noted = look_at(platform, train_logs, (*train_logs, *validate_logs), progress)
    progress("deriving the equations of the platform and its candidates")
    model = emission.emit(variants.with_candidates(platform))
    with workers() as executor:
        task = task_for(
            platform, model, train_logs, validate_logs, effect_keys(platform), executor, progress
        )
        found = search(task)
        verdict = decide(found)
        return _write_up(platform, task, found, verdict, noted)


def look_at(
    platform: Platform, train: Sequence[Log], every: Sequence[Log], progress: Progress
) -> tuple[str, ...]:
    """Refuse logs that cannot be used, and say what is odd about the others before any fit."""
    refuse_wrapped_angles(every, platform)
    refuse_motionless(train, platform)
    noted = remarks(train, platform)
    for text in noted:
        progress(text)
    return noted


def task_for(
    platform: Platform,
    model: Model,
    train: Iterable[Log],
    validate: Iterable[Log],
    declared: Sequence[str],
    executor: Executor,
    progress: Progress,
) -> Task:
    """All that stays the same; `declared` are the keys of the effects that are not candidates."""
    progress("preparing the simulation (compiles for about a minute once on a new machine)")
    refuse_unknown_signals(platform, model)
    with naming_file(platform):
        runs = [prepare_runs(model, platform, tuple(logs)) for logs in (train, validate)]
    free, known = free_parameters(platform, model), known_values(platform, model)
    noises = {s.signal: s.noise for s in platform.signals}
    return task_of(
        model,
        runs[0],
        runs[1],
        free,
        known,
        declared,
        noises,
        platform.window,
        executor,
        progress,
    )


def _write_up(
    platform: Platform, task: Task, found: Search, verdict: Verdict, noted: Sequence[str]
) -> Output:
    after = replace(verdict.final, fit=with_finite_differences(verdict.final.fit, task.executor))
    intervals = {e.name: e for e in estimates(after.fit)}
    parts = {
        "train": (found.declared.fit, after.fit),
        "validate": (verdict.before, verdict.after),
    }
    errors = error_table(parts, verdict.floor)
    extended = _extended(platform, after)
    named = [c for c in after.candidates if not c.is_declared_value]
    equations = [e for c in named for e in effect_equations(extended, c.id, c.axis)]
    left = remainder(found.proposals.space, after.values) if verdict.leaves_more else None
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "verdict": verdict.word,
        "summary": headline(verdict, errors),
        "added": added_effects(verdict, after, intervals),
        "ranking": ranking(found, verdict, task.candidates),
        "error": errors,
        "repeatability": repeatability_table(task.whole, task.model.units),
        "residual_tests": residual_tests(verdict.after, task.model.input_names),
        "fit": {
            "before": {"parameters": fit_table(found.declared, estimates(found.declared.fit))},
            "after": {"parameters": fit_table(after, tuple(intervals.values()))},
        },
        "held_out": None if verdict.held_out is None else gain_table(verdict.held_out),
        "refused": dict(verdict.refused),
        "remainder": left,
        "hints": hints(left),
        "windows": _windows(task),
        "remarks": list(noted),
        "equations": equations,
    }
    curves = curves_of(parts)
    files: dict[str, str | bytes] = {"platform.toml": platform_text(extended)}
    files["equations.tex"] = _equations_tex(equations)
    files[f"{extended.name}.py"] = emission.module_of(extended)
    files["report.html"] = render_diagnosis(summary, curves)
    files.update({f"curves/{name}": text for name, text in write_curves_csv(curves).items()})
    files["diagnosis.json"] = _json(summary)
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


def _extended(platform: Platform, after: Trial) -> Platform:
    """`platform` with the accepted effects, and every fitted value as the new start."""
    bounds = {p.name: p for p in after.fit.model.parameters}
    added = [
        EffectDeclaration(c.id, c.axis, None) for c in after.candidates if not c.is_declared_value
    ]
    fitted = [
        ParameterDeclaration(
            name,
            bounds[name].unit,
            after.values[name],
            True,
            bounds[name].lower,
            bounds[name].upper,
        )
        for c in after.candidates
        for name in c.parameters
    ]
    return variants.extended(platform, added, after.values, fitted)
