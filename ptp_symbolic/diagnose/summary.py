"""A diagnosis as plain data: errors, ranking, parameters, residual tests, curves."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.diagnose.candidates import DECLARED_VALUE
from ptp_symbolic.diagnose.floor import floor_counts, residual_counts
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

FloatArray = NDArray[np.float64]
Pair = tuple[Run, Evaluation]
LAGS = 25


def headline(found: Diagnosis) -> str:
    """One sentence that says what was found."""
    verdict = found.verdict
    before = float(np.sqrt(held_out_cost(found.base)))
    if verdict.word == NOTHING_MISSING:
        return f"Nothing is missing: {before:.3f} counts rms on held-out runs is the noise floor."
    if verdict.word in (EXPLAINED, UP_TO_GROUP, PARTLY) and verdict.accepted is not None:
        names = " and ".join(c.title for c in verdict.accepted.candidates)
        after = float(np.sqrt(held_out_cost(verdict.accepted)))
        sentence = f"Missing: {names}; held-out error {before:.3f} to {after:.3f} counts rms."
        if verdict.word == UP_TO_GROUP:
            rivals = ", ".join(sorted({k for r in verdict.rivals for k in r.keys}))
            return f"{sentence} These logs cannot tell it from: {rivals}."
        if verdict.word == PARTLY:
            return f"{sentence} A remainder is left unexplained."
        return sentence
    return (
        f"Something is missing that has no name here: {before:.3f} counts rms on held-out runs,"
        f" the floor is {verdict.floor:.3f}."
    )


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
    units = trial.train.model.units
    starts = {f.name: f.start if f.table is None else f.table for f in trial.train.free}
    return {
        e.name: {
            "value": e.value,
            "ci95": [_finite(e.lower), _finite(e.upper)],
            "unit": units[e.name],
            "start": starts[e.name],
            "at_bound": e.at_bound,
            "identified": e.identified,
            "only_with": list(e.only_with),
        }
        for e in estimates(trial.train)
    }


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
                "parameters": {
                    n: trial.train.values[n] for c in trial.candidates for n in c.parameters
                },
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


def _train_error(found: Diagnosis, trial: Trial) -> float | None:
    """Error on all train runs; None where a trial was dropped before it saw them all."""
    whole = len(trial.train.runs) == len(found.base.train.runs)
    return _finite(trial.train.rms_counts()) if whole else None


def _why(found: Diagnosis, trial: Trial) -> str:
    accepted = found.verdict.accepted
    if accepted is not None and trial.keys == accepted.keys:
        return "smallest held-out error with the fewest parameters"
    if not np.isfinite(held_out_cost(trial)):
        return "dropped: the fit to the train runs stayed far behind the best"
    before, after = held_out_cost(found.base), held_out_cost(trial)
    if after > 0.9 * before:
        return "no clear gain on held-out runs"
    if any(trial.keys == rival.keys for rival in found.verdict.rivals):
        return "as good as the best on held-out runs"
    if any(c.id.startswith(DECLARED_VALUE) for c in trial.candidates):
        return "a changed declared value explains less than the best"
    return "held-out error above the best"


def residual_tests(trial: Trial) -> list[dict[str, Any]]:
    """Whiteness of the residual and its independence of the inputs, on held-out runs."""
    assert trial.validate is not None
    white, crossed, size = [], [], 0
    for run, e in trial.validate.pairs():
        residual = residual_counts(
            run,
            e,
            int(np.flatnonzero(np.isfinite(run.counts))[0]) if np.isfinite(run.counts).any() else 0,
        )
        if residual.size <= 4 * LAGS:
            continue
        white.append(_correlation(residual, residual))
        crossed.append(_correlation(residual, run.held_inputs[:, 0]))
        size += residual.size
    if not white:
        return []
    threshold = float(stats.norm.ppf(0.995) / np.sqrt(size))
    signal = trial.validate.runs[0].signals[0]
    rows = []
    for name, values, skip, meaning in (
        (
            "whiteness",
            white,
            1,
            "rounding and slow leftovers colour an output error residual",
        ),
        (
            "independence of the input",
            crossed,
            0,
            "what follows the input is a model error",
        ),
    ):
        largest = float(np.max(np.abs(np.mean(values, axis=0)[skip:])))
        rows.append(
            {
                "name": name, "signal": signal, "statistic": largest, "threshold": threshold,
                "passed": largest <= threshold, "meaning": meaning,
            }
        )  # fmt: skip
    return rows


def _correlation(a: FloatArray, b: FloatArray) -> FloatArray:
    a, b = a - a.mean(), b - b.mean()
    scale = max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-300)
    return np.array([float(a[k:] @ b[: b.size - k]) / scale for k in range(LAGS + 1)])


def curves_of(base: Trial, after: Trial) -> dict[str, Any]:
    """Measured and simulated signals of every run, windows joined."""
    curves: dict[str, Any] = {}
    for name in ("train", "validate"):
        before_fit, after_fit = getattr(base, name), getattr(after, name)
        groups = zip(
            by_source(before_fit.pairs()).items(),
            by_source(after_fit.pairs()).values(),
            strict=True,
        )
        for (source, before), later in groups:
            key = source if source not in curves else f"{source} ({name})"
            curves[key] = _curve(name, before, later)
    return curves


def _curve(kind: str, before: list[Pair], after: list[Pair]) -> dict[str, Any]:
    first = before[0][0]
    signals: dict[str, dict[str, Any]] = {}
    for column, signal in enumerate(first.signals):
        picked = first.outputs[column]
        count = first.counts[column]
        signals[signal] = {
            "unit": "rad" if signal.startswith("theta") else "",
            "measured": _joined([r.measured[:, column] for r, _ in before]),
            "before": _joined([e.outputs[:, picked] for _, e in before]),
            "after": _joined([e.outputs[:, picked] for _, e in after]),
            "counts": float(count) if np.isfinite(count) else None,
        }
    time = _joined([r.time for r, _ in before])
    angle, rate = {}, {}
    for signal, data in signals.items():
        if signal.startswith("theta_"):
            axis = signal.removeprefix("theta_")
            angle[axis] = data["after"]
            rate[axis] = np.gradient(data["after"], time)
    return {"set": kind, "time": time, "signals": signals, "angle": angle, "rate": rate}


def _joined(windows: list[FloatArray]) -> FloatArray:
    """Windows end to end; each begins with the sample that ended the one before."""
    return np.concatenate([windows[0], *(w[1:] for w in windows[1:])])
