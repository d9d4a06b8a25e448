"""Coupling of the axes against the independent Newton-Euler program and thesis Table 2.2."""

import re
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.platform import read_platform
from ptp_symbolic.report.derivation.coupling import coupled_axes
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.coupling import (
    ALWAYS,
    AT_SPEED,
    DISTRIBUTIONS,
    UNCOUPLED,
    MassDistribution,
    conditions,
    coupling,
    distributed,
    distribution_of,
    linearity,
)
from tests.drawing.platforms import carriage, offset_platform, with_effects
from tests.independent.rigid_platform import chain, chain_torque

NAMES = [d.name for d in DISTRIBUTIONS]
# Errata 11 and 27: a completely symmetric, balanced body is linear; products of inertia couple at
# any speed. All other cells of the table stand.
CORRECTED = {
    "completely symmetric, balanced": ("linear", UNCOUPLED),
    "asymmetric, balanced": ("non-linear", ALWAYS),
}


def numbers_of(mass: MassDistribution) -> dict[str, float]:
    """Parameters of the independent program for one body that tilts like `mass`."""
    rng = np.random.default_rng(4)
    drawn = {str(s): 0.02 + 0.01 * rng.random() for s in sp.symbols("J_xy J_xz J_yz c_x c_y c_z")}
    drawn |= {"J_x": 0.3, "J_y": 0.4, "J_z": 0.35, "m": 2.0}
    values = {s: drawn[str(s)] for s in mass.inertia.free_symbols | mass.com.free_symbols}
    inertia = np.array(mass.inertia.xreplace(values).tolist(), float)
    com = np.array(mass.com.xreplace(values).tolist(), float)[:, 0]
    found = {"J_pan": 0.1, "m_payload": 2.0, "gravity": 9.81}
    for i, a in enumerate("xyz"):
        found[f"c_{a}_payload"] = com[i]
        for j, b in enumerate("xyz"[i:], start=i):
            found[f"J_{a}{b}_payload" if i != j else f"J_{a}_payload"] = inertia[i, j]
    return found


def measured_coupling(parameters: dict[str, float]) -> str:
    """How the axes of the independent program act on each other, at random states."""
    links, rng, none = chain(parameters), np.random.default_rng(7), np.zeros(2)
    always = at_speed = 0.0
    for _ in range(20):
        theta, other = rng.uniform(-3.0, 3.0, (2, 2))
        omega, faster = rng.uniform(-2.0, 2.0, (2, 2))
        at_rest = chain_torque(links, theta, none, none)
        always = max(
            always, abs((chain_torque(links, theta, none, np.array([0, 1.0])) - at_rest)[0])
        )
        moved = chain_torque(links, np.array([theta[0], other[1]]), none, none)
        always = max(always, abs((moved - at_rest)[0]))
        moved = chain_torque(links, np.array([other[0], theta[1]]), none, none)
        always = max(always, abs((moved - at_rest)[1]))
        for own, its in ((0, 1), (1, 0)):
            changed = omega.copy()
            changed[its] = faster[its]
            turned = theta.copy()
            turned[its] = other[its]
            both = [
                chain_torque(links, t, w, none)[own] for t, w in ((theta, omega), (turned, changed))
            ]
            at_speed = max(at_speed, abs(both[1] - both[0]))
    return ALWAYS if always > 1e-9 else AT_SPEED if at_speed > 1e-9 else UNCOUPLED


@pytest.mark.parametrize("mass", DISTRIBUTIONS, ids=NAMES)
def test_the_independent_program_couples_its_axes_likewise(mass: MassDistribution) -> None:
    equations = distributed(assemble(read_platform("thesis-ideal")).rigid, mass)
    assert coupling(equations) == measured_coupling(numbers_of(mass))


