"""Which structures a diagnosis tries follows from the effects and the platform, and nothing is left
out in silence.
"""

from dataclasses import replace

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.models.structures import structures, to_scale, with_what_leads
from ptp_symbolic.models.variants import (
    candidate_effects,
    extended,
    that_cannot_stand,
    with_candidates,
)
from ptp_symbolic.platform import (
    EffectDeclaration,
    ParameterDeclaration,
    Platform,
    SignalDeclaration,
    effect_key,
    read_platform,
)
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.symbolic.effects import EFFECTS

BODIES = [("rigid_bodies", None), ("payload", None)]
SERVO = [("dc_motor", "pan"), ("csvs_friction", "pan"), ("viscous_friction", "pan")]


def platform_of(*effects: tuple[str, str | None]) -> Platform:
    """A pan axis with some effects, all parameters at their defaults."""
    declared = tuple(EffectDeclaration(effect, axis, None) for effect, axis in effects)
    bare = read_platform("thesis-ideal")
    return replace(bare, axes=("pan",), effects=declared, parameters=(), signals=())


def keys_of(platform: Platform) -> list[tuple[str, ...]]:
    return [s.keys for s in structures(platform)[0]]


def test_a_motor_on_a_rigid_gear_may_have_a_shaft_a_gap_or_both() -> None:
    found = keys_of(platform_of(*BODIES, *SERVO))
    assert ("shaft_compliance@pan",) in found
    assert ("backlash@pan", "shaft_compliance@pan") in found
    assert ("backlash@pan",) in found, "rigid faces with restitution need no shaft"
    assert ("harmonic_drive@pan",) in found


def test_a_declared_shaft_makes_the_gap_a_term_and_no_structure() -> None:
    platform = platform_of(*BODIES, *SERVO, ("shaft_compliance", "pan"))
    assert ("backlash", "pan") in {(e.effect, e.axis) for e in candidate_effects(platform)}
    assert not any("backlash@pan" in keys for keys in keys_of(platform))


def test_an_axis_has_one_shaft() -> None:
    """Two, side by side, would leave what is between them without inertia."""
    shaft, drive = ("shaft_compliance", "pan"), ("harmonic_drive", "pan")
    found, untried = structures(platform_of(*BODIES, *SERVO, shaft))
    assert ("harmonic_drive@pan",) not in [s.keys for s in found]
    why = "not tried: it excludes shaft_compliance, declared on this axis"
    assert untried["harmonic_drive@pan"] == why
    with pytest.raises(InputError, match="exclude each other on axis 'pan'"):
        place_effects(platform_of(*BODIES, *SERVO, shaft, drive))


def test_an_axis_that_a_torque_drives_brings_its_motor_along() -> None:
    platform = platform_of(*BODIES, ("csvs_friction", "pan"))
    found = keys_of(platform)
    assert ("shaft_compliance@pan", "rotor_inertia@pan") in found
    assert ("backlash@pan", "shaft_compliance@pan", "rotor_inertia@pan") in found
    assert not any("rotor_inertia@pan" in keys for keys in keys_of(platform_of(*BODIES, *SERVO)))
    shaft = next(s for s in structures(platform)[0] if s.keys[0] == "shaft_compliance@pan")
    heavy = to_scale(shaft, {"pan": 3.0})
    assert heavy.starts[0]["J_rotor_pan"] == pytest.approx(15.0 * shaft.starts[0]["J_rotor_pan"])


def test_an_angle_may_be_measured_at_the_motor() -> None:
    """Tried behind every shaft and gap, where an angle is measured at all."""
    bare = platform_of(*BODIES, *SERVO)
    assert not any("motor_encoder@pan" in keys for keys in keys_of(bare))
    angle = SignalDeclaration("theta_pan", "angle", "rad", "output")
    before = [s for s in structures(replace(bare, signals=(angle,)))[0] if len(s.keys) > 1]
    seen = [s for s in before if s.keys[-1] == "motor_encoder@pan"]
    assert {s.keys[0] for s in seen} == {
        "backlash@pan",
        "shaft_compliance@pan",
        "harmonic_drive@pan",
    }
    assert all(s.notes[0] == "encoder at the motor" for s in seen)


