"""Derivatives of real expressions, against differences of their values."""

from dataclasses import replace
from pathlib import Path

import pytest
import sympy as sp

from ptp_symbolic.models import emission, variants
from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.differentiation import derivative

X, C = sp.symbols("x c", real=True)


@pytest.mark.parametrize(
    "expression",
    [
        sp.Abs(X**3 - C),
        X * sp.Abs(C - sp.log(1 + X / C)),
        sp.Abs(sp.Max(0, X / C - 3) - sp.Abs(sp.log(X / C))),
        X**2 * C,
    ],
)
@pytest.mark.parametrize("at", [(0.4, 0.7), (2.0, 0.3), (-0.5, -1.1)])
def test_the_size_of_what_sympy_cannot_prove_real_has_a_sign_for_a_slope(
    expression: sp.Expr, at: tuple[float, float]
) -> None:
    value = sp.lambdify((X, C), expression, "math")
    x, c = at
    slope = derivative(expression, X)
    assert not slope.has(sp.arg, sp.re, sp.im)
    step = 1e-6
    difference = (value(x + step, c) - value(x - step, c)) / (2 * step)
    assert sp.lambdify((X, C), slope, "math")(x, c) == pytest.approx(difference, abs=1e-7)
    bend = derivative(slope, X)
    assert not bend.has(sp.Derivative, sp.arg, sp.re, sp.im)
    first = sp.lambdify((X, C), slope, "math")
    second = sp.lambdify((X, C), bend, [{"DiracDelta": lambda x: 0.0}, "math"])
    curvature = (first(x + step, c) - first(x - step, c)) / (2 * step)
    assert second(x, c) == pytest.approx(curvature, abs=1e-7)


PRESETS = ("pan-drive", "pan-servo", "payload", "full", "tilt-drive", "tilt-drive-stroke-48")
BREAKAWAY = ("rate_dependent_breakaway", "load_dependent_friction", "position_dependent_friction")


def test_guards_hold_the_size_of_a_load_and_the_logarithm_of_a_rest(checkout: Path) -> None:
    """The tilt drive with the three effects whose breakaway torque SymPy cannot prove real."""
    platform = read_platform(checkout / "ptp_symbolic/platform/presets/thesis-tilt-drive.toml")
    added = [
        e for e in variants.candidate_effects(platform) if e.effect in (*BREAKAWAY, "csvs_friction")
    ]
    model = emission.emit(replace(platform, effects=(*platform.effects, *added)))
    assert {"a_rest_tilt", "f_cos3_tilt", "mu_load_tilt"} <= {p.name for p in model.parameters}


@pytest.mark.long
@pytest.mark.parametrize("preset", PRESETS)
def test_every_machine_is_emitted_with_all_candidates(preset: str, checkout: Path) -> None:
    """A diagnosis begins with this."""
    platform = read_platform(checkout / f"ptp_symbolic/platform/presets/thesis-{preset}.toml")
    names = {p.name for p in emission.emit(variants.with_candidates(platform)).parameters}
    axis = "tilt" if "tilt" in preset else "pan"
    assert {f"a_rest_{axis}", f"f_cos3_{axis}", f"mu_load_{axis}"} <= names
