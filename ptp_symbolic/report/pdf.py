"""Compile LaTeX, the same bytes for the same text."""

import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

PASSES = 3  # of pdflatex: contents, then links, then widths of long tables


def compile_pdf(files: Mapping[str, str | bytes], name: str) -> bytes | None:
    """The PDF of ``<name>.tex`` among `files`; None where pdflatex is missing or fails."""
    if shutil.which("pdflatex") is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        for path, content in files.items():
            data = content.encode() if isinstance(content, str) else content
            (Path(folder) / path).write_bytes(data)
        command = ["pdflatex", "-interaction=nonstopmode", "-no-shell-escape", f"{name}.tex"]
        # no time in the file: the same numbers give the same bytes
        environment = os.environ | {"SOURCE_DATE_EPOCH": "0", "FORCE_SOURCE_DATE": "1"}
        for _ in range(PASSES):
            done = subprocess.run(
                command, cwd=folder, capture_output=True, check=False, env=environment
            )
        pdf = Path(folder) / f"{name}.pdf"
        return pdf.read_bytes() if done.returncode == 0 and pdf.is_file() else None


def with_pdf(files: Mapping[str, str | bytes], name: str) -> dict[str, str | bytes]:
    """`files`, and the PDF of ``<name>.tex`` among them where it can be compiled."""
    pdf = compile_pdf(files, name)
    return dict(files) if pdf is None else {**files, f"{name}.pdf": pdf}
