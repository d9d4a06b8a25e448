"""`ptp-symbolic experiment`: the input that separates effects, or determines a parameter best."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from ptp_symbolic.cli.declared import note_defaults
from ptp_symbolic.cli.diagnose import SeveralValues
from ptp_symbolic.cli.lists import show_table
from ptp_symbolic.cli.progress import progress_line
from ptp_symbolic.cli.simulate import initial_states
from ptp_symbolic.errors import InputError


@click.command(cls=SeveralValues)
@click.option("--platform", "source", required=True, help="Platform TOML or packaged name.")
@click.option("--diagnosis", type=Path, help="Folder of a diagnosis that ended with a group.")
@click.option("--between", multiple=True, help="Effects to separate, such as cogging@pan.")
@click.option(
    "--parameter", "parameters", multiple=True, help="Free parameters to determine better."
)
@click.option("--train", multiple=True, help="Logs or folders recorded so far.")
@click.option(
    "--limit",
    "limits",
    multiple=True,
    help="Of an input, state or output: NAME=HIGH or NAME=LOW..HIGH with a unit, such as"
    " 'u_pan=12 V' or theta_pan=-90..90deg.",
)
@click.option("--duration", type=float, default=10.0, help="Seconds; default 10.")
@click.option("--period", type=float, help="Seconds between samples; default that of the logs.")
@click.option(
    "--initial", multiple=True, help="State at the start in SI, or with its unit: STATE=VALUE."
)
@click.option("--tries", type=int, default=240, help="Inputs to try; default 240.")
@click.option("--seed", type=int, default=1, help="Of the search; default 1.")
@click.option("--out", type=Path, required=True, help="Folder for the results.")
@click.option("--json", "as_json", is_flag=True, help="Print experiment.json instead of tables.")
def experiment(
    source: str,
    diagnosis: Path | None,
    between: tuple[str, ...],
    parameters: tuple[str, ...],
    train: tuple[str, ...],
    limits: tuple[str, ...],
    duration: float,
    period: float | None,
    initial: tuple[str, ...],
    tries: int,
    seed: int,
    out: Path,
    as_json: bool,
) -> None:
    """Design the run that separates alternative effects, or determines a parameter best.

    Writes input.csv, ready to play and for `simulate --input`, experiment.json and experiment.png.
    """
    from ptp_symbolic import load
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.workflows.experiment_design import Request, design_experiment
    from ptp_symbolic.workflows.experiment_group import group_of

    platform = declared_platform(source)
    check_writable(out)
    known: Mapping[str, float] = {}
    if diagnosis is not None:
        group, known = group_of(diagnosis, platform)
        if not (between or parameters or group):
            raise InputError(
                f"{diagnosis}: this diagnosis ended without a group; say by --between or"
                " --parameter what the experiment is for."
            )
        between = between or (() if parameters else group)
    states = initial_states(load(source), initial) if initial else {}
    request = Request(between, parameters, limits, duration, period, states, known, tries, seed)
    with progress_line() as say:
        found = design_experiment(platform, request, train, say)
    write_files_atomically(out, found.files)
    note_defaults(platform)
    if as_json:
        click.echo(json.dumps(found.summary, indent=2))
        return
    _print_input(found.summary)
    _print_separation(found.summary)
    _print_parameters(found.summary)
    click.echo(f"Play {out / 'input.csv'}; see {out / 'experiment.png'}.")


def _print_input(summary: Mapping[str, Any]) -> None:
    for text in summary["remarks"]:
        click.echo(f"Note: {text}")
    given = summary["input"]
    click.echo(
        f"Input: {given['kind']} of {given['duration']:g} s, a sample every {given['period']:g} s."
    )
    for name, s in given["signals"].items():
        low, high = s["limits"]
        click.echo(
            f"  {name}: {s['lowest']:.4g} to {s['highest']:.4g} {s['unit']}, allowed {low:.4g} to"
            f" {high:.4g}"
        )


def _print_separation(summary: Mapping[str, Any]) -> None:
    from rich.table import Table

    if not summary["separation"]:
        return
    table = Table("if it is", "sigmas from", "logs", "run", "both", "share of error", box=None)
    pairs = summary["separation"]
    for pair in pairs:
        sigmas = (f"{pair[key]:.3g}" for key in ("before", "run", "after"))
        shares = " to ".join(f"{100.0 * pair[k]:.0f} %" for k in ("share_before", "share_after"))
        table.add_row(pair["machine"], pair["other"], *sigmas, shares)
    show_table(table)
    least = min(pair["run"] for pair in pairs)
    if not summary["separable"]:
        click.echo(f"No input tried separates them within the limits: {least:.2g} sigmas at best.")
        return
    needed, likeliest = summary["share_needed"], pairs[0]["machine"]
    share = min(pair["share_after"] for pair in pairs if pair["machine"] == likeliest)
    enough = "enough" if share >= needed else "too little: give a longer run or wider limits"
    click.echo(
        f"diagnose names {likeliest} alone if it reduces the sum of squares of every other"
        f" by {100.0 * needed:.0f} %: at least {100.0 * share:.0f} % is predicted, {enough}."
    )


def _print_parameters(summary: Mapping[str, Any]) -> None:
    from rich.table import Table

    wanted = summary["for_parameters"]
    for name, rows in summary["parameters"].items():
        click.echo(f"Standard deviations by white noise, if the machine is {name}:")
        table = Table("  parameter", "value", "before", "after", "unit", box=None)
        for parameter, row in rows.items():
            cells = (
                "not known" if row[key] is None else f"{row[key]:.2g}"
                for key in ("sd_before", "sd_after")
            )
            mark = "> " if parameter in wanted else "  "
            table.add_row(mark + parameter, f"{row['value']:.4g}", *cells, row["unit"])
        show_table(table)
