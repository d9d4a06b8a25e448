"""LaTeX building blocks: escaped text, tables, formulas that break over lines."""

import re
from collections.abc import Sequence

import sympy as sp

from ptp_symbolic.symbolic.documents.latex import LINE_WIDTH, latex_lines, lines_as_they_are

PREAMBLE = r"""\documentclass[a4paper,10pt]{article}
\usepackage[T1]{fontenc}
\usepackage{lmodern}
\usepackage{amsmath}
\usepackage[margin=20mm]{geometry}
\usepackage{longtable}
\usepackage{booktabs}
\usepackage{array}
\newcolumntype{L}[1]{>{\raggedright\arraybackslash}p{#1}}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt}
\allowdisplaybreaks
\setlength{\jot}{1.5pt}
\setlength{\LTpre}{4pt}
\setlength{\LTpost}{6pt}
\raggedbottom
\makeatletter % room for numbers such as 10.10 in the list of contents
\renewcommand*\l@subsection{\@dottedtocline{2}{1.5em}{3em}}
\makeatother"""

SPECIAL = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}
SHORT_NAME = 12
NUMBER = 3  # width of the number of an equation, beyond the margin that it has
SHORT_TABLE = 12


def escaped(text: str) -> str:
    """Text with every character that LaTeX would act on made harmless."""
    return "".join(SPECIAL.get(c, c) for c in text)


def table(columns: str, head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table; one with many rows may break over pages, a short one stays together."""
    lines = [" & ".join(row) + r" \\" for row in rows]
    title, columns = " & ".join(head) + r" \\ \midrule", rf"{{@{{}}{columns}@{{}}}}\toprule"
    if len(rows) <= SHORT_TABLE:
        begin, end = r"\par\smallskip\begin{tabular}", r"\end{tabular}\par\medskip{}"
    else:
        title += r"\endhead"
        begin, end = r"\begin{longtable}[l]", r"\end{longtable}"
    return "\n".join([begin + columns, title, *lines, rf"\bottomrule{end}"])


def formulas(
    rows: Sequence[tuple[str, sp.Expr]],
    relation: str = "=",
    together: int = 0,
    with_numbers: bool = False,
    as_it_is: bool = False,
) -> str:
    """Displayed formulas one below another; a long sum breaks before its terms.

    The last lines, as many as are to stay `together`, are not torn apart by the end of a page.
    `with_numbers`, every formula has a number behind its last line. `as_it_is`, it is not written
    more shortly.
    """
    if not rows:
        return ""
    widest = max(len(re.sub(r"\\[a-z]+|[{}_\\]", "", left)) for left, _ in rows)
    room = LINE_WIDTH - max(0, widest - SHORT_NAME) - (NUMBER if with_numbers else 0)
    lines = []
    for left, right in rows:
        first, *more = lines_as_they_are(right, room) if as_it_is else latex_lines(right, room)
        own = [f"{left} {relation}{{}}& {first}", *(f"& {line}" for line in more)]
        lines += [*(rf"{line} \notag" for line in own[:-1]), own[-1]] if with_numbers else own
    free = max(len(lines) - together, 0)
    ends = [r" \\" if k < free else r" \\*" for k in range(len(lines) - 1)]
    text = "\n".join(f"{line}{end}" for line, end in zip(lines, [*ends, ""], strict=True))
    name = "align" if with_numbers else "align*"
    return f"\\begin{{{name}}}\n{text}\n\\end{{{name}}}\n"


def numbered(rows: Sequence[tuple[str, sp.Expr]], relation: str = "=", together: int = 0) -> str:
    """Displayed `formulas`, each with a number."""
    return formulas(rows, relation, together, with_numbers=True)


def displayed(text: str) -> str:
    """LaTeX mathematics as a display of its own."""
    return f"\\[\n{text}\n\\]\n"


def number_latex(value: float) -> str:
    """A number with four digits, powers of ten as in print."""
    mantissa, _, power = f"{value:.4g}".partition("e")
    return rf"{mantissa}\cdot10^{{{int(power)}}}" if power else mantissa


def unit_latex(unit: str) -> str:
    """A unit set upright, with thin spaces and raised powers; empty for a pure number."""
    if unit in ("", "1"):
        return ""
    words = re.sub(r"\^(-?\d+)", r"^{\1}", unit).replace(" ", r"\,")
    words = re.sub(r"\bohm\b", r"\\Omega", words)
    return rf"$\mathrm{{{words}}}$"
