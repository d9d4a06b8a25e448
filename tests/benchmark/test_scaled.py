"""Chosen constants are scaled, with what follows from them, and nothing else is."""

from pathlib import Path
from types import ModuleType

import pytest

from tests.benchmark.scaled import scale_chosen, sections

TABLE = """
# Effort
TRIED = 3  # 1; alternatives; scaled
PROPOSED = 2 * TRIED  # sets; that rows propose; derived
RUNG = ((4, 2),)  # iterations, sets; of halving; scaled
SHARE = 0.25  # 1; of a step; scaled

# Decisions
WIDEST = 1.5  # 1; block; scaled
LEVEL = 0.05  # 1; chance of a false alarm; stated level
HALF = 0.5  # 1; of a whole; definition
"""


@pytest.fixture
def table(tmp_path: Path) -> ModuleType:
    module = ModuleType("table")
    module.__file__ = str(tmp_path / "table.py")
    Path(module.__file__).write_text(TABLE)
    exec(TABLE, module.__dict__)
    return module


def test_chosen_constants_by_section() -> None:
    assert sections(TABLE) == {
        "effort": ["TRIED", "RUNG", "SHARE"],
        "decisions": ["WIDEST", "LEVEL"],
    }


def test_a_section_is_scaled_with_what_follows_from_it(table: ModuleType) -> None:
    scale_chosen(table, "effort", 2.0)
    assert (table.TRIED, table.PROPOSED, table.RUNG, table.SHARE) == (6, 12, ((8, 4),), 0.5)
    assert (table.WIDEST, table.LEVEL) == (1.5, 0.05)


def test_counts_stay_whole_and_above_zero(table: ModuleType) -> None:
    scale_chosen(table, "effort", 0.1)
    assert (table.TRIED, table.PROPOSED, table.RUNG) == (1, 2, ((1, 1),))
    scale_chosen(table, "decisions", 0.5)
    assert (table.TRIED, table.WIDEST, table.LEVEL, table.HALF) == (3, 0.75, 0.025, 0.5)


def test_one_constant_is_scaled_alone(table: ModuleType) -> None:
    scale_chosen(table, "TRIED", 2.0)
    assert (table.TRIED, table.PROPOSED, table.RUNG, table.SHARE) == (6, 12, ((4, 2),), 0.25)
    with pytest.raises(KeyError):
        scale_chosen(table, "PROPOSED", 2.0)


def test_an_unknown_section_is_refused(table: ModuleType) -> None:
    with pytest.raises(KeyError):
        scale_chosen(table, "colours", 2.0)
