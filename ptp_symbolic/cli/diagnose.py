"""`ptp-symbolic diagnose` and `fit`: a platform and its logs in, files out."""

import json
import shlex
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import click

from ptp_symbolic.cli.declared import note_defaults, refuse_own_folder
from ptp_symbolic.cli.lists import show_table
from ptp_symbolic.cli.progress import progress_line


class SeveralValues(click.Command):
    """A command whose repeatable options take all values up to the next option."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse `args`, an option with several values written once per value."""
        options = [p for p in self.params if isinstance(p, click.Option) and p.multiple]
        return super().parse_args(ctx, repeated(args, {name for p in options for name in p.opts}))


def repeated(args: Sequence[str], options: Collection[str]) -> list[str]:
    """`args` with ``--train a b`` as ``--train a --train b`` for each of the `options`."""
    written: list[str] = []
    option, has_value = None, False
    for arg in args:
        if arg.startswith("-"):
            name, equals, _ = arg.partition("=")
            option, has_value = name if name in options else None, bool(equals)
        elif option is not None:
            if has_value:
                written.append(option)
            has_value = True
        written.append(arg)
    return written


@click.command(cls=SeveralValues)
@click.option("--platform", "source", required=True, help="Platform TOML or packaged name.")
@click.option(
    "--train", multiple=True, required=True, help="Logs or folders to fit (training runs)."
)
@click.option(
    "--validate", multiple=True, required=True, help="Logs that are never fitted (validation runs)."
)
@click.option("--out", type=Path, required=True, help="Folder for the results.")
@click.option("--black-box", is_flag=True, help="Compare with black-box models.")
@click.option(
    "--time-limit",
    type=float,
    help="Last stop of the search in s; default 900. Verdict and report follow after it.",
)
@click.option(
    "--effort",
    type=float,
    default=1.0,
    help="How much the search may simulate, as a multiple of the usual.",
)
@click.option(
    "--resume",
    type=Path,
    help="Evidence of an earlier run to go on from: its --out, or the evidence.npz in it.",
)
@click.option("--json", "as_json", is_flag=True, help="Print diagnosis.json instead of tables.")
def diagnose(
    source: str,
    train: tuple[str, ...],
    validate: tuple[str, ...],
    out: Path,
    black_box: bool,
    time_limit: float | None,
    effort: float,
    resume: Path | None,
    as_json: bool,
) -> None:
    """Find the effect that is missing from a declared platform, from its logs.

    What was evaluated is kept in evidence.npz in --out, also when the run is interrupted.
    """
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.workflows.diagnosis import diagnose_platform

    platform = declared_platform(source)
    refuse_own_folder(platform, out)
    check_writable(out)
    words = ["diagnose", "--platform", source, "--train", *train, "--validate", *validate]
    words += ["--black-box"] * black_box
    words += [] if time_limit is None else ["--time-limit", f"{time_limit:g}"]
    words += [] if effort == 1.0 else ["--effort", f"{effort:g}"]
    command = shlex.join(["ptp-symbolic", *words, "--out", str(out)])
    with progress_line() as say:
        found = diagnose_platform(
            platform, train, validate, say, command, black_box, time_limit, effort, resume, out
        )
    write_files_atomically(out, found.files)
    note_defaults(platform)
    if as_json:
        click.echo(json.dumps(found.summary, indent=2))
        return
    _print_diagnosis(found.summary)
    click.echo(f"Report: {out / 'report.html'}")


