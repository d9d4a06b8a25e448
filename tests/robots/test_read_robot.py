"""Robots of other tools as platforms: they accelerate as MuJoCo says, or are refused by line."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.models.emission import possible_equations
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform, read_platform
from ptp_symbolic.symbolic.program.program import program
from ptp_symbolic.symbolic.targets.multibody import Mjcf, Urdf
from tests.robots.texts import HEAD, TURRET, UPSIDE_DOWN
from tests.targets.accelerations import Accelerations


def written(folder: Path, text: str) -> Path:
    """A file with the text, named by what it is."""
    file = folder / ("robot.urdf" if "<robot" in text else "model.xml")
    file.write_text(text, encoding="utf-8")
    return file


def off_mujoco(
    text: str, platform: Platform, joints: tuple[str, ...], signs: tuple[float, ...] = (1.0, 1.0)
) -> float:
    """Largest difference of accelerations, relative above 1 rad/s^2, at 30 random states."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(re.sub(r"<!--.*?-->", "", text, flags=re.S))
    data, rng, ours, worst = mujoco.MjData(model), np.random.default_rng(7), None, 0.0
    ours = Accelerations(platform)
    at, sign = [model.joint(j).id for j in joints], np.array(signs[: len(joints)])
    for _ in range(30):
        q, w, u = rng.normal(0.0, [[0.9], [0.9], [2.0]], (3, len(joints)))
        data.qpos[:] = model.qpos0
        data.qpos[at] = model.qpos0[at] + sign * q
        data.qvel[at], data.qfrc_applied[at] = sign * w, sign * u
        mujoco.mj_forward(model, data)
        found = ours(np.concatenate([q, w]), u)
        off = np.abs(found - sign * data.qacc[at]) / (1.0 + np.abs(found))
        worst = max(worst, float(np.max(off)))
    return worst


def test_a_turret_of_six_links_accelerates_as_in_mujoco(tmp_path: Path) -> None:
    """Inertial frames and fixed joints are rotated, and the axes do not cross."""
    imported = ptp.read_robot(written(tmp_path, TURRET), pan="yaw", tilt="pitch")
    assert {"axis_offset", "product_of_inertia"} <= {e.effect for e in imported.platform.effects}
    assert off_mujoco(TURRET, imported.platform, ("yaw", "pitch")) < 1e-10


def test_a_leaning_head_with_masses_of_shapes_accelerates_as_in_mujoco(tmp_path: Path) -> None:
    imported = ptp.read_robot(written(tmp_path, HEAD), pan="pan", tilt="tilt")
    assert {"base_tilt", "pan_com_offset"} <= {e.effect for e in imported.platform.effects}
    assert off_mujoco(HEAD, imported.platform, ("pan", "tilt")) < 1e-10
    assert [line.partition(",")[0] for line in imported.lost] == [
        "gear 20 of motor 'turn'",
        "<general> 'nod'",
        "'pan': ref: theta is 0.0872665 rad less than the angle of the file",
    ]


def test_two_joints_of_one_body_and_a_pan_axis_that_points_down(tmp_path: Path) -> None:
    """Joints that carry nothing of the chain do not matter; those in it are frozen."""
    file = written(tmp_path, UPSIDE_DOWN)
    imported = ptp.read_robot(file, pan="pan", tilt="tilt", freeze=("up", "swing"))
    held = UPSIDE_DOWN
    for name in ("up", "swing", "roll"):
        held = re.sub(rf'<joint name="{name}"[^>]*/>', "", held)
    held = held.replace('range="-20 30"', "")
    assert off_mujoco(held, imported.platform, ("pan", "tilt"), (-1.0, 1.0)) < 1e-10
    assert any("theta_pan is minus the angle of 'pan'" in note for note in imported.notes)
    own = {p.name: p.value for p in imported.platform.parameters}
    assert (own["theta_stop_lower_pan"], own["theta_stop_upper_pan"]) == (-30.0, 20.0)
    assert own["theta0_cable_pan"] == -0.3


