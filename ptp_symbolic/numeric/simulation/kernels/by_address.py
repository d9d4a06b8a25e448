"""Records that kernels pass on by address.

A record holds up to twenty arrays, each of which a compiled function takes as seven or nine
arguments: hundreds of them at every call, which take most of the time of a compiler and some of a
run. Here the record stays in the frame of the runner that makes it, and kernels get its address;
fields are read from there as they are from the record itself, and cannot be changed.
"""

from typing import Any

import llvmlite.ir as ir
from numba import types
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    infer_getattr,
    intrinsic,
    lower_getattr_generic,
    models,
    register_model,
)


class Placed(types.Type):
    """Type of the address of a record, in compiled code."""

    def __init__(self, record: Any) -> None:
        self.record = record
        super().__init__(name=f"Placed({record})")


def placed(record: type[Any], fields: Any) -> Placed:
    """Type of the address of a `record` whose fields have the types of the tuple type `fields`."""
    return Placed(types.BaseTuple.from_types(fields.types, record))


@register_model(Placed)
class _PlacedModel(models.PrimitiveModel):
    def __init__(self, manager: Any, placed: Placed) -> None:
        super().__init__(manager, placed, ir.IntType(8).as_pointer())


@infer_getattr
class _Fields(AttributeTemplate):
    key = Placed

    def generic_resolve(self, placed: Placed, name: str) -> Any:
        if name not in placed.record.fields:
            return None
        return placed.record.types[placed.record.fields.index(name)]


@lower_getattr_generic(Placed)
def _read(context: Any, builder: Any, placed: Placed, value: Any, name: str) -> Any:
    kind = context.get_value_type(placed.record).as_pointer()
    zero, field = (ir.Constant(ir.IntType(32), k) for k in (0, placed.record.fields.index(name)))
    return builder.load(builder.gep(builder.bitcast(value, kind), [zero, field]))


@intrinsic
def place(typing_context: Any, record: Any) -> Any:
    """The address of a copy of `record`, which lasts as long as the function that asks for it."""

    def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        with builder.goto_entry_block():
            copy = builder.alloca(context.get_value_type(record))
        builder.store(values[0], copy)
        return builder.bitcast(copy, ir.IntType(8).as_pointer())

    return Placed(record)(record), generate
