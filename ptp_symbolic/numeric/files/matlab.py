"""MATLAB files of version 4 to 7, read with SciPy.

MATLAB 7.3 files, which are HDF5, read with h5py.

Names of the columns within MATLAB variables: vectors, matrices and structures of them.

Known structures are those of Simulink ("Structure With Time": time, and signals with values and
labels) and of dSPACE ControlDesk (X with the times, Y with a name and data of every signal).
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import NUMERIC, WIDEST, Column, Part, lacking, one_by_one

Objects = list[str]  # names of what only MATLAB can read; empty where the file has none
Named = Iterator[tuple[str, str, "Leaf"]]  # short name, full name, numbers
SIMULATED = "tout"  # the times of a simulation, which Simulink gives in s
_PORTS = ("In", "Out")
_SIGNS = str.maketrans({"[": "(", "]": ")", ",": ";", '"': None})


@dataclass(frozen=True)
class Leaf:
    """An array of numbers of the given shape, which `load` returns."""

    shape: tuple[int, ...]
    load: Callable[[], NDArray[Any]]
    unit: str | None = None


def part_of(tree: Mapping[str, Any], objects: Objects) -> list[Part]:
    """The columns of the variables in `tree`: mappings are structures, lists arrays of structures.

    A column has the name of its field where no other has it, else with its structure before it; a
    matrix has a column for each of its own, such as `yout_2`, as `splitvars` of MATLAB names them.
    Numbers alone are no columns.
    """
    found: dict[str, tuple[Leaf, int | None]] = {}
    for short, full, leaf in _named(tree, ""):
        name = full if short in found else short
        width = _width(leaf.shape)
        if width == 1:
            found.setdefault(name, (leaf, None))
        for k in range(width if width > 1 else 0):
            found.setdefault(f"{name}_{k + 1}", (leaf, k))
    columns = [Column(n, leaf.unit, max(leaf.shape)) for n, (leaf, _) in found.items()]
    load = one_by_one(lambda name: _values(*found[name]))
    return [Part("", columns, load, _note(objects))]


def _named(tree: Mapping[str, Any], where: str) -> Named:
    """Every array by its own name, and by that with the structures that it is in."""
    for name, value in tree.items():
        if isinstance(value, Leaf):
            unit = "s" if name == SIMULATED and not where else value.unit
            yield name, f"{where}{name}", Leaf(value.shape, value.load, unit)
    for name, value in tree.items():
        full = f"{where}{name}"
        if isinstance(value, Mapping) and "X" in value and "Y" in value:
            yield from _control_desk(value, full)
        elif isinstance(value, Mapping) and "time" in value and "signals" in value:
            yield from _with_time(value, full)
        elif isinstance(value, Mapping):
            yield from _named(value, f"{full}.")
        elif isinstance(value, list):
            for k, element in enumerate(value):
                if isinstance(element, Mapping):
                    yield from _named(element, f"{full}({k + 1}).")


def _with_time(structure: Mapping[str, Any], full: str) -> Named:
    """The times and the signals of Simulink, by their labels where they have one."""
    if isinstance(structure["time"], Leaf):
        time = structure["time"]
        yield "time", f"{full}.time", Leaf(time.shape, time.load, "s")
    signals = structure["signals"]
    several = isinstance(signals, list)
    for k, signal in enumerate(signals if several else [signals]):
        own = f"{full}.signals({k + 1})" if several else f"{full}.signals"
        if isinstance(signal, Mapping) and isinstance(signal.get("values"), Leaf):
            label = signal.get("label")
            name = _plain(label) if isinstance(label, str) else ""
            yield name or f"{own}.values", f"{own}.values", signal["values"]


def _control_desk(structure: Mapping[str, Any], full: str) -> Named:
    """The times and the signals of dSPACE, by the last part of their path in the model where no
    other has it.
    """
    times = [x for x in _list(structure["X"]) if isinstance(x.get("Data"), Leaf)]
    signals = [y for y in _list(structure["Y"]) if isinstance(y.get("Data"), Leaf)]
    for k, x in enumerate(times):
        name = "time" if len(times) == 1 else f"time_{k + 1}"
        unit = x.get("Unit") if isinstance(x.get("Unit"), str) else None
        yield name, f"{full}.X({k + 1})", Leaf(x["Data"].shape, x["Data"].load, unit or "s")
    paths = [_plain(str(y.get("Name") or f"{full}.Y({k + 1})")) for k, y in enumerate(signals)]
    own = [_last(path) for path in paths]
    for y, path, name in zip(signals, paths, own, strict=True):
        yield name if own.count(name) == 1 else path, path, y["Data"]


def _list(value: Any) -> list[Mapping[str, Any]]:
    return [v for v in (value if isinstance(value, list) else [value]) if isinstance(v, Mapping)]


def _last(path: str) -> str:
    """The last block of a path in a model, without the port."""
    blocks = [block.strip() for block in path.split("/")]
    blocks = [block for block in blocks if block] or [path]
    is_port = blocks[-1].rstrip("0123456789") in _PORTS and len(blocks) > 1
    return blocks[-2] if is_port else blocks[-1]


def _plain(name: str) -> str:
    """A name without the signs that mean something in a heading or a CSV."""
    return " ".join(name.translate(_SIGNS).split())


def _width(shape: tuple[int, ...]) -> int:
    """How many columns an array has, its longest index being time; 0 where it is none."""
    longest = max(shape, default=0)
    if longest < 2 or prod(shape) == 0:
        return 0
    width = prod(shape) // longest
    return width if width <= WIDEST and (width == 1 or width < longest) else 0


def _values(leaf: Leaf, column: int | None) -> NDArray[Any]:
    values = leaf.load()
    if column is None:
        return values.ravel()
    time = values.shape.index(max(values.shape))
    rows = values.swapaxes(0, time) if time else values
    return rows.reshape(len(rows), -1)[:, column]


def _note(objects: Objects) -> str:
    if not objects:
        return ""
    names = ", ".join(repr(name) for name in objects[:3] if name) or "a variable"
    first = next(filter(None, objects), "ts")
    return (
        f"; {names} can be read by MATLAB alone, being an object such as a timeseries, a timetable"
        f" or a Dataset: save numbers, such as time = {first}.Time; angle = {first}.Data;"
        " save('log.mat', 'time', 'angle')"
    )


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


_HDF5 = b"\x89HDF\r\n\x1a\n"
_HDF5_AT = (0, 512)  # MATLAB puts a text of 512 bytes in front
_NUMBERS = {f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)}
_NUMBERS |= {"double", "single", "logical"}


def parts(path: Path) -> Sequence[Part]:
    """The vectors and matrices of numbers, named as in `part_of`; of version 7.3 see `hdf5_parts`.

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
