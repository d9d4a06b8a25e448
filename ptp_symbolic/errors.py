"""The one exception that is meant for the person at the keyboard."""

import difflib
import math
import os
from collections.abc import Iterable
from pathlib import Path


class InputError(ValueError):
    """The user's input cannot be used.

    The message is one line: what came in (with its unit), what is allowed, what to do next.
    The command line prints it and exits with code 2, with nothing written.
    """

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(message.split()))


def unknown(
    what: str, name: object, known: Iterable[str], more: str = "", listing: str = ""
) -> InputError:
    """Return the refusal of a `name` that is not `known`: the nearest one that is, then all.

    `what` says what the name should stand for, `more` what else is allowed, such as "; or a file".
    Where there are too many to print, `listing` says what lists them, and the nearest are printed.
    """
    choices, text = tuple(known), name if isinstance(name, str) else repr(name)
    shown = text if text is not name else repr(text)
    shown = shown if len(shown) <= 200 else f"{shown[:200]}...{shown[-1]}"
    if listing:
        near = ", ".join(nearest(text, choices))
        return InputError(f"Unknown {what} {shown}; the nearest are {near}. {listing} lists all.")
    listed = f"Choose one of: {', '.join(choices)}" if choices else "There is none here"
    guess = did_you_mean(text, choices) or "."
    return InputError(f"Unknown {what} {shown}{guess} {listed}{more}.")


def wrong_type(what: str, given: object, wanted: str) -> InputError:
    """Return the refusal of what is `given` for `what`, by its type; `wanted` follows "give"."""
    return InputError(f"{what} is of type {type(given).__name__}; give {wanted}.")


def path_of(given: object, what: str, wanted: str) -> Path:
    """The path `given`; raises InputError, which says what is `wanted`, for what is none."""
    if not isinstance(given, str | os.PathLike):
        raise wrong_type(what, given, wanted)
    return Path(given)


def number_of(given: object, what: str, unit: str = "") -> float:
    """The number `given`; raises InputError for texts, for truth values and for what is none."""
    if not isinstance(given, str | bytes | bool):
        try:
            return float(given)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            pass
    raise wrong_type(what, given, f"a number of {unit}" if unit else "a number")


def names_of(given: object, what: str) -> tuple[str, ...]:
    """The names `given`: several, or one. Raises InputError for what are none."""
    if isinstance(given, str):
        return (given,)
    if not isinstance(given, Iterable):
        raise wrong_type(what, given, "names as texts")
    names = tuple(given)
    for name in names:
        if not isinstance(name, str):
            raise wrong_type(f"One of {what}", name, "names as texts")
    return names


def out_of_bounds(name: str, value: float, unit: str, lower: float, upper: float) -> InputError:
    """Return the refusal of a parameter's `value` in `unit`, which may be meant in degrees."""
    in_degrees = unit == "rad" and lower <= math.radians(value) <= upper
    advice = 'write unit = "deg" if that is what it is in' if in_degrees else "change the value"
    return InputError(
        f"Parameter '{name}' = {value:g} {unit} lies outside its bounds [{lower:g}, {upper:g}]"
        f" {unit}; {advice}."
    )


def nearest(name: str, known: Iterable[str], count: int = 3) -> list[str]:
    """Return so many of the `known` names that are nearest: those that hold `name` come first."""
    word = name.lower()

    def distance(other: str) -> tuple[bool, float]:
        return word not in other, -difflib.SequenceMatcher(None, word, other).ratio()

    return sorted(known, key=distance)[:count]


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return ": did you mean 'x'?" with the nearest of `known`; empty where none is near."""
    by_word = {other.lower(): other for other in known}
    near = difflib.get_close_matches(name.lower(), tuple(by_word), n=1)
    return f": did you mean '{by_word[near[0]]}'?" if near else ""
