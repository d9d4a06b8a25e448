"""What logs can show, against differences of closed-form motions of a spring table."""

from pathlib import Path

import numpy as np
import pytest
from scipy import stats
from scipy.linalg import expm

from ptp_symbolic.numeric.diagnose.fitted_model import fitted
from ptp_symbolic.numeric.diagnose.preparation import largest_limit, visible_amounts
from ptp_symbolic.numeric.identify.least_squares import all_values_at_start
from tests.diagnose.spring_table import COUNT, PAYLOAD, PERIOD, spring_table
from tests.identify.curves import Floats

STARTS = ("angle", "rate")
NAMES = {"J": "J_pan", "b": "b_pan"}


def motion(torque: Floats, change: dict[str, float], machine: dict[str, float]) -> Floats:
    """Angle [k] of J theta'' = tau + tau0 - k theta - b theta' under a torque held per sample."""
    m = {**machine, "tau0": 0.0, "angle": 0.0, "rate": 0.0}
    m = {name: value + change.get(name, 0.0) for name, value in m.items()}
    flow = np.zeros((3, 3))
    flow[0, 1] = 1.0
    flow[1] = np.array([-m["k"], -m["b"], 1.0]) / m["J"]
    step = expm(PERIOD * flow)
    state, angle = np.array([m["angle"], m["rate"]]), np.zeros(len(torque))
    for k, applied in enumerate(torque):
        angle[k] = state[0]
        state = (step @ [*state, applied + m["tau0"]])[:2]
    return angle


def test_a_constant_torque_and_free_parameters_against_closed_forms(tmp_path: Path) -> None:
    """The smallest change of a parameter is 3.6 standard deviations of an estimate beside all other
    unknowns: found in 95 % of cases where one in twenty is a false alarm, of either sign. Of an
    effect a tenth of the squared error shows, of which noise is the rest.
    """
    with spring_table(tmp_path) as problem:
        start = fitted(problem, (), {**problem.fixed, **all_values_at_start(problem.free)}, None)
        found = {(v.effect, v.parameter): v.smallest for v in visible_amounts(problem, start)}
        machine = {"J": start.values["J_pan"] + PAYLOAD, "b": start.values["b_pan"], "k": 0.0}
        torques = [run.held_inputs[:, 0] for run in problem.train]
        sigma = 1.0 / problem.train[0].weight[0]
    assert sigma == pytest.approx(COUNT / np.sqrt(12.0), rel=0.2)

    def column(word: str) -> Floats:
        """Central differences of all runs, per unit."""
        by = 1e-4 * machine.get(word, 0.1)
        ends = [
            np.concatenate([motion(t, {word: way * by}, machine) for t in torques])
            for way in (1, -1)
        ]
        return (ends[0] - ends[1]) / (2 * by * sigma)

    starts = []
    for word in STARTS:
        for index in range(len(torques)):
            parts = [0.0 * t for t in torques]
            ends = [motion(torques[index], {word: way * 1e-4}, machine) for way in (1, -1)]
            parts[index] = (ends[0] - ends[1]) / (2e-4 * sigma)
            starts.append(np.concatenate(parts))
    declared = {name: column(word) for word, name in NAMES.items()}
    seen = stats.norm.ppf(0.95) + stats.norm.ppf(0.975)
    named = np.sqrt(sum(len(t) for t in torques) / 9.0)
    assert named > seen

    def smallest(own: Floats, others: list[Floats], by: float = seen) -> float:
        table = np.column_stack([*others, *starts])
        rest = own - table @ np.linalg.lstsq(table, own, rcond=None)[0]
        return float(by / np.linalg.norm(rest))

    for name, own in declared.items():
        others = [c for n, c in declared.items() if n != name]
        assert found[None, name] == pytest.approx(smallest(own, others), rel=0.02), name
    torque = smallest(column("tau0"), list(declared.values()), named)
    assert found["constant_torque@pan", "tau0_pan"] == pytest.approx(torque, rel=0.02)


def test_the_largest_limit_that_shows_cuts_off_what_stands_out_of_the_noise() -> None:
    """A signal up to 24 V, cut at 21 V, leaves 100 standard deviations: 3.29 at 24 - 0.0329 * 3;
    the response is given per volt below 1000, where the limit vanishes. One that leaves one
    standard deviation shows at 24 - 3.29 * 3, one a tenth of that not at all.
    """
    for size, limit in ((100.0, 23.9013), (1.0, 14.13), (0.1, np.nan)):
        smallest = 3.29 * (1000.0 - 21.0) / size
        found = largest_limit(24.0, 21.0, 1000.0, smallest)
        assert found == pytest.approx(limit, abs=1e-9, nan_ok=True)
    assert np.isnan(largest_limit(24.0, np.nan, 1000.0, np.inf))
