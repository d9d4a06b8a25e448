"""Newton-Euler, Kane and Lagrange give the same equations for every rigid configuration."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.symbolic.derivation.kane import kane
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.proof import compare_numerically, prove_equal
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics.bodies import RigidConfiguration, RigidEquations
from tests.derivation import rigid_configurations as machines
from tests.independent import rigid_platform

EVERY = [(axes, load) for axes in machines.AXES for load in machines.LOADS]
NAMES = [f"{'-'.join(axes)}: {load}" for axes, load in EVERY]


@pytest.fixture(scope="module", params=EVERY, ids=NAMES)
def routes(request: pytest.FixtureRequest) -> tuple[RigidEquations, ...]:
    configuration = machines.configuration(*request.param)
    return lagrange(configuration), newton_euler(configuration), kane(configuration)


def test_the_routes_agree_symbolically(routes: tuple[RigidEquations, ...]) -> None:
    by_lagrange, by_newton_euler, by_kane = routes
    assert prove_equal(by_lagrange, by_newton_euler).remainders == {}
    assert prove_equal(by_lagrange, by_kane).remainders == {}
    for other in (by_newton_euler, by_kane):
        assert normal_form(by_lagrange.kinetic - other.kinetic) == 0
        assert normal_form(by_lagrange.potential - other.potential) == 0


def test_the_routes_agree_at_10_000_states(routes: tuple[RigidEquations, ...]) -> None:
    values = machines.by_symbol(machines.physical_values(seed=3))
    by_lagrange, *others = routes
    for number, other in enumerate(others):
        worst = compare_numerically(by_lagrange, other, values, states=10_000, seed=number)
        assert worst <= 1e-12


@pytest.mark.parametrize("axes", machines.AXES)
def test_the_routes_agree_with_a_program_without_symbols(axes: tuple[str, ...]) -> None:
    equations = lagrange(machines.configuration(axes, "payload on a tilted base"))
    random = np.random.default_rng(11)
    for seed in range(6):
        values = machines.physical_values(seed)
        named = {_elsewhere(name): value for name, value in values.items()}
        theta, omega = random.uniform(-3, 3, len(axes)), random.normal(size=len(axes))
        state = machines.by_symbol(values)
        state |= dict(
            zip((*equations.coordinates, *equations.rates), (*theta, *omega), strict=True)
        )
        mass = np.array(equations.mass_matrix.subs(state), dtype=float)
        forcing = np.array(equations.forcing.subs(state), dtype=float)[:, 0]
        still = np.zeros(len(axes))
        expected = rigid_platform.mass_matrix(theta, named, axes)
        np.testing.assert_allclose(mass, expected, rtol=1e-12, atol=1e-15)
        torque = rigid_platform.inverse_dynamics(theta, omega, still, named, axes)
        np.testing.assert_allclose(-forcing, torque, rtol=1e-11, atol=1e-12)


def _elsewhere(name: str) -> str:
    """Our J_xx_tilt is J_x_tilt in the independent program; products have two letters in both."""
    return name.replace("_xx", "_x").replace("_yy", "_y").replace("_zz", "_z")


def test_a_wrong_sign_is_found_and_its_place_named() -> None:
    right = lagrange(machines.payload_model())
    pan, tilt = right.forcing
    omega = sp.Symbol("omega_tilt", real=True)
    wrong = replace(right, forcing=sp.ImmutableMatrix([pan.xreplace({omega: -omega}), tilt]))
    proof = prove_equal(right, wrong)
    assert not proof.equal
    assert list(proof.remainders) == ["forcing[0]"]
    names = ("J_pan", "J_x_tilt", "J_y_tilt", "J_z_tilt", "m_payload")
    names += tuple(f"{letter}_{k}_payload" for letter in "Jc" for k in "xyz")
    values = {machines.symbol(name): 0.1 + 0.01 * i for i, name in enumerate(names)}
    assert compare_numerically(right, wrong, values, states=100) > 1e-3


def test_numbers_are_compared_in_full_or_not_at_all() -> None:
    equations = lagrange(machines.payload_model())
    with pytest.raises(ValueError, match="No value for J_pan, J_x_payload"):
        compare_numerically(equations, equations, {})
    pan_alone = lagrange(machines.configuration(("pan",), "balanced"))
    with pytest.raises(ValueError, match="cannot be compared"):
        prove_equal(equations, pan_alone)


def test_configurations_that_make_no_sense_are_refused() -> None:
    bodies = machines.thesis_bodies()
    with pytest.raises(ValueError, match="in this order"):
        RigidConfiguration(("tilt", "pan"), bodies, machines.LEVEL)
    with pytest.raises(ValueError, match="frame 'roll'"):
        replace(bodies[0], frame="roll")
    with pytest.raises(ValueError, match="symmetric"):
        replace(bodies[0], inertia=sp.ImmutableMatrix([[1, 2, 0], [0, 1, 0], [0, 0, 1]]))