@pytest.mark.parametrize(("axis", "joint"), [("pan", "yaw"), ("tilt", "pitch")])
def test_one_axis_alone(axis: str, joint: str, tmp_path: Path) -> None:
    other = {"yaw": "pitch", "pitch": "yaw"}[joint]
    file = written(tmp_path, TURRET)
    named = {axis: joint}
    imported = ptp.read_robot(file, **named, freeze=(other,))
    assert imported.platform.axes == (axis,)
    held = re.sub(rf'name="{other}" type="\w+"', f'name="{other}" type="fixed"', TURRET)
    assert off_mujoco(held, imported.platform, (joint,)) < 1e-10


def test_an_axis_that_stands_upright_tilts_where_nothing_pulls(tmp_path: Path) -> None:
    """Without gravity no axis is vertical: a tilt axis alone may point anywhere."""
    text = f"<mujoco>{UPSIDE_DOWN.partition('<mujoco>')[2]}".replace('range="-20 30"', "")
    text = text.replace("<worldbody>", '<option gravity="0 0 0"/><worldbody>')
    frozen = ("up", "swing", "tilt")
    imported = ptp.read_robot(written(tmp_path, text), tilt="pan", freeze=frozen)
    for name in (*frozen, "roll"):
        text = re.sub(rf'<joint name="{name}"[^>]*/>', "", text)
    assert off_mujoco(text, imported.platform, ("pan",)) < 1e-10


RIGID = {
    "J_pan": 0.05,
    "J_x_tilt": 0.012,
    "J_y_tilt": 0.017,
    "J_z_tilt": 0.014,
    "J_xy_tilt": 0.001,
    "J_xz_tilt": -0.0007,
    "J_yz_tilt": 0.0004,
    "m_payload": 4.992,
    "J_x_payload": 0.0053,
    "J_y_payload": 0.0068,
    "J_z_payload": 0.0061,
    "c_x_payload": 0.1,
    "c_y_payload": 0.03,
    "c_z_payload": -0.04,
    "a_tilt": -0.03,
    "m_tilt": 0.9,
    "b_pan": 0.2,
    "b_tilt": 0.3,
    "k1_cable_pan": 0.8,
    "theta0_cable_pan": 0.2,
    "beta_base": 0.07,
    "alpha_base": 0.9,
    "m_pan_body": 2.0,
    "c_x_pan": 0.02,
    "c_y_pan": -0.01,
}
EVERYWHERE = ("rigid_bodies", "product_of_inertia", "payload", "axis_offset")
LEANS = ("base_tilt", "pan_com_offset")


def machine(effects: tuple[str, ...], on_axes: tuple[tuple[str, str], ...]) -> Platform:
    """A platform with effects of the whole and of axes, and the values above."""
    declared = [EffectDeclaration(e, None, None) for e in effects]
    declared += [EffectDeclaration(e, axis, None) for e, axis in on_axes]
    bare = Platform("camera", "Camera", ("pan", "tilt"), 9.7, tuple(declared), (), ())
    own = {p.name for p in possible_equations(bare).parameters}
    values = (ParameterDeclaration(n, None, v) for n, v in RIGID.items() if n in own)
    return replace(bare, parameters=tuple(values))


FRICTION = (("viscous_friction", "pan"), ("viscous_friction", "tilt"))


@pytest.mark.parametrize(
    ("target", "platform"),
    [
        (Mjcf(), machine((*EVERYWHERE, *LEANS), (*FRICTION, ("cable_spring", "pan")))),
        (Urdf(), replace(machine(EVERYWHERE, FRICTION), gravity=9.81)),
    ],
    ids=lambda given: getattr(given, "name", ""),
)
def test_exported_and_read_back_it_is_the_same_machine(
    target: Mjcf | Urdf, platform: Platform, tmp_path: Path
) -> None:
    (text,) = target.files(program(possible_equations(platform)), "camera").values()
    again = ptp.read_robot(written(tmp_path, text), pan="pan", tilt="tilt")
    assert again.lost == ()
    before, after = Accelerations(platform), Accelerations(again.platform)
    rng = np.random.default_rng(3)
    for _ in range(30):
        x, u = rng.normal(0.0, 0.8, 4), rng.normal(0.0, 2.0, 2)
        expected = before(x, u)
        assert np.max(np.abs(after(x, u) - expected) / (1.0 + np.abs(expected))) < 1e-12


