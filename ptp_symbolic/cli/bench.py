"""`ptp-symbolic bench`: how fast a platform is simulated on this computer."""

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ptp_symbolic.cli.simulate import INPUT, PLATFORM, WithProfiles, given_signals

if TYPE_CHECKING:
    from ptp_symbolic.api.bench import Speed, Timing


@click.command(cls=WithProfiles)
@PLATFORM
@INPUT
@click.option("--duration", type=float, default=10.0, show_default=True, help="Seconds.")
@click.option("--quick", is_flag=True, help="Fewer repeats and a smaller batch.")
@click.option("--out", type=Path, help="Folder for bench.json.")
def bench(
    source: str, inputs: tuple[str, ...], duration: float, quick: bool, out: Path | None
) -> None:
    """Time the simulation of a platform on this computer, beside SciPy on the same functions.

    Figures are medians of one process. The ratio says how many times as long the peer takes.
    """
    from dataclasses import asdict

    from ptp_symbolic.api.bench import measure_speed
    from ptp_symbolic.api.machine import load
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.cli.lists import print_table
    from ptp_symbolic.cli.progress import progress_line
    from ptp_symbolic.models.committed import declared_platform

    if out is not None:
        check_writable(out)
    platform = declared_platform(source)
    with progress_line() as progress:
        signals = None
        if inputs:
            signals, _ = given_signals(platform, load(source), inputs, duration)
        found = measure_speed(source, signals, duration, quick, progress)
    print_table([_row(timing) for timing in found.timings])
    _print_surroundings(found, inputs)
    if out is not None:
        text = json.dumps({**asdict(found), "given": list(inputs)}, indent=2) + "\n"
        write_files_atomically(out, {"bench.json": text})
        click.echo(f"written: {out / 'bench.json'}")


def _row(timing: "Timing") -> dict[str, str]:
    """A line of the table."""

    def number(value: float | None, unit: str = "") -> str:
        return "" if value is None else f"{value:,.3g} {unit}".strip()

    def figure(value: float | None) -> str:
        if value is not None and value >= 1000.0:
            return f"{value:,.0f} {timing.unit}"
        return number(value, timing.unit)

    return {
        "what": timing.what,
        "median": figure(timing.value),
        "error": number(timing.error),
        "beside": timing.peer or "",
        "its median": figure(timing.peer_value),
        "its error": number(timing.peer_error),
        "ratio": number(timing.ratio),
    }


def _print_surroundings(found: "Speed", inputs: tuple[str, ...]) -> None:
    driven = ", ".join(inputs or (f"{n}={text}" for n, text in found.inputs.items())) or "nothing"
    click.echo(f"\n{found.model}, {found.duration:g} s, driven by {driven}")
    click.echo(", ".join(f"{name} {value}" for name, value in found.computer.items()))
