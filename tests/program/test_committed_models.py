"""The committed modules: up to date, sealed, and right against independent programs."""

import ast
import os
import re
import subprocess
import sys

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.models.committed import COMMITTED
from ptp_symbolic.numeric.runtime.model import Model, generated_folder, load_module
from ptp_symbolic.platform import read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.simplify.steps import simplify_rigid
from tests.independent import rigid_platform
from tests.independent.mujoco_bodies import load, mass_and_bias

STATES = 1000


@pytest.mark.parametrize("seed", [pytest.param("1", marks=pytest.mark.long), "20"])
def test_nothing_has_drifted_and_no_hash_seed_changes_a_byte(seed: str) -> None:
    command = [sys.executable, "-m", "ptp_symbolic", "regenerate", "--check"]
    environment = {**os.environ, "PYTHONHASHSEED": seed}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    said = f"{len(COMMITTED)} modules are up to date.\n"
    assert (done.returncode, done.stdout) == (0, said), done.stderr


@pytest.mark.parametrize("name", ["ideal", "payload"])
def test_rigid_models_against_an_independent_newton_euler_program(name: str) -> None:
    model, rng = ptp_symbolic.load(name), np.random.default_rng(7)
    for _ in range(STATES):
        values = {key: v * rng.uniform(0.5, 2.0) for key, v in model.defaults.items()}
        for key in ("c_y_payload", "c_z_payload"):
            if key in values:
                values[key] = 0.1 * rng.normal()
        x, u = 2.0 * rng.normal(size=4), rng.normal(size=2)
        found = model.rhs(0.0, x, u, model.parameter_vector(values))
        truth = rigid_platform.accelerations(x[:2], x[2:], u, values)
        mass = rigid_platform.mass_matrix(x[:2], values)
        bound = 1e-12 * np.linalg.cond(mass) * max(1.0, np.abs(truth).max())
        assert np.abs(found[2:] - truth).max() <= bound
        assert np.array_equal(found[:2], x[2:])


@pytest.mark.parametrize("name", sorted(COMMITTED))
def test_what_is_prepared_gives_the_same_derivative_in_every_mode(name: str) -> None:
    model, rng = ptp_symbolic.load(name), np.random.default_rng(11)
    module, n = model.module, len(model.state_names)
    whole, prepared = np.zeros(n), np.zeros(n)
    for _ in range(100):
        values = {p.name: rng.uniform(0.9, 1.1) * p.default for p in model.parameters}
        p = model.parameter_vector(values)
        m = rng.integers(-1, 2, len(model.mode_names)).astype(float)
        x, u = 0.1 * rng.normal(size=n), rng.normal(size=len(model.input_names))
        module.mode_derivative(0.0, x, u, p, m, whole)
        module.prepared_derivative(0.0, x, u, p, m, model.prepared(p), prepared)
        assert np.array_equal(whole, prepared, equal_nan=True)


def test_what_depends_on_parameters_alone_is_computed_once() -> None:
    """The inertias and weights of the payload: as the header says, 27 of 71 operations."""
    text = (generated_folder() / "payload.py").read_text()
    assert "71 as written, 44 of them" in text
    bodies = {
        node.name: sum(isinstance(each, ast.BinOp) for each in ast.walk(node))
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef)
    }
    assert bodies["mode_derivative"] == 0
    assert bodies["constants"] > 20


LONGEST = 2000  # lines of a module that a person is to read
FEWEST_NAMED = 0.85  # of the terms that say what they are, and not where they are used


def test_the_largest_module_reads_like_one_that_a_person_wrote() -> None:
    """No name for a name or its negative; most names say what a term is."""
    lines = (generated_folder() / "full.py").read_text().splitlines()
    assert len(lines) <= LONGEST and max(map(len, lines)) <= 100
    assigned = [found for line in lines if (found := re.match(r"    ([A-Za-z_]\w*) = (.*)", line))]
    assert [found[0] for found in assigned if re.fullmatch(r"-?[A-Za-z_]\w*", found[2])] == []
    names = {found[1] for found in assigned}
    by_place = re.compile(r"_(term|factor|denominator)(_\d+)?(_|$)")
    described = [name for name in names if not by_place.search(name)]
    assert len(described) >= FEWEST_NAMED * len(names)


def test_no_kernel_allocates() -> None:
    """Numba refuses to compile a function without its memory manager that allocates."""
    for name in COMMITTED:
        text = (generated_folder() / f"{name}.py").read_text()
        heads = re.findall(r"@njit\((.*)\)\ndef (\w+)", text)
        assert len(heads) > 10, name
        assert {function for options, function in heads if "_nrt=False" not in options} == set()


