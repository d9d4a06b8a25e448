"""What each rule of the diagnosis is worth: the verdicts that change without it.

The decisions are made again upon stored evidence, which takes a second or so each. A rule that is
switched off may lead where nothing was evaluated: then its price is not known.
"""

import json
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any
from unittest.mock import patch

from ptp_symbolic.numeric.data import Log, read_split_logs
from ptp_symbolic.numeric.diagnose import along_rows, search, structures
from ptp_symbolic.numeric.diagnose.fitted_model import SearchProblem
from ptp_symbolic.numeric.diagnose.proposals import in_rows_of, propose
from ptp_symbolic.numeric.identify.evidence import (
    Allowance,
    Entry,
    Evidence,
    NotStoredError,
    key_of,
    recording,
)
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.workflows import preparation, structure_choice, structure_fits
from ptp_symbolic.workflows.diagnosis import SAMPLES
from ptp_symbolic.workflows.preparation import model_of, problem_for, workers
from ptp_symbolic.workflows.provenance import provenance
from ptp_symbolic.workflows.rules import RULES, Rule, switched_off
from ptp_symbolic.workflows.stored_evidence import FILE, Header, read_evidence, written
from ptp_symbolic.workflows.structure_choice import Logs, chosen_structure
from tests.benchmark.rule_lines import rule_lines
from tests.benchmark.score import score


@dataclass(frozen=True)
class Answer:
    """A verdict with the effects that it names and those that these are confused with; `grade` is
    its class where the truth is known; `missing` evaluations kept it from being reached.
    """

    verdict: str = ""
    named: tuple[tuple[str, tuple[str, ...]], ...] = ()
    grade: str = ""
    missing: int = 0

    def __str__(self) -> str:
        if self.missing:
            return f"needs {self.missing} refits that were not made"
        names = [" or ".join([key, *alike]) for key, alike in self.named]
        return f"{self.verdict} ({', '.join(names) or 'no name'})"


@dataclass(eq=False)
class Case:
    """Stored evidence with all that it rests on, to be decided upon again and again.

    What rules have no part in is made once: models, runs, and the rows along the motion.
    """

    folder: Path
    header: Header
    entries: dict[str, Entry]
    platform: Platform
    train: tuple[Log, ...]
    validate: tuple[Log, ...]
    made: dict[str, Any] = field(default_factory=dict)

    @classmethod
    def read(cls, folder: Path) -> "Case":
        """The evidence in a folder. Raises InputError where it, or its logs, cannot be read."""
        path, header, entries = read_evidence(folder)
        options = header.options
        here = (folder / "truth.json").exists()
        platform = read_platform(folder / "platform.toml" if here else options["platform"])
        parts = {}
        for part in ("train", "validate"):
            files = [Path(name) for name in options[part]]
            parts[part] = [folder / part / f.name for f in files] if here else files
        logs = read_split_logs(parts["train"], parts["validate"], platform)
        read = {part: (parts[part], own) for part, own in zip(parts, logs, strict=True)}
        header.refuse_other(path, Header.of(platform, provenance(platform, read, None), options))
        return cls(folder, header, entries, platform, *map(tuple, logs))

    def answer(self, rule: Rule | None, *, simulate: bool) -> Answer:
        """The verdict without a rule (None: with all of them)."""
        evidence = Evidence(self.entries, simulates=simulate)
        limit = self.header.options["effort"] * SAMPLES
        allowance = Allowance(evidence.work, samples=limit)
        memory = self._made_once() if not simulate else switched_off(None)
        try:
            with recording(evidence), memory, switched_off(rule), workers() as executor:
                logs = Logs(self.train, self.validate, executor, lambda text: None, allowance)
                verdict = chosen_structure(self.platform, logs).chosen.verdict
        except NotStoredError as error:
            return Answer(missing=max(len(error.missing), 1))
        finally:
            if evidence.fresh:
                self.entries.update(evidence.fresh)
                (self.folder / FILE).write_bytes(written(self.header, self.entries))
        named = [(c, tuple(verdict.confusable[c.key])) for c in verdict.final.candidates]
        added = [
            {"effect": c.id, "axis": c.axis, "confusable_with": alike, "parameters": c.parameters}
            for c, alike in named
        ]
        grade, truth = "", self.folder / "truth.json"
        if truth.exists():
            given = {"verdict": verdict.word, "added": added}
            grade = score(json.loads(truth.read_text("utf-8")), given).answer
        return Answer(verdict.word, tuple((c.key, alike) for c, alike in named), grade)

    @contextmanager
    def _made_once(self) -> Iterator[None]:
        """Models, problems and proposals from memory, where they were made before."""

        def once(key: str, make: Callable[[], Any]) -> Any:
            if key not in self.made:
                self.made[key] = make()
            return self.made[key]

        def model(platform: Platform) -> Any:
            return once(key_of("model", platform), lambda: model_of(platform))

        def problem(platform: Platform, own: Any, *rest: Any) -> SearchProblem:
            *_, declared, executor, _progress, allowance = rest
            key = key_of("problem", platform, own, declared)
            found = once(key, lambda: problem_for(platform, own, *rest))
            material = preparation.material_of(platform)
            return replace(found, executor=executor, allowance=allowance, material=material)

        def proposed(given: SearchProblem) -> Any:
            parts = given.whole, given.free, given.candidates
            return once(key_of("proposals", given, *parts), lambda: propose(given))

        def in_rows(given: SearchProblem, space: Any, values: Any, beside: Any) -> Any:
            parts = given.whole, given.free, given.candidates, space.half_width, values, beside
            return once(key_of("rows", given, *parts), lambda: in_rows_of(given, space, *parts[4:]))

        with (
            patch.object(along_rows, "in_rows_of", in_rows),
            patch.object(structure_choice, "model_of", model),
            patch.object(structure_fits, "model_of", model),
            patch.object(structure_choice, "problem_for", problem),
            patch.object(structure_fits, "problem_for", problem),
            patch.object(search, "propose", proposed),
            patch.object(structures, "propose", proposed),
        ):
            yield


