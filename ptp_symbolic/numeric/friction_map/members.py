"""The nested members of the law of steady friction, as columns of a linear fit."""

from dataclasses import dataclass
from itertools import chain, combinations

import numpy as np
from numpy.typing import NDArray

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
