"""Tables whose file holds numbers as such: MATLAB and Parquet."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.table import MOST_ROWS, Table, checked_headings, heading

_MAX_BYTES = 1_000_000_000
_HDF5 = b"\x89HDF\r\n\x1a\n"
_HDF5_AT = (0, 512)  # MATLAB puts a text of 512 bytes in front


@dataclass(frozen=True)
class ArrayTable(Table):
    """Columns that are numbers already, by index."""

    columns: tuple[NDArray[Any], ...]

    def numbers(self, columns: Sequence[int]) -> NDArray[np.float64]:
        """The given columns as [n, len(columns)]. Raises InputError for what is not finite."""
        chosen = [self.columns[k] for k in columns]
        if len(chosen[0]) > MOST_ROWS:
            raise InputError(f"{self.path}: has more than {MOST_ROWS} rows; split the log.")
        for index, column in zip(columns, chosen, strict=True):
            name = self.headings[index][0]
            if len(column) != len(chosen[0]):
                raise InputError(
                    f"{self.path}: '{name}' has {len(column)} numbers where others have"
                    f" {len(chosen[0])}; give columns of one length."
                )
            wrong = np.flatnonzero(~np.isfinite(column))
            if len(wrong):
                raise InputError(
                    f"{self.row(int(wrong[0]))}: '{name}' is {column[wrong[0]]}, not a finite"
                    " number; correct it or remove the row."
                )
        return np.column_stack(chosen).astype(np.float64)


def read_mat(path: Path) -> ArrayTable:
    """Read the numeric vectors of a MATLAB file, version 5 to 7 by SciPy, 7.3 by h5py.

    A name such as `pan_angle` has no unit; the platform file gives it. Fields of a structure are
    vectors too, by their own name. Raises InputError for a file
    that is missing, damaged, over 1 GB, or of version 7.3 where h5py is not installed.
    """
    _refuse_size(path)
    with path.open("rb") as file:
        begin = file.read(520)
    if any(begin[k : k + 8] == _HDF5 for k in _HDF5_AT):
        return _table(path, _hdf5_vectors(path))
    from scipy.io import loadmat

    try:
        found = loadmat(path, simplify_cells=True)
    except Exception as error:  # SciPy raises whatever a damaged byte leads to
        raise InputError(f"{path}: is not a MATLAB file that can be read: {error}.") from error
    return _table(path, _flat({k: v for k, v in found.items() if not k.startswith("__")}))


def read_parquet(path: Path) -> ArrayTable:
    """Read the numeric columns of a Parquet file, named `name [unit]` or `name`.

    Raises InputError for a file that is missing, damaged or over 1 GB, and where pyarrow is not
    installed.
    """
    _refuse_size(path)
    try:
        from pyarrow import parquet
    except ImportError as error:
        raise _lacking(path, "Parquet", "pyarrow", "parquet") from error
    try:
        table = parquet.read_table(path)
        return _table(path, {n: table.column(n).to_numpy() for n in table.column_names})
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: is not a Parquet file that can be read: {error}.") from error


def _hdf5_vectors(path: Path) -> dict[str, NDArray[Any]]:
    try:
        import h5py
    except ImportError as error:
        raise _lacking(path, "MATLAB 7.3", "h5py", "matlab") from error
    with h5py.File(path, "r") as file:
        return _flat(_groups(file))


def _groups(group: Any) -> dict[str, Any]:
    """What an HDF5 group holds, groups of it as mappings."""
    return {
        name: _groups(item) if hasattr(item, "keys") else item[()]
        for name, item in group.items()
        if not name.startswith("#")
    }


def _flat(found: Mapping[str, Any]) -> dict[str, Any]:
    """Fields of structures beside what stands alone: by their own name where no other has it, else
    with that of the structure before it.
    """
    flat: dict[str, Any] = {n: v for n, v in found.items() if not isinstance(v, Mapping)}
    for structure, fields in found.items():
        if isinstance(fields, Mapping):
            for name, value in _flat(fields).items():
                flat[f"{structure}.{name}" if name in flat else name] = value
    return flat


def _table(path: Path, found: Mapping[str, Any]) -> ArrayTable:
    """The numeric vectors among `found`, those of one number left out."""
    vectors = {
        name: np.asarray(value).ravel()
        for name, value in found.items()
        if np.asarray(value).dtype.kind in "iufb"
        and np.asarray(value).size == max(np.asarray(value).shape, default=0) > 1
    }
    headings = checked_headings(str(path), [heading(str(path), name) for name in vectors])
    return ArrayTable(path, headings, tuple(vectors.values()))


def _refuse_size(path: Path) -> None:
    try:
        size = path.stat().st_size
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; give the path of a log.") from error
    if size > _MAX_BYTES:
        raise InputError(f"{path}: is larger than 1 GB, the most for a log; split it.")


def _lacking(path: Path, kind: str, package: str, extra: str) -> InputError:
    return InputError(
        f"{path}: a {kind} file needs {package}; run pip install 'ptp-symbolic[{extra}]', or save"
        " the log as CSV."
    )
