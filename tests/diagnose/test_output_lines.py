"""Waves are found by what they change in the outputs, on logs that SciPy integrates."""

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose import search as roads
from ptp_symbolic.numeric.diagnose.noise_floor import propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import over_whole_runs
from ptp_symbolic.numeric.diagnose.responses import at_lines_of_outputs
from ptp_symbolic.numeric.diagnose.stepwise import StepwiseSearch
from ptp_symbolic.numeric.identify.constants import CYCLES_APART
from tests.diagnose.spring_table import (
    COUNT,
    DAMPING,
    INERTIA,
    MASS,
    PERIOD,
    SAMPLES,
    spring_table,
    table_of,
)

SHAKES = 1.7  # Hz
SPAN = PERIOD * SAMPLES


def by_input_noise(seed: int) -> Log:
    """A table with a payload 0.1 m off its axis, on a base that accelerates by 0.5 m/s^2."""
    rng = np.random.default_rng(seed)
    torque = np.repeat(rng.uniform(-0.5, 0.5, SAMPLES // 50), 50)
    time = PERIOD * np.arange(SAMPLES)

    def slope(t: float, state: np.ndarray) -> list[float]:
        base = 0.5 * np.sin(2.0 * np.pi * SHAKES * t + 0.8)
        inertial = -MASS * base * np.array([np.cos(0.4), np.sin(0.4)])
        arm = 0.1 * np.array([np.cos(state[0]), np.sin(state[0])])
        acting = torque[min(int(t / PERIOD + 1e-9), SAMPLES - 1)]
        acting += arm[0] * inertial[1] - arm[1] * inertial[0] - DAMPING * state[1]
        return [state[1], acting / INERTIA]

    found = solve_ivp(slope, (0.0, time[-1]), [0.0, 0.0], t_eval=time, max_step=PERIOD, rtol=1e-8)
    reading = np.rint(found.y[0] / COUNT) * COUNT
    return Log(f"run_{seed}", time, torque[:, None], reading[:, None])


def test_a_base_that_shakes_is_found_at_its_frequency(tmp_path: Path) -> None:
    with table_of(tmp_path, by_input_noise) as problem:
        proposals = propose(problem)
        problem, declared = over_whole_runs(problem, proposals)
        found = at_lines_of_outputs(problem, proposals.space, declared, proposals.waves)
    assert {c.key for c in found} == {"base_motion"}
    (frequency,) = {shape["f_base"] for c in found for shape in c.shapes}
    assert frequency == pytest.approx(SHAKES, abs=CYCLES_APART / SPAN)
    assert all(f.start == frequency for c in found for f in c.free if f.name == "f_base")


def test_gusts_draw_no_line(tmp_path: Path) -> None:
    """Nor is anything looked for without rows, which tell how far to look."""
    with spring_table(tmp_path, stiffness=0.0, gust=0.05) as problem:
        proposals = propose(problem)
        problem, declared = over_whole_runs(problem, proposals)
        assert at_lines_of_outputs(problem, proposals.space, declared, proposals.waves) == ()
        assert at_lines_of_outputs(problem, None, declared, proposals.waves) == ()


def test_a_search_goes_on_at_the_lines_of_the_outputs(tmp_path: Path) -> None:
    """Where the rows show none, as if the machine had rested: the base is found with them alone."""
    with table_of(tmp_path, by_input_noise) as problem:
        proposals = propose(problem)
        blind = tuple(c for c in problem.candidates if c.locked is None)
        problem, declared = over_whole_runs(problem, proposals)
        stepwise = StepwiseSearch(
            problem, declared, proposals, propagated_input_noise(problem, declared.fit)
        ).among(blind)

        lined, found = roads._with_lines(stepwise, [], roads._proposed)
        assert any("base_motion" in t.keys and lined.is_white(t) for t in found)
        quiet = roads._with_lines(lined, found, lambda _: pytest.fail("looked for again"))
    assert quiet == (lined, found)
