"""Diagnose a declared platform: search for what it lacks, and decide.

What a diagnosis found beside rivals that know no physics.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.black_box import FreeRuns, black_box, require_library
from ptp_symbolic.numeric.data import Log, log_files, read_split_logs
from ptp_symbolic.numeric.diagnose.fitted_model import SearchProblem, tolerance_for
from ptp_symbolic.numeric.diagnose.preparation import inverted_inputs
from ptp_symbolic.numeric.diagnose.stepwise import Search
from ptp_symbolic.numeric.diagnose.verdict import Verdict
from ptp_symbolic.numeric.identify.constants import ROUGH
from ptp_symbolic.numeric.identify.evidence import Allowance, recording
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.platform import Platform
from ptp_symbolic.workflows.preparation import look_at, workers
from ptp_symbolic.workflows.provenance import provenance
from ptp_symbolic.workflows.result import Output, Progress
from ptp_symbolic.workflows.stored_evidence import FILE, Header, Keeper, keeper_of
from ptp_symbolic.workflows.structure_choice import Logs, chosen_structure
from ptp_symbolic.workflows.write_up import written_up

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
    platform: Platform,
    problem: SearchProblem,
    found: Search,
    verdict: Verdict,
    validate: Sequence[Log],
) -> dict[str, Any]:
    """The comparison as plain data, judged on the whole `validate` logs; no axes where the machine
    has no equation space.
    """
    space = found.proposals.space
    if space is None:
        return {"about": NO_ROWS, "half_width": None, "axes": {}, "free": {}}
    problem.progress("training models that know no physics")
    added = verdict.final.candidates
    free = FreeRuns(
        problem.model,
        verdict.before.runs,
        problem.model.parameter_vector(verdict.declared.values),
        (verdict.before.z, verdict.after.z),
        tolerance_for(problem, ROUGH),
    )
    names = {f.name for c in added for f in c.free}
    compared = black_box(
        space,
        problem.whole,
        prepare_runs(problem.model, platform, tuple(validate)),
        verdict.declared.values,
        verdict.final.values if added else None,
        f"{len(names)} parameter{'s' if len(names) != 1 else ''}",
        free,
    )
    return {"about": FITTED, **compared}


SAMPLES = 4e8  # 1; that a search may simulate, unless a multiple is asked for; measured
TIME_LIMIT = 900.0  # s; of the search, unless another is asked for


def diagnose_platform(
    platform: Platform,
    train: Iterable[Path | str],
    validate: Iterable[Path | str],
    progress: Progress = lambda text: None,
    command: str | None = None,
    rivals: bool = False,
    time_limit: float | None = None,
    effort: float = 1.0,
    resume: Path | None = None,
    keep: Path | None = None,
) -> Output:
    """Fit `platform` to the `train` logs, find what it lacks, judge on the `validate` logs.

    `command` is the command line that asks for it, for the report; with `rivals` what is found is
    compared with models that know no physics. The search ends
    with what it has tried when it has simulated `effort` times SAMPLES samples, the same on every
    machine, or at the latest after `time_limit`, in s (None: TIME_LIMIT); the verdict and the
    report follow. What was evaluated is taken from the evidence in the file or folder `resume`, and
    written into the folder `keep` meanwhile. Raises InputError for logs and platforms that do not
    fit each other, for a run in both, for limits that are none, for rivals without the library that
    they need, and for evidence of other logs, another platform or another version.
    """
    limit = TIME_LIMIT if time_limit is None else time_limit
    if not limit > 0.0:
        raise InputError(f"`time_limit`: {limit:g} s is no time; give one above zero, such as 300.")
    if not 0.0 < effort < float("inf"):
        raise InputError(f"`effort`: {effort:g} is none; give a factor above zero, such as 2.")
    if rivals:
        require_library()
    fitted, judging = log_files(train), log_files(validate)
    train_logs, validate_logs = read_split_logs(fitted, judging, platform)
    read = {"train": (fitted, train_logs), "validate": (judging, validate_logs)}
    sources = provenance(platform, read, command)
    options = {
        "effort": effort,
        "platform": None if platform.source is None else str(Path(platform.source).resolve()),
        "train": [str(Path(path).resolve()) for path in fitted],
        "validate": [str(Path(path).resolve()) for path in judging],
    }
    keeper = keeper_of(Header.of(platform, sources, options), resume, keep)
    noted = look_at(platform, train_logs, (*train_logs, *validate_logs), progress)
    with workers() as executor, recorded_in(keeper):
        work = keeper.evidence.work
        allowance = Allowance(work, samples=effort * SAMPLES, seconds=limit)
        logs = Logs(tuple(train_logs), tuple(validate_logs), executor, progress, allowance)
        choice = chosen_structure(platform, logs)
        chosen = choice.chosen
        if choice.is_cut_short:
            noted = (_cut_short(allowance, effort), *noted)
        if chosen.verdict.leaves_more:
            noted = (*noted, *inverted_inputs(chosen.found.problem, chosen.found.declared))
        beside = None
        if rivals:
            beside = against_black_box(
                chosen.platform, chosen.problem, chosen.found, chosen.verdict, validate_logs
            )
        found = written_up(platform, choice, noted, sources, beside)
    files = {FILE: keeper.content(), **found.files}  # the one named last is written last
    return replace(found, files=files)


@contextmanager
def recorded_in(keeper: Keeper) -> Iterator[None]:
    """Record evidence, and write it as it grows, and where something ends it early."""
    keeper.evidence.changed = keeper.write_if_due
    try:
        with recording(keeper.evidence):
            yield
    except BaseException:
        keeper.write()
        raise


def _cut_short(allowance: Allowance, effort: float) -> str:
    if allowance.is_out_of_time:
        return (
            f"The search was stopped by the clock after {allowance.seconds:g} s: what it found"
            " depends on the speed of this machine. Give it more time, from where it ended."
        )
    return (
        f"The search came to its limit of {allowance.samples:.3g} simulated samples: what it had"
        f" not tried by then may be found with more effort (it was {effort:g})."
    )
