"""Set up `.venv` and run the tests: `python3 scripts/test.py [--long] [pytest arguments]`.

One process per core runs them; `-n 0` keeps them in one, for a debugger. `--long` runs the tests
that take minutes, and only those, one after the other: they use all cores themselves. Needs Python
3.11+ and nothing else.

Emitted modules and compiled functions are kept from one run to the next, of other checkouts too, in
the folder that PTP_SYMBOLIC_TEST_CACHE names, else where the user's caches are. What is kept is
used where the sources that it was made from are the same. Delete the folder to begin from nothing.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

from environment import CHECKOUT, PYTHON, prepare_environment

SIDE_BY_SIDE = ["-n", "auto", "--dist", "worksteal"]
KEPT_UNUSED = 14 * 86400.0  # s


def caches() -> dict[str, str]:
    """Variables that name the folders of emitted modules and of compiled functions; none where they
    cannot be made. What no run has read for long is deleted.
    """
    usual = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "ptp_symbolic-tests"
    folder = Path(os.environ.get("PTP_SYMBOLIC_TEST_CACHE") or usual)
    modules, compiled = folder / "modules", folder / "compiled"
    try:
        for each in (modules, compiled):
            each.mkdir(mode=0o700, parents=True, exist_ok=True)
    except OSError:
        return {}
    oldest = time.time() - KEPT_UNUSED
    for path in folder.rglob("*"):
        with suppress(OSError):
            if path.is_file() and max(path.stat().st_atime, path.stat().st_mtime) < oldest:
                path.unlink()
    return {"PTP_SYMBOLIC_CACHE": str(modules), "NUMBA_CACHE_DIR": str(compiled)}


def main(arguments: list[str]) -> int:
    """Run pytest with the arguments and return its exit code."""
    way = ["-m", "long"] if "--long" in arguments else SIDE_BY_SIDE
    passed_on = [argument for argument in arguments if argument != "--long"]
    prepare_environment(extras=("dev", "docs", "test"))
    command = [str(PYTHON), "-m", "pytest", *way, *passed_on]
    return subprocess.run(command, cwd=CHECKOUT, env=caches() | os.environ).returncode


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
