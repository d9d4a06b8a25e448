"""Call the functions of an emitted module by address, so that one runner serves every model.

numba passes functions as arguments too, but looks each of them up at every call of the runner,
which takes longer than a short simulation.
"""

from collections.abc import Collection
from functools import lru_cache
from types import ModuleType
from typing import Any

import numpy as np
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
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