@dataclass(frozen=True)
class Change:
    """What happens to a verdict without a rule."""

    folder: Path
    before: Answer
    after: Answer

    @property
    def kind(self) -> str:
        """A change for the better or the worse, where the truth is known, another, or none."""
        if self.after.missing:
            return "needs"
        grades = self.before.grade, self.after.grade
        if grades[0] != grades[1]:
            return " -> ".join(grades)
        return "none" if str(self.before) == str(self.after) else "other"


def prices(
    folders: Sequence[Path], pattern: str, simulate: bool, value: float | None = None
) -> Iterator[str]:
    """A line for the verdict of every folder and for each that changes without a rule whose name
    has the pattern (or with another `value` of it), then one for every such rule with how many do,
    and how many lines of source go with it.

    One folder after the other: what is made of its logs takes most of the time, and the memory.
    """
    rules = [rule for rule in RULES if re.search(pattern, rule.name)]
    without = "without" if value is None else f"at {value:g} by"
    rules = rules if value is None else [rule.at(value) for rule in rules]
    found: dict[str, list[Change]] = {rule.name: [] for rule in rules}
    for folder in folders:
        case = Case.read(folder)
        usual = case.answer(None, simulate=simulate)
        yield f"{folder.name}: {usual.grade or 'truth not given'}: {usual}"
        for rule in rules if not usual.missing else ():
            change = Change(folder, usual, case.answer(rule, simulate=simulate))
            found[rule.name].append(change)
            if change.kind != "none":
                yield f"    {without} {rule.name}: {change.after}"
    lines = rule_lines(rules)
    for rule in rules:
        yield f"{rule.name}: {_counted(found[rule.name])}; {lines[rule.name]} lines"


def _counted(changes: Sequence[Change]) -> str:
    """How many verdicts change, by kind, and in which folders; what is missing at first."""
    folders: dict[str, list[str]] = {}
    for change in changes:
        name = change.folder.name
        number = re.match(r"\d+(?=-)", name)
        folders.setdefault(change.kind, []).append(number[0] if number else name)
    unchanged, needs = len(folders.pop("none", ())), folders.pop("needs", [])
    said = [f"{len(names)} {kind} ({', '.join(names)})" for kind, names in sorted(folders.items())]
    if unchanged:
        said.append(f"{unchanged} unchanged")
    if needs:
        missing = sum(change.after.missing for change in changes)
        said.append(f"{len(needs)} need refits, {missing} at first ({', '.join(needs)})")
    return ", ".join(said)
