"""The residual torque of a model along the measured motion: observations, no names.

The residual torque of every axis is averaged in bins of the angle, of the rate, of the input and of
the time since the joint turned back, and searched for lines in time and in angle. The share of its
variance that a side accounts for tells where to look for what is missing.
"""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lombscargle

from ptp_symbolic.numeric.identify.constants import (
    BINS,
    CYCLES_APART,
    LEAST_CYCLES,
    MATERIAL,
    ROWS_PER_WINDOW,
)
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from ptp_symbolic.numeric.identify.row_motion import RowMotion, row_motion

FloatArray = NDArray[np.float64]
Side = tuple[str, str, FloatArray]


def remainder(space: EquationSpace | None, values: Mapping[str, float]) -> dict[str, Any] | None:
    """Maps and lines of the residual torque of every axis at the parameter `values`, with the share
    of its variance that each accounts for (adjusted for the bins); None without an equation space.
    """
    if space is None:
        return None
    rows = space.rows(space.model.parameter_vector(dict(values)))
    equation, number, time = space.labels()
    maps: list[dict[str, Any]] = []
    lines: list[dict[str, Any]] = []
    for axis, name in enumerate(space.model.module.AXES):
        own = equation == axis
        if int(own.sum()) < BINS * ROWS_PER_WINDOW:
            continue
        left, motion = rows[own], row_motion(space, axis)
        linear = space.model.is_linear(name)
        angle, turn = ("position", "m") if linear else ("angle", "turn")
        inputs = list(_inputs(space, number[own], time[own]))
        for against, unit, x in (*_sides(motion, linear), *inputs):
            if np.isfinite(x).any() and np.nanmin(x) < np.nanmax(x):
                maps.append({"axis": name, "against": against, "unit": unit, **binned(x, left)})
        in_time, once = number[own], np.zeros(len(left), dtype=np.int64)
        cycle = 1.0 if linear else 2.0 * np.pi
        for place, unit, x, speed, runs in (
            ("time", "Hz", time[own], np.ones(len(left)), in_time),
            (angle, f"1/{turn}", motion.angle / cycle, motion.rate / cycle, once),
        ):
            found = strongest_line(x, left, runs, space.half_width, speed)
            if found is not None:
                frequency, share = found
                line = {"axis": name, "against": place, "unit": unit}
                lines.append({**line, "frequency": frequency, "share": share})
    sliding = any(space.model.is_linear(name) for name in space.model.module.AXES)
    return {"unit": "N" if sliding else "N m", "maps": maps, "lines": lines}


def hints(found: Mapping[str, Any] | None) -> list[str]:
    """What the residual torque depends on most, in plain words, the largest share first."""
    if found is None:
        return []
    unit = found["unit"]
    what = "force" if unit == "N" else "torque"
    sides = [(m["share"], _said(m, what, unit)) for m in found["maps"] if m["share"] >= MATERIAL]
    sides += [
        (
            line["share"],
            f"The residual {what} on {line['axis']} has a spectral line at {line['frequency']:.3g}"
            f" {line['unit']} ({100.0 * line['share']:.0f} % of its variance).",
        )
        for line in found["lines"]
    ]
    return [text for share, text in sorted(sides, reverse=True) if share >= MATERIAL]


def _said(m: Mapping[str, Any], what: str, unit: str) -> str:
    largest = float(np.max(np.abs(m["mean"])))
    return (
        f"The residual {what} on {m['axis']} follows the {m['against']}"
        f" ({100.0 * m['share']:.0f} % of its variance, up to {largest:.3g} {unit})."
    )


def _sides(motion: RowMotion, linear: bool) -> Iterator[Side]:
    yield ("position", "m", motion.angle) if linear else ("angle", "rad", motion.angle)
    yield ("speed", "m/s", motion.rate) if linear else ("rate", "rad/s", motion.rate)
    yield "time since reversal", "s", motion.since_reversal


