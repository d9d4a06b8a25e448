"""`ptp-symbolic diagnose` and `fit`: a platform and its logs in, files out."""

import json
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import click

from ptp_symbolic.cli.declared import note_defaults


class Several(click.Option):
    """An option that takes all values up to the next option, and may be repeated."""

    def add_to_parser(self, parser: Any, ctx: click.Context) -> None:
        """Let the option take every value up to the next option."""
        super().add_to_parser(parser, ctx)
        own = next(parser._long_opt[name] for name in self.opts if name in parser._long_opt)
        process = own.process

        def take_all(value: str, state: Any) -> None:
            process(value, state)
            while state.rargs and not state.rargs[0].startswith("-"):
                process(state.rargs.pop(0), state)

        own.process = take_all


def progress_line() -> Callable[[str], None]:
    """A function that shows what is being done, on a terminal only."""
    begun = time.monotonic()

    def show(text: str) -> None:
        if sys.stderr.isatty():
            click.echo(f"[{time.monotonic() - begun:6.1f} s] {text}", err=True)

    return show


@click.command()
@click.option("--platform", "source", required=True, help="Platform TOML or packaged name.")
@click.option("--train", cls=Several, multiple=True, required=True, help="Logs or folders to fit.")
@click.option(
    "--validate", cls=Several, multiple=True, required=True, help="Logs never fitted, to judge."
)
@click.option("--out", type=Path, required=True, help="Folder for the results.")
@click.option("--json", "as_json", is_flag=True, help="Print diagnosis.json instead of tables.")
def diagnose(
    source: str, train: tuple[str, ...], validate: tuple[str, ...], out: Path, as_json: bool
) -> None:
    """Find the effect that a declared platform lacks, from its logs."""
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.diagnosis_workflow import diagnose_platform
    from ptp_symbolic.models.committed import declared_platform

    platform = declared_platform(source)
    check_writable(out)
    found = diagnose_platform(platform, train, validate, progress_line())
    write_files_atomically(out, found.files)
    note_defaults(platform)
    if as_json:
        click.echo(json.dumps(found.summary, indent=2))
        return
    _print_diagnosis(found.summary)
    click.echo(f"Report: {out / 'report.html'}")


@click.command()
@click.option("--platform", "source", required=True, help="Platform TOML or packaged name.")
@click.argument("logs", nargs=-1, required=True)
@click.option("--out", type=Path, required=True, help="Folder for the results.")
@click.option("--json", "as_json", is_flag=True, help="Print fit.json instead of a table.")
def fit(source: str, logs: tuple[str, ...], out: Path, as_json: bool) -> None:
    """Fit the free parameters of a platform to logs or folders of logs.

    Writes fit.json, and platform.toml with the fitted values as starts.
    """
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.diagnosis_workflow import fit_platform
    from ptp_symbolic.models.committed import declared_platform

    platform = declared_platform(source)
    check_writable(out)
    found = fit_platform(platform, logs, progress_line())
    write_files_atomically(out, found.files)
    note_defaults(platform)
    if as_json:
        click.echo(json.dumps(found.summary, indent=2))
        return
    _print_fit(found.summary)
    click.echo(f"Result: {out / 'fit.json'}, {out / 'platform.toml'}")


def _print_fit(summary: Mapping[str, Any]) -> None:
    from ptp_symbolic.report.tables import error_measure

    _print_remarks(summary)
    _print_parameters(summary["parameters"])
    if not summary["parameters"]:
        click.echo("Nothing is free; give a parameter 'start' in place of 'value' to fit it.")
    if summary["windows"] is not None:
        count, seconds = summary["windows"]["count"], summary["windows"]["seconds"]
        click.echo(
            f"The runs were cut into {count} windows of {seconds:.2g} s, each with a start of its"
            " own: over longer ones errors of the start and of the inputs would rule."
        )
    error = summary["error"]
    key, unit = error_measure([error["after"]["total"]])
    after, floor = (error[w]["total"][key] for w in ("after", "noise_floor"))
    before = error["before"]
    begun = (
        "the start values do not simulate"
        if before is None
        else f"{before['total'][key]:.4g} at the start values"
    )
    advice = (
        ": the model does not fit these logs; run diagnose" if summary["far_from_floor"] else ""
    )
    click.echo(f"{after:.4g} {unit} rms over all runs ({begun}), floor {floor:.2g}{advice}.")


def _print_remarks(summary: Mapping[str, Any]) -> None:
    for text in summary["remarks"]:
        click.echo(f"Note: {text}")


def _print_diagnosis(summary: Mapping[str, Any]) -> None:
    from rich.console import Console

    _print_remarks(summary)
    Console().print(f"{summary['verdict']}: {summary['summary']}", markup=False, soft_wrap=True)
    fitted = summary["fit"]["after"]["parameters"]
    added = {name for effect in summary["added"] for name in effect["parameters"]}
    for effect in summary["added"]:
        _print_parameters({name: fitted[name] for name in effect["parameters"]})
    doubtful = {
        name: p
        for name, p in fitted.items()
        if name not in added and (p["at_bound"] or not p["identified"])
    }
    if doubtful:
        click.echo("Declared parameters that these logs do not settle:")
        _print_parameters(doubtful)
    if summary["refused"]:
        click.echo("Gained something, but were not named:")
    for key, why in summary["refused"].items():
        click.echo(f"  {key}: {why}")
    _print_errors(summary)


def _print_errors(summary: Mapping[str, Any]) -> None:
    from rich.console import Console
    from rich.table import Table

    from ptp_symbolic.report.tables import declared_totals, error_measure

    key, unit = error_measure(declared_totals(summary))
    errors = summary["error"]
    for part, title in (("train", "fitted"), ("validate", "never fitted")):
        error = errors[part]
        click.echo(f"{part} ({title}), {unit} rms:")
        table = Table("run", "before", "after", "floor", box=None)
        for run in (*error["before"]["by_run"], "total"):
            cells = [
                error[when]["total"] if run == "total" else error[when]["by_run"][run]
                for when in ("before", "after", "noise_floor")
            ]
            table.add_row(run, *(_written(cell[key], unit) for cell in cells))
        Console().print(table)
    click.echo(f"Error: {errors['definition']}.")


def _written(error: float, unit: str) -> str:
    """An error as text: thousandths of a count, or three digits of an angle."""
    return f"{error:.3f}" if unit == "counts" else f"{error:.3g}"


def _print_parameters(parameters: Mapping[str, Any]) -> None:
    from ptp_symbolic.report.tables import doubts

    for name, p in parameters.items():
        low, high = (f"{v:.5g}" if v is not None else "?" for v in p["ci95"])
        notes = doubts(p)
        more = f"  ({', '.join(notes)})" if notes else ""
        click.echo(f"  {name} = {p['value']:.6g} {p['unit']}  [{low}, {high}]{more}")
