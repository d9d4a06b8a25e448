"""The derivation report: printed from the expressions, and LaTeX without a warning."""

import hashlib
import re
import shutil
import subprocess
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.models.emission import module_of
from ptp_symbolic.platform import EffectDeclaration, Platform, preset_names, read_platform
from ptp_symbolic.report.derivation import read_points, render_derivation
from ptp_symbolic.report.derivation.document import emitted, title_block
from ptp_symbolic.report.derivation.linear import linearised
from ptp_symbolic.report.derivation.operating_points import usual_points
from ptp_symbolic.report.derivation.routes import three_routes
from ptp_symbolic.report.derivation.simplification import simplified
from ptp_symbolic.report.derivation.symbols import CATALOGUE, frames, symbols
from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.report.pdf import PASSES
from ptp_symbolic.symbolic.derivation import placement
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.effects import EFFECTS
from tests.drawing.platforms import carriage, offset_platform, platform_of_every_kind
from tests.report.latex_reading import has_warning

pytestmark = pytest.mark.early

SIGNS_OF_TEX = r"50 % of $x_1$ & \alpha #2 {~^}"
PLATFORMS = {name: read_platform(name) for name in preset_names()} | {
    "axes apart, payload off both, leaning base": offset_platform(),
    "carriage": carriage(),
    "carriage on a screw": replace(
        carriage(
            ("dc_motor", "pan"),
            ("shaft_compliance", "pan"),
            ("backlash", "pan"),
            ("csvs_friction", "pan"),
        ),
        title=SIGNS_OF_TEX,
    ),
}


EVERY_RUN = ("thesis-pan-drive", "carriage on a screw")


@cache
def rendered(name: str) -> dict[str, str | bytes]:
    return render_derivation(PLATFORMS[name])


