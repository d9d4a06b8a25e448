"""Platforms to draw: with offsets, a base that leans, every kind of effect, a linear axis."""

from dataclasses import replace

from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform, read_platform

OF_EVERY_KIND = (
    ("axis_offset", None),
    ("payload_com_offset", None),
    ("product_of_inertia", None),
    ("base_tilt", None),
    ("base_motion", None),
    ("load_dependent_friction", "pan"),
    ("position_dependent_friction", "pan"),
    ("rate_dependent_breakaway", "pan"),
    ("shear_thinning_friction", "tilt"),
    ("temperature_dependent_friction", "pan"),
    ("quadratic_drag", "pan"),
    ("maxwell_slip_friction", "tilt"),
    ("cogging", "pan"),
    ("magnetic_detent", "pan"),
    ("gear_eccentricity", "pan"),
    ("pid_controller", "pan"),
    ("pwm_drive", "pan"),
    ("drive_deadband", "tilt"),
    ("voltage_offset", "tilt"),
    ("voltage_saturation", "tilt"),
    ("winding_heating", "pan"),
    ("cable_spring", "pan"),
    ("constant_torque", "tilt"),
    ("input_delay", "tilt"),
    ("encoder_eccentricity", "pan"),
    ("measurement_lag", "pan"),
    ("encoder_quantization", "tilt"),
)


def with_effects(platform: Platform, *added: tuple[str, str | None], **values: float) -> Platform:
    """`platform` with these effects, and these values of parameters in SI units."""
    effects = tuple(EffectDeclaration(effect, axis, None) for effect, axis in added)
    kept = tuple(p for p in platform.parameters if p.name not in values)
    new = tuple(ParameterDeclaration(n, None, v, False, None, None) for n, v in values.items())
    return replace(platform, effects=(*platform.effects, *effects), parameters=(*kept, *new))


def offset_platform(**values: float) -> Platform:
    """Two axes that do not cross, a payload off both, a base that leans."""
    given = {"a_tilt": 0.2, "c_y_payload": 0.04, "c_z_payload": 0.06, "beta_base": 0.15}
    base = read_platform("thesis-payload")
    added = (("axis_offset", None), ("base_tilt", None), ("cable_spring", "pan"))
    return with_effects(base, *added, **(given | {"alpha_base": 0.5} | values))


def platform_of_every_kind() -> Platform:
    """Both drives of the thesis with every effect that can be declared beside them."""
    return with_effects(read_platform("thesis-full"), *OF_EVERY_KIND, a_tilt=0.1, beta_base=0.1)


def carriage(*added: tuple[str, str | None]) -> Platform:
    """A carriage on a rail, driven by a force unless `added` says otherwise."""
    bare = Platform(
        name="carriage",
        title="Carriage on a rail",
        axes=("pan",),
        gravity=9.81,
        effects=(),
        parameters=(),
        signals=(),
        linear_axes=("pan",),
    )
    return with_effects(bare, ("rigid_bodies", None), ("viscous_friction", "pan"), *added)
