"""Every effect on a linear joint: in the units of a sliding body, or refused by name."""

import re
from dataclasses import replace

import numpy as np
import pytest

from ptp_symbolic.api.effect_bases import BARE, DRIVEN, GEARED, carriage
from ptp_symbolic.api.effect_laws import BEFORE_GEAR
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission, variants
from ptp_symbolic.platform import EffectDeclaration, SignalDeclaration
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.kane import kane
from ptp_symbolic.symbolic.derivation.lagrange import lagrange
from ptp_symbolic.symbolic.derivation.newton_euler import newton_euler
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.symbolic.derivation.proof import prove_equal
from ptp_symbolic.symbolic.effects import EFFECTS

ROTARY_ALONE = {effect.id for effect in EFFECTS if effect.instead_on_linear}
TURNS = BEFORE_GEAR


@pytest.mark.parametrize("effect", sorted(ROTARY_ALONE))
def test_what_makes_no_sense_on_a_linear_joint_says_what_does(effect: str) -> None:
    words = next(e for e in EFFECTS if e.id == effect).instead_on_linear
    assert len(words.split()) >= 4


@pytest.mark.parametrize("kind", ["elastic_impact", "hysteresis_friction", "hysteresis_inertia"])
def test_a_gap_of_any_kind_is_in_metres(kind: str) -> None:
    base = carriage(*DRIVEN)
    own = EffectDeclaration("backlash", "pan", None, kind)
    equations = assemble(replace(base, effects=(*base.effects, own)))
    (gap,) = [q for q in equations.parameters if q.name == "gap_pan"]
    assert (gap.unit, gap.lower <= 1e-6 < gap.default < 1e-3) == ("m", True)


@pytest.mark.parametrize("effect", sorted(ROTARY_ALONE))
def test_what_needs_a_joint_that_turns_is_refused_by_name(effect: str) -> None:
    with pytest.raises(InputError, match=f"^Effect '{effect}' makes no sense on a linear") as found:
        place_effects(carriage(*BARE, effect))
    assert "\n" not in str(found.value)


def test_a_search_on_a_linear_axis_proposes_what_a_linear_axis_can_have() -> None:
    found = set()
    for base in (BARE, GEARED):
        proposed = {e.effect for e in variants.candidate_effects(carriage(*base))}
        everything = assemble(variants.with_candidates(carriage(*base)))
        assert len(everything.effects) == len(proposed) + len(base)
        found |= proposed
    assert found == {e.id for e in EFFECTS if e.searched} - ROTARY_ALONE


def test_three_derivations_agree_on_newtons_second_law() -> None:
    rigid = assemble(carriage(*BARE)).rigid
    ours = [route(rigid) for route in (newton_euler, kane, lagrange)]
    assert all(prove_equal(each, ours[-1]).equal for each in ours)
    assert [str(e) for each in ours for e in (*each.mass_matrix, *each.forcing)] == [
        "m_pan",
        "0",
    ] * 3


def test_texts_speak_of_forces_and_positions() -> None:
    equations = assemble(variants.with_candidates(carriage(*GEARED)))
    texts = [q.meaning for q in equations.parameters if q.name not in {*TURNS, "N_pan"}]
    texts += [text for e in equations.effects for text in (e.effect.title,)]
    texts += [s.meaning for s in (*equations.extra_states, *equations.inputs)]
    words = r"\b(torque|angle|inertia|rate)s?\b"
    assert not [text for text in texts if re.search(words, text)]


def test_sensors_of_joint_and_shaft_are_linear_and_that_of_the_motor_turns() -> None:
    wanted = {"omega_pan": "m/s", "tau_shaft_pan": "N", "omega_motor_pan": "rad/s"}
    signals = tuple(SignalDeclaration(n, n, unit, "output") for n, unit in wanted.items())
    equations = assemble(replace(carriage(*GEARED), signals=signals))
    units = {name: unit for name, unit, _ in equations.outputs}
    assert units == {"theta_pan": "m", "i_pan": "A", **wanted}


def test_what_filtered_sensors_show_has_the_units_of_what_they_measure() -> None:
    kinds = {"rate": "omega", "motor_rate": "omega_motor", "torque": "tau_shaft"}
    wanted = {
        "shown_omega_pan": "m/s",
        "shown_omega_motor_pan": "rad/s",
        "shown_tau_shaft_pan": "N",
    }
    base = carriage(*GEARED)
    lags = tuple(EffectDeclaration("measurement_lag", "pan", None, kind) for kind in kinds)
    names = [f"{signal}_pan" for signal in kinds.values()]
    signals = tuple(SignalDeclaration(n, n, wanted[f"shown_{n}"], "output") for n in names)
    equations = assemble(replace(base, effects=(*base.effects, *lags), signals=signals))
    units = {state.name: state.unit for state in equations.extra_states}
    assert {name: units[name] for name in wanted} == wanted


def test_a_wave_number_is_two_pi_over_the_length_of_a_cycle() -> None:
    """An encoder on a screw of 8 mm lead errs alike one lead further on, and not half a lead."""
    model = emission.emit(carriage(*BARE, "encoder_eccentricity"))
    p = model.parameter_vector(
        {"n_enc_pan": 2.0 * np.pi / 8e-3, "e_sin_pan": 1e-4, "e_sin3_pan": 2e-5}
    )
    shown = []
    for travel in (1.3e-3, 9.3e-3, 5.3e-3):
        y = np.zeros(1)
        model.module.outputs(0.0, np.array([travel, 0.0]), np.zeros(1), p, y)
        shown.append(float(y[0]) - travel)
    assert shown[0] == pytest.approx(shown[1], abs=1e-15)
    assert shown[0] == pytest.approx(-shown[2], abs=1e-15)
    wave = 1e-4 * np.sin(2.0 * np.pi * 1.3 / 8.0) + 2e-5 * np.sin(6.0 * np.pi * 1.3 / 8.0)
    assert shown[0] == pytest.approx(wave, abs=1e-15)
