"""A diagnosis as plain data: headline, errors, ranking, parameters, curves.

The error of a fit has one definition for every place that shows one: root mean square over all
samples of all runs (or windows) of a part, nothing left out: of the angle signals in rad (the
position of a linear joint in m) and in counts of each signal's own encoder, and of every signal in
its own unit.
"""

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel, ranked
from ptp_symbolic.numeric.diagnose.gain import Gain, gain
from ptp_symbolic.numeric.diagnose.noise_floor import NoiseFloor
from ptp_symbolic.numeric.diagnose.regression import gain_along_motion
from ptp_symbolic.numeric.diagnose.stepwise import Search
from ptp_symbolic.numeric.diagnose.verdict import (
    EXPLAINED,
    NOTHING_MISSING,
    PARTLY,
    UP_TO_GROUP,
    Verdict,
)
from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE, MATERIAL, MOST
from ptp_symbolic.numeric.identify.evaluate import Evaluation, simulated_signals
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import Estimate
from ptp_symbolic.numeric.identify.noise import repeatability
from ptp_symbolic.numeric.identify.run import Run

FloatArray = NDArray[np.float64]


Pair = tuple[Run, Evaluation]

DEFINITION = (
    "root mean square over all samples of all runs of the part, the state at the start of each run"
    " or window fitted; of the angles together in rad (positions in m), and in counts of their own"
    " encoders"
)


def pairs_by_run(pairs: Sequence[Pair]) -> dict[str, list[Pair]]:
    """Pairs by run, the windows of one run together."""
    grouped: dict[str, list[Pair]] = {}
    for run, evaluation in pairs:
        grouped.setdefault(run.source, []).append((run, evaluation))
    return grouped


def angle_columns(run: Run) -> list[int]:
    """Measured columns that are angles; all columns where there is none."""
    found = [k for k, name in enumerate(run.signals) if name.startswith("theta_")]
    return found or list(range(len(run.signals)))


@recorded()
def error_of(fit: Fit, units: dict[str, str], floor: FloatArray | None = None) -> dict[str, Any]:
    """Errors of `fit` in total, by run and by signal, and those `without` the run or window that
    alone holds most of the error, None where none does; those of a `floor` [ny], in units of the
    noise of every signal, where one is given; and the `windows` that they were taken over.
    """
    pairs = fit.pairs()
    unit = units[fit.runs[0].signals[angle_columns(fit.runs[0])[0]]]
    return {
        "total": {**_error(pairs, floor), "unit": unit},
        "by_run": {name: _error(group, floor) for name, group in pairs_by_run(pairs).items()},
        "by_signal": {
            name: _signal_error(pairs, k, units[name], floor)
            for k, name in enumerate(fit.runs[0].signals)
        },
        "without": None if floor is not None else _without_worst(pairs, unit),
        "windows": windows_of(fit.runs),
    }


def windows_of(runs: Sequence[Run]) -> dict[str, Any] | None:
    """How many windows `runs` were cut into, and how long they are on average in s; None where all
    are whole.
    """
    lengths = [float(run.time[-1] - run.time[0]) for run in runs if run.name != run.source]
    return {"count": len(lengths), "seconds": sum(lengths) / len(lengths)} if lengths else None


def over(windows: Mapping[str, Any] | None) -> str:
    """What an error was taken over, in words, from what `windows_of` gives."""
    if windows is None:
        return "over whole runs"
    return f"over {windows['count']} windows of {windows['seconds']:.2g} s"


def _without_worst(pairs: Sequence[Pair], unit: str) -> dict[str, Any] | None:
    """The error without the run or window that leaves most of the root mean square, by its name: a
    machine that sticks where the model slides on, or the other way round, is far off for a while.
    """
    if len(pairs) < 2:
        return None
    columns = angle_columns(pairs[0][0])
    squares = [float(np.sum(residual(run, e, None)[:, columns] ** 2)) for run, e in pairs]
    worst = int(np.argmax(squares))
    rest = [pair for k, pair in enumerate(pairs) if k != worst]
    whole, left = _error(pairs, None), _error(rest, None)
    if not float(left["rmse"] or 0.0) < (1.0 - MOST) * float(whole["rmse"] or 0.0):
        return None
    return {"run": pairs[worst][0].name, **left, "unit": unit}


def residual(run: Run, evaluation: Evaluation, floor: FloatArray | None) -> FloatArray:
    """Residuals [k, ny] in the units of the signals, or the `floor` in their place."""
    table = evaluation.residual.reshape(run.measured.shape)
    if floor is not None:
        table = np.broadcast_to(floor, table.shape)
    return np.asarray(table / run.weight)


