"""Which reader a file needs, by the end of its name."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.array_table import read_mat, read_parquet
from ptp_symbolic.numeric.data.bag import METADATA, SUFFIXES, is_bag, read_topics
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

BAGS = (".bag", ".mcap")  # a .db3 needs the folder that it is in
IN_FOLDERS = (".csv", ".mat", ".parquet", *BAGS)  # taken from a folder; others may be anything
AND = "+"  # between files that hold one run together


def read_table(path: Path) -> Table:
    """Read a table of numbers; a file whose name ends otherwise is read as a CSV.

    Raises InputError as the readers do.
    """
    return READERS.get(path.suffix.lower(), read_csv)(path)


def read_tables(path: Path) -> Sequence[Table]:
    """The tables of a log: one of a file, several of a bag and of files with a plus between them.

    Raises InputError as the readers do.
    """
    parts = parts_of(path)
    bags = [part for part in parts if is_bag(part)]
    topics = read_topics(path, bags) if bags else []
    return [*(read_table(part) for part in parts if part not in bags), *topics]


def parts_of(path: Path) -> list[Path]:
    """The files that are given with a plus between them; a file of that very name is one."""
    if AND not in str(path) or path.exists():
        return [path]
    return [Path(part) for part in str(path).split(AND)]


def name_of(path: Path) -> str:
    """The name of a log, those of its files with a plus between them."""
    return AND.join(part.stem for part in parts_of(path))


def stored_at(path: Path) -> list[Path]:
    """The files in which a log is stored."""
    stored = []
    for part in parts_of(path):
        inside = sorted(part.iterdir()) if part.is_dir() else [part]
        stored += [p for p in inside if p is part or p.suffix in SUFFIXES or p.name == METADATA]
    return stored


def files_at(path: Path) -> list[Path]:
    """The logs at `path`: itself, or those of a folder. Raises InputError where it has none."""
    if not path.is_dir() or is_bag(path):
        return [path]
    files = [f for f in path.iterdir() if f.suffix.lower() in IN_FOLDERS or is_bag(f)]
    files = sorted(file for file in files if not file.name.startswith("."))
    if not files:
        kinds = ", ".join(f"*{suffix}" for suffix in IN_FOLDERS)
        raise InputError(f"{path}: the folder has no logs ({kinds}); name the folder of the logs.")
    return files
