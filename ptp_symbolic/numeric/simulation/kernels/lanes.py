"""Arithmetic on four neighbouring elements of a vector at once.

The rows of a step are so short (four to twelve states) that a compiler's own vector loops would be
little but beginning and end. Rows that are worked on here have room for a multiple of LANES
elements; what is beyond the states stays zero.
"""

from typing import Any

import llvmlite.ir as ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.extending import intrinsic, register_model

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
