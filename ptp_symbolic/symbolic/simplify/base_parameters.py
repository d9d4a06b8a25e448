"""Base parameters: the fewest combinations of physical parameters that the motion depends on."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations_with_replacement

import sympy as sp

from ptp_symbolic.symbolic.mechanics.bodies import RigidEquations
from ptp_symbolic.symbolic.mechanics.kinematics import TIME, place_of
from ptp_symbolic.symbolic.simplify.nesting import (
    AngleSums,
    Combination,
    Row,
    plus,
    unused_name,
    write_forcing,
)
from ptp_symbolic.symbolic.simplify.operations import Line
from ptp_symbolic.symbolic.simplify.regressors import (
    Coefficient,
    Exponents,
    Regression,
    StateFunction,
    regress,
)
from ptp_symbolic.symbolic.symbols import real


@dataclass(frozen=True)
class BaseForm:
    """Equations of motion M q'' = f in base parameters.

    `base_parameters` are pairs of symbol and combination of physical parameters; one that is a
    physical parameter by itself keeps its name and stands for itself. `shared_terms` are functions
    of state and base parameters that `mass_matrix` [n, n] in kg m^2 and `forcing` [n] in N m use,
    in order of use.
    """

    base_parameters: tuple[Line, ...]
    shared_terms: tuple[Line, ...]
    mass_matrix: sp.ImmutableMatrix
    forcing: sp.ImmutableMatrix

    def expanded(self) -> tuple[sp.ImmutableMatrix, sp.ImmutableMatrix]:
        """Mass matrix and forcing in base parameters with the shared terms put in."""
        return self._replace_all(self.shared_terms)

    def physical(self) -> tuple[sp.ImmutableMatrix, sp.ImmutableMatrix]:
        """Mass matrix and forcing in the physical parameters, to compare with the derivation."""
        return self._replace_all((*self.base_parameters, *self.shared_terms))

    def _replace_all(self, lines: Sequence[Line]) -> tuple[sp.ImmutableMatrix, sp.ImmutableMatrix]:
        mass_matrix, forcing = self.mass_matrix, self.forcing
        for symbol, expression in reversed(lines):
            mass_matrix = mass_matrix.xreplace({symbol: expression})
            forcing = forcing.xreplace({symbol: expression})
        return mass_matrix, forcing


def base_form(
    rigid: RigidEquations,
    mass_matrix: sp.MatrixBase | None = None,
    forcing: sp.MatrixBase | None = None,
) -> BaseForm:
    """Regroup rigid equations in the fewest base parameters, written with few operations.

    `mass_matrix` [m, m] and `forcing` [m] are those of the whole machine, whose first n rows are
    the rigid joints; left out, they are those of `rigid`. What the machine adds to the mass matrix
    of the joints joins the base parameters; torques that it adds pass through unchanged. The number
    of base parameters is the rank of the coefficients over the physical monomials, hence minimal.
    Raises ValueError when the rigid part is no trigonometric polynomial. Source: Gautier and
    Khalil, Direct calculation of minimum set of inertial parameters of serial robots, IEEE Trans.
    Robotics and Automation 6, 1990, p. 368-373.
    """
    clocks = _functions_of_time(rigid)
    opened = {symbol: function for function, symbol in clocks.items()}
    given = rigid.forcing
    rigid = replace(rigid, forcing=given.xreplace(clocks))
    n = len(rigid.coordinates)
    mass = sp.Matrix(rigid.mass_matrix if mass_matrix is None else mass_matrix)
    force = sp.Matrix(rigid.forcing if forcing is None else forcing)
    taken = {str(s) for entry in (*mass, *force) for s in entry.free_symbols}
    titles = _titles(rigid)
    entries = [(title, mass[cell]) for cell, title in titles.items()]
    entries += [("gravity", torque) for torque in rigid.forcing]
    rows, base_parameters = _combined(rigid, entries, taken)
    sums = AngleSums(rigid.coordinates, taken)
    for ((i, j), title), row in zip(titles.items(), rows, strict=False):
        mass[i, j] = mass[j, i] = sums.write_inertia(title, row)
    written = write_forcing(rows[len(titles) :], rigid.rates, sums)
    for i in range(n):
        force[i] = written[i] + (force[i] - given[i])
    return BaseForm(
        tuple((symbol, e.xreplace(opened)) for symbol, e in base_parameters),
        tuple((name, e.xreplace(opened)) for name, e in sums.lines),
        sp.ImmutableMatrix(mass).xreplace(opened),
        sp.ImmutableMatrix(force).xreplace(opened),
    )


def _titles(rigid: RigidEquations) -> dict[tuple[int, int], str]:
    """Name of every entry of the mass matrix on and above its diagonal."""
    places = [place_of(coordinate) for coordinate in rigid.coordinates]
    cells = combinations_with_replacement(range(len(places)), 2)
    return {(i, j): f"inertia_{places[i]}" if i == j else "coupling" for i, j in cells}


def _functions_of_time(rigid: RigidEquations) -> dict[sp.Expr, sp.Symbol]:
    """Sines and cosines of the time (a base that moves), to be carried along as they are."""
    found = [f for f in rigid.forcing.atoms(sp.sin, sp.cos) if TIME in f.free_symbols]
    ordered = sorted(found, key=sp.default_sort_key)
    return {f: real(f"clock:{number}") for number, f in enumerate(ordered)}


def _combined(
    rigid: RigidEquations, entries: Sequence[tuple[str, sp.Expr]], taken: set[str]
) -> tuple[list[Row], tuple[Line, ...]]:
    """Entries, given with titles, as rows in base parameters, and the base parameters."""
    expressions = [entry for _, entry in entries]
    regression = regress(expressions, rigid.coordinates, rigid.rates)
    basis = _Basis(regression, taken)
    rows = [
        {
            function: basis.combine(coefficient, _name(title, function, rigid))
            for function, coefficient in row.items()
        }
        for (title, _), row in zip(entries, regression.rows, strict=True)
    ]
    return rows, tuple(basis.parameters)


def _name(title: str, function: StateFunction, rigid: RigidEquations) -> str:
    words = function.name(rigid.coordinates)
    return f"{title}_{words}" if words else title


@dataclass
class _Basis:
    """Base parameters found so far, and the echelon form that expresses a coefficient in them."""

    regression: Regression
    taken: set[str]
    parameters: list[Line] = field(default_factory=list)
    _echelon: list[tuple[Exponents, Coefficient, Combination]] = field(default_factory=list)

    def combine(self, coefficient: Coefficient, name: str) -> Combination:
        """Write `coefficient` as rational multiples of base parameters, a new one if need be."""
        rest: Coefficient = dict(coefficient)
        combination: Combination = {}
        for pivot, vector, meaning in self._echelon:
            if pivot in rest:
                factor = rest[pivot] / vector[pivot]
                rest = plus(rest, vector, -factor)
                combination = plus(combination, meaning, factor)
        if not rest:
            return combination
        symbol, scale = self._new_parameter(coefficient, name)
        self._echelon.append((min(rest), rest, plus({symbol: scale}, combination, -1)))
        return {symbol: scale}

    def _new_parameter(self, coefficient: Coefficient, name: str) -> tuple[sp.Expr, sp.Rational]:
        """Symbol and scale of a base parameter that makes up the whole of `coefficient`."""
        expression = self.regression.parameter_expression(coefficient)
        if expression.is_Rational:
            return sp.Integer(1), expression
        scale, alone = expression.as_coeff_Mul()
        if alone.is_Symbol:
            self.parameters.append((alone, alone))
            return alone, scale
        mostly_negative = sum(sp.sign(value) for value in coefficient.values()) < 0
        scale = sp.Integer(-1 if mostly_negative else 1)
        symbol = real(unused_name(name, self.taken))
        self.taken.add(str(symbol))
        self.parameters.append((symbol, sp.expand(scale * expression)))
        return symbol, scale
