"""Derivatives of expressions that hold named functions, by the chain rule.

Without the names a derivative by each of forty parameters would write every function out again. A
named function of the parameters alone, an inertia about an axis say, is a variable of its own: what
depends on it is differentiated once by it, and not once by each of its parameters.
"""

from dataclasses import dataclass, field

import sympy as sp

from ptp_symbolic.symbolic.derivation.contributions import slope_symbol
from ptp_symbolic.symbolic.derivation.differentiation import derivative, symbols_of
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.program.sharing import Line, if_shared


@dataclass(frozen=True)
class ChainRule:
    """Derivatives of the named functions of a model that are not zero, each with its own name.

    `lines` defines the names; `slopes` finds them by function and variable, for the functions that
    depend on the state. `constants` are functions of the parameters alone; `weights` are, by
    parameter, the constants that depend on it with their derivatives; `outer` are derivatives by
    functions that are defined already.
    """

    lines: list[Line] = field(default_factory=list)
    slopes: dict[tuple[sp.Symbol, sp.Symbol], sp.Symbol] = field(default_factory=dict)
    constants: list[sp.Symbol] = field(default_factory=list)
    weights: dict[sp.Symbol, dict[sp.Symbol, sp.Symbol]] = field(default_factory=dict)
    outer: set[sp.Symbol] = field(default_factory=set)

    def partial(self, expression: sp.Expr, variable: sp.Symbol, name: str | None = None) -> sp.Expr:
        """Derivative of `expression` by `variable`, the other constants held, also by way of the
        functions of the state in it. With the `name` of the expression its derivatives by these
        are definitions.
        """
        result = derivative(expression, variable)
        for symbol in sorted(symbols_of(expression), key=str):
            slope = self.slopes.get((symbol, variable))
            if slope is not None:
                outer = derivative(expression, symbol)
                result += (outer if name is None else self._outer(name, symbol, outer)) * slope
        return result

    def _outer(self, name: str, symbol: sp.Symbol, value: sp.Expr) -> sp.Expr:
        if value.is_Atom:
            return value
        own = if_shared(f"{name}_by_{symbol}")
        if own not in self.outer:
            self.outer.add(own)
            self.lines.append((str(own), value))
        return own

    def derivative(self, expression: sp.Expr, variable: sp.Symbol) -> sp.Expr:
        """Derivative of `expression` by `variable`, also by way of all named functions in it."""
        result = self.partial(expression, variable)
        for constant, weight in self.weights.get(variable, {}).items():
            result += weight * self.partial(expression, constant)
        return result

    def name_slope(self, symbol: sp.Symbol, variable: sp.Symbol, value: sp.Expr) -> sp.Symbol:
        """The name of the derivative of `symbol` by `variable`, defined as `value`."""
        name = slope_symbol(symbol, variable)
        self.lines.append((str(name), value))
        return name


def chain_rule(equations: Equations) -> ChainRule:
    """Differentiate the named functions of `equations` by states, inputs and parameters."""
    inputs = [i.symbol for i in equations.inputs]
    parameters = [p.symbol for p in equations.parameters]
    rule, named = ChainRule(), {symbol for symbol, _ in equations.terms}
    fixed = set(parameters)
    for symbol, term in equations.terms:
        if symbols_of(term) <= fixed:
            fixed.add(symbol)
            for parameter in parameters:
                value = rule.derivative(term, parameter)
                if value != 0:
                    weight = rule.name_slope(symbol, parameter, value)
                    rule.weights.setdefault(parameter, {})[symbol] = weight
            rule.constants.append(symbol)
            continue
        for variable in (*equations.state_symbols, *inputs, *parameters, *rule.constants):
            value = rule.partial(term, variable, str(symbol))
            if value != 0:
                name = slope_symbol(symbol, variable)
                rule.slopes[symbol, variable] = name
                if name not in named:
                    rule.lines.append((str(name), value))
    return rule
