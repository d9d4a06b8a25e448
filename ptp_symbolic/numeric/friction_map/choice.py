"""Which member the points can show: every member is tested against all that are larger."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.stats import f as fisher

from ptp_symbolic.numeric.friction_map.members import Member, all_members
from ptp_symbolic.numeric.friction_map.points import Points
from ptp_symbolic.numeric.friction_map.scan import Block, Design, least_rss, left_out_errors

FloatArray = NDArray[np.float64]

REPLICATES = 999  # of a Monte Carlo test; Davison and Hinkley, Bootstrap Methods (1997), 4.2.5
# Of one test over all larger laws; at 5 % chance alone would refuse the true law in 1 map of 20.
LEVEL = 0.01
BATCH = 111  # replicates at a time; it ends where more of them cannot make the answer "significant"


@dataclass(frozen=True, eq=False)
class Comparison:
    """All members on one set of points.

    `torque` [n] is weighted. `rss` is infinite for a member whose best fit cannot exist; chance may
    still bring it about, so that the tests reckon with it. `extra` is the standard deviation that
    the torques have beside those declared.
    """

    points: Points
    design: Design
    torque: FloatArray
    blocks: Mapping[Member, tuple[Block, ...]]
    rss: Mapping[Member, float]
    extra: float | None

    @property
    def possible(self) -> list[Member]:
        """Members whose best fit is a law that can exist."""
        return [member for member, rss in self.rss.items() if np.isfinite(rss)]

    @cached_property
    def errors(self) -> dict[Member, FloatArray]:
        """Errors [n] of each member, weighted, where it predicts rates that were left out.

        Every torque at rest is left out alone: at rest no other rate tells of static friction.
        """
        count, rate = len(self.torque), self.points.rate
        groups = np.unique(np.where(rate == 0.0, 1j * (1 + np.arange(count)), rate), False, True)[1]
        return {m: left_out_errors(b, self.torque, groups) for m, b in self.blocks.items()}

    def prediction(self, member: Member) -> float:
        """The rms of `errors`, unweighted, in the unit of the torques."""
        scale = np.mean(self.design.weight**2)
        return float(np.sqrt(np.mean(self.errors[member] ** 2) / scale))

    def predicts_better(self, other: Member, member: Member) -> bool:
        """Whether `other` betters the predictions of `member` by more than one standard error.

        Source: Breiman, Friedman, Olshen and Stone, Classification and Regression Trees (1984) 3.4.
        """
        mine, its = self.errors[member] ** 2, self.errors[other] ** 2
        if not (np.isfinite(mine).all() and np.isfinite(its).all()):
            return bool(np.isfinite(its).all())
        gain = mine - its
        return float(gain.mean()) > float(gain.std(ddof=1)) / np.sqrt(len(gain))

    def left(self, member: Member) -> int:
        """Degrees of freedom that `member` leaves."""
        return len(self.torque) - member.size

    def fitted(self, member: Member) -> FloatArray:
        """Weighted torques [n] of the best fit of `member`."""
        found = np.zeros(len(self.torque))
        for block in self.blocks[member]:
            rss, _ = block.project(self.torque[:, None])
            basis = block.basis[int(np.argmin(rss[:, 0]))]
            found[block.rows] = basis @ (basis.T @ self.torque[block.rows])
        return found


def compare(points: Points) -> Comparison:
    """Fit every member that the points determine, each over the whole scan of Stribeck speeds.

    Declared standard deviations and one more that all points share weigh the torques; the shared
    one makes the largest member as good as its degrees of freedom say.
    Source: Mandel and Paule, Anal. Chem. 42 (1970) 1194.
    """
    both = bool((points.sign > 0).any() and (points.sign < 0).any())
    members = all_members(both_directions=both, breakaway=bool((points.rate == 0.0).any()))
    if points.spread is None:
        return _compared(points, members, np.ones(len(points.rate)), None)
    spread = points.spread

    def excess(extra: float) -> float:
        found = _compared(points, members, 1.0 / np.hypot(spread, extra), extra)
        return min(found.rss.values()) - min(map(found.left, found.rss))

    most = float(np.ptp(points.torque))
    extra = brentq(excess, 0.0, most) if excess(0.0) > 0.0 > excess(most) else 0.0
    return _compared(points, members, 1.0 / np.hypot(spread, extra), extra)


def _compared(
    points: Points, members: Sequence[Member], weight: FloatArray, extra: float | None
) -> Comparison:
    design = Design(points.rate, points.sign, weight)
    torque = weight * points.torque
    fits = {m: design.blocks(m) for m in members if len(torque) > m.size}
    blocks = {m: b for m, b in fits.items() if all(block.sound.any() for block in b)}
    rss = {m: float(least_rss(b, torque[:, None])[0]) for m, b in blocks.items()}
    return Comparison(points, design, torque, blocks, rss, extra)


@dataclass(frozen=True)
class Verdict:
    """The smallest member that no larger one betters, and the p-values of those tested."""

    member: Member
    p_values: Mapping[Member, float]


def choose(found: Comparison, level: float = LEVEL, seed: int = 0) -> Verdict:
    """The smallest member that no larger one betters.

    A larger one betters it that predicts left-out rates better by more than one standard error,
    where the larger ones also fit better at `level`, over all of them together. So the true law
    is refused with probability `level` at most, if its scatter is normal. Sources: Marcus, Peritz
    and Gabriel, Biometrika 63 (1976) 655; Westfall and Young, Resampling-Based Multiple Testing
    (1993), least p.
    """
    p_values: dict[Member, float] = {}
    order = sorted(found.possible, key=lambda member: (member.size, found.rss[member]))
    for member in order:
        p_values[member] = _p_value(found, member, level, np.random.default_rng(seed))
        if p_values[member] > level:
            return Verdict(member, p_values)
    return Verdict(order[-1], p_values)


def _p_value(found: Comparison, member: Member, level: float, random: np.random.Generator) -> float:
    """Probability that a larger member betters `member` by as much where it is true."""
    larger = [other for other in found.rss if other.holds(member)]
    if not any(found.predicts_better(other, member) for other in larger):
        return 1.0
    nominal = min(
        float(_nominal(found, member, other, found.rss[member], found.rss[other]))
        for other in larger
    )
    if not member.speeds:
        bound = sum(_bound(found, member, other, nominal) for other in larger)
        if bound <= level:
            return bound
    scatter = np.sqrt(found.rss[member] / found.left(member))
    # where the best law of this size cannot exist, it is on the edge to a smaller one
    inside = [member, *(m for m in found.rss if member.holds(m))]
    as_small, drawn = 0, 0
    while drawn < REPLICATES and 1 + as_small <= level * (1 + REPLICATES):
        noise = scatter * random.standard_normal((len(found.torque), BATCH))
        torques = found.fitted(member)[:, None] + noise
        own = np.min([least_rss(found.blocks[m], torques) for m in inside], axis=0)
        rss = {other: least_rss(found.blocks[other], torques) for other in larger}
        least = np.min([_nominal(found, member, m, own, rss[m]) for m in larger], axis=0)
        as_small += int(np.count_nonzero(least <= nominal))
        drawn += BATCH
    return (1 + as_small) / (1 + drawn)


def _nominal(
    found: Comparison,
    member: Member,
    other: Member,
    own: float | FloatArray,
    rss: float | FloatArray,
) -> FloatArray:
    """p-values of F-tests of `member` in `other`, as if Stribeck speeds were linear parameters."""
    added, left = other.size - member.size, found.left(other)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.where(rss < own, (own / rss - 1.0) * left / added, 0.0)
    return fisher.sf(ratio, added, left)


def _bound(found: Comparison, member: Member, other: Member, nominal: float) -> float:
    """Most that the probability of a nominal p-value as small can be: the sum over the scan.

    For a linear `member`: at each speed `other` is then linear, too, and its F-test exact. There is
    no bound where `other` adds speeds alone.
    """
    added, left = other.size - member.size, found.left(other)
    if added == other.speeds:
        return math.inf
    ratio = fisher.isf(nominal, added, left) * added / left
    scanned = float(np.prod([len(block.speeds) for block in found.blocks[other]]))
    linear, rest = added - other.speeds, left + other.speeds
    return scanned * float(fisher.sf(ratio * rest / linear, linear, rest))
