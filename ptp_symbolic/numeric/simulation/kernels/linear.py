"""Small dense linear systems: by an explicit inverse, or by LU factors.

A row with its diagonal alone, as a friction at rest has it, is never exchanged: rounding in a
product of such rows would let the rest creep.

Arithmetic on four neighbouring elements of a vector at once.

The rows of a step are so short (four to twelve states) that a compiler's own vector loops would be
little but beginning and end. Rows that are worked on here have room for a multiple of LANES
elements; what is beyond the states stays zero.
"""

from typing import Any

import llvmlite.ir as ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, models, register_model

from ptp_symbolic.numeric.simulation.kernels.records import inlined, kernel

LANES = 4
_VECTOR = ir.VectorType(ir.DoubleType(), LANES)
_DOUBLE_BYTES = 8


def padded(length: int) -> int:
    """The least multiple of LANES that is at least `length`."""
    return -(-length // LANES) * LANES


class _Four(types.Type):
    """Type of four float64 in compiled code."""

    def __init__(self) -> None:
        super().__init__(name="Four")


FOUR = _Four()


@register_model(_Four)
class _FourModel(models.PrimitiveModel):
    def __init__(self, manager: Any, numba_type: Any) -> None:
        super().__init__(manager, numba_type, _VECTOR)


def _place(context: Any, builder: Any, array_type: Any, array: Any, at: Any) -> Any:
    """Pointer to the four elements of a contiguous vector that begin at `at`."""
    data = cgutils.create_struct_proxy(array_type)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [at]), _VECTOR.as_pointer())


@intrinsic
def load(typing_context: Any, vector: Any, at: Any) -> Any:
    """The elements at .. at + 3 of a vector."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        place = _place(context, builder, signature.args[0], *values)
        return builder.load(place, align=_DOUBLE_BYTES)

    return FOUR(vector, types.intp), generate


@intrinsic
def store(typing_context: Any, four: Any, vector: Any, at: Any) -> Any:
    """Put four numbers at .. at + 3 of a vector."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        place = _place(context, builder, signature.args[1], *values[1:])
        builder.store(values[0], place, align=_DOUBLE_BYTES)
        return context.get_dummy_value()

    return types.void(FOUR, vector, types.intp), generate


@intrinsic
def nothing(typing_context: Any) -> Any:
    """Four zeros."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return ir.Constant(_VECTOR, [0.0] * LANES)

    return FOUR(), generate


@intrinsic
def plus_times(typing_context: Any, four: Any, factor: Any, other: Any) -> Any:
    """Four numbers plus a factor times four others (fused multiply-add)."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        factors = ir.Constant(_VECTOR, ir.Undefined)
        for lane in range(LANES):
            where = ir.Constant(ir.IntType(32), lane)
            factors = builder.insert_element(factors, values[1], where)
        product = builder.fmul(factors, values[2], flags=["contract"])
        return builder.fadd(values[0], product, flags=["contract"])

    return FOUR(FOUR, types.float64, FOUR), generate


@inlined
def weighted(weights, row, count, k, e):
    """Elements e .. e + 3 of the sum of the first `count` stages k [8, w] by one row of weights."""
    total = nothing()
    for j in range(count):
        total = plus_times(total, weights[row, j], load(k[j], e))
    return total


@inlined
def add_stages(i, weights, scale, k, out, count):
    """Add the stages k [8, w] before i with row i of their weights, times scale, to the first
    `count` elements of out [w].
    """
    for e in range(0, count, LANES):
        store(plus_times(load(out, e), scale, weighted(weights, i, i, k, e)), out, e)


@inlined
def multiply(columns, vector, added, out):
    """Write the product of the matrix with `columns` [m, w] and vector + added, m of each, into out
    [w].

    The two are added one by one: what has just been stored singly is slow to be loaded in fours.
    """
    for e in range(0, columns.shape[1], LANES):
        total = nothing()
        for j in range(columns.shape[0]):
            total = plus_times(total, vector[j] + added[j], load(columns[j], e))
        store(total, out, e)


