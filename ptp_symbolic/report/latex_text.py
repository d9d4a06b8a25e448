"""LaTeX building blocks: escaped text, tables, formulas that break over lines."""

import re
from collections.abc import Sequence

import sympy as sp

from ptp_symbolic.codegen.latex import latex_of

PREAMBLE = r"""\documentclass[a4paper,10pt]{article}
\usepackage[T1]{fontenc}
\usepackage{lmodern}
\usepackage{amsmath}
\usepackage[margin=22mm]{geometry}
\usepackage{longtable}
\usepackage{booktabs}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt}
\allowdisplaybreaks
\raggedbottom"""

SPECIAL = {
    "\\": r"\textbackslash{}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_",
    "{": r"\{", "}": r"\}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}",
}  # fmt: skip
LINE_WIDTH = 92
SHORT_NAME = 12


def escaped(text: str) -> str:
    """Text with every character that LaTeX would act on made harmless."""
    return "".join(SPECIAL.get(c, c) for c in text)


def table(columns: str, head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """A table that may break over pages."""
    lines = [" & ".join(row) + r" \\" for row in rows]
    return "\n".join(
        [
            rf"\begin{{longtable}}[l]{{@{{}}{columns}@{{}}}}\toprule",
            " & ".join(head) + r" \\ \midrule\endhead",
            *lines,
            r"\bottomrule\end{longtable}",
        ]
    )


def formula(text: str, expression: sp.Expr | None = None, name: str = "") -> str:
    """A displayed formula; a long sum breaks before its terms."""
    if expression is None:
        return f"\\[\n{text}\n\\]\n"
    if isinstance(expression, sp.MatrixBase):
        return f"\\[\n{name} = {latex_of(expression)}\n\\]\n"
    printed = re.sub(r"\\[a-z]+|[{}_\\]", "", name)
    lines = _lines(sp.expand(expression), LINE_WIDTH - max(0, len(printed) - SHORT_NAME))
    rows = [rf"{name} ={{}}& {lines[0]}", *(rf"& {line}" for line in lines[1:])]
    return "\\begin{align*}\n" + " \\\\\n".join(rows) + "\n\\end{align*}\n"


def _lines(expression: sp.Expr, room: int) -> list[str]:
    """Terms of a sum, as many on a line as fit into `room`."""
    lines: list[str] = []
    width = 0
    for number, term in enumerate(expression.as_ordered_terms(order="lex")):
        text = latex_of(term)
        signed = text if number == 0 or text.startswith("-") else f"+ {text}"
        size = _width(term)
        if lines and width + size <= room:
            lines[-1] += f" {signed}"
            width += size
        else:
            lines.append(signed)
            width = size
    return lines


def _width(term: sp.Expr) -> int:
    """Printed width of a term, roughly, in characters: names count without their underscores."""
    return len(sp.sstr(term).replace("_", "").replace("*", " ")) * 4 // 5 + 3
