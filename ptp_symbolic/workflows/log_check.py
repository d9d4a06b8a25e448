"""Look at logs before anything is fitted: what they hold, and what they can show."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ptp_symbolic.models import variants
from ptp_symbolic.numeric.data import read_logs
from ptp_symbolic.numeric.diagnose.preparation import Visible, visible_amounts
from ptp_symbolic.numeric.diagnose.summary import repeatability_table
from ptp_symbolic.numeric.diagnose.trial import fitted
from ptp_symbolic.numeric.identify.least_squares import all_values_at_start
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_preparation import LogFacts, facts_of
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.platform import Platform
from ptp_symbolic.report.log_check import render_log_check
from ptp_symbolic.report.log_figures import Shown
from ptp_symbolic.workflows.preparation import effect_keys, look_at, model_of, task_for, workers
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
        task = task_for(platform, model, logs, logs, effect_keys(platform), executor, progress)
        progress("simulating the logs at the declared start values")
        start = fitted(task, (), {**task.fixed, **all_values_at_start(task.free)}, None)
        failed = start.fit.failed is not None
        visible = [] if failed else visible_amounts(task, start)
    units = {n: model.units[n] for n in (*model.input_names, *task.whole[0].signals)}
    found = [facts_of(run, units) for run in task.whole]
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "remarks": list(noted),
        "logs": [facts.as_dict() for facts in found],
        "units": units,
        "repeatability": repeatability_table(task.whole, model.units),
        "simulates": not failed,
        "visible": [_row(v, model, start.values) for v in visible],
    }
    pairs = zip(task.whole, found, strict=True)
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
