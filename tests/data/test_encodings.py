"""Logs in the encodings in which spreadsheets and loggers write a degree sign."""

from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import read_log
from tests.data.test_log import GOOD, HEADER, PLATFORM, ROWS, write


@pytest.mark.parametrize("encoding", ["cp1252", "utf-16", "utf-16-be", "utf-8"])
def test_other_encodings_than_utf8_are_understood(tmp_path: Path, encoding: str) -> None:
    degrees = [f"{row.rpartition(',')[0]},{np.degrees(0.1 * k):.9f}" for k, row in enumerate(ROWS)]
    text = "\n".join(["# Größe", HEADER.replace("[rad]", "[°]"), *degrees]) + "\n"
    mark = "\ufeff" if encoding == "utf-16-be" else ""
    log = read_log(write(tmp_path, (mark + text).encode(encoding)), PLATFORM)
    np.testing.assert_allclose(log.outputs[:, 0], 0.1 * np.arange(12), rtol=1e-7)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (GOOD.encode().replace(b"4.50", b"\x81"), r"run.csv:5: is not text \(byte 0x81, not UTF-8"),
        (b"\xef\xbb\xbf" + GOOD.encode().replace(b"4.50", b"\xb0"), r"run.csv:5: is not text"),
        (GOOD.encode("utf-16-le"), "is not text"),
        (GOOD.encode("utf-16") + b"\x00", "is not text"),
    ],
)
def test_what_is_in_no_encoding_is_refused(tmp_path: Path, content: bytes, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_log(write(tmp_path, content), PLATFORM)
