"""The shortest windows that lead a search: stretches spread over the logs, not all of them."""

from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

import numpy as np
import pytest

from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose.preparation import problem_of
from ptp_symbolic.numeric.identify.blocks import MANY_RUNS
from ptp_symbolic.numeric.identify.constants import FORGOTTEN, SHORT
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from tests.identify.pan_runs import KNOWN, MODEL, PERIOD, PLATFORM, TRUTH

LOGS = 3


def leading(seconds: float) -> tuple[tuple[Run, ...], ...]:
    """The windows that lead a fit to so many seconds of a resting drive, in LOGS logs."""
    time = PERIOD * np.arange(round(seconds / LOGS / PERIOD) + 1)
    k = len(time)
    logs = [Log(f"{n}", time, np.zeros((k, 1)), np.zeros((k, 2))) for n in range(LOGS)]
    runs = prepare_runs(MODEL, PLATFORM, logs)
    free = (free_parameter("J_pan", TRUTH["J_pan"], 0.0, 10.0),)
    others = {**KNOWN, **TRUTH}
    del others["J_pan"]
    known = {name: (value, None) for name, value in others.items()}
    noises = dict.fromkeys(MODEL.input_names, 0.0)
    with ThreadPoolExecutor(1) as executor:
        return problem_of(
            MODEL, runs, runs, free, known, (), noises, None, 0.1, executor, lambda text: None
        ).windows


@pytest.mark.parametrize("seconds", [6.0, 90.0])
def test_the_shortest_windows_lead_in_stretches_that_tell_what_is_usual(seconds: float) -> None:
    """Each window tells how the next one begins, so that a stretch of them lasts as long as a
    longer window does; of these all lead. Short logs have no more than is needed.
    """
    shortest, longer = leading(seconds)
    assert sum(run.time[-1] - run.time[0] for run in longer) == pytest.approx(seconds)
    lasts = sum(run.time[-1] - run.time[0] for run in shortest)
    assert (
        min(seconds, MANY_RUNS * SHORT)
        <= lasts * 1.001
        < min(seconds, 2 * MANY_RUNS * SHORT) * 1.01
    )
    assert {run.source for run in shortest} == {run.source for run in longer}
    parted = sum(a.source != b.source or a.time[-1] != b.time[0] for a, b in pairwise(shortest))
    assert parted + 1 <= lasts / SHORT + LOGS
    assert len(shortest) == pytest.approx(lasts / FORGOTTEN, rel=0.02)
