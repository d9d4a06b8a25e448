"""Figures in the style of the package alone, whatever settings of matplotlib lie about.

matplotlib reads a `matplotlibrc` of the folder one stands in, or of the user, when it is imported:
one of another program changes figures, and a damaged one is a traceback. It is imported here, where
an empty one is found first, before another module of the reports imports it.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

_SETTINGS = Path(__file__).parent / "templates"


@contextmanager
def _standing_in(folder: Path) -> Iterator[None]:
    try:
        before = Path.cwd()
    except OSError:  # the folder one stood in is gone
        before = folder
    os.chdir(folder)
    try:
        yield
    finally:
        with suppress(OSError):
            os.chdir(before)


with _standing_in(_SETTINGS):
    import matplotlib


@contextmanager
def drawn_in(style: dict[Any, Any]) -> Iterator[None]:
    """Draw with the defaults of matplotlib and `style`; afterwards all settings are as before."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(style)
        yield
