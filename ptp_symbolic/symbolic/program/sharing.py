"""Share common subexpressions among definitions and outputs, and name them readably."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from ptp_symbolic.symbolic.simplify.operations import common_subexpressions
from ptp_symbolic.symbolic.symbols import ZERO, real

Line = tuple[str, sp.Expr]
MAX_NAME = 45  # letters: longer names are formulas
PREFIX = "shared:"  # of names yet to be found, which no machine uses
LONGEST_SUM = 3  # parts of a sum that its name says
POWERS = {
    2: "sq",
    3: "cubed",
    -1: "inverse",
    -2: "inverse_sq",
    -3: "inverse_cubed",
    sp.Rational(1, 2): "root",
}
TOLD = "="  # before the name of a term that is inlined where it is used once
MULTIPLES = {
    2: "twice",
    3: "thrice",
    4: "four_times",
    sp.Rational(1, 2): "half",
    sp.Rational(1, 4): "quarter",
}


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


def if_shared(name: str) -> sp.Symbol:
    """The symbol of a definition that is called `name` where more than one line uses it."""
    return real(f"{PREFIX}{TOLD}{name}")


def share(definitions: Sequence[Line], outputs: Sequence[Line], words: Vocabulary) -> list[Line]:
    """Return the assignments that compute `outputs`, each name assigned before it is used.

    `definitions` name intermediate results (a determinant, an acceleration) that outputs may use,
    each those before it; those that nothing uses are dropped, and those that only rename are put
    in. Targets of outputs keep their text, e.g. ``dx[0]``. No two names stand for one value, nor
    for a value and its negative.
    """
    functions = _functions_of(e for _, e in (*definitions, *outputs))
    given = [*functions, *definitions, *words.meanings]
    written = _in_single_angles([words.without_powers(e) for _, e in (*given, *outputs)])
    names = [name for name, _ in given]
    named, ends = _distinct(list(zip(names, written, strict=False)), written[len(given) :])
    named, ends = _one_form(named, ends)
    found, terms, ends = common_subexpressions([e for _, e in named], ends, PREFIX)
    shared = [(str(symbol), expression) for symbol, expression in found]
    lines = [(name, e) for (name, _), e in zip(named, terms, strict=True)]
    meanings = {name for name, _ in words.meanings}
    defined = [line for line in lines if line[0] not in meanings]
    meant = [line for line in lines if line[0] in meanings]
    final = [(name, e) for (name, _), e in zip(outputs, ends, strict=True)]
    available, final = _without_aliases(shared, defined, meant, final)
    targets = {target for target, _ in outputs}
    ordered = _inlined(_once(_ordered(available, final), targets), targets)
    entries = {e: words.targets.get(t) for t, e in reversed(ordered) if t in targets}
    return _renamed(ordered, {name for name, _ in available}, words, entries)


def _functions_of(expressions: Iterable[sp.Expr]) -> list[Line]:
    """Names of the sines and cosines of states and parameters."""
    found = {f for e in expressions for f in e.atoms(sp.sin, sp.cos) if f.args[0].is_Symbol}
    return sorted((str(_describe(f)), f) for f in found)


def _distinct(
    named: Sequence[Line], outputs: Sequence[sp.Expr]
) -> tuple[list[Line], list[sp.Expr]]:
    """Lines without those that name what another names already, or its negative, and `outputs` in
    terms of these. The shortest name stays.
    """
    first: dict[sp.Symbol, sp.Expr] = {}
    values: dict[sp.Expr, sp.Symbol] = {}
    names: dict[sp.Symbol, str] = {}
    for name, expression in _ordered(named, [("", sp.Tuple(*(real(n) for n, _ in named)))])[:-1]:
        value, symbol = expression.xreplace(first), real(name)
        known = _known(value, values)
        if known is None:
            values[value], names[symbol] = symbol, name
            continue
        first[symbol] = known
        if value in values:
            names[known] = min(names[known], name, key=lambda n: (n.startswith(PREFIX), len(n)))
    last = {symbol: real(name) for symbol, name in names.items()}
    lines = [(names[symbol], value.xreplace(last)) for value, symbol in values.items()]
    return lines, [e.xreplace(first).xreplace(last) for e in outputs]


def _one_form(
    named: Sequence[Line], outputs: Sequence[sp.Expr]
) -> tuple[list[Line], list[sp.Expr]]:
    """Lines and `outputs` in which sums that are multiples of one another, such as a - b and b - a,
    are one term, and half powers those of one root. A form that has a name is known by it.
    """
    parts: dict[sp.Expr, None] = {}
    for expression in (*(e for _, e in named), *outputs):
        _collect(expression, parts)
    names = {e: real(name) for name, e in named}
    forms: dict[sp.Expr, sp.Symbol] = {}
    replaced: dict[sp.Expr, sp.Expr] = {}

    def form(expression: sp.Expr) -> sp.Symbol:
        if expression not in forms:
            own = names.get(expression, real(f"{PREFIX}form{len(forms)}"))
            forms[expression] = replaced[expression] = own
        return forms[expression]

    for multiples in _multiples(parts):
        chosen = min(multiples, key=lambda e: (abs(multiples[e]) != 1, e not in names))
        for part, factor in multiples.items():
            if part is not chosen:
                replaced[part] = factor / multiples[chosen] * form(chosen)
    for part in parts:
        if part.is_Pow and part.exp.is_Rational and part.exp.q == 2 and abs(part.exp.p) > 1:
            replaced[part] = form(sp.sqrt(part.base)) ** part.exp.p
    replaced |= {1 / e: 1 / term for e, term in forms.items() if e.is_Pow}

    def inside(expression: sp.Expr) -> sp.Expr:
        return expression.func(*(part.xreplace(replaced) for part in expression.args))

    own = [(str(term), inside(e)) for e, term in forms.items() if e not in names]
    lines = [(name, inside(e) if e in forms else e.xreplace(replaced)) for name, e in named]
    return [*own, *lines], [e.xreplace(replaced) for e in outputs]


def _multiples(parts: Iterable[sp.Expr]) -> list[dict[sp.Expr, sp.Expr]]:
    """The sums among `parts` that are multiples of one another, with their factors."""
    groups: dict[sp.Expr, dict[sp.Expr, sp.Expr]] = {}
    for part in parts:
        if part.is_Add:
            factor, rest = part.primitive()
            if rest.could_extract_minus_sign():
                factor, rest = -factor, -rest
            groups.setdefault(rest, {})[part] = factor
    return [group for group in groups.values() if len(group) > 1]


def _collect(expression: sp.Expr, parts: dict[sp.Expr, None]) -> None:
    """Add an expression and all that it is made of to `parts`, in order."""
    if expression not in parts and expression.args:
        parts[expression] = None
        for part in expression.args:
            _collect(part, parts)


def _once(lines: Sequence[Line], targets: set[str]) -> list[Line]:
    """Lines whose value, or its negative, no earlier one has; all `targets` stay."""
    replaced: dict[sp.Symbol, sp.Expr] = {}
    values: dict[sp.Expr, sp.Symbol] = {}
    kept: list[Line] = []
    for target, expression in lines:
        value, symbol = expression.xreplace(replaced), real(target)
        known = None if target in targets else _known(value, values)
        if known is not None:
            replaced[symbol] = known
            continue
        kept.append((target, value))
        if target not in targets:
            values[value] = symbol
    return kept


def _known(value: sp.Expr, values: Mapping[sp.Expr, sp.Symbol]) -> sp.Expr | None:
    """What stands for `value` where it is a number, a symbol, or among `values`, or its negative
    is; None elsewhere.
    """
    if value in values or not isinstance(value, sp.Expr):
        return values.get(value)
    if value.is_number or value.is_Symbol or (-value).is_Symbol:
        return value
    return -values[-value] if -value in values else None


def _inlined(lines: Sequence[Line], targets: set[str]) -> list[Line]:
    """Lines without terms that one other line uses once and that have no name of their own, and
    without those that only give one of the `targets` its value.
    """
    uses: dict[sp.Symbol, int] = {}
    for _, expression in lines:
        for symbol in (each for each in sp.preorder_traversal(expression) if each.is_Symbol):
            uses[symbol] = uses.get(symbol, 0) + 1
    given = {e for target, e in lines if target in targets and e.is_Symbol}
    put_in: dict[sp.Symbol, sp.Expr] = {}
    kept: list[Line] = []
    for target, expression in lines:
        value, symbol = expression.xreplace(put_in), real(target)
        alone = target.startswith(PREFIX) or symbol in given
        if target not in targets and alone and uses[symbol] == 1:
            put_in[symbol] = value
        else:
            kept.append((target, value))
    return kept


def _without_aliases(
    shared: Sequence[Line], defined: Sequence[Line], meant: Sequence[Line], final: Sequence[Line]
) -> tuple[list[Line], list[Line]]:
    """Available lines and `final` ones, without lines that give another name alone: a shared term
    takes the name that it is defined under, and what else it is called is replaced by that.
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


