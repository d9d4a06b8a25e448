"""What is named beside more than noise takes away more than that, surely."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.confirm import _doubt_beside_residual
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.stepwise import Step
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from tests.identify.straight import finished

RNG = np.random.default_rng(7)
LEFT = 3.0 * RNG.normal(size=(6, 60))  # more than noise
SLOPES = list(RNG.normal(size=(6, 60, 1)))  # by one parameter, which has nothing to do with it
FREE = (free_parameter("J", 1.0, 0.1, 10.0),)
TASK = cast(Any, SimpleNamespace(material=0.1))


def doubt_for(*sizes: float) -> str | None:
    """What speaks against a candidate without which six runs leave so many times as much."""
    candidate = Candidate("spring", None, "", "", (), {})
    more = [size * left for size, left in zip(sizes, LEFT, strict=True)]
    whole = FittedModel((candidate,), finished(list(LEFT), SLOPES, free=FREE))
    without = FittedModel((), finished(more, SLOPES, free=FREE))
    return _doubt_beside_residual(TASK, whole, Step(candidate, gain(whole, without), 0.0, without))


@pytest.mark.parametrize(
    ("sizes", "doubted"),
    [
        ((2.0, 2.0, 2.0, 2.0, 2.0, 2.0), False),  # 75 % of the squares, in every run
        ((1.2, 1.2, 1.2, 1.2, 1.2, 1.2), True),  # 31 %
        ((1.0, 1.0, 1.0, 1.0, 1.0, 3.5), True),  # 59 %, all of it in one of six runs
    ],
)
def test_more_than_is_left_is_taken_away_surely(sizes: tuple[float, ...], doubted: bool) -> None:
    doubt = doubt_for(*sizes)
    assert (doubt is not None) is doubted
    assert doubt is None or "too little while the residual exceeds the noise" in doubt


def test_the_reason_gives_the_share_and_what_is_sure() -> None:
    doubt = doubt_for(1.0, 1.0, 1.0, 1.0, 1.0, 3.5)
    assert doubt is not None and doubt.startswith(
        "reduces the sum of squares by 59 % (lower 95 % limit 24 %)"
    )
