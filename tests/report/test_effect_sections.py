"""The section of an effect in the derivation report: its law, drawing, power and additions."""

import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from ptp_symbolic.platform import read_platform
from ptp_symbolic.report.derivation import effects as effects_module
from ptp_symbolic.report.derivation.curves import PACKAGES
from ptp_symbolic.report.derivation.effects import effect_section
from ptp_symbolic.report.derivation.power import judged
from ptp_symbolic.report.latex_equations import displayed_changes
from ptp_symbolic.report.latex_text import PREAMBLE
from ptp_symbolic.symbolic.derivation.assembly import assemble
from ptp_symbolic.symbolic.derivation.equations import Ledger
from ptp_symbolic.symbolic.documents.comparison import Change
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.symbolic.documents.laws import laws
from ptp_symbolic.symbolic.documents.statements import Statement, statements
from ptp_symbolic.symbolic.effects import EFFECTS, Effect
from tests.effects.bases import IDS
from tests.report.latex_reading import has_warning
from tests.report.sections import law_of, section

ZERO = sp.Integer(0)
PAN = "thesis-pan-drive"


def curves(text: str) -> list[tuple[str, np.ndarray]]:
    """Style and points [n, 2] of every line that a section draws."""
    found = re.findall(r"\\addplot\[([^]]*)\] coordinates \{([^}]*)\}", text)
    return [
        (
            style,
            np.array([[float(n) for n in pair.split(",")] for pair in points[1:-1].split(") (")]),
        )
        for style, points in found
    ]


@pytest.mark.parametrize("effect", EFFECTS, ids=IDS)
def test_every_effect_has_its_title_its_reference_and_a_word_on_its_power(effect: Effect) -> None:
    text = section(effect.id)
    law = law_of(effect.id)[0]
    assert law.effect.title[1:] in text
    assert rf"\texttt{{{effect.id}}}".replace("_", r"\_") in text
    assert re.search(r"dissipates|feed energy|conservative|neither stores|in their ledger", text)
    if effect.dissipative:
        assert "only dissipates" in text


@pytest.mark.long
def test_all_sections_compile_without_a_warning(tmp_path: Path) -> None:
    if shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    parts = [PREAMBLE, PACKAGES, r"\begin{document}\section{Effects}", *map(section, IDS)]
    text = "\n\n".join([*parts, r"\end{document}"])
    (tmp_path / "effects.tex").write_text(text, encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", "effects.tex"]
    subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)
    assert not has_warning((tmp_path / "effects.log").read_text(encoding="latin-1"))


def test_no_effect_is_named_by_the_report() -> None:
    folder = Path(effects_module.__file__).parent
    for path in folder.glob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert not [name for name in IDS if re.search(rf"['\"]{name}['\"]", text)], path.name


@pytest.mark.parametrize(
    ("effect", "only_dissipates"),
    [
        ("viscous_friction", True),
        ("csvs_friction", True),
        ("quadratic_drag", True),
        ("maxwell_slip_friction", True),
        ("lugre_friction", True),
        ("constant_torque", None),
        ("dc_motor", False),
        ("cable_spring", None),
        ("cogging", None),
    ],
)
def test_what_takes_energy_out_is_told_from_what_may_feed_it(
    effect: str, only_dissipates: bool | None
) -> None:
    law, _, equations = law_of(effect)
    assert judged(law, law.ledger, equations).only_dissipates is only_dissipates


def test_friction_that_drives_the_machine_in_one_direction_is_not_called_dissipative() -> None:
    law, _, equations = law_of("csvs_friction")
    (_, friction), *_ = law.frictions
    turned = law.ledger.dissipated - 4 * friction.rate * sp.Symbol("F_c_pan", real=True)
    assert judged(law, law.ledger, equations).only_dissipates
    assert not judged(law, Ledger(ZERO, ZERO, turned), equations).only_dissipates


