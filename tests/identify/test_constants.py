"""What the table of constants says of them, worked out anew."""

import re
from math import comb
from pathlib import Path

import numpy as np
import pytest
from scipy import integrate, signal, stats

from ptp_symbolic.numeric.diagnose.preparation import SEEN
from ptp_symbolic.numeric.identify import constants as c
from ptp_symbolic.numeric.identify import noise
from ptp_symbolic.numeric.identify.blocks import MANY_RUNS
from ptp_symbolic.numeric.identify.weak_form import weak_average


def said(name: str, checkout: Path) -> str:
    """What the table says of a constant."""
    text = (checkout / "ptp_symbolic/numeric/identify/constants.py").read_text(encoding="utf-8")
    found = re.search(rf"^{name} = [^#\n]*#(.*)$", text, re.MULTILINE)
    assert found is not None
    return found[1]


def bell(s: float) -> float:
    """The test function of rows."""
    return float((1.0 - s**2) ** 4)


def wave_left(cycles: float) -> float:
    """Share of a wave with so many cycles in a window that the average under the bell leaves."""
    whole = integrate.quad(bell, -1.0, 1.0)[0]
    return float(integrate.quad(lambda s: bell(s) * np.cos(np.pi * cycles * s), -1, 1)[0] / whole)


def curvature_off(samples: float) -> float:
    """Largest relative error of the second derivative of a parabola, not normalised."""
    n = int(samples)
    off = []
    for shift in np.linspace(0.0, 1.0, 11):
        s = -1.0 + (np.arange(n + 1) + shift) * 2.0 / n
        s = s[s <= 1.0]
        bent = (1.0 - s**2) ** 2 * (48.0 * s**2 - 8.0 * (1.0 - s**2))
        off.append(abs(np.sum(0.5 * bent * s**2) / np.sum((1.0 - s**2) ** 4) - 1.0))
    return float(max(off))


def huber_efficiency(bend: float) -> float:
    """Efficiency of Huber's estimate of a place for normal numbers (Huber, 1981, 4.5)."""
    inside = stats.norm.cdf(bend) - stats.norm.cdf(-bend)
    square = integrate.quad(lambda x: x**2 * stats.norm.pdf(x), -bend, bend)[0]
    return float(inside**2 / (square + 2.0 * bend**2 * stats.norm.sf(bend)))


def gap_off() -> float:
    """Largest error of the mean second derivative of a quartic where almost LARGEST_GAP is
    missing.
    """
    off = []
    spacing = 1.0 / 32.0
    for middle in np.linspace(-0.8, 0.8, 33):
        time = np.arange(-64, 65) * spacing
        time = time[np.abs(time - middle) > 0.5 * (c.LARGEST_GAP - 2.0 * spacing)]
        at = np.flatnonzero(time == 0.0)
        if at.size:
            found = weak_average(time, time[:, None] ** 4, 1.0, 2, at)[0, 0]
            off += [abs(found / (12.0 / 11.0) - 1.0)] if np.isfinite(found) else []
    assert len(off) > 10
    return float(max(off))


def neighbours() -> float:
    """Correlation of averages of white noise under bells one row apart."""
    lag = 2.0 / c.ROWS_PER_WINDOW
    both = integrate.quad(lambda s: bell(s) * bell(s - lag), lag - 1.0, 1.0)[0]
    return float(both / integrate.quad(lambda s: bell(s) ** 2, -1.0, 1.0)[0])


def rms_off() -> float:
    """Relative standard deviation of the rms of the differences of white noise in four segments."""
    whole = [
        comb(2 * c.ORDER, c.ORDER + k) / comb(2 * c.ORDER, c.ORDER) for k in range(c.ORDER + 1)
    ]
    together = 1.0 + 2.0 * sum(rho**2 for rho in whole[1:])
    return float(np.sqrt(2.0 * together / (4 * c.SEGMENT)) / 2.0)


