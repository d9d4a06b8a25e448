"""The report of the thesis: complete, readable by machine, and LaTeX without a warning."""

import json
import re
import shutil
import subprocess
from collections import Counter
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from click.testing import CliRunner

from ptp_symbolic.cli.report import thesis
from ptp_symbolic.platform import read_platform
from ptp_symbolic.report.pdf import compile_pdf
from ptp_symbolic.thesis import document
from ptp_symbolic.thesis.chapter_figures import all_figures
from ptp_symbolic.thesis.errata import ERRATA
from ptp_symbolic.thesis.figures import CURVES, STYLE, drawn
from ptp_symbolic.thesis.response_figures import friction_of
from ptp_symbolic.thesis.responses import response
from ptp_symbolic.thesis.wording import text_latex
from tests.report.latex_reading import has_warning

pytestmark = [pytest.mark.early, pytest.mark.long]

FIGURES = (
    *(f"fig_2_{n}" for n in (*range(7, 17), 18, 19)),
    *(f"fig_5_{n}" for n in (1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 14, 15, 16, 17, 18)),
    "fig_4_3",
    "fig_4_6",
)


@pytest.fixture(scope="module")
def files() -> dict[str, str | bytes]:
    return document.thesis_files()


@pytest.fixture(scope="module")
def rows(files: dict[str, str | bytes]) -> list[dict[str, object]]:
    content = json.loads(files["thesis.json"])
    assert content["schema_version"] == 2
    return list(content["items"])


def test_a_round_trip_is_never_counted_as_computed(
    files: dict[str, str | bytes], rows: list[dict[str, object]]
) -> None:
    kinds = Counter(str(r["kind"]) for r in rows)
    fitted = [r for r in rows if re.fullmatch(r"table_4_1\..*|table_4_2\..*_\d", str(r["id"]))]
    assert len(fitted) == kinds["round_trip"] == 2 * 4 + 2 * 5 * 5
    assert {r["kind"] for r in fitted} == {"round_trip"}
    content = json.loads(files["thesis.json"])
    summary = content["summary"]
    assert {kind: counts["items"] for kind, counts in summary.items()} == kinds
    for kind in ("computed", "round_trip"):
        own = [r for r in rows if r["kind"] == kind]
        assert summary[kind]["agree"] == sum(r["agrees"] is True for r in own)
        assert sum(summary[kind].values()) == 2 * len(own)
    for row in rows:
        nothing = row["kind"] in ("nothing_printed", "measurements_not_printed")
        assert (row["agrees"] is None) == nothing or row["kind"] == "erratum", row["id"]
        assert (row["kind"] == "nothing_printed") == (row["printed"] is None), row["id"]
    # the headline of the document says the same
    text = str(files["thesis.tex"])
    assert f"{summary['round_trip']['agree']} recovered" in text
    assert f"{summary['computed']['agree']} agree" in text


def test_notes_say_what_was_computed(rows: list[dict[str, object]]) -> None:
    """Section 5.4 has another shaft and friction than the preset; 0.007 has one digit, not 0.01."""
    row = {str(r["id"]): r for r in rows}
    for name in ("pan", "tilt"):
        own = row[f"fig_5_{1 if name == 'pan' else 2}.{name}_coupling_amplitude"]
        assert f"{own['computed']:.2f}" == "0.01"
        assert "two decimals" in str(own["check"])
    preset = read_platform("thesis-pan-drive")
    printed = {"d_shaft_pan": 0.0, "F_c_pan": 0.2267, "F_s_pan": 0.5578, "F_v_pan": 13.5844}
    assert all(p.value != printed.get(p.name) for p in preset.parameters)
    said = str(row["section_5_4.step.final_angle"]["check"])
    assert "omega > 0 in both directions" in said
    assert "d_shaft_pan = 0" in said
    assert "omega < 0" in str(row["section_5_4.step_backward.final_angle"]["check"])


def test_every_picture_says_what_its_curves_are(
    files: dict[str, str | bytes], rows: list[dict[str, object]]
) -> None:
    figures = json.loads(files["thesis.json"])["figures"]
    assert {f"{f['name']}.pdf" for f in figures} == {n for n in files if n.endswith(".pdf")}
    trips = {f["name"] for f in figures if f["kind"] == "round_trip"}
    assert trips == {"fig_4_3", "fig_4_6", "fig_4_6_profile"}
    assert {f["kind"] for f in figures} == {"computed", "round_trip"}
    assert str(files["thesis.tex"]).count(r"\emph{Round trip.}") == len(trips)
    known = {r["id"] for r in rows}
    assert all(set(f["items"]) <= known for f in figures)
    assert len(next(f for f in figures if f["name"] == "fig_5_10")["items"]) == 6


