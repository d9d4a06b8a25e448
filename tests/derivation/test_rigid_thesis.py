"""The balanced platform is Eq. 3.8 of the thesis, and errata 5, 11 and 27 hold."""

import sympy as sp

from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.trigonometry import normal_form
from ptp_symbolic.symbolic.mechanics import kinematics
from ptp_symbolic.symbolic.mechanics.bodies import RigidConfiguration, RigidEquations
from tests.derivation import rigid_configurations as machines
from tests.derivation.rigid_configurations import symbol

THETA, PAN_RATE, TILT_RATE = symbol("theta_tilt"), symbol("omega_pan"), symbol("omega_tilt")
SIN, COS = sp.sin(THETA), sp.cos(THETA)
J_ZP, J_XT, J_YT, J_ZT = (symbol(n) for n in ("J_pan", "J_x_tilt", "J_y_tilt", "J_z_tilt"))


def balanced() -> RigidEquations:
    return lagrange(RigidConfiguration(("pan", "tilt"), machines.thesis_bodies(), machines.LEVEL))


def test_the_balanced_platform_is_equation_3_8() -> None:
    # State (theta_t, omega_t, omega_p) as printed, but for the dampers b_p and b_t, which are an
    # effect of their own, and the inputs e_1 (pan) and e_2 (tilt).
    left = sp.diag(1, J_YT, J_ZP + J_ZT * COS**2 + J_XT * SIN**2)
    right = sp.Matrix(
        [
            [0, 1, 0],
            [0, 0, COS * SIN * PAN_RATE * (J_XT - J_ZT)],
            [0, -2 * J_XT * COS * SIN * PAN_RATE, 2 * J_ZT * COS * SIN * TILT_RATE],
        ]
    )
    forces = right * sp.Matrix([THETA, TILT_RATE, PAN_RATE])
    ours = balanced()
    assert [str(q) for q in ours.coordinates] == ["theta_pan", "theta_tilt"]
    expected_mass = sp.Matrix([[left[2, 2], 0], [0, left[1, 1]]])
    assert ours.mass_matrix == sp.ImmutableMatrix(expected_mass)
    assert sp.expand(ours.forcing[0] - forces[2]) == 0
    assert sp.expand(ours.forcing[1] - forces[1]) == 0
    assert forces[0] == TILT_RATE


def test_erratum_5_the_gyroscopic_torque_is_the_difference_of_inertias() -> None:
    # Eq. 3.7 prints "- +J_zt"; only the minus agrees.
    gyroscopic = COS * SIN * PAN_RATE**2
    forcing = balanced().forcing[1]
    assert normal_form(forcing - (J_XT * gyroscopic - J_ZT * gyroscopic)) == 0
    assert normal_form(forcing - (J_XT * gyroscopic + J_ZT * gyroscopic)) != 0


def test_erratum_11_equal_inertias_leave_it_linear_and_uncoupled() -> None:
    ours = balanced()
    same = {J_XT: J_ZT}
    mass = ours.mass_matrix.xreplace(same).applyfunc(normal_form)
    assert mass == sp.ImmutableMatrix([[J_ZP + J_ZT, 0], [0, J_YT]])
    assert ours.forcing.xreplace(same).applyfunc(normal_form) == sp.ImmutableMatrix([0, 0])


def test_erratum_27_products_of_inertia_and_offsets_couple_at_any_speed() -> None:
    full = lagrange(machines.configuration(("pan", "tilt"), "balanced"))
    products = -symbol("J_xy_tilt") * SIN + symbol("J_yz_tilt") * COS
    assert normal_form(full.mass_matrix[0, 1] - products) == 0
    offset = lagrange(machines.payload_model())
    m, x, y, z = (symbol(f"{n}_payload") for n in ("m", "c_x", "c_y", "c_z"))
    assert normal_form(offset.mass_matrix[0, 1] - m * y * (x * SIN - z * COS)) == 0
    at_rest = {PAN_RATE: 0, TILT_RATE: 0}
    assert offset.forcing[0].xreplace(at_rest) == 0
    gravity = machines.G * m * (x * COS + z * SIN)
    assert normal_form(offset.forcing[1].xreplace(at_rest) - gravity) == 0


def rotation(axes: tuple[str, ...], frame: str) -> sp.ImmutableMatrix:
    """Rotation of vectors of `frame` into the base."""
    still = sp.ImmutableMatrix([0, 0, 0])
    return RigidConfiguration(axes, (), still).rotation_to_base(frame)


def test_equation_3_1_gives_the_rates_of_the_tilt_body() -> None:
    turned = rotation(("pan", "tilt"), "tilt")
    rates = [(kinematics.angle(axis), kinematics.rate(axis)) for axis in ("pan", "tilt")]
    spin = sum((turned.T * turned.diff(q) * w for q, w in rates), sp.zeros(3, 3))
    spin = spin.applyfunc(normal_form)
    body_rates = [spin[2, 1], spin[0, 2], spin[1, 0]]
    assert body_rates == [-PAN_RATE * SIN, TILT_RATE, PAN_RATE * COS]


def test_a_positive_tilt_lowers_the_boresight() -> None:
    boresight = rotation(("pan", "tilt"), "tilt") * sp.Matrix([1, 0, 0])
    assert boresight[2] == -SIN
    alone = rotation(("tilt",), "pan")
    assert alone == sp.eye(3)


def test_on_a_tilted_base_the_payload_rests_at_the_azimuth() -> None:
    equations = lagrange(machines.configuration(("pan",), "payload on a tilted base"))
    beta, alpha = symbol("beta_base"), symbol("alpha_base")
    ahead = {symbol("c_y_payload"): 0, symbol("c_z_payload"): 0}
    torque = -symbol("m_payload") * machines.G * symbol("c_x_payload") * sp.sin(beta)
    expected = torque * sp.sin(kinematics.angle("pan") - alpha)
    assert normal_form(equations.forcing[0].xreplace(ahead) - expected) == 0