def _error(pairs: Sequence[Pair], floor: FloatArray | None) -> dict[str, float | None]:
    columns = angle_columns(pairs[0][0])
    counts = pairs[0][0].counts[columns]
    left = np.vstack([residual(run, e, floor)[:, columns] for run, e in pairs])
    measured = np.vstack([run.measured[:, columns] for run, _ in pairs])
    centred = np.vstack(
        [run.measured[:, columns] - run.measured[:, columns].mean(axis=0) for run, _ in pairs]
    )
    norm = float(np.linalg.norm(left))
    in_counts = float(np.sqrt(np.mean((left / counts) ** 2)))
    return {
        "rmse_counts": in_counts if np.isfinite(in_counts) else None,
        "rmse": norm / float(np.sqrt(left.size)),
        "relative_l2": norm / max(float(np.linalg.norm(measured)), 1e-300),
        "fit_percent": 100.0 * (1.0 - norm / max(float(np.linalg.norm(centred)), 1e-300)),
    }


def _signal_error(
    pairs: Sequence[Pair], column: int, unit: str, floor: FloatArray | None
) -> dict[str, Any]:
    """Error of one signal in its own unit, and in counts where it has an encoder."""
    left = np.concatenate([residual(run, e, floor)[:, column] for run, e in pairs])
    rms, count = float(np.sqrt(np.mean(left**2))), float(pairs[0][0].counts[column])
    return {"rmse": rms, "unit": unit, "rmse_counts": rms / count if np.isfinite(count) else None}


@recorded()
def curves_of(parts: Mapping[str, tuple[Fit, Fit]]) -> dict[str, Any]:
    """Inputs, measured and simulated signals [n] in SI of every run of each part ("train",
    "validate"), by the declared and by the final model; the windows of a run joined at the times
    `borders` in s. The key of a curve is its `run`, with the part where both parts have one of that
    name.
    """
    curves: dict[str, Any] = {}
    for name, (before_fit, after_fit) in parts.items():
        units = before_fit.model.units
        groups = zip(
            pairs_by_run(before_fit.pairs()).items(),
            pairs_by_run(after_fit.pairs()).values(),
            strict=True,
        )
        for (source, before), later in groups:
            key = source if source not in curves else f"{source} ({name})"
            inputs = before_fit.model.input_names
            curves[key] = {"run": source, **_curve(name, before, later, units, inputs)}
    return curves


def _curve(
    kind: str,
    before: list[Pair],
    after: list[Pair],
    units: Mapping[str, str],
    names: Sequence[str],
) -> dict[str, Any]:
    first = before[0][0]
    signals: dict[str, dict[str, Any]] = {}
    for column, signal in enumerate(first.signals):
        count = first.counts[column]
        signals[signal] = {
            "unit": units[signal],
            "measured": _joined([r.measured[:, column] for r, _ in before]),
            "before": _joined([simulated_signals(r, e)[:, column] for r, e in before]),
            "after": _joined([simulated_signals(r, e)[:, column] for r, e in after]),
            "counts": float(count) if np.isfinite(count) else None,
        }
    inputs = {
        name: {
            "unit": units[name],
            "values": _joined([r.held_inputs[:, column] for r, _ in before]),
        }
        for column, name in enumerate(names)
    }
    time = _joined([r.time for r, _ in before])
    angle, rate, unit = {}, {}, {}
    for signal, data in signals.items():
        if signal.startswith("theta_"):
            axis = signal.removeprefix("theta_")
            angle[axis] = data["after"]
            rate[axis] = np.gradient(data["after"], time)
            unit[axis] = data["unit"]
    return {
        "set": kind,
        "time": time,
        "signals": signals,
        "inputs": inputs,
        "angle": angle,
        "rate": rate,
        "angle_unit": unit,
        "borders": [float(r.time[0]) for r, _ in before[1:]],
    }


def _joined(windows: list[FloatArray]) -> FloatArray:
    """Windows end to end; each begins with the sample that ended the one before."""
    return np.concatenate([windows[0], *(w[1:] for w in windows[1:])])


_PART = re.compile(r"(\w+_)(sin|cos)(\d?)(_\w+)")  # a part of a wave of `harmonics`


