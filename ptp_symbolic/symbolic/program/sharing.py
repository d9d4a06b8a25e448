"""Share common subexpressions among definitions and outputs, and name them readably."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from ptp_symbolic.symbolic.simplify.operations import common_subexpressions
from ptp_symbolic.symbolic.symbols import real

Line = tuple[str, sp.Expr]
MAX_NAME = 40
PREFIX = "shared:"  # of names yet to be found, which no machine uses
MULTIPLES = {2: "twice", 3: "thrice", sp.Rational(1, 2): "half"}


@dataclass(frozen=True)
class Vocabulary:
    """Names for shared terms, and what is known of some symbols.

    `targets` say what entries of arrays are, ``accel_pan`` for ``dx[2]``; `meanings` are
    expressions that have a name of their own, such as the torque of a shaft; `signs` are symbols
    that are -1, 0 or 1, `switches` those that are 0 or 1.
    """

    targets: Mapping[str, str] = field(default_factory=dict)
    meanings: Sequence[Line] = ()
    signs: frozenset[sp.Symbol] = frozenset()
    switches: frozenset[sp.Symbol] = frozenset()

    def without_powers(self, expression: sp.Expr) -> sp.Expr:
        """`expression` with powers of signs and switches reduced: the cube of a sign is it."""

        def is_power(e: sp.Expr) -> bool:
            known = e.is_Pow and e.base in self.signs | self.switches
            return bool(known and e.exp.is_Integer and e.exp > 1)

        def reduced(power: sp.Expr) -> sp.Expr:
            even = power.base in self.signs and power.exp % 2 == 0
            return power.base**2 if even else power.base

        return expression.replace(is_power, reduced)


def share(definitions: Sequence[Line], outputs: Sequence[Line], words: Vocabulary) -> list[Line]:
    """Return the assignments that compute `outputs`, each name assigned before it is used.

    `definitions` name intermediate results (a determinant, an acceleration) that outputs may use;
    those that nothing uses are dropped, and those that only rename are put in. Targets of outputs
    keep their text, e.g. ``dx[0]``.
    """
    named = [*definitions, *words.meanings]
    written = _in_single_angles([words.without_powers(e) for _, e in (*named, *outputs)])
    count = len(named)
    found, terms, ends = common_subexpressions(written[:count], written[count:], PREFIX)
    shared = [(str(symbol), expression) for symbol, expression in found]
    lines = [(name, e) for (name, _), e in zip(named, terms, strict=True)]
    defined, meant = lines[: len(definitions)], lines[len(definitions) :]
    final = [(name, e) for (name, _), e in zip(outputs, ends, strict=True)]
    available, final = _without_aliases(shared, defined, meant, final)
    ordered = _ordered(available, final)
    return _renamed(ordered, {name for name, _ in available}, words.targets)


def _without_aliases(
    shared: Sequence[Line], defined: Sequence[Line], meant: Sequence[Line], final: Sequence[Line]
) -> tuple[list[Line], list[Line]]:
    """Available lines and `final` ones, without lines that give another name alone: a shared term
    takes the last name that it is defined under, and what else it is called is replaced by that.
    """
    terms = {real(name) for name, _ in shared}
    names: dict[sp.Symbol, sp.Expr] = {}
    kept: list[Line] = []
    for name, expression in (*reversed(defined), *meant):
        if expression in terms and expression not in names:
            names[expression] = real(name)
        elif expression.is_Symbol or expression.is_number:
            names[real(name)] = expression
        else:
            kept.append((name, expression))
    names = {symbol: _last(symbol, names) for symbol in names}
    lines = [(str(names.get(real(name), name)), e.xreplace(names)) for name, e in (*shared, *kept)]
    return lines, [(target, e.xreplace(names)) for target, e in final]


def _last(symbol: sp.Expr, names: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    while symbol in names:
        symbol = names[symbol]
    return symbol


def _in_single_angles(expressions: Sequence[sp.Expr]) -> list[sp.Expr]:
    """Sines and cosines of twice and three times an angle by those of the angle itself, where those
    are computed too: products take a tenth of the time of a function.
    """
    found = {f for e in expressions for f in e.atoms(sp.sin, sp.cos)}
    angles = {f.args[0] for f in found}
    single: dict[sp.Basic, sp.Expr] = {}
    for function in found:
        multiple, angle = function.args[0].as_coeff_Mul()
        if multiple in (2, 3) and angle in angles:
            sine, cosine = sp.sin(angle), sp.cos(angle)
            single[function] = {
                (sp.sin, 2): 2 * sine * cosine,
                (sp.cos, 2): 2 * cosine**2 - 1,
                (sp.sin, 3): sine * (4 * cosine**2 - 1),
                (sp.cos, 3): cosine * (4 * cosine**2 - 3),
            }[function.func, int(multiple)]
    if not single:
        return list(expressions)
    # SymPy compares the arguments of these when it makes them: once each, not once per expression.
    compared = {c for e in expressions for c in e.atoms(sp.Max, sp.Min, sp.Piecewise)}
    single |= {c: c.xreplace(single) for c in compared}
    return [e.xreplace(single) for e in expressions]


def _ordered(available: Sequence[Line], final: Sequence[Line]) -> list[Line]:
    """Depth-first from the outputs: only what is needed, each before its use."""
    by_name = dict(available)
    done: dict[str, sp.Expr] = {}

    def visit(expression: sp.Expr) -> None:
        for symbol in sorted(expression.free_symbols, key=_natural):
            name = str(symbol)
            if name in by_name and name not in done:
                visit(by_name[name])
                done[name] = by_name[name]

    lines: list[Line] = []
    for target, expression in final:
        before = len(done)
        visit(expression)
        lines.extend(list(done.items())[before:])
        lines.append((target, expression))
    return lines


def _natural(symbol: sp.Symbol) -> list[object]:
    parts = re.split(r"(\d+)", str(symbol))
    return [(0, int(part), "") if part.isdigit() else (1, 0, part) for part in parts]


def _renamed(lines: Iterable[Line], kept: set[str], words: Mapping[str, str]) -> list[Line]:
    lines = list(lines)
    final_use = _first_target(lines, words)
    names: dict[sp.Symbol, sp.Symbol] = {}
    taken = {str(s) for _, e in lines for s in e.free_symbols} | kept
    result: list[Line] = []
    for name, expression in lines:
        expression = expression.xreplace(names)
        if not name.startswith(PREFIX):
            result.append((name, expression))
            continue
        readable = _unused(_describe(expression) or f"{final_use[name]}_term", taken)
        taken.add(readable)
        names[real(name)] = real(readable)
        result.append((readable, expression))
    return result


def _first_target(lines: Sequence[Line], words: Mapping[str, str]) -> dict[str, str]:
    """For every shared term, a word for what it is first used in."""
    first: dict[str, str] = {}
    for name, expression in reversed(lines):
        word = first.get(name, name) if name.startswith(PREFIX) else words.get(name, name)
        for symbol in expression.free_symbols:
            first[str(symbol)] = word
    return first


def _unused(name: str, taken: set[str]) -> str:
    if name not in taken:
        return name
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"


def _describe(expression: sp.Expr) -> str | None:
    """A name such as ``cos_tilt`` or ``omega_pan_sq``, or None where none would be readable."""
    if isinstance(expression, sp.sin | sp.cos | sp.exp) and expression.args[0].is_Symbol:
        word = type(expression).__name__
        return f"{word}_{str(expression.args[0]).removeprefix('theta_')}"
    if expression.is_Pow and expression.base.is_Symbol:
        suffix = {2: "sq", 3: "cubed", -1: "inverse"}.get(expression.exp)
        return None if suffix is None else f"{expression.base}_{suffix}"
    if expression.is_Mul:
        coefficient, product = expression.as_coeff_Mul()
        factors = sp.Mul.make_args(product)
        if abs(coefficient) == 1 or abs(coefficient) in MULTIPLES:
            prefix = ["minus"] if coefficient.is_negative else []
            prefix += [MULTIPLES[abs(coefficient)]] if abs(coefficient) != 1 else []
            return _joined(prefix, "", factors)
    if (
        expression.is_Add
        and len(expression.args) == 2
        and all(a.is_Symbol for a in expression.args)
    ):
        return _joined([], "plus", expression.args)
    return None


def _joined(prefix: list[str], between: str, symbols: Sequence[sp.Basic]) -> str | None:
    """The names of `symbols` as one name; None where it gets long or something is no symbol."""
    if not all(symbol.is_Symbol for symbol in symbols):
        return None
    parts = sorted(map(str, symbols))
    name = "_".join([*prefix, f"_{between}_".join(parts) if between else "_".join(parts)])
    return name if len(name) <= MAX_NAME else None
