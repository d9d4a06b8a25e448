"""Machines in the languages of other tools."""

from pathlib import Path

from ptp_symbolic.api.machine import Source, platform_of
from ptp_symbolic.errors import path_of


def export(source: Source, target: str, folder: str | Path) -> list[Path]:
    """Write the equations of a machine for another tool into `folder`; returns the paths written.

    `source` is a machine, a platform, the path of its TOML file, or the name of a preset or model;
    `target` is one of those that `ptp-symbolic export --help` lists, such as "c99", "casadi", "jax"
    or "octave". Parameters have the values of the platform where the target writes values. Raises
    InputError for an unknown target, for a machine that the target cannot express, and where the
    folder cannot be written; then nothing is.

    >>> import tempfile
    >>> import ptp_symbolic as ptp
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [path.name for path in ptp.export("ideal", "c99", folder)]
    ['ideal.h', 'ideal.c']
    """
    from ptp_symbolic.models.export import export as written

    place = path_of(folder, "`folder`", "the path of a folder")
    return written(platform_of(source), target, place)[0]
