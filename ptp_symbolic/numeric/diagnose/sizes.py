"""How large a named effect is, in a few words for a headline."""

import re
from collections.abc import Mapping

import numpy as np

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.trial import Trial
from ptp_symbolic.numeric.identify.intervals import Estimate

_PART = re.compile(r"(\w+_)(sin|cos)(\d?)(_\w+)")  # a part of a wave of `harmonics`


def sizes_of(after: Trial, intervals: Mapping[str, Estimate]) -> dict[str, str]:
    """How large every named effect of the trial `after` is, by its key: of the parameters that
    switch it on the one that is clearest of zero, of a wave the amplitude, with its number of
    cycles where that was found, of what nothing switches off its first one; angles in degrees.
    """
    units, found = after.fit.model.units, {}
    for c in after.candidates:
        if c.is_declared_value or not c.free:
            continue
        shown = c.defining or c.free[:1]
        free = max(
            shown, key=lambda f: _clear_of_zero(intervals[f.name], c.vanishing.get(f.name, 0.0))
        )
        name, value = _amplitude(free.name, c, intervals)
        found[c.key] = f"{name} = {_written(value, units[free.name])}"
        if c.locked is not None:
            cycles = c.locked[0]
            found[c.key] += f", {cycles} = {_written(intervals[cycles].value, units[cycles])}"
    return found


def _amplitude(
    name: str, candidate: Candidate, intervals: Mapping[str, Estimate]
) -> tuple[str, float]:
    """What a parameter amounts to, and its value: with the other part of its wave the amplitude."""
    part, value = _PART.fullmatch(name), intervals[name].value
    if part is None:
        return name, value
    begin, kind, order, end = part.groups()
    other = f"{begin}{'cos' if kind == 'sin' else 'sin'}{order}{end}"
    if other not in candidate.vanishing or other not in intervals:
        return name, value
    which = f"amplitude of harmonic {order}" if order else "amplitude"
    return which, float(np.hypot(value, intervals[other].value))


def _written(value: float, unit: str) -> str:
    if unit in ("rad", "rad/s"):
        value, unit = float(np.degrees(value)), unit.replace("rad", "deg")
    return f"{value:.3g} {unit}".removesuffix(" 1")


def _clear_of_zero(estimate: Estimate, vanishing: float) -> float:
    """Distance of a value from the one that switches its effect off, in widths of its interval."""
    width = estimate.upper - estimate.lower
    known = np.isfinite(width) and width > 0.0
    return abs(estimate.value - vanishing) / width if known else 0.0
