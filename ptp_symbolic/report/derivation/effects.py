"""Every effect of the platform in a section of its own, printed from what its file states."""

import re
from collections.abc import Sequence
from itertools import groupby

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform
from ptp_symbolic.report.derivation.curves import curve
from ptp_symbolic.report.derivation.power import power
from ptp_symbolic.report.latex_text import escaped, numbered, table, unit_latex
from ptp_symbolic.report.source import THESIS
from ptp_symbolic.symbolic.codegen.comparison import Change, comparison
from ptp_symbolic.symbolic.codegen.latex import latex_of, symbol_latex
from ptp_symbolic.symbolic.codegen.laws import Law, laws
from ptp_symbolic.symbolic.codegen.statements import (
    RELATIONS,
    Statement,
    statements,
)
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations, Ledger
from ptp_symbolic.symbolic.derivation.removal import without_effect


def effects(platform: Platform, equations: Equations) -> str:
    """Section with a part for every effect: its law, a drawing of it, its power, its states, and
    what it adds to which equation.
    """
    found = laws(platform)
    parts = [rf"\section{{Effects}} \emph{{The thesis}} is {THESIS}"]
    parts += [effect_section(law, platform, equations) for law in found]
    return "\n".join(parts)


def effect_section(law: Law, platform: Platform, equations: Equations) -> str:
    """What one effect is and what it does to the equations."""
    title = law.effect.title + (f", {law.axis} axis" if law.axis else "")
    parts = [
        rf"\subsection{{{escaped(title[:1].upper() + title[1:])}}}",
        rf"\texttt{{{escaped(law.effect.id)}}}; reference: {escaped(law.effect.reference)}.",
        displayed_rows(law.rows, equations),
    ]
    try:
        rest, gone = without_effect(platform, law.effect.id, law.axis)
        before = assemble(rest)
    except InputError as error:
        said = escaped(str(error).removeprefix(f"{platform.source}: "))
        return "\n".join([*parts, curve(law, (), equations), rf"Not compared without it: {said}"])
    changes = comparison(statements(before), statements(equations))
    parts += [
        curve(law, changes, equations),
        power(law, _difference(equations.ledger, before.ledger), equations),
        _states(law, equations),
    ]
    if gone:
        names = ", ".join(rf"\texttt{{{escaped(e.id)}}}" for e in gone)
        parts.append(rf"\par Compared without it, and without what needs it: {names}.")
    shown = {(row.left, row.right) for row in law.rows}
    parts.append(displayed_changes([c for c in changes if _is_news(c, shown)]))
    return "\n".join(part for part in parts if part)


def _is_news(change: Change, shown: set[tuple[object, object]]) -> bool:
    """Whether a change is not among the formulas `shown` already, nor told in words as a switch."""
    statement = change.statement
    return statement.key[0] != "switch" and (statement.left, statement.right) not in shown


def _difference(with_it: Ledger, without: Ledger) -> Ledger:
    return Ledger(
        with_it.stored - without.stored,
        with_it.power_in - without.power_in,
        with_it.dissipated - without.dissipated,
    )


def displayed_rows(rows: Sequence[Statement], equations: Equations) -> str:
    """Formulas with what they say in words above them, and the quantities of others they name."""
    parts = []
    for name, group in groupby(rows, key=lambda s: s.name):
        for relation, own in groupby(group, key=lambda s: s.relation):
            words = in_words(equations.worded(name[:1].upper() + name[1:]))
            formulas = numbered([(s.left_latex, s.right) for s in own], RELATIONS[relation][0])
            parts.append(rf"\par {words}:{formulas}")
    named = {symbol for s in rows for symbol in s.right.free_symbols}
    meant = [(symbol_latex(n), e) for n, e in equations.quantities if n in map(str, named)]
    if meant:
        parts.append("where" + numbered(meant))
    return "\n".join(parts)


def _states(law: Law, equations: Equations) -> str:
    """States, switches, samplers and limits of an effect."""
    own = law.contribution
    rows = [
        [
            f"${symbol_latex(s.name)}$",
            escaped(equations.worded(s.meaning)),
            unit_latex(s.unit),
            f"{s.initial:g}",
        ]
        for s in own.states
    ]
    parts = []
    if rows:
        parts.append(
            r"\par Its states:" + table("lL{90mm}lr", ["symbol", "meaning", "unit", "start"], rows)
        )
    for switch in own.switches:
        deviation, threshold, drive = map(
            latex_of, (switch.deviation, switch.threshold, switch.drive)
        )
        parts.append(
            rf"\par \texttt{{{escaped(switch.name)}}} switches on where $|{deviation}|$ reaches"
            rf" ${threshold}$ while ${drive}$ drives it further, and off where ${drive}$ changes"
            " sign."
        )
    for sampler in own.samplers:
        names = ", ".join(f"${latex_of(s)}$" for s in sampler.updates)
        parts.append(rf"\par {names}: set every ${latex_of(sampler.period)}$, held in between.")
    for limit in own.limits:
        name = latex_of(limit.state)
        parts.append(
            rf"\par It holds within the {escaped(limit.meaning)}:"
            + numbered([(name, limit.lower)], r"\ge")
            + numbered([(name, limit.upper)], r"\le")
        )
    return "\n".join(parts)


def in_words(text: str) -> str:
    """Escaped text, names of symbols in it as they are printed in formulas."""
    return re.sub(
        r"\b([A-Za-z0-9]+(?:\\_[A-Za-z0-9]+)+)\b",
        lambda found: f"${symbol_latex(found[1].replace(chr(92), ''))}$",
        escaped(text).replace("±", r"$\pm$"),
    )


def displayed_changes(changes: Sequence[Change]) -> str:
    """What one machine has that another has not, equation by equation."""
    parts = []
    for change in changes:
        statement = change.statement
        left, relation = statement.left_latex, RELATIONS[statement.relation][0]
        words = in_words(statement.name)
        if change.gone:
            parts.append(rf"\par Gone: {words}.")
        elif change.added is not None:
            parts.append(
                rf"\par Added to {words}:" + numbered([(rf"\Delta {left}", change.added)], relation)
            )
        else:
            new = "New" if change.before is None else "Now"
            parts.append(rf"\par {new}: {words}:" + numbered([(left, statement.right)], relation))
    return "\n".join(parts)
