"""At which times a simulation reports, and how many there may be."""

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.simulation.run import output_times


def test_a_duration_is_cut_into_milliseconds() -> None:
    assert np.array_equal(output_times(0.5), np.linspace(0.0, 0.5, 501))


def test_an_interval_that_does_not_divide_the_duration_keeps_its_length() -> None:
    assert output_times(1.0, 0.3) == pytest.approx([0.0, 0.3, 0.6, 0.9, 1.0])
    assert output_times(0.1, 0.3) == pytest.approx([0.0, 0.1])


def test_too_many_samples_are_refused_with_an_interval_that_would_do() -> None:
    with pytest.raises(InputError, match=r"1e\+12 samples, at most 5000000 .*\(`every` 202\)"):
        output_times(1e9)
    assert len(output_times(1e9, 202.0)) < 5_000_000


def test_an_interval_is_a_positive_number() -> None:
    for wrong in (0.0, -1.0, float("nan")):
        with pytest.raises(InputError, match="give a positive number of seconds"):
            output_times(1.0, wrong)


def test_only_what_rounding_leaves_is_divided_evenly() -> None:
    """A quarter of an interval at the end is an interval of its own."""
    assert output_times(1.0, 0.8) == pytest.approx([0.0, 0.8, 1.0], abs=0.0)
    assert output_times(1.0, 0.16)[-2:] == pytest.approx([0.96, 1.0], abs=1e-12)
    assert len(output_times(0.1 * 3.0, 0.1)) == 4
