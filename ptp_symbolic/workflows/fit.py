"""Fit a declared platform to its logs."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from ptp_symbolic.models import variants
from ptp_symbolic.numeric.data import log_files, read_logs
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, SearchProblem, tolerance_for
from ptp_symbolic.numeric.diagnose.noise_floor import noise_floor_of, propagated_input_noise
from ptp_symbolic.numeric.diagnose.preparation import inverted_inputs
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import fit_declared
from ptp_symbolic.numeric.diagnose.summary import curves_of, error_of, fit_table
from ptp_symbolic.numeric.identify.fit import fit_parameters
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.numeric.identify.least_squares import Effort, all_values_at_start
from ptp_symbolic.numeric.identify.windows import estimable
from ptp_symbolic.platform import Platform, platform_text
from ptp_symbolic.workflows.preparation import look_at, model_of, problem_for, workers
from ptp_symbolic.workflows.provenance import provenance
from ptp_symbolic.workflows.result import (
    SCHEMA_VERSION,
    Output,
    Progress,
    json_text,
)

FAR_FROM_FLOOR = 3.0  # times the floor: from here on a fit is called far from it
MANY_COUNTS = 1000.0  # that a missing effect seldom costs,
SOME_OF_MOTION = 0.05  # where they are this share of the motion: not of a fine encoder
START_ITERATIONS = 10  # for the starts of the runs at the declared values
START_SHARE = 1e-2  # error of those simulations, as a share of the noise


def fit_platform(
    platform: Platform,
    paths: Iterable[Path | str],
    progress: Progress = lambda text: None,
    command: str | None = None,
) -> Output:
    """Fit the free parameters of `platform` to all logs in `paths`.

    The error before is that at the declared start values (None where they do not simulate), as
    after with the state at the start of every run fitted. `command` is the command line that asks
    for it. Raises InputError for logs and platforms that do not fit each other.
    """
    places = log_files(paths)
    logs = read_logs(places, platform)
    sources = provenance(platform, {"fit": (places, logs)}, command)
    noted = look_at(platform, logs, logs, progress)
    model = model_of(platform)
    with workers() as executor:
        problem = problem_for(platform, model, logs, logs, (), executor, progress)
        progress("fitting")
        trial = None
        if problem.free:
            problem, trial = fit_declared(problem, propose(problem))
            noted = (*noted, *inverted_inputs(problem, trial))
            trial = replace(trial, fit=estimable(trial.fit, problem.input_noise, executor))
        begun = _as_declared(problem)  # over the windows of the fit, as what comes after
        trial = trial or begun
        floor = noise_floor_of(problem, trial, propagated_input_noise(problem, trial.fit))
    units = model.units
    after = error_of(trial.fit, units)
    error = {
        "before": None if begun.fit.failed else error_of(begun.fit, units),
        "after": after,
        "noise_floor": error_of(trial.fit, units, floor.level),
    }
    noted = (*_what_to_check(error["after"]["total"]), *noted)  # type: ignore[index]
    left, least = (error[when]["total"]["rmse"] for when in ("after", "noise_floor"))  # type: ignore[index]
    fitted = variants.extended(platform, (), trial.values, ())
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "parameters": fit_table(trial, estimates(trial.fit)),
        "error": error,
        "far_from_floor": trial.fit.failed is not None or left > FAR_FROM_FLOOR * least,
        "windows": after["windows"],
        "remarks": list(noted),
        "provenance": sources,
    }
    files = {"platform.toml": platform_text(fitted), "fit.json": json_text(summary)}
    first = trial if begun.fit.failed else begun
    curves = {} if trial.fit.failed else curves_of({"fit": (first.fit, trial.fit)})
    return Output(summary, files, fitted, curves)


def _what_to_check(error: Mapping[str, Any]) -> tuple[str, ...]:
    """What is wrong most often where a fit leaves thousands of counts, or all of the motion: what
    the signals mean, not what the model lacks.
    """
    share = 1.0 - 0.01 * float(error["fit_percent"])
    counts = float(error["rmse_counts"] or 0.0)
    if share < SOME_OF_MOTION or (counts < MANY_COUNTS if counts else share < 1.0):
        return ()
    left = f"{counts:.3g} counts" if counts else f"{error['rmse']:.3g} {error['unit']}"
    return (
        f"The residual is {left} rms, {100.0 * share:.0f} % of the motion: check the unit, sign,"
        " scale and delay of every signal first, then the declared inertias and lengths; if these"
        " are right, run diagnose.",
    )


def _as_declared(problem: SearchProblem) -> FittedModel:
    """The declared start values, with nothing but the starts of the runs fitted."""
    values = {**problem.fixed, **all_values_at_start(problem.free)}
    effort = Effort(START_ITERATIONS, 1e-3, tolerance_for(problem, START_SHARE))
    return FittedModel(
        (), fit_parameters(problem.model, problem.train, (), values, None, effort, problem.executor)
    )
