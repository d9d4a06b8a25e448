"""`ptp-symbolic new` and `schema`: a platform file to start from, and what editors check it by."""

from pathlib import Path

import click

from ptp_symbolic.formats.machine_kinds import DRIVES, MACHINES

FILES = ("platform", "diagnosis")


@click.command()
@click.argument("file", type=Path)
@click.option(
    "--machine",
    type=click.Choice(tuple(MACHINES)),
    default="pan-tilt",
    show_default=True,
    help="Kind of machine.",
)
@click.option(
    "--drive",
    type=click.Choice(DRIVES),
    default="motor",
    show_default=True,
    help="What drives it: the voltage of a DC motor, or a torque (force).",
)
@click.option(
    "--from",
    "robot",
    type=Path,
    help="Robot in URDF or MJCF to lump into a platform, in place of --machine and --drive.",
)
@click.option("--pan", help="Joint of the robot that is the pan axis.")
@click.option("--tilt", help="Joint of the robot that is the tilt axis.")
@click.option("--freeze", multiple=True, help="Joint of the robot to hold as drawn; repeatable.")
def new(
    file: Path,
    machine: str,
    drive: str,
    robot: Path | None,
    pan: str | None,
    tilt: str | None,
    freeze: tuple[str, ...],
) -> None:
    """Write a commented platform FILE (.toml) to start from, and beside it the schema by which
    editors complete and check it.
    """
    from ptp_symbolic.atomic_files import check_writable, write_files_atomically
    from ptp_symbolic.errors import InputError
    from ptp_symbolic.formats.starting_file import SCHEMA_NAME, starting_text
    from ptp_symbolic.platform import fields

    if file.suffix != ".toml":
        raise InputError(f"{file}: a platform file ends in .toml; write {file.stem}.toml.")
    if file.exists():
        raise InputError(f"{file}: is there already; give another name, or remove it.")
    name = fields.name(file.stem, f"{file}: the name of the file is that of the model")
    schema, beside = _schema("platform"), file.parent / SCHEMA_NAME
    if beside.exists() and not _is_schema(beside):
        raise InputError(
            f"{beside}: is no schema of this program and would be replaced; rename it, or choose"
            " another folder."
        )
    check_writable(file.parent)
    if robot is None:
        if pan is not None or tilt is not None or freeze:
            raise InputError("--pan, --tilt and --freeze name joints of a robot; add --from FILE.")
        text = starting_text(name, machine, drive)
        done = f"fill in every nan, then run: ptp-symbolic check --platform {file} LOG..."
    else:
        text = _text_of_robot(robot, pan, tilt, freeze, name)
        done = f"try ptp-symbolic simulate --platform {file} --out run"
    write_files_atomically(file.parent, {SCHEMA_NAME: schema, file.name: text})
    click.echo(f"{file}: {done}")


def _text_of_robot(
    robot: Path, pan: str | None, tilt: str | None, freeze: tuple[str, ...], name: str
) -> str:
    """The text of a robot's platform; what was read and what is lost is printed."""
    from ptp_symbolic.errors import InputError
    from ptp_symbolic.formats.robots.imported import read_robot

    given = click.get_current_context().get_parameter_source
    if click.core.ParameterSource.COMMANDLINE in (given("machine"), given("drive")):
        raise InputError("--machine and --drive: a robot has its own axes; leave them out.")
    imported = read_robot(robot, pan, tilt, freeze, name)
    for line in (*imported.notes, *(f"not in the file: {lost}" for lost in imported.lost)):
        click.echo(line)
    return imported.text


@click.command()
@click.argument("what", type=click.Choice(FILES))
def schema(what: str) -> None:
    """Print the JSON Schema of a platform file or of diagnosis.json."""
    click.echo(_schema(what), nl=False)


def _schema(what: str) -> str:
    from ptp_symbolic.formats.diagnosis_file import diagnosis_schema
    from ptp_symbolic.formats.json_schema import schema_text
    from ptp_symbolic.formats.platform_file import platform_schema
    from ptp_symbolic.symbolic.effects import catalogue

    if what == "diagnosis":
        return schema_text(diagnosis_schema())
    return schema_text(platform_schema(tuple(catalogue())))


def _is_schema(path: Path) -> bool:
    """Whether the file is a schema that this program wrote, of whatever version."""
    from ptp_symbolic.formats.platform_file import TITLE

    try:
        return f'"title": "{TITLE}"' in path.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return False
