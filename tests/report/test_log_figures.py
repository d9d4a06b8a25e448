"""Figures of a log: a gap in the sampling stays open, white noise has its line."""

import re

import numpy as np
import pytest

from ptp_symbolic.report.log_figures import Shown, log_figure

TIME = 0.01 * np.arange(300)


def longest_line(svg: str) -> str:
    """The path with the most points."""
    return max(re.findall(r'd="([^"]*)"', svg), key=lambda path: path.count("L"))


@pytest.mark.parametrize(("pause", "pieces"), [(0.0, 1), (0.05, 1), (0.5, 2)])
def test_a_pause_of_more_than_ten_periods_parts_the_line(pause: float, pieces: int) -> None:
    time = TIME + np.where(np.arange(300) >= 150, pause, 0.0)
    svg = log_figure(time, [Shown("theta_pan", "rad", "output", np.sin(9.0 * time), 0.0)])
    assert longest_line(svg).count("M") == pieces


def test_the_line_of_the_noise_is_where_the_spectrum_of_white_noise_is() -> None:
    """Noise of rms 0.02 V: both are at the same height, within the scatter of eleven segments."""
    noise = 0.02 * np.random.default_rng(3).standard_normal(3000)
    svg = log_figure(0.01 * np.arange(3000), [Shown("u", "V", "input", noise, 0.02)])
    (dashed,) = re.findall(r'd="M \S+ (\S+) *\s*L \S+ \S+ *"[^>]*stroke-dasharray', svg)
    points = [re.findall(r"L (\S+) (\S+)", path) for path in re.findall(r'd="([^"]*)"', svg)]
    (spectrum,) = (p for p in points if len(p) > 50 and min(float(x) for x, _ in p) > 450.0)
    heights = [float(y) for _, y in spectrum]
    assert float(dashed) == pytest.approx(np.median(heights), abs=0.5 * float(np.std(heights)))