def report_of(name: str) -> str:
    return str(rendered(name)["derivation.tex"])


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The folder with the compiled report of a platform."""

    @cache
    def folder_of(name: str) -> Path:
        folder = tmp_path_factory.mktemp("report")
        compile_in(folder, rendered(name))
        return folder

    return folder_of


def compile_in(folder: Path, files: dict[str, str | bytes]) -> None:
    if shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    for name, content in files.items():
        data = content.encode() if isinstance(content, str) else content
        (folder / name).write_bytes(data)
    for _ in range(PASSES):
        subprocess.run(
            ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", "derivation.tex"],
            cwd=folder,
            capture_output=True,
            check=True,
        )


def some_of(names: Iterable[str]) -> list[Any]:
    """The platforms whose reports are compiled in every run; the others in long ones."""
    return [
        pytest.param(name, marks=() if name in EVERY_RUN else pytest.mark.long) for name in names
    ]


@pytest.mark.parametrize("name", some_of(PLATFORMS))
def test_compiles_without_a_warning(name: str, compiled: Callable[[str], Path]) -> None:
    text = report_of(name)
    assert "Kane -- Lagrange & $0$" in text
    assert "not symmetric" not in text
    assert not has_warning((compiled(name) / "derivation.log").read_text(encoding="latin-1"))


@pytest.mark.long
def test_a_platform_with_every_kind_of_effect_compiles(tmp_path: Path) -> None:
    compile_in(tmp_path, render_derivation(platform_of_every_kind()))
    assert not has_warning((tmp_path / "derivation.log").read_text(encoding="latin-1"))


def test_a_title_with_the_signs_of_tex_is_printed_as_it_is(
    compiled: Callable[[str], Path],
) -> None:
    if shutil.which("pdftotext") is None:
        pytest.skip("pdftotext is not installed")
    shown = subprocess.run(
        ["pdftotext", "-l", "1", "derivation.pdf", "-"],
        cwd=compiled("carriage on a screw"),
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert SIGNS_OF_TEX in shown


def test_an_effect_without_a_title_and_a_reference_has_its_section(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    nameless = tuple(
        replace(e, title="", reference="") if e.id == "viscous_friction" else e for e in EFFECTS
    )
    monkeypatch.setattr(placement, "catalogue", lambda: nameless)
    body = EffectDeclaration("rigid_bodies", None, None)
    friction = EffectDeclaration("viscous_friction", "pan", None)
    turntable = Platform("turntable", "Turntable", ("pan",), 9.81, (body, friction), (), ())
    text = str(render_derivation(turntable)["derivation.tex"])
    own = text[text.index(r"\subsection{Viscous\_friction, pan axis}") :]
    assert r"\texttt{viscous\_friction}; it names no reference." in own
    assert symbol_latex("b_pan") in own


@pytest.mark.parametrize("name", preset_names())
def test_every_symbol_of_the_equations_has_a_row_with_its_meaning(name: str) -> None:
    platform = read_platform(name)
    equations = assemble(platform)
    text = symbols(equations, platform)
    table = text[text.index("Variables:") :]
    modes = [str(symbol) for symbol in equations.mode_symbols]
    for symbol in [*map(str, equations.state_symbols), *modes, *(i.name for i in equations.inputs)]:
        row = re.search(rf"\${re.escape(symbol_latex(symbol))}\$ & ([^&]+) &", table)
        assert row is not None, symbol
        assert len(row[1]) > 8
        assert row[1] != "state"
    for state in equations.extra_states:
        assert escaped(state.meaning) in table
    assert "kg m" not in text
    assert "^2 &" not in text


def test_a_tilt_only_platform_describes_only_its_own_frames() -> None:
    tilt = frames(assemble(read_platform("thesis-tilt-drive")))
    assert "pan" not in tilt
    assert "tilt frame" in tilt
    assert "tilt" not in frames(assemble(read_platform("thesis-pan-drive")))


def test_values_that_the_platform_does_not_declare_are_marked() -> None:
    platform = read_platform("thesis-pan-drive")
    kept = tuple(p for p in platform.parameters if p.name != "F_v_pan")
    text = symbols(assemble(platform), replace(platform, parameters=kept))
    rows = [line for line in text.splitlines() if line.startswith("$F_{")]
    marked = [line for line in rows if CATALOGUE in line]
    assert len(marked) == 1
    assert symbol_latex("F_v_pan") in marked[0]


def test_the_final_equations_give_the_rate_of_change_of_every_state() -> None:
    equations = assemble(PLATFORMS["thesis-full"])
    final = emitted(equations, simplified(equations).base_form)
    assert final.startswith(r"\section{Final equations}")
    assert final.count(r"\dot{") == len(equations.state_symbols)


@pytest.mark.parametrize("name", some_of(preset_names()))
def test_no_page_is_nearly_empty(name: str, compiled: Callable[[str], Path]) -> None:
    if shutil.which("pdftotext") is None:
        pytest.skip("pdftotext is not installed")
    command = ["pdftotext", "-bbox", "derivation.pdf", "-"]
    boxes = subprocess.run(
        command, cwd=compiled(name), capture_output=True, text=True, check=True
    ).stdout
    for page in boxes.split("<page ")[1:]:
        height = float(re.search(r'height="([\d.]+)"', page)[1])
        words = re.findall(r'yMax="([\d.]+)">(.*?)</word>', page)
        lowest = max(float(y) for y, _ in words[:-1])  # the last word is the page number
        assert lowest > 0.25 * height


def test_axes_that_do_not_cross_are_not_said_to() -> None:
    platform = read_platform("thesis-ideal")
    added = EffectDeclaration("axis_offset", None, None)
    equations = assemble(replace(platform, effects=(*platform.effects, added)))
    text = frames(equations)
    assert "The axes cross in the origin" in frames(assemble(platform))
    assert "The axes cross" not in text
    assert r"a_{\mathrm{tilt}} & 0 & 0" in text
    assert "Kane -- Lagrange & $0$" in three_routes(equations)


def test_the_title_has_the_checksum_of_the_module_and_the_date(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    platform = read_platform("thesis-ideal")
    committed = Path("generated/ideal.py").read_text(encoding="utf-8")
    text = title_block(platform, assemble(platform))
    assert re.search(r'MODEL_HASH = "(\w+)"', committed)[1] in text
    assert hashlib.sha256(module_of(platform).encode()).hexdigest() in text
    assert "1970-01-02" in text


def test_the_machine_is_drawn_and_its_linear_models_plotted() -> None:
    files = rendered("thesis-pan-drive")
    text = str(files["derivation.tex"])
    machine = text[text.index(r"\section{The machine}") : text.index("Frames and signs")]
    assert machine.count(r"\begin{tikzpicture}") == 2  # frames, and the drive of the one axis
    assert r"\includegraphics{bode-u-pan.pdf}" in text
    assert bytes(files["bode-u-pan.pdf"]).startswith(b"%PDF")
    assert "Dry friction has no derivative at rest" in text
    equations = assemble(read_platform("thesis-pan-drive"))
    _, again = linearised(equations, usual_points(equations))
    assert again["bode-u-pan.pdf"] == files["bode-u-pan.pdf"]


def test_operating_points_can_be_chosen() -> None:
    ideal = read_platform("thesis-ideal")
    points = ["theta_tilt=-30deg,omega_pan=0.5", "theta_tilt=1rad"]
    files = render_derivation(ideal, read_points(assemble(ideal), points))
    text = str(files["derivation.tex"])
    linear = text[text.index(r"\section{Linearisation}") : text.index(r"\section{Final")]
    assert r"=-30^\circ" in linear
    assert r"=57.3^\circ" in linear
    assert "=45" not in linear


@pytest.mark.parametrize(
    ("point", "message"),
    [
        ("theta_roll=0.1", "Unknown joint angle or rate 'theta_roll'"),
        ("theta_tilt=up", "give NAME=VALUE, a number in rad"),
        ("theta_tilt=3kg", "unit 'kg'; give it in rad"),
        ("theta_tilt", "give NAME=VALUE, a number in rad"),
    ],
)
def test_an_operating_point_that_makes_no_sense_is_refused(point: str, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)):
        read_points(assemble(read_platform("thesis-payload")), [point])


def test_friction_is_linearised_sliding_forwards_everywhere_or_nowhere() -> None:
    drive = read_platform("thesis-pan-drive")
    with pytest.raises(InputError, match="give each a rate above 0, or none a rate"):
        read_points(assemble(drive), ["omega_pan=-0.1"])


def test_an_operating_point_out_of_reach_is_refused() -> None:
    drive = assemble(read_platform("thesis-tilt-drive"))
    with pytest.raises(InputError, match=r"beyond the .* give one within \["):
        read_points(drive, ["theta_tilt=120deg"])
