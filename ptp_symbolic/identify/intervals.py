"""Confidence intervals that allow for residuals correlated in time.

The residuals of a simulation error fit are never white: the covariance is a sandwich whose middle
sums the score over blocks of time (Liang and Zeger, 1986), the unknown starts projected out.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.identify.coordinates import FreeParameter, slopes, to_search, wrapped
from ptp_symbolic.identify.fit import Fit

FloatArray = NDArray[np.float64]

BLOCK_SECONDS = 1.0
UNIDENTIFIED = 1.0
LOST_SHARE, INVOLVED = 1e-10, 1e-3
WIDEST = 30.0  # of a logarithm


@dataclass(frozen=True)
class Estimate:
    """A fitted value with its 95 % interval; SI. `identified` is False where the interval is wider
    than the value itself, or the data do not see the parameter at all: then the interval is that of
    its bounds. `only_with` names parameters of which the data see a combination alone, such as the
    sum of two viscous frictions in one joint.
    """

    name: str
    value: float
    lower: float
    upper: float
    at_bound: bool
    identified: bool
    only_with: tuple[str, ...] = ()


def estimates(fit: Fit) -> tuple[Estimate, ...]:
    """Values of the free parameters of `fit` with 95 % intervals."""
    if not fit.free:
        return ()
    covariance, degrees, lost = sandwich(fit)
    reach = float(stats.t.ppf(0.975, max(degrees, 1)))
    spreads = reach * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    units = np.abs(slopes(fit.free, to_search(fit.free, fit.values)))
    involved = np.any(lost**2 > INVOLVED, axis=0)
    result = []
    for index, free in enumerate(fit.free):
        value = wrapped(free, fit.values[free.name])
        partners: tuple[str, ...] = ()
        if involved[index].any():
            others = np.flatnonzero(involved[:, involved[index]].any(axis=1))
            partners = tuple(fit.free[i].name for i in others if i != index)
            spreads[index] = np.inf
        low, high, width = _interval(free, value, float(spreads[index]), float(units[index]))
        near = 1e-4 * max(abs(free.start), abs(value))
        at_bound = value - free.lower <= near or free.upper - value <= near
        seen = bool(np.isfinite(width) and width < UNIDENTIFIED)
        result.append(Estimate(free.name, value, low, high, bool(at_bound), seen, partners))
    return tuple(result)


def _interval(
    free: FreeParameter, value: float, spread: float, unit: float
) -> tuple[float, float, float]:
    """Ends of the interval of `spread` search coordinates about `value`, `unit` each, within the
    bounds and one period; and its half width as a share of the value.
    """
    half = spread * unit if np.isfinite(spread) else np.inf
    low, high = value - half, value + half
    if free.logarithmic and spread < WIDEST:
        low, high = value * np.exp(-spread), value * np.exp(spread)
    width = spread if free.logarithmic else half / max(abs(value), 1e-300)
    if free.period is None:
        return float(max(low, free.lower)), float(min(high, free.upper)), width
    ends = max(low, value - free.period / 2), min(high, value + free.period / 2)
    return float(ends[0]), float(ends[1]), width


def sandwich(fit: Fit) -> tuple[FloatArray, int, FloatArray]:
    """Covariance [nf, nf] of the search coordinates, the degrees of freedom of its blocks, and the
    directions [2, nf, lost] that the data do not see, in coordinates scaled by what the data see of
    each alone, and in those of the search; it leaves these out.
    """
    nf = len(fit.free)
    bread, middle, blocks = np.zeros((nf, nf)), np.zeros((nf, nf)), 0
    for run, e in fit.pairs():
        projected = project_out(e.by_parameter, e.by_start)
        bread += projected.T @ projected
        ny = run.measured.shape[1]
        edges = np.arange(run.time[0], run.time[-1] + BLOCK_SECONDS, BLOCK_SECONDS)
        of_row = np.repeat(np.searchsorted(edges, run.time, side="right"), ny)
        for block in np.unique(of_row):
            rows = of_row == block
            score = projected[rows].T @ e.residual[rows]
            middle += np.outer(score, score)
            blocks += 1
    inverse, lost = _inverse(bread)
    correction = blocks / max(blocks - nf, 1)
    white = inverse * max(1.0, fit.cost / max(sum(r.size for r in fit.runs), 1))
    robust = correction * inverse @ middle @ inverse
    larger = np.maximum(np.diag(robust), np.diag(white))
    scale = np.sqrt(larger / np.maximum(np.diag(robust), 1e-300))
    return robust * np.outer(scale, scale), blocks - nf, lost


def _inverse(information: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Inverse [nf, nf] where there is information, and the directions [2, nf, lost] without.

    A parameter that the data hardly see takes part in a lost direction by little once it is scaled
    by that, and by much as it is.
    """
    size = np.sqrt(np.diag(information))
    unit = np.where(size > 0.0, size, 1.0)
    shares, directions = np.linalg.eigh(information / np.outer(unit, unit))
    kept = shares > LOST_SHARE * max(shares[-1], 1e-300)
    seen = directions[:, kept] / unit[:, None]
    lost = directions[:, ~kept] / unit[:, None]
    lost /= np.maximum(np.linalg.norm(lost, axis=0), 1e-300)
    return seen / shares[kept] @ seen.T, np.stack([directions[:, ~kept], lost])


def project_out(jacobian: FloatArray, nuisance: FloatArray) -> FloatArray:
    """The part of `jacobian` [k, nf] orthogonal to the columns of `nuisance` [k, nz]."""
    if nuisance.shape[1] == 0:
        return jacobian
    basis, triangle = np.linalg.qr(nuisance)
    kept = np.abs(np.diag(triangle)) > 1e-10 * max(np.max(np.abs(triangle)), 1e-300)
    basis = basis[:, kept]
    return jacobian - basis @ (basis.T @ jacobian)
