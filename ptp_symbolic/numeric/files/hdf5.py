"""MATLAB 7.3 files, which are HDF5, read with h5py."""

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import NUMERIC, Part, lacking
from ptp_symbolic.numeric.files.structures import Leaf, Objects, part_of

MOST_CHARACTERS = 1000  # of a text that names a signal


def hdf5_parts(path: Path) -> Sequence[Part]:
    """The vectors and matrices of numbers, as `structures` names them.

    A group that holds itself is walked once. Links to other files and data that lie in other files
    are left out. Raises InputError where h5py is not installed, and whatever h5py raises.
    """
    try:
        import h5py
    except ImportError as error:
        raise InputError(lacking(path, "MATLAB 7.3", "h5py", "matlab")) from error
    file = h5py.File(path, "r")
    objects: Objects = []
    return part_of(_tree(file, {_address(file)}, "", objects), objects)


def _tree(group: Any, walked: set[Any], where: str, objects: Objects) -> dict[str, Any]:
    tree: dict[str, Any] = {}
    for name, item in _items(group):
        if isinstance(item, type(group.file["/"])):
            if _address(item) not in walked:
                walked.add(_address(item))
                tree[name] = _tree(item, walked, f"{where}{name}.", objects)
        elif "MATLAB_object_decode" in item.attrs:
            objects.append(f"{where}{name}")
        elif _is_numeric(item):
            # MATLAB counts the first index fastest, HDF5 the last
            tree[name] = Leaf(tuple(reversed(item.shape)), partial(_transposed, item))
        elif _text(item.attrs.get("MATLAB_class")) == "char" and item.size <= MOST_CHARACTERS:
            tree[name] = "".join(map(chr, item[()].ravel()))
    return tree


def _items(group: Any) -> Iterator[tuple[str, Any]]:
    """What a group holds within its file, but for what MATLAB keeps for itself."""
    for name in group:
        link = group.get(name, getlink=True)
        if name.startswith("#") or hasattr(link, "filename"):
            continue
        try:
            item = group[name]
        except KeyError:  # a link that leads nowhere
            continue
        if hasattr(item, "keys") or hasattr(item, "shape"):
            yield name, item


def _transposed(item: Any) -> Any:
    return item[()].T


def _is_numeric(item: Any) -> bool:
    if item.shape is None or item.dtype.kind not in NUMERIC:
        return False
    if item.is_virtual or item.external or "MATLAB_empty" in item.attrs:
        return False
    return _text(item.attrs.get("MATLAB_class")) not in ("char", "cell", "function_handle")


def _address(group: Any) -> tuple[int, int]:
    from h5py import h5o

    found = h5o.get_info(group.id)
    return found.fileno, found.addr


def _text(value: Any) -> str:
    return value.decode(errors="replace") if isinstance(value, bytes) else str(value or "")
