"""Words, names and numbers of the thesis report as LaTeX."""

import re

from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.thesis.items import Value

GREEK = "alpha|beta|omega|theta|phi|psi|tau"
SYMBOL = re.compile(
    rf"\b(?P<name>[A-Za-z]{{1,2}}(?:_[A-Za-z0-9]+)+|(?:{GREEK})(?:_[A-Za-z0-9]+)*\b)"
    r"(?:\^(?P<power>-?\d+))?|\^(?P<alone>-?\d+)|\b(?P<number>\d+(?:\.\d+)?e[+-]?\d+)\b"
)


def value_latex(value: Value) -> str:
    """A printed or computed value; a dash where there is none."""
    if value is None:
        return "--"
    return text_latex(value) if isinstance(value, str) else number_latex(float(value))


def number_latex(value: float, digits: int = 6) -> str:
    """A number with so many significant digits, a power of ten written as one."""
    text = f"{value:.{digits}g}"
    mantissa, _, exponent = text.partition("e")
    return rf"${mantissa}\cdot 10^{{{int(exponent)}}}$" if exponent else f"${text}$"


def text_latex(text: str) -> str:
    """Escaped text; names such as F_s or omega_pan, powers and 2e-07 become formulas."""
    parts, end = [], 0
    for found in SYMBOL.finditer(text):
        parts.append(_words(text[end : found.start()]))
        end = found.end()
        if found["number"]:
            parts.append(number_latex(float(found["number"])))
            continue
        power = found["power"] or found["alone"]
        raised = f"^{{{power}}}" if power else ""
        name = found["name"] or ""
        symbol = rf"\{name}" if name in GREEK.split("|") else symbol_latex(name)
        parts.append(f"${symbol}{raised}$")
    return "".join([*parts, _words(text[end:])])


def _words(text: str) -> str:
    """Escaped text that may break after a slash or a bracket, and not before a percent sign."""
    for plain, written in ((" %", r"\,\%"), ("<", "$<$"), (">", "$>$")):
        text = text.replace(plain, f"\0{written}\0")
    pieces = text.split("\0")
    kept = [
        piece
        if number % 2
        else "".join(escaped(c) + (r"\allowbreak{}" if c in "/)]" else "") for c in piece)
        for number, piece in enumerate(pieces)
    ]
    return "".join(kept)
