"""Parquet files, read with pyarrow."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files.content import Column, Part, lacking, one_by_one, seconds


def parquet_parts(path: Path) -> Sequence[Part]:
    """The numeric columns; dates and durations are in s.

    Raises InputError where pyarrow is not installed, and whatever pyarrow raises.
    """
    try:
        import pyarrow
        from pyarrow import parquet, types
    except ImportError as error:
        raise InputError(lacking(path, "Parquet", "pyarrow", "parquet")) from error
    pyarrow.set_memory_pool(pyarrow.system_memory_pool())
    file = parquet.ParquetFile(path)
    rows = file.metadata.num_rows
    columns = []
    for field in file.schema_arrow:
        if types.is_timestamp(field.type) or types.is_duration(field.type):
            columns.append(Column(field.name, "s", rows))
        elif any(
            kind(field.type) for kind in (types.is_integer, types.is_floating, types.is_boolean)
        ):
            columns.append(Column(field.name, None, rows))

    def load(name: str) -> NDArray[Any]:
        table = parquet.read_table(path, columns=[name], use_threads=False, memory_map=False)
        values = np.asarray(table.column(name).to_numpy())
        return seconds(values) if values.dtype.kind in "mM" else values.astype(np.float64)

    return [Part("", columns, one_by_one(load))]
