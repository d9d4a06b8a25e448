"""Which reader a file needs, by the end of its name."""

from collections.abc import Callable, Mapping
from pathlib import Path

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.array_table import read_mat, read_parquet
from ptp_symbolic.numeric.data.csv_table import read_csv
from ptp_symbolic.numeric.data.table import Table

READERS: Mapping[str, Callable[[Path], Table]] = {
    ".csv": read_csv,
    ".tsv": read_csv,
    ".txt": read_csv,
    ".dat": read_csv,
    ".mat": read_mat,
    ".parquet": read_parquet,
}

IN_FOLDERS = (".csv", ".mat", ".parquet")  # taken from a folder; other names may be anything


def read_table(path: Path) -> Table:
    """Read a table of numbers; a file whose name ends otherwise is read as a CSV.

    Raises InputError as the readers do.
    """
    return READERS.get(path.suffix.lower(), read_csv)(path)


def files_at(path: Path) -> list[Path]:
    """The logs at `path`: itself, or those of a folder. Raises InputError where it has none."""
    if not path.is_dir():
        return [path]
    files = [file for file in path.iterdir() if file.suffix.lower() in IN_FOLDERS]
    files = sorted(file for file in files if not file.name.startswith("."))
    if not files:
        kinds = ", ".join(f"*{suffix}" for suffix in IN_FOLDERS)
        raise InputError(f"{path}: the folder has no logs ({kinds}); name the folder of the logs.")
    return files