def test_curves_of_a_panel_differ_without_colour_and_legends_fit() -> None:
    for figure in (f for group in all_figures().values() for f in group):
        with matplotlib.rc_context(STYLE):
            page = drawn(figure)
            page.canvas.draw()
        for axes in page.axes:
            named = [line for line in axes.lines if not line.get_label().startswith("_")]
            looks = {(line.get_linestyle(), line.get_marker()) for line in named}
            assert len(looks) == len(named), figure.name
            # every curve of every figure is drawn from the one cycle, in its order
            for line, (colour, dash, marker) in zip(named, CURVES, strict=False):
                assert (line.get_color(), line.get_linestyle()) == (colour, dash), figure.name
                assert len(named) == 1 or line.get_marker() == marker, figure.name
            legend = axes.get_legend()
            if legend is not None:
                box = legend.get_window_extent()
                assert box.x0 >= 0.0 and box.x1 <= page.bbox.x1, figure.name


def test_every_erratum_is_there_and_settled(rows: list[dict[str, object]]) -> None:
    errata = {r["erratum"]: r for r in rows if r["settled"] is not None}
    assert sorted(errata) == sorted(ERRATA) == list(range(1, 33))
    assert [n for n, r in errata.items() if not r["settled"]] == []
    assert all(r["agrees"] is False and r["computed"] is not None for r in errata.values())


def test_every_estimation_has_its_standard_deviations_and_correlations(
    files: dict[str, str | bytes],
) -> None:
    content = json.loads(files["thesis.json"])
    found = {(e["table"], e["direction"], e["test"]): e for e in content["estimates"]}
    directions = ("positive", "negative")
    tests = {("table_4_2", d, n) for d in directions for n in range(1, 6)}
    assert set(found) == tests | {("table_4_1", d, None) for d in directions}
    for (table, *_), estimate in found.items():
        names = [p["name"] for p in estimate["parameters"]]
        assert names == ["J"] * (table == "table_4_2") + ["F_c", "F_s", "v_s", "F_v"]
        assert np.linalg.eigvalsh(estimate["correlation"]).min() > 0.0
        for p in estimate["parameters"]:
            assert p["unit"] and p["fisher_standard_deviation"] > 0.0
            assert p["lower_bound"] <= p["estimated"] <= p["upper_bound"]
            assert p["on_bound"] == (p["name"] == "J"), p
    # by hand: 7.203, 7.511, 8.1, 7.81, 6.6 N m
    assert content["spread_of_tests"]["positive"]["F_s"] == pytest.approx(0.578618, abs=1e-6)


def test_every_item_says_what_it_is(rows: list[dict[str, object]]) -> None:
    names = [r["id"] for r in rows]
    assert len(names) == len(set(names))
    for row in rows:
        assert row["title"] and row["check"]
        assert isinstance(row["unit"], str)
        if row["agrees"] is None:
            assert row["printed"] is None or row["computed"] is None
        else:
            assert row["printed"] is not None and row["computed"] is not None
        if row["agrees"] is False:
            assert row["erratum"] in ERRATA, row["id"]


def test_every_part_of_the_thesis_has_items(rows: list[dict[str, object]]) -> None:
    names = " ".join(str(r["id"]) for r in rows)
    for part in (
        "table_2_2.",
        "eq_3_8.",
        "appendix_a.",
        "table_4_1.",
        "table_4_2.",
        "section_4_3.",
        "section_5_4.",
        *(f"fig_5_{n}." for n in (1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 14)),
    ):
        assert part in names, part


def test_every_figure_is_there_in_both_formats(files: dict[str, str | bytes]) -> None:
    for name in FIGURES:
        assert bytes(files[f"{name}.pdf"]).startswith(b"%PDF")
        assert bytes(files[f"{name}.png"]).startswith(b"\x89PNG")
    included = re.findall(r"\\includegraphics\[[^]]*\]\{([^}]*)\}", str(files["thesis.tex"]))
    assert set(included) == {n for n in files if n.endswith(".pdf")}


def test_the_document_cites_the_thesis_and_shows_no_internal_name(
    files: dict[str, str | bytes], rows: list[dict[str, object]]
) -> None:
    text = str(files["thesis.tex"])
    assert text.count("Multi-Domain Modeling of Pan Tilt Platform") == 1
    assert "August 2013" in text
    without_figures = re.sub(r"\\includegraphics\[[^]]*\]\{[^}]*\}", "", text)
    plain = without_figures.replace(r"\allowbreak{}", "").replace(r"\_", "_")
    assert [r["id"] for r in rows if str(r["id"]) in plain] == []


