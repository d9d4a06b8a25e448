"""The report of the thesis: thesis.json, the figures, and thesis.tex with its PDF."""

import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from string import ascii_lowercase

from ptp_symbolic.report.latex_text import PREAMBLE, escaped, formulas, table, unit_latex
from ptp_symbolic.report.source import THESIS
from ptp_symbolic.symbolic.codegen.latex import symbol_latex
from ptp_symbolic.thesis import (
    backlash,
    configurations,
    contact,
    errata,
    friction,
    ramp_items,
    responses,
    rigid,
    tilt_drive,
)
from ptp_symbolic.thesis.chapter_figures import all_figures
from ptp_symbolic.thesis.figures import ThesisFigure, rendered
from ptp_symbolic.thesis.items import Item, Value

SCHEMA_VERSION = 1
# below a row of several lines, so that it does not lean on the next one
STRUT = r"\rule[-5pt]{0pt}{0pt}"
GREEK = "alpha|beta|omega|theta|phi|psi|tau"
SYMBOL = re.compile(
    rf"\b(?P<name>[A-Za-z]{{1,2}}(?:_[A-Za-z0-9]+)+|(?:{GREEK})(?:_[A-Za-z0-9]+)*\b)"
    r"(?:\^(?P<power>-?\d+))?|\^(?P<alone>-?\d+)"
)
INTRODUCTION = (
    rf"\emph{{The thesis}} is {THESIS}\par "
    r"""Every result that it computes is computed here again. Printed values are taken over exactly,
wrong ones included; computed values come out of this program or, where an independent one is asked
for, out of SciPy. \emph{Agrees} means within the tolerance that the check or the last printed digit
states; a number points to the erratum that explains a difference. A dash stands where there is
nothing to compare: the thesis prints no value, or not the measurements behind it. The curves of the
thesis are pictures, so the figures show the computed ones alone."""
)


PARTS: Mapping[str, tuple[Callable[[], list[Item]], ...]] = {
    "Configurations and equations (2.3.1, 3.1)": (configurations.items,),
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

    `progress` is told what is being computed; all of it takes about twenty seconds.
    """
    items: dict[str, list[Item]] = {}
    for part, makers in PARTS.items():
        progress(part)
        items[part] = [item for make in makers for item in make()]
    progress("Figures")
    figures = all_figures()
    files: dict[str, str | bytes] = {
        "thesis.json": json_text(items),
        "thesis.tex": latex_text(items, figures),
    }
    for group in figures.values():
        for figure in group:
            files.update(rendered(figure))
    return files


def summary(items: Mapping[str, Sequence[Item]]) -> dict[str, int]:
    """How many items there are, and how they compare."""
    everything = [item for group in items.values() for item in group]
    results = [item for item in everything if item.settled is None]
    return {
        "items": len(everything),
        "agree": sum(i.agrees is True for i in results),
        "differ_by_an_erratum": sum(i.agrees is False and i.erratum is not None for i in results),
        "differ_unexplained": sum(i.agrees is False and i.erratum is None for i in results),
        "nothing_to_compare": sum(i.agrees is None for i in results),
        "errata": len(everything) - len(results),
        "errata_settled": sum(bool(i.settled) for i in everything),
    }


def json_text(items: Mapping[str, Sequence[Item]]) -> str:
    """The items as JSON: schema_version, summary, and one object per item."""
    rows = [{"part": part, **asdict(item)} for part, group in items.items() for item in group]
    document = {"schema_version": SCHEMA_VERSION, "summary": summary(items), "items": rows}
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def latex_text(
    items: Mapping[str, Sequence[Item]], figures: Mapping[str, Sequence[ThesisFigure]]
) -> str:
    """The report as LaTeX; it needs the figures beside it."""
    count = summary(items)
    parts = [
        PREAMBLE,
        r"\usepackage{graphicx}",
        r"\title{The pan-tilt thesis, recomputed}\author{}\date{}\begin{document}\maketitle",
        INTRODUCTION,
        rf"\par {count['items'] - count['errata']} results: {count['agree']} agree,"
        rf" {count['differ_by_an_erratum']} differ by an erratum,"
        rf" {count['differ_unexplained']} differ without one, {count['nothing_to_compare']} have"
        rf" nothing to compare. {count['errata_settled']} of {count['errata']} errata are settled.",
        *(
            _errata(group) if part == "Errata" else _results(part, group)
            for part, group in items.items()
        ),
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
            _text(i.title) + STRUT,
            _value(i.printed),
            _value(i.computed),
            unit_latex(i.unit),
            _verdict(i),
            notes[i.check],
        ]
        for i in listed
    ]
    head = ["result", "printed", "computed", "unit", "verdict", "note"]
    text = rf"\section{{{escaped(part)}}}" + table("L{59mm}L{22mm}L{23mm}lll", head, rows)
    lines = "".join(rf"\item[{note}] {_text(check)}" + "\n" for check, note in notes.items())
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
            _text(i.title.partition(": ")[2]),
            _value(i.printed),
            " ".join([_value(i.computed)] + [unit_latex(i.unit)] * isinstance(i.computed, float)),
            _text(i.check) + STRUT,
            "settled" if i.settled else "open",
        ]
        for i in items
    ]
    head = ["no.", "where", "as printed", "what holds", "check", ""]
    text = r"\section{Errata} Each with the check that settles it, computed in this run."
    return text + r"{\footnotesize " + table("rL{24mm}L{26mm}L{30mm}L{50mm}l", head, rows) + "}"


def _figures(part: str, figures: Sequence[ThesisFigure]) -> str:
    blocks = [
        rf"\begin{{minipage}}{{\textwidth}}\includegraphics[width=150mm]{{{f.name}.pdf}}\par"
        rf" {{\small {_text(f.caption)}}}\end{{minipage}}\par\bigskip"
        for f in figures
    ]
    return rf"\section{{Figures: {escaped(part)}}}" + "\n" + "\n\n".join(blocks)


def _value(value: Value) -> str:
    if value is None:
        return "--"
    return _text(value) if isinstance(value, str) else _number(float(value))


def _number(value: float) -> str:
    text = f"{value:.6g}"
    mantissa, _, exponent = text.partition("e")
    return rf"${mantissa}\cdot 10^{{{int(exponent)}}}$" if exponent else f"${text}$"


def _verdict(item: Item) -> str:
    if item.agrees is None:
        return "--"
    if item.agrees:
        return "agrees"
    return "differs" if item.erratum is None else f"erratum {item.erratum}"


def _text(text: str) -> str:
    """Escaped text; names such as F_s or omega_pan and powers become formulas."""
    parts, end = [], 0
    for found in SYMBOL.finditer(text):
        parts.append(_words(text[end : found.start()]))
        power = found["power"] or found["alone"]
        raised = f"^{{{power}}}" if power else ""
        name = found["name"] or ""
        symbol = rf"\{name}" if name in GREEK.split("|") else symbol_latex(name)
        parts.append(f"${symbol}{raised}$")
        end = found.end()
    return "".join([*parts, _words(text[end:])])


def _words(text: str) -> str:
    """Escaped text that may break after a slash or a bracket, and not before a percent sign."""
    for plain, written in ((" %", r"\,\%"), ("<", "$<$"), (">", "$>$")):
        text = text.replace(plain, f"\0{written}\0")
    pieces = text.split("\0")
    kept = [
        piece
        if number % 2
        else "".join(escaped(c) + (r"\allowbreak{}" if c in "/()[]" else "") for c in piece)
        for number, piece in enumerate(pieces)
    ]
    return "".join(kept)
