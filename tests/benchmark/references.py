"""What a servo is asked to track: angles over time within a reach, with their rates."""

import math

import numpy as np

from tests.benchmark.machine import Floats

WAVES = (0.1, 0.23, 0.47, 0.81, 1.7, 3.1)  # Hz
SHORT_WAVES = (0.47, 0.81, 1.3, 1.7, 2.4, 3.1)  # Hz, where the arc is short
SMOOTHING = 0.06  # s over which corners are rounded


def with_rates(angle: Floats, period: float) -> Floats:
    """Angles [n] and their rates as [n, 2]."""
    return np.column_stack([angle, np.gradient(angle, period)])


def rounded(angle: Floats, period: float) -> Floats:
    """Angles [n] with corners rounded by a running mean over SMOOTHING."""
    width = max(1, round(SMOOTHING / period))
    padded = np.concatenate([np.full(width, angle[0]), angle, np.full(width, angle[-1])])
    kernel = np.hanning(width + 2)[1:-1]
    return np.convolve(padded, kernel / kernel.sum(), mode="same")[width:-width]


def waves(
    t: Floats, rng: np.random.Generator, reach: float, fastest: float, short: bool = False
) -> Floats:
    """Six sines that fall with the frequency, within `reach` in rad and `fastest` in rad/s."""
    frequencies = np.array(SHORT_WAVES if short else WAVES) * rng.uniform(0.95, 1.05, 6)
    angles = 2 * math.pi * np.outer(t, frequencies) + rng.uniform(0, 2 * math.pi, 6)
    wave = (np.sin(angles) / frequencies**1.5).sum(axis=1)
    wave *= reach / np.max(np.abs(wave))
    rate = np.max(np.abs(np.gradient(wave, t[1] - t[0])))
    return wave * min(1.0, fastest / rate)


def faded_in(t: Floats, wave: Floats, time: float = 0.6) -> Floats:
    """The same motion begun from rest."""
    fade = np.sin(0.5 * math.pi * np.clip(t / time, 0.0, 1.0)) ** 2
    return wave[0] + fade * (wave - wave[0])


def crawl(t: Floats, centre: float, speeds: tuple[float, ...], half: float) -> Floats:
    """To and fro about `centre` at several slow speeds in rad/s, `half` s each way."""
    number = (t // half).astype(int)
    speed = np.array(speeds)[number // 2 % len(speeds)]
    rate = np.where(number % 2 == 0, speed, -speed)
    return centre + np.concatenate([[0.0], np.cumsum(rate[:-1] * np.diff(t))])


def moves(t: Floats, stops: tuple[float, ...], rests: tuple[float, ...], speed: float) -> Floats:
    """From stop to stop in rad at `speed` in rad/s, a rest in s before each; then over again."""
    times, angles = [0.0], [stops[0]]
    k = 0
    while times[-1] < t[-1]:
        goal = stops[(k + 1) % len(stops)]
        times.append(times[-1] + rests[k % len(rests)])
        angles.append(angles[-1])
        times.append(times[-1] + abs(goal - angles[-1]) / speed + 1e-3)
        angles.append(goal)
        k += 1
    return np.interp(t, times, angles)


def creeps(t: Floats, low: float, high: float, rests: tuple[float, ...]) -> Floats:
    """Slowly from `low` to `high` in equal pieces, with a rest in s before each piece."""
    pieces = len(rests)
    moving = (t[-1] - sum(rests)) / pieces
    times, angles = [0.0], [low]
    for k, rest in enumerate(rests):
        times += [times[-1] + rest, times[-1] + rest + moving]
        angles += [angles[-1], low + (high - low) * (k + 1) / pieces]
    return np.interp(t, times, angles)
