"""A platform file with damaged bytes is read or refused; it never ends in a traceback."""

import math
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ptp_symbolic.errors import InputError
from ptp_symbolic.platform import read_platform

GOOD = (Path(__file__).parents[1] / "platforms" / "fieldlog_two_axis.toml").read_bytes()


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    st.lists(
        st.tuples(st.integers(0, len(GOOD) - 1), st.binary(max_size=3), st.integers(0, 9)),
        min_size=1,
        max_size=4,
    )
)
def test_a_damaged_file_is_read_or_refused_in_one_line(
    tmp_path: Path, damage: list[tuple[int, bytes, int]]
) -> None:
    content = GOOD
    for place, inserted, removed in damage:
        content = content[:place] + inserted + content[place + removed :]
    path = tmp_path / "damaged.toml"
    path.write_bytes(content)
    try:
        platform = read_platform(path)
    except InputError as refusal:
        assert "\n" not in str(refusal)
        assert str(refusal).startswith(str(path))
    else:
        assert all(math.isfinite(parameter.value) for parameter in platform.parameters)


def test_a_long_dotted_key_is_refused_before_it_is_parsed(tmp_path: Path) -> None:
    path = tmp_path / "bench.toml"
    path.write_text("a" + ".a" * 400_000 + " = 1\n", encoding="utf-8")
    with pytest.raises(InputError, match="line has more than 500 characters"):
        read_platform(path)
