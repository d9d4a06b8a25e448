"""Every effect of the platform in a section of its own, printed from what its file states."""

from collections.abc import Sequence

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform
from ptp_symbolic.report.derivation.curves import curve
from ptp_symbolic.report.derivation.power import power
from ptp_symbolic.report.derivation.results import EQUATIONS
from ptp_symbolic.report.latex_equations import displayed_changes, displayed_rows
from ptp_symbolic.report.latex_text import escaped, numbered, table, unit_latex
from ptp_symbolic.report.source import THESIS
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations, Ledger
from ptp_symbolic.symbolic.derivation.removal import without_effect
from ptp_symbolic.symbolic.documents.comparison import Change, comparison
from ptp_symbolic.symbolic.documents.latex import latex_of, symbol_latex
from ptp_symbolic.symbolic.documents.laws import Law, laws
from ptp_symbolic.symbolic.documents.statements import statements


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
    try:
        rest, gone = without_effect(platform, law.effect.id, law.axis)
        before = assemble(rest)
    except InputError as error:
        said = escaped(str(error).removeprefix(f"{platform.source}: "))
        return "\n".join([described(law, equations), rf"\par Not compared without it: {said}"])
    changes = comparison(statements(before), statements(equations))
    parts = [described(law, equations, changes, equations.ledger - before.ledger)]
    if gone:
        names = ", ".join(rf"\texttt{{{escaped(e.id)}}}" for e in gone)
        parts.append(
            rf"{{\raggedright\par Compared without it, and without what needs it: {names}.\par}}"
        )
    shown = {(row.left, row.right) for row in law.rows}
    parts.append(displayed_changes([c for c in changes if _is_news(c, shown)], EQUATIONS))
    return "\n".join(parts)


def described(
    law: Law,
    equations: Equations,
    changes: Sequence[Change] = (),
    difference: Ledger | None = None,
) -> str:
    """The law of an effect, a drawing of it, its power and states; `changes` and `difference` are
    those of the equations and the ledger where it is added.
    """
    effect = law.effect
    title = (effect.title or effect.id) + (f", {law.axis} axis" if law.axis else "")
    source = f"reference: {effect.reference}" if effect.reference else "it names no reference"
    parts = [
        rf"\subsection{{{escaped(title[:1].upper() + title[1:])}}}",
        rf"\texttt{{{escaped(effect.id)}}}; {escaped(source)}.",
        displayed_rows(law.rows, equations),
        curve(law, changes, equations),
        power(law, difference, equations),
        _states(law, equations),
    ]
    return "\n".join(part for part in parts if part)


def _is_news(change: Change, shown: set[tuple[object, object]]) -> bool:
    """Whether a change is not among the formulas `shown` already, nor told in words as a switch."""
    statement = change.statement
    return statement.key[0] != "switch" and (statement.left, statement.right) not in shown


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
