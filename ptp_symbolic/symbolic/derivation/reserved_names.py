"""Names that the emitted modules need for themselves."""

import keyword

from ptp_symbolic.symbolic.derivation.equations import Equations

VARIABLES = frozenset(
    ["t", "x", "u", "p", "m", "c", "g", "y", "z", "e", "r", "dx", "forces", "np", "math", "float32"]
)
PREFIXES = (
    *("mass_", "force_", "accel_", "inverse_", "slide_", "side_", "active_", "rate_of_"),
    *("given_", "balance_"),
)


def refuse_reserved_names(equations: Equations) -> None:
    """Raise ValueError for a parameter, state, input or named function whose name is none, or
    that of a variable or an intermediate result of the emitted modules.
    """
    named = [("Parameter", p.name) for p in equations.parameters]
    named += [("State", state.name) for state in equations.extra_states]
    named += [("Input", given.name) for given in equations.inputs]
    named += [("Named function", str(symbol)) for symbol, _ in equations.terms]
    for what, name in named:
        if not (name.isidentifier() and name.isascii()) or keyword.iskeyword(name):
            raise ValueError(f"{what} '{name}' has no valid name: use letters, digits and _.")
        if name in VARIABLES or name.startswith(PREFIXES):
            raise ValueError(
                f"{what} '{name}' has a name that emitted modules use for themselves; put its"
                " meaning first."
            )
