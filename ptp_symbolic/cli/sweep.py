"""`ptp-symbolic sweep`: thousands of runs with sampled parameters, streamed to disk."""

import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ptp_symbolic.cli.simulate import (
    INITIAL,
    PLATFORM,
    WithProfiles,
    initial_states,
)
from ptp_symbolic.errors import InputError

if TYPE_CHECKING:
    from ptp_symbolic.api.sweep import SweepPlan


@click.command(cls=WithProfiles)
@PLATFORM
@click.option(
    "--vary",
    multiple=True,
    metavar="NAME=LOW:HIGH",
    help="A parameter or initial state and its range or distribution: NAME=normal:MEAN:SD,"
    " lognormal:MEDIAN:SIGMA, loguniform:LOW:HIGH, triangular:LOW:MODE:HIGH; or a TOML file with"
    ' lines NAME = "LOW:HIGH". Repeat for several.',
)
@click.option("--samples", type=int, default=1024, show_default=True, help="Runs.")
@click.option("--seed", type=int, default=0, show_default=True, help="Of the Sobol sequence.")
@click.option(
    "--input", "inputs", multiple=True, metavar="NAME=PROFILE", help="Repeat for several."
)
@INITIAL
@click.option("--duration", type=float, default=10.0, show_default=True, help="Seconds.")
@click.option("--every", type=float, default=1e-2, show_default=True, help="Seconds.")
@click.option(
    "--output",
    "outputs",
    multiple=True,
    metavar="REDUCTION",
    help="A number per run, such as 'largest(theta_pan)'; repeat for several. Default: the final"
    " states.",
)
@click.option(
    "--aim",
    multiple=True,
    metavar="theta_pan=PROFILE",
    help="Reference of the line of sight; adds the pointing error and its band.",
)
@click.option("--signal", "signals", multiple=True, help="Drawn as a band. Default: the angles.")
@click.option(
    "--sensitivity",
    "sensitivities",
    multiple=True,
    metavar="NAME",
    help="A parameter or initial state by which every output is differentiated; repeat.",
)
@click.option("--rtol", type=float, default=1e-6, show_default=True)
@click.option("--atol", type=float, default=1e-8, show_default=True, help="rad.")
@click.option("--whole", is_flag=True, help="Keep the signals of all runs (trajectories.zarr).")
@click.option("--bands/--no-bands", default=True, help="Values for bands of signals; a plot.")
@click.option("--chunk", type=int, help="Runs that are computed and written at once.")
@click.option("--resume", is_flag=True, help="Go on with a sweep that was interrupted.")
@click.option("--cluster", metavar="ADDRESS", help="Dask scheduler, such as tcp://host:8786.")
@click.option("--out", type=Path, required=True, help="Folder for the results.")
def sweep(
    source: str,
    vary: tuple[str, ...],
    samples: int,
    seed: int,
    inputs: tuple[str, ...],
    initial: tuple[str, ...],
    duration: float,
    every: float,
    outputs: tuple[str, ...],
    aim: tuple[str, ...],
    signals: tuple[str, ...],
    sensitivities: tuple[str, ...],
    rtol: float,
    atol: float,
    whole: bool,
    bands: bool,
    chunk: int | None,
    resume: bool,
    cluster: str | None,
    out: Path,
) -> None:
    """Simulate a platform with sampled parameters; writes a row per run (Parquet), bands, a plot.

    Chunks are whole or not there: after Ctrl-C, a full disk or a lost cluster the same command with
    --resume computes those that are missing.
    """
    from ptp_symbolic.api.machine import load
    from ptp_symbolic.api.sweep import SweepPlan, run_sweep
    from ptp_symbolic.cli.progress import progress_line

    machine = load(source)
    targets = _pairs(aim, "--aim", "theta_pan=PROFILE")
    wanted = list(outputs) or [f"final({name})" for name in machine.state_names]
    if targets:
        body = "; ".join(f"{name} = {text}" for name, text in targets.items())
        wanted += [f"pointing_error({body})", f"largest_pointing_error({body})"]
    angles = [name for name in machine.state_names if name in ("theta_pan", "theta_tilt")]
    shown = list(dict.fromkeys([*(signals or angles), *(angles if targets else ())]))
    plan = SweepPlan(
        machine.module.MODEL_HASH,
        _varied(vary),
        samples,
        seed,
        duration,
        every,
        _pairs(inputs, "--input", "NAME=PROFILE"),
        initial_states(machine, initial),
        wanted,
        shown,
        targets,
        rtol,
        atol,
        chunk
        or _rows(
            duration, every, (len(machine.state_names) + len(shown)) * (1 + len(sensitivities))
        ),
        whole,
        bands,
        sensitivities,
    )
    with progress_line() as progress:
        run_sweep(machine, plan, out, resume, cluster, progress)
        _write_summary(machine, plan, out)