@inlined
def add_product(matrix, width, vectors, out):
    """Add the product of matrix [n, n or more] and vectors to out, both by rows of `width` and with
    at least n of them.
    """
    n = matrix.shape[0]
    for a in range(n):
        for c in range(0, width, LANES):
            total = load(out, a * width + c)
            for b in range(n):
                total = plus_times(total, matrix[a, b], load(vectors, b * width + c))
            store(total, out, a * width + c)


@inlined
def add_sparse_product(matrix, n, width, vectors, out):
    """Add the product of a sparse matrix, its first n rows and columns, and vectors to out, both by
    rows of `width`.
    """
    for a in range(n):
        for b in range(n):
            if matrix[a, b] != 0.0:
                add_scaled(matrix[a, b], vectors, b * width, out, a * width, width)


@inlined
def add_scaled(factor, source, first, target, at, count):
    """Add factor times `count` elements of a vector from `first` on to those of another."""
    for e in range(0, count, LANES):
        total = plus_times(load(target, at + e), factor, load(source, first + e))
        store(total, target, at + e)


@inlined
def _is_coupled(a, row):
    """Whether a row has more than its diagonal."""
    coupled = False
    for j in range(a.shape[0]):
        coupled = coupled or (j != row and a[row, j] != 0.0)
    return coupled


@kernel
def invert(fx, rate, a, order, transposed):
    """Write the inverse of rate I - fx [n, n], `rate` in 1/s, into a [n, w] and, transposed, into
    `transposed` [n, w] (Gauss-Jordan, partial pivoting in `order` [n]).

    Eight products follow with every inverse: for a dozen states they cost less than substitutions,
    which wait for one division after the other.
    """
    n, width = a.shape
    for i in range(n):
        for j in range(n):
            a[i, j] = -fx[i, j]
        a[i, i] += rate
    for c in range(n):
        pivot = c
        if _is_coupled(a, c):
            for i in range(c + 1, n):
                if abs(a[i, c]) > abs(a[pivot, c]):
                    pivot = i
        order[c] = pivot
        if pivot != c:
            for j in range(n):
                a[c, j], a[pivot, j] = a[pivot, j], a[c, j]
        scale = 1.0 / a[c, c]
        for e in range(0, width, LANES):
            store(plus_times(nothing(), scale, load(a[c], e)), a[c], e)
        for i in range(n):
            factor = a[i, c]
            if i != c and factor != 0.0:
                add_scaled(-factor, a[c], 0, a[i], 0, width)
                a[i, c] = -factor * scale  # last: four at once are slow to see a single one
        a[c, c] = scale
    for c in range(n - 1, -1, -1):
        if order[c] != c:
            for i in range(n):
                a[i, c], a[i, order[c]] = a[i, order[c]], a[i, c]
    for i in range(n):
        for j in range(n):
            transposed[j, i] = a[i, j]


@kernel
def factor(a, order):
    """Replace a [n, n] by its LU factors, partial pivoting recorded in `order` [n]."""
    n = a.shape[0]
    for k in range(n):
        pivot = k
        if _is_coupled(a, k):
            for i in range(k + 1, n):
                if abs(a[i, k]) > abs(a[pivot, k]):
                    pivot = i
        order[k] = pivot
        if pivot != k:
            for j in range(n):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
        inverse = 1.0 / a[k, k]
        for i in range(k + 1, n):
            if a[i, k] != 0.0:
                a[i, k] *= inverse
                for j in range(k + 1, n):
                    a[i, j] -= a[i, k] * a[k, j]


@kernel
def solve(a, order, b):
    """Replace the right-hand side b [n] by the solution, with the LU factors from `factor`."""
    n = len(b)
    for k in range(n):
        pivot = order[k]
        b[k], b[pivot] = b[pivot], b[k]
    for i in range(1, n):
        for j in range(i):
            b[i] -= a[i, j] * b[j]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            b[i] -= a[i, j] * b[j]
        b[i] /= a[i, i]
