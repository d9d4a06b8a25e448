"""Linear models against closed forms of a two-mass drive, and SciPy's differences of the module."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import approx_fprime

import ptp_symbolic
from ptp_symbolic.platform import EffectDeclaration, read_platform
from ptp_symbolic.report.derivation.linear import poles
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.linearisation import (
    LinearModel,
    OperatingPoint,
    linear_model,
    vector_field,
)
from tests.drawing.platforms import carriage, with_effects

AT_REST = OperatingPoint({}, {})


def two_masses_by_hand() -> np.ndarray:
    """A of the pan drive of the thesis, written down from its free-body diagrams.

    States: joint angle, motor angle at the gear output, their rates, current. Table 5.7.
    """
    load, rotor, ratio = 0.05, 1.1e-5, 500.0
    stiffness, damping, bearing = 5000.0, 1.0, 2.0
    constant, resistance, inductance = 0.0724, 12.9, 6.9e-3
    motor = rotor * ratio**2
    return np.array(
        [
            [0, 0, 1, 0, 0],
            [0, 0, 0, 1, 0],
            [-stiffness / load, stiffness / load, -(damping + bearing) / load, damping / load, 0],
            [
                stiffness / motor,
                -stiffness / motor,
                damping / motor,
                -damping / motor,
                ratio * constant / motor,
            ],
            [0, 0, 0, -ratio * constant / inductance, -resistance / inductance],
        ]
    )


def test_the_pan_drive_at_rest_is_the_two_masses_of_the_textbook() -> None:
    platform = with_effects(read_platform("thesis-pan-drive"), J_pan=0.05)
    model = linear_model(assemble(platform), AT_REST)
    assert [str(s) for s in model.states] == [
        "theta_pan",
        "theta_gear_pan",
        "omega_pan",
        "omega_gear_pan",
        "i_pan",
    ]
    assert np.allclose(model.A, two_masses_by_hand(), rtol=1e-12)
    assert np.allclose(model.B[:, 0], [0, 0, 0, 0, 1 / 6.9e-3])


def test_two_free_masses_swing_at_the_root_of_stiffness_over_reduced_inertia() -> None:
    platform = with_effects(
        read_platform("thesis-pan-drive"), d_shaft_pan=0.0, b_pan=0.0, K_t_pan=1e-9, J_pan=0.05
    )
    found = poles(linear_model(assemble(platform), AT_REST))
    swinging = [p.value for p in found if p.value.imag]
    assert len(swinging) == 1
    reduced = 1.0 / (1.0 / 0.05 + 1.0 / (1.1e-5 * 500.0**2))
    assert swinging[0].imag == pytest.approx(np.sqrt(5000.0 / reduced), rel=1e-9)
    assert abs(swinging[0].real) < 1e-6
    assert found[0].value == 0
    assert found[0].count == 2  # nothing holds the two together where they are


def test_a_payload_hangs_as_a_physical_pendulum() -> None:
    """Tilt down by 90 deg, the payload below the axis: omega^2 = m g c / (J + m c^2)."""
    platform = with_effects(read_platform("thesis-payload"), b_tilt=0.0, b_pan=0.0)
    equations = assemble(platform)
    p = {q.name: q.default for q in equations.parameters}
    found = poles(linear_model(equations, OperatingPoint({"tilt": np.pi / 2}, {})))
    inertia = p["J_y_tilt"] + p["J_y_payload"] + p["m_payload"] * p["c_x_payload"] ** 2
    wanted = np.sqrt(p["m_payload"] * p["gravity"] * p["c_x_payload"] / inertia)
    assert [q.value.imag for q in found if q.value.imag] == [pytest.approx(wanted, rel=1e-12)]
    up = poles(linear_model(equations, OperatingPoint({"tilt": -np.pi / 2}, {})))
    assert max(q.value.real for q in up) == pytest.approx(wanted, rel=1e-9)


def test_dry_friction_counts_with_its_slope_only_where_it_slides() -> None:
    """Coulomb and Stribeck parts: d/dw [(F_s - F_c) exp(-(w / v_s)^2)]."""
    platform = with_effects(
        read_platform("thesis-payload"),
        ("csvs_friction", "pan"),
        F_c_pan=0.2,
        F_s_pan=0.7,
        v_s_pan=0.1,
        F_v_pan=0.3,
    )
    equations = assemble(platform)
    rest = linear_model(equations, AT_REST)
    rate = 0.05
    sliding = linear_model(equations, OperatingPoint({}, {"pan": rate}, sliding=True))
    slope = 0.3 - 2 * rate / 0.1**2 * 0.5 * np.exp(-((rate / 0.1) ** 2))
    row = [str(s) for s in rest.states].index("omega_pan")
    inertia = 1.0 / rest.B[row, 0]
    assert (rest.A - sliding.A)[row, row] == pytest.approx(slope / inertia, rel=1e-9)
    u = dict(zip(map(str, sliding.values), sliding.values.values(), strict=True))
    level = 0.2 + 0.5 * np.exp(-((rate / 0.1) ** 2)) + 0.3 * rate
    b = next(q.default for q in equations.parameters if q.name == "b_pan")
    assert u["tau_pan"] == pytest.approx(level + b * rate, rel=1e-9)


def test_bodies_in_rigid_contact_are_one() -> None:
    """Play without a shaft, closed: rotor and load turn as one mass."""
    base = carriage(("dc_motor", "pan"))
    joined = linear_model(assemble(base), AT_REST)
    closed = EffectDeclaration("backlash", "pan", None, "elastic_impact")
    play = replace(base, effects=(*base.effects, closed))
    found = linear_model(assemble(play), AT_REST)
    assert list(map(str, found.states)) == list(map(str, joined.states))
    assert np.allclose(found.A, joined.A, rtol=1e-12)


@pytest.mark.parametrize(
    ("name", "preset", "point"),
    [
        ("payload", "thesis-payload", OperatingPoint({"tilt": 0.4}, {"pan": 0.7, "tilt": -0.3})),
        ("pan_drive", "thesis-pan-drive", OperatingPoint({}, {"pan": 0.1}, sliding=True)),
    ],
)
def test_the_linear_model_is_the_slope_of_the_emitted_module(
    name: str, preset: str, point: OperatingPoint
) -> None:
    linear = linear_model(assemble(read_platform(preset)), point)
    module = ptp_symbolic.load(name)
    at = {str(s): value for s, value in linear.values.items()}
    x = np.array([at[n] for n in module.state_names])
    u = np.array([at[n] for n in module.input_names])
    p = module.parameter_vector()
    assert np.allclose(module.rhs(0.0, x, u, p)[rows(linear, module.state_names, "omega")], 0.0)
    order = [module.state_names.index(str(s)) for s in linear.states]
    step = 1e-7
    A = approx_fprime(x, lambda q: module.rhs(0.0, q, u, p), step)[np.ix_(order, order)]
    B = approx_fprime(u, lambda q: module.rhs(0.0, x, q, p), step)[order]
    size = np.abs(A).max()
    assert np.allclose(linear.A, A, rtol=1e-4, atol=1e-6 * size)
    assert np.allclose(linear.B, B, rtol=1e-5, atol=1e-6)


def test_derivatives_hold_where_the_machine_accelerates() -> None:
    """The mass matrix varies with the tilt angle: its slope counts with the acceleration."""
    equations = assemble(read_platform("thesis-payload"))
    module, field = ptp_symbolic.load("payload"), vector_field(equations)
    p = module.parameter_vector()
    assert list(map(str, field.states)) == list(module.state_names)
    rng = np.random.default_rng(5)
    x, u = rng.uniform(-1.0, 1.0, 4), rng.uniform(-3.0, 3.0, 2)
    values = {q.symbol: q.default for q in equations.parameters}
    values |= dict(zip((*field.states, *field.inputs), (*x, *u), strict=True))
    rates, slopes = field.at(values)
    assert np.allclose(rates, module.rhs(0.0, x, u, p), rtol=1e-10)
    assert np.abs(rates[2:]).min() > 0.1
    A = approx_fprime(x, lambda q: module.rhs(0.0, q, u, p), 1e-7)
    assert np.allclose(slopes[:, :4], A, rtol=1e-5, atol=1e-5)


def rows(linear: LinearModel, names: tuple[str, ...], letter: str) -> list[int]:
    return [k for k, n in enumerate(names) if n.startswith(letter) and n in map(str, linear.states)]
