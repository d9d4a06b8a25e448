"""`ptp-symbolic friction-map`: the law of steady friction that points of rate and torque show."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from ptp_symbolic.cli.lists import show_table
from ptp_symbolic.platform import AXES


@click.command("friction-map")
@click.argument("points", type=Path)
@click.option("--rate", default="rate", show_default=True, help="Column of the rate.")
@click.option("--torque", default="torque", show_default=True, help="Column of the torque.")
@click.option("--spread", help="Column of the standard deviation of the torque.")
@click.option("--nominal", help="Torque that % is of, such as '9.84 mN m'.")
@click.option("--platform", "source", help="Platform TOML or packaged name that has the axis.")
@click.option("--axis", type=click.Choice(AXES), default="pan", show_default=True)
@click.option("--confidence", type=float, default=0.95, show_default=True)
@click.option("--out", type=Path, help="Folder for friction.toml, friction.png, friction.json.")
@click.option("--json", "as_json", is_flag=True, help="Print friction.json instead of tables.")
def friction_map(
    points: Path,
    rate: str,
    torque: str,
    spread: str | None,
    nominal: str | None,
    source: str | None,
    axis: str,
    confidence: float,
    out: Path | None,
    as_json: bool,
) -> None:
    """Fit laws of friction to steady POINTS (a CSV: rate [rpm], torque [mN m]); name the smallest
    that predicts as well as any other. Rates in mm/s or m/s are those of a linear axis; its forces
    are the column that --torque names.

    A point at rate 0 is a breakaway torque. The torque drives the joint: it has the sign of the
    rate. Intervals are profile likelihoods for normal scatter.
    """
    from ptp_symbolic.api import results
    from ptp_symbolic.atomic_files import check_writable

    if out is not None:
        check_writable(out)
    found = results.friction_map(
        points,
        rate=rate,
        torque=torque,
        spread=spread,
        nominal=nominal,
        axis=axis,
        confidence=confidence,
    )
    if source is not None:
        _check_axis(source, axis, points, found.summary["units"]["rate"])
    if out is not None:
        found.save(out)
    if as_json:
        click.echo(found.output.files["friction.json"], nl=False)
    else:
        _print(found.summary)


def _check_axis(source: str, axis: str, points: Path, rate: str) -> None:
    from ptp_symbolic.errors import InputError
    from ptp_symbolic.models.committed import platform_as_written
    from ptp_symbolic.numeric.friction_map.points import LINEAR, ROTARY

    platform = platform_as_written(source)
    if axis not in platform.axes:
        axes = ", ".join(platform.axes)
        raise InputError(f"--axis {axis}: '{source}' has {axes}; give one of these.")
    own = (LINEAR if axis in platform.linear_axes else ROTARY).rate
    if rate != own:
        raise InputError(
            f"{points}: rates in {rate}, but the {axis} axis of '{source}' moves in {own}; give"
            " points of this axis, or correct the unit in the heading."
        )


def _print(summary: Mapping[str, Any]) -> None:
    from rich.table import Table

    rms = summary["rms"]
    click.echo(f"{summary['source']}: {summary['member']}")
    without = f", without its rise {rms['without_rise']:.3g}" if "without_rise" in rms else ""
    unit = summary["units"]["torque"]
    click.echo(
        f"rms: Coulomb alone {rms['coulomb']:.3g}{without}, this law {rms['law']:.3g} {unit}"
    )
    percent = f"{100.0 * summary['confidence']:g} % interval"
    table = Table("parameter", "value", percent, "unit", box=None)
    for name, of in summary["parameters"].items():
        ends = ["open" if of[end] is None else f"{of[end]:.4g}" for end in ("low", "high")]
        table.add_row(name, f"{of['value']:.4g}", " to ".join(ends), of["unit"])
    show_table(table)
    members = Table("parameters", "rms", "cross-validated", "p", "law", box=None)
    for row in summary["members"]:
        if row["p_value"] is not None:
            left_out = "" if row["left_out"] is None else f"{row['left_out']:.3g}"
            cells = (f"{row['rms']:.3g}", left_out, f"{row['p_value']:.2g}", row["member"])
            members.add_row(str(row["parameters"]), *cells)
    click.echo("Laws tested, the named one last (p: F tests against all larger laws together):")
    show_table(members)
    for text in summary["remarks"]:
        click.echo(f"Note: {text}")
