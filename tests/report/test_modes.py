"""The modes of friction and contact as the derivation report lists and draws them."""

import re
from dataclasses import replace

import sympy as sp

import ptp_symbolic
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.report.derivation.modes import Automaton, automata, modes
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.effects import EFFECTS
from tests.effects.bases import with_effect

PAN = "thesis-pan-drive"


def row(own: Automaton, name: str) -> sp.Expr:
    return dict(own.rows)[symbol_latex(name)]


def edges(own: Automaton) -> set[tuple[str, str]]:
    return {(own.modes[t.start].name, own.modes[t.end].name) for t in own.transitions}


def test_a_smooth_machine_has_no_modes() -> None:
    assert modes(assemble(read_platform("thesis-payload"))) == ""


def test_what_friction_holds_is_the_torque_of_motor_and_shaft() -> None:
    friction, _ = automata(assemble(read_platform(PAN)))
    K_t, N, i, T, active = (
        sp.Symbol(name, real=True)
        for name in ("K_t_pan", "N_pan", "i_pan", "T_shaft_pan", "active_pan")
    )
    assert sp.expand(row(friction, "F_sticking_gear_pan") - (K_t * N * i - active * T)) == 0
    static, differs = (sp.Symbol(name, real=True) for name in ("F_s_pan", "a_F_s_pan"))
    assert sp.expand(row(friction, "F_ahead_gear_pan") - static * (1 + differs)) == 0
    assert sp.expand(row(friction, "F_back_gear_pan") - static * (1 - differs)) == 0


def test_sliding_turns_round_by_way_of_rest_and_faces_meet_across_the_gap() -> None:
    friction, contact = automata(assemble(read_platform(PAN)))
    assert edges(friction) == {
        ("slip back", "stick"),
        ("stick", "slip back"),
        ("stick", "slip ahead"),
        ("slip ahead", "stick"),
    }
    assert ("gap", "contact") in edges(contact)
    assert ("contact", "gap") not in edges(contact)


def rigid(kind: str) -> Platform:
    platform = read_platform(PAN)
    effects = tuple(
        replace(e, kind=kind) if e.effect == "backlash" else e
        for e in platform.effects
        if e.effect != "shaft_compliance"
    )
    kept = tuple(p for p in platform.parameters if "shaft" not in p.name)
    return replace(platform, effects=effects, parameters=kept)


def test_rigid_faces_bounce_with_their_restitution() -> None:
    found = automata(assemble(rigid("elastic_impact")))[-1]
    assert ("gap", "gap") in edges(found)
    assert row(found, "e_pan") == sp.Symbol("e_gap_pan", real=True)
    assert row(automata(assemble(rigid("hysteresis_inertia")))[-1], "e_pan") == 0


def test_every_mode_symbol_is_in_a_table_and_every_mode_in_a_drawing() -> None:
    slipping = next(e for e in EFFECTS if e.id == "maxwell_slip_friction")
    for platform in (read_platform("thesis-full"), with_effect(slipping)):
        equations = assemble(platform)
        text = modes(equations)
        for symbol in equations.mode_symbols:
            assert symbol_latex(str(symbol)) in text
        for own in automata(equations):
            assert len(own.modes) > 1
        drawn = len(re.findall(r"\\node\[state\]", text))
        assert drawn == sum(len(own.modes) for own in automata(equations))


def test_a_run_changes_modes_only_along_the_drawn_arrows() -> None:
    """What the simulation of the pan drive goes through, which locates its events on its own."""
    own = dict(
        zip(("friction pan", "contact pan"), automata(assemble(read_platform(PAN))), strict=True)
    )
    words = {
        "slides backward": "slip back",
        "sticks": "stick",
        "slides forward": "slip ahead",
        "is in the gap": "gap",
        "touches": "contact",
        "lets go": "off its face",
    }
    run = ptp_symbolic.simulate(ptp_symbolic.load("pan_drive"), 2.0, {"u_pan": "multisine:6@2,3.1"})
    now = {"friction pan": "stick", "contact pan": "gap"}
    passed = set()
    for event in run.events:
        entered = next(mode for word, mode in words.items() if event.mode.startswith(word))
        passed.add((event.element, now[event.element], entered))
        now[event.element] = entered
    for element, before, after in passed:
        arrows = edges(own[element])
        at_once = {(before, "stick"), ("stick", after)}  # a reversal rests for an instant alone
        assert (before, after) in arrows or at_once <= arrows, (element, before, after)
    assert len(passed) > 5
