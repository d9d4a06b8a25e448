"""Every effect of a set is held to the validation runs: some are of a machine that lacks one."""

from pathlib import Path

import pytest

from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.diagnose.confirm import rejected_on_validation
from ptp_symbolic.numeric.diagnose.fitted_model import fitted
from ptp_symbolic.numeric.diagnose.noise_floor import propagated_input_noise
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import over_whole_runs
from ptp_symbolic.numeric.diagnose.stepwise import StepwiseSearch
from tests.diagnose.spring_table import STIFFNESS, log, table_of

VALIDATION = (3, 4, 5, 6, 7)  # seeds of the validation runs


@pytest.mark.parametrize("still_there", [True, False])
def test_validation_runs_deny_an_effect_that_they_do_not_have(
    still_there: bool, tmp_path: Path
) -> None:
    """A spring and a delay, which is gone on the day of the validation runs: the set of both takes
    away most of the error there as well, by the spring.
    """

    def logged(seed: int) -> Log:
        return log(seed, STIFFNESS, late=2 if still_there or seed not in VALIDATION else 0)

    with table_of(tmp_path, logged, VALIDATION) as problem:
        proposals = propose(problem)
        problem, declared = over_whole_runs(problem, proposals)
        stepwise = StepwiseSearch(
            problem, declared, proposals, propagated_input_noise(problem, declared.fit)
        )
        both = tuple(
            min((c for c in problem.candidates if c.key == key), key=lambda c: len(c.free))
            for key in ("cable_spring@pan", "input_delay@pan")
        )
        start = declared.values | {f.name: f.start for c in both for f in c.free}
        whole = stepwise.polished(fitted(problem, both, start, None))
        found = rejected_on_validation(problem, whole, [stepwise.step(whole, c) for c in both])
    assert (found is None) is still_there
    assert found is None or found.candidate.key == "input_delay@pan"
