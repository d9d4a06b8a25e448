"""How small a parameter or an effect these logs can show, predicted at the declared start values.

The prediction takes the declared model for right and the noise for white: model errors leave less
to be seen. An effect is simulated at a small amount; its response, projected off what the free
parameters and the starts of the runs can follow, must stand out of the noise, and hold the share of
the squared error below which nothing is named.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.linear import projected_off, stacked_jacobian
from ptp_symbolic.numeric.diagnose.responses import response_columns
from ptp_symbolic.numeric.diagnose.trial import Task, Trial
from ptp_symbolic.numeric.identify.constants import FALSE_ALARM, MOST, NOTHING, REACH
from ptp_symbolic.numeric.identify.coordinates import slopes, to_search

FloatArray = NDArray[np.float64]

# Standard deviations, of either sign, with which 95 % are found at 5 % of false alarms.
SEEN = float(np.sum(stats.norm.isf([FALSE_ALARM, MOST * FALSE_ALARM])))


@dataclass(frozen=True)
class Visible:
    """A parameter, the `effect` that it switches on (None: declared and free), and the smallest
    amount in its unit that the logs show; infinite where they show none. Of a limit, such as a
    largest voltage, it is the `largest` that shows, and NaN where none does.
    """

    effect: str | None
    parameter: str
    smallest: float
    largest: float | None = None


def visible_amounts(task: Task, start: Trial) -> list[Visible]:
    """Smallest visible change of every free parameter, and amount of every effect that is searched
    for in its simplest form, in their units, at `start`, the declared model with its Jacobians.
    """
    declared = stacked_jacobian(start.fit)
    units = np.abs(slopes(start.fit.free, to_search(start.fit.free, start.fit.values)))
    found = [
        Visible(None, f.name, _smallest(declared[:, k] / units[k], np.delete(declared, k, axis=1)))
        for k, f in enumerate(start.fit.free)
    ]
    simplest: dict[str, Candidate] = {}
    for candidate in sorted(task.candidates, key=lambda c: len(c.free)):
        if not candidate.is_declared_value:
            simplest.setdefault(candidate.key, candidate)
    most = REACH * float(np.sqrt(len(declared)))
    named = max(SEEN, float(np.sqrt(task.material / (1.0 - task.material) * len(declared))))

    def amounts(candidate: Candidate) -> list[Visible]:
        columns = response_columns(task, start, candidate, candidate.shapes[0], most)
        seen = {} if columns is None else dict(zip(columns.free, columns.table.T, strict=True))
        rows = []
        for f in candidate.defining:
            smallest = _smallest(seen[f], declared, named) if f in seen else float("inf")
            largest = None
            if candidate.is_limit(f) and f.logarithmic:
                at = np.nan if columns is None else columns.limits.get(f.name, np.nan)
                largest = largest_limit(candidate.met_at(f), at, f.upper, smallest)
                smallest = float("inf")
            rows.append(Visible(candidate.key, f.name, smallest, largest))
        return rows

    amount = f"{len(simplest)} effects, each simulated at several amounts"
    for done, rows in enumerate(task.executor.map(amounts, simplest.values())):
        if done % max(len(simplest) // 4, 1) == 0:
            task.progress(f"predicting what {len(task.train)} runs can show: {done} of {amount}")
        found += rows
    return found


def largest_limit(met: float, at: float, upper: float, smallest: float) -> float:
    """The largest limit that shows, of a signal that reaches `met`: the response to a limit `at`
    some value stands out of the noise at the amount `smallest`, were it counted from `upper`; it
    grows with what is cut off, met - at. NaN where no limit above zero shows.
    """
    cut = (met - at) * smallest / (upper - at)
    return float(met - cut) if cut < met else float("nan")


def _smallest(column: FloatArray, others: FloatArray, by: float = SEEN) -> float:
    """The amount whose response, `column` [n] per unit, stands out of unit noise `by` so many
    standard deviations beside what `others` [n, k] can follow.
    """
    size = float(np.linalg.norm(projected_off(column[:, None], others)))
    least = np.sqrt(NOTHING) * float(np.linalg.norm(column))
    return by / size if size > least else float("inf")
