"""Symmetry, positive definiteness, passivity and the energy ledger of the rigid equations."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from ptp_symbolic.symbolic.derivation.kane import kane
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.properties import (
    energy_remainder,
    is_passive,
    is_symmetric,
    smallest_eigenvalue,
)
from ptp_symbolic.symbolic.mechanics.bodies import RigidEquations
from tests.derivation import rigid_configurations as machines

TILTED = "payload on a tilted base"
FULL = lagrange(machines.configuration(("pan", "tilt"), TILTED))


@pytest.mark.parametrize("derive", [lagrange, newton_euler, kane])
@pytest.mark.parametrize("axes", machines.AXES)
def test_symmetric_passive_and_the_energy_ledger_closes(axes: tuple[str, ...], derive) -> None:
    equations: RigidEquations = derive(machines.configuration(axes, TILTED))
    assert is_symmetric(equations)
    assert is_passive(equations)
    assert energy_remainder(equations) == 0


def test_a_lost_coriolis_torque_is_noticed() -> None:
    lost = FULL.forcing.xreplace({FULL.rates[1]: 0})
    broken = replace(FULL, forcing=sp.ImmutableMatrix([lost[0], FULL.forcing[1]]))
    assert not is_passive(broken)
    assert energy_remainder(broken) != 0


def test_a_mass_matrix_that_is_not_of_the_kinetic_energy_is_noticed() -> None:
    mass = sp.Matrix(FULL.mass_matrix)
    mass[0, 1] = -mass[0, 1]
    broken = replace(FULL, mass_matrix=sp.ImmutableMatrix(mass))
    assert not is_symmetric(broken)
    assert energy_remainder(broken) != 0


finite = st.floats(-1.0, 1.0)


@settings(max_examples=150, deadline=None)
@given(
    spreads=st.tuples(*(arrays(float, (3, 3), elements=finite) for _ in range(3))),
    offset=arrays(float, 3, elements=finite),
    mass=st.floats(1e-3, 1e3),
)
def test_positive_definite_for_every_physical_inertia(
    spreads: tuple[np.ndarray, ...], offset: np.ndarray, mass: float
) -> None:
    values = {"m_payload": mass}
    values |= {f"c_{k}_payload": c for k, c in zip("xyz", offset, strict=True)}
    for body, spread in zip(("pan", "tilt", "payload"), spreads, strict=True):
        values |= machines.inertia_values(body, spread + 0.1 * np.eye(3))
    values = {name: v for name, v in values.items() if machines.symbol(name) in MASS_SYMBOLS}
    tilt = np.linspace(-np.pi, np.pi, 25)
    angles = np.stack([np.zeros_like(tilt), tilt], axis=1)
    assert np.all(smallest_eigenvalue(FULL, machines.by_symbol(values), angles) > 0)


MASS_SYMBOLS = FULL.mass_matrix.free_symbols


def test_an_impossible_inertia_is_not_positive_definite() -> None:
    values = dict.fromkeys(MASS_SYMBOLS - {*FULL.coordinates}, 0.1)
    values[machines.symbol("J_zz_pan")] = -5.0
    assert np.all(smallest_eigenvalue(FULL, values, np.zeros((1, 2))) < 0)
