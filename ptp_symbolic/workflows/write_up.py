"""A diagnosis written up: its summary, and every file of it."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.diagnose.curves import curves_of
from ptp_symbolic.numeric.diagnose.floor import Floor
from ptp_symbolic.numeric.diagnose.hints import further_hints
from ptp_symbolic.numeric.diagnose.remainder import hints, remainder
from ptp_symbolic.numeric.diagnose.residual_tests import residual_tests
from ptp_symbolic.numeric.diagnose.sizes import sizes_of
from ptp_symbolic.numeric.diagnose.summary import (
    added_effects,
    error_table,
    fit_table,
    gain_table,
    headline,
    ranking,
    repeatability_table,
)
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.numeric.identify.replays import estimable
from ptp_symbolic.platform import Platform, platform_text
from ptp_symbolic.report.changes import render_changes
from ptp_symbolic.report.diagnosis import render_diagnosis, write_curves_csv
from ptp_symbolic.report.drawing import drawn
from ptp_symbolic.report.latex_text import PREAMBLE, escaped
from ptp_symbolic.report.pdf import with_pdf
from ptp_symbolic.symbolic.codegen.effect_equations import effect_equations
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.workflows.preparation import with_effects
from ptp_symbolic.workflows.result import SCHEMA_VERSION, Output, json_text, windows_table
from ptp_symbolic.workflows.structure_choice import Choice


def written_up(
    platform: Platform,
    choice: Choice,
    noted: Sequence[str],
    sources: Mapping[str, Any],
    beside: Mapping[str, Any] | None = None,
) -> Output:
    """What was found, as data and as files; `sources` say what it rests on (see `provenance`), and
    `beside` how rivals do that know no physics.
    """
    chosen = choice.chosen
    task, found, verdict = chosen.task, chosen.found, chosen.verdict
    after = verdict.final
    intervals = {e.name: e for e in estimates(verdict.estimated)}
    before = verdict.estimated
    if after is not verdict.declared:
        before = estimable(verdict.declared.fit, task.input_noise, task.executor)
    parts = {
        "train": (verdict.declared.fit, after.fit),
        "validate": (verdict.before, verdict.after),
    }
    errors = error_table(parts, verdict.floor)
    extended = with_effects(chosen.platform, after)
    module, doubts = _module_of(extended)
    doubts += _carried_remarks(platform, verdict.floor)
    doubts += _tied_remarks(platform) if verdict.leaves_more else []
    named = [c for c in after.candidates if not c.is_declared_value]
    equations = [e for c in named for e in effect_equations(extended, c.id, c.axis)]
    space = found.proposals.space
    left = remainder(space, after.values) if verdict.leaves_more else None
    further = further_hints(after, space) if verdict.leaves_more else []
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "verdict": verdict.word,
        "summary": headline(verdict, errors, sizes_of(after, intervals)),
        "fitted_to": "torques" if verdict.is_along_motion else "outputs",
        "added": added_effects(verdict, after, intervals),
        "ranking": _ranking(choice),
        "error": errors,
        "repeatability": repeatability_table(task.whole, task.model.units),
        "residual_tests": residual_tests(verdict.after, task.model.input_names),
        "fit": {
            "before": {"parameters": fit_table(verdict.declared, estimates(before))},
            "after": {"parameters": fit_table(after, tuple(intervals.values()))},
        },
        "held_out": None if verdict.held_out is None else gain_table(verdict.held_out),
        "refused": dict(verdict.refused),
        "remainder": left,
        "hints": [*hints(left), *further],
        "black_box": None if beside is None else dict(beside),
        "windows": windows_table(found.task),
        "material": task.material,
        "remarks": [*noted, *doubts],
        "equations": equations,
        "provenance": dict(sources),
    }
    changes = task.executor.submit(with_pdf, render_changes(platform, extended, summary), "changes")
    curves = curves_of(parts)
    files: dict[str, str | bytes] = {"platform.toml": platform_text(extended)}
    files["equations.tex"] = equations_tex(equations)
    files |= module
    marked = {name for candidate in after.candidates for name in candidate.parameters}
    machine = drawn(extended, assemble(extended), marked)
    files["report.html"] = render_diagnosis(summary, curves, machine)
    files.update({f"curves/{name}": text for name, text in write_curves_csv(curves).items()})
    files |= changes.result()  # pdflatex runs beside the drawing
    files["diagnosis.json"] = json_text(summary)
    return Output(summary, files, extended, curves)


def _ranking(choice: Choice) -> list[dict[str, Any]]:
    """Structures first, then sets of terms of the chosen structure and of the declared one, then
    what was not tried, and why.
    """
    rows = list(choice.rows)
    outcomes = [choice.chosen] if choice.chosen.structure is None else [choice.chosen, choice.terms]
    for outcome in outcomes:
        sets = ranking(outcome.found, outcome.verdict, outcome.task.candidates)
        if outcome is not choice.chosen:
            sets = [{**row, "accepted": False} for row in sets]
        rows += [{**row, "structure": list(outcome.keys)} for row in sets]
    rows += [
        {
            "effect": effect,
            "axis": axis or None,
            "structure": [],
            "gain": None,
            "gain_along_motion": None,
            "train_error_after": None,
            "parameters": {},
            "accepted": False,
            "why": why,
        }
        for (effect, _, axis), why in ((key.partition("@"), w) for key, w in choice.untried.items())
    ]
    return rows


def _module_of(extended: Platform) -> tuple[dict[str, str], list[str]]:
    """The module of an extended platform, as a file; or why such a machine cannot exist, though its
    logs look like it: a value that was declared may be wrong too.
    """
    try:
        return {f"{extended.name}.py": emission.module_of(extended)}, []
    except InputError as error:
        return {}, [f"The declared and the found values exclude each other. {error}"]


def _carried_remarks(platform: Platform, floor: Floor) -> list[str]:
    """Inputs whose noise, estimated from the logs, leaves more in an output than its own does. A
    command that a controller computed from a noisy angle looks noisy, and is known exactly.
    """
    names = [s.signal for s in platform.signals if s.role == "input" and s.noise is None]
    if not names or np.all(floor.carried.usual <= floor.noise):
        return []
    return [
        f"The noise of {' and '.join(names)}, estimated from the logs, leaves more than that of the"
        " outputs. Where an input is logged as it was commanded, declare `noise = 0.0` for it: then"
        " smaller effects show."
    ]


def _tied_remarks(platform: Platform) -> list[str]:
    """Ties that may be what is wrong: no candidate undoes one."""
    return [
        f"{p.name} is declared the same as {p.same_as}, which is not put in doubt; with a `start`"
        " in place of `same_as` it is fitted."
        for p in platform.parameters
        if p.same_as is not None
    ]


def equations_tex(equations: list[dict[str, Any]]) -> str:
    """The added equations as a LaTeX document of its own."""
    rows = [f"\\[\n{e['latex']}\n\\]\n" for e in equations]
    titles = [escaped(f"{e['title'][:1].upper()}{e['title'][1:]}") for e in equations]
    text = "\n".join(f"{title}:\n{row}" for title, row in zip(titles, rows, strict=True))
    text = text or "No effect was added to the equations.\n"
    return f"{PREAMBLE}\n\\begin{{document}}\n{text}\\end{{document}}\n"
