"""`ptp-symbolic regenerate`: emit the committed models, or check them, or those of a platform."""

from pathlib import Path

import click


@click.command()
@click.argument("models", nargs=-1, metavar="[MODEL|PLATFORM...]")
@click.option("--out", type=Path, help="Folder for modules of your own platforms (TOML or name).")
@click.option("--check", is_flag=True, help="Write nothing; exit 1 and name what differs.")
def regenerate(models: tuple[str, ...], out: Path | None, check: bool) -> int:
    """Emit the committed models (all without a name); only what changed is rewritten.

    With --out, emit the equations of platforms as modules: numpy, numba and nothing else.
    """
    from ptp_symbolic.models.committed import regenerate as emit
    from ptp_symbolic.models.committed import stray_modules
    from ptp_symbolic.numeric.runtime.model import generated_folder

    if out is not None:
        return _emit_platforms(models, out, check)
    outcome = emit(models, check)
    for name in outcome.changed:
        click.echo(f"{'differs from its equations' if check else 'written'}: generated/{name}")
    stray = stray_modules(generated_folder()) if check and not models else ()
    for name in stray:
        click.echo(f"belongs to no committed model: generated/{name}")
    if not outcome.changed and not stray:
        click.echo(f"{len(outcome.unchanged)} modules are up to date.")
    return 1 if check and (outcome.changed or stray) else 0


def _emit_platforms(sources: tuple[str, ...], out: Path, check: bool) -> int:
    from ptp_symbolic.atomic_files import check_writable
    from ptp_symbolic.cli.declared import note_defaults
    from ptp_symbolic.errors import InputError
    from ptp_symbolic.models.committed import declared_platform, regenerate_into

    if not sources:
        raise InputError("Nothing to emit into --out; name a platform TOML, a preset or a model.")
    if not check:
        check_writable(out)
    platforms = [declared_platform(source) for source in sources]
    outcome = regenerate_into(out, platforms, check)
    for platform in platforms:
        note_defaults(platform)
    for name in outcome.changed:
        click.echo(f"{'differs from its equations' if check else 'written'}: {out / name}")
    if not outcome.changed:
        click.echo(f"{len(outcome.unchanged)} modules are up to date.")
    return 1 if check and outcome.changed else 0
