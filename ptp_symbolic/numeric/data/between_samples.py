"""What a signal was between its samples: by cubics, not over lost samples, and not over jumps."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.data.continuity import MEDIAN_TO_SIGMA, after_lost, jumps

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.intp]

SAME_TIME = 1e-6  # of a sampling period: what rounding may leave between equal times
NEXT, OVER_NEXT = (-1, 0, 1, 2), (-3, -1, 1, 3)  # the samples around a time, around a sample
MOST_SCATTER = 1.1  # of a cubic over that of samples; at the ends of parts it is up to 1.09
NOISY = 5.0  # standard deviations that noise seldom reaches
WIDER = 2.0  # sampling periods between the samples that foretell one


@dataclass(frozen=True, eq=False)
class Samples:
    """`values` [n] at `time` [n] in s; those of an encoder have the resolution `count`."""

    time: FloatArray
    values: FloatArray
    count: float | None = None

    @cached_property
    def part(self) -> IntArray:
        """The number [n] of the part of every sample: parts begin after lost samples and jumps."""
        breaks = after_lost(self.time)
        if self.count is not None:
            breaks = np.union1d(breaks, jumps(self.values, self.time, self.count))
        begins = np.zeros(len(self.time), dtype=np.intp)
        begins[breaks] = 1
        return np.cumsum(begins)

    def places(self, clock: FloatArray) -> IntArray | None:
        """Index of the sample at every time of `clock` [k], None where one lies between samples."""
        nearest = self._nearest(clock)
        return nearest if bool(np.all(self._is_at(nearest, clock))) else None

    def is_known(self, clock: FloatArray) -> NDArray[np.bool_]:
        """Whether there is a sample at every time of `clock` [k], or on either side in one part."""
        after = np.clip(np.searchsorted(self.time, clock), 1, len(self.time) - 1)
        is_inside = (clock >= self.time[0]) & (clock <= self.time[-1])
        same = self.part[after - 1] == self.part[after]
        return self._is_at(self._nearest(clock), clock) | (is_inside & same)

    def at(self, clock: FloatArray) -> FloatArray:
        """The values at the times of `clock` [k], each of which `is_known`.

        Of the samples themselves where there is one at each time, else of the cubics through four
        samples around (Lagrange); of straight lines where a cubic would scatter more than samples
        do, next to one that came early or late, and in parts of less than four. At a sampling
        period h a cubic is off by h^4/43 of the fourth derivative at most, at the ends of parts by
        h^4/24; where an acceleration jumps, as friction turns, by h^2/28 of the jump.
        """
        at = self.places(clock)
        if at is not None:
            return self.values[at]
        before = np.clip(np.searchsorted(self.time, clock, side="right") - 1, 0, len(self.time) - 2)
        first = np.searchsorted(self.part, self.part[before], side="left")
        last = np.searchsorted(self.part, self.part[before], side="right") - 1
        is_long = last - first >= len(NEXT) - 1
        middle = np.minimum(np.maximum(before, first + 1), last - 2)
        middle = np.clip(middle, 1, len(self.time) - 3)
        found, scatter = self._cubics(middle, NEXT, clock)
        straight = np.interp(clock, self.time, self.values)
        return np.where(is_long & (scatter <= MOST_SCATTER), found, straight)

    @cached_property
    def uncertainty(self) -> float:
        """How far cubics are off where the motion changes suddenly, beyond noise, to a factor of a
        few: half of how far each sample is off a cubic through those one and three periods away.
        These are twice as far apart, which doubles the error where a rate jumps, and quadruples it
        where an acceleration does.
        """
        own = np.arange(-OVER_NEXT[0], len(self.time) - OVER_NEXT[-1])
        own = own[self.part[own + OVER_NEXT[0]] == self.part[own + OVER_NEXT[-1]]]
        found, scatter = self._cubics(own, OVER_NEXT, self.time[own])
        off = np.abs(found - self.values[own])[scatter <= MOST_SCATTER]
        if not len(off):
            return 0.0
        noise = NOISY * MEDIAN_TO_SIGMA * float(np.median(off))
        return max(float(off.max()) - noise, 0.0) / WIDER

    def _cubics(
        self, middle: IntArray, around: tuple[int, ...], clock: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Values [k] at the times of `clock` [k] of the cubics through the samples `around` each of
        `middle` [k], and how much more they scatter than samples that do so independently.
        """
        nodes = middle[:, None] + np.array(around)
        times = self.time[nodes]
        weights = np.ones(times.shape)
        for own in range(len(around)):
            for other in range(len(around)):
                if other != own:
                    weights[:, own] *= clock - times[:, other]
                    weights[:, own] /= times[:, own] - times[:, other]
        values = np.sum(weights * self.values[nodes], axis=1)
        return values, np.sqrt(np.sum(weights**2, axis=1))

    def _nearest(self, clock: FloatArray) -> IntArray:
        return np.searchsorted(0.5 * (self.time[1:] + self.time[:-1]), clock)

    def _is_at(self, nearest: IntArray, clock: FloatArray) -> NDArray[np.bool_]:
        rounding = SAME_TIME * float(np.median(np.diff(self.time)))
        return np.abs(self.time[nearest] - clock) <= rounding
