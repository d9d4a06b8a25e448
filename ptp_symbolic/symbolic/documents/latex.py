"""Formulas for documents: LaTeX, MathML and plain text, all printed from the expressions."""

import re

import sympy as sp
from sympy.printing.latex import LatexPrinter
from sympy.printing.mathml import mathml

from ptp_symbolic.symbolic.documents.letters import lettered
from ptp_symbolic.symbolic.simplify.readable import readable
from ptp_symbolic.symbolic.symbols import real

GREEK = {
    "theta",
    "omega",
    "tau",
    "alpha",
    "beta",
    "gamma",
    "delta",
    "epsilon",
    "eta",
    "kappa",
    "lambda",
    "mu",
    "phi",
    "psi",
    "rho",
    "sigma",
    "zeta",
    "chi",
    "iota",
    "nu",
    "varsigma",
    "vartheta",
    "xi",
}
LETTERS = {"gravity": "g"}
DERIVATIVES = {"dc": r"\Delta c", "dF": r"\Delta F"}
LARGEST_FRACTION = 2  # larger ones are measured numbers
LINE_WIDTH = 92
COLLECTED_BEFORE = 0.65  # of a line, of what stands before a collected sum
BRACKETS = 4  # width of a pair of them
ARGUMENT_WIDTH = 40  # of a maximum, beside what it is multiplied with
_SIGN = '<mo form="infix">{}</mo>'


def letter_and_place(name: str) -> tuple[str, list[str]]:
    """The letter of a symbol, and the words and numbers of its index."""
    letter, *place = LETTERS.get(name, lettered(name)).split("_")
    trailing = re.fullmatch(r"([A-Za-z]+)(\d+)", letter)
    return (trailing[1], [trailing[2], *place]) if trailing else (letter, place)


def symbol_latex(name: str) -> str:
    """LaTeX of a symbol name: ``theta_gear_pan`` becomes a theta with an upright subscript.

    Letters are set in italics, words upright; words in front become letters (see `lettered`).
    """
    letter, place = letter_and_place(name)
    word = letter if len(letter) <= 1 else rf"\mathrm{{{letter}}}"
    head = DERIVATIVES.get(letter, rf"\{letter}" if letter in GREEK else word)
    return rf"{head}_{{\mathrm{{{','.join(place)}}}}}" if place else head


def rate_latex(name: str) -> str:
    """LaTeX of the time derivative of a symbol: a dot above its letter."""
    head, line, place = symbol_latex(name).partition("_")
    return rf"\dot{{{head}}}{line}{place}"


def latex_of(expression: sp.Expr) -> str:
    """LaTeX of an expression, symbols as `symbol_latex` writes them."""
    expression = _with_decimals(expression)
    names = {s: symbol_latex(str(s)) for s in expression.free_symbols}
    return str(_Printer({"symbol_names": names, "order": "lex"}).doprint(expression))


class _Printer(LatexPrinter):
    """Prints long arguments of an extreme or a size on several lines, so that they stay on the
    page, and exponents in their shorter form, fractions beside ``exp``.
    """

    def _print_Max(self, expression: sp.Expr, exp: str | None = None) -> str:
        arguments = sorted(expression.args, key=str)
        written = [_stacked(argument) for argument in arguments]
        if not any(written):
            return str(self._hprint_variadic_function(expression, exp))
        own = [w or latex_of(a) for w, a in zip(written, arguments, strict=True)]
        power = "" if exp is None else f"^{{{exp}}}"
        name = type(expression).__name__.lower()
        return f"\\{name}{power}\\left({', '.join(own)}\\right)"

    _print_Min = _print_Max

    def _print_Abs(self, expression: sp.Abs, exp: str | None = None) -> str:
        written = _stacked(expression.args[0])
        if not written:
            return str(super()._print_Abs(expression, exp))
        power = "" if exp is None else f"^{{{exp}}}"
        return f"\\left|{written}\\right|{power}"

    def _print_ExpBase(self, expression: sp.exp, exp: str | None = None) -> str:
        given = expression.args[0]
        factored = sp.factor(given)
        shorter = factored if factored.count_ops() < given.count_ops() else given
        if exp is None and sp.fraction(shorter)[1] != 1:  # too small to be read as an exponent
            return rf"\exp\left({latex_of(shorter)}\right)"
        return str(super()._print_ExpBase(sp.exp(shorter, evaluate=False), exp))


