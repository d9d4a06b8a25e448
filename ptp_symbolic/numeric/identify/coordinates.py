"""The coordinates in which a fit searches, and its inequality constraints.

Coordinates are logarithms where zero is out of bounds, else scaled values. A constraint is a
relation that the machine needs, such as a breakaway that is not below sliding friction.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import ROUNDS, SAME
from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]


SMALLEST_SHARE = SAME * SAME  # of a scale; from which on a logarithm begins


@dataclass(frozen=True)
class FreeParameter:
    """A parameter to be fitted: start, bounds, period and scale in its unit; `tied` follow its
    value.

    `declared_start` is the value that the platform declares to start from; None for a parameter of
    an effect that is only searched for.
    """

    name: str
    start: float
    lower: float
    upper: float
    period: float | None = None
    tied: tuple[str, ...] = ()
    logarithmic: bool = False
    scale: float = 1.0
    declared_start: float | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """Its name and those of the parameters tied to it."""
        return (self.name, *self.tied)


def free_parameter(
    name: str,
    start: float,
    lower: float,
    upper: float,
    period: float | None = None,
    tied: tuple[str, ...] = (),
) -> FreeParameter:
    """Choose the coordinate: logarithmic where zero is out of bounds; the others can reach it."""
    logarithmic = lower > 0.0
    scale = abs(start) if start != 0.0 else min(1.0, 0.1 * (upper - lower))
    return FreeParameter(name, start, lower, upper, period, tied, logarithmic, scale)


def to_search(free: Sequence[FreeParameter], values: Mapping[str, float]) -> FloatArray:
    """Search coordinates [nf] of parameter values, dimensionless."""
    return np.array(
        [
            np.log(max(values[f.name], SMALLEST_SHARE * f.start) / f.start)
            if f.logarithmic
            else values[f.name] / f.scale
            for f in free
        ]
    )


def to_values(free: Sequence[FreeParameter], phi: FloatArray) -> dict[str, float]:
    """Parameter values of search coordinates phi [nf], within their bounds to the last bit."""
    given = [
        f.start * np.exp(v) if f.logarithmic else f.scale * v
        for f, v in zip(free, phi, strict=True)
    ]
    return {f.name: float(np.clip(v, f.lower, f.upper)) for f, v in zip(free, given, strict=True)}


def slopes(free: Sequence[FreeParameter], phi: FloatArray) -> FloatArray:
    """Derivative of every parameter value by its search coordinate phi [nf], in its unit."""
    values = to_values(free, phi)
    return np.array([values[f.name] if f.logarithmic else f.scale for f in free])


def limits(free: Sequence[FreeParameter]) -> tuple[FloatArray, FloatArray]:
    """Bounds of the search coordinates, each [nf]."""
    low, high = [], []
    for f in free:
        if f.logarithmic:
            low.append(np.log(max(f.lower, SMALLEST_SHARE * f.start) / f.start))
            high.append(np.log(f.upper / f.start))
        else:
            low.append(f.lower / f.scale)
            high.append(f.upper / f.scale)
    return np.array(low), np.array(high)


def wrapped(free: FreeParameter, value: float) -> float:
    """The value of a periodic parameter in (-period/2, period/2]."""
    if free.period is None:
        return value
    return float(value - free.period * np.ceil(value / free.period - 0.5))


Allow = Callable[[FloatArray, FloatArray], FloatArray]

NUDGE = SAME * SAME  # search coordinates; step of difference quotients, and past a boundary


def keep_possible(
    model: Model, free: Sequence[FreeParameter], parameters: Callable[[FloatArray], FloatArray]
) -> Allow:
    """Return a function that projects a step from phi to trial [nf], so that no relation that the
    machine needs is broken: up to the boundary, then along the active constraint, and only in the
    coordinates that the relation is about (gradient projection: Rosen, 1960).

    `parameters(phi)` gives all parameters [np]. A relation broken at phi already is let be.
    """
    relations = _relations(model, free, parameters)

    def allow(phi: FloatArray, trial: FloatArray) -> FloatArray:
        for relation in relations:
            if relation.holds(phi) and not relation.holds(trial):
                trial = relation.bent(phi, trial)
        return trial

    return allow


def nearest_possible(
    model: Model,
    free: Sequence[FreeParameter],
    parameters: Callable[[FloatArray], FloatArray],
    phi: FloatArray,
) -> FloatArray:
    """Return `phi` [nf], projected onto the boundary of every relation that is broken there."""
    for relation in _relations(model, free, parameters):
        if not relation.holds(phi):
            phi = relation.entered(phi)
    return phi


def _relations(
    model: Model, free: Sequence[FreeParameter], parameters: Callable[[FloatArray], FloatArray]
) -> list["_Relation"]:
    """The relations of a model that `free` parameters can break."""
    relations, bounds = [], limits(free)
    for row, (names, _, strict) in enumerate(model.module.REQUIREMENTS):
        about = np.array([bool({f.name, *f.tied} & set(names)) for f in free], dtype=np.bool_)
        if about.any():
            relations.append(_Relation(model, parameters, row, strict, about, bounds))
    return relations


@dataclass(frozen=True, eq=False)
class _Relation:
    """One relation between parameters; `about` [nf] marks the coordinates that it concerns."""

    model: Model
    parameters: Callable[[FloatArray], FloatArray]
    row: int
    strict: bool
    about: NDArray[np.bool_]
    bounds: tuple[FloatArray, FloatArray]

    def margin(self, phi: FloatArray) -> float:
        found = np.zeros(len(self.model.module.REQUIREMENTS))
        self.model.module.margins(self.parameters(phi), found)
        return float(found[self.row])

    def holds(self, phi: FloatArray) -> bool:
        by = self.margin(phi)
        return by > 0.0 if self.strict else by >= 0.0

    def gradient(self, phi: FloatArray) -> FloatArray:
        """Derivatives [nf] of the margin."""
        slope = np.zeros(len(phi))
        for i in np.flatnonzero(self.about):
            ahead = phi.copy()
            ahead[i] += NUDGE
            slope[i] = (self.margin(ahead) - self.margin(phi)) / NUDGE
        return slope

    def boundary(self, phi: FloatArray, step: FloatArray) -> FloatArray:
        """The farthest point along `step` at which the relation still holds."""
        kept, lost = 0.0, 1.0
        for _ in range(ROUNDS):  # to 1e-12 of the step
            middle = 0.5 * (kept + lost)
            kept, lost = (middle, lost) if self.holds(phi + middle * step) else (kept, middle)
        return phi + kept * step

    def at_bound(self, phi: FloatArray, step: FloatArray) -> NDArray[np.bool_]:
        """Which coordinates [nf] a bound keeps from going the way of `step`."""
        lower, upper = self.bounds
        return ((phi <= lower) & (step < 0.0)) | ((phi >= upper) & (step > 0.0))

    def bent(self, phi: FloatArray, trial: FloatArray) -> FloatArray:
        """`trial` with the coordinates of the relation moved to the boundary and along it."""
        step = np.where(self.about, trial - phi, 0.0)
        boundary = self.boundary(phi, step)
        rest, slope = phi + step - boundary, self.gradient(boundary)
        rest -= _inward(slope) * min(0.0, float(slope @ rest))
        there = self.entered(np.clip(boundary + rest, *self.bounds))
        return np.where(self.about, there if self.holds(there) else boundary, trial)

    def entered(self, phi: FloatArray) -> FloatArray:
        """The nearest point at which the relation holds, within the bounds; where Newton's steps
        along the gradient find none, the last one that they reach.
        """
        for _ in range(ROUNDS):
            if self.holds(phi):
                break
            by, slope = self.margin(phi), self.gradient(phi)
            inward = _inward(np.where(self.at_bound(phi, slope), 0.0, slope))
            phi = np.clip(phi + inward * (NUDGE * abs(by) - by), *self.bounds)
        return phi


def _inward(slope: FloatArray) -> FloatArray:
    """The shortest step [nf] that gains a margin of one where its derivatives are `slope` [nf]."""
    return slope / max(float(slope @ slope), 1e-300)
