"""The drawing of a platform: the declared numbers and signs, and what was added at its place."""

import math
import re
from itertools import combinations
from xml.etree import ElementTree

import numpy as np
import pytest
import sympy as sp
from matplotlib.textpath import TextPath
from scipy.spatial.transform import Rotation

from ptp_symbolic.platform import Platform, preset_names, read_platform
from ptp_symbolic.report.diagnosis import render_diagnosis
from ptp_symbolic.report.drawing import PlatformDrawing, drawn, svg_text, tikz_text
from ptp_symbolic.report.drawing.scene import Label, Scene, Stroke, placed
from ptp_symbolic.report.drawing.space import POSE, Space, projected, space_of
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.documents.latex import latex_of
from tests.drawing.platforms import (
    carriage,
    offset_platform,
    platform_of_every_kind,
    with_effects,
)
from tests.report.synthetic_diagnosis import synthetic_diagnosis


def drawing_of(platform: Platform, *marked: str) -> PlatformDrawing:
    return drawn(platform, assemble(platform), marked)


def in_space(platform: Platform) -> Space:
    return space_of(assemble(platform))


def words(scene: Scene) -> list[str]:
    return [str(item.text) for item in scene.items if isinstance(item, Label)]


def test_frames_are_turned_as_scipy_turns_them() -> None:
    base, pan, tilt = in_space(read_platform("thesis-payload")).frames
    assert np.allclose(base.axes, np.eye(3))
    assert np.allclose(pan.axes, Rotation.from_euler("z", POSE["pan"]).as_matrix())
    turned = Rotation.from_euler("ZY", [POSE["pan"], POSE["tilt"]])
    assert np.allclose(tilt.axes, turned.as_matrix())
    assert tilt.axes[2, 0] < 0.0, "a positive tilt angle lowers the boresight"


def test_the_paper_is_seen_from_above_and_outside() -> None:
    """A right-handed frame stays one: x turns towards y against the clock, and up is up."""
    (x0, y0), (x1, y1), (x2, y2) = (projected(v) for v in np.eye(3))
    assert x0 * y1 - x1 * y0 > 0.0
    assert abs(x2) < 1e-12
    assert y2 > 0.0


def test_offsets_have_their_direction_and_a_larger_one_is_drawn_larger() -> None:
    lengths, apart = [], []
    for scale in (0.5, 1.0, 3.0):
        offset = {"c_x_payload": 0.1, "c_y_payload": 0.04, "c_z_payload": 0.06, "a_tilt": 0.2}
        space = in_space(offset_platform(**{n: v * scale for n, v in offset.items()}))
        centre = next(c for c in space.centres if c.body.name == "payload")
        way = centre.frame.axes.T @ (centre.at - centre.frame.origin)
        lengths.append(np.linalg.norm(way))
        assert np.allclose(way / lengths[-1], np.array([5.0, 2.0, 3.0]) / math.sqrt(38.0))
        _, pan, tilt = space.frames
        along = pan.axes.T @ (tilt.origin - pan.origin)
        apart.append(along[0])
        assert np.allclose(along[1:], 0.0)
    assert lengths[0] < lengths[1] < lengths[2]
    assert 0.0 < apart[0] < apart[1] < apart[2]


def test_an_offset_of_zero_is_not_drawn() -> None:
    names = words(drawing_of(offset_platform(a_tilt=0.0, c_y_payload=0.0)).frames)
    assert "a_tilt" not in names
    assert "c_y_payload" not in names
    assert "c_x_payload" in names
    assert {"a_tilt", "c_y_payload"} <= {*words(drawing_of(offset_platform()).frames)}
    assert not in_space(read_platform("thesis-ideal")).centres


def test_gravity_points_down_the_page_and_the_base_leans_by_the_declared_angle() -> None:
    lean, azimuth = 0.15, 0.5
    space = in_space(offset_platform(beta_base=lean, alpha_base=azimuth))
    in_base = np.array(
        [
            math.sin(lean) * math.cos(azimuth),
            math.sin(lean) * math.sin(azimuth),
            -math.cos(lean),
        ]
    )
    assert np.allclose(space.frames[0].axes @ in_base, [0.0, 0.0, -1.0])
    assert space.lean == pytest.approx(lean)
    assert any("8.59°" in w for w in words(drawing_of(offset_platform()).frames))
    level = drawing_of(read_platform("thesis-payload")).frames
    assert not any("vertical" in w for w in words(level))


def test_a_base_that_shakes_does_not_lean() -> None:
    platform = with_effects(
        read_platform("thesis-payload"), ("base_motion", None), a_base=3.0, phi_base=1.0
    )
    space = in_space(platform)
    assert space.lean == 0.0
    assert space.shaken
    assert not in_space(read_platform("thesis-payload")).shaken


def test_a_carriage_slides_along_x_and_does_not_turn() -> None:
    base, pan = in_space(carriage()).frames
    assert np.allclose(pan.axes, base.axes)
    along = base.axes.T @ (pan.origin - base.origin)
    assert along[0] > 0.0
    assert np.allclose(along[1:], 0.0)


