"""`ptp-symbolic report thesis`: everything the thesis computes, recomputed."""

import shutil
from pathlib import Path

import click

from ptp_symbolic.cli.progress import progress_line


@click.command()
@click.option("--out", type=Path, required=True, help="Folder for the report.")
@click.option("--json", "as_json", is_flag=True, help="Print thesis.json instead of file names.")
def thesis(out: Path, as_json: bool) -> None:
    """Recompute the thesis: thesis.json, figures, thesis.tex, and thesis.pdf with pdflatex."""
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.report.pdf import compile_pdf
    from ptp_symbolic.thesis.document import thesis_files

    check_writable(out)
    with progress_line() as say:
        files = thesis_files(say)
    pdf = compile_pdf(files, "thesis")
    if pdf is not None:
        files["thesis.pdf"] = pdf
    write_files_atomically(out, files)
    if pdf is None:
        found = shutil.which("pdflatex") is not None
        why = "pdflatex failed on thesis.tex" if found else "pdflatex is not installed"
        click.echo(f"No thesis.pdf: {why}.", err=True)
    if as_json:
        click.echo(files["thesis.json"], nl=False)
        return
    for name in files:
        click.echo(out / name)
