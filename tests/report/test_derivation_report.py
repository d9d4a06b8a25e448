"""The derivation report: printed from the expressions, and LaTeX without a warning."""

import shutil
import subprocess
from pathlib import Path

import pytest

from ptp_symbolic.platform import preset_names, read_platform
from ptp_symbolic.report.derivation import has_warning, render_derivation


@pytest.mark.parametrize("name", preset_names())
def test_compiles_without_a_warning(name: str, tmp_path: Path) -> None:
    files = render_derivation(read_platform(name))
    text = files["derivation.tex"]
    assert isinstance(text, str)
    assert "Kane -- Lagrange & $0$" in text
    assert "not symmetric" not in text
    if shutil.which("pdflatex") is None:
        pytest.skip("pdflatex is not installed")
    (tmp_path / "derivation.tex").write_text(text, encoding="utf-8")
    for _ in range(2):
        subprocess.run(
            ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", "derivation.tex"],
            cwd=tmp_path, capture_output=True, check=True,
        )  # fmt: skip
    assert not has_warning((tmp_path / "derivation.log").read_text(encoding="latin-1"))
