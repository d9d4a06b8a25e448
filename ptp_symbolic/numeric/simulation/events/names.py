"""Changes of mode in words."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ptp_symbolic.numeric.runtime.model import Model

FloatArray = NDArray[np.float64]

SLIDING = {-1.0: "slides backward", 0.0: "sticks", 1.0: "slides forward"}
SWITCHING = {
    -2.0: "goes off beyond the lower threshold",
    -1.0: "goes on at the lower threshold",
    0.0: "is ready",
    1.0: "goes on at the upper threshold",
    2.0: "goes off beyond the upper threshold",
}
TOUCHING = {
    -4.0: "leans on the lower face",
    -3.0: "bounces off the lower face",
    -2.0: "lets go of the lower face",
    -1.0: "touches the lower face",
    0.0: "is in the gap",
    1.0: "touches the upper face",
    2.0: "lets go of the upper face",
    3.0: "bounces off the upper face",
    4.0: "leans on the upper face",
}


@dataclass(frozen=True)
class Event:
    """A change of mode: time in s, the element (``friction pan``, ``contact pan``), what it did."""

    time: float
    element: str
    mode: str


def named_events(model: Model, rows: FloatArray) -> tuple[Event, ...]:
    """The events of `rows` [e, 3]: time in s, element, mode entered."""
    frictions = [n.removeprefix("slide_") for n in model.mode_names if n.startswith("slide_")]
    contacts = [n.removeprefix("side_") for n in model.mode_names if n.startswith("side_")]
    events = []
    for time, element, mode in rows:
        index = int(element)
        if index < len(frictions):
            events.append(Event(float(time), f"friction {frictions[index]}", SLIDING[mode]))
        else:
            number = index - len(frictions)
            is_switch = number >= len(model.module.CONTACT_ANGLES)
            what, modes = ("switch", SWITCHING) if is_switch else ("contact", TOUCHING)
            events.append(Event(float(time), f"{what} {contacts[number]}", modes[mode]))
    return tuple(events)
