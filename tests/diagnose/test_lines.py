"""Frequencies are found by a full scan, also in long logs."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.regression import lines, regression
from ptp_symbolic.numeric.diagnose.responses import _place
from ptp_symbolic.numeric.diagnose.signatures import Signature, _strongest
from ptp_symbolic.numeric.identify.constants import CYCLES_APART, LEAST_CYCLES
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from tests.identify.curves import Floats


def space_of(time: Floats, angle: Floats) -> Any:
    """One axis that was measured at `angle`, with a row at every sample."""
    rows = np.zeros(len(time), dtype=np.int64)
    run = SimpleNamespace(
        time=time,
        signals=("theta_pan",),
        measured=angle[:, None],
        weight=np.array([1e6]),
        counts=np.array([np.nan]),
    )
    return SimpleNamespace(
        labels=lambda: (rows, rows, time),
        runs=(run,),
        half_width=0.05,
        model=SimpleNamespace(module=SimpleNamespace(AXES=("pan",))),
    )


def flat(rows: int) -> Floats:
    """A candidate whose wave has the same size everywhere."""
    return np.full((rows, 1), rows**-0.5)


def locked_to(place: str) -> Candidate:
    free = (free_parameter("n", 9.0, 0.5, 1e3),)
    return Candidate("cogging", "pan", "", "", free, {}, locked=("n", place))


@pytest.mark.parametrize("seconds", [10.0, 300.0])
@pytest.mark.parametrize("cycles", [8.3, 24.0, 61.0])
def test_cogging_is_found_at_its_cycles_per_turn(cycles: float, seconds: float) -> None:
    """To the spacing of the scan; the axis sways by 1.4 rad, slowly in long logs."""
    time = np.linspace(0.0, seconds, 6000)
    angle = 1.4 * np.sin(2.0 * np.pi * time / seconds)
    residual = 0.3 * np.sin(cycles * angle + 0.4)
    residual += 0.3 * np.random.default_rng(2).standard_normal(6000)
    space = space_of(time, angle)
    (found, *_), _, _ = _strongest(space, locked_to("angle"), residual, np.ones(6000), flat(6000))
    assert found == pytest.approx(cycles, abs=CYCLES_APART / (2.8 / (2.0 * np.pi)))


def test_a_slow_wave_is_no_line() -> None:
    """Two thirds of a turn hold three cycles of four and a half per turn, not of two."""
    time = np.linspace(0.0, 20.0, 4000)
    angle = (2.0 / 3.0) * np.pi * np.sin(2.0 * np.pi * time / 20.0)
    (found, *_), lowest, _ = _strongest(
        space_of(time, angle), locked_to("angle"), np.sin(2.0 * angle), np.ones(4000), flat(4000)
    )
    assert found >= LEAST_CYCLES * 1.5 - 1e-6
    assert lowest == pytest.approx(0.9 * 4.5, rel=1e-6)


def test_a_line_in_time_is_found_in_hertz() -> None:
    time = np.linspace(0.0, 60.0, 12000)
    residual = np.sin(2.0 * np.pi * 7.31 * time) + np.random.default_rng(3).standard_normal(12000)
    space = space_of(time, np.zeros(12000))
    (found, *_), _, apart = _strongest(
        space, locked_to("time"), residual, np.ones(12000), flat(12000)
    )
    assert found == pytest.approx(7.31, abs=CYCLES_APART / 60.0)
    half = space_of(time[:6000], np.zeros(6000))
    _, _, fewer = _strongest(half, locked_to("time"), residual[:6000], np.ones(6000), flat(6000))
    assert apart == pytest.approx(2 * fewer + LEAST_CYCLES, abs=3)  # lines 1/60 Hz apart, and 1/30


def test_a_line_is_found_on_what_turns_with_the_machine() -> None:
    """A base that shakes at 1.7 Hz in an unknown direction under an axis that turns by 0.4 Hz: the
    torque itself has lines at 1.3 and 2.1 Hz, and a stronger one of another origin.
    """
    time = np.linspace(0.0, 30.0, 6000)
    angle = 2.0 * np.pi * 0.4 * time
    residual = np.sin(2.0 * np.pi * 1.7 * time + 0.3) * np.sin(0.9 - angle)
    residual += 0.7 * np.sin(2.0 * np.pi * 3.1 * time)
    carriers = np.linalg.qr(np.column_stack([np.sin(angle), np.cos(angle)]))[0]
    space = space_of(time, angle)
    (found, *_), _, _ = _strongest(space, locked_to("time"), residual, np.ones(6000), carriers)
    assert found == pytest.approx(1.7, abs=CYCLES_APART / 30.0)
    (plain, *_), _, _ = _strongest(space, locked_to("time"), residual, np.ones(6000), flat(6000))
    assert plain == pytest.approx(3.1, abs=CYCLES_APART / 30.0)


@pytest.mark.parametrize("hiding", [0.0, 1.0])
def test_a_line_beside_a_larger_effect_is_found(hiding: float) -> None:
    """Cogging of 18 cycles per turn under a torque that has a stronger line at 6.8."""
    time = np.linspace(0.0, 30.0, 6000)
    angle = 1.4 * np.sin(2.0 * np.pi * time / 30.0)
    larger = np.sin(6.8 * angle)
    rows = hiding * larger + 0.2 * np.sin(18.0 * angle + 0.4)
    rows += 0.1 * np.random.default_rng(5).standard_normal(6000)
    space, one = space_of(time, angle), np.zeros(6000, dtype=np.int64)
    smooth = Candidate("spring", "pan", "", "", (free_parameter("k", 1.0, -9.0, 9.0),), {})

    def scan(left: Floats) -> list[Signature]:
        (cycles, *_), _, _ = _strongest(space, locked_to("angle"), left, np.ones(6000), flat(6000))
        wave = np.column_stack([np.sin(cycles * angle), np.cos(cycles * angle)])
        candidate = replace(locked_to("angle"), shapes=({"n": cycles},))
        return [Signature(candidate, (tuple(wave.T),), frozenset(), np.linalg.qr(wave)[0])]

    column = larger[:, None] / np.linalg.norm(larger)
    known = Signature(smooth, ((larger,),), frozenset(), column)
    found = regression(
        rows,
        (),
        np.ones((6000, 1)),
        [known],
        one,
        np.column_stack([one, np.arange(6000) // 100]),
        np.ones(6000),
    )
    (line,) = lines(found, scan)
    spacing = CYCLES_APART / (2.8 / (2.0 * np.pi))
    assert line.candidate.shapes[0]["n"] == pytest.approx(18.0, abs=spacing)


def test_the_frequency_of_all_forms_is_that_of_the_simplest() -> None:
    """Cogging of 18 cycles per turn: six cycles with two harmonics more do all that it does."""
    angle = 1.4 * np.sin(2.0 * np.pi * np.linspace(0.0, 30.0, 6000) / 30.0)
    rows = 0.2 * np.sin(18.0 * angle + 0.4)
    rows += 0.1 * np.random.default_rng(5).standard_normal(6000)
    one = np.zeros(6000, dtype=np.int64)

    def scan(_: Floats) -> list[Signature]:
        found = []
        for cycles, harmonics in ((6.0, 1), (6.0, 3), (18.0, 1), (18.0, 3)):
            turns = [n * cycles * angle for n in range(1, harmonics + 1)]
            wave = np.column_stack([f(turn) for turn in turns for f in (np.sin, np.cos)])
            candidate = replace(
                locked_to("angle"), shapes=({"n": cycles},), member=int(harmonics > 1)
            )
            span = np.linalg.qr(wave)[0]
            found.append(Signature(candidate, (tuple(wave.T),), frozenset(), span))
        return found

    blocks = np.column_stack([one, np.arange(6000) // 100])
    found = regression(rows, (), np.ones((6000, 1)), [], one, blocks, np.ones(6000))
    placed = [(s.candidate.member, s.candidate.shapes[0]["n"]) for s in lines(found, scan)]
    assert placed == [(0, 18.0), (1, 18.0)]


def test_of_several_lines_the_strongest_come_first() -> None:
    time = np.linspace(0.0, 60.0, 12000)
    residual = sum(a * np.sin(2.0 * np.pi * f * time) for a, f in ((1.0, 2.3), (3.0, 7.3)))
    space = space_of(time, np.zeros(12000))
    found, _, _ = _strongest(space, locked_to("time"), residual, np.ones(12000), flat(12000))
    assert found[:2] == pytest.approx([7.3, 2.3], abs=CYCLES_APART / 60.0)


def test_how_far_and_how_fast_a_place_goes() -> None:
    """An axis that sways goes more slowly than 0.71 of its largest rate half of the time."""
    time = np.linspace(0.0, 20.0, 4001)
    space: Any = space_of(time, 1.4 * np.sin(2.0 * np.pi * time / 20.0))
    trial: Any = SimpleNamespace(fit=SimpleNamespace(runs=space.runs))
    turns, usual, rows = _place(space, trial, locked_to("angle"))
    assert turns == pytest.approx(2.8 / (2.0 * np.pi))
    assert usual == pytest.approx(1.4 / 20.0 * np.sqrt(0.5), rel=5e-3)  # rates over a window
    assert rows == 4001
    assert _place(space, trial, locked_to("time")) == (20.0, 1.0, 4001)
