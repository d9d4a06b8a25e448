"""Sets that grow and shrink by one candidate at a time: stepwise selection, of all candidates or of
effects alone.
"""

from ptp_symbolic.numeric.diagnose.findings import Step
from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.seeker import Seeker
from ptp_symbolic.numeric.diagnose.starts import taken_over
from ptp_symbolic.numeric.diagnose.trial import Trial, ranked
from ptp_symbolic.numeric.diagnose.tried import worth_keeping
from ptp_symbolic.numeric.identify.constants import LARGEST, MOST


def extended(
    seeker: Seeker, best: Trial, steps: list[Step], end: Trial | None = None
) -> tuple[Trial, list[Step]]:
    """A pruned trial with one candidate more as long as one is needed, up to the set of `end`, to
    which none could be added before; and the `steps` of its candidates. A candidate that leads the
    way may be dropped once others are there: then there is room for one more.
    """
    material = seeker.task.material
    for rounds in range(2 * LARGEST):
        if rounds >= LARGEST <= len(best.candidates):
            break
        if end is not None and best.keys == end.keys and gain(best, end).share < material:
            break
        seeker.tried.others[:] = worth_keeping(seeker.tried.others, best)
        grown = seeker.grown(best)
        if grown is None:
            break
        seeker.tried.others.append(best)
        full = seeker.completed(grown)
        if gain(grown, best).share >= MOST:  # one that gains less has been begun anew before
            full = seeker.restarted(full)
        pruned, fewer = seeker.pruned(full)
        same = pruned.keys == best.keys
        if same and ranked([best, pruned])[0] is best:
            break
        seeker.follow(pruned)
        best, steps = pruned, fewer  # the same candidates too: a third may show them a better place
    return best, steps


def floated(seeker: Seeker, best: Trial, steps: list[Step]) -> tuple[Trial, list[Step]]:
    """The trial, or a better one from where a set goes without one of its candidates: what stands
    in for an effect hides it as long as it is there (floating search: Pudil, Novovicova and
    Kittler, 1994).
    """
    if seeker.is_at_noise(best):
        return best, steps
    for step in steps:
        others = tuple(c for c in seeker.task.candidates if c.key != step.candidate.key)
        grown = seeker.among(others).grown(step.without, briefly=True)
        if grown is not None and gain(grown, best).share >= seeker.task.material:
            seeker.tried.others.append(best)
            return extended(seeker, *seeker.pruned(seeker.completed(grown)))
    return best, steps


def by_effects_alone(
    seeker: Seeker, best: Trial, steps: list[Step], end: Trial | None = None
) -> tuple[Trial, list[Step]]:
    """The trial, or its effects alone where these leave only noise, or what forward selection from
    the declared model makes of effects alone, if that fits better, or leaves only noise too with no
    more parameters. `end` is that of `extended`.

    Declared values are known, and a few of them changed together imitate much: they scale all
    torques of an axis that is driven by a voltage. So they are taken out together: torque constant
    and resistance change nothing but the viscous friction where one goes with the other, and none
    can be done without alone then. A single one that leaves only noise is not doubted here.
    """
    quiet = seeker.is_at_noise(best)
    known = [c for c in best.candidates if c.is_declared_value]
    if quiet and (not known or len(best.candidates) == 1):
        return best, steps
    effects = tuple(c for c in best.candidates if not c.is_declared_value)
    if known and effects:
        left = seeker.polished(ranked(taken_over(seeker.task, effects, best))[0])
        if seeker.is_at_noise(left):
            seeker.tried.others.append(best)
            return seeker.pruned(left)
        seeker.tried.others.append(left)
    alone = seeker.among(tuple(c for c in seeker.task.candidates if not c.is_declared_value))
    other, fewer = extended(alone, seeker.declared, [], end)
    no_larger = seeker.is_at_noise(other) and len(other.fit.free) <= len(best.fit.free)
    if ranked([best, other])[0] is best and not (quiet and no_larger):
        seeker.tried.others.append(other)
        return best, steps
    seeker.tried.others.append(best)
    return other, fewer
