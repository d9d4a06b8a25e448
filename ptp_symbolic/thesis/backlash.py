"""Section 4.1 and Appendix A: the average backlash gap, with the interval that it deserves."""

import numpy as np
from scipy import stats

from ptp_symbolic.thesis import printed
from ptp_symbolic.thesis.items import Item, compared, unprinted


def mean_interval(level: float = 0.95) -> tuple[float, float, float]:
    """Mean gap in deg and its Student t interval at `level`, from the readings of Appendix A."""
    readings = np.array(printed.BACKLASH_DEG)
    mean, error = float(readings.mean()), float(stats.sem(readings))
    low, high = stats.t.interval(level, len(readings) - 1, loc=mean, scale=error)
    return mean, float(low), float(high)


def items() -> list[Item]:
    """All items of this file."""
    mean, low, high = mean_interval()
    count = len(printed.BACKLASH_DEG)
    interval = f"Student t interval of {count} readings, {count - 1} degrees of freedom"
    step = 360.0 / printed.COUNTS_PER_REVOLUTION
    return [
        compared(
            "appendix_a.mean",
            "Appendix A, average backlash gap",
            printed.BACKLASH_AVERAGE_DEG,
            mean,
            "deg",
            f"mean of {count} readings",
        ),
        unprinted("appendix_a.ci95_low", "Average gap, lower end at 95 %", low, "deg", interval),
        unprinted("appendix_a.ci95_high", "Average gap, upper end at 95 %", high, "deg", interval),
        unprinted(
            "appendix_a.spread",
            "Standard deviation of the readings",
            float(np.std(printed.BACKLASH_DEG, ddof=1)),
            "deg",
            f"from the readings; one count of the encoder is {step:g} deg",
        ),
    ]