def test_gravity_may_be_set_like_any_parameter() -> None:
    """The payload swings about the tilt axis with the moon's gravity and the earth's."""
    model = ptp_symbolic.load("payload")
    rest, still = np.zeros(4), np.zeros(2)
    moon, earth = (
        model.rhs(0.0, rest, still, model.parameter_vector({"gravity": g}))[3] for g in (1.62, 9.81)
    )
    assert moon / earth == pytest.approx(1.62 / 9.81, rel=1e-12)
    assert model.defaults["gravity"] == 9.81


@pytest.mark.parametrize("name", ["ideal", "payload"])
def test_torques_that_a_motion_lacks_against_an_independent_newton_euler_program(name: str) -> None:
    model, rng = ptp_symbolic.load(name), np.random.default_rng(9)
    values, p, no_modes = model.defaults, model.parameter_vector(), np.zeros(0)
    for _ in range(STATES):
        angles, rates, wanted, given = rng.normal(size=(4, 2))
        lacking = np.zeros(2)
        x = np.concatenate([angles, rates, wanted])
        model.module.equation_error(0.0, x, given, p, no_modes, lacking)
        mass = rigid_platform.mass_matrix(angles, values)
        free = rigid_platform.accelerations(angles, rates, given, values)
        truth = mass @ (wanted - free)
        assert np.abs(lacking - truth).max() <= 1e-11 * max(1.0, np.abs(truth).max())


