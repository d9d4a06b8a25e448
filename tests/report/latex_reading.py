"""Reads the printed equations of a report back: LaTeX to numbers, for exactly what is printed.

Nothing of the program is used: a wrong printer is not to be read by its own code.
"""

import math
import operator
import re
from collections.abc import Iterator, Mapping

TOKEN = re.compile(
    r"\\(?:left|right)\s*\\?[()\[\]|{}.]|\\(?:left|right)\\[lr]floor|\\begin\{\w+\*?\}|\\end\{\w+\*?\}"
    r"|\\operatorname\{\w+\}|\\text\{[^{}]*\}|\\mathrm\{[^{}]*\}|\\[A-Za-z]+|\\\\|\\.|[A-Za-z]|\d+(?:\.\d+)?(?:e-?\d+)?"
    r"|[-+^_{}&=(),|<>/*']"
)
RELATIONS = {">": operator.gt, "<": operator.lt, r"\geq": operator.ge, r"\leq": operator.le}
FUNCTIONS = {
    r"\sin": math.sin,
    r"\cos": math.cos,
    r"\exp": math.exp,
    r"\log": math.log,
    r"\operatorname{acos}": math.acos,
    r"\operatorname{sign}": lambda x: math.copysign(1.0, x) if x else 0.0,
}
SPACES = {r"\,", r"\quad", r"\;", r"\ ", r"\:", r"\!"}
SKIPPED = {*SPACES, "&", r"\\", r"\begin{aligned}", r"\end{aligned}"}
OF_CASES = (r"\\", r"\text{for}", r"\text{otherwise}", r"\end{cases}", *RELATIONS)


def equations_in(text: str) -> dict[str, str]:
    """Left and right sides of the displayed equations of a section, a later one over an earlier."""
    found = {}
    for body in re.findall(r"\\begin\{align\*?\}(.*?)\\end\{align\*?\}", text, re.DOTALL):
        for row in re.split(r"(?<!\\notag) \\\\\*?\n(?!\s*& )", _one_line_sums(body).strip()):
            left, relation, right = row.partition("={}&")
            if relation:
                found[symbol(left)] = right.replace(r"\notag", "")
    return found


def _one_line_sums(body: str) -> str:
    """Rows of one equation joined: all but its last carry no number."""
    return re.sub(r"\\notag\s*\\\\\*?\n\s*&", " ", body)


def symbol(text: str) -> str:
    """A symbol without the spaces in it."""
    return re.sub(r"\s+", "", text)


class Reader:
    """Evaluates printed expressions; `values` of symbols, and `definitions` printed for others."""

    def __init__(self, values: Mapping[str, float], definitions: Mapping[str, str]) -> None:
        self.values, self.definitions = dict(values), definitions

    def value(self, left: str) -> float:
        """The value of a symbol, known or by its printed definition."""
        if left not in self.values:
            if left not in self.definitions:
                raise KeyError(f"{left} is neither in the table of symbols nor defined")
            self.values[left] = self.evaluate(self.definitions[left])
        return self.values[left]

    def evaluate(self, text: str) -> float:
        """The value of an expression; raises ValueError for what it cannot read."""
        tokens = [re.sub(r"\s+", "", t) for t in TOKEN.findall(text)]
        left = TOKEN.sub("", text).strip()
        if left:
            raise ValueError(f"not read: {left[:40]!r}")
        inner = _Expression(self, list(_told(tokens)))
        result = inner.sum()
        if inner.at != len(inner.tokens):
            raise ValueError(f"left over: {inner.tokens[inner.at :][:8]}")
        return result


def _told(tokens: list[str]) -> Iterator[str]:
    """The tokens that say something: within cases a new line does."""
    cases = 0
    for token in tokens:
        cases += (token == r"\begin{cases}") - (token == r"\end{cases}")
        if token not in SKIPPED or (cases and token == r"\\"):
            yield token