def _inputs(space: EquationSpace, number: NDArray[np.int64], time: FloatArray) -> Iterator[Side]:
    """What drives the machine at the rows: torques, voltages."""
    model = space.model
    for column, name in enumerate(model.input_names):
        x = np.zeros(len(time))
        for k, run in enumerate(space.runs):
            here = number == k
            x[here] = np.interp(time[here], run.time, run.held_inputs[:, column])
        yield f"input {name}", model.units[name], x


def binned(x: FloatArray, left: FloatArray) -> dict[str, Any]:
    """Means of `left` [n] in N m in equally full bins of `x` [n] (equal values share one), their
    standard errors (rows whose windows overlap count as one), and the share of the variance between
    bins.
    """
    usable = np.isfinite(x)
    if not usable.any():
        return {"at": [], "mean": [], "error": [], "share": 0.0}
    x, left = x[usable], left[usable]
    edges = np.unique(np.quantile(x, np.linspace(0.0, 1.0, BINS + 1)[1:-1]))
    place = np.searchsorted(edges, x, side="right")
    parts = [np.flatnonzero(place == k) for k in np.unique(place)]
    mean = np.array([left[part].mean() for part in parts])
    error = [
        float(left[part].std() / np.sqrt(max(part.size / ROWS_PER_WINDOW, 1.0))) for part in parts
    ]
    within = sum(float(np.sum((left[p] - m) ** 2)) for p, m in zip(parts, mean, strict=True))
    whole = float(np.sum((left - left.mean()) ** 2)) if left.size else 0.0
    independent = max(left.size / ROWS_PER_WINDOW, len(parts) + 2.0)
    excess = (independent - 1.0) / (independent - len(parts))
    share = 1.0 - excess * within / whole if whole > 0.0 else 0.0
    return {
        "at": [float(np.median(x[part])) for part in parts],
        "mean": mean.tolist(),
        "error": error,
        "share": max(share, 0.0),
    }


def strongest_line(
    place: FloatArray,
    left: FloatArray,
    runs: NDArray[np.int64],
    half_width: float,
    speed: FloatArray,
) -> tuple[float, float] | None:
    """The strongest line of `left` [n] over a `place` [n] (time in s run by run, turns or m), in
    Hz, 1/turn or 1/m, and the share of the variance in it (Lomb, 1976; Scargle, 1982), beyond that
    of the strongest of white noise (Fisher, 1929); None where the range holds too few cycles.
    Frequencies end where a window of `half_width` s averages two cycles away at the `speed` [n] of
    the place per s, or at two rows in a cycle.
    """
    span = max(float(np.ptp(place[runs == k])) for k in np.unique(runs))
    moving = np.abs(speed[speed != 0.0])
    slow = float(np.quantile(moving, 0.1)) if moving.size else 1.0
    lowest = LEAST_CYCLES / max(span, 1e-12)
    highest = min(1.0 / max(half_width * slow, 1e-12), 0.5 * left.size / max(span, 1e-12))
    if not lowest < highest:
        return None
    count = int((highest - lowest) * span / CYCLES_APART) + 2
    frequency = np.linspace(lowest, highest, count)
    power, whole = np.zeros(len(frequency)), 0.0
    for k in np.unique(runs):
        own = left[runs == k] - left[runs == k].mean()
        square = float(own @ own)
        if own.size < 2 * ROWS_PER_WINDOW or square == 0.0:
            continue
        found = lombscargle(place[runs == k], own, 2.0 * np.pi * frequency, normalize=True)
        power += square * np.asarray(found)
        whole += square
    if whole == 0.0:
        return None
    best = int(np.argmax(power))
    independent = max(left.size / ROWS_PER_WINDOW, 3.0)
    chance = min(2.0 * np.log(independent) / independent, 1.0 - 1e-9)
    share = (float(power[best] / whole) - chance) / (1.0 - chance)
    return float(frequency[best]), max(share, 0.0)
