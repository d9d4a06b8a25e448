"""MATLAB files of version 4 to 7, read with SciPy."""

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.files.content import NUMERIC, Part
from ptp_symbolic.numeric.files.hdf5 import Leaf, hdf5_parts, part_of

_HDF5 = b"\x89HDF\r\n\x1a\n"
_HDF5_AT = (0, 512)  # MATLAB puts a text of 512 bytes in front
_NUMBERS = {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
_NUMBERS |= {"double", "single", "logical"}


def parts(path: Path) -> Sequence[Part]:
    """The vectors and matrices of numbers, as `structures` names them; version 7.3 as `hdf5` does.

    A structure is read as a whole. Raises whatever the libraries raise.
    """
    with path.open("rb") as file:
        begin = file.read(520)
    if any(begin[k : k + 8] == _HDF5 for k in _HDF5_AT):
        return hdf5_parts(path)
    from scipy.io import whosmat

    tree: dict[str, Any] = {}
    try:
        listed = whosmat(path)
    except TypeError:  # SciPy cannot list a file with an object that MATLAB alone can read
        return _with_objects(path)
    for name, shape, kind in listed:
        if kind in _NUMBERS:
            tree[name] = Leaf(tuple(shape), partial(_load, path, name))
        elif kind == "struct":
            tree[name] = _fields(_load(path, name))
    return part_of(tree, [name for name, _, kind in listed if kind == "object"])


def _with_objects(path: Path) -> Sequence[Part]:
    """Everything, read at once; objects are left out, and have lost their names."""
    from scipy.io import loadmat

    found = loadmat(path, simplify_cells=True)
    return part_of(
        {n: _fields(v) for n, v in found.items() if n != "None" and not n.startswith("__")}, [""]
    )


def _load(path: Path, name: str) -> Any:
    from scipy.io import loadmat

    return loadmat(path, variable_names=[name], simplify_cells=True)[name]


def _fields(value: Any) -> Any:
    """A structure as mappings, arrays of structures as lists, arrays of numbers as leaves."""
    if isinstance(value, Mapping):
        return {str(name): _fields(field) for name, field in value.items()}
    if isinstance(value, list) or (isinstance(value, np.ndarray) and value.dtype.kind == "O"):
        return [_fields(element) for element in np.asarray(value, dtype=object).ravel()]
    if isinstance(value, np.ndarray) and value.dtype.kind in NUMERIC:
        return _leaf(value)
    return value if isinstance(value, str) else None


def _leaf(values: NDArray[Any]) -> Leaf:
    return Leaf(values.shape, lambda: values)
