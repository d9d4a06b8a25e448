"""The solution of normal equations within the box that one step may reach."""

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.constants import LARGEST_STEP, WIDE_STEP

FloatArray = NDArray[np.float64]

SHARE_TO_BOUND = -np.expm1(-LARGEST_STEP)  # of the way there in one step


def reach(distance: FloatArray) -> FloatArray:
    """How far one step may go [nf] towards bounds at `distance` [nf].

    A parameter that one step takes from its start to zero takes the others to where no step leads
    back: the share is that of an interior point method (Coleman and Li, 1996).
    """
    share = np.where(distance > WIDE_STEP, SHARE_TO_BOUND, 1.0)
    return np.minimum(LARGEST_STEP, share * distance)


def box(
    phi: FloatArray, lower: FloatArray, upper: FloatArray, logarithmic: NDArray[np.bool_] | bool
) -> tuple[FloatArray, FloatArray]:
    """How far down and up one step may go [nf] from phi [nf], as `taken` takes it."""
    down, up = -reach(phi - lower), reach(upper - phi)
    return (
        np.where(logarithmic, np.expm1(down), down),
        np.where(logarithmic, np.expm1(up), up),
    )


def taken(phi: FloatArray, step: FloatArray, logarithmic: NDArray[np.bool_] | bool) -> FloatArray:
    """The search coordinates after a step [nf], which is straight in the values, whose logarithms
    some coordinates are: an inertia and the damping beside it trade places along a straight valley,
    and one that bends allows short steps only.
    """
    share = np.where(logarithmic, step, 0.0)
    return phi + np.where(logarithmic, np.log1p(share), step)


def limited_step(
    matrix: FloatArray, right: FloatArray, size: FloatArray, low: FloatArray, high: FloatArray
) -> FloatArray:
    """Solve matrix @ step = right with low <= step <= high [nf]; `size` scales them [nf].

    The one that wants furthest beyond is fixed there and the others solved anew: scaling all alike
    would let a parameter on its way to zero stop the rest.
    """
    step, moves = np.zeros(len(right)), np.ones(len(right), dtype=np.bool_)
    matrix, right = matrix / np.outer(size, size), right / size
    while moves.any():
        rest = right[moves] - matrix[np.ix_(moves, ~moves)] @ (size * step)[~moves]
        found = np.linalg.lstsq(matrix[np.ix_(moves, moves)], rest, rcond=1e-14)[0]
        step[moves] = found / size[moves]
        allowed = np.clip(step, low, high)
        worst = int(np.argmax(np.abs(step - allowed)))
        if step[worst] == allowed[worst]:
            break
        step[worst] = allowed[worst]
        moves[worst] = False
    return step