def test_a_platform_without_a_mass_on_its_tilt_axis_is_written_as_it_is(tmp_path: Path) -> None:
    """What is read has all of its tilting mass in the payload, and axes that do not cross."""
    imported = ptp.read_robot(written(tmp_path, TURRET), pan="yaw", tilt="pitch")
    whole = program(possible_equations(imported.platform))
    (text,) = Mjcf().files(whole, "turret").values()
    assert off_mujoco(text, imported.platform, ("pan", "tilt")) < 1e-10


def test_the_rotor_of_a_motor_is_inertia_of_the_axis(tmp_path: Path) -> None:
    whole = program(possible_equations(read_platform("thesis-pan-drive")))
    (text,) = Mjcf().files(whole, "drive").values()
    imported = ptp.read_robot(written(tmp_path, text), pan="pan")
    own = {p.name: p.default for p in whole.equations.parameters}
    read = {p.name: p.value for p in imported.platform.parameters}
    assert read["J_pan"] == pytest.approx(
        own["J_pan"] + own["N_pan"] ** 2 * own["J_motor_pan"], rel=1e-14
    )
    assert read["F_c_pan"] == read["F_s_pan"] == own["F_c_pan"]
    assert read["b_pan"] == own["F_v_pan"] + own["b_pan"]


def test_right_angles_of_few_digits_are_right_angles_and_said(tmp_path: Path) -> None:
    text = TURRET.replace('<axis xyz="0 -1 0"/>', '<axis xyz="0 0 -1"/>')
    text = text.replace('rpy="0 0 -0.35"', 'rpy="-1.5708 0 -0.35"')
    imported = ptp.read_robot(written(tmp_path, text), pan="yaw", tilt="pitch")
    (said,) = [note for note in imported.notes if "right angle" in note]
    assert "'pitch' and the pan axis" in said
    assert off_mujoco(text, imported.platform, ("yaw", "pitch")) < 1e-3


WRONG = [
    ('xyz="0 -1 0"', 'xyz="0 -1 0.5"', r"urdf:28: <joint>: .*'pitch'.*63.43 deg"),
    ('xyz="0 0 2"', 'xyz="1 0 0"', r"urdf:10: <joint>: .*'yaw' leans by 90 deg"),
    ('"pitch" type="revolute"', '"pitch" type="prismatic"', r"urdf:28: .*is prismatic; the joints"),
    (
        '"camera_mount" type="fixed"',
        '"camera_mount" type="continuous"',
        r"urdf:39: .*'camera_mount' turns too.*--freeze",
    ),
    ('"mount" type="fixed"', '"mount" type="floating"', r"urdf:5: .*'mount' is floating too"),
    ('<child link="camera"/>', '<child link="lens"/>', r"urdf:39: .*child 'lens' is no link"),
    (
        '<child link="pedestal"/>',
        '<child link="yoke"/>',
        r"urdf:10: .*a second joint before 'yoke'",
    ),
    ('<mass value="2.4"/>', '<mass value="-2.4"/>', r"urdf:44: <mass>: value = -2.4 is negative"),
    ('<mass value="2.4"/>', '<mass value="2,4"/>', r"urdf:44: .*'2,4' is not a finite number"),
    ('<mass value="2.4"/>', '<mass value="nan"/>', r"urdf:44: .*'nan' is not a finite number"),
    ('iyz="-0.0006" izz="0.007"', 'iyz="-0.6" izz="0.007"', r"urdf:45: .*none may be negative"),
    ('xyz="0 0 2"', 'xyz="0 0 0"', r"urdf:12: <axis>: xyz = \[0.0, 0.0, 0.0\] has no direction"),
    (
        '<link name="pedestal"/>',
        '<link name="pedestal"/><link name="camera"/>',
        r"urdf:43: .*a second link 'camera'",
    ),
    (
        '<link name="pedestal"/>',
        "<xacro:include/>",
        r"urdf:9: <xacro:include>: is xacro; write the URDF",
    ),
    ("</robot>", "", r"urdf:\d+: is not XML: "),
    (
        '<?xml version="1.0"?>',
        '<!DOCTYPE r [<!ENTITY a "b">]>',
        r"urdf: has a document type or entities",
    ),
]


