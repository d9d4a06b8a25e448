"""Headlines where something is missing that has no name: the runs that show it are quoted."""

import pytest

from ptp_symbolic.numeric.diagnose import summary
from ptp_symbolic.numeric.diagnose.verdict import UNEXPLAINED
from tests.report.test_summary import _trial, _verdict


@pytest.mark.parametrize(
    ("train", "validate", "words"),
    [
        (2.0, 3.0, "3.000 counts rms on validation runs, the noise floor is 0.300 counts rms."),
        (0.3, 3.0, "3.000 counts rms on validation runs, the noise floor is 0.300 counts rms."),
        (0.3, 0.3, "0.300 counts rms on validation runs, the noise floor is 0.300 counts rms."),
        (
            2.0,
            0.32,
            "2.000 counts rms on training runs, the noise floor is 0.300 counts rms; the"
            " validation runs reach theirs.",
        ),
    ],
)
def test_the_runs_that_show_that_something_is_missing_are_quoted(
    train: float, validate: float, words: str
) -> None:
    def total(counts: float) -> dict[str, object]:
        return {"total": {"rmse_counts": counts, "rmse": 1e-3 * counts, "unit": "rad"}}

    errors = {
        part: {"before": total(left), "after": total(left), "noise_floor": total(0.3)}
        for part, left in (("train", train), ("validate", validate))
    }
    text = summary.headline(_verdict(UNEXPLAINED, _trial()), errors, {})
    assert text == f"Something is missing, and no known effect could be confirmed: {words}"
