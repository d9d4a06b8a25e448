"""`ptp-symbolic check`: the contents of logs, and what they can show, before anything is fitted."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from ptp_symbolic.cli.declared import note_defaults
from ptp_symbolic.cli.progress import progress_line

COLUMNS = (
    "  signal",
    "unit",
    "lowest",
    "highest",
    "noise",
    "step",
    "at ends",
    "at rest",
    "fastest",
)
EVEN = 1e-4  # of a period, rms: less is rounding of the time column


@click.command()
@click.option("--platform", "source", required=True, help="Platform TOML or packaged name.")
@click.argument("logs", nargs=-1, required=True)
@click.option("--out", type=Path, help="Folder for check.html and check.json.")
@click.option("--json", "as_json", is_flag=True, help="Print check.json instead of tables.")
def check(source: str, logs: tuple[str, ...], out: Path | None, as_json: bool) -> None:
    """Print the contents of logs, and the smallest parameter change and effect they can show.

    The amounts are predicted by the declared model at its start values, for white noise.
    """
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.workflows.log_check import check_logs

    platform = declared_platform(source)
    if out is not None:
        check_writable(out)
    with progress_line() as say:
        found = check_logs(platform, logs, say)
    if out is not None:
        write_files_atomically(out, found.files)
    note_defaults(platform)
    if as_json:
        click.echo(json.dumps(found.summary, indent=2))
        return
    _print_logs(found.summary)
    _print_visible(found.summary)
    if out is not None:
        click.echo(f"Page: {out / 'check.html'}")


def _print_logs(summary: Mapping[str, Any]) -> None:
    """Noise is the white part, rms; a step is that between levels; fastest is per second."""
    from rich.console import Console
    from rich.table import Table

    for text in summary["remarks"]:
        click.echo(f"Note: {text}")
    for log in summary["logs"]:
        even = log["jitter"] < EVEN
        spread = f"periods vary by {100 * log['jitter']:.2g} % rms"
        click.echo(
            f"{log['name']}: {log['samples']} samples over {log['duration']:.4g} s at"
            f" {log['rate']:.4g} Hz; {'evenly sampled' if even else spread}, the longest period is"
            f" {log['longest_period']:.3g} s."
        )
        signals = Table(box=None, pad_edge=False, padding=(0, 1, 0, 0))
        for column in COLUMNS:
            signals.add_column(
                column, no_wrap=True, justify="left" if column[0] == " " else "right"
            )
        for signal in log["signals"]:
            signals.add_row(*_signal_cells(signal, summary["units"][signal["name"]]))
        Console().print(signals)
    same = summary["repeatability"]
    if same is None:
        click.echo("No two runs have the same inputs: its repeatability is not known.")
    else:
        pairs = ", ".join(" = ".join(pair) for pair in same["runs"])
        click.echo(f"Runs with the same inputs: {pairs}.")


def _signal_cells(signal: Mapping[str, Any], unit: str) -> list[str]:
    def cell(key: str, form: str, factor: float = 1.0, suffix: str = "") -> str:
        return "" if signal[key] is None else f"{factor * signal[key]:{form}}{suffix}"

    return [
        f"  {signal['name']}",
        unit,
        cell("lowest", ".4g"),
        cell("highest", ".4g"),
        cell("noise", ".2g"),
        cell("step", ".3g"),
        cell("at_ends", ".0f", 100.0, " %"),
        cell("resting", ".0f", 100.0, " %"),
        cell("fastest", ".3g"),
    ]


def _print_visible(summary: Mapping[str, Any]) -> None:
    from rich.console import Console
    from rich.table import Table

    if not summary["simulates"]:
        click.echo("The declared model does not simulate at its start values; change them.")
        return
    click.echo(
        "Smallest amounts that these logs can show, and of effects those that diagnose would name,"
        " if the declared model is right:"
    )
    table = Table("", "parameter", "smallest", box=None)
    rows = sorted(summary["visible"], key=lambda r: (r["effect"] is not None, r["effect"] or ""))
    for row in rows:
        size = "not visible"
        if row["smallest"] is not None:
            size = f"{row['smallest']:.2g} {row['unit']}"
        elif row["largest"] is not None:
            size = f"a limit of {row['largest']:.3g} {row['unit']} or less"
        table.add_row(row["effect"] or "declared", row["parameter"], size)
    Console().print(table)
