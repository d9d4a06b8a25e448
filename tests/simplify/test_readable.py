"""Formulas as a person would write them, and docstrings in the form that the code computes."""

import ast
import re

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.models.emission import module_of
from ptp_symbolic.platform import preset_names, read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.simplify.readable import readable

SYMBOLS = "J_pan J_x_tilt J_z_tilt m c_x c_y c_z theta_pan theta_tilt beta k theta_0 omega_pan"
J_PAN, J_X, J_Z, M, C_X, C_Y, C_Z, PAN, TILT, BETA, K, REST, RATE = sp.symbols(SYMBOLS, real=True)
SIN, COS = sp.sin(TILT), sp.cos(TILT)
GIVEN_AND_WRITTEN = {
    "sine and cosine squared fold": (
        C_Y**2 * M * SIN**2 + C_Y**2 * M * COS**2 + J_PAN,
        "J_pan + c_y**2*m",
    ),
    "inertias are collected by what they are multiplied with": (
        J_X * SIN**2 + C_Z**2 * M * SIN**2 + C_X**2 * M * COS**2 + J_Z * COS**2,
        "(J_x_tilt + c_z**2*m)*sin(theta_tilt)**2 + (J_z_tilt + c_x**2*m)*cos(theta_tilt)**2",
    ),
    "rates belong to the motion": (
        J_X * RATE * SIN * COS - J_Z * RATE * SIN * COS,
        "omega_pan*(J_x_tilt - J_z_tilt)*sin(theta_tilt)*cos(theta_tilt)",
    ),
    "a difference of angles under a sine": (
        K * sp.sin(BETA) * sp.cos(PAN) - K * sp.cos(BETA) * sp.sin(PAN),
        "k*sin(beta - theta_pan)",
    ),
    "a difference of angles under a cosine, beside another factor": (
        K * SIN * (sp.sin(BETA) * sp.sin(PAN) + sp.cos(BETA) * sp.cos(PAN)),
        "k*sin(theta_tilt)*cos(beta - theta_pan)",
    ),
    "a sum of angles": (
        -sp.sin(BETA) * sp.cos(PAN) - sp.cos(BETA) * sp.sin(PAN),
        "-sin(beta + theta_pan)",
    ),
    "a spring with a rest angle": (K * (-2 * REST + 2 * PAN) / 2, "k*(-theta_0 + theta_pan)"),
    "a spring behind half a gap": (
        K * (2 * PAN - 2 * TILT - REST) / 2,
        "k*(-theta_0/2 + theta_pan - theta_tilt)",
    ),
    "a wave keeps its number": (
        K * sp.sin(7 * PAN + BETA) + K * COS,
        "k*sin(beta + 7*theta_pan) + k*cos(theta_tilt)",
    ),
}


@pytest.mark.parametrize("case", GIVEN_AND_WRITTEN)
def test_written_as_a_person_would(case: str) -> None:
    given, wanted = GIVEN_AND_WRITTEN[case]
    assert (
        sp.sstr(readable(sp.expand(given) if given.has(sp.sin) else given), order="lex") == wanted
    )


@pytest.mark.parametrize("name", preset_names())
def test_what_is_written_has_the_value_of_what_was_derived(name: str) -> None:
    equations = assemble(read_platform(name))
    entries = [*equations.mass_matrix, *equations.forcing, *equations.ledger.parts]
    symbols = sorted({s for e in entries for s in e.free_symbols}, key=str)
    values = np.random.default_rng(2).uniform(0.1, 1.0, len(symbols))
    for entry in entries:
        before, after = (float(sp.lambdify(symbols, e)(*values)) for e in (entry, readable(entry)))
        assert after == pytest.approx(before, rel=1e-11, abs=1e-11)


def test_the_docstring_shows_the_inertia_that_the_code_computes() -> None:
    """About the pan axis: J_pan, and of tilt body and payload what their squares of arm give."""
    found = ast.get_docstring(ast.parse(module_of(read_platform("thesis-payload")))) or ""
    lines = re.sub(r"\n {6,}", " ", found).splitlines()
    formulas = dict(
        line.strip().split(" = ", 1)
        for line in lines
        if "' = " not in line and re.match(r"  [\w\[\], ]+ = ", line)
    )
    values = dict(J_pan=0.1, J_x_tilt=0.2, J_y_tilt=0.3, J_z_tilt=0.4, m_payload=2.0)
    values |= dict(J_x_payload=0.5, J_y_payload=0.6, J_z_payload=0.7, gravity=9.81)
    values |= dict(
        c_x_payload=0.3, c_y_payload=0.2, c_z_payload=-0.1, theta_tilt=0.4, omega_pan=1.0
    )
    for name, formula in formulas.items():
        if "[" not in name:
            values[name] = evaluated(formula, values)
    sine, cosine = np.sin(0.4), np.cos(0.4)
    arm_x, arm_y = 0.3 * cosine + -0.1 * sine, 0.2
    inertia = 0.1 + (0.2 + 0.5) * sine**2 + (0.4 + 0.7) * cosine**2 + 2.0 * (arm_x**2 + arm_y**2)
    assert evaluated(formulas["M[0, 0]"], values) == pytest.approx(inertia)
    assert not re.search(r"sin\(theta_tilt\)\*\*2.*cos\(theta_tilt\)\*\*2", formulas["M[0, 0]"])
    code = module_of(read_platform("thesis-payload")).partition("MODEL_HASH")[2]
    assert [n for n in formulas if "[" not in n and not re.search(rf"\b{n}\b", code)] == []


def evaluated(formula: str, values: dict[str, float]) -> float:
    return float(sp.sympify(formula, locals={n: sp.Float(v) for n, v in values.items()}))
