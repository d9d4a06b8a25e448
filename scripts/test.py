"""Set up `.venv` and run the tests: `python3 scripts/test.py [--long] [pytest arguments]`.

One process per core runs them; `-n 0` keeps them in one, for a debugger. `--long` runs the tests
that take minutes, and only those, one after the other: they use all cores themselves. Needs Python
3.11+ and nothing else.
"""

from __future__ import annotations

import subprocess
import sys

from environment import CHECKOUT, PYTHON, prepare_environment

SIDE_BY_SIDE = ["-n", "auto", "--dist", "worksteal"]


def main(arguments: list[str]) -> int:
    """Run pytest with the arguments and return its exit code."""
    way = ["-m", "long"] if "--long" in arguments else SIDE_BY_SIDE
    passed_on = [argument for argument in arguments if argument != "--long"]
    prepare_environment(extras=("dev", "docs", "test"))
    command = [str(PYTHON), "-m", "pytest", *way, *passed_on]
    return subprocess.run(command, cwd=CHECKOUT).returncode


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
