"""All commands in one group, and what becomes of what goes wrong in them."""

import re
import sys

import click

from ptp_symbolic.cli.bench import bench
from ptp_symbolic.cli.check import check
from ptp_symbolic.cli.diagnose import diagnose, fit
from ptp_symbolic.cli.experiment import experiment
from ptp_symbolic.cli.export import export
from ptp_symbolic.cli.friction_map import friction_map
from ptp_symbolic.cli.lists import effects, models, platforms
from ptp_symbolic.cli.new import new, schema
from ptp_symbolic.cli.regenerate import regenerate
from ptp_symbolic.cli.report import report
from ptp_symbolic.cli.simulate import sensitivity, simulate
from ptp_symbolic.cli.sweep import sweep
from ptp_symbolic.errors import InputError


@click.group()
@click.version_option(package_name="ptp-symbolic")
def commands() -> None:
    """Equations of pan-tilt platforms: derive, compile, simulate, fit, diagnose."""


for command in (
    new,
    schema,
    regenerate,
    simulate,
    sensitivity,
    sweep,
    bench,
    check,
    friction_map,
    fit,
    diagnose,
    experiment,
    export,
    report,
    effects,
    models,
    platforms,
):
    commands.add_command(command)


def own_name(command: click.Command) -> str:
    """The name of the program that runs `command`, however it was started."""
    return "ptp-symbolic" if isinstance(command, click.Group) else "regenerate-equations"


def run(command: click.Command) -> None:
    """Run `command`; what the user got wrong is one line on stderr and exit code 2."""
    if "" in sys.argv[1:]:
        before = sys.argv[sys.argv.index("") - 1] if sys.argv[1] else "the command"
        _refuse(f"What follows {before} is empty; give it a value (was a shell variable not set?).")
    try:
        code = command.main(prog_name=own_name(command), standalone_mode=False)
    except click.exceptions.Exit as ended:
        sys.exit(ended.exit_code)
    except click.exceptions.NoArgsIsHelpError as bare:
        click.echo(bare.format_message(), err=True)
        sys.exit(2)
    except click.UsageError as wrong:
        told = " ".join(wrong.format_message().split()).removesuffix(".")
        asked = "" if wrong.ctx is None else f" See '{wrong.ctx.command_path} --help'."
        _refuse(f"{told}{'' if told.endswith('?') else '.'}{asked}")
    except click.ClickException as wrong:
        _refuse(" ".join(wrong.format_message().split()))
    except InputError as wrong:
        _refuse(in_options(str(wrong), command))
    except OSError as wrong:
        _refuse(f"{wrong.filename or 'A file'}: {wrong.strerror or wrong}; check path and rights.")
    sys.exit(code if isinstance(code, int) else 0)


def in_options(message: str, command: click.Command) -> str:
    """`message` with every `argument` of a Python function as the option of `command`."""
    own = command.commands.values() if isinstance(command, click.Group) else (command,)
    options = {
        str(p.name): max(p.opts, key=len)
        for each in own
        for p in each.params
        if isinstance(p, click.Option)
    }
    return re.sub(r"`(\w+)`", lambda found: options.get(found[1], found[0]), message)


def _refuse(message: str) -> None:
    click.echo(f"ptp-symbolic: {message}", err=True)
    sys.exit(2)
