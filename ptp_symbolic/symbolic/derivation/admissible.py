"""Refuse a machine that cannot exist: parameters against each other, bodies, inertia."""

from collections.abc import Collection, Mapping

import numpy as np
import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform, naming_file
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.effect_interface.conditions import Requirement
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import Body

SLACK = 1e-9
ANGLE = 0.3


def refuse_impossible(equations: Equations, platform: Platform | None = None) -> None:
    """Raise InputError unless a machine with the parameters of `equations` can exist.

    Checked are the relations that the effects require, the inertia tensor of every body, and that
    every coordinate has inertia. With the `platform` that the equations are of, the message names
    its file and says "(default)" of the values that it does not declare.
    """
    if platform is None:
        _refuse_impossible(equations, {p.name for p in equations.parameters})
        return
    with naming_file(platform):
        _refuse_impossible(equations, {p.name for p in platform.parameters})


def _refuse_impossible(equations: Equations, declared: Collection[str]) -> None:
    values = {p.symbol: sp.Float(p.default) for p in equations.parameters}
    for requirement in equations.requirements:
        _refuse_broken(requirement, equations, values, declared)
    for body in equations.rigid.bodies:
        _refuse_impossible_tensor(body, equations, values, declared)
    _refuse_massless(equations, values, declared)


def _refuse_broken(
    requirement: Requirement,
    equations: Equations,
    values: Mapping[sp.Symbol, sp.Float],
    declared: Collection[str],
) -> None:
    if requirement.holds.subs(values) == sp.false:
        given = _given(requirement.holds.free_symbols, equations, declared)
        raise InputError(f"Impossible {given}: {requirement.rule}.")


def _refuse_impossible_tensor(
    body: Body,
    equations: Equations,
    values: Mapping[sp.Symbol, sp.Float],
    declared: Collection[str],
) -> None:
    """A body that is given about one axis alone has no tensor to check."""
    if any(body.inertia[k, k] == 0 for k in range(3)):
        return
    tensor = np.array(body.inertia.subs(values), dtype=float)
    low, middle, high = np.linalg.eigvalsh(tensor)
    if high > (low + middle) * (1.0 + SLACK):
        given = _given(body.inertia.free_symbols, equations, declared)
        raise InputError(
            f"Impossible {given}: of the principal inertias {low:.4g}, {middle:.4g} and"
            f" {high:.4g} kg m^2 of '{body.name}' none may exceed the sum of the others; change"
            " one of them."
        )


def _refuse_massless(
    equations: Equations, values: Mapping[sp.Symbol, sp.Float], declared: Collection[str]
) -> None:
    for k, rate in enumerate(equations.rates):
        axis = kinematics.place_of(rate)
        if axis.startswith("gear_") and equations.mass_matrix[k, k] == 0:
            raise InputError(
                f"Nothing turns before the shaft or gap on axis '{axis.removeprefix('gear_')}':"
                " declare its dc_motor, or rotor_inertia where its torque is the input."
            )
    known = {**values, **dict.fromkeys(equations.coordinates, sp.Float(ANGLE))}
    for symbol, term in equations.terms:
        known[symbol] = term.subs(known)
    mass = np.array(equations.mass_matrix.subs(known), dtype=float)
    scale = np.sqrt(np.diag(mass))
    if not (np.all(scale > 0) and np.linalg.eigvalsh(mass / np.outer(scale, scale))[0] > SLACK):
        given = _given(equations.mass_matrix.free_symbols, equations, declared)
        raise InputError(f"Impossible {given}: every axis needs inertia; give it some.")


def _given(symbols: set[sp.Symbol], equations: Equations, declared: Collection[str]) -> str:
    names = {str(symbol) for symbol in symbols}
    return ", ".join(
        f"{p.name} = {p.default:g} {p.unit}{'' if p.name in declared else ' (default)'}"
        for p in equations.parameters
        if p.name in names
    )
