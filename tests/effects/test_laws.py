"""Laws that hold for every effect of the catalogue, whatever it is."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.models import emission, variants
from ptp_symbolic.platform import EffectDeclaration, Platform
from ptp_symbolic.platform.units import to_si
from ptp_symbolic.symbolic import effects as catalogue
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.symbolic.effects import EFFECTS, Effect
from tests.effects.bases import BASES, IDS, vanishing, with_effect, without
from tests.effects.other_units import refuse_misfit
from tests.effects.plain_python import as_python


def test_every_effect_has_its_file_and_one_import() -> None:
    folder = Path(catalogue.__file__).parent
    files = {p.stem for p in folder.glob("*.py")} - {"__init__"}
    assert files == set(IDS), "a file per effect, imported and listed in effects/__init__.py"
    assert all(len(p.read_text().splitlines()) <= 80 for p in folder.glob("*.py") if p.stem in IDS)


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_declared_parameters_are_used_and_have_units(effect: Effect) -> None:
    equations = assemble(with_effect(effect))
    used = {p.name for p in equations.parameters}
    for placed in equations.effects:
        if placed.effect is effect:
            assert set(placed.parameters) <= used
    for parameter in equations.parameters:
        assert parameter.meaning
        assert parameter.unit == "1" or to_si(parameter.unit)[0] == 1.0


def named_expressions(equations: Equations) -> dict[tuple[str, ...], sp.Expr]:
    """Everything that the equations of a machine say, by what it is."""
    found: dict[tuple[str, ...], sp.Expr] = {}
    for i, rate in enumerate(map(str, equations.rates)):
        found["force", rate] = equations.forcing[i]
        for j, other in enumerate(map(str, equations.rates)):
            found["mass", rate, other] = equations.mass_matrix[i, j]
    for friction in equations.frictions:
        found["level", str(friction.rate)] = friction.level
        found["breakaway", str(friction.rate)] = friction.breakaway
    for contact in equations.contacts:
        found["separation", contact.axis] = contact.separation
        found["half gap", contact.axis] = contact.half_gap
    found |= {("state", state.name): state.derivative for state in equations.extra_states}
    found |= {("output", name): reading for name, _, reading in equations.outputs}
    for given, delay in zip(equations.inputs, equations.delays, strict=True):
        found["delay", given.name] = sp.Integer(0) if delay is None else delay
    ledger = equations.ledger
    found |= {("stored",): ledger.stored, ("dissipated",): ledger.dissipated}
    return {key: equations.written_out(e) for key, e in found.items()} | {
        ("power in",): equations.written_out(ledger.power_in)
    }


@pytest.mark.parametrize("effect", [e for e in EFFECTS if not e.structural], ids=lambda e: e.id)
def test_equations_are_unchanged_when_it_is_off(effect: Effect) -> None:
    """All that the machine says without the effect, it says with the effect switched off; and
    some of that the effect changes when it is on.
    """
    platform = with_effect(effect)
    full, bare = assemble(platform), assemble(without(platform, effect))
    off = vanishing(full, effect)
    assert off, "give one of its parameters `vanishes`, or the effect `structural=True`"
    assert effect.separating_experiment
    known = {state.name for state in bare.extra_states}
    off |= {s.symbol: sp.Float(s.initial) for s in full.extra_states if s.name not in known}
    touching = {mode: 1 for c in full.contacts for mode in (c.active, c.side)}
    with_it, without_it = named_expressions(full), named_expressions(bare)
    rng = np.random.default_rng(8)
    changed = False
    for key, expression in without_it.items():
        sides = with_it[key].subs(off).subs(touching), expression.subs(touching), with_it[key]
        symbols = sorted(set().union(*(e.free_symbols for e in sides)), key=str)
        for _ in range(5):
            point = {symbol: sp.Float(rng.uniform(0.1, 1.0)) for symbol in symbols}
            switched_off, alone, on = (complex(e.xreplace(point)) for e in sides)
            assert switched_off == pytest.approx(alone, rel=1e-12, abs=1e-12), key
            changed |= on != pytest.approx(alone, rel=1e-9)
    assert changed, "nothing that was compared depends on the effect"


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_what_it_brings_is_named_after_its_axis_and_stores_what_its_states_hold(
    effect: Effect,
) -> None:
    for placed, place in place_effects(with_effect(effect)):
        if placed is not effect:
            continue
        added = effect.contribute(place)
        if place.axis is not None:
            names = [p.name for p in effect.parameters_at(place)] + [s.name for s in added.states]
            assert all(place.axis in name.split("_") for name in names), names
        if added.states and added.torques:
            given = {place.quantity(need) for need in effect.needs}
            by_others = any(torque.free_symbols & given for torque in added.torques.values())
            assert added.stored != 0 or by_others, "its states hold energy: declare it as `stored`"


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_defaults_starts_and_where_it_vanishes_lie_within_the_bounds(effect: Effect) -> None:
    for placed, place in place_effects(with_effect(effect)):
        for p in effect.parameters_at(place) if placed is effect else ():
            given = (p.default, *p.starts, *(() if p.vanishes is None else (p.vanishes,)))
            assert all(p.lower <= value <= p.upper for value in given), p.name


@pytest.mark.parametrize("base", BASES, ids=lambda base: base.name)
def test_all_candidates_fit_into_one_machine(base: Platform) -> None:
    """Names of parameters and states differ: a diagnosis places them all at once."""
    everything = replace(base, effects=(*base.effects, *variants.candidate_effects(base)))
    assert len(assemble(everything).effects) == len(everything.effects)


def test_an_unknown_effect_is_refused() -> None:
    base = BASES[0]
    with pytest.raises(ValueError, match=r"Unknown effect 'wings'\. Choose one of: rigid_bodies"):
        assemble(replace(base, effects=(*base.effects, EffectDeclaration("wings", None, None))))


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_other_units_give_the_same_motion(effect: Effect) -> None:
    refuse_misfit(as_python(emission.emit(with_effect(effect))), effect.id, "N m")
