"""Every candidate by itself over a few short windows: what the motion alone does not show.

Windows forget: neither a rest nor a bounce in a gap that ends a sample late leads a fit astray
there, so that a few iterations tell how much a candidate is worth, and at which values.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.proposals import Proposals, start_for
from ptp_symbolic.numeric.diagnose.trial import Task, Trial, fitted, halving, ranked
from ptp_symbolic.numeric.identify.constants import ITERATIONS, TRIED


def screened(
    task: Task,
    found: Proposals,
    kept: Sequence[Candidate],
    wanted: Sequence[Candidate],
    values: Mapping[str, float],
) -> list[Trial]:
    """The set `kept` with those of the candidates `wanted`, and with what they bring along, that
    fit a few windows of the task best, the best first. A candidate is tried in its simplest and in
    its fullest form. A fit begins where the rows start the set, or at `values` and the candidate's
    own start, whichever is better, and the windows where they begin without it; after every
    iteration half of the fits go on.
    """
    part = replace(task, train=task.few)
    z = fitted(part, kept, values, None, executor=task.executor).fit.z
    have = {c.key for c in kept}
    by_key = {c.key: c for c in reversed(task.candidates)}

    def begun(candidate: Candidate) -> Trial:
        added = [by_key[key] for key in candidate.brings if key not in have]
        own = {name: f.start for c in (*added, candidate) for f in c.free for name in f.names}
        whole = {**values, **own, **candidate.shapes[0]}
        candidates = (*kept, *added, candidate)
        starts = [whole, start_for(task, found, candidates, whole, linear=True)]
        return ranked([fitted(part, candidates, start, z) for start in starts])[0]

    own: dict[str, list[Candidate]] = {}
    for c in sorted(wanted, key=lambda c: len(c.free)):
        if c.key not in have:
            own.setdefault(c.key, []).append(c)
    ends = [c for forms in own.values() for c in (forms[0], *forms[1:][-1:])]
    trials = list(task.executor.map(begun, ends))
    rungs = [max(len(trials) >> k, TRIED) for k in range(1, ITERATIONS + 1)]
    best: dict[tuple[str, ...], Trial] = {}
    for trial in halving(part, trials, *rungs, iterations=1):
        best.setdefault(trial.keys, trial)
    return list(best.values())
