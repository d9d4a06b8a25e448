"""Exported C beside the fixed steps of the simulator: friction, gaps, impacts, samplers."""

from pathlib import Path

import numpy as np
import pytest

import ptp_symbolic as ptp
from ptp_symbolic.models.emission import possible_equations
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.symbolic.program.program import program
from ptp_symbolic.symbolic.targets.c99 import C99_DOUBLE
from tests.effects.test_backlash_kinds import platform as platform_of_kind
from tests.targets.c_library import COMPILERS, Stepped, compiled

pytestmark = pytest.mark.skipif(not COMPILERS, reason="no C compiler on this machine")
STEP, HOLD = 1e-3, 0.05  # s


def beside(platform: Platform, duration: float, volts: float, folder: Path) -> tuple[float, int]:
    """Largest difference of any state, and how many events the simulation notes."""
    machine = ptp.load(platform, catalogue_values=True)
    library = compiled(
        program(possible_equations(platform)), "machine", C99_DOUBLE, folder, COMPILERS[0]
    )
    times = HOLD * np.arange(round(duration / HOLD) + 1)
    swing = np.where(times // 5 % 3 == 0, 0.3, 1.0) * volts * np.sin(0.4 * np.pi * times)
    (name,) = machine.input_names
    run = machine.simulate(list(times), method="fixed_step", step=STEP, **{name: (times, swing)})
    start = np.array([run[state][0] for state in machine.state_names])
    found = Stepped(library, "machine", machine.parameter_vector()).run(
        start, times, swing[:, None], STEP
    )
    states = np.column_stack([run[state] for state in machine.state_names])
    return float(np.max(np.abs(found - states))), len(run.events)


def test_a_minute_of_stick_slip_and_gap_is_that_of_the_simulator(tmp_path: Path) -> None:
    difference, events = beside(read_platform("thesis-pan-drive"), 60.0, 3.0, tmp_path)
    assert events > 100
    assert difference < 1e-12


def test_a_sampled_servo_is_that_of_the_simulator(tmp_path: Path) -> None:
    difference, events = beside(read_platform("thesis-pan-servo"), 5.0, 0.1, tmp_path)
    assert events > 5
    assert difference < 1e-11


@pytest.mark.parametrize("kind", ["elastic_impact", "hysteresis_friction", "hysteresis_inertia"])
def test_rigid_faces_strike_as_in_the_simulator(kind: str, tmp_path: Path) -> None:
    difference, events = beside(platform_of_kind(kind), 20.0, 6.0, tmp_path)
    assert events > 20
    assert difference < 1e-11
