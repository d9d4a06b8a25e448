"""Random models in all of MJCF's ways to say where things are: as MuJoCo compiles them."""

from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic as ptp
from tests.robots.test_read_robot import off_mujoco

SIZES = {"sphere": 1, "capsule": 2, "cylinder": 2, "box": 3, "ellipsoid": 3}


class Drawn:
    """Pieces of a random model, angles in degrees or radians."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)
        self.degrees = bool(self.random.random() < 0.5)
        self.turn = 180.0 / np.pi if self.degrees else 1.0

    def normal(self, count: int, size: float = 1.0) -> str:
        return " ".join(f"{v:.5g}" for v in self.random.normal(0.0, size, count))

    def uniform(self, count: int, low: float, high: float) -> str:
        return " ".join(f"{v:.5g}" for v in self.random.uniform(low, high, count))

    def orientation(self) -> str:
        ways = [
            "",
            f'quat="{self.normal(4)}"',
            f'axisangle="{self.normal(3)} {self.normal(1, self.turn)}"',
            f'euler="{self.normal(3, self.turn)}"',
            f'xyaxes="{self.normal(6)}"',
            f'zaxis="{self.normal(3)}"',
        ]
        return str(self.random.choice(ways))

    def geom(self) -> str:
        kind = str(self.random.choice(list(SIZES)))
        size = self.uniform(SIZES[kind], 0.02, 0.1)
        mass = self.random.choice(["", 'mass="0.7"', 'density="2000"', 'mass="0"'])
        if kind != "sphere" and self.random.random() < 0.4:
            ends = f'size="{size.split()[0]}" fromto="{self.normal(6, 0.1)}"'
            return f'<geom type="{kind}" {ends} {mass}/>'
        where = f'pos="{self.normal(3, 0.1)}" {self.orientation()}'
        return f'<geom type="{kind}" size="{size}" {where} {mass}/>'

    def inertial(self) -> str:
        given = f'mass="{self.uniform(1, 0.2, 3.0)}" pos="{self.normal(3, 0.1)}"'
        diagonal = self.uniform(3, 0.010, 0.015)
        if self.random.random() < 0.5:
            return f'<inertial {given} {self.orientation()} diaginertia="{diagonal}"/>'
        return f'<inertial {given} fullinertia="{diagonal} {self.uniform(3, -0.001, 0.001)}"/>'

    def fixed(self, depth: int = 0) -> str:
        own = self.inertial() if self.random.random() < 0.4 else self.geom() + self.geom()
        more = self.fixed(depth + 1) if depth < 2 and self.random.random() < 0.5 else ""
        return f'<body pos="{self.normal(3, 0.1)}" {self.orientation()}>{own}{more}</body>'

    def model(self) -> str:
        letters = self.random.choice(list(self.random.choice(["xyz", "XYZ"])), 3)
        angle = "degree" if self.degrees else "radian"
        from_geoms = self.random.choice(["auto", "true"])
        up = self.random.choice(["0 0 1", "0 0 -1"])
        armature = self.random.choice([0.0, 0.01, 0.05])
        spring = f'stiffness="{self.uniform(1, 0.0, 1.0)}" springref="0.3"'
        return f"""<mujoco>
<compiler angle="{angle}" eulerseq="{"".join(letters)}" inertiafromgeom="{from_geoms}"/>
<option gravity="{self.normal(2, 0.5)} -9.81"><flag contact="disable"/></option>
<default><joint damping="{self.uniform(1, 0.0, 0.5)}" armature="{armature}"/>
<geom density="{self.uniform(1, 300.0, 900.0)}"/></default>
<worldbody><body pos="1 2 3">{self.geom()}
<body><joint name="pan" axis="{up}" pos="0.1 0 0"/>{self.inertial()}{self.geom()}{self.fixed()}
<body pos="{self.normal(2, 0.1)} 0.3">
<joint name="tilt" axis="{self.normal(2)} 0" pos="0.02 0.03 0.01" {spring} ref="0.2"/>
{self.inertial()}{self.geom()}{self.fixed()}</body></body></body></worldbody></mujoco>"""


@pytest.mark.long
@pytest.mark.parametrize("seed", range(1, 11))
def test_random_models_accelerate_as_in_mujoco(seed: int, tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    text = Drawn(seed).model()
    try:
        mujoco.MjModel.from_xml_string(text)
    except ValueError as refused:
        pytest.skip(f"MuJoCo refuses it: {refused}")
    file = tmp_path / "model.xml"
    file.write_text(text)
    imported = ptp.read_robot(file, pan="pan", tilt="tilt")
    down = any("theta_pan is minus" in note for note in imported.notes)
    signs = (-1.0 if down else 1.0, 1.0)
    assert off_mujoco(text, imported.platform, ("pan", "tilt"), signs) < 1e-10
