"""`ptp-symbolic report`: documents printed from the equations."""

import json
import shutil
from pathlib import Path

import click

from ptp_symbolic.cli.declared import note_defaults
from ptp_symbolic.cli.progress import progress_line


@click.command()
@click.option("--data", type=Path, required=True, help="Folder with the folders of the machines.")
@click.option("--out", type=Path, required=True, help="Folder for the page.")
@click.option("--json", "as_json", is_flag=True, help="Print machines.json instead of file names.")
def machines(data: Path, out: Path, as_json: bool) -> None:
    """Diagnose real machines from their raw files: machines.html and machines.json."""
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.machines import study
    from ptp_symbolic.report.machines import render_machines

    check_writable(out)
    with progress_line() as say:
        results = study.machines(data, say)
    text = json.dumps(results, indent=2) + "\n"
    files: dict[str, str | bytes] = {
        "machines.html": render_machines(results),
        "machines.json": text,
    }
    write_files_atomically(out, files)
    if as_json:
        click.echo(text, nl=False)
        return
    for name in files:
        click.echo(out / name)


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


@click.group()
def report() -> None:
    """Write a document."""


@report.command()
@click.option("--platform", "source", required=True, help="Platform TOML or packaged name.")
@click.option("--out", type=Path, required=True, help="Folder for the document.")
@click.option(
    "--at",
    "points",
    multiple=True,
    metavar="POINT",
    help="Operating point to linearise about: theta_tilt=30deg,omega_pan=0.2rad/s. Repeatable.",
)
def derivation(source: str, out: Path, points: tuple[str, ...]) -> None:
    """Write the derivation of a platform's equations in LaTeX, and as PDF with pdflatex."""
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.platform import naming_file
    from ptp_symbolic.report.derivation import read_points, render_derivation
    from ptp_symbolic.report.pdf import with_pdf
    from ptp_symbolic.symbolic.derivation.assembly import assemble

    platform = declared_platform(source)
    check_writable(out)
    with naming_file(platform):
        equations = assemble(platform)
    chosen = read_points(equations, points)
    with naming_file(platform):
        files = with_pdf(render_derivation(platform, chosen), "derivation")
    write_files_atomically(out, files)
    note_defaults(platform)
    for name in files:
        click.echo(out / name)


@report.command()
@click.argument("before")
@click.argument("after")
@click.option(
    "--diagnosis",
    type=click.Path(path_type=Path),
    help="diagnosis.json of BEFORE, or the folder that has it: the error before and after.",
)
@click.option("--out", type=Path, required=True, help="Folder for the document.")
def changes(before: str, after: str, diagnosis: Path | None, out: Path) -> None:
    """Write what AFTER adds to the platform BEFORE, in LaTeX (and PDF with pdflatex)."""
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.report.changes import render_changes, shown_of
    from ptp_symbolic.report.pdf import with_pdf
    from ptp_symbolic.workflows.result import read_diagnosis

    one, other = declared_platform(before), declared_platform(after)
    check_writable(out)
    found = None if diagnosis is None else read_diagnosis(diagnosis, one, shown_of)
    files = with_pdf(render_changes(one, other, found), "changes")
    write_files_atomically(out, files)
    for name in files:
        click.echo(out / name)


report.add_command(machines)
report.add_command(thesis)
