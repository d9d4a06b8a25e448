"""Torques that no effect of the catalogue describes, and declared values that are wrong."""

from collections.abc import Callable

from tests.benchmark.effects import LISTED, Scene, Shape

DECLARED_VALUE = "declared_value:"
LARGEST_ANGLE = 2.8  # rad


def _own(
    name: str, scene: Scene, guess: float, limit: float = float("inf"), **rest: float
) -> Shape:
    """A shape with one parameter that the truth alone has; `rest` do not scale."""
    names = {f"{key}_{scene.axis}": value for key, value in rest.items()}
    slope = {f"{name}_{scene.axis}": 1.0}
    return Shape(slope, names, guess=guess, limit=limit, untold=(*slope, *names))


def _damping(scene: Scene) -> float:
    """Viscous coefficient at the joint in N m s/rad, the motor's own damping left out."""
    viscous = scene.values.get(f"b_{scene.axis}", 0.0)
    return viscous or scene.values[f"F_v_{scene.axis}"]


def wind_gust(scene: Scene) -> Shape:
    """A random torque with a correlation time of 0.3 to 2 s, drawn with the runs."""
    return _own("gust_torque", scene, guess=0.05 * scene.coulomb())


def switched_torque(scene: Scene) -> Shape:
    """A torque that is switched on at some time and off later."""
    return _own("switched_torque", scene, guess=0.05 * scene.coulomb())


def decaying_friction(scene: Scene) -> Shape:
    """Dry friction that decays with the time since the run began."""
    time = scene.between(1.5, 4.0)
    return _own("friction_decay", scene, guess=0.1, limit=5.0, decay_time=time)


def hysteretic_cable(scene: Scene) -> Shape:
    """A cable wrap that gives way, after Bouc and Wen."""
    angle = scene.between(0.15, 0.5)
    return _own("wrap_torque", scene, guess=0.07 * scene.coulomb(), wrap_angle=angle)


def viscous_by_angle(scene: Scene) -> Shape:
    """Viscous friction that goes with the sine of twice the angle."""
    least = 0.9 * _damping(scene)  # more would drive the joint at some angles
    return _own("viscous_by_angle", scene, guess=0.1 * least, limit=least)


def torque_by_angle_and_rate(scene: Scene) -> Shape:
    """A torque that grows with angle times rate."""
    least = 0.9 * _damping(scene) / LARGEST_ANGLE  # more would drive the joint at its end
    return _own("torque_by_angle_and_rate", scene, guess=0.1 * least, limit=least)


LISTED_SINCE = {"decaying_friction": "friction_drift"}  # what the catalogue describes by now
UNLISTED: dict[str, Callable[[Scene], Shape]] = {
    made.__name__: made
    for made in (
        wind_gust,
        switched_torque,
        decaying_friction,
        hysteretic_cable,
        viscous_by_angle,
        torque_by_angle_and_rate,
    )
}


def declared_value(scene: Scene, parameter: str) -> Shape:
    """A known value that is wrong by a share of itself: the size, 3 to 40 %."""
    value = scene.values[parameter]
    return Shape(
        {parameter: scene.sign() * value}, {parameter: value}, guess=0.03, limit=0.4, torque=False
    )


def shape_of(effect: str, scene: Scene) -> Shape:
    """The shape of a listed or unlisted effect or of a wrong declared value."""
    if effect.startswith(DECLARED_VALUE):
        return declared_value(scene, effect.removeprefix(DECLARED_VALUE))
    return (LISTED | UNLISTED)[effect](scene)
