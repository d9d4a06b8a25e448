"""The compiled functions of a fit, compiled by another process while this one derives equations.

Each module lists them with the types that they are called with, in AHEAD: numba would compile them
one after the other where a fit first calls them.
"""

from ptp_symbolic.numeric.identify import along_motion, evaluate, start, weak_form
from ptp_symbolic.numeric.simulation.ahead import begin, note_compiled

FIT = "fit"
COMPILE_FIT = f"from {__name__} import compile_all; compile_all()"


def begin_fit() -> None:
    """Begin to compile them in another process, unless they are compiled."""
    begin(FIT, COMPILE_FIT)


def compile_all() -> None:
    """Compile them, or find them compiled."""
    for function, types in (*weak_form.AHEAD, *start.AHEAD, *evaluate.AHEAD, *along_motion.AHEAD):
        function.compile(types)
    note_compiled(FIT)
