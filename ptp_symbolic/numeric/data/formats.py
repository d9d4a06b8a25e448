"""Which reader a file needs, by the end of its name.

Tables of files that a library reads: MATLAB, Parquet, TDMS, ROS bags and MCAP.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.csv_table import BAG, foreign_tables, read_csv, read_excel
from ptp_symbolic.numeric.data.table import Table

FOREIGN: Mapping[str, str] = {".mat": "MATLAB", ".parquet": "Parquet", ".tdms": "TDMS"}
EXCEL = (".xlsx", ".xlsm")
BAGS = (".bag", ".mcap")  # a .db3 needs the folder that it is in
STORED_IN = (*BAGS, ".db3")
METADATA = "metadata.yaml"  # what makes a folder a bag of ROS 2
IN_FOLDERS = (
    ".csv",
    *FOREIGN,
    ".lvm",
    ".xlsx",
    *BAGS,
)  # taken from a folder; others may be anything
AND = "+"  # between files that hold one run together


def read_table(path: Path) -> Table:
    """Read the one table of a file. Raises InputError for several, and as the readers do."""
    tables = read_tables(path)
    if len(tables) > 1:
        names = ", ".join(table.head for table in tables[:5])
        raise InputError(f"{path}: holds {len(tables)} tables ({names}); save one alone, as CSV.")
    return tables[0]


def read_tables(path: Path) -> Sequence[Table]:
    """The tables of a log: one of most files, several of a bag, of groups of channels, and of files
    with a plus between them. A file whose name has an unknown end is read as a CSV.

    Raises InputError as the readers do.
    """
    parts = parts_of(path)
    bags = [part for part in parts if is_bag(part)]
    topics = foreign_tables(path, BAG, bags) if bags else []
    return [*(t for part in parts if part not in bags for t in _tables_of(part)), *topics]


def _tables_of(path: Path) -> Sequence[Table]:
    suffix = path.suffix.lower()
    if suffix in FOREIGN:
        return foreign_tables(path, FOREIGN[suffix])
    return [read_excel(path) if suffix in EXCEL else read_csv(path)]


def is_bag(path: Path) -> bool:
    """Whether a path is a bag: a file by the end of its name, or a folder with its metadata."""
    return path.suffix.lower() in STORED_IN or (path / METADATA).is_file()


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
        stored += [p for p in inside if p is part or p.suffix in STORED_IN or p.name == METADATA]
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
