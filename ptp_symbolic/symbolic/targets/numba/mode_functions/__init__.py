"""Functions that emitted modules have in common: how the modes follow from a state."""

import inspect
from types import ModuleType

from ptp_symbolic.symbolic.targets.numba.mode_functions import lanes, rigid, smooth, sprung

MARK = "# copied from here on\n"


def mode_functions_text(has_modes: bool, has_rigid_contacts: bool) -> str:
    """The functions that find the modes of a state, as text."""
    chosen: ModuleType = smooth
    if has_modes:
        chosen = rigid if has_rigid_contacts else sprung
    return inspect.getsource(chosen).partition(MARK)[2].strip()


def lane_functions_text() -> str:
    """The functions that a derivative of several states at once calls, as text."""
    return inspect.getsource(lanes).partition(MARK)[2].strip()
