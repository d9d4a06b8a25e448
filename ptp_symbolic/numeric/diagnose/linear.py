"""Linear algebra at a fit: what an effect changes in the residuals, projected off what others
follow.
"""

from collections.abc import Collection, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import lsq_linear

from ptp_symbolic.numeric.identify.blocks import SINGULAR
from ptp_symbolic.numeric.identify.constants import SAME
from ptp_symbolic.numeric.identify.coordinates import slopes, to_search
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.intervals import project_out

FloatArray = NDArray[np.float64]


def stacked(fit: Fit, columns: Sequence[FloatArray]) -> FloatArray:
    """Columns [k, c] of every run below one another [n, c], projected off its start unknowns."""
    pairs = zip(columns, fit.evaluations, strict=True)
    return np.vstack([project_out(c, e.by_start) for c, e in pairs])


def stacked_residual(fit: Fit) -> FloatArray:
    """The weighted residual [n] of all runs, projected off their starts."""
    return stacked(fit, [e.residual[:, None] for e in fit.evaluations])[:, 0]


def stacked_jacobian(fit: Fit) -> FloatArray:
    """Its derivatives by the search coordinates [n, nf], projected likewise."""
    return stacked(fit, [e.by_parameter for e in fit.evaluations])


def effect_of(fit: Fit, vanishing: Mapping[str, float], table: FloatArray) -> FloatArray:
    """Linear prediction of what parameters change in the residuals [n] at the fit against their
    values in `vanishing`: `table` [n, nf] is the Jacobian by the search coordinates.
    """
    unit = slopes(fit.free, to_search(fit.free, fit.values))
    effect = np.zeros(len(table))
    for k, f in enumerate(fit.free):
        if f.name in vanishing:
            effect += table[:, k] / unit[k] * (fit.values[f.name] - vanishing[f.name])
    return effect


def made_up_for(
    fit: Fit, vanishing: Mapping[str, float], kept: Collection[str], table: FloatArray
) -> dict[str, float]:
    """Values of the fit with parameters at their values in `vanishing`, and with others, `kept`,
    where they make up for that, by linear prediction; `table` is that of `effect_of`.

    They move by what that predicts in their units, not in search coordinates: what an effect adds
    to an inertia is a sum. Parameters that the logs hardly tell apart move together.
    """
    own = [k for k, f in enumerate(fit.free) if f.name in kept]
    columns, unit = table[:, own], slopes(fit.free, to_search(fit.free, fit.values))
    size = np.linalg.norm(columns, axis=0)
    size[size == 0.0] = 1.0
    steps, *_ = np.linalg.lstsq(columns / size, effect_of(fit, vanishing, table), SAME)
    values = {**fit.values, **vanishing}
    for k, step in zip(own, steps / size, strict=True):
        f = fit.free[k]
        moved = float(np.clip(fit.values[f.name] + unit[k] * step, f.lower, f.upper))
        values.update(dict.fromkeys(f.names, moved))
    return values


def left_beside(fit: Fit, effect: FloatArray, kept: Collection[str], table: FloatArray) -> float:
    """Sum of squares of what is left of an `effect` [n] once parameters `kept` do of it what they
    can within their bounds, by linear prediction; `table` is that of `effect_of`.
    """
    own = [k for k, f in enumerate(fit.free) if f.name in kept]
    whole = float(effect @ effect)
    if not own or whole == 0.0:
        return whole
    unit = slopes(fit.free, to_search(fit.free, fit.values))
    size = np.linalg.norm(table[:, own], axis=0)
    size[size == 0.0] = 1.0
    room = [(fit.free[k], fit.values[fit.free[k].name], unit[k]) for k in own]
    lower = np.array([min((f.lower - v) / u, 0.0) for f, v, u in room]) * size
    upper = np.array([max((f.upper - v) / u, 0.0) for f, v, u in room]) * size
    slack = SINGULAR * np.sqrt(whole)
    basis, triangle = np.linalg.qr(table[:, own] / size)
    steps = lsq_linear(triangle, basis.T @ effect, (lower - slack, upper + slack)).x
    return float(np.sum((effect - basis @ (triangle @ steps)) ** 2))


def projected_off(columns: FloatArray, away: FloatArray) -> FloatArray:
    """Projection of `columns` [n, k] onto the orthogonal complement of those of `away` [n, m]."""
    size = np.linalg.norm(away, axis=0)
    kept = away[:, size > 0.0] / size[size > 0.0]
    if not kept.shape[1]:
        return columns
    left, values, _ = np.linalg.svd(kept, full_matrices=False)
    basis = left[:, values > SINGULAR * values[0]]
    return np.asarray(columns - basis @ (basis.T @ columns))


def canonical_correlation(target: FloatArray, columns: FloatArray) -> float:
    """Largest correlation, 0 to 1, of `target` [n] with any combination of `columns` [n, k]."""
    size = np.linalg.norm(columns, axis=0)
    kept = columns[:, size > 0.0] / size[size > 0.0]
    if not kept.shape[1] or not np.any(target):
        return 0.0
    left, values, _ = np.linalg.svd(kept, full_matrices=False)
    basis = left[:, values > SINGULAR * values[0]]
    return float(np.linalg.norm(basis.T @ target) / np.linalg.norm(target))
