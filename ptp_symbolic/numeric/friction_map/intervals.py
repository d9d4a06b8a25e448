"""Parameters of a chosen member with intervals by profile likelihood."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import f as fisher

from ptp_symbolic.numeric.friction_map.choice import Comparison
from ptp_symbolic.numeric.friction_map.members import Member, contrasts
from ptp_symbolic.numeric.friction_map.scan import Block, scan_speeds

FloatArray = NDArray[np.float64]

REFINED = 160  # speeds between the neighbours of the interval that the coarse scan finds


@dataclass(frozen=True)
class Estimate:
    """A value with its interval; an end is None where the points give none."""

    value: float
    low: float | None
    high: float | None


@dataclass(frozen=True, eq=False)
class Profile:
    """All Stribeck speeds (of both directions, where each has its own) that the points allow.

    For each of them [g]: `speeds` [g, 1 or 2], `coefficients` [g, k], their `covariance` [g, k, k]
    at unit variance, and `room` [g]: by how much the sum of squares may rise. `best` is the index
    of the least sum of squares. `signs` are the directions that were measured.
    """

    member: Member
    signs: tuple[int, ...]
    speeds: FloatArray
    coefficients: FloatArray
    covariance: FloatArray
    room: FloatArray
    best: int
    scanned: FloatArray

    def weights(self) -> dict[int, dict[str, FloatArray]]:
        """F_c, F_s and F_v by direction as weights [k] of the coefficients."""
        if not self.member.separate:
            return {sign: contrasts(self.member, sign) for sign in self.signs}
        alone = contrasts(Member(self.member.rise, self.member.viscous), 1)
        zero = np.zeros(len(alone["F_c"]))
        return {
            sign: {
                n: np.concatenate([w, zero] if sign > 0 else [zero, w]) for n, w in alone.items()
            }
            for sign in self.signs
        }

    def linear(self, weight: FloatArray) -> Estimate:
        """The value of `weight` [k] times the coefficients."""
        value = self.coefficients @ weight
        half = np.sqrt(self.room * self._cross(weight, weight))
        low, high = float((value - half).min()), float((value + half).max())
        return Estimate(float(value[self.best]), low, high)

    def ratio(self, above: FloatArray, below: FloatArray) -> Estimate:
        """The quotient of two such values; its ends are the roots of a quadratic.

        Source: Fieller, J. R. Stat. Soc. B 16 (1954) 175, at every speed of the profile.
        """
        n, d = self.coefficients @ above, self.coefficients @ below
        a = d**2 - self.room * self._cross(below, below)
        b = n * d - self.room * self._cross(above, below)
        c = n**2 - self.room * self._cross(above, above)
        value = float(n[self.best] / d[self.best]) if d[self.best] else math.nan
        if (a <= 0.0).any():
            return Estimate(value, None, None)
        root = np.sqrt(np.maximum(b * b - a * c, 0.0))
        return Estimate(value, float(((b - root) / a).min()), float(((b + root) / a).max()))

    def of_speeds(self, values: FloatArray, *, bounded: bool) -> Estimate:
        """The range of a function of the speeds, given as values [g].

        `bounded`: an end of the scan within the interval leaves that end open.
        """
        low, high = float(values.min()), float(values.max())
        below = bounded and bool((self.speeds <= self.scanned[0]).any())
        above = bounded and bool((self.speeds >= self.scanned[-1]).any())
        return Estimate(float(values[self.best]), None if below else low, None if above else high)

    def _cross(self, one: FloatArray, other: FloatArray) -> FloatArray:
        return np.einsum("i,gij,j->g", one, self.covariance, other)


def profile(found: Comparison, member: Member, confidence: float) -> Profile:
    """The profile of the sum of squares of `member` over its Stribeck speeds.

    An interval holds what raises the least sum of squares by no more than the F distribution lets
    chance do. Source: Bates and Watts, Nonlinear Regression Analysis (1988), 6.1.
    """
    scanned = scan_speeds(found.points.rate)
    blocks = found.blocks[member]
    left = found.left(member)
    quantile = float(fisher.ppf(confidence, 1, left)) / left
    allowed = found.rss[member] * quantile
    fine = [_refined(found, block, scanned, allowed) for block in blocks]
    curves = [block.project(found.torque[:, None]) for block in fine]
    rss = [curve[0][:, 0] for curve in curves]
    total = rss[0] if len(rss) == 1 else rss[0][:, None] + rss[1][None, :]
    least = float(total.min())
    kept = np.nonzero(total <= least * (1.0 + quantile))
    size = sum(curve[1].shape[1] for curve in curves)
    coefficients = np.concatenate(
        [curve[1][at, :, 0] for curve, at in zip(curves, kept, strict=True)], axis=1
    )
    covariance = np.zeros((len(kept[0]), size, size))
    start = 0
    for block, at in zip(fine, kept, strict=True):
        inverse = block.inverse[at]
        end = start + inverse.shape[1]
        covariance[:, start:end, start:end] = inverse @ np.swapaxes(inverse, 1, 2)
        start = end
    room = least * (1.0 + quantile) - total[kept]
    speeds = np.stack([b.speeds[at] for b, at in zip(fine, kept, strict=True)], axis=1)
    signs = tuple(s for s in (1, -1) if (found.points.sign == s).any())
    best = int(np.argmax(room))
    return Profile(member, signs, speeds, coefficients, covariance, room, best, scanned)


def _refined(found: Comparison, block: Block, scanned: FloatArray, allowed: float) -> Block:
    """`block` at more speeds: between the scanned ones around those that the points allow."""
    if not np.isfinite(block.speeds).all():
        return block
    rss = block.project(found.torque[:, None])[0][:, 0]
    speeds = scanned
    # twice, because the first time the interval may lie between two scanned speeds
    for _ in range(2):
        at = np.flatnonzero(rss <= rss.min() + allowed)
        low, high = speeds[max(at[0] - 1, 0)], speeds[min(at[-1] + 1, len(speeds) - 1)]
        speeds = np.geomspace(low, high, REFINED)
        block = found.design.block(block.member, block.rows, speeds)
        rss = block.project(found.torque[:, None])[0][:, 0]
    return block