@pytest.mark.parametrize(("of", "into", "message"), WRONG, ids=[w[1][:40] for w in WRONG])
def test_a_robot_that_is_no_platform_is_refused_by_line(
    of: str, into: str, message: str, tmp_path: Path
) -> None:
    assert of in TURRET
    file = written(tmp_path, TURRET.replace(of, into))
    with pytest.raises(ptp.InputError, match=message):
        ptp.read_robot(file, pan="yaw", tilt="pitch")


WRONG_HEADS = [
    (
        '<geom type="sphere" size="0.04"',
        '<geom type="mesh" mesh="a"',
        r"xml:25: .*of a 'mesh' is not known; let MuJoCo",
    ),
    ('class="servo" ref', 'class="motor" ref', r"xml:17: .*class 'motor' is not defined"),
    (
        'euler="-30 0 0"',
        'euler="-30 0 0" quat="1 0 0 0"',
        r"xml:29: .*has quat and euler; give one",
    ),
    (
        "<actuator>",
        '<include file="a.xml"/><actuator>',
        r"xml:40: <include>: is not read; let MuJoCo",
    ),
    ('eulerseq="ZYX"', 'settotalmass="3"', r"xml:2: <compiler>: settotalmass changes masses"),
    ('name="arm"', 'name="head"', r"xml:29: <body>: a second body 'head'"),
    (
        '<joint name="tilt" axis="0 1 0"/>',
        '<joint name="tilt" type="ball"/>',
        r"xml:30: .*is ball; the joints",
    ),
    ('stiffness="2.5"', 'armature="5"', r"xml:30: .*its armature, 5 kg m\^2, is more than"),
    ('"pan" class', '"tilt" class', r"xml:30: .*a second joint 'tilt'; rename one"),
]


@pytest.mark.parametrize(
    ("of", "into", "message"),
    WRONG_HEADS,
    ids=[w[1][:40] for w in WRONG_HEADS],
)
def test_a_model_that_is_no_platform_is_refused_by_line(
    of: str, into: str, message: str, tmp_path: Path
) -> None:
    assert of in HEAD
    with pytest.raises(ptp.InputError, match=message):
        ptp.read_robot(written(tmp_path, HEAD.replace(of, into)), pan="pan", tilt="tilt")


def test_joints_that_are_not_there_or_not_in_this_order(tmp_path: Path) -> None:
    file = written(tmp_path, TURRET)
    with pytest.raises(ptp.InputError, match="Unknown pan joint 'yav': did you mean 'yaw'"):
        ptp.read_robot(file, pan="yav", tilt="pitch")
    with pytest.raises(ptp.InputError, match=r"urdf:10: .*'yaw' is not carried by pan joint"):
        ptp.read_robot(file, pan="pitch", tilt="yaw")
    with pytest.raises(ptp.InputError, match="Unknown joint to freeze 'box_mount'"):
        ptp.read_robot(file, pan="yaw", tilt="pitch", freeze=("box_mount",))
    with pytest.raises(ptp.InputError, match="'yaw' is the pan axis; do not freeze it"):
        ptp.read_robot(file, pan="yaw", tilt="pitch", freeze=("yaw",))
    with pytest.raises(ptp.InputError, match="they are two joints"):
        ptp.read_robot(file)