def _renamed(
    lines: Sequence[Line],
    kept: set[str],
    words: Vocabulary,
    entries: Mapping[sp.Expr, str | None],
) -> list[Line]:
    """Lines with readable names for the terms that have none; `entries` are names of values."""
    uses, values = _first_uses(lines, words.targets), dict(lines)
    names: dict[sp.Symbol, sp.Symbol] = {}
    taken = {str(s) for _, e in lines for s in e.free_symbols} | kept
    result: list[Line] = []
    for name, expression in lines:
        expression = expression.xreplace(names)
        if not name.startswith(PREFIX):
            result.append((name, expression))
            continue
        told = name.removeprefix(PREFIX + TOLD) if name.startswith(PREFIX + TOLD) else None
        symbol, negative = real(name), entries.get(-real(name))
        own = told or entries.get(symbol) or _describe(expression)
        own = own or (f"minus_{negative}" if negative else _part_of(name, values, uses, words))
        readable = _unused(own, taken)
        taken.add(readable)
        names[real(name)] = real(readable)
        result.append((readable, expression))
    return result


def _first_uses(
    lines: Sequence[Line], targets: Mapping[str, str]
) -> dict[str, tuple[str, sp.Expr]]:
    """For every shared term what it is first used in: a word for it, and the expression."""
    first: dict[str, tuple[str, sp.Expr]] = {}
    for name, expression in reversed(lines):
        shared = name.startswith(PREFIX) and name in first
        word = first[name][0] if shared else targets.get(name, name)
        for symbol in expression.free_symbols:
            first[str(symbol)] = (word, expression)
    return first


