"""Shorten single entries of the equations; `simplify` on whole accelerations does not end."""

from collections import defaultdict

import sympy as sp

from ptp_symbolic.symbolic.derivation.trigonometry import Terms, TrigonometricRing, without_squares
from ptp_symbolic.symbolic.simplify.operations import written_operations


def reduce_trigonometry(expression: sp.Expr) -> sp.Expr:
    """Multiply out and apply sin^2 + cos^2 = 1 wherever that leaves fewer terms.

    The choice is made angle by angle and, for each, separately for every product of the other
    symbols. Raises ValueError when `expression` is no polynomial in symbols, sines and cosines.
    """
    ring = TrigonometricRing([expression])
    terms = ring.terms(expression)
    for pair in ring.pairs:
        groups: dict[tuple[int, ...], Terms] = defaultdict(dict)
        for monomial, value in terms.items():
            others = tuple(0 if i in pair else power for i, power in enumerate(monomial))
            groups[others][monomial] = value
        terms = {}
        for group in groups.values():
            forms: list[Terms] = [group]
            forms += [without_squares(group, *squares) for squares in (pair[::-1], pair)]
            shortest: Terms = min(forms, key=len)
            terms.update(shortest)
    return ring.expression(terms)


def factor_entry(expression: sp.Expr, state: set[sp.Symbol]) -> sp.Expr:
    """Collect what multiplies the same function of `state` and pull out common factors.

    Returns the shortest of a few ways to write `expression`, itself among them.
    """
    ring = TrigonometricRing([expression])
    moving = [bool(g.free_symbols & state) for g in ring.generators]
    groups: dict[tuple[int, ...], Terms] = defaultdict(dict)
    for monomial, value in ring.terms(expression).items():
        key = tuple(p if moves else 0 for p, moves in zip(monomial, moving, strict=True))
        rest = tuple(0 if moves else p for p, moves in zip(monomial, moving, strict=True))
        groups[key][rest] = value
    collected = sp.Add(
        *(ring.product(key) * sp.factor_terms(ring.expression(c)) for key, c in groups.items())
    )
    candidates = (expression, sp.factor_terms(expression), collected, sp.factor_terms(collected))
    return min(candidates, key=written_operations)
