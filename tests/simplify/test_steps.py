"""The named steps of the simplification: counted, checked, the same on every run."""

from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.simplify import steps as simplification
from ptp_symbolic.symbolic.simplify.reduction import factor_entry, reduce_trigonometry
from ptp_symbolic.symbolic.simplify.steps import simplify_rigid
from tests.derivation import rigid_configurations as machines
from tests.derivation.rigid_configurations import symbol

STEP_NAMES = [
    "as derived",
    "trigonometric reduction",
    "factor element by element",
    "base parameters",
    "common subexpressions",
]
EVERY = [(axes, load) for axes in machines.AXES for load in machines.LOADS]


@pytest.mark.parametrize(("axes", "load"), EVERY)
def test_every_step_is_counted_and_checked(axes: tuple[str, ...], load: str) -> None:
    simplified = simplify_rigid(lagrange(machines.configuration(axes, load)))
    assert [step.name for step in simplified.steps] == STEP_NAMES
    for before, after in zip(simplified.steps, simplified.steps[1:], strict=False):
        assert after.operations_before == before.operations_after
    for step in simplified.steps:
        assert step.proved
        assert step.worst_difference < 1e-11
        assert step.operations_after <= step.operations_before
        assert step.shared_operations <= step.operations_after


def test_the_lines_compute_the_accelerations_of_the_derivation() -> None:
    rigid = lagrange(machines.configuration(("pan", "tilt"), "payload on a tilted base"))
    torques = sp.ImmutableMatrix([symbol("tau_pan"), symbol("tau_tilt")])
    simplified = simplify_rigid(rigid, forcing=rigid.forcing + torques)
    random = np.random.default_rng(2)
    for seed in range(6):
        values = machines.by_symbol(machines.physical_values(seed))
        state = (*rigid.coordinates, *rigid.rates, *torques)
        values |= dict(zip(state, random.uniform(-3, 3, 6), strict=True))
        known = {s: float(e.subs(values)) for s, e in simplified.base_form.base_parameters}
        known |= values
        for name, term in simplified.lines:
            known[name] = float(term.xreplace({s: sp.Float(known[s]) for s in term.free_symbols}))
        ours = [
            float(e.xreplace({s: sp.Float(known[s]) for s in e.free_symbols}))
            for e in simplified.accelerations
        ]
        mass = np.array(rigid.mass_matrix.subs(values), dtype=float)
        force = np.array((rigid.forcing + torques).subs(values), dtype=float)[:, 0]
        scale = 1e-12 * np.linalg.cond(mass) * np.linalg.norm(ours)
        np.testing.assert_allclose(ours, np.linalg.solve(mass, force), rtol=0, atol=scale)


def test_the_payload_model_ends_at_42_operations() -> None:
    rigid = lagrange(machines.payload_model())
    torques = [symbol(f"tau_{a}") - symbol(f"b_{a}") * symbol(f"omega_{a}") for a in rigid.axes]
    last = simplify_rigid(rigid, forcing=rigid.forcing + sp.ImmutableMatrix(torques)).steps[-1]
    assert last.shared_operations == last.operations_after == 42


def test_a_step_that_changes_the_equations_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    flip = ("flip", "", lambda entry, state: entry.subs(sp.sin(symbol("theta_tilt")), 0))
    monkeypatch.setattr(simplification, "ENTRY_STEPS", (flip,))
    with pytest.raises(ArithmeticError, match="'flip' changes the equations"):
        simplify_rigid(lagrange(machines.payload_model()))


def test_reduction_shortens_and_keeps_what_is_short() -> None:
    x, a, b = sp.symbols("x a b", real=True)
    sin, cos = sp.sin(x), sp.cos(x)
    assert reduce_trigonometry(a * sin**2 + a * cos**2 + b * cos**2) == a + b * cos**2
    assert reduce_trigonometry(a - a * sin**2) == a * cos**2
    assert reduce_trigonometry(a * sin**2 + b * cos**2) == a * sin**2 + b * cos**2


def test_factoring_collects_by_functions_of_the_state() -> None:
    x, a, b, c = sp.symbols("x a b c", real=True)
    entry = a * sp.sin(x) + b * sp.sin(x) + a * c + b * c
    factored = factor_entry(entry, {x})
    assert sp.count_ops(factored) < sp.count_ops(entry)
    assert normal_form(factored - entry) == 0


SCRIPT = """
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.simplify.steps import simplify_rigid
from tests.derivation import rigid_configurations as machines
machine = machines.configuration(("pan", "tilt"), "payload on a tilted base")
print(simplify_rigid(lagrange(machine)))
"""


def test_the_result_does_not_depend_on_the_hash_seed(
    printed_in_two_processes: Callable[..., set[str]],
) -> None:
    assert len(printed_in_two_processes(SCRIPT)) == 1
