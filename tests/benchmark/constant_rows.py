"""A row of the benchmark for every chosen constant: a few sets with it halved and doubled."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from ptp_symbolic.numeric.identify import constants
from tests.benchmark.entry import Entry
from tests.benchmark.runner import make_missing, read_set, run_under
from tests.benchmark.scaled import sections
from tests.benchmark.score import score

FACTORS = (0.5, 2.0)


def halved_and_doubled(entries: Sequence[Entry], out: Path, jobs: int) -> list[str]:
    """Diagnose the entries as the table of constants is and with every chosen constant halved and
    doubled; how many are right, and which are not: a line for each, that of the whole table first.
    """
    source = Path(str(constants.__file__)).read_text(encoding="utf-8")
    names = [name for part in sections(source).values() for name in part]
    scales = [None, *(f"{name}={factor}" for name in names for factor in FACTORS)]
    wanted = []
    for scale in scales:
        folder = out / (scale or "as_it_is")
        for entry in entries:
            if scale is None:
                make_missing(entry, folder / entry.id)
            elif not (folder / entry.id).exists():
                kept = shutil.ignore_patterns("outcome.json", "diagnosis.json", "usage.json")
                shutil.copytree(out / "as_it_is" / entry.id, folder / entry.id, ignore=kept)
            wanted.append((entry, folder, scale))
    run_under(wanted, jobs)
    lines = []
    for scale in scales:
        answers = {e.id: score(*read_set(out / (scale or "as_it_is") / e.id)) for e in entries}
        right = sum(answer.answer == "right" for answer in answers.values())
        amiss = [f"{k[:3]} {a.answer}" for k, a in answers.items() if a.answer != "right"]
        lines.append(" ".join([f"{scale or 'as it is'}: {right} of {len(entries)} right", *amiss]))
    return lines
