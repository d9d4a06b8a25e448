"""Results of many runs of one machine: numbers, signals, their derivatives, why runs failed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.api.extras import extra_library
from ptp_symbolic.api.machine import Machine
from ptp_symbolic.errors import unknown
from ptp_symbolic.numeric.simulation.kernels.records import (
    CHATTERING,
    DIVERGED,
    DONE,
    EXHAUSTED,
    OUTSIDE,
    STIFF,
    TOO_FAST,
    UNDECIDED,
)
from ptp_symbolic.numeric.simulation.lanes import IMPOSSIBLE

FloatArray = NDArray[np.float64]

WORDS = {
    DONE: "done",
    IMPOSSIBLE: "impossible",
    DIVERGED: "diverged",
    CHATTERING: "chattering",
    UNDECIDED: "undecided",
    OUTSIDE: "outside",
    EXHAUSTED: "exhausted",
    TOO_FAST: "too fast",
    STIFF: "stiff",
}


@dataclass(frozen=True, eq=False)
class Batch:
    """Results of n runs of `model` at the times `t` [k] in s.

    `batch[name]` is a number per run [n] (a final state, a reduction) or a signal [n, k], in the
    unit `batch.units[name]`; NaN where a run failed. `status` [n] says "done" or why not, `reasons`
    the whole sentence by number of the run; `seeds` [n] are those of the noise, `steps` [n] those
    that were tried, `given` [n] the parameters and initial states that differ between runs.
    `sensitivities` of every output are its derivatives [n, m] or [n, k, m] by the parameters and
    initial states `by` [m], in the unit of the output over theirs.
    """

    model: Machine
    t: FloatArray
    numbers: Mapping[str, FloatArray]
    signals: Mapping[str, FloatArray]
    units: Mapping[str, str]
    given: Mapping[str, FloatArray]
    status: NDArray[np.str_]
    reasons: Mapping[int, str]
    seeds: NDArray[np.int64]
    steps: NDArray[np.int64]
    by: tuple[str, ...] = ()
    sensitivities: Mapping[str, FloatArray] = field(default_factory=dict)

    @property
    def ok(self) -> NDArray[np.bool_]:
        """Whether every run [n] reached its end."""
        return self.status == WORDS[DONE]

    def __len__(self) -> int:
        return len(self.status)

    def __getitem__(self, name: str) -> FloatArray:
        """Numbers [n] or signals [n, k]. Raises KeyError, which lists the names, for another."""
        for values in (self.numbers, self.signals):
            if name in values:
                return values[name]
        raise KeyError(str(unknown("output", name, (*self.numbers, *self.signals))))

    def sensitivity(self, output: str, by: str) -> FloatArray:
        """Derivative of an output by one of `by`: of a number [n], of a signal [n, k].

        Raises KeyError, which lists the names, for others.
        """
        for name, known in ((output, tuple(self.sensitivities)), (by, self.by)):
            if name not in known:
                raise KeyError(str(unknown("sensitivity", name, known)))
        return self.sensitivities[output][..., self.by.index(by)]

    def __repr__(self) -> str:
        failed = int((~self.ok).sum())
        return (
            f"Batch of '{self.model.name}': {len(self)} runs from {self.t[0]:g} to {self.t[-1]:g} s"
            f", {failed} failed; {', '.join((*self.numbers, *self.signals))}"
        )

    def table(self) -> dict[str, NDArray[Any]]:
        """One row per run: what was given, the numbers and their derivatives, "d NUMBER / d NAME",
        status, seed, steps and reason.
        """
        slopes = {
            slope_name(number, by): self.sensitivity(number, by)
            for number in self.numbers
            for by in self.by
        }
        reasons = np.array([self.reasons.get(b, "") for b in range(len(self))], dtype=object)
        own = {"status": self.status, "seed": self.seeds, "steps": self.steps, "reason": reasons}
        return {**self.given, **self.numbers, **slopes, **own}

    def to_pandas(self) -> Any:
        """`table` as a pandas DataFrame. Raises InputError where pandas is not installed."""
        return extra_library("pandas").DataFrame(self.table())

    def to_xarray(self) -> Any:
        """An xarray Dataset over `run` and `time` in s, with the units as attributes.

        Derivatives are called "d OUTPUT by NAME": a slash would be a folder to netCDF and Zarr.
        Raises InputError where xarray is not installed.
        """
        xarray = extra_library("xarray")
        unit = {**self.model.units, **self.units}
        columns: dict[str, Any] = {
            name: ("run", values, {"units": unit[name]} if name in unit else {})
            for name, values in self.table().items()
        }
        columns["reason"] = ("run", np.array(self.table()["reason"], dtype=np.str_), {})
        taken = {n: f"initial {n}" if n in self.signals else _by(n) for n in columns}
        data = {taken[name]: column for name, column in columns.items()}
        data |= {n: (("run", "time"), v, {"units": self.units[n]}) for n, v in self.signals.items()}
        data |= {
            _by(slope_name(name, by)): (("run", "time"), self.sensitivity(name, by), {})
            for name in self.signals
            for by in self.by
        }
        return xarray.Dataset(data, coords={"time": ("time", self.t, {"units": "s"})})


def slope_name(output: str, by: str) -> str:
    """Name of the derivative of an output."""
    return f"d {output} / d {by}"


def _by(name: str) -> str:
    return name.replace(" / d ", " by ")