@click.command(cls=SeveralValues)
@click.option("--platform", "source", required=True, help="Platform TOML or packaged name.")
@click.argument("logs", nargs=-1)
@click.option("--train", multiple=True, help="Logs or folders too, as `diagnose` takes them.")
@click.option("--out", type=Path, required=True, help="Folder for the results.")
@click.option("--json", "as_json", is_flag=True, help="Print fit.json instead of a table.")
def fit(
    source: str, logs: tuple[str, ...], train: tuple[str, ...], out: Path, as_json: bool
) -> None:
    """Fit the free parameters of a platform to logs or folders of logs.

    Writes fit.json, and platform.toml with the fitted values as start values.
    """
    logs = (*logs, *train)
    if not logs:
        raise click.UsageError("Missing argument 'LOGS...'.")
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.workflows.fit import fit_platform

    platform = declared_platform(source)
    refuse_own_folder(platform, out)
    check_writable(out)
    words = ["fit", "--platform", source, *logs, "--out", str(out)]
    with progress_line() as say:
        found = fit_platform(platform, logs, say, shlex.join(["ptp-symbolic", *words]))
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
    _print_windows(summary)
    error = summary["error"]
    key, unit = error_measure([error["after"]["total"]])
    after, floor = (error[w]["total"][key] for w in ("after", "noise_floor"))
    before = error["before"]
    begun = (
        "the start values do not simulate"
        if before is None
        else f"{before['total'][key]:.4g} at the start values"
    )
    if before is not None and after > before["total"][key]:
        begun += "; a fit counts stretches that are far off less, so that this may rise"
    advice = ""
    if summary["far_from_floor"]:
        is_odd = any(text.startswith("The residual is") for text in summary["remarks"])
        next_step = "check the signals as said above" if is_odd else "run diagnose"
        advice = f": the model does not fit these logs; {next_step}"
    click.echo(f"{after:.4g} {unit} rms over all runs ({begun}), noise floor {floor:.2g}{advice}.")


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
        if effect["confusable_with"]:
            click.echo(f"  Experiment that separates them: {effect['separating_experiment']}")
    doubtful = {
        name: p
        for name, p in fitted.items()
        if name not in added and (p["at_bound"] or not p["identified"])
    }
    if doubtful:
        click.echo("Declared parameters that these logs do not identify:")
        _print_parameters(doubtful)
    _print_windows(summary)
    if summary["refused"]:
        click.echo("Improved the fit, but rejected:")
    for key, why in summary["refused"].items():
        click.echo(f"  {key}: {why}")
    for text in summary["hints"]:
        click.echo(f"Hint: {text}")
    _print_errors(summary)
    _print_rivals(summary)


def _print_windows(summary: Mapping[str, Any]) -> None:
    if summary["windows"] is None:
        return
    count, seconds = summary["windows"]["count"], summary["windows"]["seconds"]
    click.echo(
        f"Runs were cut into {count} windows of {seconds:.2g} s on average, each with its own"
        " initial state: where samples are missing, or where errors grow."
    )


def _print_rivals(summary: Mapping[str, Any]) -> None:
    """The residual torque and the free simulation of every model on the validation runs."""
    from ptp_symbolic.report.rivals import MODELS, free_errors, said
    from ptp_symbolic.report.tables import declared_totals, error_measure, usable

    found = summary["black_box"]

    for axis, part in ({} if found is None else found["axes"]).items():
        models = [f"{MODELS[key]} {said(m)}" for key, m in part["models"].items()]
        click.echo(
            f"Residual torque on {axis} along the validation runs, rms in {part['unit']}:"
            f" {', '.join(models)}."
        )
    if found is not None and found["free"]:
        key, unit = error_measure(declared_totals(summary))
        errors = [
            f"{MODELS[name]} {error[key]:.3g}"
            if usable(error.get(key))
            else f"{MODELS[name]} fails"
            for name, error in free_errors(summary).items()
            if name != "named" or summary["added"]
        ]
        click.echo(f"Simulated freely on the validation runs, {unit} rms: {', '.join(errors)}.")


def _print_errors(summary: Mapping[str, Any]) -> None:
    from rich.table import Table

    from ptp_symbolic.numeric.diagnose.summary import over
    from ptp_symbolic.report.tables import declared_totals, error_measure

    key, unit = error_measure(declared_totals(summary))
    errors = summary["error"]
    for part, title in (("train", "fitted"), ("validate", "never fitted")):
        error = errors[part]
        click.echo(f"{part} ({title}), {unit} rms, {over(error['before'].get('windows'))}:")
        table = Table("run", "before", "after", "noise floor", box=None)
        for run in (*error["before"]["by_run"], "total"):
            cells = [
                error[when]["total"] if run == "total" else error[when]["by_run"][run]
                for when in ("before", "after", "noise_floor")
            ]
            table.add_row(run, *(_written(cell[key], unit) for cell in cells))
        show_table(table)
    click.echo(f"Error: {errors['definition']}.")


def _written(error: float, unit: str) -> str:
    """An error as text: thousandths of a count, or three digits of an angle."""
    return f"{error:.3f}" if unit == "counts" else f"{error:.3g}"


def _print_parameters(parameters: Mapping[str, Any]) -> None:
    from ptp_symbolic.report.tables import doubts

    for name, p in parameters.items():
        low, high = (f"{v:.5g}" if v is not None else "?" for v in p["ci95"])
        interval = "no interval" if (low, high) == ("?", "?") else f"[{low}, {high}]"
        notes = doubts(p)
        more = f"  ({', '.join(notes)})" if notes else ""
        click.echo(f"  {name} = {p['value']:.6g} {p['unit']}  {interval}{more}")