def sizes_of(after: FittedModel, intervals: Mapping[str, Estimate]) -> dict[str, str]:
    """How large every named effect of the trial `after` is, by its key: of the parameters that
    switch it on the most significant one, of a wave the amplitude, with its number of cycles where
    that was found, of what nothing switches off the first that is identified; angles in degrees.
    """
    units, found = after.fit.model.units, {}
    for c in after.candidates:
        if c.is_declared_value or not c.free:
            continue
        shown = c.defining or sorted(c.free, key=lambda f: not intervals[f.name].identified)[:1]
        free = max(
            shown, key=lambda f: _significance(intervals[f.name], c.vanishing.get(f.name, 0.0))
        )
        name, value = _amplitude(free.name, c, intervals)
        found[c.key] = f"{name} = {_written(value, units[free.name])}"
        if c.locked is not None:
            cycles = c.locked[0]
            found[c.key] += f", {cycles} = {_written(intervals[cycles].value, units[cycles])}"
    return found


def _amplitude(
    name: str, candidate: Candidate, intervals: Mapping[str, Estimate]
) -> tuple[str, float]:
    """What a parameter amounts to, and its value: with the other part of its wave the amplitude."""
    part, value = _PART.fullmatch(name), intervals[name].value
    if part is None:
        return name, value
    begin, kind, order, end = part.groups()
    other = f"{begin}{'cos' if kind == 'sin' else 'sin'}{order}{end}"
    if other not in candidate.vanishing or other not in intervals:
        return name, value
    which = f"amplitude of harmonic {order}" if order else "amplitude"
    return which, float(np.hypot(value, intervals[other].value))


def _written(value: float, unit: str) -> str:
    if unit in ("rad", "rad/s"):
        value, unit = float(np.degrees(value)), unit.replace("rad", "deg")
    return f"{value:.3g} {unit}".removesuffix(" 1")


def _significance(estimate: Estimate, vanishing: float) -> float:
    """Distance of a value from the one that switches its effect off, in widths of its interval."""
    width = estimate.upper - estimate.lower
    known = np.isfinite(width) and width > 0.0
    return abs(estimate.value - vanishing) / width if known else 0.0


SMALL = "The deviation is statistically significant but small."


def headline(found: Verdict, errors: dict[str, Any], sizes: Mapping[str, str]) -> str:
    """What was found, in one or two sentences; `sizes` say by key how large a named effect is."""
    before, after, floor = (
        _worded(errors["validate"][when]["total"]) for when in ("before", "after", "noise_floor")
    )
    if found.word == NOTHING_MISSING:
        rms = [errors["validate"][when]["total"]["rmse"] for when in ("before", "noise_floor")]
        if rms[0] <= ABOVE_NOISE * rms[1]:
            taken = _over_windows(errors["validate"]["before"])
            return f"Nothing is missing: {before} on validation runs{taken} is the noise floor."
        text = f"Nothing is missing: noise ({floor}) and errors of fitted values explain {before}"
        usual = _mostly_in_one_run(errors["validate"]["before"]["without"])
        return " ".join([f"{text} on validation runs.", *usual])
    if found.word in (EXPLAINED, UP_TO_GROUP, PARTLY):
        causes = " and ".join(
            f"{cause(c, found.final)}{f' ({sizes[c.key]})' if c.key in sizes else ''}"
            for c in found.final.candidates
        )
        declared = all(c.is_declared_value for c in found.final.candidates)
        begin = f"{causes[:1].upper()}{causes[1:]}" if declared else f"Missing: {causes}"
        taken = _over_windows(errors["validate"]["after"])
        sentences = [f"{begin}; validation error {before} to {after}{taken}."]
        sentences += _mostly_in_one_run(errors["validate"]["after"]["without"])
        sentences += [SMALL for c in found.final.candidates if _is_small(c, found.final)][:1]
        alternatives = {key: ", ".join(keys) for key, keys in found.confusable.items() if keys}
        alone = len(found.final.candidates) == 1
        sentences += [
            f"In these logs {'it' if alone else key} is indistinguishable from: {others}."
            for key, others in alternatives.items()
        ]
        if found.word == PARTLY:
            sentences.append(f"The noise floor is {floor}: part of the residual is unexplained.")
        return " ".join(sentences)
    left = _residual_in_words(errors)
    text = f"Something is missing, and no known effect could be confirmed: {left}."
    if found.closest is not None:
        text += f" The closest candidate, not confirmed: {' + '.join(found.closest.keys)}."
    return text


def _residual_in_words(errors: Mapping[str, Any]) -> str:
    """The residual of the declared model beside the noise floor: of the validation runs, or of the
    training runs where these alone show more than noise.
    """

    def is_at_floor(part: str) -> bool:
        rms, floor = (errors[part][w]["total"]["rmse"] for w in ("before", "noise_floor"))
        return bool(rms <= ABOVE_NOISE * floor)

    training = is_at_floor("validate") and not is_at_floor("train")
    part, name = ("train", "training") if training else ("validate", "validation")
    before, floor = (_worded(errors[part][w]["total"]) for w in ("before", "noise_floor"))
    taken = _over_windows(errors[part]["before"])
    text = f"{before} on {name} runs{taken}, the noise floor is {floor}"
    return f"{text}; the validation runs reach theirs" if training else text


