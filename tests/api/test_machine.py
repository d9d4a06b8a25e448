"""A machine as an object: functions by name, mass matrix, linearisation, copies."""

import copy
import math
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from multiprocessing import get_context
from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.errors import InputError
from ptp_symbolic.models.committed import declared_platform
from ptp_symbolic.platform import EffectDeclaration, Platform

PENDULUM = Platform(
    "pendulum",
    "Tilt axis with a payload off its axis",
    ("pan", "tilt"),
    9.81,
    (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("payload", None, None),
        EffectDeclaration("viscous_friction", "tilt", None),
    ),
    (),
    (),
)
MASS, LENGTH, DAMPING, INERTIA = 2.0, 0.25, 0.3, 0.04
VALUES = {
    "m_payload": "2000 g",
    "c_x_payload": "25 cm",
    "c_y_payload": 0.0,
    "c_z_payload": 0.0,
    "J_x_payload": 0.0,
    "J_y_payload": 0.0,
    "J_z_payload": 0.0,
    "J_y_tilt": INERTIA,
    "b_tilt": DAMPING,
}


BENCH = """
[platform]
name = "bench"
axes = ["pan"]
[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "viscous_friction"
axis = "pan"
[parameters.b_pan]
value = 0.2
"""


@pytest.fixture(scope="module")
def pendulum() -> ptp.Machine:
    return ptp.load(PENDULUM, catalogue_values=True)


def test_a_platform_without_its_inertia_is_refused_in_the_words_of_the_commands(
    tmp_path: Path,
) -> None:
    """As an object as from a file: the thesis' machine is no default of another one."""
    file = tmp_path / "bench.toml"
    file.write_text(BENCH, encoding="utf-8")
    said = (
        f"{file}: Not declared, and without a natural default: J_pan in kg m^2 (inertia of the"
        " pan body about z). Declare each under [parameters], as in J_pan = { value = NUMBER,"
        ' unit = "kg m^2" }, or with start in place of value where it is to be fitted.'
    )
    platform = ptp.read_platform(file)
    motion = ([[0.0]], [[0.0]], [[1.0]])
    for use in (
        lambda: declared_platform(str(file)),
        lambda: ptp.load(platform),
        lambda: ptp.simulate(platform, 1.0),
        lambda: ptp.export(platform, "c99", tmp_path / "out"),
        lambda: ptp.fit(platform, [tmp_path / "run.csv"]),
        lambda: ptp.inverse_dynamics(platform, motion),
    ):
        with pytest.raises(InputError) as error:
            use()
        assert str(error.value) == said
    assert ptp.load(platform, catalogue_values=True).name == "bench"
    torque = ptp.inverse_dynamics(platform, motion, {"J_pan": 3.0})
    assert torque == pytest.approx(np.array([[3.0]]))


def test_linearised_at_rest_a_pendulum_has_its_textbook_poles(pendulum: ptp.Machine) -> None:
    """I s^2 + b s + m g l cos(q) = 0 about the angle at which a torque holds it."""
    inertia, angle = INERTIA + MASS * LENGTH**2, 0.6
    found = pendulum.linearize({"theta_tilt": angle}, p=VALUES)
    tilt = [1, 3]
    # The payload sits at x, forwards: tilting by +q about y lowers it, so that gravity acts with
    # m g l cos(q); its derivative by the angle is -m g l sin(q).
    stiffness = MASS * 9.81 * LENGTH * math.sin(angle)
    own = found.A[np.ix_(tilt, tilt)]
    assert own == pytest.approx(
        np.array([[0.0, 1.0], [-stiffness / inertia, -DAMPING / inertia]]), rel=1e-12
    )
    assert found.B[3] == pytest.approx([0.0, 1.0 / inertia], rel=1e-12)
    assert found.C.tolist() == [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]]
    assert found.rate[3] == pytest.approx(MASS * 9.81 * LENGTH * math.cos(angle) / inertia)


