"""The trigonometric normal form decides equality, exactly."""

import pytest
import sympy as sp

from ptp_symbolic.symbolic.derivation.trigonometry import normal_form

X, Y = sp.symbols("x y", real=True)


@pytest.mark.parametrize(
    "identity",
    [
        sp.sin(X) ** 2 + sp.cos(X) ** 2 - 1,
        sp.cos(X) ** 4 - sp.sin(X) ** 4 - sp.cos(2 * X),
        sp.sin(X + Y) - sp.sin(X) * sp.cos(Y) - sp.cos(X) * sp.sin(Y),
        sp.cos(3 * X) - 4 * sp.cos(X) ** 3 + 3 * sp.cos(X),
        Y * (sp.cos(X) - sp.sin(X)) ** 2 - Y + 2 * Y * sp.sin(X) * sp.cos(X),
    ],
)
def test_identities_become_zero(identity: sp.Expr) -> None:
    assert normal_form(identity) == 0


def test_what_is_not_zero_stays() -> None:
    assert normal_form(sp.sin(X) ** 2 - sp.cos(X) ** 2) == 2 * sp.sin(X) ** 2 - 1
    assert normal_form(sp.Rational(1, 3) * Y) == Y / 3
    assert normal_form(sp.Integer(0)) == 0


@pytest.mark.parametrize(
    "strange", [1 / X, sp.exp(X), sp.tan(X), sp.sqrt(X), 0.5 * X, sp.sin(X**2), sp.sin(X / 2)]
)
def test_what_is_no_trigonometric_polynomial_is_refused(strange: sp.Expr) -> None:
    with pytest.raises(ValueError, match=r"polynomial|float|angles"):
        normal_form(strange)


def test_a_product_such_as_pi_f_t_is_an_angle_of_its_own() -> None:
    """Of a base that shakes; twice it is written with it."""
    f, t, a = sp.symbols("f t a", real=True)
    assert normal_form(sp.sin(sp.pi * f * t) ** 2 + sp.cos(sp.pi * f * t) ** 2) == 1
    double = sp.sin(2 * sp.pi * f * t + a) - sp.sin(a + 2 * sp.pi * f * t)
    assert normal_form(double) == 0
    twice = sp.sin(2 * sp.pi * f * t)
    assert normal_form(twice - 2 * sp.sin(sp.pi * f * t) * sp.cos(sp.pi * f * t)) == 0
