"""Options that take several values: written once for all, or once for each."""

import pytest

from ptp_symbolic.cli.diagnose import repeated


@pytest.mark.parametrize(
    "args",
    [
        ["--train", "a", "b", "--validate", "c", "--json"],
        ["--train", "a", "--train", "b", "--validate", "c", "--json"],
        ["--train=a", "b", "--validate=c", "--json"],
    ],
)
def test_values_up_to_the_next_option_belong_to_it(args: list[str]) -> None:
    written = " ".join(repeated(args, {"--train", "--validate"})).replace("=", " ")
    assert written == "--train a --train b --validate c --json"


def test_other_options_and_arguments_are_let_be() -> None:
    args = ["log1", "log2", "--out", "x", "log3", "-h"]
    assert repeated(args, {"--train"}) == args
