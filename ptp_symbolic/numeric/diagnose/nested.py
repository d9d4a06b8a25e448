"""The declared model and the sets that contain it: neither is stuck where the other shows a way.

A set fits no worse than the declared model, which it contains, and what it gains is only worth a
name where the declared model had the same chance.
"""

from ptp_symbolic.numeric.diagnose.gain import gain
from ptp_symbolic.numeric.diagnose.left_over import Carried
from ptp_symbolic.numeric.diagnose.refits import polished
from ptp_symbolic.numeric.diagnose.starts import taken_over
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, fitted, halving, is_near, ranked


def beside_declared(task: Task, trial: Trial, declared: Trial, carried: Carried) -> Trial:
    """A trial that fits worse than the declared model, begun anew beside that, its effects as they
    are or at their vanishing values; `carried` as in `Search`.
    """
    own = {name: trial.values[name] for c in trial.candidates for name in c.names}
    off = {n: c.vanishing[f.name] for c in trial.candidates for f in c.defining for n in f.names}
    begun = [
        fitted(task, trial.candidates, values, declared.fit.z, 0, declared.fit)
        for values in (declared.values | own, declared.values | own | off)
    ]
    left = halving(task, begun, 1)
    return ranked([trial, *(polished(task, t, carried) for t in left)])[0]


def declared_from(task: Task, trial: Trial, declared: Trial, carried: Carried) -> Trial | None:
    """The declared model fitted from where a trial ended, as it is and where it takes over what the
    effects did; None unless that is materially better than `declared`, which was in a local minimum
    then.
    """
    left = halving(task, taken_over(task, (), trial), 1)
    again = [polished(task, t, carried) for t in left if is_near(t, [declared])]
    best = ranked([declared, *again])[0]
    return best if gain(best, declared).share >= task.material else None