@pytest.mark.parametrize("name", ["payload", "tilt_drive"])
def test_jacobians_are_the_limits_of_central_differences(name: str) -> None:
    machine = ptp.load(name)
    rng = np.random.default_rng(4)
    x = np.array(machine.module.STATE_INITIAL) + rng.uniform(0.01, 0.05, len(machine.state_names))
    u, p = rng.uniform(0.1, 0.5, len(machine.input_names)), machine.parameter_vector()
    found = machine.jacobian(x, u)
    for matrix, at in ((found.x, 0), (found.u, 1)):
        for k in range(matrix.shape[1]):
            ends = []
            for step in (1e-6, -1e-6):
                point = [x.copy(), u.copy()]
                point[at][k] += step
                ends.append(machine.rhs(0.0, *point, p))
            slope = (ends[0] - ends[1]) / 2e-6
            assert matrix[:, k] == pytest.approx(slope, rel=1e-5, abs=1e-3)


def test_the_mass_matrix_is_that_of_the_thesis() -> None:
    """Eq. 3.8: J_pan + J_x sin^2 + J_z cos^2, and J_y."""
    angle = 0.7
    inertias = {"J_pan": 3.0, "J_x_tilt": 0.2, "J_y_tilt": 0.3, "J_z_tilt": 0.4}
    found = ptp.load("ideal").mass_matrix({"theta_tilt": angle}, inertias)
    pan = 3.0 + 0.2 * math.sin(angle) ** 2 + 0.4 * math.cos(angle) ** 2
    assert found == pytest.approx(np.diag([pan, 0.3]), rel=1e-14)


def test_mass_matrix_and_inverse_dynamics_agree_where_nothing_else_acts() -> None:
    machine = ptp.load("payload")
    q, a, x = [0.3, -0.8], [1.5, -2.0], [0.3, -0.8, 0.0, 0.0]
    torques = machine.inverse_dynamics(q, [0.0, 0.0], a)
    weight = machine.inverse_dynamics(q, [0.0, 0.0], [0.0, 0.0])
    assert torques - weight == pytest.approx(machine.mass_matrix(x) @ a, rel=1e-12)
    rate = machine.rhs(x, u=torques)
    assert rate[2:] == pytest.approx(a, rel=1e-12)


def test_a_state_by_name_in_order_and_with_units_is_the_same_state() -> None:
    machine = ptp.load("payload")
    old = machine.rhs(
        0.0, [0.1, math.radians(30.0), 0.2, 0.0], [0.5, 0.0], machine.parameter_vector()
    )
    for x in (
        {"theta_pan": 0.1, "theta_tilt": "30 deg", "omega_pan": 0.2},
        [0.1, "30 deg", 0.2, 0.0],
        np.array([0.1, math.radians(30.0), 0.2, 0.0]),
    ):
        assert machine.rhs(x, u={"tau_pan": "500 mN m"}) == pytest.approx(old, rel=1e-15)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda m: m.rhs({"theta_pen": 1.0}),
            "Unknown state 'theta_pen': did you mean 'theta_pan'",
        ),
        (lambda m: m.rhs([0.0, 1.0]), r"States have shape \(2,\); give \[4\]: theta_pan"),
        (
            lambda m: m.rhs([0.0] * 4, p={"J_pan": "3 m"}),
            "'J_pan' = '3 m': m does not fit its unit",
        ),
        (lambda m: m.rhs([0.0] * 4, u=[1.0]), r"Inputs have shape \(1,\); give \[2\]"),
        (lambda m: m.rhs({"theta_pan": "30 of them"}), "'of them' is not a unit"),
        (lambda m: m.rhs({"theta_pan": float("nan")}), "'theta_pan' = nan rad; give a finite"),
        (lambda m: m.linearize(modes={"slide_pan": 1}), "Unknown mode 'slide_pan'"),
        (lambda m: m.mass_matrix([0] * 4, {"J_pan": -1.0}), "'J_pan' = -1 kg m.2 lies outside"),
    ],
)
def test_what_does_not_fit_is_refused_in_one_line(call: object, message: str) -> None:
    with pytest.raises(ptp.InputError, match=message) as found:
        call(ptp.load("ideal"))  # type: ignore[operator]
    assert "\n" not in str(found.value)


