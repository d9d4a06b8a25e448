"""The bond graph: junctions pass on all power, elements make up the ledger, strokes follow."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.api.effect_laws import admissible_values, random_modes
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.bond_graph import BondGraph, acceleration, bond_graph
from ptp_symbolic.symbolic.derivation.causality import strokes
from ptp_symbolic.symbolic.effects import EFFECTS, Effect
from ptp_symbolic.symbolic.program import dynamics
from tests.effects.bases import IDS, with_effect

STATES = 20
MOTOR_WITH_GEAR_AND_PAYLOAD = """
[platform]
name = "pan"
axes = ["pan"]
gravity = 9.81

[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "payload"
[[effects]]
effect = "viscous_friction"
axis = "pan"
[[effects]]
effect = "dc_motor"
axis = "pan"
"""
VALUES = {  # SI units; 3 kg at 0.1 m are 0.03 kg m^2
    "J_pan": 0.02,
    "m_payload": 3.0,
    "J_z_payload": 0.0,
    "c_x_payload": 0.1,
    "c_y_payload": 0.0,
    "b_pan": 0.3,
    "L_pan": 1e-3,
    "R_pan": 2.0,
    "K_t_pan": 0.05,
    "J_motor_pan": 1e-5,
    "N_pan": 100.0,
    "omega_pan": 0.4,
    "i_pan": 1.5,
    "u_pan": 12.0,
}
# W from the first to the second, by hand. The motor turns at 40 rad/s, gives 7.5 N m at the joint
# and has 0.1 kg m^2 there; friction takes 0.12 N m: 7.38 N m / 0.15 kg m^2 = 49.2 rad/s^2.
POWERS = {
    ("voltage_pan", "winding_pan"): 12.0 * 1.5,
    ("winding_pan", "resistance_pan"): 2.0 * 1.5**2,
    ("winding_pan", "inductance_pan"): (12.0 - 3.0 - 2.0) * 1.5,
    ("winding_pan", "motor_pan"): 2.0 * 1.5,
    ("motor_pan", "rotor_pan"): 0.075 * 40.0,
    ("rotor_pan", "rotor_inertia_pan"): 0.0492 * 40.0,
    ("rotor_pan", "gear_0_pan"): 0.0258 * 40.0,
    ("gear_0_pan", "pan"): 2.58 * 0.4,
    ("pan", "bodies"): 2.46 * 0.4,
    ("pan", "viscous_friction"): 0.12 * 0.4,
}
# Where the causal stroke is, by hand: at an I, away from a C, at all bonds but one of a 1-junction.
STROKES = {
    ("voltage_pan", "winding_pan"): "winding_pan",
    ("winding_pan", "resistance_pan"): "winding_pan",
    ("winding_pan", "inductance_pan"): "inductance_pan",
    ("winding_pan", "motor_pan"): "winding_pan",
    ("motor_pan", "rotor_pan"): "rotor_pan",
    ("rotor_pan", "rotor_inertia_pan"): "rotor_pan",
    ("rotor_pan", "gear_0_pan"): "gear_0_pan",
    ("gear_0_pan", "pan"): "pan",
    ("pan", "bodies"): "bodies",
    ("pan", "viscous_friction"): "pan",
}


@pytest.fixture
def geared(tmp_path: Path) -> BondGraph:
    path = tmp_path / "pan.toml"
    path.write_text(MOTOR_WITH_GEAR_AND_PAYLOAD)
    return bond_graph(read_platform(path))


def plain(name: str) -> str:
    """The name of a node without the number that an effect's element has."""
    return name.rstrip("0123456789").rstrip("_") if name.startswith("viscous") else name


def test_powers_of_a_geared_motor_by_hand(geared: BondGraph) -> None:
    values = {sp.Symbol(n, real=True): v for n, v in VALUES.items()}
    values[sp.Symbol("alpha_pan", real=True)] = 49.2
    found = {(plain(b.tail), plain(b.head)): b.power.subs(values) for b in geared.bonds}
    assert {pair: float(power) for pair, power in found.items()} == pytest.approx(POWERS)
    for node in geared.nodes:
        assert float(geared.surplus(node).subs(values)) == pytest.approx(0.0, abs=1e-12)


def test_strokes_of_a_geared_motor_by_hand(geared: BondGraph) -> None:
    """The joint sets the speed of the rotor, whose inertia is not one of its own."""
    found = {
        (plain(b.tail), plain(b.head)): plain(b.head if b.at_head else b.tail) for b in geared.bonds
    }
    assert found == STROKES
    assert [node.name for node in geared.dependent] == ["rotor_inertia_pan"]


def test_behind_a_shaft_the_rotor_is_independent() -> None:
    assert bond_graph(read_platform("thesis-pan-drive")).dependent == ()


def test_the_linear_actuator_has_gear_screw_and_linkage_as_transformers() -> None:
    graph = bond_graph(read_platform("thesis-tilt-drive"))
    stages = [n for n in graph.nodes if n.kind in ("TF", "MTF")]
    assert [n.kind for n in stages] == ["TF", "TF", "MTF"]
    gear, lead = sp.symbols("N_tilt lead_tilt", real=True)
    assert [n.law for n in stages[:2]] == [gear, 2 * sp.pi / lead]


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_junctions_pass_on_all_power_and_elements_make_up_the_ledger(effect: Effect) -> None:
    check_powers(with_effect(effect))


@pytest.mark.parametrize("kind", ["elastic_impact", "hysteresis_friction", "hysteresis_inertia"])
def test_rigid_faces_pass_on_all_power(kind: str) -> None:
    """The torque at the faces is what the gear output lacks; the joint then lacks nothing."""
    base = read_platform("thesis-pan-drive")
    gone = {"shaft_compliance", "backlash"}
    kept = tuple(e for e in base.effects if e.effect not in gone)
    own = tuple(p for p in base.parameters if "shaft" not in p.name)
    rigid = EffectDeclaration("backlash", "pan", None, kind)
    check_powers(replace(base, effects=(*kept, rigid), parameters=own))


def check_powers(platform: Platform) -> None:
    equations, graph = assemble(platform), bond_graph(platform)
    solve = dynamics.solve_accelerations(equations)
    definitions = {sp.Symbol(n, real=True): e for n, e in solve.definitions}
    moving = zip(equations.state_symbols, dynamics.state_rates(equations, solve), strict=True)
    own = {acceleration(s): rate for s, rate in moving if s in equations.rates}
    touching = contact_torques(graph)
    expressions = [e for n in graph.nodes for e in (graph.surplus(n), power_size(graph, n.name))]
    growth = graph.motion.growth(equations.ledger.stored)
    for part, whole in (
        (growth - graph.motion.growth(graph.ledger.stored), growth),
        (graph.ledger.power_in - equations.ledger.power_in, equations.ledger.power_in),
        (graph.ledger.dissipated - equations.ledger.dissipated, equations.ledger.dissipated),
    ):
        expressions += [
            part,
            sp.Add(*map(sp.Abs, sp.Add.make_args(sp.expand(whole, power_exp=False)))),
        ]
    expressions = [e.subs(touching).subs(own) for e in expressions]
    named = list(definitions.items())
    free = set().union(*(e.free_symbols for e in (*expressions, *definitions.values())))
    symbols = sorted(free - definitions.keys(), key=str)
    function = sp.lambdify(symbols, expressions, "numpy", cse=lambda written: (named, written))
    rng = np.random.default_rng(3)
    moved = 0.0
    for _ in range(STATES):
        modes = random_modes(equations, rng)
        for contact in (c for c in equations.contacts if c.rigid):
            touch = float(rng.choice([-1.0, 1.0]))
            modes |= {str(contact.side): touch, str(contact.active): 1.0}
            modes[f"omega_gear_{contact.axis}"] = modes[f"omega_{contact.axis}"] = 0.3
            modes |= {str(m): touch for m in equations.mode_symbols if str(m).startswith("slide")}
        values = admissible_values(equations, symbols, modes, rng)
        found = np.array(function(*values), dtype=float).reshape(-1, 2)
        assert np.all(np.abs(found[:, 0]) <= 1e-10 * (found[:, 1] + 1e-9)), modes
        moved = max(moved, float(found[:, 1].max()))
    assert moved > 0.0


def power_size(graph: BondGraph, name: str) -> sp.Expr:
    """The sum of the sizes of all terms of the powers at a node."""
    own = graph.node(name).ledger
    parts = [b.power for b in graph.bonds if name in (b.tail, b.head)]
    parts += [own.power_in, own.dissipated, graph.motion.growth(own.stored)]
    return sp.Add(
        *(sp.Abs(term) for p in parts for term in sp.Add.make_args(sp.expand(p, power_exp=False)))
    )


def contact_torques(graph: BondGraph) -> dict[sp.Symbol, sp.Expr]:
    """The torque at rigid faces, from the equation of motion of the gear output."""
    found = {}
    for node in graph.nodes:
        if node.name.startswith("contact_"):
            axis = node.axis
            others = [b for b in graph.bonds if f"gear_{axis}" in (b.tail, b.head)]
            found[node.law] = sp.Add(
                *(
                    b.effort if b.head == f"gear_{axis}" else -b.effort
                    for b in others
                    if b.head != node.name
                )
            )
    return found


def test_sources_that_contradict_each_other_are_refused() -> None:
    """Two motions cannot both be prescribed at one joint."""
    kinds = {"one": "Sf", "two": "Sf", "joint": "1"}
    with pytest.raises(ValueError, match="contradicts another source"):
        strokes(kinds, [("one", "joint"), ("two", "joint")])
