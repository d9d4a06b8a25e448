"""The bond graph as it is drawn and tabulated in the derivation report."""

import re
from itertools import combinations

import pytest

from ptp_symbolic.platform import read_platform
from ptp_symbolic.report.derivation.bond_graph import bond_graph_section
from ptp_symbolic.report.drawing.bond_graph import PAGE, bond_graph_tikz
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.bond_graph import bond_graph

NODE = re.compile(r"\\node at \((-?[\d.]+),(-?[\d.]+)\) \{(.*)\};")
PRESETS = ("thesis-full", "thesis-payload", "thesis-pan-servo", "thesis-tilt-drive")


@pytest.mark.parametrize("name", PRESETS)
def test_every_node_has_a_place_of_its_own(name: str) -> None:
    platform = read_platform(name)
    graph = bond_graph(platform)
    found = NODE.findall(bond_graph_tikz(graph, platform.axes))
    places = [(float(x), float(y)) for x, y, _ in found]
    assert len(places) == len(graph.nodes)
    nearest = min(abs(a - c) + abs(b - d) for (a, b), (c, d) in combinations(places, 2))
    assert nearest > 0.5  # cm
    assert max(x for x, _ in places) - min(x for x, _ in places) < PAGE


def test_the_pan_drive_is_drawn_as_the_field_draws_it() -> None:
    """Source, winding, gyrator, rotor, transformer, gear output, shaft, joint: one line."""
    graph = bond_graph(read_platform("thesis-pan-servo"))
    found = NODE.findall(bond_graph_tikz(graph, ("pan",)))
    line = sorted((float(x), text) for x, y, text in found if float(y) == 0.0)
    letters = [re.sub(r"[^A-Za-z01].*", "", text.removeprefix(r"$\mathsf{")) for _, text in line]
    assert letters == ["MSe", "1", "GY", "1", "TF", "1", "0", "1", "I"]


def test_the_powers_of_the_bonds_make_up_the_ledger() -> None:
    """The two voltages supply; windings, rotor, shaft, friction of gear, screw and joints lose."""
    platform = read_platform("thesis-full")
    text = bond_graph_section(platform, assemble(platform))
    graph = bond_graph(platform)
    words = {
        "in": {"voltage_pan", "voltage_tilt"},
        "diss": {
            *("resistance_pan", "resistance_tilt", "rotor_friction_tilt", "damper_pan"),
            *("friction_gear_pan", "friction_tilt", "viscous_friction"),
        },
    }
    for part, names in words.items():
        (line,) = re.findall(rf"P_\{{\\mathrm\{{{part}\}}\}} = (.*?) (?:\\\\|\\end)", text)
        numbers = [int(n) for n in re.findall(r"e_\{(\d+)\}", line)]
        ends = {e for n in numbers for e in (graph.bonds[n - 1].tail, graph.bonds[n - 1].head)}
        elements = {re.sub(r"_\d+$", "", e) for e in ends if graph.node(e).kind not in ("0", "1")}
        assert elements == names
    assert "In derivative causality: rotor inertia of the tilt motor." in text