def _stacked(argument: sp.Expr) -> str:
    """LaTeX of an argument on several lines; empty where one is enough."""
    lines = latex_lines(argument, ARGUMENT_WIDTH)
    if len(lines) == 1:
        return ""
    return "\\begin{aligned}& " + " \\\\ & ".join(lines) + "\\end{aligned}"


def latex_lines(expression: sp.Expr, room: int = LINE_WIDTH) -> list[str]:
    """LaTeX of an expression, the terms of a sum on as many lines as they need.

    It is written as `readable` writes it. A product with a long sum in it breaks inside the sum;
    another term that is too long is multiplied out.
    """
    return lines_as_they_are(readable(expression), room)


def lines_as_they_are(expression: sp.Expr, room: int) -> list[str]:
    """As `latex_lines`, but in the form that the expression has."""
    most = COLLECTED_BEFORE if _is_collected(expression, room) else 0.5
    product = _long_product(expression, room, most)
    if product is not None:
        before, inner = product
        return [f"{latex_of(before)} {_in_brackets(inner, room - _width(before) - BRACKETS)}"]
    lines: list[str] = []
    width = 0
    for number, term in enumerate(_terms(expression, room)):
        lines_of = lines_as_they_are if _is_collected(term, room) else _factors_by_line
        first, *more = lines_of(term, room)
        signed = first if number == 0 or first.startswith("-") else f"+ {first}"
        size = _width(term)
        if lines and width + size <= room and not more:
            lines[-1] += f" {signed}"
            width += size
        else:
            lines += [signed, *(rf"\quad\times {factors}" for factors in more)]
            width = room if more else size
    return lines


def _long_product(
    expression: sp.Expr, room: int, most: float = 0.5
) -> tuple[sp.Expr, sp.Expr] | None:
    """Factors of a product wider than `room`: all but a sum, and the sum; None of anything else,
    and where the first would take more than the share `most` of the room.
    """
    if not isinstance(expression, sp.Mul) or _width(expression) <= room:
        return None
    sums = [factor for factor in expression.args if isinstance(factor, sp.Add)]
    if len(sums) != 1:
        return None
    before = expression / sums[0]
    return (before, sums[0]) if _width(before) < most * room else None


def _is_collected(term: sp.Expr, room: int) -> bool:
    """Whether a long term is a sum of plain products times something, as inertias are."""
    product = _long_product(term, room, COLLECTED_BEFORE)
    return product is not None and not any(part.has(sp.Add) for part in product[1].args)


def _terms(expression: sp.Expr, room: int) -> list[sp.Expr]:
    """The terms of a sum in a fixed order; one wider than `room`, in which no sum can be broken, is
    multiplied out if that fits.
    """
    terms = []
    for term in expression.as_ordered_terms(order="lex"):
        parts = [term]
        if _is_collected(term, room):
            terms.append(term)
            continue
        for multiplied_out in (sp.expand_mul(term, deep=False), sp.expand(term)):
            if max(map(_width, parts)) > room:
                parts = multiplied_out.as_ordered_terms(order="lex")
        terms += parts if max(map(_width, parts)) <= room else [term]
    return terms


def _factors_by_line(term: sp.Expr, room: int) -> list[str]:
    """LaTeX of the factors of a product, on as many lines as they need."""
    if not isinstance(term, sp.Mul) or _width(term) <= max(room, 2 * ARGUMENT_WIDTH):
        return [latex_of(term)]
    groups: list[sp.Expr] = []
    for factor in sorted(term.args, key=_width):
        if groups and _width(groups[-1] * factor) <= room:
            groups[-1] *= factor
        else:
            groups.append(factor)
    inside = room - 2 * BRACKETS  # behind a cross, indented
    return [_in_brackets(g, inside) if isinstance(g, sp.Add) else latex_of(g) for g in groups]