def test_bristles_take_the_place_of_dry_friction_and_keep_its_values() -> None:
    platform = platform_of(*BODIES, *SERVO)
    (lugre,) = [s for s in structures(platform)[0] if s.keys == ("lugre_friction@pan",)]
    effects = {e.effect for e in lugre.platform.effects}
    assert "lugre_friction" in effects and "csvs_friction" not in effects
    assert [e.effect for e in lugre.removed] == ["csvs_friction"]


def test_kinds_of_one_effect_are_told_apart_by_what_they_change() -> None:
    """A filter of the angle and one of the current share a key: by the key alone one of them would
    be judged on the platform of the other.
    """
    bare = platform_of(*BODIES, *SERVO)
    signals = (
        SignalDeclaration("theta_pan", "output", "angle", "rad"),
        SignalDeclaration("i_pan", "output", "current", "A"),
    )
    found = structures(replace(bare, signals=signals))[0]
    lags = [s for s in found if s.keys == ("measurement_lag@pan",)]
    assert {e.kind for s in lags for e in s.added} == {"angle", "current"}
    assert len({(s.keys, s.provides) for s in found}) == len(found)


def test_terms_are_searched_for_beside_bristles_but_not_the_friction_that_they_are() -> None:
    """The platform with all candidates is one that can be: each parameter is described once."""
    platform = platform_of(*BODIES, ("dc_motor", "pan"), ("lugre_friction", "pan"))
    candidates = {e.effect for e in candidate_effects(platform)}
    assert "csvs_friction" not in candidates and "cogging" in candidates
    place_effects(with_candidates(platform))
    why = structures(platform)[1]["csvs_friction@pan"]
    assert why == "not tried: lugre_friction describes the same"


def test_friction_that_needs_the_one_replaced_is_a_reason_not_a_crash() -> None:
    platform = platform_of(*BODIES, *SERVO, ("direction_dependent_friction", "pan"))
    found, untried = structures(platform)
    assert ("lugre_friction@pan",) not in [s.keys for s in found]
    assert "direction_dependent_friction" in untried["lugre_friction@pan"]


@pytest.mark.parametrize(
    "effects", [BODIES, [*BODIES, *SERVO], [*BODIES, *SERVO, ("shaft_compliance", "pan")]]
)
def test_no_effect_is_left_out_in_silence(effects: list[tuple[str, str | None]]) -> None:
    platform = platform_of(*effects)
    found, untried = structures(platform)
    known = {effect_key(e.effect, e.axis) for e in platform.effects}
    known |= {effect_key(e.effect, e.axis) for e in candidate_effects(platform)}
    known |= {key for s in found for key in s.keys} | set(untried)
    assert {effect_key(e.id, "pan" if e.on_axis else None) for e in EFFECTS} <= known
    assert all(untried.values())


def test_what_contains_another_structure_provides_all_that_it_does() -> None:
    found = {s.keys: s for s in structures(platform_of(*BODIES, *SERVO))[0] if not any(s.notes)}
    shaft = found["shaft_compliance@pan",].provides
    assert shaft < found["backlash@pan", "shaft_compliance@pan"].provides
    assert shaft <= found["harmonic_drive@pan",].provides
    assert not shaft <= found["measurement_lag@pan",].provides


def test_what_splits_an_axis_is_tried_with_friction_at_the_gear_and_behind_it() -> None:
    """An antenna turns in bearings of its own; where it is said where friction sits, it stays."""
    platform = platform_of(*BODIES, *SERVO)
    found = structures(platform)[0]
    assert len({(s.keys, s.provides) for s in found}) == len(found)
    sites = {
        s.keys: [e.site for t in found if t.keys == s.keys for e in frictions(t.platform)]
        for s in found
    }
    assert sites["shaft_compliance@pan",] == [None, "joint"]
    assert sites["backlash@pan", "shaft_compliance@pan"] == [None, "joint"]
    assert sites["actuator_lag@pan",] == [None]
    assert {note for s in found for note in s.notes} == {"", "friction at the joint"}
    shafts = [s for s in found if s.keys == ("shaft_compliance@pan",)]
    assert not shafts[0].provides <= shafts[1].provides
    assert not shafts[1].provides <= shafts[0].provides
    said = replace(
        platform,
        effects=tuple(
            replace(e, site="gear") if e.effect == "csvs_friction" else e for e in platform.effects
        ),
    )
    assert [s.keys for s in structures(said)[0]].count(("shaft_compliance@pan",)) == 1


