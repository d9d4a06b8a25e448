"""`ptp-symbolic report machines`: public data of real machines, diagnosed anew."""

import json
from pathlib import Path

import click

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
