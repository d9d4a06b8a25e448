"""Figures in the style of the package alone, whatever settings of Matplotlib lie about.

Matplotlib reads `matplotlibrc` of the working folder when it is first imported, and fails where
that is damaged: the package `report` imports this module before all others.
"""

from collections.abc import Mapping
from contextlib import AbstractContextManager, chdir
from pathlib import Path
from typing import Any

with chdir(Path(__file__).parent):
    import matplotlib

_OF_THE_SYSTEM = ("backend", "backend_fallback")  # how figures get to a screen


def own_style(style: Mapping[str, Any]) -> AbstractContextManager[None]:
    """Draw with the defaults of Matplotlib, changed by `style`."""
    defaults = {
        name: value
        for name, value in matplotlib.rcParamsDefault.items()
        if name not in _OF_THE_SYSTEM
    }
    settings: dict[Any, Any] = {**defaults, **style}
    return matplotlib.rc_context(settings)
