"""`ptp-symbolic effects | models | platforms`: what there is to choose from."""

import json

import click


def _show(rows: list[dict[str, str]], as_json: bool) -> None:
    if as_json:
        click.echo(json.dumps(rows, indent=2))
        return
    from rich.console import Console
    from rich.table import Table

    table = Table(*rows[0], box=None)
    for row in rows:
        table.add_row(*row.values())
    Console().print(table)


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def effects(as_json: bool) -> None:
    """List the effects that a platform can declare."""
    from ptp_symbolic.effects import EFFECTS

    rows = [
        {
            "effect": kind.id,
            "kind": kind.kind or "",
            "what": kind.title,
            "reference": kind.reference,
        }
        for effect in EFFECTS
        for kind in (effect, *effect.kinds)
    ]
    _show(rows, as_json)


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def models(as_json: bool) -> None:
    """List the committed models."""
    from ptp_symbolic.runtime.loader import load_model, model_names

    found = [(name, load_model(name)) for name in model_names()]
    _show(
        [
            {"model": n, "what": m.title, "states": ", ".join(m.state_names)}
            for n, m in found
        ],
        as_json,
    )  # fmt: skip


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def platforms(as_json: bool) -> None:
    """List the packaged platforms."""
    from ptp_symbolic.platform import preset_names, read_platform

    rows = [{"platform": name, "what": read_platform(name).title} for name in preset_names()]
    _show(rows, as_json)
