"""Formulas as a person would write them: squares of sine and cosine folded, inertias collected.

In a sum of products of sines and cosines, sin^2 + cos^2 becomes 1 wherever that leaves fewer terms,
products of two angles become the function of their sum or difference, and what multiplies the same
function of the motion is collected. Everything else keeps its form but for common numbers.
"""

from collections import defaultdict
from collections.abc import Mapping
from functools import lru_cache
from itertools import combinations

import sympy as sp

from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.simplify.reduction import reduce_trigonometry
from ptp_symbolic.symbolic.symbols import ZERO, real

CIRCULAR = (sp.sin, sp.cos)
PLACES = tuple(prefix + axis for axis in kinematics.AXES for prefix in ("", "gear_"))
MOTION = frozenset(
    real(f"{letter}_{place}") for letter in ("omega", "alpha", "theta") for place in PLACES
)
# Coefficients of (sin a sin b, cos a cos b, sin a cos b, cos a sin b) of what they add up to.
SUMS = {
    (1, 1, 0, 0): lambda a, b: sp.cos(a - b),
    (-1, 1, 0, 0): lambda a, b: sp.cos(a + b),
    (0, 0, 1, -1): lambda a, b: sp.sin(a - b),
    (0, 0, 1, 1): lambda a, b: sp.sin(a + b),
}


@lru_cache(maxsize=4096)
def readable(expression: sp.Expr) -> sp.Expr:
    """An expression equal to `expression`, as a person would write it."""
    plain: list[sp.Expr] = []
    circular: list[sp.Expr] = []
    for term in sp.Add.make_args(expression):
        (circular if _is_circular_polynomial(term) else plain).append(term)
    written = [_with_numbers_inside(sp.factor_terms(term)) for term in plain]
    if circular:
        written.append(_collected(sp.Add(*circular)))
    return sp.Add(*written)


def _with_numbers_inside(expression: sp.Expr) -> sp.Expr:
    """`expression` with a fraction before a sum put into it where most of its terms get shorter."""

    def is_fraction_of_sum(part: sp.Expr) -> bool:
        if not isinstance(part, sp.Mul) or part.as_coeff_Mul()[0].q == 1:
            return False
        sums = [factor for factor in part.args if isinstance(factor, sp.Add)]
        below = part.as_coeff_Mul()[0].q
        return len(sums) == 1 and 2 * sum(
            term.as_coeff_Mul()[0] % below == 0 for term in sums[0].args
        ) > len(sums[0].args)

    def inside(part: sp.Expr) -> sp.Expr:
        number, product = part.as_coeff_Mul()
        (total,) = (factor for factor in product.args if isinstance(factor, sp.Add))
        shorter = sp.Add(*(term * sp.Rational(1, number.q) for term in total.args))
        return number.p * (product / total) * shorter

    return expression.replace(is_fraction_of_sum, inside)


def _is_circular_polynomial(term: sp.Expr) -> bool:
    """Whether `term` is a polynomial in symbols and at least one sine or cosine."""
    if not term.has(*CIRCULAR):
        return False
    opaque = term.xreplace({f: sp.Dummy() for f in term.atoms(*CIRCULAR)})
    whole = all(power.exp.is_Integer for power in opaque.atoms(sp.Pow))
    return bool(whole and opaque.is_polynomial(*opaque.free_symbols)) and not opaque.has(sp.Float)


def _collected(total: sp.Expr) -> sp.Expr:
    compound = {f for f in total.atoms(*CIRCULAR) if not f.args[0].is_Symbol}
    names = {function: sp.Dummy(f"f{k}", real=True) for k, function in enumerate(_sorted(compound))}
    numbers = {number: sp.Dummy(str(number)) for number in total.atoms(sp.NumberSymbol)}
    folded = reduce_trigonometry(total.xreplace(names | numbers))
    parts: dict[sp.Expr, list[sp.Expr]] = defaultdict(list)
    for term in sp.Add.make_args(_with_sums_of_angles(sp.expand(folded))):
        moving, fixed = _parts_of(term, set(names.values()))
        parts[moving].append(fixed)
    alone = parts.pop(sp.Integer(1), [])
    products = (moving * sp.factor_terms(sp.Add(*own)) for moving, own in parts.items())
    back = {name: given for given, name in (names | numbers).items()}
    return sp.Add(*alone, *products).xreplace(back)


def _sorted(functions: set[sp.Expr]) -> list[sp.Expr]:
    return sorted(functions, key=sp.default_sort_key)


def _parts_of(term: sp.Expr, opaque: set[sp.Dummy]) -> tuple[sp.Expr, sp.Expr]:
    """What moves in a product, and what does not."""
    moving: list[sp.Expr] = []
    fixed: list[sp.Expr] = []
    for factor in sp.Mul.make_args(term):
        moves = factor.has(*CIRCULAR) or factor.free_symbols & (MOTION | opaque)
        (moving if moves else fixed).append(factor)
    return sp.Mul(*moving), sp.Mul(*fixed)


def _with_sums_of_angles(total: sp.Expr) -> sp.Expr:
    """`total` with sin a sin b + cos a cos b and the like as functions of a - b and a + b."""
    angles = _sorted({f.args[0] for f in total.atoms(*CIRCULAR)})
    for a, b in combinations(angles, 2):
        groups: dict[sp.Expr, dict[int, sp.Expr]] = defaultdict(dict)
        rest = []
        for term in sp.Add.make_args(total):
            found = _pair_in(term, a, b)
            if found is None:
                rest.append(term)
            else:
                kind, others, value = found
                groups[others][kind] = value
        total = sp.Add(*rest, *(_summed(o, own, a, b) for o, own in groups.items()))
    return total


def _pairs(a: sp.Expr, b: sp.Expr) -> tuple[sp.Expr, ...]:
    return (
        sp.sin(a) * sp.sin(b),
        sp.cos(a) * sp.cos(b),
        sp.sin(a) * sp.cos(b),
        sp.cos(a) * sp.sin(b),
    )


def _pair_in(term: sp.Expr, a: sp.Expr, b: sp.Expr) -> tuple[int, sp.Expr, sp.Expr] | None:
    """Which of the `_pairs` is in `term`, what multiplies it, and the number in front."""
    number, product = term.as_coeff_Mul()
    for kind, pair in enumerate(_pairs(a, b)):
        others = product / pair
        if not any(f.args[0] in (a, b) for f in others.atoms(*CIRCULAR)):
            return kind, others, number
    return None


def _summed(others: sp.Expr, own: Mapping[int, sp.Expr], a: sp.Expr, b: sp.Expr) -> sp.Expr:
    values = tuple(own.get(kind, ZERO) for kind in range(4))
    size = next(value for value in reversed(values) if value != 0)
    for sign in (1, -1):
        found = SUMS.get(tuple(sign * value / size for value in values))
        if found is not None:
            return sign * size * others * found(a, b)
    return sp.Add(
        *(value * others * pair for value, pair in zip(values, _pairs(a, b), strict=True))
    )
