"""The process that reads a file with a library; it may die of what the file holds.

Run as `python -m ptp_symbolic.numeric.files.child`, with a `Request` in JSON as its argument. It
answers on its standard output with one line of JSON, followed by numbers or text.
"""

import json
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.files import bags, matlab
from ptp_symbolic.numeric.files.content import MOST_COLUMNS, Part, in_a_line
from ptp_symbolic.numeric.files.tables import excel_text, parquet_parts, tdms_parts

KINDS = {"MATLAB": matlab.parts, "Parquet": parquet_parts, "TDMS": tdms_parts}
EXCEL, BAG = "Excel", "bag"
ROOM = 500_000_000  # bytes that reading may take, beside three times the size of the file


def main() -> None:
    """Answer the request that is the argument."""
    request = json.loads(sys.argv[1])
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    _limit_memory([Path(path) for path in request["paths"]])
    answer_to(request, answer)


def answer_to(request: dict[str, Any], answer: BinaryIO) -> None:
    """Write what is asked for to `answer`, or why the file is refused."""
    name, kind = request["name"], request["kind"]
    try:
        _answer(answer, request)
    except InputError as error:
        _refuse(answer, str(error))
    except MemoryError:
        _refuse(
            answer,
            f"{name}: unfolds into more than {ROOM // 10**6} MB; save the columns that are needed"
            " alone, or as CSV.",
        )
    except Exception as error:  # a library raises whatever a damaged byte leads to
        _refuse(answer, f"{name}: is not a {kind} file that can be read: {in_a_line(error)}.")


def _answer(answer: BinaryIO, request: dict[str, Any]) -> None:
    paths = [Path(path) for path in request["paths"]]
    if request["kind"] == EXCEL:
        content = excel_text(paths[0]).encode()
        _line(answer, {"bytes": len(content)})
        answer.write(content)
        answer.flush()
        return
    if request["kind"] == BAG:
        parts: Sequence[Part] = bags.parts(Path(request["name"]), paths)
    else:
        parts = KINDS[request["kind"]](paths[0])
    if request["part"] is None:
        listed = [
            [part.name, [_listed(c) for c in part.columns[: MOST_COLUMNS + 1]], part.note]
            for part in parts[: MOST_COLUMNS + 1]
        ]
        _line(answer, {"parts": listed})
        return
    part = parts[request["part"]]
    arrays = part.load(request["columns"])
    first = np.asarray(next(arrays), dtype=np.float64).ravel()
    _line(answer, {"rows": len(first)})
    first.tofile(answer)
    del first
    for values in arrays:
        np.asarray(values, dtype=np.float64).ravel().tofile(answer)
    answer.flush()


def _listed(column: Any) -> list[Any]:
    name = column.name.encode(errors="replace").decode()
    return [" ".join(name.split()), column.unit, column.size]


def _line(answer: BinaryIO, content: dict[str, Any]) -> None:
    answer.write(json.dumps(content).encode() + b"\n")
    answer.flush()


def _refuse(answer: BinaryIO, message: str) -> None:
    _line(answer, {"refused": message})


def _limit_memory(paths: Sequence[Path]) -> None:
    """Let the system refuse memory beyond what reading may take, where it can (not on Windows)."""
    try:
        import resource
    except ImportError:
        return
    stored = sum(path.stat().st_size for path in paths if path.is_file())
    most = ROOM + 3 * stored
    try:
        resource.setrlimit(resource.RLIMIT_DATA, (most, most))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    except (ValueError, OSError):
        return


if __name__ == "__main__":
    main()
