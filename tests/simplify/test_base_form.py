"""Base parameters: minimal in number, exact, few operations, and nothing else touched."""

import ast

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics.bodies import Body, RigidConfiguration, RigidEquations
from ptp_symbolic.symbolic.simplify.base_parameters import BaseForm, base_form
from ptp_symbolic.symbolic.simplify.operations import (
    operation_count,
    share_subexpressions,
    written_operations,
)
from ptp_symbolic.symbolic.simplify.solve import accelerations
from tests.derivation import rigid_configurations as machines
from tests.derivation.rigid_configurations import symbol

EVERY = [(axes, load) for axes in machines.AXES for load in machines.LOADS]
NAMES = [f"{'-'.join(axes)}: {load}" for axes, load in EVERY]


def driven(rigid: RigidEquations) -> sp.ImmutableMatrix:
    """Forcing with the torque input and viscous friction of every joint."""
    torques = [symbol(f"tau_{a}") - symbol(f"b_{a}") * symbol(f"omega_{a}") for a in rigid.axes]
    return rigid.forcing + sp.ImmutableMatrix(torques)


def one_shape_payload() -> RigidConfiguration:
    """A payload whose inertia about pan varies with sin(tilt) cos(tilt) alone."""
    same, c = symbol("J_payload"), symbol("c_payload")
    inertia = sp.ImmutableMatrix(sp.diag(same, same, same))
    body = Body("payload", "tilt", symbol("m_payload"), sp.ImmutableMatrix([c, 0, c]), inertia)
    return RigidConfiguration(("pan", "tilt"), (body,), machines.LEVEL)


@pytest.mark.parametrize(("axes", "load"), EVERY, ids=NAMES)
def test_the_base_form_is_the_derived_equations(axes: tuple[str, ...], load: str) -> None:
    rigid = lagrange(machines.configuration(axes, load))
    assert_same(base_form(rigid), rigid.mass_matrix, rigid.forcing)


def test_the_base_form_of_special_shapes() -> None:
    balanced = RigidConfiguration(("pan", "tilt"), machines.thesis_bodies(), machines.LEVEL)
    for configuration in (balanced, machines.payload_model(), one_shape_payload()):
        rigid = lagrange(configuration)
        assert_same(base_form(rigid, forcing=driven(rigid)), rigid.mass_matrix, driven(rigid))


def assert_same(base: BaseForm, mass_matrix: sp.MatrixBase, forcing: sp.MatrixBase) -> None:
    mass, force = base.physical()
    assert (mass - mass_matrix).applyfunc(normal_form) == sp.zeros(*mass.shape)
    assert (force - forcing).applyfunc(normal_form) == sp.zeros(*force.shape)
    terms = {s for s, _ in base.shared_terms}
    left = {s for e in (*base.mass_matrix, *base.forcing) for s in e.free_symbols}
    assert not terms & {s for matrix in base.expanded() for e in matrix for s in e.free_symbols}
    physical = {s for e in (*mass_matrix, *forcing) for s in e.free_symbols}
    assert left <= terms | {s for s, _ in base.base_parameters} | physical


@pytest.mark.parametrize(("axes", "load"), EVERY, ids=NAMES)
def test_there_are_no_fewer_base_parameters(axes: tuple[str, ...], load: str) -> None:
    # The entries at many states, for many machines, span a space of as many dimensions as there
    # are base parameters: its rank is found here by singular values, without any algebra.
    rigid = lagrange(machines.configuration(axes, load))
    base = base_form(rigid)
    entries = [*rigid.mass_matrix, *rigid.forcing]
    state = [*rigid.coordinates, *rigid.rates]
    parameters = sorted({s for e in entries for s in e.free_symbols} - set(state), key=str)
    function = sp.lambdify([*state, *parameters], entries, modules="numpy", cse=True)
    random = np.random.default_rng(5)
    states = random.uniform(-2, 2, (len(state), 200))
    columns = []
    for _ in range(60):
        values = function(*states, *random.uniform(0.5, 1.5, len(parameters)))
        columns.append(np.concatenate([np.broadcast_to(value, (200,)) for value in values]))
    sizes = np.linalg.svd(np.array(columns), compute_uv=False)
    rank = int(np.sum(sizes > 1e-11 * sizes[0]))
    assert len(base.base_parameters) == rank


def test_the_payload_model_needs_at_most_44_operations() -> None:
    rigid = lagrange(machines.payload_model())
    forcing = driven(rigid)
    lines, outputs = accelerations(rigid.mass_matrix, forcing)
    assert operation_count(outputs, lines) > 120
    base = base_form(rigid, forcing=forcing)
    lines, outputs = accelerations(base.mass_matrix, base.forcing)
    count = operation_count(outputs, (*base.shared_terms, *lines))
    assert count == 42, "the baseline moved: on purpose?"
    shared, outputs = share_subexpressions(outputs, (*base.shared_terms, *lines))
    assert operations_of_text([*(str(e) for _, e in shared), *map(str, outputs)]) <= 44
    divisions = [
        e for _, e in shared if e.atoms(sp.Pow) and any(p.exp == -1 for p in e.atoms(sp.Pow))
    ]
    assert len(divisions) == 1


