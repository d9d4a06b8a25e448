"""What a command says of a platform: the parameters that keep a default nobody declared."""

import click

from ptp_symbolic.platform import Platform


def note_defaults(platform: Platform) -> None:
    """Print one line on stderr with all parameters that keep their natural default."""
    from ptp_symbolic.symbolic.derivation.placement import undeclared_parameters

    left = undeclared_parameters(platform)
    if left:
        shown = ", ".join(f"{p.name} = {p.default:g} {p.unit}".removesuffix(" 1") for p in left)
        click.echo(f"Not declared, at their natural default: {shown}.", err=True)
