"""Signatures of all candidates along a motion that is known in closed form."""

from collections.abc import Iterator

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.proposals import ProposedSets, propose
from ptp_symbolic.numeric.diagnose.regression import remainder
from ptp_symbolic.numeric.diagnose.responses import projected_off
from tests.diagnose.spring_table import spring_table


@pytest.fixture(scope="module")
def proposals(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ProposedSets]:
    with spring_table(tmp_path_factory.mktemp("table")) as problem:
        yield propose(problem)


def test_every_signature_is_finite_and_of_full_rank(proposals: ProposedSets) -> None:
    """Columns are orthonormal by the first weights; later ones bend that a little."""
    rows = proposals.regression
    assert rows is not None
    root = np.sqrt(rows.weight)[:, None]
    assert len({s.candidate.key for s in rows.signatures}) > 8
    for s in rows.signatures:
        assert np.isfinite(s.columns).all(), s.candidate.key
        assert all(np.isfinite(slope).all() for at in s.slopes for slope in at), s.candidate.key
        assert np.linalg.cond(s.columns * root) < 2.0, s.candidate.key


def test_the_spring_takes_up_what_the_declared_model_leaves(proposals: ProposedSets) -> None:
    """The torque k theta is all that is missing; what stays is rounding of the angle."""
    rows = proposals.regression
    assert rows is not None
    root = np.sqrt(rows.weight)
    left = remainder(rows) * root
    base = rows.base * root[:, None]
    shares = {}
    for s in rows.signatures:
        columns = np.column_stack([base, s.columns * root[:, None]])
        whole = float(projected_off(left[:, None], base)[:, 0] @ left)
        after = projected_off(left[:, None], columns)[:, 0]
        key = s.candidate.key
        shares[key] = min(shares.get(key, 1.0), float(after @ after) / whole)
    assert min(shares, key=lambda key: shares[key]) == "cable_spring@pan"
    assert shares["cable_spring@pan"] < 0.05
    assert shares["quadratic_drag@pan"] > 0.5
