"""A diagnosis written up: its summary, and every file of it."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.diagnose.confirm import at_bound
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.hints import further_hints
from ptp_symbolic.numeric.diagnose.noise_floor import NoiseFloor
from ptp_symbolic.numeric.diagnose.remainder import hints, remainder, residual_tests
from ptp_symbolic.numeric.diagnose.summary import (
    added_effects,
    curves_of,
    error_table,
    fit_table,
    gain_table,
    headline,
    ranking,
    repeatability_table,
    sizes_of,
)
from ptp_symbolic.numeric.diagnose.verdict import reasons
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.numeric.identify.windows import estimable
from ptp_symbolic.platform import Platform, platform_text
from ptp_symbolic.report.changes import interval, render_changes
from ptp_symbolic.report.diagnosis import render_diagnosis, write_curves_csv
from ptp_symbolic.report.drawing import drawn
from ptp_symbolic.report.latex_equations import in_words
from ptp_symbolic.report.latex_text import PREAMBLE, escaped, table, unit_latex
from ptp_symbolic.report.pdf import with_pdf
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import (
    available_quantities,
    find_effect,
    place_effects,
)
from ptp_symbolic.symbolic.documents.effect_equations import effect_equations
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.effects import EFFECTS
from ptp_symbolic.workflows.preparation import with_effects
from ptp_symbolic.workflows.result import SCHEMA_VERSION, Output, json_text
from ptp_symbolic.workflows.structure_choice import Choice

TAKEN_OVER = (
    "The declared model fits better from the values of an extended model than from its declared"
    " start values. The error before is that of the better fit; fit alone may end in the worse one."
)
NOT_TRIED = "not tried: "  # begins a reason that lies in the effect, not in the platform

STOPPED = " The search was stopped before its end: the remarks say by what."


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
    problem, found, verdict = chosen.problem, chosen.found, chosen.verdict
    after = verdict.final
    intervals = {e.name: e for e in estimates(verdict.estimated)}
    before = verdict.estimated
    if after is not verdict.declared:
        before = estimable(verdict.declared.fit, problem.input_noise, problem.executor)
    parts = {
        "train": (verdict.declared.fit, after.fit),
        "validate": (verdict.before, verdict.after),
    }
    errors = error_table(parts, verdict.floor)
    extended = with_effects(chosen.platform, after)
    module, doubts = _module_of(extended)
    doubts += _propagated_remarks(platform, verdict.floor)
    doubts += _tied_remarks(platform) if verdict.leaves_more else []
    if choice.terms.found.is_taken_over:
        doubts.append(TAKEN_OVER)
    named = [c for c in after.candidates if not c.is_declared_value]
    equations = [e for c in named for e in effect_equations(extended, c.id, c.axis)]
    space = found.proposals.space
    left = remainder(space, after.values) if verdict.leaves_more else None
    further = further_hints(after, space) if verdict.leaves_more else []
    if verdict.leaves_more:
        tried = [t for t in (verdict.closest, found.chosen, *found.tried.others) if t is not None]
        further += _bound_hints(platform, tried, verdict.refused)
        further += _untried_hints(platform, choice.untried)

    added = added_effects(verdict, after, intervals)
    summary = {
        "schema_version": SCHEMA_VERSION,
        "platform": {"name": platform.name, "title": platform.title},
        "verdict": verdict.word,
        "summary": headline(verdict, errors, sizes_of(after, intervals))
        + (STOPPED if choice.is_cut_short else ""),
        "fitted_to": "torques" if verdict.is_along_motion else "outputs",
        "added": added,
        "ranking": _ranking(choice),
        "error": errors,
        "repeatability": repeatability_table(problem.whole, problem.model.units),
        "residual_tests": residual_tests(verdict.after, problem.model.input_names),
        "fit": {
            "before": {"parameters": fit_table(verdict.declared, estimates(before))},
            "after": {"parameters": fit_table(after, tuple(intervals.values()))},
        },
        "held_out": None if verdict.held_out is None else gain_table(verdict.held_out),
        "why": reasons(found, verdict, len(choice.rows)),
        "refused": dict(verdict.refused),
        "remainder": left,
        "hints": [*hints(left), *further],
        "black_box": None if beside is None else dict(beside),
        "windows": errors["train"]["after"]["windows"],
        "material": problem.material,
        "remarks": [*noted, *doubts],
        "equations": equations,
        "provenance": dict(sources),
    }
    changes = problem.executor.submit(
        with_pdf, render_changes(platform, extended, summary), "changes"
    )
    curves = curves_of(parts)
    files: dict[str, str | bytes] = {"platform.toml": platform_text(extended)}
    files["equations.tex"] = equations_tex(equations, added, assemble(extended))
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
        sets = ranking(outcome.found, outcome.verdict, outcome.problem.candidates)
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


def _bound_hints(
    platform: Platform, tried: Sequence[FittedModel], refused: Mapping[str, str]
) -> list[str]:
    """Of declared values that ended at the end of what they may be, in the first of the trials (the
    closest) or where that is why they are not named: how to let them go farther.
    """
    said: dict[str, str] = {}
    for number, trial in enumerate(tried):
        for c in trial.candidates:
            bound = at_bound(trial.fit, c) if c.is_declared_value else None
            if bound is not None and (number == 0 or c.key in refused):
                said.setdefault(bound, _farther(platform, bound, trial.values[bound]))
    return list(said.values())


def _farther(platform: Platform, name: str, end: float) -> str:
    """What to write so that a declared value may be twice as far off as the `end` of its range."""
    (own,) = (p for p in platform.parameters if p.name == name)
    unit = own.unit or "1"
    wider = 2.0 * abs(end - own.value)
    range_of = "its uncertainty" if own.uncertainty is not None else "a factor of two"
    return (
        f"The declared value of {name}, {own.value:.6g} {unit}, ended at its bound of {end:.6g}"
        f" {unit}, the end of {range_of}: it may be farther off. Declare how far, as in"
        f' {name} = {{ value = {own.value:.6g}, unit = "{unit}", uncertainty = {wider:.3g} }}, and'
        " run diagnose again."
    )


def _untried_hints(platform: Platform, untried: Mapping[str, str]) -> list[str]:
    """Candidates that were not tried for want of something that could be declared, those that want
    the same together, and those that could not be fitted, with the reason.
    """
    wanting: dict[str, list[str]] = {}
    for key, why in untried.items():
        identifier, _, axis = key.partition("@")
        effect = find_effect(identifier)
        if not (effect.searched or effect.structure):
            continue
        wanted = _wanted(platform, effect, axis or None)
        if wanted:
            on_axis = f" on {axis}" if axis else ""
            wanting.setdefault(f"for want of {wanted}{on_axis}, not declared", []).append(key)
        elif not why.startswith(NOT_TRIED):
            wanting.setdefault(why, []).append(key)
    return [f"Not tried: {', '.join(keys)} ({why})." for why, keys in wanting.items()]


def _wanted(platform: Platform, effect: Effect, axis: str | None) -> str:
    """Effects that would have to be declared for `effect` to be a candidate; empty where none is
    lacking, or where none would do.
    """
    placed = place_effects(platform)
    given = effect.structure
    needs = [n.format(axis=axis) for n in (given.needs if given else effect.needs)]
    missing = {n for n in needs if n not in available_quantities(placed)}
    bringing = {name: list[str]() for name in missing}
    for other in EFFECTS:
        place = Place(platform.axes, axis, None, frozenset(), bool(platform.linear_axes))
        if other is effect or other.on_axis != (axis is not None):
            continue
        if not (platform.linear_axes and other.instead_on_linear):
            for name in missing & available_quantities([*placed, (other, place)]):
                bringing[name].append(other.id)
    if given and given.in_place_of:
        own = {e.effect for e in platform.effects if e.axis == axis}
        if not own.intersection(given.in_place_of):
            bringing["in place of"] = list(given.in_place_of)
    if not all(bringing.values()):
        return ""
    return " and ".join(sorted({" or ".join(ids) for ids in bringing.values()}))


def _module_of(extended: Platform) -> tuple[dict[str, str], list[str]]:
    """The module of an extended platform, as a file; or why such a machine cannot exist, though its
    logs look like it: a value that was declared may be wrong too.
    """
    try:
        return {f"{extended.name}.py": emission.module_of(extended)}, []
    except InputError as error:
        return {}, [f"The declared and the found values exclude each other. {error}"]


def _propagated_remarks(platform: Platform, floor: NoiseFloor) -> list[str]:
    """Inputs whose noise, estimated from the logs, leaves more in an output than its own does. A
    command that a controller computed from a noisy angle looks noisy, and is known exactly.
    """
    names = [s.signal for s in platform.signals if s.role == "input" and s.noise is None]
    if not names or np.all(floor.propagated.median <= floor.noise):
        return []
    return [
        f"The noise of {' and '.join(names)}, estimated from the logs, causes a larger error than"
        " that of the outputs. Where an input is logged as it was commanded, declare `noise = 0.0`"
        " for it: then smaller effects are visible."
    ]


def _tied_remarks(platform: Platform) -> list[str]:
    """Ties that may be what is wrong: no candidate undoes one."""
    return [
        f"{p.name} is declared the same as {p.same_as}, which is not tested; with a `start`"
        " in place of `same_as` it is fitted."
        for p in platform.parameters
        if p.same_as is not None
    ]


def equations_tex(
    equations: Sequence[Mapping[str, Any]],
    added: Sequence[Mapping[str, Any]],
    machine: Equations,
) -> str:
    """The added equations as a LaTeX document of its own, with meaning, value and 95 % interval of
    the parameters of what was `added` to the `machine`.
    """
    rows = [f"\\[\n{e['latex']}\n\\]\n" for e in equations]
    titles = [in_words(f"{e['title'][:1].upper()}{e['title'][1:]}") for e in equations]
    text = "\n".join(f"{title}:\n{row}" for title, row in zip(titles, rows, strict=True))
    text = text or "No effect was added to the equations.\n"
    meanings = {p.name: p.meaning for p in machine.parameters}
    values = [
        [
            f"${symbol_latex(name)}$",
            escaped(meanings.get(name, "")),
            unit_latex(own["unit"]),
            f"{own['value']:.6g}",
            interval(own.get("ci95")),
        ]
        for effect in added
        for name, own in effect["parameters"].items()
    ]
    head = ["symbol", "meaning", "unit", "value", r"95\,\% interval"]
    text += table("lL{62mm}lrl", head, values) if values else ""
    return f"{PREAMBLE}\n\\begin{{document}}\n{text}\\end{{document}}\n"