def operations_of_text(lines: list[str]) -> int:
    """Arithmetic operators in source text, one call of sincos and numbers not counted."""
    nodes = [node for line in lines for node in ast.walk(ast.parse(line))]
    return sum(isinstance(node, ast.BinOp) for node in nodes)


def test_the_base_parameters_of_the_payload_model() -> None:
    base = base_form(lagrange(machines.payload_model()))
    m, x, y, z = (symbol(f"{name}_payload") for name in ("m", "c_x", "c_y", "c_z"))
    values = {str(name): value for name, value in base.base_parameters}
    J = {k: symbol(f"J_{k}_tilt") + symbol(f"J_{k}_payload") for k in "xyz"}
    expected = {
        "inertia_pan": symbol("J_pan") + J["z"] + m * (x**2 + y**2),
        "inertia_pan_sin_sq_tilt": J["x"] - J["z"] + m * (z**2 - x**2),
        "inertia_pan_sin_cos_tilt": 2 * m * x * z,
        "coupling_sin_tilt": m * x * y,
        "coupling_cos_tilt": m * y * z,
        "inertia_tilt": J["y"] + m * (x**2 + z**2),
        "gravity_sin_tilt": machines.G * m * z,
        "gravity_cos_tilt": machines.G * m * x,
    }
    assert list(values) == list(expected)
    assert all(sp.expand(values[name] - expected[name]) == 0 for name in expected)


def test_a_physical_parameter_that_stands_alone_keeps_its_name() -> None:
    balanced = RigidConfiguration(("pan", "tilt"), machines.thesis_bodies(), machines.LEVEL)
    base = base_form(lagrange(balanced))
    alone = symbol("J_y_tilt")
    assert (alone, alone) in base.base_parameters
    assert base.mass_matrix[1, 1] == alone


def test_names_that_are_taken_are_not_used_again() -> None:
    taken = sp.ImmutableMatrix(sp.diag(0, 0, symbol("inertia_pan")))
    body = Body("pan_body", "pan", symbol("m"), machines.offset("pan"), taken)
    base = base_form(lagrange(RigidConfiguration(("pan",), (body,), machines.LEVEL)))
    (name, value), *others = base.base_parameters
    assert str(name) == "inertia_pan_2"
    assert symbol("inertia_pan") in value.free_symbols
    assert not others
    rigid = lagrange(machines.payload_model())
    names = [symbol("coriolis"), symbol("inertia_pan_per_sin_tilt")]
    base = base_form(rigid, forcing=rigid.forcing + sp.ImmutableMatrix(names))
    assert not {s for s, _ in base.shared_terms} & set(names)
    assert_same(base, rigid.mass_matrix, rigid.forcing + sp.ImmutableMatrix(names))


def test_the_rest_of_the_machine_passes_through() -> None:
    rigid = lagrange(machines.payload_model())
    rotor, ratio, motor = symbol("J_motor_pan"), symbol("N_pan"), symbol("J_motor_tilt")
    mass = sp.diag(rigid.mass_matrix, motor)
    mass[0, 0] += ratio**2 * rotor
    angle, gear = symbol("theta_tilt"), symbol("theta_gear_tilt")
    stribeck = symbol("F_s_pan") * sp.exp(-sp.Abs(symbol("omega_pan") / symbol("v_s_pan")))
    spring = symbol("k_shaft_tilt") * (gear - angle) ** 3
    forcing = sp.Matrix([rigid.forcing[0] - stribeck, rigid.forcing[1] + spring, -spring])
    base = base_form(rigid, mass, forcing)
    inertia = dict(base.base_parameters)[symbol("inertia_pan")]
    assert sp.expand(inertia).coeff(rotor) == ratio**2
    assert base.mass_matrix[2, 2] == motor
    assert base.forcing[2] == -spring
    plain = base_form(rigid)
    assert base.forcing[0] - plain.forcing[0] == -stribeck
    assert base.forcing[1] - plain.forcing[1] == spring


@pytest.mark.parametrize(
    ("addition", "reason"),
    [(sp.exp(symbol("theta_tilt")), "outside of its own sine"), (1 / symbol("m"), "polynomial")],
)
def test_an_inertia_that_is_no_polynomial_is_refused(addition: sp.Expr, reason: str) -> None:
    rigid = lagrange(machines.payload_model())
    mass = sp.Matrix(rigid.mass_matrix)
    mass[1, 1] += addition
    with pytest.raises(ValueError, match=reason):
        base_form(rigid, mass)


def test_operations_are_counted_as_promised() -> None:
    x, y = sp.symbols("x y", real=True)
    assert written_operations(sp.sin(x) * y + sp.cos(x)) == 2
    assert written_operations(1 / (x + y)) == 2
    assert written_operations(x**2 - y) == 2
    assert operation_count([x * y + 1, x * y + 2]) == 3
    shared = sp.Symbol("shared", real=True)
    assert operation_count([shared * y], [(shared, x + y)]) == 2
    lines, (output,) = share_subexpressions([shared**2], [(shared, sp.sin(x) + sp.sin(x) * y)])
    for name, term in reversed(lines):
        output = output.xreplace({name: term})
    assert sp.expand(output - (sp.sin(x) + sp.sin(x) * y) ** 2) == 0
