"""Where effects sit on the machine: from what they add, for every effect of the catalogue."""

from dataclasses import replace

import pytest

from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.symbolic.derivation import placement
from ptp_symbolic.symbolic.derivation.sites import (
    BASE,
    BODY,
    COMMAND,
    GEAR,
    JOINT,
    MOTOR,
    SENSOR,
    SHAFT,
    Site,
    sited_effects,
)
from ptp_symbolic.symbolic.effects import EFFECTS, Effect
from ptp_symbolic.symbolic.effects.quadratic_drag import QUADRATIC_DRAG
from tests.effects.bases import IDS, with_effect


def sites_of(platform: Platform, effect: str, axis: str | None = None) -> tuple[Site, ...]:
    found = [s for s in sited_effects(platform) if (s.effect.id, s.axis) == (effect, axis)]
    return found[0].sites


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_every_effect_sits_on_the_base_a_body_or_its_own_axis(effect: Effect) -> None:
    own = [s for s in sited_effects(with_effect(effect)) if s.effect.id == effect.id]
    assert own
    for sited in own:
        assert sited.sites
        for site in sited.sites:
            assert site.part in (BASE, BODY) or site.axis == sited.axis


@pytest.mark.parametrize(
    ("effect", "axis", "part"),
    [
        ("viscous_friction", "pan", JOINT),
        ("csvs_friction", "pan", GEAR),
        ("direction_dependent_friction", "pan", GEAR),
        ("backlash", "pan", SHAFT),
        ("shaft_compliance", "pan", SHAFT),
        ("gear_eccentricity", "pan", GEAR),
        ("cogging", "pan", GEAR),
        ("dc_motor", "pan", MOTOR),
        ("voltage_offset", "tilt", MOTOR),
        ("winding_heating", "tilt", MOTOR),
        ("input_delay", "tilt", COMMAND),
        ("encoder_eccentricity", "pan", SENSOR),
        ("measurement_lag", "tilt", SENSOR),
        ("cable_spring", "tilt", JOINT),
        ("constant_torque", "pan", JOINT),
    ],
)
def test_an_effect_of_an_axis_sits_where_a_mechanic_would_look(
    effect: str, axis: str, part: str
) -> None:
    platform = read_platform("thesis-full")
    if (effect, axis) not in {(e.effect, e.axis) for e in platform.effects}:
        added = EffectDeclaration(effect, axis, None)
        platform = replace(platform, effects=(*platform.effects, added))
    assert sites_of(platform, effect, axis)[0] == Site(part, axis)


def test_effects_of_the_whole_platform_sit_on_its_base_and_bodies() -> None:
    platform = read_platform("thesis-payload")
    names = ("base_tilt", "base_motion", "payload_com_offset", "product_of_inertia")
    added = tuple(EffectDeclaration(name, None, None) for name in names)
    platform = replace(platform, effects=(*platform.effects, *added))
    assert sites_of(platform, "base_tilt") == sites_of(platform, "base_motion") == (Site(BASE),)
    assert sites_of(platform, "payload_com_offset") == (Site(BODY, "tilt", "payload"),)
    assert sites_of(platform, "product_of_inertia") == (Site(BODY, "tilt", "tilt_body"),)


def test_dry_friction_without_a_drive_sits_at_the_joint() -> None:
    platform = read_platform("thesis-payload")
    added = EffectDeclaration("csvs_friction", "tilt", None)
    platform = replace(platform, effects=(*platform.effects, added))
    assert sites_of(platform, "csvs_friction", "tilt") == (Site(JOINT, "tilt"),)


def test_an_effect_never_seen_before_has_a_site(monkeypatch: pytest.MonkeyPatch) -> None:
    wind = replace(QUADRATIC_DRAG, id="wind")
    monkeypatch.setattr(placement, "catalogue", lambda: (*EFFECTS, wind))
    platform = read_platform("thesis-payload")
    added = EffectDeclaration("wind", "tilt", None)
    platform = replace(platform, effects=(*platform.effects, added))
    assert sites_of(platform, "wind", "tilt") == (Site(JOINT, "tilt"),)
