"""Where an effect holds: bounds of states, and relations between its parameters."""

from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Limit:
    """Bounds of a state, functions of parameters, outside of which the equations do not hold."""

    state: sp.Symbol
    lower: sp.Expr
    upper: sp.Expr
    meaning: str


@dataclass(frozen=True)
class Requirement:
    """A relation between parameters without which the effect cannot exist.

    `rule` says what is allowed and what to do, as the end of a message that starts with the values.
    """

    holds: sp.Rel
    rule: str
