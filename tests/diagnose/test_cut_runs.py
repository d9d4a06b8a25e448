"""Runs that the model of a chosen set cannot follow to their end: closed form of a pendulum."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

from ptp_symbolic.numeric.diagnose.cut_runs import in_windows_of
from ptp_symbolic.numeric.diagnose.trial import Task, fitted
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.workflows.result import windows_table
from tests.identify.test_windows import COUNT, FREE, MODEL, pendulum

PAYLOAD = {"m_payload": 5.0, "c_x_payload": 0.001}


@pytest.fixture(scope="module")
def task() -> Iterator[Task]:
    """Runs above the axis, where a small angle grows a hundred and four times, and one below it,
    declared without the payload.
    """
    up, down, little = (pendulum(*of)[0] for of in ((100.0, True), (100.0, False), (4.0, True)))
    train = (up, down, little)
    with ThreadPoolExecutor(2) as executor:
        yield Task(
            MODEL,
            train,
            train,
            train,
            (),
            (),
            (down, up),
            tuple(free_parameter(name, 0.0, 0.0, 10.0) for name in PAYLOAD),
            dict(zip(MODEL.parameter_names, MODEL.parameter_vector(FREE), strict=True)),
            (),
            executor,
            lambda text: None,
            (None, None),
            frozenset(),
            COUNT,
        )


def test_runs_in_which_a_set_multiplies_errors_are_cut_and_no_other(task: Task) -> None:
    """2.4 s above the axis are two windows; from four times up to ten a run stays whole."""
    up, down, little = task.train
    part = in_windows_of(task, fitted(task, (), {**task.fixed, **PAYLOAD}, None))
    first, second, *whole = part.train
    assert (first.source, second.source) == (up.source, up.source)
    assert len(first.time) + len(second.time) == len(up.time) + 1
    assert whole == [down, little]
    assert part.every_sample == part.train
    assert part.validate[0] is down
    assert len(part.validate) == 3
    assert windows_table(part) == {"count": 2, "seconds": pytest.approx(up.time[-1] / 2)}


def test_a_set_that_multiplies_none_leaves_the_runs_as_they_are(task: Task) -> None:
    assert in_windows_of(task, fitted(task, (), task.fixed, None)) is task
