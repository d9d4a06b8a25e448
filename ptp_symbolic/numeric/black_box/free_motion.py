"""Free simulation with a learned torque on the joints of the declared model."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.evaluate import Tolerance, start_state
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.integration import Accuracy, integrate
from ptp_symbolic.numeric.simulation.kernels.records import DONE
from ptp_symbolic.numeric.simulation.signals.inputs import delayed, delays_of

FloatArray = NDArray[np.float64]
Torque = Callable[[FloatArray], FloatArray]

TORQUE = "tau0_{axis}"  # of the effect constant_torque, which is in every model of a diagnosis


@dataclass(frozen=True, eq=False)
class FreeRuns:
    """What is simulated: `runs` (or windows of them) at p [np], from the better of several
    `starts`, each the start unknowns of every run.
    """

    model: Model
    runs: Sequence[Run]
    p: FloatArray
    starts: Sequence[Sequence[FloatArray]]
    tolerance: Tolerance


def free_error(free: FreeRuns, torques: Mapping[str, Torque]) -> dict[str, float | None] | None:
    """The error (rms) of the angles together in rad (positions in m) and in counts, with the
    `torques` by axis on the joints; every run from that start which leaves less.

    None where a simulation ends early, and for a model without a place for the torques.
    """
    if any(TORQUE.format(axis=axis) not in free.model.parameter_names for axis in torques):
        return None
    tried = [
        [
            _left(free.model, run, states, free.p)
            for run, states in zip(free.runs, simulated(free, z, torques), strict=True)
        ]
        for z in free.starts
    ]
    best = [min(parts, key=_size) for parts in zip(*tried, strict=True)]
    left = np.vstack(best)
    if not np.all(np.isfinite(left)):
        return None
    counts = free.runs[0].counts[_angles(free.runs[0])]
    in_counts = float(np.sqrt(np.mean((left / counts) ** 2)))
    return {
        "rmse": float(np.sqrt(np.mean(left**2))),
        "rmse_counts": in_counts if np.isfinite(in_counts) else None,
    }


def _size(left: FloatArray) -> float:
    square = float(np.sum(left**2))
    return square if np.isfinite(square) else np.inf


def _angles(run: Run) -> list[int]:
    return [k for k, name in enumerate(run.signals) if name.startswith("theta_")]


def _left(model: Model, run: Run, states: FloatArray, p: FloatArray) -> FloatArray:
    """Measured minus simulated angles [k, na] of a run at its `states` [k, n]."""
    shown = np.zeros((len(run.time), len(model.output_names)))
    for k, x in enumerate(states):
        model.module.outputs(run.time[k], x, run.held_inputs[k], p, shown[k])
    columns = _angles(run)
    return np.asarray((run.measured - shown[:, run.outputs])[:, columns])


def simulated(
    free: FreeRuns, z: Sequence[FloatArray], torques: Mapping[str, Torque]
) -> list[FloatArray]:
    """The states [k, n] of all runs from the start unknowns `z`, with the `torques` by
    axis of angles, rates and inputs [s] added to the joints; nan from where a simulation ends.

    A torque is held from sample to sample of the log, as inputs are. All runs go on sample by
    sample, so that a torque is asked for once a sample.
    """
    model, runs, p, tolerance = free.model, free.runs, free.p, free.tolerance
    none = np.zeros(0, dtype=np.int64)
    axes = model.module.AXES
    places = [model.state_names.index(f"{w}_{a}") for w in ("theta", "omega") for a in axes]
    acts = {model.parameter_names.index(TORQUE.format(axis=a)): f for a, f in torques.items()}
    table = [delayed(run.inputs, delays_of(model, p)) for run in runs]
    accuracy = Accuracy(tolerance.relative, tolerance.absolute(model), 1.0)
    states = [np.full((len(run.time), len(model.state_names)), np.nan) for run in runs]
    for found, run, start in zip(states, runs, z, strict=True):
        found[0] = start_state(model, run, p, start, none)[0]
    for k in range(max(len(run.time) for run in runs) - 1):
        going = [r for r, x in enumerate(states) if k + 1 < len(x) and np.all(np.isfinite(x[k]))]
        if not going:
            break
        seen = np.array([[*states[r][k][places], *runs[r].held_inputs[k]] for r in going])
        added = {place: torque(seen) for place, torque in acts.items()}
        for row, r in enumerate(going):
            own = p.copy()
            for place, torque in added.items():
                own[place] += torque[row]
            ends = runs[r].time[k : k + 2]
            stops, x = table[r].with_stops(ends), states[r][k]
            end = integrate(model, None, own, x, table[r], True, stops, ends, accuracy)
            if end.status == DONE:
                states[r][k + 1] = end.x[-1]
    return states