def _rows(duration: float, every: float, signals: int) -> int:
    """Runs per chunk, as many as take CHUNK_BYTES."""
    from ptp_symbolic.api.sweep import CHUNK_BYTES, MOST_ROWS

    return max(1, min(MOST_ROWS, int(CHUNK_BYTES / (8.0 * signals * (duration / every + 1.0)))))


def _pairs(given: Sequence[str], option: str, form: str) -> dict[str, str]:
    found = {}
    for text in given:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not value:
            raise InputError(f"{option} {text}: write {form}.")
        found[name] = value
    return found


def _varied(given: Sequence[str]) -> dict[str, str]:
    """Distributions by name, of texts NAME=LOW:HIGH and of TOML files."""
    found: dict[str, str] = {}
    for text in given:
        if not text.endswith(".toml"):
            found |= _pairs([text], "--vary", "NAME=LOW:HIGH")
            continue
        try:
            lines = tomllib.loads(Path(text).read_text(encoding="utf-8"))
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise InputError(f"{text}: {error}.") from error
        for name, value in lines.get("vary", lines).items():
            if not isinstance(value, str):
                raise InputError(f'{text}: {name} = {value!r}; write {name} = "LOW:HIGH".')
            found[name] = value
    return found


def _write_summary(machine: Any, plan: "SweepPlan", out: Path) -> None:
    import json

    from ptp_symbolic.api.plots import bands_figure, png_of
    from ptp_symbolic.api.sweep import QUANTILES, band_columns, bands_of, summary_of
    from ptp_symbolic.atomic_files import write_files_atomically
    from ptp_symbolic.cli.tables import table_text

    summary, bands = summary_of(plan, out), bands_of(plan, out)
    units = {name: machine.units.get(name, "rad") for name in bands}
    t = plan.times[band_columns(plan)]
    files: dict[str, str | bytes] = {}
    if bands:
        head = [f"{name} {q:g} [{units[name]}]" for name in bands for q in QUANTILES]
        rows = zip(t, *(row for values in bands.values() for row in values), strict=True)
        files["bands.csv"] = table_text(["time [s]", *head], rows)
        files["sweep.png"] = png_of(bands_figure(t, bands, units))
    files["summary.json"] = json.dumps(summary, indent=1) + "\n"
    write_files_atomically(out, files)
    failed = plan.samples - summary["status"].get("done", 0)
    why = ", ".join(f"{n} {word}" for word, n in summary["status"].items() if word != "done")
    said = f" ({why}; what follows is of the others, the column `reason` says more)" if why else ""
    click.echo(f"{plan.samples} runs, {failed} failed{said}: {out / 'trajectories'}")
    for name, found in summary["outputs"].items():
        low, high = found["quantiles"]["0.05"], found["quantiles"]["0.95"]
        click.echo(f"{name}: mean {found['mean']:.6g}, 90 % of runs in {low:.6g} to {high:.6g}")
