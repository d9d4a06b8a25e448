"""What a command says of a platform: the parameters that keep a default nobody declared."""

import click

from ptp_symbolic.platform import Platform

SHOWN = 6


def note_defaults(platform: Platform) -> None:
    """Print one line on stderr with the parameters that keep the default of the catalogue."""
    from ptp_symbolic.symbolic.derivation.placement import undeclared_parameters

    left = undeclared_parameters(platform)
    if not left:
        return
    shown = ", ".join(f"{p.name} = {p.default:g} {p.unit}" for p in left[:SHOWN])
    more = f" and {len(left) - SHOWN} more" if len(left) > SHOWN else ""
    click.echo(f"Not declared, default of the catalogue: {shown}{more}.", err=True)