def test_a_sticking_joint_is_linearised_as_it_slides_where_that_is_asked_for() -> None:
    machine = ptp.load("pan_drive")
    rest = machine.linearize()
    moving = machine.linearize(modes={"slide_pan": 1.0})
    at = machine.state_names.index("omega_gear_pan")
    assert rest.modes["slide_pan"] == 0.0
    assert np.all(rest.A[at] == 0.0)
    assert np.any(moving.A[at] != 0.0)


def test_python_control_finds_the_same_response() -> None:
    control = pytest.importorskip("control")
    machine = ptp.load("ideal")
    system = machine.linearize().to_control()
    t = np.linspace(0.0, 0.2, 21)
    linear = control.forced_response(system, t, np.vstack([1e-6 * np.ones_like(t), 0.0 * t]))
    run = machine.simulate(t, tau_pan=1e-6)
    assert run["theta_pan"] == pytest.approx(linear.outputs[0], rel=1e-5, abs=1e-15)
    assert list(system.state_labels) == list(machine.state_names)


def final_angle(machine: ptp.Machine) -> float:
    return float(machine.simulate(0.1, tau_tilt=0.2)["theta_tilt"][-1])


def test_a_machine_goes_to_another_process_and_its_run_comes_back(pendulum: ptp.Machine) -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        run = pool.submit(pendulum.simulate, 0.1, tau_tilt=0.2).result()
    assert isinstance(run, ptp.Run)
    assert run["theta_tilt"][-1] == final_angle(pendulum)
    assert run.model.platform == PENDULUM


@pytest.mark.parametrize("name", ["ideal", "pendulum"])
def test_copies_have_the_same_equations_and_numbers(name: str, pendulum: ptp.Machine) -> None:
    machine = pendulum if name == "pendulum" else ptp.load(name)
    for other in (copy.copy(machine), copy.deepcopy(machine), pickle.loads(pickle.dumps(machine))):
        assert other == machine
        assert hash(other) == hash(machine)
        assert other.platform == machine.platform
        assert other.defaults == machine.defaults


def test_a_pickle_whose_module_is_gone_derives_it_again(
    pendulum: ptp.Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pendulum.module, "__file__", "/nowhere/machine.py")
    data = pickle.dumps(pendulum)
    monkeypatch.undo()
    assert pickle.loads(data).state_names == pendulum.state_names


def test_a_pickle_of_other_equations_is_refused(
    pendulum: ptp.Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pendulum.module, "MODEL_HASH", "0123456789abcdef")
    data = pickle.dumps(replace(pendulum))
    monkeypatch.undo()
    with pytest.raises(ptp.InputError, match="'pendulum' has the equations 0123456789abcdef"):
        pickle.loads(data)


def test_it_is_read_as_tables_and_lists_nothing_private(pendulum: ptp.Machine) -> None:
    text, page = repr(pendulum), pendulum._repr_html_()
    for word in ("theta_tilt", "rad/s", "tau_pan", "N m", "J_y_tilt", "kg m^2", "payload mass"):
        assert word in text
        assert word in page
    assert page.count("<table>") == page.count("</table>") == 5
    for thing in (pendulum, pendulum.linearize(), pendulum.simulate(0.01), ptp):
        assert [n for n in dir(thing) if n.startswith("_") and not n.startswith("__")] == []


def test_markup_in_a_title_stays_text() -> None:
    machine = ptp.load(replace(PENDULUM, title="<script>alert(1)</script>"), catalogue_values=True)
    assert "<script>" not in machine._repr_html_()