class _Expression:
    """A recursive descent through the tokens of one expression."""

    def __init__(self, reader: Reader, tokens: list[str]) -> None:
        self.reader, self.tokens, self.at = reader, tokens, 0

    @property
    def next(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self, *wanted: str) -> str:
        token = self.next
        if wanted and token not in wanted:
            raise ValueError(f"{token!r} where one of {wanted} should be")
        self.at += 1
        return token

    def sum(self) -> float:
        total = 0.0
        sign = -1.0 if self.next == "-" else 1.0
        if self.next in "+-" and self.next:
            self.take()
        total += sign * self.product()
        while self.next in ("+", "-"):
            sign = -1.0 if self.take() == "-" else 1.0
            total += sign * self.product()
        return total

    def product(self) -> float:
        result = self.power()
        while (
            self.next
            and self.next not in ("+", "-", "}", ")", ",", "|", *OF_CASES)
            and not re.match(r"\\right", self.next)
        ):
            if self.next in (r"\cdot", r"\times"):
                self.take()
            result *= self.power()
        return result

    def power(self) -> float:
        base = self.atom()
        if self.next == "^":
            self.take()
            return float(base ** self.group())
        return base

    def group(self) -> float:
        self.take("{")
        value = self.sum()
        self.take("}")
        return value

    def bracketed(self) -> list[float]:
        """The arguments in a pair of growing parentheses, inside of braces or not."""
        braces = self.next == "{"
        if braces:
            self.take()
        self.take(r"\left(")
        values = [self.sum()]
        while self.next == ",":
            self.take()
            values.append(self.sum())
        self.take(r"\right)")
        if braces:
            self.take("}")
        return values

    def atom(self) -> float:
        token = self.next
        if re.fullmatch(r"\d.*", token):
            return float(self.take())
        if token == r"\pi":
            self.take()
            return math.pi
        if token == "{":
            return self.group()
        if token == r"\left(":
            return self.bracketed()[0]
        if token in (r"\left|", r"\left\lfloor"):
            self.take()
            value = self.sum()
            self.take(r"\right|", r"\right\rfloor")
            return abs(value) if token == r"\left|" else math.floor(value)
        if token == r"\frac":
            self.take()
            above = self.group()
            return above / self.group()
        if token == r"\sqrt":
            self.take()
            return math.sqrt(self.group())
        if token == r"\begin{cases}":
            return self.case()
        if token in (r"\max", r"\min"):
            self.take()
            return (max if token == r"\max" else min)(self.bracketed())
        if token in FUNCTIONS:
            self.take()
            power = 1.0
            if self.next == "^":
                self.take()
                power = self.group()
            return float(FUNCTIONS[token](self.bracketed()[0]) ** power)
        if token == "e" and self.tokens[self.at + 1 : self.at + 2] == ["^"]:
            self.take()
            self.take()
            return math.exp(self.group())
        return self.reader.value(self.symbol())

    def case(self) -> float:
        """One value where a relation holds, and another one otherwise."""
        self.take(r"\begin{cases}")
        value = self.sum()
        self.take(r"\text{for}")
        left, relation, right = self.sum(), self.take(), self.sum()
        self.take(r"\\")
        other = self.sum()
        self.take(r"\text{otherwise}")
        self.take(r"\end{cases}")
        return value if RELATIONS[relation](left, right) else other

    def symbol(self) -> str:
        """A letter with its index, or with a Delta in front."""
        name = self.take()
        if not re.fullmatch(r"\\?[A-Za-z]+|\\mathrm\{.*\}", name):
            raise ValueError(f"{name!r} is no symbol")
        if name == r"\Delta":
            name += self.take()
        if self.next == "_":
            name += self.take()
            depth = 0
            while True:
                token = self.take()
                depth += {"{": 1, "}": -1}.get(token, 0)
                name += token
                if depth == 0:
                    break
        return name


def has_warning(log: str) -> bool:
    """True when a LaTeX log reports a warning or a box that does not fit."""
    return re.search(r"Warning|Overfull|Underfull", log) is not None
