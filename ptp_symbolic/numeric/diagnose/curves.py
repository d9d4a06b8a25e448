"""Measured and simulated signals of a diagnosis, run by run."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.errors import Pair, pairs_by_run
from ptp_symbolic.numeric.identify.evaluate import simulated_signals
from ptp_symbolic.numeric.identify.fit import Fit

FloatArray = NDArray[np.float64]


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
