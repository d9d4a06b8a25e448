"""The report of the thesis: thesis.json, the figures, and thesis.tex with its PDF."""

from collections.abc import Callable, Mapping, Sequence
from string import ascii_lowercase

from ptp_symbolic.report.latex_text import PREAMBLE, escaped, formulas, table, unit_latex
from ptp_symbolic.report.source import THESIS
from ptp_symbolic.thesis import (
    backlash,
    configurations,
    contact,
    errata,
    friction,
    friction_laws,
    ramp_items,
    responses,
    rigid,
    tilt_drive,
)
from ptp_symbolic.thesis.chapter_figures import all_figures
from ptp_symbolic.thesis.figures import ThesisFigure, rendered
from ptp_symbolic.thesis.items import Item, Kind
from ptp_symbolic.thesis.precision_tables import precision_section
from ptp_symbolic.thesis.record import json_text, summary
from ptp_symbolic.thesis.wording import text_latex, value_latex

# below a row of several lines, so that it does not lean on the next one
STRUT = r"\rule[-5pt]{0pt}{0pt}"
# in mm, the width of the first column beside this unit and beside shorter ones
LONGEST_UNIT, RESULT_WIDTH, WIDE_RESULT = "N m s/rad", 61, 73
INTRODUCTION = (
    rf"\emph{{The thesis}} is {THESIS}\par "
    r"""Every result that it computes is computed here again. Printed values are taken over exactly,
wrong ones included; computed values come out of this program. \emph{Agrees} means within the
tolerance that the check or the last printed digit states; a number points to the erratum that
explains a difference. The measurements behind Tables 4.1 and 4.2 are not printed: data are made
from the printed parameters and fitted again. \emph{Recovered} says that such a round trip came
back; it tests the fit and its data, and says nothing about the thesis. A dash stands where there is
nothing to compare: the thesis prints no value, or not the measurements behind it. The curves of the
thesis are pictures, so the figures show the computed ones alone. Its drawings, bond graphs and data
flows are left out."""
)


PARTS: Mapping[str, tuple[Callable[[], list[Item]], ...]] = {
    "Configurations and equations (2.3.1, 3.1)": (configurations.items,),
    "Friction (2.3.2.1)": (friction_laws.items,),
    "Backlash gap (4.1)": (backlash.items,),
    "Steady friction (4.2)": (friction.items,),
    "Ramp test (4.3)": (ramp_items.items,),
    "Rigid platform (5.1, 5.2)": (rigid.items,),
    "Tilt drive (3.2.3.2, 5.3)": (tilt_drive.items,),
    "Pan drive (5.4)": (responses.items, contact.items),
    "Errata": (errata.items,),
}


def _silent(_: str) -> None:
    pass


def thesis_files(progress: Callable[[str], None] = _silent) -> dict[str, str | bytes]:
    """``thesis.json``, ``thesis.tex`` and every figure as PDF and PNG, by file name.

    `progress` is told what is being computed; all of it takes about half a minute.
    """
    items: dict[str, list[Item]] = {}
    for part, makers in PARTS.items():
        progress(part)
        items[part] = [item for make in makers for item in make()]
    progress("Figures")
    figures = all_figures()
    files: dict[str, str | bytes] = {
        "thesis.json": json_text(items, figures),
        "thesis.tex": latex_text(items, figures),
    }
    for group in figures.values():
        for figure in group:
            files.update(rendered(figure))
    return files


def _headline(items: Mapping[str, Sequence[Item]]) -> str:
    """What was computed, what only came back, and what there is nothing to compare with."""
    count = summary(items)
    computed, trips = count[Kind.COMPUTED], count[Kind.ROUND_TRIP]
    rows = [
        [
            "computed from the equations and from other printed numbers",
            computed["items"],
            f"{computed['agree']} agree, {computed['differ_by_an_erratum']} differ by an erratum,"
            f" {computed['differ_unexplained']} unexplained",
        ],
        [
            "round trip: fitted to data made from the printed value",
            trips["items"],
            f"{trips['agree']} recovered, {trips['differ_by_an_erratum']} differ by an"
            f" erratum, {trips['differ_unexplained']} unexplained",
        ],
        ["nothing printed", count[Kind.NOTHING_PRINTED]["items"], "nothing to compare with"],
        [
            "about measurements that are not printed",
            count[Kind.MEASUREMENTS_NOT_PRINTED]["items"],
            "cannot be recomputed",
        ],
        ["errata", count[Kind.ERRATUM]["items"], f"{count[Kind.ERRATUM]['settled']} settled"],
    ]
    return table(
        "L{86mm}rL{63mm}", ["results", "number", "outcome"], [[*map(str, r)] for r in rows]
    )


