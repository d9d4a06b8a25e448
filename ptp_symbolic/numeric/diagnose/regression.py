"""The rows of the equation space as one linear regression on the declared parameters and the
signatures of all candidates, with Huber's weights.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.signatures import Signature
from ptp_symbolic.numeric.identify.constants import CYCLES
from ptp_symbolic.numeric.identify.coordinates import FreeParameter
from ptp_symbolic.numeric.identify.equation_fit import (
    blocks_in_time,
    huber_weight,
    robust_scale,
)

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def block_numbers(run: IntArray, time: FloatArray) -> IntArray:
    """The number [n] of the block of every row, as `blocks_in_time` tells them apart."""
    _, number = np.unique(blocks_in_time(run, time), axis=0, return_inverse=True)
    return np.asarray(number.reshape(-1), dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Regression:
    """Rows [n] to be regressed on `base` [n, nb], the columns of the `declared` parameters, and on
    the columns of the signatures.

    `scale` [n] is the standard deviation of every row, `weight` [n] its weight in the fit,
    `equation` [n] its equation, `block` [n, 2] the block of time that it belongs to (see
    `blocks_in_time`).
    """

    rows: FloatArray
    declared: tuple[FreeParameter, ...]
    base: FloatArray
    signatures: tuple[Signature, ...]
    equation: IntArray
    block: IntArray
    weight: FloatArray
    scale: FloatArray


def regression(
    rows: FloatArray,
    declared: Sequence[FreeParameter],
    base: FloatArray,
    found: Sequence[Signature],
    equation: IntArray,
    block: IntArray,
    weight: FloatArray,
) -> Regression:
    """The regression with weights [n] from the residual of the declared model, begun at `weight`;
    the other arguments are those of `Regression`.
    """
    start = Regression(
        rows,
        tuple(declared),
        base,
        tuple(found),
        equation,
        block,
        weight,
        np.ones(len(rows)),
    )
    return reweighted(start, ())


def reweighted(found: Regression, candidates: Sequence[Candidate]) -> Regression:
    """`found` with Huber's weights and scales from the residual of a set of `candidates`: twice as
    many rounds as fits take, which cost more, settle the weights to a percent.
    """
    own = [s.columns for s in found.signatures if s.candidate in candidates]
    columns = np.column_stack([found.base, *own])
    weight, scale = found.weight, found.scale
    for _ in range(2 * CYCLES):
        left = found.rows - columns @ _amounts(columns, found.rows, weight)
        scale = robust_scale(left, found.equation)
        weight = huber_weight(left, scale)
    return replace(found, weight=weight, scale=scale)


def untold(found: Regression) -> list[FreeParameter]:
    """Declared parameters of which all rows, with all others known, tell less than their start
    does, which may be off by its scale. Rows overlap: those of a block in one equation count as
    one.
    """
    counted = np.column_stack([found.equation, found.block])
    overlap = len(counted) / len(np.unique(counted, axis=0))
    told = np.linalg.norm(found.base * np.sqrt(found.weight / overlap)[:, None], axis=0)
    return [f for f, size in zip(found.declared, told, strict=True) if size * f.scale < 1.0]


def remainder(found: Regression, beside: Sequence[Signature] = ()) -> FloatArray:
    """Residual rows [n] of the regression on the declared parameters and the signatures `beside`
    them.
    """
    columns = np.column_stack([found.base, *(s.columns for s in beside)])
    return found.rows - columns @ _amounts(columns, found.rows, found.weight)


def _amounts(columns: FloatArray, rows: FloatArray, weight: FloatArray) -> FloatArray:
    root = np.sqrt(weight)
    size = np.maximum(np.linalg.norm(columns * root[:, None], axis=0), 1e-300)
    scaled = columns * root[:, None] / size
    return np.linalg.lstsq(scaled, rows * root, rcond=1e-6)[0] / size
