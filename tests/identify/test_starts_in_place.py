"""Windows that follow one another begin where they should, with no more effort than that asks."""

from collections import Counter
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.numeric.identify import least_squares
from ptp_symbolic.numeric.identify.constants import ABOVE_NOISE
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.fit import starts_in_place
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.windows import cut
from tests.identify.curves import Floats
from tests.identify.pan_runs import KNOWN, MODEL, TRUTH, make_runs, sine, stairs
from tests.independent.pan_drive import PanDrive

VALUES = {**KNOWN, **TRUTH}


def mean_squares(
    windows: tuple[Run, ...], starts: list[Floats], values: dict[str, float]
) -> Floats:
    """What every window leaves, in units of its noise."""
    p, none = MODEL.parameter_vector(values), np.zeros(0, dtype=np.int64)
    found = [
        evaluate(MODEL, run, p, z, none, False, Tolerance())
        for run, z in zip(windows, starts, strict=True)
    ]
    assert not any(e.failed for e in found)
    return np.array([np.mean(e.residual**2) for e in found])


@pytest.mark.parametrize("friction", [1.0, 2.0])
def test_a_window_is_not_begun_anew_that_leaves_what_is_usual(
    friction: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the machine's own values nearly all windows leave noise and the usual changes nothing;
    where a value is wrong all leave more, and only those that leave more than is usual are begun at
    other places: these end as with all effort, for the others it is less.
    """
    windows = cut(MODEL, make_runs(PanDrive(), [stairs(), sine()], 3).runs, 0.5)
    values = {**VALUES, "F_v_pan": friction * VALUES["F_v_pan"]}
    guesses, calls = [run.guess for run in windows], Counter[float]()

    def begun(usual: float) -> list[Floats]:
        def counted(*arguments: Any) -> Any:
            calls[usual] += 1
            return evaluate(*arguments)

        monkeypatch.setattr(least_squares, "evaluate", counted)
        return starts_in_place(MODEL, windows, values, guesses, Tolerance(), None, usual=usual)

    every = mean_squares(windows, begun(1.0), values)
    usual = float(np.median(every))
    some = mean_squares(windows, begun(usual), values)
    if friction == 1.0:
        assert usual < ABOVE_NOISE
        assert some == pytest.approx(every)
        return
    assert usual > 2.0
    assert calls[usual] < 0.9 * calls[1.0]
    satisfied = some <= ABOVE_NOISE * usual
    assert 0 < np.sum(satisfied) < len(windows)
    assert some[~satisfied] == pytest.approx(every[~satisfied], rel=0.1)
