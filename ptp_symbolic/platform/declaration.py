"""The declared machine as plain data: what a platform TOML says, checked and in SI units."""

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from ptp_symbolic.errors import InputError

AXES = ("pan", "tilt")  # that a platform may have, base first
STANDARD_GRAVITY = 9.81  # m/s^2
SITES = ("gear", "joint")  # where on its axis an effect may sit
JOINTS = ("rotary", "linear")  # kinds of a joint
INTERPOLATIONS = ("hold", "linear")  # of an input between its samples
MOTIONS = ("rad/s", "rad/s^2", "m/s", "m/s^2")  # units of what a body does


@dataclass(frozen=True)
class ParameterDeclaration:
    """One parameter that the platform sets: known, free (to be fitted) or tied to another one.

    `value` is the known value, the start value of a free parameter, or the value of the parameter
    it is tied to. Numbers are in `unit`, an SI unit; `unit` None means the effect's own unit and
    bounds None the effect's own bounds. `lower` and `upper` are given together. `uncertainty` says
    by how much a known value may be off at most; None where the platform does not say.
    """

    name: str
    unit: str | None
    value: float
    free: bool = False
    lower: float | None = None
    upper: float | None = None
    same_as: str | None = None
    uncertainty: float | None = None


def effect_key(effect: str, axis: str | None) -> str:
    """Id and axis of an effect in one word, e.g. ``cable_spring@pan``."""
    return effect if axis is None else f"{effect}@{axis}"


@dataclass(frozen=True)
class EffectDeclaration:
    """One effect of the platform: its id, the axis it acts on, and where on the drive train.

    `axis` is None for an effect of the whole platform. `site` is "gear" (at the gear output),
    "joint" (at the load) or None (the effect's own place). `kind` chooses among the kinds of an
    effect that has several, None its usual one.
    """

    effect: str
    axis: str | None
    site: str | None
    kind: str | None = None


def interpolation_of(unit: str) -> str:
    """What an input in the SI `unit` is between its samples: "linear" for the motion of a body,
    which sensors sample; "hold" for a torque, a voltage or a set-point, which a converter holds.
    """
    return "linear" if unit in MOTIONS else "hold"


@dataclass(frozen=True)
class SignalDeclaration:
    """One signal of the logs and the quantity of the model that it measures or sets.

    `signal` is the model's name (u_pan, theta_pan), `column` the CSV column without its unit,
    `unit` the SI unit of the model, `role` "input" or "output". `noise` is the rms noise in `unit`,
    `counts_per_revolution` the resolution of an encoder on a rotary joint, `counts_per_metre` that
    of one on a linear joint, all of the signal, not of its column.

    With a `scale`, in `unit` per number of the column, the signal is scale (number - offset);
    without one it is the column, its unit converted, less the `offset` in `unit`. An output whose
    time stamp is t was measured at t - `delay`, an input acts on the machine at t + `delay`, in s.
    `column_unit` is the unit of a column whose heading has none; None for `unit`. `interpolation`
    is one of INTERPOLATIONS, what an input is between its samples; None for what suits its unit.
    """

    signal: str
    column: str
    unit: str
    role: str
    counts_per_revolution: int | None = None
    noise: float | None = None
    counts_per_metre: float | None = None
    scale: float | None = None
    offset: float = 0.0
    delay: float = 0.0
    column_unit: str | None = None
    interpolation: str | None = None

    @property
    def between_samples(self) -> str:
        """What an input is between its samples, one of INTERPOLATIONS: as declared, or else as
        `interpolation_of` its unit.
        """
        return self.interpolation or interpolation_of(self.unit)

    @property
    def count(self) -> float | None:
        """The size of one encoder count in rad or m; None of a signal without an encoder."""
        if self.counts_per_revolution is not None:
            return 2.0 * math.pi / self.counts_per_revolution
        return None if self.counts_per_metre is None else 1.0 / self.counts_per_metre

    @property
    def is_position(self) -> bool:
        """Whether it is the angle of a rotary joint or the position of a linear one."""
        return self.unit in ("rad", "m")


@dataclass(frozen=True)
class Clock:
    """The times of a log: name of their column (None: time or t), and its unit where the heading
    gives none.
    """

    column: str | None = None
    unit: str | None = None


@dataclass(frozen=True)
class Platform:
    """A declared machine. `axes` are ordered pan, tilt; `gravity` is in m/s^2.

    The joints of `linear_axes` slide, in m, N and kg; those of all other axes turn.
    `window` is the length in s of the windows into which a fit cuts runs, None where it finds that
    by itself, and `material` the share of the error that an effect has to take away for a name,
    None for the usual one; `clock` is the column of times. `source` is the file that says so, for
    messages; None where there is none.
    """

    name: str
    title: str
    axes: tuple[str, ...]
    gravity: float
    effects: tuple[EffectDeclaration, ...]
    parameters: tuple[ParameterDeclaration, ...]
    signals: tuple[SignalDeclaration, ...]
    window: float | None = None
    clock: Clock = Clock()
    linear_axes: tuple[str, ...] = ()
    source: str | None = field(default=None, compare=False, repr=False)
    material: float | None = None


@contextmanager
def naming_file(platform: Platform) -> Iterator[None]:
    """Let every InputError raised inside name the file that declares `platform`."""
    try:
        yield
    except InputError as wrong:
        if platform.source is None or str(wrong).startswith(f"{platform.source}:"):
            raise
        raise InputError(f"{platform.source}: {wrong}") from wrong