def _in_brackets(total: sp.Expr, room: int) -> str:
    first, *more = lines_as_they_are(total, room)
    if not more:
        return rf"\left({first}\right)"
    lines = " \\\\\n& ".join([first, *more])
    return f"\\left(\\begin{{aligned}}& {lines}\\end{{aligned}}\\right)"


def _width(term: sp.Expr) -> int:
    """Printed width of a term, roughly, in characters: names count without their underscores, and
    an argument that is set on several lines counts as wide as one of them.
    """

    def is_extreme(part: sp.Expr) -> bool:
        return isinstance(part, sp.Max | sp.Min | sp.Abs)

    def stacked(extreme: sp.Expr) -> sp.Symbol:
        width = sum(min(_width(argument), ARGUMENT_WIDTH) + 2 for argument in extreme.args)
        return sp.Symbol("m" * (5 * width // 4))

    return _written_width(term.replace(is_extreme, stacked))


def _written_width(term: sp.Expr) -> int:
    return len(sp.sstr(term).replace("_", "").replace("*", " ")) * 4 // 5 + 3


def _with_decimals(expression: sp.Expr) -> sp.Expr:
    """`expression` with measured numbers such as 981/100 and 49/5 as decimals, and rounding as a
    floor. Simple fractions stay.
    """

    def is_measured(number: sp.Rational) -> bool:
        ends = number.q != 1 and 10**6 % number.q == 0
        return bool(ends and (number.q % 10 == 0 or abs(number) > LARGEST_FRACTION))

    expression = expression.rewrite(sp.floor)
    return expression.xreplace(
        {
            number: sp.sign(number) * sp.Symbol(repr(float(abs(number))))
            for number in expression.atoms(sp.Rational)
            if is_measured(number)
        }
    )


def plain_text_of(expression: sp.Expr) -> str:
    """One line of text, names as in the emitted module."""
    return str(sp.sstr(_with_decimals(expression), order="lex"))


def mathml_of(expression: sp.Expr) -> str:
    """Presentation MathML of an expression; exponentials as a function, not as small type."""
    written = _with_decimals(expression).replace(sp.exp, sp.Function("exp"))
    written = written.xreplace({real(name): sp.Symbol(letter) for name, letter in LETTERS.items()})
    text = str(mathml(written, printer="presentation", order="lex"))
    text = text.replace("<mi>dc</mi>", "<mi>Δc</mi>").replace("<mi>dF</mi>", "<mi>ΔF</mi>")
    for mark, entity in ((">", "&gt;"), ("<", "&lt;")):  # which SymPy's printer writes as they are
        text = text.replace(f"<mo>{mark}</mo>", f"<mo>{entity}</mo>")
    return text.replace("<mo>-</mo>", "<mo>−</mo>")


def mathml_lines(expression: sp.Expr, room: int = LINE_WIDTH) -> list[str]:
    """Presentation MathML of the terms of a sum, each with its sign, to be set one after another.

    A reader may break the line between any two of them, also of a long sum in a product.
    """
    return _pieces(readable(expression), room)


def _pieces(expression: sp.Expr, room: int) -> list[str]:
    product = _long_product(expression, room)
    if product is not None:
        before, inner = product
        pieces = _pieces(inner, room)
        opened, closed = (f'<mo stretchy="false">{mark}</mo>' for mark in "()")
        pieces[0] = f"<mrow>{mathml_of(before)}{opened}{pieces[0]}</mrow>"
        pieces[-1] = f"<mrow>{pieces[-1]}{closed}</mrow>"
        return pieces
    pieces = []
    for number, term in enumerate(_terms(expression, room)):
        negative = term.could_extract_minus_sign()
        sign = _SIGN.format("−" if negative else "+") if number or negative else ""
        pieces.append(f"<mrow>{sign}{mathml_of(-term if negative else term)}</mrow>")
    return pieces
