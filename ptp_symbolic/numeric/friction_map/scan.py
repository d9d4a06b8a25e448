"""Least squares of one member: linear at every Stribeck speed of a scan (variable projection)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.friction_map.members import STRIBECK, Member, columns, one_sided

FloatArray = NDArray[np.float64]

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
