"""A tenth of the benchmark with the diagnosis itself: no wrong name, and enough right answers.

Takes hours of one core; `python -m tests.benchmark run` does the whole.
"""

import os
from pathlib import Path

import pytest

from tests.benchmark.catalogue import catalogue
from tests.benchmark.entry import KINDS, Entry
from tests.benchmark.runner import line_of, run_one

pytestmark = pytest.mark.long

EVERY = 10  # one set of ten, and at least one of each kind
LEAST_RIGHT = 12  # of 30; a good half of the sets is right, effects below the threshold among them


def sample() -> list[Entry]:
    """Every tenth entry, and the first of each kind that these leave out."""
    entries = catalogue()
    chosen = list(entries[::EVERY])
    for kind in KINDS:
        if all(entry.kind != kind for entry in chosen):
            chosen.append(next(entry for entry in entries if entry.kind == kind))
    return chosen


def test_a_tenth_of_the_catalogue_has_no_wrong_name(tmp_path: Path) -> None:
    cores = sorted(os.sched_getaffinity(0))
    outcomes = [run_one(entry, tmp_path, cores) for entry in sample()]
    lines = [line_of(outcome) for outcome in outcomes]
    answers = [outcome["score"]["answer"] for outcome in outcomes]
    wrong = [line for line, answer in zip(lines, answers, strict=True) if answer == "wrong"]
    assert not wrong, "\n".join(wrong)
    assert answers.count("right") >= LEAST_RIGHT, "\n".join(lines)
