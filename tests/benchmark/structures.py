"""Hidden structures: what changes the form of a model, as functions of one size.

Unlike the effects of `effects`, most come in sizes of their own: a stiffness in N m/rad, a gap in
rad, a restitution. Their response is recorded, not asked for. Those that grow from nothing, lags
and ceilings for example, are asked for in thresholds as effects are.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from tests.benchmark.effects import Numbers, Scene
from tests.benchmark.truth_drive import payload_lever_torque

SMALL_DEVIATIONS, STIFF_SHAFT = "small_deviations", "stiff_shaft"  # of machines that lack nothing
VISIBLE_FLOORS = 5.0
SHAFT = "shaft_compliance"


@dataclass(frozen=True)
class Structure:
    """Parameters as a function of the size; `natural` sizes are in units of their own.

    `effects` are what a diagnosis would name, `allowed` what it may name beside them. `told` are
    the parameters with a true value, by the letters before the axis. A shaft beside a gap is told
    if it is visible on its own.
    """

    make: Callable[[float], Numbers]
    effects: tuple[str, ...]
    told: tuple[str, ...]
    natural: bool = True
    allowed: tuple[str, ...] = ()
    guess: float = 0.1
    limit: float = math.inf
    torque: bool = False

    def values(self, size: float) -> Numbers:
        """All parameters at `size`."""
        return self.make(size)


def _log_between(scene: Scene, low: float, high: float) -> float:
    """A number in between, even in its logarithm."""
    return math.exp(scene.between(math.log(low), math.log(high)))


def _load_inertia(scene: Scene) -> float:
    """Inertia in kg m^2 of what hangs on the shaft."""
    body = {"pan": "J_pan", "tilt": "J_y_tilt"}[scene.axis]
    return scene.values[body] + payload_lever_torque(scene.values) * scene.values["c_x_payload"]


def _shaft(scene: Scene, stiffness: float, ratio: float) -> Numbers:
    """A shaft with the damping ratio that the load has on it."""
    damping = 2.0 * ratio * math.sqrt(stiffness * _load_inertia(scene))
    return {f"k_shaft_{scene.axis}": stiffness, f"d_shaft_{scene.axis}": damping}


def shaft_compliance(scene: Scene) -> Structure:
    """A shaft without a gap; its size is the stiffness in N m/rad."""
    ratio = _log_between(scene, 0.02, 0.3)
    told = ("k_shaft", "d_shaft")
    return Structure(lambda size: _shaft(scene, size, ratio), (SHAFT,), told)


def backlash(scene: Scene) -> Structure:
    """A gap in rad with a shaft that is stiff, 2e4 to 1e5 N m/rad."""
    stiffness, ratio = _log_between(scene, 2e4, 1e5), _log_between(scene, 0.05, 0.3)
    shaft, name = _shaft(scene, stiffness, ratio), f"gap_{scene.axis}"
    return Structure(lambda size: {**shaft, name: size}, ("backlash",), ("gap",), allowed=(SHAFT,))


def shaft_and_gap(scene: Scene) -> Structure:
    """A gap in rad with a shaft of 50 to 5000 N m/rad."""
    stiffness, ratio = _log_between(scene, 50.0, 5e3), _log_between(scene, 0.03, 0.3)
    shaft, name = _shaft(scene, stiffness, ratio), f"gap_{scene.axis}"
    effects, told = ("backlash", SHAFT), ("gap", "k_shaft", "d_shaft")
    return Structure(lambda size: {**shaft, name: size}, effects, told)


def elastic_impact(scene: Scene) -> Structure:
    """A gap of 0.2 to 3 degrees between rigid faces; its size is the restitution."""
    gap = {f"gap_{scene.axis}": math.radians(_log_between(scene, 0.2, 3.0))}
    name = f"e_gap_{scene.axis}"
    told = ("gap", "e_gap")
    return Structure(lambda size: {**gap, name: size}, ("backlash",), told, allowed=(SHAFT,))


def lugre_friction(scene: Scene) -> Structure:
    """Bristles in place of sticking; the size is the bend in rad at which they break away."""
    axis, values = scene.axis, scene.values
    inertia = values[f"J_motor_{axis}"] * values[f"N_{axis}"] ** 2 + _load_inertia(scene)
    ratio = _log_between(scene, 0.1, 0.7)

    def make(size: float) -> Numbers:
        stiffness = values[f"F_s_{axis}"] / size
        damping = 2.0 * ratio * math.sqrt(stiffness * inertia)
        viscous = values[f"F_v_{axis}"]
        return {f"sigma0_{axis}": stiffness, f"sigma1_{axis}": damping, f"sigma2_{axis}": viscous}

    return Structure(make, ("lugre_friction",), ("sigma0", "sigma1", "sigma2"))


def measurement_lag(scene: Scene) -> Structure:
    """A time constant of the encoder in s, asked for in thresholds."""
    name = f"t_lag_{scene.axis}"
    effects, told = ("measurement_lag",), ("t_lag",)
    return Structure(lambda size: {name: size}, effects, told, False, guess=2e-3, limit=0.06)


def actuator_lag(scene: Scene) -> Structure:
    """A time constant of the voltage or torque in s, asked for in thresholds."""
    name = f"t_actuator_{scene.axis}"
    effects, told = ("actuator_lag",), ("t_actuator",)
    return Structure(lambda size: {name: size}, effects, told, False, guess=2e-3, limit=0.06)


def _below_peak(scene: Scene, name: str, effect: str, letters: str) -> Structure:
    """A ceiling that lies by the size below the largest input, asked for in thresholds."""
    peak = scene.peak
    return Structure(
        lambda size: {name: peak - size},
        (effect,),
        (letters,),
        False,
        guess=0.05 * peak,
        limit=0.8 * peak,
    )


def torque_saturation(scene: Scene) -> Structure:
    """A ceiling of the torque."""
    return _below_peak(scene, f"tau_max_{scene.axis}", "torque_saturation", "tau_max")


def voltage_ceiling(scene: Scene) -> Structure:
    """A ceiling of the voltage."""
    return _below_peak(scene, f"u_max_{scene.axis}", "voltage_saturation", "u_max")


def torque_proportional_loss(scene: Scene) -> Structure:
    """A loss with the torque transmitted; the size is its mean share, asked for in thresholds."""
    axis, difference = scene.axis, scene.sign() * scene.between(0.1, 0.5)
    angle = _log_between(scene, 0.005, 0.1)

    def make(size: float) -> Numbers:
        shares = {f"mu_avg_{axis}": size, f"mu_dif_{axis}": difference * size}
        return shares | {f"h_loss_{axis}": angle}

    told = ("mu_avg", "mu_dif", "h_loss")
    return Structure(make, ("torque_proportional_loss",), told, False, guess=0.05, limit=0.6)


def end_stop(scene: Scene) -> Structure:
    """A stop that lies by the size in rad within the angles that the runs reach."""
    upper = scene.chance(0.5)
    side = "upper" if upper else "lower"
    place = f"theta_stop_{side}_{scene.axis}"
    contact = {
        f"k_stop_{scene.axis}": _log_between(scene, 50.0, 1000.0),
        f"c_stop_{scene.axis}": scene.between(0.2, 2.0),
    }
    low, high = scene.reach

    def make(size: float) -> Numbers:
        return {place: high - size if upper else low + size} | contact

    return Structure(make, ("end_stop",), (f"theta_stop_{side}", "k_stop", "c_stop"))


def stiff_shaft(scene: Scene) -> Structure:
    """A shaft so stiff that nothing shows; its size is the stiffness in N m/rad."""
    return Structure(lambda size: _shaft(scene, size, 0.1), (), ())


STRUCTURES: dict[str, Callable[[Scene], Structure]] = {
    made.__name__: made
    for made in (
        shaft_compliance,
        backlash,
        shaft_and_gap,
        elastic_impact,
        lugre_friction,
        measurement_lag,
        actuator_lag,
        torque_saturation,
        voltage_ceiling,
        torque_proportional_loss,
        end_stop,
        stiff_shaft,
    )
}
