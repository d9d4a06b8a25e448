"""Some of many windows: enough to tell what is usual, spread over the logs."""

from collections.abc import Sequence

from ptp_symbolic.numeric.identify.constants import SHORT
from ptp_symbolic.numeric.identify.linked_windows import has_linked, linked
from ptp_symbolic.numeric.identify.robust_loss import MANY_RUNS
from ptp_symbolic.numeric.identify.run import Run


def leading(windows: tuple[Run, ...], length: float, stretch: float) -> tuple[Run, ...]:
    """Windows of `length` s that lead a search: spread over the logs; where each tells how the next
    one begins, in stretches of `stretch` s, and all of them where that is no longer than a window.
    """
    if not has_linked(windows):
        return spread_over(windows, length)
    count = round(stretch / length)
    if count <= 1:
        return windows
    series = [s[k : k + count] for s in linked(windows) for k in range(0, len(s), count)]
    return tuple(windows[k] for s in series[:: _apart(windows, length)] for k in s)


def spread_over(windows: tuple[Run, ...], length: float) -> tuple[Run, ...]:
    """Windows of `length` s spread over the logs, at least as many as tell what is usual, and more
    of shorter ones, in the same time.
    """
    return windows[:: _apart(windows, length)]


def _apart(windows: Sequence[Run], length: float) -> int:
    """Every which one to take of `windows` of `length` s."""
    return max(1, int(len(windows) * length / (MANY_RUNS * SHORT)))
