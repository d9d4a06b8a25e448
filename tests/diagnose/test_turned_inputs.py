"""A motor that is wired the other way round is told from a machine that lacks something."""

from dataclasses import replace
from pathlib import Path

import pytest

from ptp_symbolic.numeric.diagnose.preparation import inverted_inputs
from ptp_symbolic.numeric.diagnose.proposals import propose
from ptp_symbolic.numeric.diagnose.refits import fit_declared
from tests.diagnose.spring_table import log, table_of


@pytest.mark.parametrize(("sign", "stiffness"), [(-1.0, 0.0), (1.0, 0.0), (1.0, 0.8)])
def test_a_torque_with_its_sign_turned_is_said(
    tmp_path: Path, sign: float, stiffness: float
) -> None:
    """Neither a perfect table nor one that lacks its spring is called wired wrongly."""

    def logged(seed: int):
        run = log(seed, stiffness)
        return replace(run, inputs=sign * run.inputs)

    with table_of(tmp_path, logged) as problem:
        problem, declared = fit_declared(problem, propose(problem))
        found = inverted_inputs(problem, declared)
    assert len(found) == (1 if sign < 0.0 else 0)
    assert all("sign of 'tau_pan' inverted" in text for text in found)
