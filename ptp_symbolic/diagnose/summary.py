"""A diagnosis as plain data: headline, errors, ranking, parameters."""

from typing import Any

import numpy as np

from ptp_symbolic.diagnose.candidates import DECLARED_VALUE, Candidate
from ptp_symbolic.diagnose.floor import floor_counts, residual_counts, trimmed
from ptp_symbolic.diagnose.rounds import Diagnosis
from ptp_symbolic.diagnose.trial import Trial, held_out_cost
from ptp_symbolic.diagnose.verdict import (
    EXPLAINED,
    NOTHING_MISSING,
    PARTLY,
    UP_TO_GROUP,
)
from ptp_symbolic.identify.evaluate import Evaluation
from ptp_symbolic.identify.fit import Fit
from ptp_symbolic.identify.intervals import estimates
from ptp_symbolic.identify.run import Run

Pair = tuple[Run, Evaluation]
SMALL_PERCENT = 1.0
SMALL = "The deviation is statistically clear but small."


def headline(found: Diagnosis) -> str:
    """What was found, in one or two sentences."""
    verdict, accepted = found.verdict, found.verdict.accepted
    before = float(np.sqrt(held_out_cost(found.base)))
    if verdict.word == NOTHING_MISSING:
        return f"Nothing is missing: {before:.3f} counts rms on validation runs is the noise floor."
    if verdict.word in (EXPLAINED, UP_TO_GROUP, PARTLY) and accepted is not None:
        after = float(np.sqrt(held_out_cost(accepted)))
        causes = " and ".join(cause(c, accepted) for c in accepted.candidates)
        declared = all(c.is_declared_value for c in accepted.candidates)
        begin = f"{causes[:1].upper()}{causes[1:]}" if declared else f"Missing: {causes}"
        sentences = [
            f"{begin}; validation error {before:.3f} to {after:.3f} counts rms{_kept(found)}."
        ]
        sentences += [SMALL for c in accepted.candidates if _is_small(c, accepted)][:1]
        if verdict.word == UP_TO_GROUP:
            rivals = ", ".join(sorted({k for r in verdict.rivals for k in r.keys}))
            sentences.append(f"These logs cannot tell it from: {rivals}.")
        if verdict.word == PARTLY:
            sentences.append("A remainder is left unexplained.")
        return " ".join(sentences)
    return (
        f"Something is missing that has no name here: {before:.3f} counts rms on validation runs,"
        f" the floor is {verdict.floor:.3f}."
    )


def cause(candidate: Candidate, trial: Trial) -> str:
    """What `candidate` says is wrong with the declared machine; of a value also by how much."""
    if not candidate.is_declared_value:
        return candidate.title
    name = candidate.parameters[0]
    meaning = {p.name: p.meaning for p in trial.train.model.parameters}[name]
    percent = deviation(candidate, trial)
    written = f"{percent:+.1f}" if abs(percent) >= 10.0 else f"{percent:+.2g}"
    return f"declared value of {name} is wrong by {written} % ({meaning})"


def deviation(candidate: Candidate, trial: Trial) -> float:
    """By how many percent the fit moved a declared value."""
    (declared,) = candidate.starts[0]
    return 100.0 * (trial.train.values[declared.name] - declared.start) / abs(declared.start)


def _is_small(candidate: Candidate, trial: Trial) -> bool:
    return candidate.is_declared_value and abs(deviation(candidate, trial)) < SMALL_PERCENT


def _kept(found: Diagnosis) -> str:
    """A note where the worst windows do not count."""
    fit = found.base.validate
    pairs = [] if fit is None else fit.pairs()
    return "" if len(trimmed(pairs)) == len(pairs) else " without the worst tenth of the windows"


def by_source(pairs: list[Pair]) -> dict[str, list[Pair]]:
    """Pairs by run, the windows of one run together."""
    grouped: dict[str, list[Pair]] = {}
    for run, evaluation in pairs:
        grouped.setdefault(run.name.partition("#")[0], []).append((run, evaluation))
    return grouped


def error_table(base: Trial, after: Trial, floor: float | None) -> dict[str, Any]:
    """Errors of train and validate, before and after, in total and by run."""
    table: dict[str, Any] = {}
    for name in ("train", "validate"):
        fits = [getattr(trial, name) for trial in (base, after)]
        if any(fit is None for fit in fits):
            continue
        level = floor if floor is not None else floor_counts(fits[1].pairs())
        table[name] = {
            "before": _errors(fits[0], None),
            "after": _errors(fits[1], None),
            "noise_floor": _errors(fits[1], level),
        }
    return table


def _errors(fit: Fit, floor: float | None) -> dict[str, Any]:
    return {
        "total": _error(fit.pairs(), floor),
        "by_run": {name: _error(group, floor) for name, group in by_source(fit.pairs()).items()},
    }


