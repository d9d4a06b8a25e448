"""MJCF and URDF: MuJoCo reads both, and moves as the equations do."""

import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.models.emission import possible_equations
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform, read_platform
from ptp_symbolic.symbolic.program.program import program
from ptp_symbolic.symbolic.targets.multibody import Mjcf, Urdf
from tests.targets.accelerations import Accelerations

mujoco = pytest.importorskip("mujoco")

RIGID = {
    "J_pan": ("kg m^2", 0.05),
    "J_x_tilt": ("kg m^2", 0.012),
    "J_y_tilt": ("kg m^2", 0.017),
    "J_z_tilt": ("kg m^2", 0.014),
    "m_payload": ("kg", 4.992),
    "J_x_payload": ("kg m^2", 0.0053),
    "J_y_payload": ("kg m^2", 0.0068),
    "J_z_payload": ("kg m^2", 0.0061),
    "c_x_payload": ("m", 0.1),
    "c_y_payload": ("m", 0.03),
    "c_z_payload": ("m", -0.04),
    "b_pan": ("N m s/rad", 0.2),
    "b_tilt": ("N m s/rad", 0.3),
    "k1_cable_pan": ("N m/rad", 0.8),
    "theta0_cable_pan": ("rad", 0.2),
    "beta_base": ("rad", 0.07),
    "alpha_base": ("rad", 0.9),
    "J_xy_tilt": ("kg m^2", 0.001),
    "J_xz_tilt": ("kg m^2", -0.0007),
    "J_yz_tilt": ("kg m^2", 0.0004),
}


def camera(*more: str) -> Platform:
    """A pan-tilt camera that leans, on a cable."""
    names = ["rigid_bodies", "payload", *more]
    effects = [EffectDeclaration(n, None, None) for n in names]
    effects += [EffectDeclaration("viscous_friction", axis, None) for axis in ("pan", "tilt")]
    effects += [EffectDeclaration("cable_spring", "pan", None)]
    bare = Platform("camera", "Camera", ("pan", "tilt"), 9.81, tuple(effects), (), ())
    own = {p.name for p in possible_equations(bare).parameters}
    values = tuple(
        ParameterDeclaration(name, unit, value)
        for name, (unit, value) in RIGID.items()
        if name in own
    )
    return replace(bare, parameters=values)


def exported(target: Mjcf | Urdf, platform: Platform) -> str:
    (text,) = target.files(program(possible_equations(platform)), "machine").values()
    return text


@pytest.mark.parametrize(
    "more", [(), ("base_tilt",), ("base_tilt", "product_of_inertia")], ids="+".join
)
def test_mujoco_accelerates_as_the_equations_do(more: tuple[str, ...]) -> None:
    platform = camera(*more)
    machine = Accelerations(platform)
    model = mujoco.MjModel.from_xml_string(exported(Mjcf(), platform))
    data, rng, worst = mujoco.MjData(model), np.random.default_rng(3), 0.0
    for _ in range(50):
        x, u = rng.normal(0.0, 0.8, 4), rng.normal(0.0, 2.0, 2)
        data.qpos[:], data.qvel[:], data.ctrl[:] = x[:2], x[2:], u
        mujoco.mj_forward(model, data)
        ours = machine(x, u)
        worst = max(worst, float(np.max(np.abs(data.qacc - ours) / (1.0 + np.abs(ours)))))
    assert worst < 1e-12


def test_mujoco_reads_the_urdf_and_accelerates_alike() -> None:
    platform = camera("product_of_inertia")
    effects = tuple(e for e in platform.effects if e.effect != "cable_spring")
    values = tuple(p for p in platform.parameters if "cable" not in p.name)
    platform = replace(platform, effects=effects, parameters=values)
    assert Urdf().remarks(program(possible_equations(platform))) == []
    text = exported(Urdf(), platform)
    model = mujoco.MjModel.from_xml_string(re.sub(r"<!--.*?-->", "", text, flags=re.S))
    data, rng, machine = mujoco.MjData(model), np.random.default_rng(4), Accelerations(platform)
    for _ in range(20):
        x, u = rng.normal(0.0, 0.8, 4), rng.normal(0.0, 2.0, 2)
        data.qpos[:], data.qvel[:], data.qfrc_applied[:] = x[:2], x[2:], u
        mujoco.mj_forward(model, data)
        assert np.allclose(data.qacc, machine(x, u), rtol=1e-9, atol=1e-9)


def test_a_motor_is_the_armature_of_its_joint_and_what_is_lost_is_said() -> None:
    whole = program(possible_equations(read_platform("thesis-pan-drive")))
    (text,) = Mjcf().files(whole, "drive").values()
    values = {p.name: p.default for p in whole.equations.parameters}
    (joint,) = ET.fromstring(text).iter("joint")
    armature = values["N_pan"] ** 2 * values["J_motor_pan"]
    assert float(joint.get("armature", "")) == pytest.approx(armature, rel=1e-15)
    lost = "\n".join(Mjcf().remarks(whole))
    for effect in ("backlash@pan", "shaft_compliance@pan", "dc_motor@pan", "csvs_friction@pan"):
        assert effect in lost and effect in text
    mujoco.MjModel.from_xml_string(text)


def test_a_rotor_behind_a_linkage_is_lost_and_said() -> None:
    """Its ratio changes with the angle: N^2 J_motor would be no inertia of the joint."""
    whole = program(possible_equations(read_platform("thesis-tilt-drive")))
    (text,) = Mjcf().files(whole, "drive").values()
    (joint,) = ET.fromstring(text).iter("joint")
    assert float(joint.get("armature", "")) == 0.0
    assert any("rotor on tilt" in remark for remark in Mjcf().remarks(whole))


def test_friction_of_bristles_is_no_friction_loss() -> None:
    """LuGre friction has a parameter F_c too, and is lost whole."""
    names = ("rigid_bodies", "dc_motor", "lugre_friction")
    effects = tuple(
        EffectDeclaration(n, None if n == "rigid_bodies" else "pan", None) for n in names
    )
    whole = program(possible_equations(Platform("drive", "", ("pan",), 9.81, effects, (), ())))
    (text,) = Mjcf().files(whole, "drive").values()
    (joint,) = ET.fromstring(text).iter("joint")
    assert float(joint.get("frictionloss", "")) == 0.0
    assert any("lugre_friction@pan: all of it" in remark for remark in Mjcf().remarks(whole))