def test_the_table_of_the_thesis_is_met_but_for_its_errata(shared: Path) -> None:
    text = (shared / "thesis" / "thesis.txt").read_text(encoding="utf-8")
    table = text[text.index("Configuration\t") : text.index("Table 2.2: System")]
    rows = [re.split(r"\t+", line.strip()) for line in table.splitlines() if "on-linear" in line]
    assert len(rows) == len(DISTRIBUTIONS)
    rigid = assemble(read_platform("thesis-payload")).rigid
    words = {
        "un-coupled": UNCOUPLED,
        "coupling effect at higher speeds": AT_SPEED,
        "coupled": ALWAYS,
    }
    for (_, _, straight, axes), mass in zip(rows, DISTRIBUTIONS, strict=True):
        printed = straight.strip().lower(), words[axes.strip().lower()]
        equations = distributed(rigid, mass)
        found = linearity(equations), coupling(equations)
        assert found == CORRECTED.get(mass.name, printed)
        assert (found == printed) == (mass.name not in CORRECTED)


def test_the_conditions_of_a_payload_are_those_of_its_central_moments() -> None:
    """By hand: M_12 = m c_y (c_x sin - c_z cos); M_11 varies with J_x - J_z and m c_x c_z."""
    found = conditions(assemble(read_platform("thesis-payload")).rigid_equations)
    m, x, y, z = (
        sp.Symbol(n, real=True) for n in ("m_payload", *(f"c_{k}_payload" for k in "xyz"))
    )
    J = {k: sum(sp.Symbol(f"J_{k}_{b}", real=True) for b in ("tilt", "payload")) for k in "xz"}
    wanted = {
        m * x * y: ALWAYS,
        m * y * z: ALWAYS,
        m * x * z: AT_SPEED,
        J["x"] - J["z"] + m * z**2 - m * x**2: AT_SPEED,
    }
    for expression, kind in wanted.items():
        own = [c for c in found if sp.expand(c.expression**2 - expression**2) == 0]
        assert [c.kind for c in own] == [kind]
    assert len(found) == len(wanted)


def test_a_base_that_leans_couples_at_rest_through_gravity() -> None:
    level, leaning = (assemble(offset_platform(beta_base=b)).rigid_equations for b in (0.0, 0.1))
    gravity = sp.Symbol("gravity", real=True)
    for equations in (level, leaning):  # the angle is a symbol of the equations in both
        own = [c for c in conditions(equations) if gravity in c.expression.free_symbols]
        assert own
        assert {c.kind for c in own} == {ALWAYS}
    straight = assemble(read_platform("thesis-payload")).rigid_equations
    assert not [c for c in conditions(straight) if gravity in c.expression.free_symbols]


def test_the_report_says_what_the_declared_numbers_couple() -> None:
    text = coupled_axes(assemble(read_platform("thesis-payload")))
    assert "The axes of this platform are coupled at higher speeds." in text  # c_y is zero
    assert r"\textbf{symmetric, imbalanced} (here)" in text
    beside = with_effects(read_platform("thesis-payload"), c_y_payload=0.01)
    assert "The axes of this platform are coupled." in coupled_axes(assemble(beside))
    assert coupled_axes(assemble(carriage())) == ""


def test_distributions_are_told_from_the_sum_of_the_bodies() -> None:
    """By the declared numbers: equal inertias, different ones, and a product of inertia."""
    equations = assemble(read_platform("thesis-ideal"))
    values = {p.symbol: p.default for p in equations.parameters}
    assert distribution_of(equations.rigid, values).name == "partially symmetric, balanced"
    even = values | {sp.Symbol("J_x_tilt", real=True): 1.0, sp.Symbol("J_z_tilt", real=True): 1.0}
    assert distribution_of(equations.rigid, even).name == "completely symmetric, balanced"
    skewed = with_effects(
        read_platform("thesis-ideal"), ("product_of_inertia", None), J_xy_tilt=1e-4
    )
    own = assemble(skewed)
    values = {p.symbol: p.default for p in own.parameters}
    assert distribution_of(own.rigid, values).name == "asymmetric, balanced"
