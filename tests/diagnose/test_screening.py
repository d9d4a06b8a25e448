"""Candidates by themselves over short windows, on logs whose motion is known in closed form."""

from collections.abc import Iterator

import pytest

from ptp_symbolic.numeric.diagnose.fitted_model import SearchProblem
from ptp_symbolic.numeric.diagnose.proposals import declared_start, propose
from ptp_symbolic.numeric.diagnose.stepwise import screened
from ptp_symbolic.numeric.identify.constants import TRIED
from tests.diagnose.spring_table import INERTIA, PAYLOAD, STIFFNESS, spring_table


@pytest.fixture(scope="module")
def problem(tmp_path_factory: pytest.TempPathFactory) -> Iterator[SearchProblem]:
    with spring_table(tmp_path_factory.mktemp("table")) as made:
        yield made


def test_the_spring_comes_first_at_its_stiffness(problem: SearchProblem) -> None:
    found = screened(problem, propose(problem), (), problem.candidates, declared_start(problem))
    assert 1 < len(found) <= TRIED  # half of the others go after every iteration
    assert found[0].keys == ("cable_spring@pan",)
    assert found[0].values["k1_cable_pan"] == pytest.approx(STIFFNESS, rel=0.02)
    assert found[0].values["J_pan"] == pytest.approx(INERTIA - PAYLOAD, rel=0.02)
