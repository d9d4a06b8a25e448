"""The report of changes: what one platform has that another has not, and the error of both."""

import json
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

from ptp_symbolic.cli.commands import commands
from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import EffectDeclaration, ParameterDeclaration, Platform, read_platform
from ptp_symbolic.report.changes import render_changes, shown_of
from ptp_symbolic.symbolic.documents.latex import symbol_latex
from ptp_symbolic.workflows.result import read_diagnosis
from tests.report.latex_reading import has_warning
from tests.report.synthetic_diagnosis import synthetic_diagnosis


def with_cable(spring: float) -> tuple[Platform, Platform]:
    """The payload platform, and the same with a linear cable spring on tilt, in N m/rad."""
    before = read_platform("thesis-payload")
    added = EffectDeclaration("cable_spring", "tilt", None)
    value = ParameterDeclaration("k1_cable_tilt", "N m/rad", spring, True, 0.0, 10.0)
    return before, replace(
        before, effects=(*before.effects, added), parameters=(*before.parameters, value)
    )


def changes(*args: object) -> str:
    return str(render_changes(*args)["changes.tex"])  # type: ignore[arg-type]


def test_a_spring_adds_its_torque_to_its_joint_and_nothing_else() -> None:
    text = changes(*with_cable(0.37))
    terms = text[text.index("term by term") :]
    assert terms.count("Added to") == 1
    assert "New:" not in terms
    torque = symbol_latex("f_tilt")
    assert rf"\Delta {torque}" in terms
    for name in ("k1_cable_tilt", "k3_cable_tilt", "theta0_cable_tilt", "theta_tilt"):
        assert symbol_latex(name) in terms
    assert r"^{3}" in terms


def test_new_parameters_come_with_meaning_unit_and_value() -> None:
    text = changes(*with_cable(0.37))
    row = next(x for x in text.splitlines() if x.startswith(f"${symbol_latex('k1_cable_tilt')}$ &"))
    assert "linear stiffness of the cable wrap" in row
    assert r"N\,m/rad" in row
    assert "0.37" in row
    assert "Gone" not in text


def test_backwards_the_same_is_gone() -> None:
    text = changes(*reversed(with_cable(0.37)))
    assert r"Gone: \texttt{cable\_spring}" in text
    assert rf"${symbol_latex('k1_cable_tilt')}$" in text[text.index(r"\par Gone: $") :]


def test_friction_that_moves_to_the_other_side_of_a_shaft_is_said() -> None:
    before = read_platform("thesis-pan-drive")
    moved = tuple(
        replace(e, site="joint") if e.effect == "csvs_friction" else e for e in before.effects
    )
    text = changes(before, replace(before, effects=moved))
    assert r"Moved: \texttt{csvs\_friction@pan} to the joint." in text
    assert "Moved" not in changes(before, before)


def test_values_that_differ_are_told_before_and_after() -> None:
    _, before = with_cable(0.37)
    after = replace(
        before, parameters=(*before.parameters[:-1], replace(before.parameters[-1], value=0.52))
    )
    text = changes(before, after)
    row = next(x for x in text.splitlines() if x.startswith(f"${symbol_latex('k1_cable_tilt')}$ &"))
    assert re.search(r"& 0\.37 & 0\.52", row)
    assert "No equation differs" in text


def test_with_a_diagnosis_the_errors_are_those_of_the_diagnosis(tmp_path: Path) -> None:
    found = synthetic_diagnosis("explained")
    (tmp_path / "diagnosis.json").write_text(json.dumps(found), encoding="utf-8")
    platform = replace(read_platform("thesis-payload"), name=found["platform"]["name"])
    text = changes(platform, platform, read_diagnosis(tmp_path, platform, shown_of))
    totals = found["error"]["validate"]
    for stage in ("before", "after", "noise_floor"):
        assert f"{totals[stage]['total']['rmse_counts']:.3g}" in text
    assert text.index("never fitted") < text.index("& noise alone") + 200


def test_a_diagnosis_of_another_platform_is_refused(tmp_path: Path) -> None:
    (tmp_path / "diagnosis.json").write_text(json.dumps(synthetic_diagnosis("explained")))
    with pytest.raises(
        InputError, match="not of 'pan_drive'; give the platform that was diagnosed"
    ):
        read_diagnosis(tmp_path, read_platform("thesis-pan-drive"), shown_of)
    with pytest.raises(InputError, match="is no diagnosis"):
        read_diagnosis(tmp_path / "nothing.json", read_platform("thesis-pan-drive"), shown_of)


@pytest.mark.parametrize(
    "pair",
    [("pan_drive", "thesis-pan-servo"), pytest.param(("ideal", "full"), marks=pytest.mark.long)],
)
def test_the_command_writes_a_document_that_compiles(pair: tuple[str, str], tmp_path: Path) -> None:
    done = CliRunner().invoke(commands, ["report", "changes", *pair, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    if shutil.which("pdflatex") is None:
        assert not (tmp_path / "changes.pdf").exists()
        pytest.skip("pdflatex is not installed")
    assert (tmp_path / "changes.pdf").read_bytes().startswith(b"%PDF")
    command = ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", "changes.tex"]
    for _ in range(2):  # the second one knows the widths of long tables
        subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)
    assert not has_warning((tmp_path / "changes.log").read_text(encoding="latin-1"))
