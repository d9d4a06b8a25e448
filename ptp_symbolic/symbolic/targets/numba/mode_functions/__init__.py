"""Functions that emitted modules have in common: how the modes follow from a state."""

import inspect
from types import ModuleType

from ptp_symbolic.symbolic.targets.numba.mode_functions import rigid, smooth, sprung

MARK = "# copied from here on\n"


def mode_functions_text(has_modes: bool, has_rigid_contacts: bool) -> str:
    """The functions that find the modes of a state, as text."""
    chosen: ModuleType = smooth
    if has_modes:
        chosen = rigid if has_rigid_contacts else sprung
    return inspect.getsource(chosen).partition(MARK)[2].strip()
