"""What the benchmark asks of a machine, and the records that pass between its parts."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from tests.benchmark.variation import Variation

Floats = NDArray[np.float64]
Values = Mapping[str, float]
Declared = dict[str, Any]  # a platform as TOML data


@dataclass(frozen=True)
class Run:
    """One recording to be made.

    path "train/NAME" or "validate/NAME", period in s, command [n, inputs] (voltages, or the
    feedforward of a servo), start (what the machine starts from), kept [n] (False where the
    computer stalls: no row, the input stays), gust and switch [n + 1, joints]: torques of unit
    size, linear between samples; reference [n, joints, 2] (angles and rates) and the servo that
    tracks it, where there is one.
    """

    path: str
    period: float
    command: Floats
    start: Floats
    kept: NDArray[np.bool_]
    gust: Floats
    switch: Floats
    reference: Floats | None = None
    servo: Any = None

    @property
    def time(self) -> Floats:
        """Sample times [n] in s."""
        return self.period * np.arange(len(self.command))


class Recording(NamedTuple):
    """A run as the machine made it: inputs [n, inputs] as applied, states [n, ...]."""

    run: Run
    inputs: Floats
    states: Floats


class Machine(Protocol):
    """A machine of the benchmark; `values` are parameters by name, hidden ones included."""

    name: str
    axes: tuple[str, ...]
    voltage_driven: bool

    def draw(self, rng: np.random.Generator, variation: Variation) -> dict[str, float]:
        """True values of all parameters of the machine, nothing hidden."""
        ...

    def free(self, variation: Variation) -> tuple[str, ...]:
        """The declared free parameters."""
        ...

    def declared(self, values: Values, variation: Variation) -> Declared:
        """The platform as its owner declares it."""
        ...

    def runs(
        self, rng: np.random.Generator, values: Values, variation: Variation
    ) -> tuple[Run, ...]:
        """The runs of a set, training first."""
        ...

    def record(self, values: Values, run: Run) -> Recording:
        """The run as the machine with `values` makes it."""
        ...

    def replay(
        self, values: Values, recording: Recording, inputs: Floats | None = None, shift: int = -1
    ) -> Floats:
        """States along the recording's inputs (or others), window by window from its states.

        `shift` moves one coordinate of every window's start by SHIFT_SIZE.
        """
        ...

    def window(self, run: Run) -> int:
        """Samples after which a replay starts anew from the recorded state."""
        ...

    def shifts(self) -> int:
        """How many coordinates of a start are unknown."""
        ...

    def readings(self, values: Values, states: Floats, variation: Variation) -> Floats:
        """Outputs [n, outputs] without noise and rounding: angles, then currents."""
        ...

    def coulomb(self, axis: str) -> float:
        """Coulomb torque in N m that `axis` is declared with, or would be."""
        ...

    def torque(self, values: Values, recording: Recording, states: Floats) -> Floats:
        """Torque [n, joints] in N m of all that an effect may change, along `states`."""
        ...


SHIFT_SIZE = 1e-4  # rad, or rad/s for a rate
CURRENT_NOISE = 4e-3  # A rms


def angle_floor(variation: Variation) -> float:
    """Root mean square in rad of the encoder's rounding and noise together."""
    count = 2.0 * np.pi / variation.counts
    return float(count * np.hypot(1.0 / np.sqrt(12.0), variation.noise_counts))


def push(values: Values, run: Run, axes: tuple[str, ...]) -> Floats:
    """Torques [n + 1, joints] in N m that follow no law of the state."""
    gust = np.array([values.get(f"gust_torque_{axis}", 0.0) for axis in axes])
    switch = np.array([values.get(f"switched_torque_{axis}", 0.0) for axis in axes])
    return gust * run.gust + switch * run.switch


def unit_pushes(
    rng: np.random.Generator, samples: int, period: float, correlation_time: float, joints: int
) -> tuple[Floats, Floats]:
    """Torques [samples + 1, joints] of unit size: a random one, and one that is on for a while."""
    switch = np.zeros((samples + 1, joints))
    first, last = np.sort(rng.integers(samples // 8, 7 * samples // 8, 2))
    switch[first:last] = 1.0
    gusts = [random_walk(rng, samples + 1, period, correlation_time) for _ in range(joints)]
    return np.column_stack(gusts), switch


def random_walk(
    rng: np.random.Generator, samples: int, period: float, correlation_time: float
) -> Floats:
    """Ornstein-Uhlenbeck process [samples] of unit size, exact at the sample times."""
    keep = np.exp(-period / correlation_time)
    shocks = rng.normal(size=samples) * np.sqrt(1.0 - keep**2)
    shocks[0] = rng.normal()
    return autoregression(shocks, keep)


def autoregression(shocks: Floats, pole: float) -> Floats:
    """First-order autoregressive sequence [n] driven by `shocks` [n]."""
    return np.asarray(lfilter([1.0], [1.0, -pole], shocks))


def stalls(rng: np.random.Generator, samples: int, share: float) -> NDArray[np.bool_]:
    """Rows that are kept [samples]: all, or all but 2 to 4 bursts that hold `share` of them."""
    kept = np.ones(samples, dtype=bool)
    bursts = int(rng.integers(2, 5))
    length = round(share * samples / bursts)
    for begin in rng.integers(1, max(2, samples - length), bursts):
        kept[begin : begin + length] = False
    return kept


def hold_in_stalls(command: Floats, kept: NDArray[np.bool_]) -> Floats:
    """The command [n, ...] with the last value kept before each stall held through it."""
    last = np.maximum.accumulate(np.where(kept, np.arange(len(kept)), 0))
    return command[last]
