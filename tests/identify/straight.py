"""Finished fits of straight models: residuals and derivatives are given, nothing is simulated."""

from collections.abc import Mapping, Sequence

import numpy as np

import ptp_symbolic
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.evaluate import Evaluation
from ptp_symbolic.numeric.identify.fit import Fit
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.simulation.inputs import constant, stack
from tests.identify.curves import Floats

MODEL = ptp_symbolic.load("ideal")  # a Fit has one; the statistics never ask it for anything


def run_of(samples: int, signals: int = 1, inputs: Floats | None = None, name: str = "run") -> Run:
    """A run of analog signals and `inputs` [k, nu] (default: one zero); all measured is zero."""
    held = np.zeros((samples, 1)) if inputs is None else inputs
    return Run(
        name,
        name.partition("#")[0],
        np.arange(samples) / 50.0,
        stack([constant(0.0)] * held.shape[1]),
        held,
        np.zeros((samples, signals)),
        np.arange(signals),
        np.ones(signals),
        np.full(signals, np.nan),
        tuple(f"y{k}" for k in range(signals)),
        np.zeros(0),
        (),
    )


def finished(
    residuals: Sequence[Floats],
    by_parameter: Sequence[Floats] | None = None,
    by_start: Sequence[Floats] | None = None,
    free: Sequence[FreeParameter] = (),
    values: Mapping[str, float] | None = None,
    inputs: Sequence[Floats] | None = None,
) -> Fit:
    """The fit that leaves `residuals` [k] or [k, ny] per run, their derivatives by the search
    coordinates [k * ny, nf] and by the unknown starts [k * ny, nz] (default: there are none).
    """
    tables = [r.reshape(len(r), -1) for r in residuals]
    none = [np.zeros((r.size, 0)) for r in tables]
    by_parameter = none if by_parameter is None else by_parameter
    by_start = none if by_start is None else by_start
    held = [None] * len(tables) if inputs is None else inputs
    pairs = enumerate(zip(tables, held, strict=True))
    runs = [run_of(*r.shape, u, f"run {k}") for k, (r, u) in pairs]
    ends = [
        Evaluation(r.ravel(), j, s) for r, j, s in zip(tables, by_parameter, by_start, strict=True)
    ]
    cost = float(sum(np.sum(r**2) for r in tables))
    z = tuple(np.zeros(s.shape[1]) for s in by_start)
    return Fit(MODEL, tuple(runs), tuple(free), dict(values or {}), z, cost, tuple(ends))
