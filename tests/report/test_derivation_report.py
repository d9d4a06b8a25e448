"""The derivation report: printed from the expressions, and LaTeX without a warning."""

import hashlib
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest

from ptp_symbolic.models.emission import module_of
from ptp_symbolic.platform import EffectDeclaration, preset_names, read_platform
from ptp_symbolic.report.derivation import has_warning, render_derivation
from ptp_symbolic.report.derivation.symbols import CATALOGUE
from ptp_symbolic.report.latex_text import escaped
from ptp_symbolic.report.pdf import PASSES
from ptp_symbolic.symbolic.codegen.latex import symbol_latex
from ptp_symbolic.symbolic.derivation.assembly import assemble


@cache
def report_of(name: str) -> str:
    return str(render_derivation(read_platform(name))["derivation.tex"])


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """The folder with the compiled report of a platform."""

    @cache
    def folder_of(name: str) -> Path:
        if shutil.which("pdflatex") is None:
            pytest.skip("pdflatex is not installed")
        folder = tmp_path_factory.mktemp(name)
        (folder / "derivation.tex").write_text(report_of(name), encoding="utf-8")
        for _ in range(PASSES):
            subprocess.run(
                ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", "derivation.tex"],
                cwd=folder,
                capture_output=True,
                check=True,
            )
        return folder

    return folder_of


@pytest.mark.parametrize("name", preset_names())
def test_compiles_without_a_warning(name: str, compiled: Callable[[str], Path]) -> None:
    text = report_of(name)
    assert "Kane -- Lagrange & $0$" in text
    assert "not symmetric" not in text
    assert not has_warning((compiled(name) / "derivation.log").read_text(encoding="latin-1"))


@pytest.mark.parametrize("name", preset_names())
def test_every_symbol_of_the_equations_has_a_row_with_its_meaning(name: str) -> None:
    platform = read_platform(name)
    equations = assemble(platform)
    text = report_of(name)
    table = text[text.index("Variables:") : text.index(r"\section{Three routes")]
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
    text = report_of("thesis-tilt-drive")
    frames = text[text.index("Frames and signs") : text.index(r"\section{Symbols}")]
    assert "pan" not in frames
    assert "tilt frame" in frames
    pan = report_of("thesis-pan-drive")
    frames = pan[pan.index("Frames and signs") : pan.index(r"\section{Symbols}")]
    assert "tilt" not in frames


def test_values_that_the_platform_does_not_declare_are_marked() -> None:
    platform = read_platform("thesis-pan-drive")
    kept = tuple(p for p in platform.parameters if p.name != "F_v_pan")
    text = str(render_derivation(replace(platform, parameters=kept))["derivation.tex"])
    rows = [line for line in text.splitlines() if line.startswith("$F_{")]
    marked = [line for line in rows if CATALOGUE in line]
    assert len(marked) == 1
    assert symbol_latex("F_v_pan") in marked[0]


def test_the_final_equations_give_the_rate_of_change_of_every_state() -> None:
    platform = read_platform("thesis-full")
    text = report_of("thesis-full")
    final = text[text.index(r"\section{Final equations}") :]
    assert final.count(r"\dot{") == len(assemble(platform).state_symbols)


@pytest.mark.parametrize("name", preset_names())
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
    platform = read_platform("thesis-payload")
    crossing = str(render_derivation(platform)["derivation.tex"])
    added = EffectDeclaration("axis_offset", None, None)
    apart = replace(platform, effects=(*platform.effects, added))
    text = str(render_derivation(apart)["derivation.tex"])
    assert "The axes cross in the origin" in crossing
    assert "The axes cross" not in text
    assert r"a_{\mathrm{tilt}} & 0 & 0" in text
    assert "Kane -- Lagrange & $0$" in text


def test_the_title_has_the_checksum_of_the_module_and_the_date(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    platform = read_platform("thesis-payload")
    committed = Path("generated/payload.py").read_text(encoding="utf-8")
    text = str(render_derivation(platform)["derivation.tex"])
    assert re.search(r'MODEL_HASH = "(\w+)"', committed)[1] in text
    assert hashlib.sha256(module_of(platform).encode()).hexdigest() in text
    assert "1970-01-02" in text
