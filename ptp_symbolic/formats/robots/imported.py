"""The platform of a robot that another tool describes, and its file."""

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ptp_symbolic.errors import InputError, path_of
from ptp_symbolic.formats.robots.axes import Carried, Seen, seen
from ptp_symbolic.formats.robots.mjcf import read_mjcf
from ptp_symbolic.formats.robots.robot import Robot, about
from ptp_symbolic.formats.robots.urdf import read_urdf
from ptp_symbolic.formats.robots.xml_file import FloatArray, read_xml
from ptp_symbolic.formats.starting_file import SCHEMA_NAME
from ptp_symbolic.models.emission import possible_equations
from ptp_symbolic.platform import (
    AXES,
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    SignalDeclaration,
    platform_text,
)
from ptp_symbolic.platform.fields import shown

LEAST_INERTIA = 1e-12  # kg m^2; the lower bound of a body's inertia in a platform
LEVEL = 1e-9  # rad; a base that leans by less is level
NO_PRODUCT = 1e-13  # of the largest inertia; what rounding leaves of a product that is zero
STRIBECK_SPEED = 0.016  # rad/s; no influence where static friction is Coulomb friction
STIFFNESS_OF_STOPS = 1e3  # N m/rad; the default of end_stop: the files do not say it
DAMPING_OF_STOPS = 0.3  # s/rad; likewise
READERS = {"robot": read_urdf, "mujoco": read_mjcf}


@dataclass(frozen=True)
class ImportedPlatform:
    """A platform that stands for a robot of another tool.

    `notes` say where each number comes from, `lost` what the platform does not have.
    """

    platform: Platform
    file: Path
    notes: tuple[str, ...]
    lost: tuple[str, ...]

    @property
    def text(self) -> str:
        """The platform as TOML, with the notes and what is lost as comments at its head."""
        lines = [f"A platform of ptp-symbolic, from {shown(self.file.name)}.", *self.notes]
        lines += ["Not in this file:", *(f"  {line}" for line in self.lost)] if self.lost else []
        plain = ("".join(c if c.isprintable() else "?" for c in line) for line in lines)
        head = [f"#:schema {SCHEMA_NAME}", *(f"# {line}" for line in plain), ""]
        return "\n".join(head) + "\n" + platform_text(self.platform)


def read_robot(
    file: str | Path,
    pan: str | None = None,
    tilt: str | None = None,
    freeze: Collection[str] = (),
    name: str | None = None,
) -> ImportedPlatform:
    """The pan-tilt platform in a URDF or MJCF file: masses and inertias lumped onto two bodies.

    `pan` and `tilt` name the joints of the axes, one or both; `freeze` names joints that are held
    as drawn. The platform, called `name` ("robot" if not given), is driven by torques; joints have
    viscous and Coulomb friction, a spring, stops and the inertia of a rotor where the file says so.
    Raises InputError, with the line of the file, for what a platform cannot be.

    >>> import ptp_symbolic as ptp
    >>> imported = ptp.read_robot("turret.urdf", pan="yaw", tilt="pitch")  # doctest: +SKIP
    >>> machine = ptp.load(imported.platform)  # doctest: +SKIP
    """
    path = path_of(file, "A robot", "the path of a URDF or MJCF file")
    named = {axis: joint for axis, joint in (("pan", pan), ("tilt", tilt)) if joint is not None}
    if not named or pan == tilt:
        raise InputError(
            f"{path}: name the joint of the pan axis with `pan`, that of the tilt axis with `tilt`,"
            " or both; they are two joints."
        )
    root = read_xml(path)
    if root.tag not in READERS:
        raise root.refused("is neither <robot> (URDF) nor <mujoco> (MJCF); give such a file.")
    robot = READERS[root.tag](root)
    try:
        found = seen(robot, named, freeze)
    except InputError as wrong:
        message = str(wrong)
        raise InputError(
            message if message.startswith(str(path)) else f"{path}: {message}"
        ) from wrong
    return _Import(robot, found, path, name or "robot").platform()