def _error(pairs: list[Pair], floor: float | None) -> dict[str, float]:
    """Errors over the encoder signals of `pairs`; of the noise floor where one is given."""
    run = pairs[0][0]
    columns = [c for c in range(run.measured.shape[1]) if np.isfinite(run.counts[c])] or [0]
    count = float(run.counts[columns[0]]) if np.isfinite(run.counts[columns[0]]) else 1.0
    residual = np.concatenate([residual_counts(r, e, c) for r, e in pairs for c in columns])
    measured = np.concatenate([r.measured[:, c] for r, _ in pairs for c in columns])
    centred = np.concatenate(
        [r.measured[:, c] - r.measured[:, c].mean() for r, _ in pairs for c in columns]
    )
    counts = float(np.sqrt(np.mean(residual**2))) if floor is None else floor
    norm = counts * count * np.sqrt(residual.size)
    return {
        "rmse_counts": counts,
        "rmse": counts * count,
        "relative_l2": float(norm / max(np.linalg.norm(measured), 1e-300)),
        "fit_percent": float(100.0 * (1.0 - norm / max(np.linalg.norm(centred), 1e-300))),
    }


def fit_table(trial: Trial) -> dict[str, Any]:
    """Fitted parameters with intervals, starts, bounds hit and those the data cannot identify."""
    model = trial.train.model
    meanings = {p.name: p.meaning for p in model.parameters}
    return {
        e.name: {
            "value": e.value,
            "ci95": [_finite(e.lower), _finite(e.upper)],
            "unit": model.units[e.name],
            "meaning": meanings[e.name],
            "start": _start(trial, e.name),
            "at_bound": e.at_bound,
            "identified": e.identified,
            "only_with": list(e.only_with),
        }
        for e in estimates(trial.train)
    }


def _start(trial: Trial, name: str) -> float | None:
    """Where the search for a parameter began; None where it began at several places."""
    declared = {f.name: f.table for f in trial.train.free}
    if declared[name] is not None:
        return declared[name]
    began = {f.start for c in trial.candidates for start in c.starts for f in start
             if f.name == name}  # fmt: skip
    return began.pop() if len(began) == 1 else None


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def ranking(found: Diagnosis) -> list[dict[str, Any]]:
    """Every trial, best first, with its score, its held-out error and why it was (not) accepted."""
    rows = []
    accepted = found.verdict.accepted
    for trial in found.trials:
        score = found.scores[trial.candidates[-1].key]
        judged = np.isfinite(held_out_cost(trial))
        rows.append(
            {
                "effect": " + ".join(c.id for c in trial.candidates),
                "axis": trial.candidates[0].axis,
                "statistic": score.statistic,
                "p_value": score.p_value,
                "train_error_after": _train_error(found, trial),
                "validate_error_after": float(np.sqrt(held_out_cost(trial))) if judged else None,
                "parameters": _fitted(trial) if judged else {},
                "accepted": accepted is not None and trial.keys == accepted.keys,
                "why": _why(found, trial),
            }
        )
    for candidate in found.invisible:
        score = found.scores[candidate.key]
        rows.append(
            {
                "effect": candidate.id, "axis": candidate.axis, "statistic": score.statistic,
                "p_value": score.p_value, "train_error_after": None,
                "validate_error_after": None, "parameters": {}, "accepted": False,
                "why": "not visible in these logs: absorbed by the declared parameters",
            }
        )  # fmt: skip
    return rows


def _fitted(trial: Trial) -> dict[str, dict[str, Any]]:
    units = trial.train.model.units
    return {
        name: {"value": trial.train.values[name], "unit": units[name]}
        for candidate in trial.candidates
        for name in candidate.parameters
    }


def _train_error(found: Diagnosis, trial: Trial) -> float | None:
    """Error on all train runs; None where a trial was dropped before it saw them all."""
    whole = len(trial.train.runs) == len(found.base.train.runs)
    return _finite(trial.train.rms_counts()) if whole else None


def _why(found: Diagnosis, trial: Trial) -> str:
    accepted = found.verdict.accepted
    if accepted is not None and trial.keys == accepted.keys:
        return "smallest validation error with the fewest parameters"
    if not np.isfinite(held_out_cost(trial)):
        return "dropped early: after a few iterations its fit stayed far behind the best"
    before, after = held_out_cost(found.base), held_out_cost(trial)
    if after > 0.9 * before:
        return "no clear gain on validation runs"
    if any(trial.keys == rival.keys for rival in found.verdict.rivals):
        return "as good as the best on validation runs"
    if any(c.id.startswith(DECLARED_VALUE) for c in trial.candidates):
        return "a changed declared value explains less than the best"
    return "validation error above the best"
