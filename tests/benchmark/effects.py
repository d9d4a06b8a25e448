"""The hidden effects: their parameters as functions of one size, with the rest drawn by chance.

Listed effects carry the project's parameter names; unlisted ones have names of the truth alone.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.benchmark.machine import Machine, Values

LARGEST_PRODUCT = 3.4e-3  # kg m^2, what the larger tilt body can have as a body

Numbers = dict[str, float]


@dataclass(frozen=True)
class Shape:
    """An effect whose parameters are offset + slope x size.

    `guess` is a size to try first and `limit` the largest sane one. `torque` says that the effect
    is a torque, so that its size is also judged by its share of the Coulomb torque. `untold` are
    parameters that another value describes as well, or that the truth alone has.
    """

    slope: Numbers
    offset: Numbers = field(default_factory=dict)
    guess: float = 0.1
    limit: float = math.inf
    torque: bool = True
    untold: tuple[str, ...] = ()

    def values(self, size: float) -> Numbers:
        """All parameters at `size`."""
        names = [*self.slope, *(name for name in self.offset if name not in self.slope)]
        return {
            name: self.offset.get(name, 0.0) + self.slope.get(name, 0.0) * size for name in names
        }


@dataclass(frozen=True)
class Scene:
    """Where an effect is planted: machine, values, axis, largest command and rate, chance, least
    and largest angle.
    """

    machine: Machine
    values: Values
    axis: str
    peak: float
    fastest: float
    rng: np.random.Generator
    reach: tuple[float, float] = (0.0, 0.0)

    def sign(self) -> float:
        """Plus or minus one."""
        return 1.0 if self.rng.random() < 0.5 else -1.0

    def between(self, low: float, high: float) -> float:
        """A number in between."""
        return float(self.rng.uniform(low, high))

    def turn(self) -> float:
        """A phase or azimuth in rad."""
        return self.between(-math.pi, math.pi)

    def coulomb(self) -> float:
        """Coulomb torque of the axis in N m."""
        return self.values.get(f"F_c_{self.axis}", 0.0) or 0.05

    def chance(self, share: float) -> bool:
        """True in `share` of the cases."""
        return bool(self.rng.random() < share)


def base_tilt(scene: Scene) -> Shape:
    """Gravity on the payload of a base that leans towards an azimuth."""
    azimuth = scene.turn()
    untold: tuple[str, ...] = ()
    if scene.machine.axes == ("tilt",):
        # The lean across the tilt axis does nothing: an azimuth ahead or behind, and no own value.
        azimuth, untold = 0.2 * azimuth, ("beta_base", "alpha_base")
        azimuth += 0.0 if scene.chance(0.5) else math.pi * (1.0 if azimuth < 0.0 else -1.0)
    return Shape({"beta_base": 1.0}, {"alpha_base": azimuth}, guess=0.01, limit=0.45, untold=untold)


def base_motion(scene: Scene) -> Shape:
    """A horizontal acceleration of the base that is a sine in time."""
    azimuth = 0.3 * scene.turn() if scene.machine.axes == ("tilt",) else scene.turn()
    offset = {"f_base": scene.between(0.3, 3.0), "phi_base": scene.turn(), "psi_base": azimuth}
    # Phase and azimuth may both turn by half a circle; on the tilt axis alone a cos(psi) counts.
    untold = ("phi_base", "psi_base")
    if scene.machine.axes == ("tilt",):
        untold = ("a_base", *untold)
    return Shape({"a_base": 1.0}, offset, guess=0.05, limit=5.0, untold=untold)


def cable_spring(scene: Scene) -> Shape:
    """A spring with linear and cubic part and a rest angle."""
    stiffness = {
        f"k1_cable_{scene.axis}": scene.between(0.4, 1.0),
        f"k3_cable_{scene.axis}": scene.between(0.0, 0.5),
    }
    rest = {f"theta0_cable_{scene.axis}": scene.between(-0.8, 0.8)}
    return Shape(stiffness, rest, guess=0.05 * scene.coulomb())


def constant_torque(scene: Scene) -> Shape:
    """A torque of either sign."""
    return Shape({f"tau0_{scene.axis}": scene.sign()}, guess=0.05 * scene.coulomb())


def viscous_friction(scene: Scene) -> Shape:
    """Viscous friction where none is declared."""
    return Shape({f"b_{scene.axis}": 1.0}, guess=0.05 * scene.coulomb())


def csvs_friction(scene: Scene) -> Shape:
    """Coulomb and static friction where none is declared."""
    static = 1.0 if scene.machine.axes == ("pan", "tilt") else scene.between(1.0, 1.6)
    levels = {f"F_c_{scene.axis}": 1.0, f"F_s_{scene.axis}": static}
    return Shape(
        levels,
        {f"v_s_{scene.axis}": 0.03},
        guess=0.05 * scene.coulomb(),
        untold=(f"v_s_{scene.axis}", f"F_s_{scene.axis}"),
    )


def direction_dependent_friction(scene: Scene) -> Shape:
    """Friction of which each parameter differs by direction by a share of its own."""
    axis = scene.axis
    coulomb = scene.sign() * scene.between(0.5, 1.0)
    slope = {f"a_F_c_{axis}": coulomb, f"a_F_s_{axis}": coulomb}
    if scene.machine.axes != ("pan", "tilt"):
        slope[f"a_F_s_{axis}"] = coulomb * scene.between(0.3, 1.2)
        slope[f"a_v_s_{axis}"] = scene.sign() * scene.between(0.0, 0.6)
        slope[f"a_F_v_{axis}"] = scene.sign() * scene.between(0.05, 0.4)
    return Shape(slope, guess=0.05, limit=0.8)


def _vector(scene: Scene, sine: str, cosine: str, size: float) -> Numbers:
    """Sine and cosine part of `size` at a random angle."""
    angle = scene.turn()
    return {sine: size * math.cos(angle), cosine: size * math.sin(angle)}


def _two_harmonics(scene: Scene, sine: str, cosine: str, share: float) -> Shape:
    """Sine and cosine part; in `share` of the cases twice the harmonic beside it."""
    axis = scene.axis
    slope = _vector(scene, f"{sine}_{axis}", f"{cosine}_{axis}", 1.0)
    second = (f"{sine}_2_{axis}", f"{cosine}_2_{axis}")
    if scene.chance(share):
        slope |= _vector(scene, *second, scene.between(0.4, 1.2))
    return Shape(slope, untold=second)


def position_dependent_friction(scene: Scene) -> Shape:
    """Dry friction that goes with the angle, in a third of the cases with its double too."""
    shape = _two_harmonics(scene, "f_sin", "f_cos", 0.35)
    return Shape(shape.slope, guess=0.07, limit=0.9, untold=shape.untold)


def load_dependent_friction(scene: Scene) -> Shape:
    """Dry friction that grows with the torque transmitted to the joint."""
    return Shape({f"mu_load_{scene.axis}": 1.0}, guess=0.02, limit=0.6)


def rate_dependent_breakaway(scene: Scene) -> Shape:
    """Breakaway that grows with the logarithm of the time at rest."""
    rest = {f"t_rest_{scene.axis}": scene.between(0.1, 0.8)}
    return Shape({f"a_rest_{scene.axis}": 1.0}, rest, guess=0.1, limit=1.5, torque=False)


def quadratic_drag(scene: Scene) -> Shape:
    """Drag with the square of the rate, up to three Coulomb torques at the largest."""
    unit = scene.coulomb() / scene.fastest**2
    return Shape({f"c_drag_{scene.axis}": 1.0}, guess=0.1 * unit, limit=3.0 * unit)


def cogging(scene: Scene) -> Shape:
    """A torque of 4 to 80 cycles per turn, in a third of the cases of twice as many beside it."""
    axis = scene.axis
    cycles = float(round(math.exp(scene.between(math.log(4.0), math.log(80.0)))))
    slope = _vector(scene, f"T_sin_{axis}", f"T_cos_{axis}", 1.0)
    offset = {f"n_cog_{axis}": cycles}
    second = (f"T_sin_2_{axis}", f"T_cos_2_{axis}", f"n_cog_2_{axis}")
    if scene.chance(0.3):
        slope |= _vector(scene, *second[:2], scene.between(0.3, 0.7))
        offset[second[2]] = 2.0 * cycles
    return Shape(slope, offset, guess=0.07 * scene.coulomb(), untold=second)


def gear_eccentricity(scene: Scene) -> Shape:
    """A transmission error once per turn of the gear output."""
    slope = _vector(scene, f"g_sin_{scene.axis}", f"g_cos_{scene.axis}", 1.0)
    return Shape(slope, guess=2e-3, limit=0.05, torque=False)


def encoder_eccentricity(scene: Scene) -> Shape:
    """A reading error once per turn, in a third of the cases twice per turn beside it."""
    shape = _two_harmonics(scene, "e_sin", "e_cos", 0.3)
    return Shape(shape.slope, guess=2e-3, limit=0.05, torque=False, untold=shape.untold)


def voltage_offset(scene: Scene) -> Shape:
    """An offset in V of either sign."""
    return Shape({f"u0_{scene.axis}": scene.sign()}, guess=0.03, limit=4.0, torque=False)


def drive_deadband(scene: Scene) -> Shape:
    """A dead band of the drive in V."""
    return Shape({f"u_dead_{scene.axis}": 1.0}, guess=0.05, limit=4.0, torque=False)


def voltage_saturation(scene: Scene) -> Shape:
    """Size in V is how far the rails lie below the largest command."""
    name, peak = f"u_max_{scene.axis}", scene.peak
    return Shape({name: -1.0}, {name: peak}, guess=0.01 * peak, limit=0.8 * peak, torque=False)


def input_delay(scene: Scene) -> Shape:
    """A delay of the held input in s."""
    return Shape({f"t_delay_{scene.axis}": 1.0}, guess=1e-3, limit=0.06, torque=False)


def winding_heating(scene: Scene) -> Shape:
    """A winding whose resistance rises with the power it takes."""
    time = {f"t_heat_{scene.axis}": scene.between(3.0, 20.0)}
    return Shape({f"k_heat_{scene.axis}": 1.0}, time, guess=0.02, limit=0.6, torque=False)


def payload_com_offset(scene: Scene) -> Shape:
    """A payload that sits off its declared place, in a random direction."""
    letters = "xz" if scene.machine.axes == ("tilt",) else "xyz"
    vector = scene.rng.normal(size=len(letters))
    vector /= np.linalg.norm(vector)
    slope = {f"dc_{k}_payload": float(v) for k, v in zip(letters, vector, strict=True)}
    return Shape(slope, guess=5e-4, limit=0.04)


def product_of_inertia(scene: Scene) -> Shape:
    """Products of inertia of the tilt body, in a random mixture."""
    vector = scene.rng.normal(size=3)
    vector /= np.linalg.norm(vector)
    names = ("J_xy_tilt", "J_xz_tilt", "J_yz_tilt")
    slope = {name: float(v) for name, v in zip(names, vector, strict=True)}
    return Shape(slope, guess=2e-4, limit=LARGEST_PRODUCT)


LISTED: dict[str, Callable[[Scene], Shape]] = {
    made.__name__: made
    for made in (
        base_tilt,
        base_motion,
        cable_spring,
        constant_torque,
        viscous_friction,
        csvs_friction,
        direction_dependent_friction,
        position_dependent_friction,
        load_dependent_friction,
        rate_dependent_breakaway,
        quadratic_drag,
        cogging,
        gear_eccentricity,
        encoder_eccentricity,
        voltage_offset,
        drive_deadband,
        voltage_saturation,
        input_delay,
        winding_heating,
        payload_com_offset,
        product_of_inertia,
    )
}
WHOLE_PLATFORM = ("base_tilt", "base_motion", "payload_com_offset", "product_of_inertia")
