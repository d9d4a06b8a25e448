"""Which member the points can show: every member is tested against all that are larger.

The nested members of the law of steady friction, as columns of a linear fit.

Least squares of one member: linear at every Stribeck speed of a scan (variable projection).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, combinations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.stats import f as fisher

from ptp_symbolic.numeric.friction_map.points import Points

FloatArray = NDArray[np.float64]


COULOMB, STATIC, STRIBECK, VISCOUS = "Coulomb", "static", "Stribeck", "viscous"
SPEED = "Stribeck speed"


@dataclass(frozen=True)
class Member:
    """One law: Coulomb friction, and what it has besides.

    `rise` is "" (none), STATIC (seen in breakaway torques alone, without a curve) or STRIBECK.
    `by_direction` are the parts that differ between positive and negative rate. `only` is +1 or -1
    where the rise is there in that direction alone, else 0.
    """

    rise: str
    viscous: bool
    by_direction: frozenset[str] = frozenset()
    only: int = 0

    @property
    def parts(self) -> tuple[str, ...]:
        """The parts of friction that the law has."""
        return (COULOMB, *([self.rise] * bool(self.rise)), *([VISCOUS] * self.viscous))

    @property
    def separate(self) -> bool:
        """Whether the directions share nothing, so that each is a fit of its own."""
        return SPEED in self.by_direction

    @property
    def speeds(self) -> int:
        """How many Stribeck speeds the law has."""
        return (2 if self.separate else 1) if self.rise == STRIBECK else 0

    @property
    def size(self) -> int:
        """Number of parameters."""
        return len(self.parts) + len(self.by_direction - {SPEED}) + self.speeds

    @property
    def title(self) -> str:
        """The law in words."""
        law = " + ".join(self.parts)
        differing = ", ".join(p for p in self.parts if p in self.by_direction)
        remarks = ["all by direction"] if self.separate else [f"{differing} by direction"]
        remarks = remarks if self.by_direction else []
        if self.only:
            remarks.append(
                f"{self.rise} at {'positive' if self.only > 0 else 'negative'} rate only"
            )
        return "; ".join([law, *remarks])

    def holds(self, other: "Member") -> bool:
        """Whether `other` is this law with some parameters at zero or equal by direction.

        Static friction without a curve is the limit of a Stribeck speed of zero.
        """
        rise = other.rise in ("", self.rise) or (other.rise == STATIC and self.rise == STRIBECK)
        named = {STRIBECK if part == STATIC else part for part in self.by_direction}
        inner = {STRIBECK if part == STATIC else part for part in other.by_direction}
        if self.only == 0 and other.only and other.rise:
            inner |= {STRIBECK}
        side = not other.rise or self.only in (0, other.only)
        return self != other and rise and side and other.viscous <= self.viscous and inner <= named


def all_members(*, both_directions: bool, breakaway: bool) -> tuple[Member, ...]:
    """All members, the smallest first; `breakaway`: there are torques at rest."""
    found = []
    for rise in ("", STATIC, STRIBECK) if breakaway else ("", STRIBECK):
        for viscous in (False, True):
            parts = Member(rise, viscous).parts if both_directions else ()
            sizes = (combinations(parts, k) for k in range(len(parts) + 1))
            found += [Member(rise, viscous, frozenset(s)) for s in chain.from_iterable(sizes)]
            if rise and both_directions:
                others = (frozenset(m.by_direction) for m in found[-(2 ** len(parts)) :])
                found += [
                    Member(rise, viscous, s, only)
                    for s in others
                    if rise not in s
                    for only in (1, -1)
                ]
            if rise == STRIBECK and both_directions:
                found.append(Member(rise, viscous, frozenset((*parts, SPEED))))
    return tuple(sorted(found, key=lambda member: member.size))


def columns(member: Member, rate: FloatArray, sign: FloatArray, decay: FloatArray) -> FloatArray:
    """Columns [..., n, k] of `member` at `rate` [n] in direction `sign` [n] (+1 or -1).

    `decay` [..., n] is the Stribeck curve, 1 at rest. The order is Coulomb, its half difference,
    rise, viscous; a rise or a viscous part that differs has a column for each direction, so that
    none of their coefficients is negative in a law that exists.
    """
    shape = decay.shape
    found = [np.broadcast_to(sign, shape)]
    if COULOMB in member.by_direction:
        found.append(np.ones(shape))
    rise = sign * decay * (sign == member.only if member.only else 1.0)
    for part, column in ((member.rise, rise), (VISCOUS, np.broadcast_to(rate, shape))):
        if part and part in member.parts:
            if part in member.by_direction:
                found += [column * (sign > 0), column * (sign < 0)]
            else:
                found.append(column)
    return np.stack(found, axis=-1)


def one_sided(member: Member) -> NDArray[np.bool_]:
    """Which coefficients of `columns` [k] must not be negative.

    The Coulomb torque beside a rise must not: a negative one would be a static friction that
    falls below zero. Without a rise its sign is left to the data.
    """
    free = [not member.rise] + [True] * (COULOMB in member.by_direction)
    parts = [part for part in member.parts if part != COULOMB]
    return ~np.array(free + [False] * sum(1 + (p in member.by_direction) for p in parts))


def contrasts(member: Member, direction: int) -> dict[str, FloatArray]:
    """F_c, F_s and F_v in `direction` (+1 or -1) as weights [k] of the coefficients of `columns`.

    F_s is there with a rise only, F_v with a viscous part only.
    """
    weights: list[tuple[str, float]] = [("F_c", 1.0)]
    if COULOMB in member.by_direction:
        weights.append(("F_c", float(direction)))
    for part, name in ((member.rise, "rise"), (VISCOUS, "F_v")):
        if part and part in member.parts:
            if part in member.by_direction:
                weights += [(name, float(direction > 0)), (name, float(direction < 0))]
            else:
                there = name == "F_v" or member.only in (0, direction)
                weights.append((name, float(there)))
    found = {
        name: np.array([weight if of == name else 0.0 for of, weight in weights])
        for name in dict(weights)
    }
    if "rise" in found:
        found["F_s"] = found["F_c"] + found.pop("rise")
    return found


# Neighbouring curves of a scan differ by at most 2/e of this step, 7 % of the rise.
SCAN_STEP = np.log(10.0) / 24.0
SMALLEST_PIVOT = np.sqrt(np.finfo(float).eps)  # of a column of unit length: less is dependent


@dataclass(frozen=True, eq=False)
class Block:
    """A linear fit of `rows` [m] of the points at every one of `speeds` [g], weighted.

    `basis` [g, m, k] is orthonormal, `triangle` [g, k, k] upper triangular, `sound` [g] says where
    the columns are independent. Without a Stribeck curve g is 1 and the speed NaN.
    Source: Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973): the projected problem.
    """

    member: Member
    rows: NDArray[np.int64]
    speeds: FloatArray
    basis: FloatArray
    triangle: FloatArray
    sound: NDArray[np.bool_]

    def project(self, torque: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Sums of squares [g, r] and coefficients [g, k, r] for weighted torques [n, r].

        The sum is infinite where the law cannot exist: it is then that of a smaller member.
        """
        y = torque[self.rows]
        along = np.swapaxes(self.basis, 1, 2) @ y
        square = (y * y).sum(axis=0)
        # the difference of two squares is known to their rounding
        rss = np.maximum(square - (along * along).sum(axis=1), np.finfo(float).eps * square)
        coefficients = self.inverse @ along
        possible = (coefficients[:, one_sided(self.member)] >= 0.0).all(axis=1)
        return np.where(possible & self.sound[:, None], rss, np.inf), coefficients

    @cached_property
    def inverse(self) -> FloatArray:
        """Inverse [g, k, k] of `triangle`; zero where the columns depend."""
        safe = np.where(self.sound[:, None, None], self.triangle, np.eye(self.triangle.shape[1]))
        return np.where(self.sound[:, None, None], np.linalg.inv(safe), 0.0)

    def left_out(self, torque: FloatArray, groups: NDArray[np.int64]) -> FloatArray:
        """Errors [m] of weighted `torque` [n] predicted from all rows of other `groups` [n].

        The speed is chosen anew each time; the rest follows in closed form from the whole fit.
        Infinite where a group cannot be left out.
        """
        y, own = torque[self.rows], groups[self.rows]
        whole, _ = self.project(torque[:, None])
        residual = y - (self.basis @ (np.swapaxes(self.basis, 1, 2) @ y)[:, :, None])[:, :, 0]
        errors = np.full(len(y), np.inf)
        for group in np.unique(own):
            at = np.flatnonzero(own == group)
            part = self.basis[:, at]
            rest = np.eye(len(at)) - part @ np.swapaxes(part, 1, 2)
            sound = np.isfinite(whole[:, 0]) & (np.linalg.det(rest) > SMALLEST_PIVOT)
            if not sound.any():
                continue
            error = np.linalg.solve(rest[sound], residual[sound][:, at, None])[:, :, 0]
            rss = whole[sound, 0] - (residual[sound][:, at] * error).sum(axis=1)
            errors[at] = error[np.argmin(rss)]
        return errors


