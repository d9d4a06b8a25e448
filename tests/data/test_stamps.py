"""Times of a log may be dates with times of day."""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import read_log
from tests.data.test_log import GOOD, HEADER, PLATFORM, ROWS, write


@pytest.mark.parametrize(
    ("form", "separator"),
    [
        ("2026-11-26T11:59:59.{:03d}Z", ","),
        ("2026-11-26 12:59:59,{:03d}+01:00", ";"),
        ("2026-11-26T11:59:59.{:03d}000", ","),
    ],
)
def test_times_may_be_stamps(tmp_path: Path, form: str, separator: str) -> None:
    rows = [f"{form.format(940 + 5 * k)},{row.partition(',')[2]}" for k, row in enumerate(ROWS)]
    text = "\n".join([HEADER.replace("time [s]", "time"), *rows]) + "\n"
    if separator == ";":
        date, comma = form.split(",")[0], form[form.find(",") :][:1]
        text = "\n".join(
            line.replace(",", ";").replace(f"{date};", f"{date}{comma}")
            for line in text.split("\n")
        )
    log = read_log(write(tmp_path, text), PLATFORM)
    np.testing.assert_allclose(np.diff(log.time), 0.005, rtol=0, atol=1e-7)
    np.testing.assert_allclose(log.outputs[:, 0], 0.1 * np.arange(12), rtol=1e-14)


def test_a_stamp_that_is_no_time_and_one_among_signals_are_refused(tmp_path: Path) -> None:
    stamp = "2026-11-26T12:00:00Z"
    for old, new in (("\n0.0150,", f"\n{stamp[:5]}13{stamp[7:]},"), (",4.50,", f",{stamp},")):
        path = write(tmp_path, GOOD.replace(old, new))
        with pytest.raises(
            InputError, match=r"run.csv:5: '\w+' is '2026-1[0-9T:Z-]+', not a finite decimal"
        ):
            read_log(path, PLATFORM)