def _over_windows(error: Mapping[str, Any]) -> str:
    """The windows that an error was taken over, where runs were cut."""
    windows = error.get("windows")
    return "" if windows is None else f" {over(windows)}"


def _mostly_in_one_run(without: Mapping[str, Any] | None) -> list[str]:
    """Where most of the error lies in one run or window: which, and the error of the others."""
    if without is None:
        return []
    return [
        f"Most of that lies in {without['run']}; the error of the others is {_worded(without)}."
    ]


def _worded(error: Mapping[str, Any]) -> str:
    """An error in counts, or in its unit where there is no encoder."""
    if error["rmse_counts"] is None:
        return f"{error['rmse']:.3g} {error['unit']} rms"
    return f"{error['rmse_counts']:.3f} counts rms"


def cause(candidate: Candidate, trial: FittedModel) -> str:
    """What `candidate` says is wrong with the declared machine; of a value also by how much."""
    if not candidate.is_declared_value:
        return candidate.title
    name = candidate.parameters[0]
    meaning = {p.name: p.meaning for p in trial.fit.model.parameters}[name]
    percent = deviation(candidate, trial)
    written = f"{percent:+.1f}" if abs(percent) >= 10.0 else f"{percent:+.2g}"
    return f"declared value of {name} is wrong by {written} % ({meaning})"


def deviation(candidate: Candidate, trial: FittedModel) -> float:
    """By how many percent the fit moved a declared value."""
    (name,) = candidate.parameters
    declared = candidate.vanishing[name]
    return 100.0 * (trial.values[name] - declared) / abs(declared)


def _is_small(candidate: Candidate, trial: FittedModel) -> bool:
    """Whether a declared value is off by less than a material share of a material share."""
    return candidate.is_declared_value and abs(deviation(candidate, trial)) < 100.0 * MATERIAL**2


def repeatability_table(runs: Sequence[Run], units: Mapping[str, str]) -> dict[str, Any] | None:
    """What differs between `runs` with equal inputs, by signal; None where there are none."""
    found = repeatability(runs)
    if found is None:
        return None
    counts = found.rms / runs[0].counts
    return {
        "runs": [list(pair) for pair in found.names],
        "by_signal": {
            signal: {
                "rmse": float(found.rms[k]),
                "unit": units[signal],
                "rmse_counts": _finite(counts[k]),
            }
            for k, signal in enumerate(runs[0].signals)
        },
    }


def error_table(parts: dict[str, tuple[Fit, Fit]], floor: NoiseFloor) -> dict[str, Any]:
    """Errors of each part ("train", "validate") by the declared model and by the final one, and of
    the noise floor.
    """
    table: dict[str, Any] = {"definition": DEFINITION}
    for name, (before, after) in parts.items():
        units = before.model.units
        table[name] = {
            "before": error_of(before, units),
            "after": error_of(after, units),
            "noise_floor": error_of(after, units, floor.level),
        }
    return table


def fit_table(trial: FittedModel, found: Sequence[Estimate]) -> dict[str, Any]:
    """Fitted parameters with intervals, starts, bounds hit and those the data cannot identify."""
    model = trial.fit.model
    meanings = {p.name: p.meaning for p in model.parameters}
    declared = {f.name: f.declared_start for f in trial.fit.free}
    return {
        e.name: {
            "value": e.value,
            "ci95": [_finite(e.lower), _finite(e.upper)] if e.has_interval else [None, None],
            "unit": model.units[e.name],
            "meaning": meanings[e.name],
            "start": declared[e.name],
            "at_bound": e.at_bound,
            "identified": e.identified,
            "only_with": list(e.only_with),
        }
        for e in found
    }


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def added_effects(
    verdict: Verdict, after: FittedModel, intervals: Mapping[str, Estimate]
) -> list[dict[str, Any]]:
    """The named effects of the trial `after`, with the `intervals` of their parameters."""
    units = after.fit.model.units
    return [
        {
            "effect": c.id,
            "title": cause(c, after),
            "axis": c.axis,
            "parameters": {name: _value(intervals[name], units[name]) for name in c.parameters},
            "gain": gain_table(verdict.gains[c.key]),
            "confusable_with": list(verdict.confusable[c.key]),
            "separating_experiment": c.separating_experiment,
        }
        for c in after.candidates
    ]


def _value(estimate: Estimate, unit: str) -> dict[str, Any]:
    interval = [estimate.lower, estimate.upper]
    return {"value": estimate.value, "ci95": interval, "unit": unit}


