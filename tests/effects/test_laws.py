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


@pytest.mark.parametrize("effect", [e for e in EFFECTS if e.searched], ids=lambda e: e.id)
def test_equations_are_unchanged_when_it_is_off(effect: Effect) -> None:
    platform = with_effect(effect)
    full = assemble(platform)
    bare, off = assemble(without(platform, effect)), vanishing(full, effect)
    assert off, "give one of its parameters `vanishes`, or the effect `structural=True`"
    assert effect.separating_experiment
    opened = {c.active: 1 for c in full.contacts} | {c.side: 0 for c in full.contacts}
    pairs = [
        *zip((*full.mass_matrix, *full.forcing), (*bare.mass_matrix, *bare.forcing), strict=True)
    ]
    pairs += [
        (getattr(a, word), getattr(b, word))
        for a, b in zip(full.frictions, bare.frictions, strict=False)
        for word in ("level", "breakaway")
    ]
    left, right = (sp.Matrix(side).subs(off).subs(opened) for side in zip(*pairs, strict=True))
    symbols = sorted(left.free_symbols | right.free_symbols, key=str)
    rng = np.random.default_rng(8)
    for _ in range(10):
        point = {symbol: sp.Float(rng.uniform(0.1, 1.0)) for symbol in symbols}
        a, b = (np.array(side.subs(point), dtype=float) for side in (left, right))
        assert a == pytest.approx(b, rel=1e-12, abs=1e-12)


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
    change = sum(sp.diff(stored, s) * r for s, r in zip(states, rates, strict=True))
    change += sp.diff(stored, TIME)
    parts = [change, ledger.power_in, ledger.dissipated]
    for name in reversed(list(definitions)):
        named = {sp.Symbol(name, real=True): definitions[name]}
        parts = [part.subs(named) for part in parts]
    symbols = sorted(set().union(*(part.free_symbols for part in parts)), key=str)
    function = sp.lambdify(symbols, parts, "numpy")
    for _ in range(20):
        values = admissible_values(equations, symbols, rng)
        stored, supplied, dissipated = (float(v) for v in function(*values))
        size = abs(stored) + abs(supplied) + abs(dissipated)
        assert abs(stored - supplied + dissipated) <= 1e-9 * size


def admissible_values(
    equations: Equations, symbols: list[sp.Symbol], rng: np.random.Generator
) -> list[float]:
    """Random values of `symbols`, drawn until the parameters fit each other."""
    for _ in range(1000):
        values = [value_of(equations, str(symbol), rng) for symbol in symbols]
        given = dict(zip(symbols, values, strict=True))
        if all(requirement.holds.subs(given) != sp.false for requirement in equations.requirements):
            return values
    raise AssertionError("No admissible parameters were drawn.")


def value_of(equations: Equations, name: str, rng: np.random.Generator) -> float:
    """A random value; modes are consistent with sliding forward and touching the upper face."""
    if name.startswith(("slide_", "side_", "active_")):
        return 1.0
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
    dx, other = np.zeros(len(x)), np.zeros(len(x))
    model.module.mode_derivative(0.0, x, u, p, m, dx)
    model.module.mode_derivative(0.0, *scaled, m, other)
    per_second = np.array([unit_factor(units[n]) / unit_factor("s") for n in names[0]])
    fits = np.isclose(other, dx * per_second, rtol=1e-9, atol=1e-12)
    wrong = [name for name, fit in zip(names[0], fits, strict=True) if not fit]
    assert not wrong, f"units of {effect.id} do not fit the derivatives of {wrong}"
