"""The error of a fit, in one definition for every place that shows one.

Root mean square over all samples of all runs (or windows) of a part, nothing left out: of the angle
signals in rad (the position of a linear joint in m) and in counts of each signal's own encoder, and
of every signal in its own unit.

Measured and simulated signals of a diagnosis, run by run.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import MOST
from ptp_symbolic.numeric.identify.evaluate import Evaluation, simulated_signals
from ptp_symbolic.numeric.identify.evidence import recorded
from ptp_symbolic.numeric.identify.fit import Fit
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
