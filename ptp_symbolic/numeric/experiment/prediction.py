"""What an experiment is predicted to show: separation of every pair, intervals, curves."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import permutations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.experiment.contender import (
    Contender,
    as_it_is,
    information,
    refitted,
    spreads,
)
from ptp_symbolic.numeric.experiment.criteria import compared
from ptp_symbolic.numeric.experiment.machine import SCENARIOS, Conditions, logged, play
from ptp_symbolic.numeric.identify.coordinates import slopes
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.simulations import POLISH

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Pair:
    """How far `other` is from what `machine` shows, in sigmas: on the logs so far (`before`), by
    the new run (`run`), and on both (`after`); and the shares of the squared error of `other` that
    `machine` takes away on the logs so far and on both; in the scenario that tells least. Zero
    where the logs so far speak for `other`.
    """

    machine: str
    other: str
    before: float
    run: float
    after: float
    share_before: float
    share_after: float

    def as_dict(self) -> dict[str, Any]:
        """As plain data."""
        return asdict(self)


def predicted_pairs(
    contenders: Sequence[Contender], conditions: Conditions, wave: FloatArray
) -> list[Pair]:
    """Every ordered pair after the run `wave` [k, nu]."""
    pairs = []
    for machine, other in permutations(contenders, 2):
        tried = [compared(machine, other, conditions, wave, how, POLISH) for how in SCENARIOS]
        runs = [found for found in tried if found is not None]
        if not runs:
            continue
        found = min(runs, key=lambda each: each.more)
        before = other.left - machine.left
        after = max(0.0, before + found.more)
        left = machine.left + found.run.size
        pairs.append(
            Pair(
                machine.name,
                other.name,
                float(np.sqrt(max(0.0, before))),
                float(np.sqrt(found.more)),
                float(np.sqrt(after)),
                max(0.0, before) / max(machine.left + before, 1.0),
                after / (left + after),
            )
        )
    return pairs


def predicted_spreads(
    contender: Contender, conditions: Conditions, wave: FloatArray
) -> dict[str, dict[str, Any]]:
    """Value, unit and standard deviation before and after the run `wave` [k, nu] of every free
    parameter of a contender; None where nothing is known.
    """
    before = spreads(contender, contender.memory.T @ contender.memory)
    played = play(contender, conditions, wave)
    known = (
        None
        if played is None
        else information(contender, logged(contender, conditions, played), 0.0)
    )
    after = before if known is None else spreads(contender, known)
    return {
        f.name: {
            "value": contender.values[f.name],
            "unit": contender.model.units[f.name],
            "sd_before": _finite(before[f.name]),
            "sd_after": _finite(after[f.name]),
        }
        for f in contender.free
    }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def predicted_curves(
    contenders: Sequence[Contender],
    wanted: Sequence[str],
    conditions: Conditions,
    wave: FloatArray,
) -> dict[str, Any]:
    """Time, inputs and outputs along `wave` [k, nu], and by output what tells: how far the second
    contender, refitted, is from the first; or the change by a tenth of each parameter `wanted`. In
    sigmas of the noise.
    """
    first = contenders[0]
    played = play(first, conditions, wave)
    assert played is not None
    run = logged(first, conditions, played)
    lines: Mapping[str, FloatArray]
    if wanted:
        lines = _changes(first, wanted, run)
    else:
        found = refitted(contenders[1], run, 0.0, POLISH)
        shape = run.measured.shape
        difference = np.zeros(shape) if found is None else found.evaluation.residual.reshape(shape)
        lines = {f"{first.name} minus {contenders[1].name}": difference}
    units = first.model.units
    return {
        "time": conditions.t,
        "inputs": {
            n: (units[n], c) for n, c in zip(first.model.input_names, played.inputs.T, strict=True)
        },
        "outputs": {n: (units[n], c) for n, c in zip(run.signals, run.measured.T, strict=True)},
        "tells": {
            name: {label: table[:, k] for label, table in lines.items()}
            for k, name in enumerate(run.signals)
        },
    }


def _changes(contender: Contender, wanted: Sequence[str], run: Run) -> dict[str, FloatArray]:
    """By name the change [k, ny], in sigmas, of what is measured by a tenth of a parameter."""
    found = as_it_is(contender, run, 0.0)
    assert found is not None
    units = np.abs(slopes(contender.free, contender.phi))
    changes = {}
    for k, f in enumerate(contender.free):
        if f.name in wanted:
            tenth = 0.1 * contender.values[f.name] / units[k]
            column = -tenth * found.by_parameter[:, k]
            changes[f"10 % of {f.name}"] = column.reshape(run.measured.shape)
    return changes
