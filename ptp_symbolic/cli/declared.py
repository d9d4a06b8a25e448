"""What a command says of a platform: defaults that it keeps, and that its file is in the way."""

from pathlib import Path

import click

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Platform


def refuse_own_folder(platform: Platform, out: Path) -> None:
    """Raise InputError where a platform.toml in `out` would replace the file of `platform`."""
    if platform.source and (out / "platform.toml").resolve() == Path(platform.source).resolve():
        raise InputError(
            f"`out` {out}: its platform.toml is the platform that is read, and the result would"
            " replace it; give another folder."
        )


def note_defaults(platform: Platform) -> None:
    """Print one line on stderr with all parameters that keep their natural default."""
    from ptp_symbolic.symbolic.derivation.placement import undeclared_parameters

    left = undeclared_parameters(platform)
    if left:
        shown = ", ".join(f"{p.name} = {p.default:g} {p.unit}".removesuffix(" 1") for p in left)
        click.echo(f"Not declared, at their natural default: {shown}.", err=True)
