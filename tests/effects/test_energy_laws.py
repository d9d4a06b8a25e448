"""Energies of every effect: the ledger closes in every mode, losses only take."""

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.models import emission
from ptp_symbolic.symbolic.codegen import dynamics
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Equations
from ptp_symbolic.symbolic.effect_interface.place import active, side, slide
from ptp_symbolic.symbolic.effects import EFFECTS, Effect
from ptp_symbolic.symbolic.mechanics.kinematics import TIME
from tests.effects.bases import IDS, with_effect
from tests.effects.plain_python import as_python


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
    named = [(sp.Symbol(name, real=True), definitions[name]) for name in definitions]
    free = set().union(*(e.free_symbols for e in (*parts, *definitions.values())))
    symbols = sorted(free - {symbol for symbol, _ in named}, key=str)
    function = sp.lambdify(symbols, parts, "numpy", cse=lambda written: (named, written))
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
    model, rng = as_python(emission.emit(with_effect(effect))), np.random.default_rng(5)
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