def scan_speeds(rate: FloatArray) -> FloatArray:
    """Stribeck speeds [g] that points at `rate` [n] in rad/s can show: from the lowest speed,
    below which a curve touches no point that moves, to the highest, above which it is a parabola.
    """
    moving = np.abs(rate[rate != 0.0])
    low, high = moving.min(), moving.max()
    return np.geomspace(low, high, 2 + int(np.log(high / low) / SCAN_STEP))


@dataclass(frozen=True, eq=False)
class Design:
    """Where points were taken, and how they are weighted.

    `rate` [n] in rad/s, `sign` [n], `weight` [n]: square roots of the weights of least squares.
    """

    rate: FloatArray
    sign: FloatArray
    weight: FloatArray

    def block(self, member: Member, rows: NDArray[np.int64], speeds: FloatArray) -> Block:
        """The fit of `member` to `rows` [m] at `speeds` [g] in rad/s."""
        rate, sign = self.rate[rows], self.sign[rows]
        if member.rise == STRIBECK:
            decay = np.exp(-((rate / speeds[:, None]) ** 2))
        else:
            speeds, decay = np.full(1, np.nan), (rate == 0.0)[None].astype(float)
        table = columns(member, rate, sign, decay) * self.weight[rows][:, None]
        count, size = table.shape[1:]
        if count < size:
            none = np.zeros(len(speeds), dtype=bool)
            triangle = np.broadcast_to(np.eye(size), (len(speeds), size, size))
            return Block(member, rows, speeds, np.zeros_like(table), triangle, none)
        basis, triangle = np.linalg.qr(table)
        length = np.linalg.norm(table, axis=1)
        pivots = np.abs(np.diagonal(triangle, axis1=1, axis2=2))
        sound = (pivots > SMALLEST_PIVOT * length).all(axis=1)
        return Block(member, rows, speeds, basis, triangle, sound)

    def blocks(self, member: Member, speeds: FloatArray | None = None) -> tuple[Block, ...]:
        """One fit of all points, or one of each direction where these share nothing."""
        if speeds is None:
            speeds = scan_speeds(self.rate)
        if not member.separate:
            return (self.block(member, np.arange(len(self.rate)), speeds),)
        alone = Member(member.rise, member.viscous)
        return tuple(self.block(alone, np.flatnonzero(self.sign == s), speeds) for s in (1, -1))


def least_rss(blocks: tuple[Block, ...], torque: FloatArray) -> FloatArray:
    """Least sums of squares [r] over the scan, for weighted torques [n, r]; infinite for none."""
    return np.sum([block.project(torque)[0].min(axis=0) for block in blocks], axis=0)


def left_out_errors(
    blocks: tuple[Block, ...], torque: FloatArray, groups: NDArray[np.int64]
) -> FloatArray:
    """Errors [n] of weighted `torque` [n], each group of `groups` [n] predicted from the others."""
    errors = np.full(len(torque), np.inf)
    for block in blocks:
        errors[block.rows] = block.left_out(torque, groups)
    return errors


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
