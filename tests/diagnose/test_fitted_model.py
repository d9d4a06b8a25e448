"""How trials are ranked: one scale for all, and runs far off do not decide."""

from collections.abc import Sequence

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.fitted_model import TUNING, FittedModel, deviances, ranked
from tests.identify.curves import Floats
from tests.identify.straight import finished

WAVE = np.where(np.arange(60) % 2, 1.0, -1.0)


def trial(residuals: Sequence[Floats]) -> FittedModel:
    return FittedModel((), finished(residuals))


def test_a_misfit_is_the_logarithm_of_the_mean_square_of_every_signal() -> None:
    two = [np.column_stack([2.0 * WAVE, 3.0 * WAVE])] * 4
    (found,) = deviances([trial(two)])
    assert found == pytest.approx(240 * (np.log(4.0) + np.log(9.0)), rel=1e-12)


def test_trials_are_compared_in_the_scale_of_the_best() -> None:
    """One run of five is off by 10: it counts linearly beside the others, alike in both trials,
    though by its own median the second would count less five times later.
    """
    first = trial([WAVE] * 4 + [10.0 * WAVE])
    second = trial([5.0 * WAVE] * 4 + [10.0 * WAVE])
    bent = 2.0 * np.sqrt(TUNING**2 * 100.0) - TUNING**2
    steady = 2.0 * np.sqrt(TUNING**2 * 25.0) - TUNING**2
    expected = [300 * np.log((4.0 + bent) / 5.0), 300 * np.log((4.0 * steady + bent) / 5.0)]
    assert deviances([first, second]) == pytest.approx(expected, rel=1e-12)
    assert deviances([second, first]) == pytest.approx(expected[::-1], rel=1e-12)


def test_a_failed_simulation_ranks_last() -> None:
    good, failed = trial([WAVE]), trial([np.full(60, np.nan)])
    assert deviances([failed, good])[0] == np.inf
    assert ranked([failed, good])[0] is good


def test_an_axis_that_rests_does_not_decide() -> None:
    """What one leaves of an angle at rest is a rounding of zero; the other signal is better."""
    better = [np.column_stack([1.0 * WAVE, 0.0 * WAVE])] * 4
    worse = [np.column_stack([1.2 * WAVE, 1e-15 * WAVE])] * 4
    first, second = deviances([trial(better), trial(worse)])
    assert second - first == pytest.approx(240 * np.log(1.44), rel=1e-12)
    first, second = deviances([trial(worse), trial([t[:, ::-1] for t in worse])])
    assert first == pytest.approx(second)
