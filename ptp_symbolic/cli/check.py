"""`ptp-symbolic check`: what a platform declares; what logs hold and can show, before a fit."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from ptp_symbolic.cli.declared import note_defaults
from ptp_symbolic.cli.lists import print_table, show_table
from ptp_symbolic.cli.progress import progress_line
from ptp_symbolic.errors import InputError

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
LEGEND = (
    "noise: its white part, rms. step: between neighbouring levels. at ends: share of the samples"
    " at the lowest or highest value. at rest: share of the time at standstill. fastest: largest"
    " change per s over a tenth of a second."
)
EVEN = 1e-4  # of a period, rms: less is rounding of the time column


@click.command()
@click.option("--platform", "source", required=True, help="Platform TOML or packaged name.")
@click.argument("logs", nargs=-1)
@click.option("--out", type=Path, help="Folder for check.html and check.json.")
@click.option("--json", "as_json", is_flag=True, help="Print check.json instead of tables.")
def check(source: str, logs: tuple[str, ...], out: Path | None, as_json: bool) -> None:
    """Print what LOGS hold, and the smallest parameter change and effect that they can show.

    The amounts are predicted by the declared model at its start values, for white noise. Without
    LOGS, print what the platform declares: states, inputs, outputs, parameters, what is missing.
    """
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.workflows.log_check import check_logs

    if not logs:
        if out is not None:
            raise InputError("`out` is for what logs show; name logs, or leave it out.")
        _check_platform(source, as_json)
        return
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


def _check_platform(source: str, as_json: bool) -> None:
    """Print a platform without logs; what is missing is refused after that."""
    from ptp_symbolic.models.committed import platform_as_written
    from ptp_symbolic.workflows.log_check import check_platform, refuse_incomplete

    platform = platform_as_written(source)
    with progress_line() as say:
        found = check_platform(platform, say)
    if as_json:
        click.echo(json.dumps(found, indent=2))
    else:
        _print_platform(found)
    refuse_incomplete(platform)


def _print_platform(found: Mapping[str, Any]) -> None:
    about = found["platform"]
    click.echo(f"{about['name']}: {about['title']}; axes {', '.join(about['axes'])}.")
    click.echo(f"Effects: {', '.join(found['effects'])}.")
    states = ", ".join(f"{s['name']} [{s['unit']}]" for s in found["states"])
    click.echo(f"States: {states}.")
    for role in ("inputs", "outputs"):
        signals = ", ".join(
            f"{s['name']} [{s['unit']}]" + (f" in column '{s['column']}'" if s["column"] else "")
            for s in found[role]
        )
        what = "Inputs" if role == "inputs" else "What sensors may measure"
        click.echo(f"{what}: {signals}.")
    lacking = [s["name"] for s in found["inputs"] if not s["column"]]
    if not any(s["column"] for s in found["outputs"]):
        lacking.append("an output")
    if lacking:
        click.echo(f"To read logs, declare under [signals] too: {', '.join(lacking)}.")
    click.echo()
    print_table(
        [
            {
                "parameter": p["name"],
                "value": "" if p["value"] is None else f"{p['value']:g}",
                "unit": p["unit"],
                "declared": p["declared"],
                "bounds": f"{p['bounds'][0]:g} to {p['bounds'][1]:g}",
                "meaning": p["meaning"],
            }
            for p in found["parameters"]
        ]
    )
    click.echo(
        "known: declared by `value`; fitted: by `start`; default: natural, not declared; missing:"
        " declare it."
    )


def _print_logs(summary: Mapping[str, Any]) -> None:
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
        show_table(signals)
    click.echo(LEGEND)
    same = summary["repeatability"]
    if same is None and len(summary["logs"]) > 1:
        click.echo("No two runs have the same inputs: how well a run repeats is not known.")
    elif same is not None:
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
    show_table(table)
