"""Fit the free parameters of a model to several runs at once."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import NOTHING
from ptp_symbolic.numeric.identify.coordinates import FreeParameter, slopes, to_search
from ptp_symbolic.numeric.identify.evaluate import Evaluation, Tolerance, mean_squares
from ptp_symbolic.numeric.identify.evidence import Deferred, is_recording, key_of, stored
from ptp_symbolic.numeric.identify.least_squares import Shift, minimise
from ptp_symbolic.numeric.identify.requirements import nearest_possible
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_starts import fitted_starts, starts_in_place
from ptp_symbolic.numeric.identify.simulations import (
    DEFAULT_TOLERANCE,
    Effort,
    Simulations,
    all_values,
    problem_of,
    simulations_of,
)
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Fit:
    """A fit: parameter `values` (all of the model), start unknowns `z` and evaluations per run.

    `shaken` are, per run, changes [k * ny, replays] of the residual by noise of the inputs, without
    what the start unknowns can take up; none where they were not looked for.
    """

    model: Model
    runs: tuple[Run, ...]
    free: tuple[FreeParameter, ...]
    values: Mapping[str, float]
    z: tuple[FloatArray, ...]
    cost: float
    evaluations: Sequence[Evaluation]
    failed: str | None = None
    tolerance: Tolerance = DEFAULT_TOLERANCE
    misleading: tuple[Shift, ...] | None = None
    shaken: Sequence[FloatArray] = ()

    def rms_counts(self) -> float:
        """Root mean square of the residual of all encoder signals, in counts (see `run_counts`)."""
        squares = np.concatenate([run_counts(r, e) for r, e in self.pairs()])
        return float(np.sqrt(np.mean(squares**2)))

    def pairs(self) -> list[tuple[Run, Evaluation]]:
        """Runs with their evaluations."""
        return list(zip(self.runs, self.evaluations, strict=True))


def run_counts(run: Run, evaluation: Evaluation) -> FloatArray:
    """Residuals [k * ne] of the encoder signals in counts; without one, of all in sigmas."""
    residual = evaluation.residual.reshape(run.measured.shape)
    in_counts = residual / run.weight / run.counts
    encoders = np.isfinite(run.counts)
    return (in_counts[:, encoders] if encoders.any() else residual).ravel()


def fit_parameters(
    model: Model,
    runs: Sequence[Run],
    free: Sequence[FreeParameter],
    fixed: Mapping[str, float],
    z: Sequence[FloatArray] | None = None,
    effort: Effort | None = None,
    executor: Executor | None = None,
    misleading: Sequence[Shift] | None = None,
    earlier: Fit | None = None,
) -> Fit:
    """Fit `free` from their starts; all other parameters stay at `fixed`. Derivatives known to be
    `misleading` from an earlier fit of the same parameters are replaced from the first step on.
    Where this fit begins at the end of an `earlier` one, that is not simulated again.

    With no free parameter only the start unknowns of every run are fitted, which is how validation
    runs are judged. Places in a gap are looked for where no starts `z`, each [nz], are given.
    Raises InputError for `fixed` values out of bounds.
    """
    effort = effort or Effort()

    def ended() -> _End:
        return _ended(model, runs, free, fixed, z, effort, executor, misleading, earlier)

    if not is_recording():
        return ended().fit
    given = model, tuple(runs), tuple(free), fixed, z, effort, misleading
    key = key_of("fit", *given, None if earlier is None else earlier.evaluations)
    found = stored(key, ended, _End.light)
    kept, make = found.light, None
    if found.made is not None:
        fit = found.made.fit
    else:
        fit, make = _of_light(kept, model, runs, free, fixed, effort, executor, earlier)
    evaluations = Deferred(key, len(runs), make, kept["squares"], fit.evaluations)
    return replace(fit, evaluations=evaluations)


@dataclass(frozen=True, eq=False)
class _End:
    """A fit, the search coordinates phi [nf] where it ended, and whether it is `unmoved`: it has
    the evaluations of the earlier fit from whose end it began.
    """

    fit: Fit
    phi: FloatArray
    unmoved: bool = False

    def light(self) -> dict[str, Any]:
        """What is recorded of it: no evaluations but their mean squares."""
        fit = self.fit
        return {
            "phi": self.phi,
            "unmoved": self.unmoved,
            "z": fit.z,
            "cost": fit.cost,
            "failed": fit.failed,
            "misleading": fit.misleading,
            "squares": mean_squares(fit.evaluations, fit.runs),
        }


def _of_light(
    kept: Mapping[str, Any],
    model: Model,
    runs: Sequence[Run],
    free: Sequence[FreeParameter],
    fixed: Mapping[str, float],
    effort: Effort,
    executor: Executor | None,
    earlier: Fit | None,
) -> tuple[Fit, Callable[[], Sequence[Evaluation]]]:
    """The fit of which `_End.light` was recorded, and what makes its evaluations."""
    values = {**fixed, **all_values(free, kept["phi"])} if free else dict(fixed)

    def evaluations() -> Sequence[Evaluation]:
        if kept["unmoved"] and earlier is not None:
            return _by_coordinates(earlier, free)
        base = fixed if free else values
        simulations = simulations_of(model, runs, free, base, effort, executor)
        return simulations.evaluate(kept["phi"], kept["z"], True)

    fit = Fit(
        model,
        tuple(runs),
        tuple(free),
        values,
        kept["z"],
        kept["cost"],
        (),
        kept["failed"],
        effort.tolerance,
        kept["misleading"],
    )
    return fit, evaluations


def _ended(
    model: Model,
    runs: Sequence[Run],
    free: Sequence[FreeParameter],
    fixed: Mapping[str, float],
    z: Sequence[FloatArray] | None,
    effort: Effort,
    executor: Executor | None,
    misleading: Sequence[Shift] | None,
    earlier: Fit | None,
) -> _End:
    """See `fit_parameters`."""
    if not free:
        known = [[]] * len(runs) if z is None else [[start] for start in z]
        starts = fitted_starts(model, runs, fixed, known, effort, executor)
        fit = Fit(
            model,
            tuple(runs),
            (),
            dict(fixed),
            tuple(s.z[0] for s in starts),
            float(sum(s.cost for s in starts)),
            tuple(s.evaluations[0] for s in starts),
            next((s.failed for s in starts if s.failed), None),
            effort.tolerance,
        )
        return _End(fit, np.zeros(0))
    simulations = simulations_of(model, runs, free, fixed, effort, executor)
    problem = problem_of(simulations, effort)
    if problem.refine is not None and misleading is not None:
        problem.refine.chosen = list(misleading)
    phi = to_search(free, {f.name: f.start for f in free})
    phi = nearest_possible(model, free, simulations.parameters, phi)
    values = {**fixed, **all_values(free, phi)}
    if z is None:
        guesses = [run.guess for run in runs]
        z = starts_in_place(model, runs, values, guesses, effort.tolerance, executor, brief=True)
    begun = None
    if earlier is not None and _ends_at(earlier, simulations, values, z):
        begun = _by_coordinates(earlier, free)
    best = minimise(problem, phi, z, effort.iterations, effort.gain, effort.rejections, begun)
    values = {**fixed, **all_values(free, best.phi)}
    chosen = None if problem.refine is None else problem.refine.chosen
    fit = Fit(
        model,
        tuple(runs),
        tuple(free),
        values,
        tuple(best.z),
        best.cost,
        tuple(best.evaluations),
        best.failed,
        effort.tolerance,
        None if chosen is None else tuple(chosen),
    )
    return _End(fit, best.phi, begun is not None and best.evaluations[0] is begun[0])


def _ends_at(
    fit: Fit, simulations: Simulations, values: Mapping[str, float], z: Sequence[FloatArray]
) -> bool:
    """Whether a fit ends at the parameter `values` and the starts z, each [nz], and has simulated
    there, by the same parameters, what `simulations` would.
    """
    return (
        not fit.failed
        and fit.tolerance == simulations.tolerance
        and [f.name for f in fit.free] == [f.name for f in simulations.free]
        and len(fit.runs) == len(simulations.runs)
        and all(a is b for a, b in zip(fit.runs, simulations.runs, strict=True))
        and all(np.array_equal(a, b) for a, b in zip(fit.z, z, strict=True))
        and all(abs(values[n] - v) <= NOTHING * abs(v) for n, v in fit.values.items())
    )


def _by_coordinates(fit: Fit, free: Sequence[FreeParameter]) -> list[Evaluation]:
    """The evaluations of a fit with Jacobians by the coordinates of `free`, its own parameters."""
    own, new = (slopes(f, to_search(f, fit.values)) for f in (fit.free, free))
    return [replace(e, by_parameter=e.by_parameter * (new / own)) for e in fit.evaluations]