@pytest.mark.parametrize(
    ("name", "quoted", "value"),
    [
        ("FEWEST_BLOCKS", "12 %", stats.t.ppf(0.975, c.FEWEST_BLOCKS - 1) / 1.959964 - 1.0),
        ("MOST_BLOCKS", "5 %", 1.0 / np.sqrt(2.0 * (c.MOST_BLOCKS - 1))),
        ("REPLAYS", "7 %", 1.0 / np.sqrt(2.0 * (c.REPLAYS - 1))),
        ("RESAMPLES", "0.35 %", np.sqrt(0.025 * 0.975 / c.RESAMPLES)),
        ("REPEATS", "25 %", np.sqrt(2.0 / (4.0 * c.REPEATS))),
        ("DEVIATIONS", "99 %", huber_efficiency(c.DEVIATIONS)),
        ("SAMPLES_PER_WINDOW", "2e-4", curvature_off(c.SAMPLES_PER_WINDOW)),
        ("LEAST_SAMPLES", "6 %", curvature_off(c.LEAST_SAMPLES)),
        ("ATTENUATED", "11 %", wave_left(c.ATTENUATED)),
        ("CYCLES_APART", "3 %", 1.0 - np.sinc(c.CYCLES_APART / 2.0) ** 2),
        ("BINS_PER_CYCLE", "10 %", 1.0 - np.sinc(1.0 / c.BINS_PER_CYCLE)),
        ("ROWS_PER_WINDOW", "0.86", neighbours()),
        ("ORDER", "0.6 %", (2.0 * np.sin(0.1 * np.pi)) ** c.ORDER / np.sqrt(252.0)),
        ("ROUNDS", "1e-12", 0.5**c.ROUNDS),
        ("NOTHING", "2e-11", 1e5 * np.finfo(float).eps),
    ],
)
def test_a_derived_number_is_what_the_table_says(
    name: str, quoted: str, value: float, checkout: Path
) -> None:
    assert quoted in said(name, checkout)
    number = float(quoted.removesuffix(" %")) / (100.0 if quoted.endswith("%") else 1.0)
    assert value == pytest.approx(number, rel=0.3)


def test_a_gap_in_a_window_spoils_little(checkout: Path) -> None:
    assert "12 %" in said("LARGEST_GAP", checkout)
    assert gap_off() <= 0.13


@pytest.mark.parametrize("pole", [0.0, 0.5, 0.9])
def test_a_spectrum_settles_in_so_many_rounds(pole: float, monkeypatch: pytest.MonkeyPatch) -> None:
    series = signal.lfilter([1.0], [1.0, -pole], np.random.default_rng(4).standard_normal(8000))
    series += np.random.default_rng(5).standard_normal(8000)
    usual = noise.coloured_noise([series], 0.1).rms
    monkeypatch.setattr(noise, "ROUNDS", 20 * c.ROUNDS)
    assert usual == noise.coloured_noise([series], 0.1).rms


def test_numbers_that_follow_are_what_their_places_say() -> None:
    """See `white_noise`, `half_width_of`, `dependence_of`, `SEEN`, `MANY_RUNS`."""
    assert rms_off() == pytest.approx(0.08, rel=0.1)
    assert curvature_off(c.SAMPLES_PER_WINDOW / 2) == pytest.approx(0.003, rel=0.3)
    assert 0.5 ** (2 * c.CYCLES) == 1.0 / 64.0
    assert stats.norm.cdf(SEEN - stats.norm.ppf(0.975)) == pytest.approx(0.95)
    assert pytest.approx(1.0 / 0.05) == MANY_RUNS


@pytest.mark.parametrize(("name", "once_in"), [("FAR", 16_000), ("RESTING", 1_700_000)])
def test_noise_reaches_so_far_once_in(name: str, once_in: int, checkout: Path) -> None:
    assert f"{once_in:,}" in said(name, checkout)
    far = getattr(c, name)
    assert 2.0 * stats.norm.sf(far) == pytest.approx(1.0 / once_in, rel=0.05)


def test_periodograms_that_overlap_by_half_vary_as_their_tapers_say() -> None:
    """The mean of many varies by 1 + 2 r^2 times that of independent ones (Welch, 1967)."""
    beside = 35.0 / 18.0  # bins that a Hann taper makes one
    assert noise._mixed() == pytest.approx(19.0 / 18.0 * beside, rel=1e-12)
