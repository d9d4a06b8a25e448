"""Types of the emitted functions, so that one compiled runner serves every model."""

from numba import types

_FLOAT = types.float64
_VECTOR = types.float64[::1]
_MATRIX = types.float64[:, ::1]
_AT = (_FLOAT, _VECTOR, _VECTOR, _VECTOR, _VECTOR)

MODE_DERIVATIVE = types.FunctionType(types.void(*_AT, _VECTOR))
JACOBIAN = types.FunctionType(types.void(*_AT, _MATRIX, _MATRIX, _MATRIX))
GUARDS = types.FunctionType(types.void(*_AT, _VECTOR))
GUARD_JACOBIAN = types.FunctionType(types.void(*_AT, _MATRIX, _MATRIX))
ENERGY = types.FunctionType(types.void(*_AT, _VECTOR))
