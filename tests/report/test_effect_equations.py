"""What an added effect does to the equations: no effect of the catalogue without an equation."""

import shutil
import subprocess
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from ptp_symbolic.models import variants
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.report.diagnosis import render_diagnosis
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.documents.effect_equations import effect_equations
from ptp_symbolic.symbolic.effect_interface.place import Place
from ptp_symbolic.symbolic.effects import EFFECTS
from ptp_symbolic.workflows.write_up import equations_tex
from tests.report.latex_reading import has_warning
from tests.report.synthetic_diagnosis import synthetic_diagnosis

PLATFORMS = Path(__file__).parent.parent / "platforms"
SEARCHED = [effect.id for effect in EFFECTS if effect.searched]
LAWS = (
    "csvs_friction",
    "direction_dependent_friction",
    "load_dependent_friction",
    "position_dependent_friction",
    "rate_dependent_breakaway",
)


@cache
def platforms() -> tuple[Platform, ...]:
    pan, two = (read_platform(PLATFORMS / f"fieldlog_{n}.toml") for n in ("pan", "two_axis"))
    bare = replace(
        pan,
        effects=tuple(e for e in pan.effects if e.effect not in ("viscous_friction", "backlash")),
        parameters=tuple(p for p in pan.parameters if p.name not in ("b_pan", "gap_pan")),
    )
    return pan, bare, two, read_platform("thesis-full")


@cache
def equations_of(effect: str) -> tuple[list[dict[str, Any]], EffectDeclaration]:
    for platform in platforms():
        for found in variants.candidate_effects(platform):
            if found.effect == effect:
                extended = replace(platform, effects=(*platform.effects, found))
                return effect_equations(extended, effect, found.axis), found
    raise AssertionError(f"no platform takes {effect}")


@pytest.mark.parametrize("effect", SEARCHED)
def test_every_effect_that_can_be_added_shows_its_equation(effect: str) -> None:
    rows, placed = equations_of(effect)
    assert rows
    for row in rows:
        assert all(row[key].strip() for key in ("title", "latex", "text", "mathml"))
    own = next(e for e in EFFECTS if e.id == effect)
    assert any(
        p.name.format(axis=placed.axis) in row["text"]
        for row in rows
        for p in own.parameters_at(Place(("pan", "tilt"), placed.axis, None, frozenset()))
    )


@pytest.mark.parametrize("effect", LAWS)
def test_a_friction_law_is_shown_with_all_its_branches_and_the_torque_it_acts_against(
    effect: str,
) -> None:
    titles = " | ".join(row["title"] for row in equations_of(effect)[0])
    for part in ("sliding:", "sticking:", "breakaway:", "the torque on omega_", "in whole"):
        assert part in titles
    law = next(r for r in equations_of(effect)[0] if r["title"].startswith("sliding:"))
    assert "exp(" in law["text"]
    assert "slide_" in law["text"]


def test_the_cable_spring_is_printed_as_it_was_written() -> None:
    rows, _ = equations_of("cable_spring")
    added = next(row for row in rows if row["title"] == "added to the torque on omega_pan")
    assert "**3" in added["text"]
    assert "3*" not in added["text"].replace("**3", "")


@pytest.mark.parametrize("effect", SEARCHED)
def test_the_formulas_pass_the_filter_of_the_page_and_wrap_between_terms(effect: str) -> None:
    rows, _ = equations_of(effect)
    html = render_diagnosis({**synthetic_diagnosis("explained"), "equations": rows}, {})
    assert html.count('<p class="formula">') == len(rows)
    assert html.count("<math") == sum(len(row["mathml"].splitlines()) for row in rows)


def test_equations_tex_compiles_without_a_warning(tmp_path: Path) -> None:
    rows = [row for effect in SEARCHED for row in equations_of(effect)[0]]
    machine = assemble(read_platform("thesis-pan-drive"))
    values = {"F_s_pan": {"value": 0.5, "ci95": [0.4, 0.6], "unit": "N m"}}
    text = equations_tex(rows, [{"effect": "csvs_friction", "parameters": values}], machine)
    assert r"$F_{\mathrm{s,pan}}$ & static (breakaway) friction torque" in text
    assert r"0.5 & [0.4, 0.6]" in text
    assert "omega\\_pan" not in text  # symbols in headings are printed as in formulas
    assert text.count("\\[") == len(rows)
    if shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    (tmp_path / "equations.tex").write_text(text, encoding="utf-8")
    subprocess.run(
        ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", "equations.tex"],
        cwd=tmp_path,
        capture_output=True,
        check=True,
    )
    log = (tmp_path / "equations.log").read_text(encoding="latin-1")
    assert not has_warning(log), [x for x in log.splitlines() if "full" in x]