def machines() -> dict[str, Platform]:
    found = {name: read_platform(name) for name in preset_names()}
    found["offset"] = offset_platform()
    found["every kind"] = platform_of_every_kind()
    found["carriage"] = carriage()
    screw = (("dc_motor", "pan"), ("shaft_compliance", "pan"), ("backlash", "pan"))
    found["carriage on a screw"] = carriage(*screw)
    return found


MACHINES = machines()


@pytest.mark.parametrize("name", MACHINES)
def test_every_machine_is_drawn_with_every_effect_numbered(name: str) -> None:
    platform = MACHINES[name]
    found = drawing_of(platform)
    assert len(found.drives) == len(platform.axes)
    assert len(found.key) == len(platform.effects)
    scenes = (found.frames, *found.drives)
    written = [word for scene in scenes for word in words(scene)]
    for entry in found.key:
        assert str(entry.number) in written
        assert entry.where
    for scene in scenes:
        svg = svg_text(scene)
        ElementTree.fromstring(svg)
        colours = set(re.findall(r'(?:fill|stroke)="([^"]*)"', svg))
        assert colours <= {"none", "currentColor"}
        assert svg.count("http") == 1  # the name of the format
        assert "nan" not in svg + tikz_text(scene)


def test_what_was_added_is_marked_and_named_at_its_place() -> None:
    found = drawing_of(offset_platform(), "k1_cable_pan", "beta_base")
    marked = {e.effect: e.where for e in found.key if e.marked}
    assert marked == {"base_tilt": "base", "cable_spring": "pan joint"}
    pan, tilt = found.drives
    assert "cable wrap that pulls back" in words(pan)
    assert "base that is not level" in words(found.frames)
    assert not [i for i in tilt.items if i.marked]
    svg = svg_text(pan)
    assert re.search(r'class="mark">cable wrap that pulls back<', svg)
    assert "mark" not in svg_text(tilt)


def test_labels_lie_over_all_lines() -> None:
    scene = drawing_of(read_platform("thesis-payload")).frames
    arm = next(i for i in scene.items if isinstance(i, Label) and "c_x" in str(i.text))
    assert any(isinstance(i, Stroke) for i in scene.items[scene.items.index(arm) :])
    svg, tikz = svg_text(scene), tikz_text(scene)
    assert svg.rindex("<path") < svg.index("<text")
    assert tikz.rindex(r"\draw") < tikz.index(r"\node")


FOOTNOTE_PT, PT_PER_CM = 8.0, 28.45


def on_paper(label: Label) -> tuple[float, float, float, float]:
    """Left, bottom, right and top in cm of a label, by the letters that Matplotlib sets."""
    letters = TextPath((0, 0), f"${latex_of(sp.sympify(label.text))}$", FOOTNOTE_PT, usetex=False)
    box = letters.get_extents()
    (x, y), width, height = placed(label), box.width / PT_PER_CM, box.height / PT_PER_CM
    left = x if label.direction[0] > 0.5 else x - width / (1 if label.direction[0] < -0.5 else 2)
    return left, y - height / 2, left + width, y + height / 2


@pytest.mark.parametrize(
    "offset",
    [(0.1, 0.04, 0.06), (0.1, 0.001, 0.001), (0.01, 0.01, 0.01), (-0.1, 0.05, -0.02)],
)
def test_no_symbol_lies_over_another(offset: tuple[float, float, float]) -> None:
    """Offsets of a payload: their names were drawn over each other."""
    names = ("c_x_payload", "c_y_payload", "c_z_payload")
    scene = drawing_of(offset_platform(**dict(zip(names, offset, strict=True)))).frames
    symbols = [label for label in scene.labels if isinstance(label.text, sp.Expr)]
    assert {*names} <= {str(label.text) for label in symbols}
    for one, other in combinations(symbols, 2):
        (a, b, c, d), (e, f, g, h) = on_paper(one), on_paper(other)
        clear = max(a - g, e - c, b - h, f - d)
        assert clear > 0.0, (one.text, other.text)


def test_an_axis_without_a_drive_has_no_motor() -> None:
    driven = drawing_of(read_platform("thesis-pan-drive")).drives[0]
    bare = drawing_of(read_platform("thesis-payload")).drives[0]
    assert "M" in words(driven)
    assert "M" not in words(bare)
    assert "tau_pan" in words(bare)
    assert "u_pan" in words(driven)


def test_the_same_platform_is_drawn_the_same() -> None:
    first, second = (drawing_of(offset_platform()) for _ in range(2))
    assert svg_text(first.frames) == svg_text(second.frames)
    assert tikz_text(first.frames) == tikz_text(second.frames)


def test_the_diagnosis_page_marks_what_was_added_at_its_place() -> None:
    found = drawing_of(offset_platform(), "k1_cable_pan")
    html = render_diagnosis(synthetic_diagnosis("explained"), {}, found)
    section = html[html.index('<section id="machine">') :]
    section = section[: section.index("</section>")]
    assert "Where it sits" in section
    assert "cable wrap that pulls back (pan axis), at the pan joint." in section
    assert section.count("<svg") == 3
    assert section.count('<tr class="accepted">') == 1
    assert 'href="#machine"' in html
    declared = render_diagnosis(synthetic_diagnosis("nothing_missing"), {}, drawing_of(carriage()))
    assert "The declared machine" in declared
    assert 'id="machine"' not in render_diagnosis(synthetic_diagnosis("explained"), {})
