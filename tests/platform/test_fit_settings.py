"""What a platform file says of the clock of its logs and of the windows of a fit."""

from pathlib import Path

import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import Clock, platform_text, read_platform
from tests.platform.test_platform_reader import GOOD, write


def test_the_length_of_windows_arrives_in_seconds(tmp_path: Path) -> None:
    assert read_platform(write(tmp_path, GOOD)).window is None
    for text, seconds in (("500 ms", 0.5), ("0.25 s", 0.25), ("1.5 min", 90.0)):
        assert read_platform(write(tmp_path, f'{GOOD}[fit]\nwindow = "{text}"\n')).window == seconds


@pytest.mark.parametrize("given", ["0.5", '"0.5"', '"0 s"', '"-1 s"', '"nan s"', '"1 m"', '"s"'])
def test_a_window_that_is_no_time_is_refused(tmp_path: Path, given: str) -> None:
    with pytest.raises(InputError, match=r'fit.window: .* is not a time above zero; write "0.5 s"'):
        read_platform(write(tmp_path, f"{GOOD}[fit]\nwindow = {given}\n"))


def test_the_share_that_earns_a_name_arrives_and_is_written_again(tmp_path: Path) -> None:
    assert read_platform(write(tmp_path, GOOD)).material is None
    found = read_platform(write(tmp_path, f"{GOOD}[fit]\nmaterial = 0.05\n"))
    assert found.material == 0.05
    again = write(tmp_path, platform_text(found))
    assert read_platform(again) == found


@pytest.mark.parametrize("given", ["0.0", "1.0", "-0.1", "5"])
def test_what_is_no_share_of_the_error_is_refused(tmp_path: Path, given: str) -> None:
    with pytest.raises(InputError, match=r"fit.material: .* is no share of the error; .* 0.05"):
        read_platform(write(tmp_path, f"{GOOD}[fit]\nmaterial = {given}\n"))


def test_the_clock_may_have_a_name_and_a_unit_of_its_own(tmp_path: Path) -> None:
    assert read_platform(write(tmp_path, GOOD)).clock == Clock()
    text = GOOD + '[log]\ntime = "clock"\ntime_unit = "ms"\n'
    assert read_platform(write(tmp_path, text)).clock == Clock("clock", "ms")
    for wrong, why in (("V", "is no unit of time"), ("fortnit", "is not a unit")):
        with pytest.raises(InputError, match=rf"log.time_unit: .*{why}"):
            read_platform(write(tmp_path, f'{GOOD}[log]\ntime_unit = "{wrong}"\n'))
