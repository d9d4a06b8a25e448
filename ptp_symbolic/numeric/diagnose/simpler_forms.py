"""Every candidate of a set in the simplest of its forms that will do."""

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.gain import gain, p_value
from ptp_symbolic.numeric.diagnose.refits import expected_gain, forms
from ptp_symbolic.numeric.diagnose.seeker import Seeker
from ptp_symbolic.numeric.diagnose.trial import Trial, fitted
from ptp_symbolic.numeric.identify.constants import ITERATIONS, MOST


def simplified(seeker: Seeker, trial: Trial) -> Trial:
    """Every candidate in the simplest of its forms that loses nothing clear and material. A
    form is not fitted where linear prediction loses most, and not to its end where that
    foresees a material loss and most is lost after some iterations.
    """
    for key in trial.keys:
        candidate = next(c for c in trial.candidates if c.key == key)
        simpler = sorted(
            (c for c in forms(seeker.task, candidate) if len(c.free) < len(candidate.free)),
            key=lambda c: len(c.free),
        )
        for form in simpler:
            names = {f.name for f in form.free}
            lost = {n: v for n, v in candidate.vanishing.items() if n not in names}
            foreseen = expected_gain(trial, lost)
            if foreseen > MOST:
                continue
            smaller = begun_in_form(seeker, trial, candidate, form)
            if foreseen >= seeker.task.material and gain(trial, smaller).share >= MOST:
                continue
            smaller = seeker.polished(smaller)
            if not seeker.is_earned(gain(trial, smaller), p_value(trial, lost), ()):
                trial = smaller
                break
    return trial


def begun_in_form(seeker: Seeker, trial: Trial, candidate: Candidate, form: Candidate) -> Trial:
    """The trial refitted, by some iterations, with a candidate in another form."""
    dropped = set(candidate.parameters) - set(form.parameters)
    values = trial.values | {name: seeker.task.fixed[name] for name in dropped}
    candidates = tuple(form if c is candidate else c for c in trial.candidates)
    task, run = seeker.task, seeker.task.executor
    return fitted(task, candidates, values, trial.fit.z, ITERATIONS, trial.fit, executor=run)
