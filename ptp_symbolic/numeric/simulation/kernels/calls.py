"""Call the functions of an emitted module by address, so that one runner serves every model.

numba passes functions as arguments too, but looks each of them up at every call of the runner,
which takes longer than a short simulation.

Records that kernels pass on by address.

A record holds up to twenty arrays, each of which a compiled function takes as seven or nine
arguments: hundreds of them at every call, which take most of the time of a compiler and some of a
run. Here the record stays in the frame of the runner that makes it, and kernels get its address;
fields are read from there as they are from the record itself, and cannot be changed.
"""

from collections.abc import Collection
from functools import lru_cache
from types import ModuleType
from typing import Any

import llvmlite.ir as ir
import numpy as np
from numba import types
from numba.core import cgutils
from numba.core.typing.templates import AttributeTemplate
from numba.extending import (
    infer_getattr,
    intrinsic,
    lower_getattr_generic,
    models,
    register_model,
)
from numpy.typing import NDArray

_AT = (types.float64, *[types.float64[::1]] * 4)  # t, x, u, p, m
_VECTOR, _MATRIX = types.float64[::1], types.float64[:, ::1]
_WRITES_VECTOR = types.void(*_AT, _VECTOR)
SIGNATURES = {
    "prepared_derivative": types.void(*_AT, _VECTOR, _VECTOR),
    "linearize": types.void(*_AT, *[_MATRIX] * 5),
    "guards": _WRITES_VECTOR,
    "energy": _WRITES_VECTOR,
}
SAMPLER_SIGNATURES = {
    "sample": _WRITES_VECTOR,
    "sample_jacobian": types.void(*_AT, _MATRIX, _MATRIX, _MATRIX),
}
OUTPUT_SIGNATURES = {
    "outputs": types.void(*_AT[:-1], _VECTOR),
    "output_jacobian": types.void(*_AT[:-1], _MATRIX, _MATRIX),
}
DERIVATIVE, LINEARIZE, GUARDS, ENERGY = range(4)
IMPACT_SIGNATURES = {
    "impacts": _WRITES_VECTOR,
    "impact_jacobian": types.void(*_AT, _MATRIX, _MATRIX),
}

CALLED = [
    signature
    for own in (SIGNATURES, IMPACT_SIGNATURES, SAMPLER_SIGNATURES, OUTPUT_SIGNATURES)
    for signature in own.values()
]
OF_TANGENTS = ("impact_jacobian",)


@lru_cache(maxsize=256)
def addresses(module: ModuleType, tangents: bool = True) -> NDArray[np.int64]:
    """Addresses [6] of the compiled functions of an emitted module, in the order above.

    A module without rigid contacts has no impacts, and zeros as their addresses; so have functions
    that runs without `tangents` never call, which are not compiled for them.

    The module keeps the functions alive, and the cache keeps the module.
    """
    idle = () if tangents else OF_TANGENTS
    return compiled_addresses(module, SIGNATURES | IMPACT_SIGNATURES, idle)


@lru_cache(maxsize=256)
def smooth_addresses(module: ModuleType, ledger: bool) -> NDArray[np.int64]:
    """Addresses [2] of `prepared_derivative` and `energy` of an emitted module, the latter 0, and
    not compiled, without a `ledger`.
    """
    wanted = {name: SIGNATURES[name] for name in ("prepared_derivative", "energy")}
    return compiled_addresses(module, wanted, () if ledger else ("energy",))


@lru_cache(maxsize=256)
def sampler_addresses(module: ModuleType) -> NDArray[np.int64]:
    """Addresses [2] of `sample` and `sample_jacobian` of a module with samplers."""
    return compiled_addresses(module, SAMPLER_SIGNATURES)


@lru_cache(maxsize=256)
def output_addresses(module: ModuleType) -> NDArray[np.int64]:
    """Addresses [2] of `outputs` and `output_jacobian` of an emitted module."""
    return compiled_addresses(module, OUTPUT_SIGNATURES)


def compiled_addresses(
    module: ModuleType, signatures: dict[str, Any], idle: Collection[str] = ()
) -> NDArray[np.int64]:
    """Address of the compiled function of every name in `signatures`; 0 for an impact function that
    the module does not have, and for those that are `idle`.
    """
    found = []
    for name, signature in signatures.items():
        if name in idle or (name in IMPACT_SIGNATURES and name not in vars(module)):
            found.append(0)
            continue
        compiled = getattr(module, name).get_compile_result(signature)
        name_there = compiled.fndesc.llvm_func_name
        found.append(compiled.library.get_pointer_to_function(name_there))
    return np.array(found, dtype=np.int64)


@intrinsic
def call(typing_context: Any, address: Any, *arguments: Any) -> Any:
    """Call the compiled function at `address` with (t, x, u, p, m, outputs...), m where it asks,
    and before the output the prepared subexpressions where it asks for them.

    Raises TypeError, when it is compiled, for arguments that no emitted function takes.
    """
    signature = types.void(*arguments)
    if signature not in CALLED:
        raise TypeError(f"no emitted function takes {signature}")

    def generate(context: Any, builder: Any, _: Any, values: Any) -> Any:
        pointer_type = context.call_conv.get_function_type(types.void, arguments).as_pointer()
        function = builder.inttoptr(values[0], pointer_type)
        given = cgutils.unpack_tuple(builder, values[1])
        context.call_conv.call_function(builder, function, types.void, arguments, given)
        return context.get_dummy_value()

    return types.void(address, types.StarArgTuple(arguments)), generate


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