def frictions(platform: Platform) -> list[EffectDeclaration]:
    return [e for e in platform.effects if e.effect == "csvs_friction"]


def test_friction_may_be_behind_a_declared_shaft_unless_its_site_is_said() -> None:
    split = platform_of(*BODIES, *SERVO, ("shaft_compliance", "pan"))
    (moved,) = [s for s in structures(split)[0] if s.keys == ("csvs_friction@pan",)]
    (friction,) = frictions(moved.platform)
    assert friction.site == "joint" and moved.notes == ("at the joint, not at the gear",)
    assert len(moved.platform.effects) == len(split.effects)
    said = tuple(
        replace(e, site="gear") if e.effect == "csvs_friction" else e for e in split.effects
    )
    for other in (replace(split, effects=said), platform_of(*BODIES, *SERVO)):
        assert ("csvs_friction@pan",) not in keys_of(other)


def test_gaps_are_tried_beside_torques_that_hold_the_gear_on_a_face() -> None:
    platform = platform_of(*BODIES, *SERVO)
    every = structures(platform)[0]
    led = {s.keys[0] for s in every if s.beside}
    assert led == {"backlash@pan"}
    by_torque, by_spring = with_what_leads(platform, every)
    for leading, name in ((by_torque, "constant_torque"), (by_spring, "cable_spring")):
        (added,) = [e for e in leading.effects if e not in platform.effects]
        assert (added.effect, added.axis) == (name, "pan")
        assert all(p.free for p in leading.parameters)
    assert {p.name: p.value for p in by_torque.parameters} == {"tau0_pan": 0.0}
    known = platform_of(*BODIES, *SERVO, ("constant_torque", "pan"), ("cable_spring", "pan"))
    assert with_what_leads(known, structures(known)[0]) == ()


def test_what_cannot_stand_beside_a_rigid_gap_leaves_all_other_candidates_in() -> None:
    every = structures(platform_of(*BODIES, *SERVO))[0]
    rigid = next(s.platform for s in every if s.keys == ("backlash@pan",))
    every_one = candidate_effects(rigid)
    with pytest.raises(InputError, match="rigid backlash leaves"):
        assemble(replace(rigid, effects=(*rigid.effects, *every_one)))
    kept = with_candidates(rigid).effects
    assert {e.effect for e in every_one if e not in kept} == {"load_dependent_friction"}
    said = that_cannot_stand(rigid)
    assert list(said) == ["load_dependent_friction@pan"]
    assert "which rigid backlash leaves open" in said["load_dependent_friction@pan"]
    assert that_cannot_stand(platform_of(*BODIES, *SERVO)) == {}


def test_starts_are_in_the_scale_of_a_heavy_axis() -> None:
    """So that a shaft swings as fast on it as on a usual one: by its stiffness over the inertia."""
    platform = platform_of(*BODIES, *SERVO)
    shaft, _ = [s for s in structures(platform)[0] if s.keys == ("shaft_compliance@pan",)]
    usual, heavy = (to_scale(shaft, {"pan": inertia}) for inertia in (0.2, 200.0))
    assert usual.starts == shaft.starts
    for before, after in zip(shaft.starts, heavy.starts, strict=True):
        assert after == pytest.approx({name: 1000.0 * value for name, value in before.items()})
    declared = {p.name: p.value for p in heavy.platform.parameters}
    assert declared == heavy.starts[0]


def test_what_is_declared_as_known_stays_so_whatever_a_fit_beside_it_moved() -> None:
    own = (
        ParameterDeclaration("J_pan", "kg m^2", 0.2, free=True),
        ParameterDeclaration("R_pan", "ohm", 1.0),
    )
    platform = replace(platform_of(*BODIES, *SERVO), parameters=own)
    begun = extended(platform, (), {"J_pan": 0.3, "R_pan": 0.98}, ())
    assert {p.name: p.value for p in begun.parameters} == {"J_pan": 0.3, "R_pan": 1.0}
