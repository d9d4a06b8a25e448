"""Derivatives of expressions that hold named functions, by the chain rule.

Without the names a derivative by each of forty parameters would write every function out again.
"""

from dataclasses import dataclass

import sympy as sp

from ptp_symbolic.symbolic.derivation.contributions import slope_symbol
from ptp_symbolic.symbolic.derivation.differentiation import derivative, symbols_of
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program.sharing import Line


@dataclass(frozen=True)
class ChainRule:
    """Derivatives of the named functions of a model that are not zero, each with its own name.

    `lines` defines the names; `slopes` finds them by function and variable.
    """

    lines: tuple[Line, ...]
    slopes: dict[tuple[sp.Symbol, sp.Symbol], sp.Symbol]

    def derivative(self, expression: sp.Expr, variable: sp.Symbol) -> sp.Expr:
        """Derivative of `expression` by `variable`, also by way of the named functions in it."""
        result = derivative(expression, variable)
        for symbol in sorted(symbols_of(expression), key=str):
            slope = self.slopes.get((symbol, variable))
            if slope is not None:
                result += derivative(expression, symbol) * slope
        return result


def chain_rule(equations: Equations) -> ChainRule:
    """Differentiate the named functions of `equations` by states, inputs and parameters."""
    inputs = [i.symbol for i in equations.inputs]
    parameters = [p.symbol for p in equations.parameters]
    rule, named = ChainRule((), {}), {symbol for symbol, _ in equations.terms}
    for symbol, term in equations.terms:
        for variable in (*equations.state_symbols, *inputs, *parameters):
            slope = rule.derivative(term, variable)
            if slope != 0:
                name = slope_symbol(symbol, variable)
                rule.slopes[symbol, variable] = name
                if name not in named:
                    rule = ChainRule((*rule.lines, (str(name), slope)), rule.slopes)
    return rule
