"""Laws that hold for every effect of the catalogue, whatever it is."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pint
import pytest
import sympy as sp

from ptp_symbolic.models import emission, variants
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.platform.units import to_si
from ptp_symbolic.symbolic import effects as catalogue
from ptp_symbolic.symbolic.codegen import dynamics
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.derivation.placement import available_quantities, place_effects
from ptp_symbolic.symbolic.effect_interface.place import active, side, slide
from ptp_symbolic.symbolic.effects import EFFECTS, Effect
from ptp_symbolic.symbolic.mechanics.kinematics import TIME

PLATFORMS = Path(__file__).parents[1] / "platforms"
BASES = tuple(
    read_platform(source)
    for source in (
        "thesis-payload",
        PLATFORMS / "fieldlog_pan.toml",
        PLATFORMS / "fieldlog_two_axis.toml",
    )
)
IDS = [effect.id for effect in EFFECTS]


def with_effect(effect: Effect) -> Platform:
    """The first base platform that has the effect, or that it can be added to."""
    for base in BASES:
        if any(e.effect == effect.id for e in base.effects):
            return base
        available = available_quantities(place_effects(base))
        for addition in variants.candidate_effects(base):
            needs = {need.format(axis=addition.axis) for need in effect.needs}
            if addition.effect == effect.id and needs <= available:
                return replace(base, effects=(*base.effects, addition))
    assert not effect.searched, f"No base platform takes {effect.id}."
    needs = {need.format(axis="pan") for need in effect.needs}
    if effect.splits_axis:
        return instead_of_shaft(effect)
    base = next(b for b in BASES if needs <= available_quantities(place_effects(b)))
    addition = EffectDeclaration(effect.id, base.axes[0] if effect.on_axis else None, None)
    return replace(base, effects=(*base.effects, addition))


def instead_of_shaft(effect: Effect) -> Platform:
    """The first base platform with a shaft, `effect` in its place, and nothing that acts on it."""
    splitting = {e.id for e in EFFECTS if e.splits_axis}
    base, shaft = next((b, e) for b in BASES for e in b.effects if e.effect in splitting)
    key = f"{shaft.effect}@{shaft.axis}"
    gone = [e for e in assemble(base).effects if e.effect.id == shaft.effect or key in e.acts_on]
    own, names = {n for e in gone for n in e.parameters}, {e.effect.id for e in gone}
    kept = tuple(e for e in base.effects if e.effect not in names)
    return replace(
        base,
        effects=(*kept, EffectDeclaration(effect.id, shaft.axis, None)),
        parameters=tuple(p for p in base.parameters if p.name not in own),
    )


def without(platform: Platform, effect: Effect) -> Platform:
    """`platform` without the effect and its parameters."""
    own = {n for e in assemble(platform).effects if e.effect is effect for n in e.parameters}
    return replace(
        platform,
        effects=tuple(e for e in platform.effects if e.effect != effect.id),
        parameters=tuple(p for p in platform.parameters if p.name not in own),
    )


def vanishing(equations: Equations, effect: Effect) -> dict[sp.Symbol, sp.Expr]:
    return {
        sp.Symbol(p.name, real=True): sp.nsimplify(p.vanishes)
        for placed in equations.effects
        if placed.effect is effect
        for p in equations.parameters
        if p.name in placed.parameters and p.vanishes is not None
    }


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
            switched_off, alone, on = (complex(e.subs(point)) for e in sides)
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
            assert added.stored != 0, "torques of a state work on what it stores: declare it"


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


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_energy_ledger_closes_in_every_mode(effect: Effect) -> None:
    equations = assemble(with_effect(effect))
    rng = np.random.default_rng(11)
    solve = dynamics.solve_accelerations(equations)
    definitions = dict(solve.definitions)
    rates = dynamics.state_rates(equations, solve)
    states, ledger = equations.state_symbols, equations.ledger
    stored = equations.written_out(ledger.stored)
    flows = [sp.diff(stored, s) * r for s, r in zip(states, rates, strict=True)]
    flows.append(sp.diff(stored, TIME))
    parts = [sp.Add(*flows), ledger.power_in, ledger.dissipated, sp.Add(*map(sp.Abs, flows))]
    for name in reversed(list(definitions)):
        named = {sp.Symbol(name, real=True): definitions[name]}
        parts = [part.subs(named) for part in parts]
    symbols = sorted(set().union(*(part.free_symbols for part in parts)), key=str)
    function = sp.lambdify(symbols, parts, "numpy")
    for _ in range(60):
        modes = random_modes(equations, rng)
        values = admissible_values(equations, symbols, modes, rng)
        stored, supplied, dissipated, flowing = (float(v) for v in function(*values))
        size = flowing + abs(supplied) + abs(dissipated)
        assert abs(stored - supplied + dissipated) <= 1e-10 * size, modes


def random_modes(equations: Equations, rng: np.random.Generator) -> dict[str, float]:
    """Modes that a machine can be in, and the rates that they force: a friction at rest rests."""
    modes: dict[str, float] = {}
    for friction in equations.frictions:
        direction = float(rng.choice([-1.0, 0.0, 1.0]))
        modes[str(slide(friction.axis))] = direction
        if direction == 0.0:
            modes[str(friction.rate)] = 0.0
    sides = [(c.side, c.active) for c in equations.contacts if not c.rigid]
    sides += [(side(switch.name), active(switch.name)) for switch in equations.switches]
    for where, on in sides:
        modes[str(where)] = float(rng.choice([-1.0, 0.0, 1.0]))
        modes[str(on)] = float(rng.choice([0.0, 1.0])) * abs(modes[str(where)])
    return modes


def admissible_values(
    equations: Equations,
    symbols: list[sp.Symbol],
    modes: dict[str, float],
    rng: np.random.Generator,
) -> list[float]:
    """Random values of `symbols`, drawn until the parameters fit each other."""
    for _ in range(1000):
        values = [
            modes[s.name] if s.name in modes else value_of(equations, s.name, rng) for s in symbols
        ]
        given = dict(zip(symbols, values, strict=True))
        if all(requirement.holds.subs(given) != sp.false for requirement in equations.requirements):
            return values
    raise AssertionError("No admissible parameters were drawn.")


def value_of(equations: Equations, name: str, rng: np.random.Generator) -> float:
    """A random value, of a parameter around its default."""
    for parameter in equations.parameters:
        if parameter.name == name:
            base = parameter.default or 0.1
            return float(base * rng.uniform(0.5, 1.5))
    return float(rng.normal())


@pytest.mark.parametrize("effect", [e for e in EFFECTS if e.dissipative], ids=lambda e: e.id)
@pytest.mark.parametrize("size", [1e-3, 1.0, 30.0])
def test_a_dissipative_effect_takes_energy_out(effect: Effect, size: float) -> None:
    """Its own share of what the machine dissipates, with the effect at work and switched off."""
    model, rng = emission.emit(with_effect(effect)), np.random.default_rng(5)
    own = {p.name: p for p in model.parameters if p.vanishes is not None}
    names = {
        n for e in assemble(with_effect(effect)).effects if e.effect is effect for n in e.parameters
    }
    at_work = {n: own[n].starts[0] for n in names & own.keys() if own[n].starts}
    switched_off = {n: own[n].vanishes for n in names & own.keys()}
    p, off = model.parameter_vector(at_work), model.parameter_vector(switched_off)
    taken = []
    for _ in range(200):
        x, u = rng.normal(size=len(model.state_names)), rng.normal(size=len(model.input_names))
        x *= size
        m, e, other = np.zeros(len(model.mode_names)), np.zeros(3), np.zeros(3)
        model.module.initial_modes(0.0, x, u, p, m)
        model.module.energy(0.0, x, u, p, m, e)
        model.module.energy(0.0, x, u, off, m, other)
        assert e[2] >= 0.0
        taken.append(e[2] - other[2] if switched_off else e[2])
        assert taken[-1] >= -1e-12 * abs(e[2])
    assert max(taken) > 0.0


def test_an_unknown_effect_is_refused() -> None:
    base = BASES[0]
    with pytest.raises(ValueError, match=r"Unknown effect 'wings'\. Choose one of: rigid_bodies"):
        assemble(replace(base, effects=(*base.effects, EffectDeclaration("wings", None, None))))


def unit_factor(unit: str) -> float:
    """How a number in `unit` changes when kg, m, s and A change; m = s^2 keeps gravity as it is."""
    scales = {"[mass]": 3.0, "[length]": 4.0, "[time]": 2.0, "[current]": 7.0}
    dimension = pint.get_application_registry()(unit if unit != "1" else "").to_base_units()
    factor = 1.0
    for base, exponent in dimension.dimensionality.items():
        factor *= scales[base] ** exponent
    return factor


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_other_units_give_the_same_motion(effect: Effect) -> None:
    model, rng = emission.emit(with_effect(effect)), np.random.default_rng(2)
    units = model.units
    names = (model.state_names, model.input_names, model.parameter_names)
    x, u = (rng.normal(size=len(n)) for n in names[:2])
    p = model.parameter_vector({q.name: q.default or q.upper * 1e-4 for q in model.parameters})
    m = np.ones(len(model.mode_names))
    scaled = [
        a * np.array([unit_factor(units[n]) for n in group])
        for a, group in zip((x, u, p), names, strict=True)
    ]
    t, later = 0.7, 0.7 * unit_factor("s")
    outputs = [unit_factor(units[name]) for name in model.output_names]
    guards = [unit_factor("N m")] * 3 * len(model.friction_rates)
    for _ in model.module.CONTACT_ANGLES:
        guards += [1.0, 1.0, unit_factor("N m"), unit_factor("N m")]
    guards += [np.nan] * (3 * len(model.friction_rates) + 4 * len(model.contacts) - len(guards))
    rates = [unit_factor(units[n]) / unit_factor("s") for n in names[0]]
    powers = [unit_factor("J"), unit_factor("W"), unit_factor("W")]
    for function, factors, modes in (
        (model.module.mode_derivative, rates, (m,)),
        (model.module.guards, guards, (m,)),
        (model.module.energy, powers, (m,)),
        (model.module.outputs, outputs, ()),
    ):
        here, other = np.zeros((2, len(factors)))
        function(t, x, u, p, *modes, here)
        function(later, *scaled, *modes, other)
        known = np.isfinite(factors)
        wanted = (here * factors)[known]
        fits = np.isclose(other[known], wanted, rtol=1e-9, atol=1e-12)
        assert fits.all(), f"units of {effect.id} do not fit {function.__name__}: {fits}"
