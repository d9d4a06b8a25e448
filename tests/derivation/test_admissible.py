"""Machines that cannot exist are refused: value with unit, what is allowed, what to do."""

from dataclasses import replace

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform, read_platform


def changed(preset: str, effects: tuple[str, ...] = (), **values: float) -> Platform:
    """A preset with other values and with effects of the whole platform added."""
    platform = read_platform(preset)
    kept = tuple(p for p in platform.parameters if p.name not in values)
    return replace(
        platform,
        effects=(*platform.effects, *(EffectDeclaration(e, None, None) for e in effects)),
        parameters=(*kept, *(ParameterDeclaration(n, None, v) for n, v in values.items())),
    )


TILT, PAN, PAYLOAD = "thesis-tilt-drive", "thesis-pan-drive", "thesis-payload"


@pytest.mark.parametrize(
    ("platform", "message"),
    [
        (changed(TILT, s_start_tilt=0.13, s_max_tilt=0.2), r"s_start_tilt = 0\.13 m: the linkage"),
        (changed(TILT, l_min_tilt=0.05), r"l_min_tilt = 0\.05 m.*closes, off its dead centres"),
        (changed(TILT, r_arm_tilt=0.0), r"'r_arm_tilt' = 0 m lies outside its bounds"),
        (changed(TILT, s_start_tilt=-0.01), r"'s_start_tilt' = -0\.01 m lies outside its bounds"),
        (changed(TILT, s_max_tilt=0.02), r"s_max_tilt = 0\.02 m: s_start is at most s_max"),
        (changed(TILT, f_screw_tilt=7.0), r"f_screw_tilt = 7 1: the screw wedges unless"),
        (changed(TILT, J_motor_tilt=0.0), r"'J_motor_tilt' = 0 kg m\^2 lies outside"),
        (changed(PAN, J_pan=0.0), r"'J_pan' = 0 kg m\^2 lies outside its bounds"),
        (changed(PAN, J_pan=-1.0), r"'J_pan' = -1 kg m\^2 lies outside its bounds"),
        (changed(PAN, v_s_pan=0.0), r"'v_s_pan' = 0 rad/s lies outside its bounds"),
        (changed(PAN, gap_pan=-0.01), r"'gap_pan' = -0\.01 rad lies outside its bounds"),
        (changed(PAN, F_s_pan=0.1), r"F_s_pan = 0\.1 N m: F_s is at least F_c; raise F_s"),
        (changed(PAYLOAD, J_x_tilt=1e-3), r"J_x_tilt = 0\.001 .*'tilt_body' none may exceed"),
        (changed(PAYLOAD, J_z_payload=1.0), r"J_z_payload = 1 kg m\^2: .*'payload' none may"),
        (
            changed(PAYLOAD, ("product_of_inertia",), J_xy_tilt=5e-4),
            r"J_xy_tilt = 0\.0005 .*'tilt_body' none may exceed the sum of the others; change",
        ),
    ],
)
def test_impossible_machines_are_refused(platform: Platform, message: str) -> None:
    with pytest.raises(InputError, match=message) as refused:
        emission.emit(platform)
    assert "\n" not in str(refused.value)


def test_an_axis_without_inertia_is_refused() -> None:
    effects = (EffectDeclaration("payload", None, None),)
    parameters = tuple(
        ParameterDeclaration(name, None, 0.0)
        for name in ("m_payload", "J_y_payload", "c_x_payload", "c_z_payload")
    )
    platform = Platform("empty", "Nothing turns", ("tilt",), 9.81, effects, parameters, ())
    with pytest.raises(InputError, match=r"m_payload = 0 kg.*every axis needs inertia; give"):
        emission.emit(platform)


def test_a_point_mass_and_a_rod_exist() -> None:
    emission.emit(changed(PAYLOAD, J_x_payload=0.0, J_y_payload=0.0, J_z_payload=0.0))
    emission.emit(changed(PAYLOAD, J_x_payload=0.0, J_y_payload=6.8e-3, J_z_payload=6.8e-3))


def test_two_coupled_screws_are_refused() -> None:
    drives = tuple(EffectDeclaration("linear_actuator", axis, None) for axis in ("pan", "tilt"))
    platform = read_platform(PAYLOAD)
    with pytest.raises(InputError, match="Two coupled joints have friction that depends"):
        emission.emit(replace(platform, effects=(*platform.effects, *drives)))
