"""Equations written in base parameters, the form from which kernels are made."""

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.simplify.base_parameters import base_form


def in_base_parameters(equations: Equations) -> Equations:
    """The same equations written in base parameters, which need the fewest operations; these and
    what they are multiplied by are named functions.
    """
    varying = equations.varying_inertia
    constant = equations.mass_matrix - varying
    form = base_form(equations.rigid_at_rest, constant, equations.forcing)
    mass = sp.ImmutableMatrix(form.mass_matrix + varying)
    raw, written = (
        [*matrix, *forcing]
        for matrix, forcing in ((equations.mass_matrix, equations.forcing), (mass, form.forcing))
    )
    terms = [(s, e) for s, e in (*form.base_parameters, *form.shared_terms) if s != e]
    terms += [(s, _in_base_form(e, raw, written)) for s, e in equations.terms]
    return replace(equations, mass_matrix=mass, forcing=form.forcing, terms=tuple(terms))


def _in_base_form(
    expression: sp.Expr, raw: Sequence[sp.Expr], written: Sequence[sp.Expr]
) -> sp.Expr:
    """The expression with a `raw` entry in it as it is `written` instead, where that is shorter."""
    for entry, form in zip(raw, written, strict=True):
        other = expression - entry + form
        if sp.count_ops(other) < sp.count_ops(expression):
            return other
    return expression
