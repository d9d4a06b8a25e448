"""Look before anything is fitted: at what a platform declares, at what logs hold and can show."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ptp_symbolic.models import emission, variants
from ptp_symbolic.models.declared import refuse_unknown_signals
from ptp_symbolic.numeric.data import read_logs
from ptp_symbolic.numeric.diagnose.fitted_model import fitted
from ptp_symbolic.numeric.diagnose.preparation import Visible, visible_amounts
from ptp_symbolic.numeric.diagnose.summary import repeatability_table
from ptp_symbolic.numeric.identify.least_squares import all_values_at_start
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_preparation import LogFacts, facts_of
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import STANDARD_GRAVITY, ParameterDeclaration, Platform
from ptp_symbolic.report.log_check import render_log_check
from ptp_symbolic.report.log_figures import Shown
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.contributions import sensors_on
from ptp_symbolic.symbolic.derivation.placement import (
    GRAVITY,
    place_effects,
    refuse_undeclared,
    resolved_parameters,
    undeclared_parameters,
)
from ptp_symbolic.workflows.preparation import effect_keys, look_at, model_of, problem_for, workers
from ptp_symbolic.workflows.result import SCHEMA_VERSION, Output, Progress, json_text


def check_logs(
    platform: Platform, paths: Iterable[Path | str], progress: Progress = lambda text: None
) -> Output:
    """What logs of `platform` hold, and how small a parameter and an effect they can show,
    predicted by the model at its declared start values.

    Raises InputError for logs and platforms that do not fit each other.
    """
    logs = read_logs(paths, platform)
    noted = look_at(platform, logs, logs, progress)
    progress("deriving the equations of the platform and its candidates")
    model = model_of(variants.with_candidates(platform))
    with workers() as executor:
        problem = problem_for(
            platform, model, logs, logs, effect_keys(platform), executor, progress
        )
        progress("simulating the logs at the declared start values")
        start = fitted(problem, (), {**problem.fixed, **all_values_at_start(problem.free)}, None)
        failed = start.fit.failed is not None
        visible = [] if failed else visible_amounts(problem, start)
    units = {n: model.units[n] for n in (*model.input_names, *problem.whole[0].signals)}
    found = [facts_of(run, units) for run in problem.whole]
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "remarks": list(noted),
        "logs": [facts.as_dict() for facts in found],
        "units": units,
        "repeatability": repeatability_table(problem.whole, model.units),
        "simulates": not failed,
        "visible": [_row(v, model, start.values) for v in visible],
    }
    pairs = zip(problem.whole, found, strict=True)
    curves = {run.name: (run.time, _shown(run, facts, units)) for run, facts in pairs}
    page = render_log_check(summary, curves)
    return Output(summary, {"check.html": page, "check.json": json_text(summary)})


def _row(visible: Visible, model: Model, start: Mapping[str, float]) -> dict[str, Any]:
    unit = next(p.unit for p in model.parameters if p.name == visible.parameter)
    shown = {
        name: amount if amount is not None and math.isfinite(amount) else None
        for name, amount in (("smallest", visible.smallest), ("largest", visible.largest))
    }
    return {**asdict(visible), **shown, "unit": unit, "start": start[visible.parameter]}


def _shown(run: Run, facts: LogFacts, units: Mapping[str, str]) -> list[Shown]:
    """The inputs of a run, then what is measured, with the noise found in them."""
    columns = (*run.held_inputs.T, *run.measured.T)
    return [
        Shown(s.name, units[s.name], s.role, column, s.noise)
        for s, column in zip(facts.signals, columns, strict=True)
    ]


def check_platform(platform: Platform, progress: Progress = lambda text: None) -> dict[str, Any]:
    """What `platform` declares, as data: effects, states, inputs, what sensors may measure, and its
    parameters, each known, fitted, tied, at a natural default or missing.

    Raises InputError for a platform whose names, units or bounds do not fit its effects; what is
    missing is no error here (see `refuse_incomplete`).
    """
    progress("deriving the equations of the platform")
    equations, placed = assemble(platform), place_effects(platform)
    units = {str(q): equations.unit("rad") for q in equations.coordinates}
    units |= {str(w): equations.unit("rad/s") for w in equations.rates}
    units |= {state.name: state.unit for state in equations.extra_states}
    added = [effect.contribution_at(place) for effect, place in placed]
    sensors = sensors_on(platform.axes, added, platform.linear_axes)
    shown = {name: unit for name, unit, _ in equations.outputs}
    shown |= {sensor.name: sensor.unit for sensor in sensors}
    columns = {s.signal: s.column for s in platform.signals}
    said = {p.name: _said(p) for p in platform.parameters}
    if platform.gravity != STANDARD_GRAVITY:
        said[GRAVITY.name] = "known"
    missing = {p.name for p in undeclared_parameters(platform) if not p.has_natural_default}
    return {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title, "axes": platform.axes},
        "effects": effect_keys(platform),
        "states": [{"name": str(s), "unit": units[str(s)]} for s in equations.state_symbols],
        "inputs": [
            {"name": i.name, "unit": i.unit, "meaning": i.meaning, "column": columns.get(i.name)}
            for i in equations.inputs
        ],
        "outputs": [
            {"name": name, "unit": unit, "column": columns.get(name)}
            for name, unit in shown.items()
        ],
        "parameters": [
            {
                "name": p.name,
                "value": None if p.name in missing else p.default,
                "unit": p.unit,
                "declared": "missing" if p.name in missing else said.get(p.name, "default"),
                "bounds": [p.lower, p.upper],
                "meaning": p.meaning,
            }
            for p in resolved_parameters(platform, placed).values()
        ],
    }


def _said(declared: ParameterDeclaration) -> str:
    if declared.same_as is not None:
        return f"same as {declared.same_as}"
    return "fitted" if declared.free else "known"


def refuse_incomplete(platform: Platform) -> None:
    """Raise InputError where `platform` lacks a parameter, no machine has its values, or a signal
    is none of it: what would end any other use of it.
    """
    refuse_undeclared(platform)
    refuse_unknown_signals(platform, emission.emit(platform))
