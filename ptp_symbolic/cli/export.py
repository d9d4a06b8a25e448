"""`ptp-symbolic export`: the equations of a platform in the language of another tool."""

from pathlib import Path

import click

from ptp_symbolic.cli.declared import note_defaults
from ptp_symbolic.cli.progress import progress_line


class WithTargets(click.Command):
    """A command whose help ends with the targets."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list; read from where it is defined, when it is asked for."""
        from ptp_symbolic.symbolic.targets import TARGETS

        with formatter.section("Targets"):
            formatter.write_dl([(target.name, target.summary) for target in TARGETS])


@click.command(cls=WithTargets)
@click.argument("target")
@click.option("--platform", "source", required=True, help="Platform TOML or name.")
@click.option("--out", type=Path, required=True, help="Folder for the files.")
def export(target: str, source: str, out: Path) -> None:
    """Write the equations of a platform for another tool: TARGET is one of those below."""
    from ptp_symbolic.models.committed import declared_platform
    from ptp_symbolic.models.export import export as written
    from ptp_symbolic.models.export import target_named

    target_named(target)
    platform = declared_platform(source)
    with progress_line() as say:
        paths, remarks = written(platform, target, out, say)
    note_defaults(platform)
    for remark in remarks:
        click.echo(remark)
    for path in paths:
        click.echo(f"written: {path}")