def _part_of(
    name: str,
    values: Mapping[str, sp.Expr],
    uses: Mapping[str, tuple[str, sp.Expr]],
    words: Vocabulary,
) -> str:
    """A name for a term by its part in what it is first used in: in a force the torque of a
    friction, which its direction multiplies, and all else; elsewhere a denominator, factor or term.
    """
    word, user = uses[name]
    symbol, (force, _, place) = real(name), word.partition("_")

    def is_friction(part: sp.Expr) -> bool:
        own = values.get(str(-part), ZERO)
        return (-part).is_Symbol and own.is_Mul and not words.signs.isdisjoint(own.args)

    if force == "force" and user.is_Add and any(map(is_friction, user.args)):
        if is_friction(-symbol):
            return f"friction_torque_{place}"
        if len(user.args) == 2:
            return f"forcing_{place}"
    parts = list(sp.preorder_traversal(user))
    if any(e.is_Pow and e.exp.is_negative and e.base in (symbol, sp.Abs(symbol)) for e in parts):
        return f"{word}_denominator"
    inside = [e for e in parts if symbol in e.args and e != -symbol]
    return f"{word}_factor" if inside and all(e.is_Mul for e in inside) else f"{word}_term"


def _unused(name: str, taken: set[str]) -> str:
    if name not in taken:
        return name
    number = 2
    while f"{name}_{number}" in taken:
        number += 1
    return f"{name}_{number}"


def _describe(expression: sp.Expr) -> str | None:
    """A name such as ``cos_tilt`` or ``omega_pan_sq``, or None where none would be readable."""
    name = _words(expression)
    return name if name is not None and len(name) <= MAX_NAME else None


def _words(expression: sp.Expr) -> str | None:
    """An expression of named things in words; None where there are no words for a part of it."""
    if expression.is_Symbol or expression == sp.pi:
        return str(expression)
    if isinstance(expression, sp.sin | sp.cos | sp.exp | sp.Abs | sp.sign):
        argument, prefix = expression.args[0], type(expression).__name__.lower()
        word = _words(argument)
        return None if word is None else f"{prefix}_{word.removeprefix('theta_')}"
    if expression.is_Pow:
        base, suffix = _words(expression.base), POWERS.get(expression.exp)
        return f"{base}_{suffix}" if base and suffix else None
    if expression.is_Mul:
        return _product_in_words(expression)
    return _sum_in_words(expression) if expression.is_Add else None


def _product_in_words(product: sp.Expr) -> str | None:
    """``twice_b_pan_omega_pan``; what is divided by comes last, after a `per`."""
    coefficient, rest = product.as_coeff_Mul()
    size, factors = abs(coefficient), sp.Mul.make_args(rest)
    if size != 1 and size not in MULTIPLES:
        return None
    below = [1 / f for f in factors if f.is_Pow and f.exp.is_negative and len(factors) > 1]
    above = [f for f in factors if 1 / f not in below]
    words = [[_words(f) for f in each] for each in (above, below)]
    if None in words[0] + words[1]:
        return None
    prefix = ["minus"] if coefficient.is_negative else []
    prefix += [MULTIPLES[size]] if size != 1 else []
    parts = ["_".join([*prefix, *sorted(map(str, words[0]))]), *sorted(map(str, words[1]))]
    return "_per_".join(part for part in parts if part)


def _sum_in_words(total: sp.Expr) -> str | None:
    """``one_plus_a_minus_b``, of at most LONGEST_SUM parts."""
    constant, rest = total.as_coeff_Add()
    terms = sp.Add.make_args(rest)
    if constant not in (0, 1, -1) or len(terms) + abs(constant) > LONGEST_SUM:
        return None
    signed = [(bool(t.as_coeff_Mul()[0].is_negative), t) for t in terms]
    words = sorted((minus, str(_words(-t if minus else t))) for minus, t in signed)
    if any(_words(-t if minus else t) is None for minus, t in signed):
        return None
    if constant != 0:
        words = sorted([(bool(constant < 0), "one"), *words], key=lambda word: word[0])
    text = "".join(f"_{'minus' if minus else 'plus'}_{word}" for minus, word in words)
    return text.removeprefix("_plus_").removeprefix("_")
