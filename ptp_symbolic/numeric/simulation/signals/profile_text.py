"""Input profiles as a person types them on the command line: `step:24@0.5`, `constant:3`."""

import re
from collections.abc import Mapping, Sequence

from ptp_symbolic.errors import InputError, unknown
from ptp_symbolic.numeric.simulation.signals.inputs import (
    InputSignal,
    constant,
    cubic_transition,
    multisine,
    ramp,
    sine_sweep,
    step,
    trapezoid,
)

_N = r"([-+]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][-+]?\d+)?)"
_LIST = rf"({_N}(?:,{_N})*)"
# kind: (what follows the colon, example, what the numbers mean)
_FORMS = {
    "constant": (_N, "3", "value"),
    "step": (rf"(?:{_N}\.\.)?{_N}@{_N}", "24@0.5", "[before..]after@time"),
    "ramp": (rf"{_N}\.\.{_N}@{_N}\.\.{_N}(?:,{_N})?", "0..24@0..10", "start..end@t0..t1[,then]"),
    "trapezoid": (rf"{_N},{_N},{_N},{_N}(?:@{_N})?", "24,0.5,2.5,0.5", "level,rise,hold,fall[@t0]"),
    "cubic": (rf"{_N}\.\.{_N}@{_N}\.\.{_N}", "0..10@0..0.5", "start..end@t0..t1"),
    "sweep": (rf"{_N}@{_N}\.\.{_N}", "14@0.1..5", "amplitude@f0..f1 in Hz over the whole run"),
    "multisine": (rf"{_N}@{_LIST}", "12@0.3,0.7,1.1", "amplitude of each@frequencies in Hz"),
}


PROFILES = tuple(_FORMS)
_STRANGE = re.compile(r"(?<![a-z])(?:nan|inf(?:inity)?)(?![a-z])", re.IGNORECASE)


def as_signals(
    names: Sequence[str], given: Mapping[str, InputSignal | str], duration: float
) -> dict[str, InputSignal]:
    """Return the inputs `given` to a model whose inputs are `names`, profiles read into signals.

    `duration` in s is that of the run. Raises InputError for a name that is no input, for what is
    neither signal nor text, and as `parse_profile` does.
    """
    signals = {}
    for name, signal in given.items():
        if name not in names:
            raise unknown("input", name, names)
        if isinstance(signal, str):
            try:
                signal = parse_profile(signal, duration)
            except InputError as error:
                raise InputError(f"Input '{name}': {error}") from error
        if not isinstance(signal, InputSignal):
            raise InputError(
                f"Input '{name}' is of type {type(signal).__name__}; give a profile such as"
                " 'constant:3', or a signal of ptp_symbolic.numeric.simulation.signals.inputs."
            )
        signals[name] = signal
    return signals


def profile_forms() -> tuple[tuple[str, str], ...]:
    """Every kind of profile as an example and what its numbers mean."""
    return tuple((f"{kind}:{example}", rule) for kind, (_, example, rule) in _FORMS.items())


def parse_profile(text: str, duration: float) -> InputSignal:
    """Read one profile; times in s, values in the unit of the input that it drives.

    `duration` in s of the run: a sweep takes all of it. Raises InputError, with the list of forms,
    for anything that is not exactly one of them or whose numbers make no profile.
    """
    kind, _, body = text.strip().partition(":")
    pattern = _FORMS[kind][0] if kind in _FORMS else None
    found = re.fullmatch(pattern, body, re.ASCII) if pattern else None
    if found is None:
        strange = _STRANGE.search(body)
        why = f": {strange[0]} is no finite number" if strange else ""
        raise InputError(f"Profile {_shown(text)} is not understood{why}; use one of {_listed()}.")
    given = [None if group is None or "," in group else float(group) for group in found.groups()]
    try:
        return _profile(kind, body, given, duration)
    except InputError as error:
        raise InputError(f"Profile {_shown(text)}: {error} Forms: {_listed()}.") from error


def _profile(kind: str, body: str, given: list[float | None], duration: float) -> InputSignal:
    numbers = [0.0 if value is None else value for value in given]
    match kind:
        case "constant":
            return constant(numbers[0])
        case "step":
            return step(numbers[0], numbers[1], numbers[2])
        case "ramp":
            return ramp(numbers[0], numbers[1], numbers[2], numbers[3], given[4])
        case "trapezoid":
            return trapezoid(*numbers)
        case "cubic":
            return cubic_transition(*numbers)
        case "sweep":
            return sine_sweep(numbers[0], numbers[1], numbers[2], 0.0, duration)
    frequencies = [float(part) for part in body.partition("@")[2].split(",")]
    return multisine([numbers[0]] * len(frequencies), frequencies)


def _shown(text: str) -> str:
    return repr(text if len(text) <= 60 else text[:60] + "...")


def _listed() -> str:
    return ", ".join(f"{example} ({rule})" for example, rule in profile_forms())