def mass_and_weight(
    model: Model, x: np.ndarray, p: np.ndarray, u: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix and gravity torques of a model, all its modes zero."""
    rows = sum(name.startswith("omega_") for name in model.state_names)
    u = np.zeros(len(model.input_names)) if u is None else u
    m, mass, weight = np.zeros(len(model.mode_names)), np.zeros((rows, rows)), np.zeros(rows)
    model.module.mass_matrix(0.0, x, u, p, m, mass)
    model.module.gravity_torque(0.0, x, u, p, m, weight)
    return mass, weight


def test_mass_matrix_and_weight_of_the_payload_are_those_of_mujoco() -> None:
    pytest.importorskip("mujoco")
    model, rng = ptp_symbolic.load("payload"), np.random.default_rng(12)
    for _ in range(30):
        values = {key: v * rng.uniform(0.9, 1.1) for key, v in model.defaults.items()}
        values |= {key: 0.1 * rng.normal() for key in ("c_x_payload", "c_y_payload", "c_z_payload")}
        angles, rates = rng.uniform(-np.pi, np.pi, 2), rng.normal(size=2)
        p = model.parameter_vector(values)
        mass, weight = mass_and_weight(model, np.concatenate([angles, rates]), p)
        down = np.array([0.0, 0.0, -values["gravity"]])
        expected, at_rest = mass_and_bias(load(values, down), angles, np.zeros(2))
        assert np.abs(mass - expected).max() <= 1e-12 * np.abs(expected).max()
        assert np.abs(weight - at_rest).max() <= 1e-12 * max(1.0, np.abs(at_rest).max())


@pytest.mark.parametrize("name", list(COMMITTED))
def test_mass_matrices_are_positive_definite_and_weight_is_the_slope_of_energy(name: str) -> None:
    """The weight of all bodies does not depend on rates, inputs or drive states."""
    model, rng, h = ptp_symbolic.load(name), np.random.default_rng(13), 1e-5
    rates = [k for k, n in enumerate(model.state_names) if n.startswith("omega_")]
    angles = [
        model.state_names.index(model.state_names[k].replace("omega", "theta")) for k in rates
    ]
    p, no_input = model.parameter_vector(), np.zeros(len(model.input_names))
    m, weightless = np.zeros(len(model.mode_names)), p.copy()
    if "gravity" in model.parameter_names:
        weightless[model.parameter_names.index("gravity")] = 0.0

    def potential(x: np.ndarray) -> float:
        energies = np.zeros((2, 3))
        for row, own in zip(energies, (p, weightless), strict=True):
            model.module.energy(0.0, x, no_input, own, m, row)
        return float(energies[0, 0] - energies[1, 0])

    for _ in range(10):
        x = 0.5 * rng.normal(size=len(model.state_names))
        mass, weight = mass_and_weight(model, x, p, rng.normal(size=len(no_input)))
        assert np.array_equal(mass, mass.T) and np.linalg.eigvalsh(mass).min() > 0.0
        for angle, torque in zip(angles, weight, strict=True):
            step = h * np.eye(len(x))[angle]
            slope = (potential(x + step) - potential(x - step)) / (2.0 * h)
            assert torque == pytest.approx(slope, rel=1e-8, abs=1e-8)


def test_the_mass_matrix_of_a_geared_drive_is_that_of_its_rotors() -> None:
    model = ptp_symbolic.load("pan_drive")
    p = model.parameter_vector({"J_pan": 3.0, "J_motor_pan": 2e-6, "N_pan": 100.0})
    mass, weight = mass_and_weight(model, np.zeros(len(model.state_names)), p)
    assert mass == pytest.approx(np.diag([3.0, 2e-6 * 100.0**2]), rel=1e-14)
    assert np.array_equal(weight, np.zeros(2))


@pytest.mark.parametrize("name", list(COMMITTED))
def test_a_motion_that_obeys_the_equations_lacks_no_torque(name: str) -> None:
    model, rng = ptp_symbolic.load(name), np.random.default_rng(4)
    states = list(model.state_names)
    rows = [states.index(n) for n in states if n.startswith("omega_")]
    others = [i for i, n in enumerate(states) if not n.startswith(("theta_", "omega_"))]
    n, p = len(states), model.parameter_vector()
    m = rng.choice([-1.0, 1.0], len(model.mode_names))
    for _ in range(20):
        x, u = 0.3 * rng.normal(size=n), rng.normal(size=len(model.input_names))
        dx, r = np.zeros(n), np.zeros(len(rows) + len(others))
        model.module.mode_derivative(0.0, x, u, p, m, dx)
        model.module.equation_error(0.0, np.concatenate([x, dx[rows]]), u, p, m, r)
        still = np.zeros_like(r)
        model.module.equation_error(0.0, np.concatenate([x, 0 * dx[rows]]), u, p, m, still)
        assert np.abs(r[: len(rows)]).max() <= 1e-9 * max(1.0, np.abs(still).max())
        assert r[len(rows) :] == pytest.approx(dx[others], rel=1e-12)


@pytest.mark.parametrize("name", list(COMMITTED))
def test_derivatives_against_central_differences(name: str) -> None:
    model, rng = ptp_symbolic.load(name), np.random.default_rng(3)
    n, nu, m = len(model.state_names), len(model.input_names), np.zeros(len(model.mode_names))
    m[:] = 1.0
    p, x, u = model.parameter_vector(), 0.3 * rng.normal(size=n), rng.normal(size=nu)
    found = model.derivatives(0.0, x, u, p, m)
    guards = len(found.gx)
    by_x, by_p = np.vstack([found.fx, found.gx]), np.vstack([found.fp, found.gp])
    by_u = np.vstack([found.fu, np.full((guards, nu), np.nan)])
    for array, matrix in ((x, by_x), (u, by_u), (p, by_p)):
        for j in range(len(array)):
            step = 1e-6 * max(abs(array[j]), 1e-3)
            sides = []
            for sign in (1.0, -1.0):
                kept, dx, g = array[j], np.zeros(n), np.zeros(guards)
                array[j] = kept + sign * step
                model.module.mode_derivative(0.0, x, u, p, m, dx)
                model.module.guards(0.0, x, u, p, m, g)
                array[j] = kept
                sides.append(dx if array is u else np.concatenate([dx, g]))
            difference = (sides[0] - sides[1]) / (2.0 * step)
            scale = np.abs(difference).max() + 1e-6
            rounding = np.finfo(float).eps * np.abs(sides).max() / step
            own = matrix[: len(difference), j]
            assert np.abs(difference - own).max() <= 2e-5 * scale + 2.0 * rounding


@pytest.mark.parametrize("name", ["full", "payload"])
def test_derivatives_that_are_not_asked_for_are_neither_written_nor_needed(name: str) -> None:
    """A step of the implicit method asks for those by the state and the inputs alone."""
    model, rng = ptp_symbolic.load(name), np.random.default_rng(5)
    n, m = len(model.state_names), np.ones(len(model.mode_names))
    x, u = 0.3 * rng.normal(size=n), rng.normal(size=len(model.input_names))
    p = model.parameter_vector()
    whole = model.derivatives(0.0, x, u, p, m)
    for asked in (2, 3):
        arrays = [np.zeros_like(a) if k < asked else a[:0].copy() for k, a in enumerate(whole)]
        model.module.linearize(0.0, x, u, p, m, *arrays)
        for k in range(asked):
            assert np.array_equal(arrays[k], whole[k])


def test_payload_needs_few_operations() -> None:
    equations = assemble(read_platform("thesis-payload"))
    steps = simplify_rigid(
        equations.rigid_equations, equations.mass_matrix, equations.forcing
    ).steps
    assert steps[-1].operations_after <= 44
    assert all(step.proved for step in steps)


def test_an_edited_module_is_refused(tmp_path) -> None:
    text = (generated_folder() / "ideal.py").read_text(encoding="utf-8")
    edited = tmp_path / "edited.py"
    edited.write_text(text.replace("cos_tilt", "sin_tilt", 1), encoding="utf-8")
    with pytest.raises(InputError, match=r"edited\.py does not fit its checksum"):
        load_module(edited, "edited_module")
