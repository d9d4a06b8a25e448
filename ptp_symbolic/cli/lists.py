"""`ptp-symbolic effects | models | platforms`: what there is to choose from."""

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from rich.table import Table

PIPE_WIDTH = 10_000


def _show(rows: Sequence[Mapping[str, str]], as_json: bool) -> None:
    if as_json:
        click.echo(json.dumps(rows, indent=2))
        return
    print_table(rows)


def print_table(rows: Sequence[Mapping[str, str]]) -> None:
    """One row per line, names whole; only on a terminal the last columns wrap to its width."""
    from rich.markup import escape
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for number, heading in enumerate(rows[0]):
        table.add_column(heading, no_wrap=number == 0, overflow="fold")
    for row in rows:
        table.add_row(*map(escape, row.values()))
    show_table(table)


def show_table(table: "Table") -> None:
    """Print a table to the width of a terminal; into a pipe or a file, as wide as it is."""
    from rich.console import Console

    console = Console()
    if console.is_terminal:
        console.print(table)
        return
    wide = Console(width=PIPE_WIDTH)
    with wide.capture() as printed:
        wide.print(table)
    click.echo("\n".join(line.rstrip() for line in printed.get().splitlines()))


@click.command()
@click.argument("effect", required=False)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def effects(effect: str | None, as_json: bool) -> None:
    """List the effects that a platform can declare, or explain one of them."""
    from ptp_symbolic.symbolic.effects import EFFECTS

    if effect is not None:
        _explain(effect, as_json)
        return
    rows = [
        {
            "effect": kind.id,
            "kind": kind.kind or "",
            "what": kind.title,
            "reference": kind.reference,
        }
        for each in EFFECTS
        for kind in (each, *each.kinds)
    ]
    _show(rows, as_json)


def _explain(name: str, as_json: bool) -> None:
    from ptp_symbolic.symbolic.derivation.placement import find_effect

    effect = find_effect(name)
    kinds = [described(kind) for kind in (effect, *effect.kinds)]
    if as_json:
        click.echo(json.dumps({"effect": effect.id, "kinds": kinds}, indent=2))
        return
    for number, kind in enumerate(kinds):
        click.echo("\n" if number else "", nl=False)
        of_kind = f' (kind = "{kind["kind"]}")' if kind["kind"] else ""
        click.echo(f"{effect.id}{of_kind}: {kind['what']}")
        searched = "a candidate of diagnose" if kind["searched"] else "declared, never searched for"
        click.echo(f"  sits on {kind['sits_on']}; {searched}")
        click.echo(f"  reference: {kind['reference']}")
        for need in kind["needs"]:
            own = [source for source in need["from"] if " " not in source]
            more = ": declare it too" if len(own) == 1 else ": declare one of them too" * bool(own)
            click.echo(f"  needs {' or '.join(need['from'])} ({need['quantity']}){more}")
        if kind["separating_experiment"]:
            click.echo(f"  to separate it: {kind['separating_experiment']}")
        if kind["parameters"]:
            click.echo()
            print_table([_as_row(parameter) for parameter in kind["parameters"]])


def described(kind: Any) -> dict[str, Any]:
    """One kind of an effect as data; `<axis>` stands for pan or tilt."""
    from ptp_symbolic.platform import AXES
    from ptp_symbolic.symbolic.derivation.placement import effects_that_define
    from ptp_symbolic.symbolic.effect_interface.place import Place

    # On a base that turns an effect has all of its parameters.
    place = Place(AXES, "<axis>" if kind.on_axis else None, None, frozenset(), base_turns=True)
    return {
        "kind": kind.kind,
        "what": kind.title,
        "sits_on": "an axis" if kind.on_axis else "the whole platform",
        "searched": kind.searched,
        "reference": kind.reference,
        "separating_experiment": kind.separating_experiment,
        "needs": [
            {
                "quantity": need.format(axis="<axis>"),
                "from": effects_that_define(need.format(axis=AXES[0]), AXES)
                or _from_the_machine(need),
            }
            for need in kind.needs
        ],
        "parameters": [
            {
                "name": p.name,
                "unit": p.unit,
                "default": p.default if p.has_natural_default else None,
                "bounds": [p.lower, p.upper],
                "meaning": p.meaning,
                "off_at": p.vanishes,
            }
            for p in kind.parameters_at(place)
        ],
    }


def _from_the_machine(need: str) -> list[str]:
    """Where a quantity comes from that no effect defines: a signal, or the axis itself (see
    `machine_quantities`).
    """
    if need.startswith("reading_"):
        return [f"[signals.{need.removeprefix('reading_').format(axis='<axis>')}]"]
    if need.startswith(("input_torque_", "command_torque_")):
        return ["any axis without a motor and without prescribed_motion"]
    if need.startswith("transmitted_torque_"):
        return ["any axis without prescribed_motion and without rigid backlash"]
    return ["dc_motor", "linear_actuator", "shaft_compliance"]


def _as_row(parameter: Mapping[str, Any]) -> dict[str, str]:
    lower, upper = parameter["bounds"]
    off, default = parameter["off_at"], parameter["default"]
    return {
        "parameter": parameter["name"],
        "unit": parameter["unit"],
        "default": "none: declare it" if default is None else f"{default:g}",
        "bounds": f"{lower:g} to {upper:g}",
        "off at": "" if off is None else f"{off:g}",
        "meaning": parameter["meaning"],
    }


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def models(as_json: bool) -> None:
    """List the committed models."""
    from ptp_symbolic.numeric.runtime.model import load_model, model_names

    found = [(name, load_model(name)) for name in model_names()]
    _show(
        [{"model": n, "what": m.title, "states": ", ".join(m.state_names)} for n, m in found],
        as_json,
    )


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def platforms(as_json: bool) -> None:
    """List the packaged platforms."""
    from ptp_symbolic.platform import preset_names, read_platform

    rows = [{"platform": name, "what": read_platform(name).title} for name in preset_names()]
    _show(rows, as_json)
