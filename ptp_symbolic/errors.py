"""The one exception that is meant for the person at the keyboard."""

import difflib
import math
from collections.abc import Iterable


class InputError(ValueError):
    """The user's input cannot be used.

    The message is one line: what came in (with its unit), what is allowed, what to do next.
    The command line prints it and exits with code 2, with nothing written.
    """

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(message.split()))


def unknown(what: str, name: str, known: Iterable[str], more: str = "") -> InputError:
    """Return the refusal of a `name` that is not `known`: the nearest one that is, then all.

    `what` says what the name should stand for, `more` what else is allowed, such as "; or a file".
    """
    choices = tuple(known)
    shown = repr(name if len(name) <= 200 else name[:200] + "...")
    listed = f"Choose one of: {', '.join(choices)}" if choices else "There is none here"
    guess = did_you_mean(name, choices) or "."
    return InputError(f"Unknown {what} {shown}{guess} {listed}{more}.")


def out_of_bounds(name: str, value: float, unit: str, lower: float, upper: float) -> InputError:
    """Return the refusal of a parameter's `value` in `unit`, which may be meant in degrees."""
    in_degrees = unit == "rad" and lower <= math.radians(value) <= upper
    advice = 'write unit = "deg" if that is what it is in' if in_degrees else "change the value"
    return InputError(
        f"Parameter '{name}' = {value:g} {unit} lies outside its bounds [{lower:g}, {upper:g}]"
        f" {unit}; {advice}."
    )


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return ": did you mean 'x'?" with the nearest of `known`; empty where none is near."""
    near = difflib.get_close_matches(name, tuple(known), n=1)
    return f": did you mean '{near[0]}'?" if near else ""
