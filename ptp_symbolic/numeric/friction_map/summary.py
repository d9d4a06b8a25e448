"""A friction map in words and numbers: the law, its parameters with intervals, what stays open.

The parameters of a friction map as entries of a platform file.

Parameters of a chosen member with intervals by profile likelihood.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import tomlkit
from numpy.typing import NDArray
from scipy.stats import f as fisher

from ptp_symbolic.numeric.friction_map.choice import (
    COULOMB,
    STRIBECK,
    Block,
    Comparison,
    Member,
    choose,
    compare,
    contrasts,
    scan_speeds,
)
from ptp_symbolic.numeric.friction_map.points import Points

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


SCHEMA_VERSION = 1
LARGEST_DIFFERENCE = 0.95  # bound of the effect direction_dependent_friction


def friction_map(points: Points, axis: str, confidence: float) -> dict[str, Any]:
    """The smallest law of steady friction that predicts `points` as well as any other.

    The result is plain data in the SI `units` of the joint: `member`, `parameters` by name for
    `axis`, `by_direction`, `rms`, all `members`, `remarks`, and the `points` with their fitted
    torques; `quantity` says whether these are torques or forces.
    """
    found = compare(points)
    verdict = choose(found)
    member = verdict.member
    estimates = profile(found, member, confidence)
    fitted = found.fitted(member) / found.design.weight
    names = {True: "positive", False: "negative"}
    by_direction = {
        names[sign > 0]: {n: asdict(estimates.linear(w)) for n, w in weights.items()}
        for sign, weights in estimates.weights().items()
    }
    if member.rise == STRIBECK:
        for k, sign in enumerate(estimates.signs):
            if member.only in (0, sign):
                speed = _speed(estimates, k if member.separate else 0)
                by_direction[names[sign > 0]]["v_s"] = asdict(speed)
    own = points.units
    units = {"F_c": own.torque, "F_s": own.torque, "v_s": own.rate, "F_v": own.viscous}
    parameters = {
        f"{name}_{axis}": {**asdict(estimate), "unit": units.get(name, "1")}
        for name, estimate in _parameters(estimates)
    }
    return {
        "schema_version": SCHEMA_VERSION,
        "source": points.name,
        "axis": axis,
        "units": {"rate": own.rate, "torque": own.torque, "viscous": own.viscous},
        "quantity": own.word,
        "confidence": confidence,
        "member": member.title,
        "parts": list(member.parts),
        "parameters": parameters,
        "by_direction": by_direction,
        "rms": _rms(found, member),
        "extra_spread": found.extra,
        "remarks": [*_remarks(found, member, estimates)],
        "members": [
            {
                "member": m.title,
                "parameters": m.size,
                "rms": _root_mean_square(found, m),
                "left_out": _finite(found.prediction(m)),
                "p_value": verdict.p_values.get(m),
            }
            for m in found.possible
        ],
        "points": {
            "rate": points.rate.tolist(),
            "torque": points.torque.tolist(),
            "fitted": fitted.tolist(),
        },
        "curve": _curve(points, estimates),
    }


def _parameters(estimates: Profile) -> Iterator[tuple[str, Estimate]]:
    """Means over the directions, and relative half differences where they are not zero."""
    weights = estimates.weights()
    one = weights[estimates.signs[0]]
    other = weights[estimates.signs[-1]]
    member = estimates.member
    for name in one:
        mean, half = (one[name] + other[name]) / 2.0, (one[name] - other[name]) / 2.0
        yield name, estimates.linear(mean)
        if half.any():
            yield f"a_{name}", estimates.ratio(half, mean)
    if member.separate:
        first, second = estimates.speeds.T
        yield "v_s", estimates.of_speeds((first + second) / 2.0, bounded=True)
        difference = (first - second) / (first + second)
        yield "a_v_s", estimates.of_speeds(difference, bounded=True)
    elif member.rise == STRIBECK:
        yield "v_s", _speed(estimates, 0)


def _speed(estimates: Profile, column: int) -> Estimate:
    found = estimates.speeds[:, column]
    low, high = float(found.min()), float(found.max())
    return Estimate(
        float(found[estimates.best]),
        low if low > estimates.scanned[0] else None,
        high if high < estimates.scanned[-1] else None,
    )


def _curve(points: Points, estimates: Profile) -> dict[str, list[float]]:
    """The law along rates [k] for a plot, the directions one after the other."""
    top = float(np.abs(points.rate).max())
    at = np.linspace(0.0, top, 400)[1:]
    rates, torques = [], []
    for sign in estimates.signs[::-1]:
        values = {
            n: float(w @ estimates.coefficients[estimates.best])
            for n, w in estimates.weights()[sign].items()
        }
        speeds = estimates.speeds[estimates.best]
        speed = speeds[0 if sign > 0 else -1]
        decay = np.exp(-((at / speed) ** 2)) if np.isfinite(speed) else np.zeros(len(at))
        dry = values["F_c"] + (values.get("F_s", values["F_c"]) - values["F_c"]) * decay
        torque = sign * (dry + values.get("F_v", 0.0) * at)
        rates += (sign * at)[::sign].tolist()
        torques += torque[::sign].tolist()
    return {"rate": rates, "torque": torques}


def _root_mean_square(found: Comparison, member: Member) -> float:
    error = found.fitted(member) / found.design.weight - found.points.torque
    return float(np.sqrt(np.mean(error * error)))


def _rms(found: Comparison, member: Member) -> dict[str, float]:
    """Of Coulomb friction alone, of the law, and of the law without its Stribeck curve."""
    rms = {
        "coulomb": _root_mean_square(found, Member("", False)),
        "law": _root_mean_square(found, member),
    }
    if member.rise:
        plain = Member("", member.viscous, member.by_direction & set(Member("", True).parts))
        rms["without_rise"] = _root_mean_square(found, plain)
    return rms


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _remarks(found: Comparison, member: Member, estimates: Profile) -> Iterator[str]:
    """What the points leave open, one sentence each."""
    points, lowest = found.points, float(estimates.scanned[0])
    rate, torque, word = points.units.rate, points.units.torque, points.units.word
    if member == Member("", False):
        yield "No law predicts these points better than Coulomb friction alone."
    if len(estimates.signs) == 1:
        yield (
            f"All points move one way: a difference by direction, and a constant {word} beside"
            " Coulomb friction, are not identifiable; measure the other direction too."
        )
    weights = estimates.weights()
    mean = sum((w["F_c"] for w in weights.values()), 0.0 * weights[estimates.signs[0]]["F_c"])
    low = estimates.linear(mean / len(weights)).low
    if low is not None and low <= 0.0:
        yield "Coulomb friction is not significant: its interval reaches zero."
    if not member.rise:
        at_rest = bool((points.rate == 0.0).any())
        yield (
            f"Static friction does not show: a Stribeck curve that ends below {lowest:.3g} {rate},"
            " the lowest speed, would not; measure slower"
            + ("." if at_rest else f", or add breakaway {word}s as points at rate 0.")
        )
    elif member.rise != STRIBECK:
        yield (
            "The Stribeck speed is not determined: static friction shows at rest alone, so it lies"
            f" below {lowest:.3g} {rate}, the lowest speed."
        )
    elif estimates.speeds.min() <= lowest:
        yield (
            f"The Stribeck speed is not determined downwards: anything below {lowest:.3g} {rate},"
            " the lowest speed, fits; F_s is what the curve reaches there. Measure slower."
        )
    if member.rise == STRIBECK and estimates.speeds.max() >= estimates.scanned[-1]:
        yield (
            f"The Stribeck speed is not determined upwards: {estimates.scanned[-1]:.3g} {rate}, the"
            f" highest speed, fits. The {word} is curved over the whole range; do not extrapolate."
        )
    if COULOMB in member.by_direction:
        yield (
            f"Coulomb friction that differs by direction and a constant {word} on the joint are the"
            " same at steady rates; turn the axis over, or back-drive it, to separate them."
        )
    if found.extra:
        yield (
            f"The {word}s scatter by {found.extra:.2g} {torque} (rms) more than their declared"
            " standard deviations: between the points something else changes."
        )


def platform_fragment(summary: Mapping[str, Any]) -> str:
    """TOML text with the effects and parameters of `summary` (see `friction_map`).

    A law without a rise has F_s tied to F_c. A difference by direction that is larger than its
    effect allows is written as a constant torque on the joint, where it is one of Coulomb friction.
    """
    axis, found, units = summary["axis"], summary["parameters"], summary["units"]
    entries: dict[str, Any] = {
        name: {"value": max(of["value"], 0.0), "unit": of["unit"]}
        for name, of in found.items()
        if not name.startswith("a_")
    }
    rise = f"F_s_{axis}" in entries
    if not rise:
        entries[f"F_s_{axis}"] = {"same_as": f"F_c_{axis}"}
    if rise and f"v_s_{axis}" not in entries:
        lowest = min(abs(rate) for rate in summary["points"]["rate"] if rate)
        entries[f"v_s_{axis}"] = {"value": lowest, "unit": units["rate"]}
    if f"F_v_{axis}" not in entries:
        entries[f"F_v_{axis}"] = {"value": 0.0, "unit": units["viscous"]}
    effects = [{"effect": "csvs_friction", "axis": axis}]
    differences = {n: of["value"] for n, of in found.items() if n.startswith("a_")}
    if max(map(abs, differences.values()), default=0.0) > LARGEST_DIFFERENCE:
        torque = differences.pop(f"a_F_c_{axis}", 0.0) * found[f"F_c_{axis}"]["value"]
        effects.append({"effect": "constant_torque", "axis": axis})
        # what drives the joint against it has the other sign
        entries[f"tau0_{axis}"] = {"value": -torque, "unit": units["torque"]}
        if f"a_F_s_{axis}" in differences:
            static = found[f"F_s_{axis}"]["value"]
            differences[f"a_F_s_{axis}"] -= torque / static
    elif differences and not rise and f"a_F_c_{axis}" in differences:
        entries[f"a_F_s_{axis}"] = {"same_as": f"a_F_c_{axis}"}
    if differences:
        effects.append({"effect": "direction_dependent_friction", "axis": axis})
        entries |= {name: {"value": value} for name, value in differences.items()}
    notes = [f"# {summary['member']}", *(f"# {text}" for text in summary["remarks"])]
    tables = tomlkit.table()
    for name, entry in entries.items():
        tables[name] = tomlkit.inline_table()
        tables[name].update(entry)
    return "\n".join([*notes, tomlkit.dumps({"effects": effects, "parameters": tables})])
