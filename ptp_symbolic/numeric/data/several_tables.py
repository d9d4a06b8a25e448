"""One run in several tables: files cut one after the other, groups of signals, topics of a bag."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data.table import Table

FloatArray = NDArray[np.float64]
Part = tuple[Table, FloatArray, FloatArray]  # with times [n] in s and values [n, s]


def groups_of(
    path: Path, tables: Sequence[Table], columns: Sequence[str]
) -> dict[tuple[str, ...], list[Table]]:
    """The tables that hold some of the `columns`, by the columns that they hold.

    Raises InputError for a column in none of them, and for one in tables that hold others beside.
    """
    groups: dict[tuple[str, ...], list[Table]] = {}
    for table in tables:
        own = tuple(column for column in columns if table.place(column) is not None)
        if own:
            groups.setdefault(own, []).append(table)
    for column in columns:
        found = [tables[0] for own, tables in groups.items() if column in own]
        if not found:
            held = ", ".join(name for table in tables for name, _ in table.headings)
            held = held if len(held) <= 300 else held[:297] + "..."
            raise InputError(f"{path}: signal '{column}' is missing; the log has {held}.")
        if len(found) > 1:
            raise InputError(
                f"{path}: '{column}' is in {found[0].head} and in {found[1].head}, with other"
                " signals beside it; leave it in one of them."
            )
    return groups


def one_after_the_other(parts: Sequence[Part]) -> tuple[FloatArray, FloatArray]:
    """Times [n] in s and values [n, s] of parts with the same signals, in the order of time.

    Raises InputError for parts whose times overlap.
    """
    ordered = sorted(parts, key=lambda part: float(part[1][0]))
    for (first, before, _), (second, after, _) in pairwise(ordered):
        if after[0] <= before[-1]:
            raise InputError(
                f"{second.head}: its times from {after[0]:.6g} s to {after[-1]:.6g} s overlap those"
                f" of {first.head}, {before[0]:.6g} s to {before[-1]:.6g} s; parts of one run need"
                " one clock: give runs of their own as logs of their own."
            )
    return np.concatenate([p[1] for p in ordered]), np.concatenate([p[2] for p in ordered])