def test_every_row_names_the_note_that_says_how_it_was_computed(
    files: dict[str, str | bytes], rows: list[dict[str, object]]
) -> None:
    sections = str(files["thesis.tex"]).split(r"\section{")
    for part in dict.fromkeys(str(r["part"]) for r in rows if r["settled"] is None):
        own = next(s for s in sections if s.startswith(document.escaped(part)))
        notes = set(re.findall(r"\\item\[(\w)\]", own))
        used = re.findall(r" & (\w) \\\\$", own, re.MULTILINE)
        listed = [r for r in rows if r["part"] == part and not str(r["id"]).startswith("eq_3_8")]
        assert len(used) == len(listed)
        assert set(used) == notes
        assert len(notes) == len({r["check"] for r in listed})


def test_friction_of_the_pan_drive_by_hand() -> None:
    run = response("trapezoid")
    friction, rate = friction_of(run), run["omega_gear_pan"]
    dry = 0.2267 + (0.5578 - 0.2267) * np.exp(-((rate / 0.0159) ** 2))
    sliding = rate > 0.0
    assert friction[sliding] == pytest.approx((dry + 13.5844 * rate)[sliding], abs=1e-6)
    # at rest in the gap it is the motor's torque, up to the breakaway
    resting = (rate == 0.0) & (run.t < 0.1)
    assert friction[resting] == pytest.approx(36.2 * run["i_pan"][resting], abs=1e-9)


def test_no_page_is_half_empty(files: dict[str, str | bytes], tmp_path: Path) -> None:
    if shutil.which("pdflatex") is None or shutil.which("pdftoppm") is None:
        pytest.skip("pdflatex or pdftoppm is not installed")
    pdf = compile_pdf(files, "thesis")
    assert pdf is not None
    (tmp_path / "thesis.pdf").write_bytes(pdf)
    command = ["pdftoppm", "-r", "20", "-gray", "thesis.pdf", "page"]
    subprocess.run(command, cwd=tmp_path, check=True)
    pages = [filled(path) for path in sorted(tmp_path.glob("page-*.pgm"))]
    assert min(pages[:-1]) > 0.6, pages


def filled(path: Path) -> float:
    """How far down a page is printed, its number apart, as a share of its height."""
    header, data = path.read_bytes().split(b"255\n", 1)
    width, height = map(int, header.split()[1:3])
    rows = np.frombuffer(data, np.uint8).reshape(height, width)[: int(0.92 * height)]
    return float(np.flatnonzero(rows.min(axis=1) < 200)[-1]) / height


def test_compiles_without_a_warning(files: dict[str, str | bytes], tmp_path: Path) -> None:
    if shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    for name, content in files.items():
        data = content.encode() if isinstance(content, str) else content
        (tmp_path / name).write_bytes(data)
    for _ in range(2):
        subprocess.run(
            ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", "thesis.tex"],
            cwd=tmp_path,
            capture_output=True,
            check=True,
        )
    assert not has_warning((tmp_path / "thesis.log").read_text(encoding="latin-1"))


@pytest.mark.parametrize(
    ("text", "latex"),
    [
        ("off by 2e-07 rad", r"off by $2\cdot 10^{-7}$ rad"),
        ("F_s < 5 % of kg m^2", r"$F_{\mathrm{s}}$ $<$ 5\,\% of kg m$^{2}$"),
        ("theta', psi', b_7", r"$\theta$', $\psi$', $b_{\mathrm{7}}$"),
        ("a_long_word & 0.5", r"$a_{\mathrm{long,word}}$ \& 0.5"),
    ],
)
def test_names_become_formulas(text: str, latex: str) -> None:
    assert text_latex(text) == latex


def test_the_command_writes_everything_and_says_when_there_is_no_pdf(
    files: dict[str, str | bytes], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(document, "thesis_files", lambda progress: dict(files))
    monkeypatch.setattr(shutil, "which", lambda name: None)
    done = CliRunner().invoke(thesis, ["--out", str(tmp_path / "report")])
    assert done.exit_code == 0
    assert "No thesis.pdf: pdflatex is not installed." in done.stderr
    written = {path.name for path in (tmp_path / "report").iterdir()}
    assert written == set(files)


def test_the_command_refuses_a_file_as_its_folder(tmp_path: Path) -> None:
    taken = tmp_path / "taken"
    taken.write_text("")
    done = CliRunner().invoke(thesis, ["--out", str(taken)])
    assert done.exit_code != 0
    assert "is not a folder" in str(done.exception)
