"""What one platform has that another has not, on paper; with a diagnosis the errors of both."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from ptp_symbolic import __version__
from ptp_symbolic.platform import Platform, effect_key
from ptp_symbolic.report.derivation.curves import PACKAGES
from ptp_symbolic.report.derivation.effects import described
from ptp_symbolic.report.derivation.named_functions import meaning_of
from ptp_symbolic.report.latex_equations import displayed_changes
from ptp_symbolic.report.latex_text import PREAMBLE, escaped, table, unit_latex
from ptp_symbolic.report.quantities import number
from ptp_symbolic.report.source import THESIS
from ptp_symbolic.report.tables import declared_totals, error_groups, error_measure
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.documents.comparison import Change, comparison
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.documents.laws import laws
from ptp_symbolic.symbolic.documents.statements import statements

Record = Mapping[str, Any]
SETS = {"validate": "never fitted", "train": "fitted"}


def shown_of(diagnosis: Record) -> Record:
    """The diagnosis; raises KeyError where it lacks what the document shows."""
    _ = diagnosis["summary"], diagnosis["error"]["train"]
    return diagnosis


def render_changes(
    before: Platform, after: Platform, diagnosis: Record | None = None
) -> dict[str, str | bytes]:
    """Return the document as ``changes.tex``; it needs no other file.

    Raises InputError for a platform that cannot be derived.
    """
    old, new = assemble(before), assemble(after)
    changes = comparison(statements(old), statements(new))
    parts = [
        PREAMBLE,
        PACKAGES,
        rf"\title{{\vspace{{-15mm}}{escaped(after.title)}\\",
        r"\large What was added to the equations}",
        rf"\author{{\small ptp-symbolic {__version__}}}\date{{}}",
        r"\begin{document}\maketitle",
        _compared(before, after),
        _errors(diagnosis) if diagnosis is not None else "",
        _effects(before, after, old, new, changes),
        _quantities(old, new, diagnosis or {}),
        r"\section{Equations, term by term}",
        displayed_changes(changes) or "No equation differs.",
        r"\end{document}",
    ]
    return {"changes.tex": "\n\n".join(part for part in parts if part) + "\n"}


def _compared(before: Platform, after: Platform) -> str:
    """What is compared with what; nothing where one platform was extended."""
    if (before.name, before.title) == (after.name, after.title):
        return ""
    rows = [
        [which, escaped(p.title), rf"\texttt{{{escaped(p.name)}}}"]
        for which, p in (("before", before), ("after", after))
    ]
    return table("lL{90mm}l", ["", "platform", "name"], rows)


def _errors(diagnosis: Record) -> str:
    """The error of every run before and after, beside the floor that noise sets."""
    key, unit = error_measure(declared_totals(diagnosis))
    rows = [
        [
            f"{SETS[group.set]}: {'all runs' if row.run is None else escaped(row.run)}",
            *(_figure(record.get(key)) for record in (row.before, row.after, row.noise_floor)),
        ]
        for group in error_groups(diagnosis, key)
        for row in group.rows
    ]
    head = ["runs", "before", "after", "noise alone"]
    verdict = escaped(str(diagnosis.get("verdict", "")).replace("_", " "))
    return (
        rf"\section{{Error before and after}}Verdict: {verdict}. {escaped(diagnosis['summary'])}"
        + table("L{80mm}rrr", head, rows)
        + rf"\noindent Root mean square, in {escaped(unit)}; the parameters of both machines are"
        r" fitted to the same runs."
    )


def _figure(value: Any) -> str:
    return escaped(number(value))


def _effects(
    before: Platform, after: Platform, old: Equations, new: Equations, changes: Sequence[Change]
) -> str:
    """The effects that were added, each with its law, those that act at another site, and those
    that are gone.
    """
    had, has = ({(e.effect.id, e.axis, e.effect.kind) for e in m.effects} for m in (old, new))
    added = [law for law in laws(after) if (law.effect.id, law.axis, law.effect.kind) in has - had]
    parts = [r"\section{Effects}"]
    parts += [rf"\emph{{The thesis}} is {THESIS}"] if added else ["No effect was added."]
    if len(added) == 1:  # all that changed is due to it
        parts.append(described(added[0], new, changes, new.ledger - old.ledger))
    else:
        parts += [described(law, new) for law in added]
    sites = {effect_key(e.effect, e.axis): e.site for e in before.effects}
    moved = [
        rf"\texttt{{{escaped(key)}}} to the {e.site or 'gear'}"
        for e in after.effects
        if sites.get(key := effect_key(e.effect, e.axis), e.site) != e.site
    ]
    if moved:
        parts.append(rf"\par Moved: {', '.join(moved)}.")
    if gone := sorted(had - has, key=str):
        names = ", ".join(rf"\texttt{{{escaped(name)}}}" for name, _, _ in gone)
        parts.append(rf"\par Gone: {names}.")
    return "\n".join(parts)


def _quantities(old: Equations, new: Equations, diagnosis: Record) -> str:
    """Parameters that are new, have another value or are gone; states and inputs likewise."""
    parts = [r"\section{Parameters and states}"]
    intervals = {
        name: value.get("ci95")
        for effect in diagnosis.get("added", ())
        for name, value in effect["parameters"].items()
    }
    fitted = _fitted_before(diagnosis)
    was, now = ({p.name: p for p in m.parameters} for m in (old, new))
    rows = [
        [
            f"${symbol_latex(p.name)}$",
            escaped(p.meaning),
            unit_latex(p.unit),
            f"{p.default:.6g}",
            interval(intervals.get(p.name)),
        ]
        for name, p in now.items()
        if name not in was
    ]
    if rows:
        head = ["symbol", "meaning", "unit", "value", r"95\,\% interval" if intervals else ""]
        parts.append(r"New parameters:\nopagebreak" + table("lL{62mm}lrl", head, rows))
    rows = [
        [
            f"${symbol_latex(p.name)}$",
            escaped(p.meaning),
            unit_latex(p.unit),
            f"{fitted.get(name, was[name].default):.6g}",
            f"{p.default:.6g}",
        ]
        for name, p in now.items()
        if name in was and f"{fitted.get(name, was[name].default):.6g}" != f"{p.default:.6g}"
    ]
    if rows:
        head = ["symbol", "meaning", "unit", "before", "after"]
        parts.append(r"\par Other values:\nopagebreak" + table("lL{62mm}lrr", head, rows))
    variables = [dict(_variables(m)) for m in (old, new)]
    rows = [
        [f"${symbol_latex(name)}$", escaped(meaning), unit_latex(unit), kind]
        for name, (meaning, unit, kind) in variables[1].items()
        if name not in variables[0]
    ]
    if rows:
        head = ["symbol", "meaning", "unit", ""]
        parts.append(r"\par New states and inputs:\nopagebreak" + table("lL{78mm}ll", head, rows))
    rows = [
        [f"${symbol_latex(str(s))}$", *_of_function(str(s))]
        for s, _ in new.terms
        if s not in dict(old.terms)
    ]
    if rows:
        parts.append(
            r"\par New functions:\nopagebreak"
            + table("lL{98mm}l", ["symbol", "meaning", "unit"], rows)
        )
    gone = [name for name in (*was, *variables[0]) if name not in now and name not in variables[1]]
    if gone:
        parts.append(r"\par Gone: " + ", ".join(f"${symbol_latex(name)}$" for name in gone) + ".")
    return "\n".join(parts if len(parts) > 1 else [*parts, "The same, with the same values."])


def _of_function(name: str) -> tuple[str, str]:
    meaning, unit = meaning_of(name)
    return meaning, unit_latex(unit)


def _fitted_before(diagnosis: Record) -> dict[str, float]:
    """The parameters of the declared machine as fitted to the runs, where there is a diagnosis."""
    before = (diagnosis.get("fit") or {}).get("before") or {}
    found = {name: own.get("value") for name, own in (before.get("parameters") or {}).items()}
    return {name: value for name, value in found.items() if value is not None}


def interval(ends: Sequence[float | None] | None) -> str:
    """The ends of an interval in print; nothing where there is none."""
    if not ends:
        return ""
    return "[" + ", ".join("?" if end is None else f"{end:.5g}" for end in ends) + "]"


def _variables(machine: Equations) -> Iterator[tuple[str, tuple[str, str, str]]]:
    """States of effects and inputs by name, with meaning, unit and kind."""
    for state in machine.extra_states:
        yield state.name, (machine.worded(state.meaning), state.unit, "state")
    for given in machine.inputs:
        yield given.name, (given.meaning, given.unit, "input")
