"""The bond graph as it is drawn and tabulated in the derivation report."""

import re
from itertools import combinations

import pytest
from matplotlib.textpath import TextPath

from ptp_symbolic.platform import read_platform
from ptp_symbolic.report.derivation.bond_graph import bond_graph_section
from ptp_symbolic.report.drawing.bond_graph import PAGE, bond_graph_tikz
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.bond_graph import bond_graph
from tests.drawing.platforms import platform_of_every_kind

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


POINTS = {r"\tiny": 5.0, r"\scriptsize": 7.0, "": 9.0}  # of letters, in a document of 10 pt
PT_PER_CM = 28.45
LABEL = re.compile(r"\\node(?:\[(.*?)\])? at \((.*?),(.*?)\) \{(.*)\};")
BOND = re.compile(r"\\draw\[line width=0.5pt\] \((.*?),(.*?)\) -- \((.*?),(.*?)\);")
Box = tuple[float, float, float, float]


def on_paper(options: str, x: str, y: str, text: str) -> Box:
    """Left, bottom, right and top in cm of a label, by the letters that Matplotlib sets."""
    size = next(points for name, points in POINTS.items() if name in options)
    box = TextPath((0, 0), text.replace(r"\mathsf{", r"\mathrm{"), size).get_extents()
    width, height = box.width / PT_PER_CM, box.height / PT_PER_CM
    part = 0.0 if "anchor=west" in options else 1.0 if "anchor=east" in options else 0.5
    left, bottom = float(x) - part * width, float(y) - height / 2
    return left, bottom, left + width, bottom + height


def crosses(line: tuple[float, ...], box: Box) -> bool:
    x0, y0, x1, y1 = line
    points = ((x0 + (x1 - x0) * k / 60, y0 + (y1 - y0) * k / 60) for k in range(61))
    return any(box[0] < x < box[2] and box[1] < y < box[3] for x, y in points)


@pytest.mark.parametrize("name", [*PRESETS, "every kind"])
def test_no_label_touches_another_nor_a_bond(name: str) -> None:
    platform = platform_of_every_kind() if name == "every kind" else read_platform(name)
    picture = bond_graph_tikz(bond_graph(platform), platform.axes)
    labels = [(found[3], on_paper(*found)) for found in LABEL.findall(picture)]
    for (one, (a, b, c, d)), (other, (e, f, g, h)) in combinations(labels, 2):
        assert max(a - g, e - c, b - h, f - d) > 0.0, (one, other)
    bonds = [tuple(map(float, found)) for found in BOND.findall(picture)]
    for text, box in labels:
        assert not [line for line in bonds if crosses(line, box)], text


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