class _Import:
    """A platform while it is made: effects, parameters, notes, what is lost."""

    def __init__(self, robot: Robot, found: Seen, path: Path, name: str) -> None:
        self.robot, self.found, self.path, self.name = robot, found, path, name
        self.axes = tuple(axis for axis in AXES if axis in found.axes)
        self.effects: list[EffectDeclaration] = []
        self.values: dict[str, tuple[float, str]] = {}
        self.notes: list[str] = []
        self.lost: list[str] = list(robot.lost)

    def platform(self) -> ImportedPlatform:
        """The whole; raises InputError where no machine has these numbers."""
        for axis in self.axes:
            self._describe(axis, self.found.axes[axis])
        self._orientation()
        self._bodies()
        for axis in self.axes:
            self._joint(axis, self.found.axes[axis])
        made = Platform(
            self.name,
            f"{shown(self.robot.name)} from {shown(self.path.name)}",
            self.axes,
            float(np.linalg.norm(self.found.gravity)),
            tuple(self.effects),
            tuple(ParameterDeclaration(n, u, v) for n, (v, u) in self.values.items()),
            tuple(self._signals()),
        )
        try:
            possible_equations(made)
        except InputError as wrong:
            raise InputError(
                f"{self.path}: lumped onto its axes it is no machine: {wrong} Correct the masses"
                " and inertias of the links."
            ) from wrong
        return ImportedPlatform(made, self.path, tuple(self.notes), tuple(self.lost))

    def declare(
        self, effect: str, values: Mapping[str, tuple[float, str]], axis: str | None = None
    ) -> None:
        """Declare an effect and its values, in SI units."""
        self.effects.append(EffectDeclaration(effect, axis, None))
        self.values |= {name: (float(value), unit) for name, (value, unit) in values.items()}

    def _describe(self, axis: str, own: Carried) -> None:
        links = ", ".join(map(shown, own.links))
        self.notes.append(
            f"{axis}: joint {shown(own.joint.name)} (line {own.joint.element.line}) carries"
            f" {own.body.mass:.9g} kg, centre of mass {_vector(own.body.com)} m: {links}"
        )

    def _orientation(self) -> None:
        x = self.found.frame[:, 0]
        self.notes.append(
            f"At zero angles the boresight (x) is {_vector(x)} in the base of the file."
        )
        self.notes += self.found.notes

    def _bodies(self) -> None:
        """Pan body about its axis; all that tilts as a point mass at its centre of mass, and its
        whole inertia as that of the tilt body.
        """
        has_pan, has_tilt = ("pan" in self.axes, "tilt" in self.axes)
        armature = {axis: own.joint.armature for axis, own in self.found.axes.items()}
        lean, azimuth = _lean(self.found.gravity)
        inertias: dict[str, float] = {}
        if has_pan:
            body = self.found.axes["pan"].body
            own = body.inertia[2, 2] + armature["pan"]
            if lean == 0.0 or not body.mass:
                own += about(body.mass, body.com)[2, 2]
            inertias["J_pan"] = float(own)
        products: dict[str, float] = {}
        if has_tilt:
            tensor = self.found.axes["tilt"].body.inertia.copy()
            tensor[1, 1] += armature["tilt"]
            if has_pan:
                self._make_room(tensor, inertias)
                inertias |= {f"J_{k}_tilt": tensor[i, i] for i, k in enumerate("xyz")}
                products = _products(tensor)
            else:
                inertias["J_y_tilt"] = float(tensor[1, 1])
        self._note_inertias(armature, inertias)
        kept = {n: (max(v, LEAST_INERTIA), "kg m^2") for n, v in inertias.items()}
        self.declare("rigid_bodies", kept)
        if products:
            self.declare("product_of_inertia", {n: (v, "kg m^2") for n, v in products.items()})
        if has_tilt:
            self._tilting_mass(has_pan)
        if has_pan and lean:
            self._leaning(lean, azimuth)

    def _note_inertias(self, armature: Mapping[str, float], inertias: Mapping[str, float]) -> None:
        for axis, inertia in armature.items():
            if inertia:
                into = "J_pan" if axis == "pan" else "J_y_tilt"
                self.notes.append(
                    f"{into} has the armature of the {axis} joint, {inertia:.9g} kg m^2."
                )
        for name, value in inertias.items():
            if value < LEAST_INERTIA:
                self.notes.append(f"{name} is {value:.3g} kg m^2 in the file, less than it may be.")

    def _make_room(self, tensor: FloatArray, inertias: dict[str, float]) -> None:
        """Move inertia from the pan body to the tilt body, about x and z alike, as far as a rotor
        about y needs it for a tensor that can exist. On a base at rest the equations are the same.
        """
        low, middle, high = np.linalg.eigvalsh(tensor)
        lacking = high - low - middle
        if lacking <= 0.0 or not self.found.axes["tilt"].joint.armature:
            return
        moved = lacking / 2.0 * (1.0 + 1e-9)
        while np.linalg.eigvalsh(tensor + np.diag([moved, 0.0, moved])) @ [-1.0, -1.0, 1.0] > 0.0:
            moved *= 1.25
        if moved > inertias["J_pan"] - LEAST_INERTIA:
            element = self.found.axes["tilt"].joint.element
            raise element.refused(
                f"its armature, {self.found.axes['tilt'].joint.armature:.9g} kg m^2, is more than"
                " bodies of these inertias can stand for; remove it, and declare the motor in the"
                " platform (dc_motor)."
            )
        tensor += np.diag([moved, 0.0, moved])
        inertias["J_pan"] -= moved
        self.notes.append(
            f"J_x_tilt and J_z_tilt are {moved:.9g} kg m^2 more and J_pan is as much less than in"
            " the file, for a tilt body with the rotor to exist; the equations are the same."
        )

    def _tilting_mass(self, has_pan: bool) -> None:
        body = self.found.axes["tilt"].body
        if not body.mass:
            return
        across = "xyz" if has_pan else "xz"
        point = {f"c_{k}_payload": (body.com["xyz".index(k)], "m") for k in across}
        about_itself = {f"J_{k}_payload": (0.0, "kg m^2") for k in ("xyz" if has_pan else "y")}
        self.declare("payload", {"m_payload": (body.mass, "kg"), **about_itself, **point})
        self.notes.append(
            "m_payload, c_*_payload: the mass of all that tilts, at its centre of mass; J_*_tilt:"
            " its inertia about it."
        )
        if has_pan and self.found.ahead:
            offset = {"a_tilt": (self.found.ahead, "m"), "m_tilt": (0.0, "kg")}
            self.declare("axis_offset", offset)

    def _leaning(self, lean: float, azimuth: float) -> None:
        body = self.found.axes["pan"].body
        if body.mass:
            com = {f"c_{k}_pan": (body.com[i], "m") for i, k in enumerate("xy")}
            self.declare("pan_com_offset", {"m_pan_body": (body.mass, "kg"), **com})
        self.declare("base_tilt", {"beta_base": (lean, "rad"), "alpha_base": (azimuth, "rad")})

    def _joint(self, axis: str, own: Carried) -> None:
        """Friction, spring and stops of a joint."""
        joint, sign = own.joint, own.sign
        if joint.damping:
            self.declare("viscous_friction", {f"b_{axis}": (joint.damping, "N m s/rad")}, axis)
        if joint.friction:
            coulomb = {
                f"F_c_{axis}": (joint.friction, "N m"),
                f"F_s_{axis}": (joint.friction, "N m"),
                f"v_s_{axis}": (STRIBECK_SPEED, "rad/s"),
                f"F_v_{axis}": (0.0, "N m s/rad"),
            }
            self.declare("csvs_friction", coulomb, axis)
            self.notes.append(f"v_s_{axis} has no influence: static friction is Coulomb friction.")
        if joint.stiffness:
            spring = {
                f"k1_cable_{axis}": (joint.stiffness, "N m/rad"),
                f"k3_cable_{axis}": (0.0, "N m/rad^3"),
                f"theta0_cable_{axis}": (sign * joint.rest, "rad"),
            }
            self.declare("cable_spring", spring, axis)
        if joint.limits is not None:
            self._stops(axis, sign, *joint.limits)
        self.lost += [f"{shown(joint.name)}: {line}" for line in joint.lost]

    def _stops(self, axis: str, sign: float, low: float, high: float) -> None:
        if not low < high:
            self.lost.append(f"limits of the {axis} joint, {low:g} to {high:g} rad: no way between")
            return
        low, high = sorted((sign * low, sign * high))
        stops = {
            f"theta_stop_upper_{axis}": (high, "rad"),
            f"theta_stop_lower_{axis}": (low, "rad"),
            f"k_stop_{axis}": (STIFFNESS_OF_STOPS, "N m/rad"),
            f"c_stop_{axis}": (DAMPING_OF_STOPS, "s/rad"),
        }
        self.declare("end_stop", stops, axis)
        self.notes.append(
            f"k_stop_{axis} and c_stop_{axis} are not in the file: how hard the stops are is a"
            " guess."
        )

    def _signals(self) -> Iterator[SignalDeclaration]:
        for axis in self.axes:
            turned = -1.0 if self.found.axes[axis].sign < 0.0 else None
            for name, unit, role in (("tau", "N m", "input"), ("theta", "rad", "output")):
                yield SignalDeclaration(
                    f"{name}_{axis}", f"{name}_{axis}", unit, role, scale=turned
                )


def _lean(gravity: FloatArray) -> tuple[float, float]:
    """Angle between pan axis and vertical and the direction of the lean, in rad; 0 if level."""
    lean = math.atan2(math.hypot(gravity[0], gravity[1]), -gravity[2])
    if not np.any(gravity) or lean < LEVEL:
        return 0.0, 0.0
    return lean, math.atan2(gravity[1], gravity[0])


def _products(tensor: FloatArray) -> dict[str, float]:
    """Products of inertia, none where rounding alone is left of them."""
    found = {"xy": tensor[0, 1], "xz": tensor[0, 2], "yz": tensor[1, 2]}
    if max(map(abs, found.values())) <= NO_PRODUCT * float(np.abs(tensor).max()):
        return {}
    return {f"J_{pair}_tilt": float(value) for pair, value in found.items()}


def _vector(numbers: FloatArray) -> str:
    return f"({', '.join(f'{n + 0.0:.9g}' for n in numbers)})"
