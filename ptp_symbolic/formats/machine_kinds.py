"""The kinds of machine for which there is a platform file to start from."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Kind:
    """A kind of machine: the title of its file, its axes, and whether its joint is linear."""

    title: str
    axes: tuple[str, ...]
    linear: bool = False


MACHINES = {
    "pan-tilt": Kind("Pan-tilt platform with a payload", ("pan", "tilt")),
    "pan": Kind("One rotary axis", ("pan",)),
    "tilt": Kind("One rotary axis with a payload that gravity acts on", ("tilt",)),
    "linear": Kind("One linear axis", ("pan",), True),
}
DRIVES = ("motor", "torque")
