"""Pieces of work side by side, however few workers an executor has."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier, get_ident

import pytest

from ptp_symbolic.numeric.diagnose.fitted_model import side_by_side

PATIENCE = 60.0  # s; until a piece that waits in vain for the others gives up


def test_two_are_begun_before_either_has_to_end_and_a_single_worker_serves_them() -> None:
    """Each waits for another before it hands on: in turn, none would end."""
    met = Barrier(2)
    with ThreadPoolExecutor(1) as executor:

        def work(number: int) -> list[int]:
            met.wait(PATIENCE)
            return list(executor.map(lambda k: number * k, range(4)))

        assert side_by_side(work, [3, 2]) == [[0, 3, 6, 9], [0, 2, 4, 6]]


def test_one_piece_is_done_in_its_place_and_none_is_no_work() -> None:
    assert side_by_side(lambda k: (k, get_ident()), [7]) == [(7, get_ident())]
    assert side_by_side(str, []) == []


def test_what_goes_wrong_in_one_is_raised() -> None:
    with pytest.raises(ZeroDivisionError):
        side_by_side(lambda k: 1 / k, [1, 0, 2])
