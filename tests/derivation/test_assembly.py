"""Assembly of a declared platform: Eq. 3.8 of the thesis, and what is refused."""

from dataclasses import replace

import pytest
import sympy as sp

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    read_platform,
)
from ptp_symbolic.symbolic.derivation.assembly import assemble

IDEAL = read_platform("thesis-ideal")
THETA, PAN_RATE, TILT_RATE = sp.symbols("theta_tilt omega_pan omega_tilt", real=True)
J_ZP, J_XT, J_YT, J_ZT = sp.symbols("J_pan J_x_tilt J_y_tilt J_z_tilt", real=True)
B_P, B_T, E_1, E_2 = sp.symbols("b_pan b_tilt tau_pan tau_tilt", real=True)
SIN, COS = sp.sin(THETA), sp.cos(THETA)


def with_effect(effect: str, axis: str | None = None) -> Platform:
    return replace(IDEAL, effects=(*IDEAL.effects, EffectDeclaration(effect, axis, None)))


def with_parameter(declaration: ParameterDeclaration) -> Platform:
    kept = tuple(p for p in IDEAL.parameters if p.name != declaration.name)
    return replace(IDEAL, parameters=(*kept, declaration))


def test_mass_matrix_of_equation_3_8() -> None:
    equations = assemble(IDEAL)
    assert [str(s) for s in equations.rates] == ["omega_pan", "omega_tilt"]
    mass = equations.mass_matrix
    assert (mass[0, 1], mass[1, 0]) == (0, 0)
    assert sp.simplify(mass[0, 0] - (J_ZP + J_ZT * COS**2 + J_XT * SIN**2)) == 0
    assert sp.simplify(mass[1, 1] - J_YT) == 0


@pytest.mark.parametrize(
    ("row", "factor", "expected"),
    [
        (0, B_P, -PAN_RATE),
        (0, J_XT, -2 * COS * SIN * PAN_RATE * TILT_RATE),
        (0, J_ZT, 2 * COS * SIN * PAN_RATE * TILT_RATE),
        (0, E_1, 1),
        (1, B_T, -TILT_RATE),
        (1, J_XT, COS * SIN * PAN_RATE**2),
        (1, J_ZT, -COS * SIN * PAN_RATE**2),
        (1, E_2, 1),
    ],
)
def test_a_term_of_the_right_side_of_equation_3_8(
    row: int, factor: sp.Symbol, expected: sp.Expr
) -> None:
    """J_zt in the tilt row with the sign of erratum 5."""
    assert sp.simplify(assemble(IDEAL).forcing[row].diff(factor) - expected) == 0


def test_the_right_side_of_equation_3_8_has_no_other_terms() -> None:
    off = dict.fromkeys((B_P, B_T, J_XT, J_ZT, E_1, E_2), 0)
    assert assemble(IDEAL).forcing.xreplace(off) == sp.ImmutableMatrix([0, 0])


def test_parameters_carry_what_the_platform_declares() -> None:
    tied = with_parameter(ParameterDeclaration("b_tilt", None, 0.1, same_as="b_pan"))
    found = {p.name: p for p in assemble(tied).parameters}
    assert list(found) == ["J_pan", "J_x_tilt", "J_y_tilt", "J_z_tilt", "b_pan", "b_tilt"]
    assert found["J_y_tilt"].default == 6.5e-4  # Table 5.1
    bounded = with_parameter(ParameterDeclaration("b_pan", None, 0.3, True, 0.1, 0.5))
    (b_pan,) = [p for p in assemble(bounded).parameters if p.name == "b_pan"]
    assert (b_pan.default, b_pan.lower, b_pan.upper) == (0.3, 0.1, 0.5)


def test_a_tied_parameter_takes_the_value_of_the_other() -> None:
    tied = with_parameter(ParameterDeclaration("b_tilt", None, 0.9, same_as="b_pan"))
    (b_tilt,) = [p for p in assemble(tied).parameters if p.name == "b_tilt"]
    assert b_tilt.default == 0.1


@pytest.mark.parametrize(
    ("platform", "message"),
    [
        (
            with_effect("wings"),
            r"Unknown effect 'wings'; the nearest are \w+, \w+, \w+\. `ptp-symbolic effects` lists",
        ),
        (
            with_effect("cable_spring"),
            r"Effect 'cable_spring' sits on an axis; add axis = \"pan\"\.",
        ),
        (
            with_effect("backlash", "pan"),
            r"'backlash' acts on 'half_gap_pan', which no declared effect defines; declare"
            r" shaft_compliance on axis 'pan' too",
        ),
        (
            with_effect("direction_dependent_friction", "tilt"),
            r"acts on 'coulomb_torque_tilt', which no declared effect defines; declare csvs",
        ),
        (
            with_parameter(ParameterDeclaration("m_payload", "kg", 1.0)),
            r"'m_payload' belongs to no declared effect: it is of payload; declare one\. Known",
        ),
        (
            with_parameter(ParameterDeclaration("b_pam", "kg", 1.0)),
            r"Parameter 'b_pam' belongs to no declared effect: did you mean 'b_pan'\? Known",
        ),
        (
            with_parameter(ParameterDeclaration("b_pan", "kg m^2", 0.1)),
            r"Parameter 'b_pan' has unit 'kg m\^2'; give it in 'N m s/rad'\.",
        ),
        (
            with_parameter(ParameterDeclaration("b_pan", "N m s/rad", -0.1)),
            r"'b_pan' = -0\.1 N m s/rad lies outside its bounds \[0, 10000\] N m s/rad; change",
        ),
        (
            with_parameter(ParameterDeclaration("J_pan", "kg m^2", 1e5)),
            r"'J_pan' = 100000 kg m\^2 lies outside its bounds \[1e-12, 10000\] kg m\^2",
        ),
        (
            with_parameter(ParameterDeclaration("b_pan", None, 0.1, True, -5.0, 5.0)),
            r"'b_pan' has a bound of -5 N m s/rad, which it cannot have: it lies within",
        ),
        (
            with_effect("base_tilt", "pan"),
            r"'base_tilt' is of the whole platform; remove its axis = \"pan\"\.",
        ),
    ],
)
def test_refusals_say_what_is_allowed(platform: Platform, message: str) -> None:
    with pytest.raises(InputError, match=message):
        assemble(platform)