def gain_table(earned: Gain) -> dict[str, Any]:
    """A predictive gain: the share of the loss on blocks left out, with its 95 % interval."""
    return {"share": earned.share, "ci95": [_finite(earned.lower), _finite(earned.upper)]}


def ranking(
    search: Search, found: Verdict, candidates: Sequence[Candidate]
) -> list[dict[str, Any]]:
    """Every set that was fitted, the best first: its error on the training runs, what it gains over
    the declared model in prediction, and why it was accepted or not; then the candidates that were
    compared along the measured motion alone.
    """
    alternatives = [r.trial for r in found.alternatives]
    trials = [
        t
        for t in (found.compared, *alternatives, search.chosen, *search.tried.others)
        if t.candidates
    ]
    best = [t for t in ranked(trials) if np.isfinite(t.fit.cost)]
    judged = {trial.keys: trial for trial in (search.chosen, found.compared)}
    kept: dict[tuple[str, ...], FittedModel] = {}
    for trial in best:
        kept.setdefault(trial.keys, judged.get(trial.keys, trial))
    rows = [_row(search, found, trial) for trial in kept.values()]
    tried = {key for trial in kept.values() for key in trial.keys}
    forms: dict[str, list[Candidate]] = {}
    for candidate in candidates:
        if candidate.key not in tried:
            forms.setdefault(candidate.key, []).append(candidate)
    return rows + [_unfitted(search, own) for own in forms.values()]


def _row(search: Search, found: Verdict, trial: FittedModel) -> dict[str, Any]:
    accepted = bool(found.final.candidates) and trial.keys == found.compared.keys
    elsewhere = accepted and found.is_along_motion  # that fit is not the best one of outputs
    earned = None if elsewhere else gain(trial, search.declared)
    return ranking_row(trial.candidates, trial, earned, accepted, _why(found, trial))


def ranking_row(
    added: Sequence[Candidate], trial: FittedModel, earned: Gain | None, accepted: bool, why: str
) -> dict[str, Any]:
    """A row of the ranking for a trial with the effects `added`; without figures where it failed.
    The error is in counts where an angle is counted, else in its unit.
    """
    units, failed = trial.fit.model.units, bool(trial.fit.failed)
    error = {} if failed else error_of(trial.fit, units)["total"]
    in_counts = error.get("rmse_counts")
    axes = {c.axis for c in added}
    return {
        "effect": " + ".join(c.id for c in added),
        "axis": axes.pop() if len(axes) == 1 else None,
        "gain": None if failed or earned is None else gain_table(earned),
        "train_error_after": error.get("rmse") if in_counts is None else in_counts,
        "parameters": {
            f.name: {"value": trial.values[f.name], "unit": units[f.name]}
            for c in added
            for f in c.free
        },
        "accepted": accepted,
        "why": why,
    }


def _unfitted(search: Search, forms: Sequence[Candidate]) -> dict[str, Any]:
    """A candidate that was not simulated, and what the best of its `forms` by itself gains over the
    declared model along the motion.
    """
    rows = search.proposals.regression
    shown = [] if rows is None else [gain_along_motion(rows, (form,), ()) for form in forms]
    unseen = "" if rows is None else ", and does not show along the measured motion"
    found = [gain for gain in shown if gain is not None]
    best = max(found, key=lambda gain: gain.share, default=None)
    return {
        "effect": forms[0].id,
        "axis": forms[0].axis,
        "gain": None,
        "gain_along_motion": None if best is None else gain_table(best),
        "train_error_after": None,
        "parameters": {},
        "accepted": False,
        "why": "compared along the measured motion, where other sets did better"
        if found
        else f"not tried: it was not simulated{unseen}",
    }


def _why(found: Verdict, trial: FittedModel) -> str:
    if found.final.candidates and trial.keys == found.compared.keys:
        if found.is_along_motion:
            return "every effect in it is significant in the torque along the measured motion"
        return "every effect in it is significant, and no other effect improves it"
    other = next((r for r in found.alternatives if r.trial.keys == trial.keys), None)
    if other is not None:
        noise = "its residual is within the propagated noise of the inputs"
        return noise if other.is_within_input_noise else "predicts as well as the accepted set"
    refused = [f"{key} {why}" for key, why in found.refused.items() if key in trial.keys]
    if refused and set(trial.keys) <= {*found.compared.keys, *found.refused}:
        return "; ".join(refused)
    if found.final.candidates and set(found.compared.keys) < set(trial.keys):
        return "what it adds to the accepted set reduces the error too little"
    return "tried, not judged: the search went on from another set"
