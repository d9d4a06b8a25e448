"""What differs from set to set beside the hidden effect: encoder, sampling, noise, start values."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

ENCODERS = {4_000: 0.2, 7_200: 0.4, 65_536: 0.25, 1_000_000: 0.15}  # counts per turn: share
FINE_ENCODERS = {65_536: 0.5, 1_000_000: 0.5}
PERIODS = {0.02: 0.12, 0.01: 0.2, 0.005: 0.5, 0.001: 0.18}  # s: share
NOISE_KINDS = {"none": 0.5, "white": 0.25, "coloured": 0.25}
# Counts rms, least and most, of encoder noise by counts per turn.
NOISE_COUNTS = {
    4_000: (0.5, 2.0),
    7_200: (0.5, 3.0),
    65_536: (2.0, 10.0),
    1_000_000: (10.0, 60.0),
}


@dataclass(frozen=True)
class Variation:
    """The surroundings of a set.

    Encoder noise: `noise_kind` "none", "white" or "coloured" (first-order autoregressive with
    `noise_pole` per sample), `noise_counts` rms before rounding. `input_noise` is what white noise
    on the logged inputs leaves in the simulated outputs, in multiples of the encoder's floor.
    `declared_*` says whether the platform states that noise. `stalls` is the share of rows that are
    missing, as the computer stalled and the input stayed; `far` puts the start values of inertia
    and dry friction 3 to 6 times off; `repeat` gives two runs the same command; `short_arc` keeps
    within 10 deg; `current` logs the motor current; `heavy` is the larger machine;
    `without` are effects, as effect@axis, that the platform does not declare this time.
    """

    counts: int = 7_200
    period: float = 0.005
    noise_kind: str = "none"
    noise_counts: float = 0.0
    noise_pole: float = 0.0
    declared_noise: bool = False
    input_noise: float = 0.0
    declared_input_noise: bool = False
    stalls: float = 0.0
    far: bool = False
    repeat: bool = False
    short_arc: bool = False
    current: bool = True
    heavy: bool = False
    without: tuple[str, ...] = ()


def _choose(rng: np.random.Generator, shares: Mapping) -> object:
    """One of the choices by its share."""
    weights = np.array(list(shares.values()))
    return list(shares)[int(rng.choice(len(weights), p=weights / weights.sum()))]


FAINT_NOISE_COUNTS = 3.0  # at most, where the effect needs a fine encoder
QUIET_NOISE_COUNTS = 0.3  # at most, of a coarse encoder beside small deviations


def for_faint_effects(variation: Variation) -> Variation:
    """The same with a fine encoder and little noise."""
    counts = max(variation.counts, min(FINE_ENCODERS))
    noise = min(variation.noise_counts, FAINT_NOISE_COUNTS)
    return replace(variation, counts=counts, noise_counts=noise)


def for_small_deviations(variation: Variation) -> Variation:
    """The same with 7,200 counts or more, and little noise."""
    most = FAINT_NOISE_COUNTS if variation.counts >= min(FINE_ENCODERS) else QUIET_NOISE_COUNTS
    noise = min(variation.noise_counts, most)
    return replace(variation, counts=max(variation.counts, 7_200), noise_counts=noise)


def draw_variation(
    seed: int, fine_encoder: bool, far: bool = False, short_arc: bool = False
) -> Variation:
    """The surroundings that belong to `seed`; `fine_encoder` is for machines with no gear."""
    rng = np.random.default_rng([seed, 1])
    counts = int(_choose(rng, FINE_ENCODERS if fine_encoder else ENCODERS))
    kind = str(_choose(rng, NOISE_KINDS))
    least, most = NOISE_COUNTS[counts]
    noise, pole = round(float(rng.uniform(least, most)), 3), float(rng.uniform(0.8, 0.95))
    input_noise = round(float(rng.uniform(0.2, 0.8)), 3) if rng.random() < 0.6 else 0.0
    return Variation(
        counts=counts,
        period=float(_choose(rng, PERIODS)),
        noise_kind=kind,
        noise_counts=0.0 if kind == "none" else noise,
        noise_pole=round(pole, 3) if kind == "coloured" else 0.0,
        declared_noise=kind != "none" and rng.random() < 0.5,
        input_noise=input_noise,
        declared_input_noise=input_noise > 0.0 and rng.random() < 0.6,
        stalls=round(float(rng.uniform(0.01, 0.03)), 4) if rng.random() < 0.12 else 0.0,
        far=far,
        repeat=rng.random() < 0.12,
        short_arc=short_arc,
        current=rng.random() < 0.5,
        heavy=rng.random() < 0.3,
    )