def latex_text(
    items: Mapping[str, Sequence[Item]], figures: Mapping[str, Sequence[ThesisFigure]]
) -> str:
    """The report as LaTeX; it needs the figures beside it."""
    parts = [
        PREAMBLE,
        r"\usepackage{graphicx}",
        # no page ends between a sentence and the list that it announces
        r"\makeatletter\@beginparpenalty=10000\makeatother",
        r"\title{The pan-tilt thesis, recomputed}\author{}\date{}\begin{document}\maketitle",
        INTRODUCTION,
        _headline(items),
        *(
            _errata(group) if part == "Errata" else _results(part, group)
            for part, group in items.items()
        ),
        precision_section(),
        *(_figures(part, group) for part, group in figures.items()),
        r"\end{document}",
    ]
    return "\n\n".join(parts) + "\n"


def _results(part: str, items: Sequence[Item]) -> str:
    """The table of a part; the last column names the note below that says how it was computed."""
    listed = [i for i in items if not i.id.startswith("eq_3_8")]
    checks = list(dict.fromkeys(i.check for i in listed))
    notes = {check: ascii_lowercase[k] for k, check in enumerate(checks)}
    rows = [
        [
            text_latex(i.title) + STRUT,
            value_latex(i.printed),
            value_latex(i.computed),
            unit_latex(i.unit),
            _verdict(i),
            notes[i.check],
        ]
        for i in listed
    ]
    wide = RESULT_WIDTH if any(i.unit == LONGEST_UNIT for i in listed) else WIDE_RESULT
    columns = rf"L{{{wide}mm}}L{{20mm}}L{{23mm}}lll"
    head = ["result", "printed", "computed", "unit", "verdict", "note"]
    text = rf"\section{{{escaped(part)}}}" + table(columns, head, rows)
    lines = "".join(rf"\item[{note}] {text_latex(check)}" + "\n" for check, note in notes.items())
    text += r"Notes on how the rows with that letter were computed:"
    text += rf"\begin{{itemize}}\setlength{{\itemsep}}{{0pt}}{lines}\end{{itemize}}"
    return text + (_equation_3_8(items) if len(listed) < len(items) else "")


def _equation_3_8(items: Sequence[Item]) -> str:
    names = {
        "mass_pan": r"M_{\mathrm{pan}}",
        "mass_tilt": r"M_{\mathrm{tilt}}",
        "mass_pan_tilt": r"M_{\mathrm{pan,tilt}}",
        "torque_pan": r"f_{\mathrm{pan}}",
        "torque_tilt": r"f_{\mathrm{tilt}}",
    }
    equal = all(i.agrees for i in items if i.id.startswith("eq_3_8"))
    text = r"\subsection*{Eq. 3.8, term by term} " + (
        "Derived by Lagrange's equations from the platform of Table 5.1; every entry minus the"
        f" printed one is {'zero' if equal else 'NOT zero'} in trigonometric normal form."
    )
    derived = configurations.derived_equation_3_8()
    return text + formulas([(name, derived[key]) for key, name in names.items()])


def _errata(items: Sequence[Item]) -> str:
    rows = [
        [
            str(i.erratum),
            text_latex(i.title.partition(": ")[2]),
            value_latex(i.printed),
            " ".join(
                [value_latex(i.computed)] + [unit_latex(i.unit)] * isinstance(i.computed, float)
            ),
            text_latex(i.check) + STRUT,
            "settled" if i.settled else "open",
        ]
        for i in items
    ]
    head = ["no.", "where", "as printed", "what holds", "check", ""]
    text = r"\section{Errata} Each with the check that settles it, computed in this run."
    return text + r"{\footnotesize " + table("rL{24mm}L{26mm}L{30mm}L{56mm}l", head, rows) + "}"


def _figures(part: str, figures: Sequence[ThesisFigure]) -> str:
    blocks = [
        rf"\begin{{minipage}}{{\textwidth}}\includegraphics[width=150mm]{{{f.name}.pdf}}\par"
        rf" {{\small {_round_trip(f)}{text_latex(f.caption)}}}\end{{minipage}}\par\bigskip"
        for f in figures
    ]
    return rf"\section{{Figures: {escaped(part)}}}" + "\n" + "\n\n".join(blocks)


def _round_trip(figure: ThesisFigure) -> str:
    return r"\emph{Round trip.} " if figure.kind is Kind.ROUND_TRIP else ""


def _verdict(item: Item) -> str:
    if item.agrees is None:
        return "--"
    if item.agrees:
        return "recovered" if item.kind is Kind.ROUND_TRIP else "agrees"
    return "differs" if item.erratum is None else f"erratum {item.erratum}"