def test_the_drawn_friction_is_the_stribeck_curve() -> None:
    platform = read_platform(PAN)
    law = next(law for law in laws(platform) if law.effect.id == "csvs_friction")
    value = {p.name: p.value for p in platform.parameters}
    text = effect_section(law, platform, assemble(platform))
    sliding = [points for style, points in curves(text) if style == "black"]
    assert len(sliding) == 2
    for points in sliding:
        rate, torque = np.abs(points).T
        decay = np.exp(-((rate / value["v_s_pan"]) ** 2))
        level = value["F_c_pan"] + (value["F_s_pan"] - value["F_c_pan"]) * decay
        np.testing.assert_allclose(torque, level + value["F_v_pan"] * rate, rtol=1e-3)
        assert rate.max() >= 3 * value["v_s_pan"]


def test_a_slip_element_is_drawn_as_a_loop_that_ends_at_the_torques_at_which_all_slip() -> None:
    platform = law_of("maxwell_slip_friction")[2]
    value = {p.name: p.default for p in platform.parameters}
    ((_, points),) = curves(section("maxwell_slip_friction"))
    ends = sum(value[f"F_slip{k}_pan"] for k in (1, 2, 3))
    np.testing.assert_allclose([points[:, 1].min(), points[:, 1].max()], [-ends, ends], rtol=0.02)
    middle = points[np.abs(points[:, 0]) < 0.2 * points[:, 0].max(), 1]
    assert np.ptp(middle) > ends  # there and back are apart


def test_the_dead_zone_is_drawn_flat_within_half_the_gap_and_stiff_beyond() -> None:
    platform = read_platform(PAN)
    law = next(law for law in laws(platform) if law.effect.id == "backlash")
    equations = assemble(platform)
    value = {p.name: p.default for p in equations.parameters}
    ((_, points),) = curves(effect_section(law, platform, equations))
    apart, torque = points.T
    beyond = np.sign(apart) * np.maximum(np.abs(apart) - value["gap_pan"] / 2, 0.0)
    np.testing.assert_allclose(torque, value["k_shaft_pan"] * beyond, atol=0.01)


def test_what_viscous_friction_adds_is_its_torque_on_its_joint_alone() -> None:
    text = section("viscous_friction")
    added = text[text.index("Added to") :]
    assert added.count("Added to") == 1
    rate, friction = symbol_latex("omega_pan"), symbol_latex("b_pan")
    assert rf"\Delta {symbol_latex('f_pan')} ={{}}& - {friction} {rate}" in added


def test_symbols_that_differ_are_printed_as_different_letters() -> None:
    for effect in IDS:
        law, _, equations = law_of(effect)
        rows = [*statements(equations), *law.rows]
        names = {str(s) for row in rows for s in row.left.free_symbols | row.right.free_symbols}
        names |= {p.name for p in equations.parameters} | set(map(str, equations.state_symbols))
        assert len({symbol_latex(name) for name in names}) == len(names), effect


def test_an_effect_that_vanishes_as_declared_is_drawn_at_the_start_of_a_search() -> None:
    law, platform, equations = law_of("quadratic_drag")
    assert "As declared it vanishes" in section("quadratic_drag")
    parameters = tuple(
        replace(p, default=0.5) if p.name == "c_drag_pan" else p for p in equations.parameters
    )
    there = effect_section(law, platform, replace(equations, parameters=parameters))
    assert "As declared it vanishes" not in there
    ((_, points),) = curves(there)
    rate, torque = points.T
    np.testing.assert_allclose(torque, -0.5 * rate * np.abs(rate), atol=1e-4)


def test_a_sum_of_many_terms_stands_once_and_is_named_after() -> None:
    """Where all equations stand in a section, and else, as between two machines, in full."""
    long = sp.Add(*(sp.Symbol(f"c_{k}") * sp.Symbol(f"w_{k}") for k in range(20)))
    short = sp.Symbol("c_1") + sp.Symbol("w_1")
    changes = [
        Change(Statement(("term", "T_load_tilt"), "T_load_tilt by its name", ZERO, long), None),
        Change(Statement(("term", "J_load_tilt"), "J_load_tilt by its name", ZERO, short), None),
    ]
    text = displayed_changes(changes, "Equations of motion")
    assert "by its name, as in section Equations of motion." in text
    assert "w_{\\mathrm{7}}" not in text and "w_{7}" not in text
    assert text.count(r"\begin{align}") == 1
    assert displayed_changes(changes).count(r"\begin{align}") == 2
