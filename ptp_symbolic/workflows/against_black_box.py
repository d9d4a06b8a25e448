"""What a diagnosis found beside rivals that know no physics."""

from collections.abc import Sequence
from typing import Any

from ptp_symbolic.numeric.black_box import FreeRuns, black_box
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose.stepwise import Search
from ptp_symbolic.numeric.diagnose.trial import Task, tolerance_for
from ptp_symbolic.numeric.diagnose.verdict import Verdict
from ptp_symbolic.numeric.identify.constants import ROUGH
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import Platform

FITTED = (
    "The declared model and the named effects were fitted to the training runs. The black-box"
    " models were fitted to the residual torque (force of a linear joint) of the fitted declared"
    " model along the measured motion of the same runs, as a function of angles, rates, their signs"
    " and inputs; how strongly they are regularised was chosen by cross-validation over blocks of"
    " these runs. No model was fitted to the validation runs. All are judged by that torque,"
    " averaged over windows in which the joint slides, and in free simulation: there the torque of"
    " a black-box model acts on the joints of the declared model, constant between samples, from"
    " the fitted initial state of the declared or of the final model, whichever has the smaller"
    " error."
)
NO_ROWS = "The equations of this machine have no residual torque along its measured motion."


def against_black_box(
    platform: Platform, task: Task, found: Search, verdict: Verdict, validate: Sequence[Log]
) -> dict[str, Any]:
    """The comparison as plain data, judged on the whole `validate` logs; no axes where the machine
    has no equation space.
    """
    space = found.proposals.space
    if space is None:
        return {"about": NO_ROWS, "half_width": None, "axes": {}, "free": {}}
    task.progress("training models that know no physics")
    added = verdict.final.candidates
    free = FreeRuns(
        task.model,
        verdict.before.runs,
        task.model.parameter_vector(verdict.declared.values),
        (verdict.before.z, verdict.after.z),
        tolerance_for(task, ROUGH),
    )
    names = {f.name for c in added for f in c.free}
    compared = black_box(
        space,
        task.whole,
        prepare_runs(task.model, platform, tuple(validate)),
        verdict.declared.values,
        verdict.final.values if added else None,
        f"{len(names)} parameter{'s' if len(names) != 1 else ''}",
        free,
    )
    return {"about": FITTED, **compared}
