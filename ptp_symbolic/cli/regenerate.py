"""`ptp-symbolic regenerate`: emit the committed models, or check them."""

import click


@click.command()
@click.argument("models", nargs=-1, metavar="[MODEL...]")
@click.option("--check", is_flag=True, help="Write nothing; exit 1 and name what differs.")
def regenerate(models: tuple[str, ...], check: bool) -> int:
    """Emit the committed models (all without a name); only what changed is rewritten."""
    from ptp_symbolic.regenerate import regenerate as emit
    from ptp_symbolic.regenerate import stray_modules
    from ptp_symbolic.runtime.loader import generated_folder

    outcome = emit(models, check)
    for name in outcome.changed:
        click.echo(f"{'differs from its equations' if check else 'written'}: generated/{name}")
    stray = stray_modules(generated_folder()) if check and not models else ()
    for name in stray:
        click.echo(f"belongs to no committed model: generated/{name}")
    if not outcome.changed and not stray:
        click.echo(f"{len(outcome.unchanged)} modules are up to date.")
    return 1 if check and (outcome.changed or stray) else 0
