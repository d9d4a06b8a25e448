"""What every test may ask for."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import settings

os.environ.setdefault("MPLBACKEND", "Agg")
# Before NumPy is imported. Matrices are small and tests run side by side: threads of BLAS would
# wait for each other in a loop, three times the computing time of all tests of intervals.
for library in ("OPENBLAS", "OMP", "MKL"):
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

from ptp_symbolic.numeric.simulation.ahead import (  # noqa: E402
    COMPILE,
    compile_ahead,
    wait_until_compiled,
)

# The first call of a jitted function compiles it: a deadline per example would fail at random.
settings.register_profile("ptp_symbolic", deadline=None, derandomize=True)
settings.load_profile("ptp_symbolic")


@pytest.fixture(scope="session")
def checkout() -> Path:
    """Root folder of the source tree."""
    return Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def shared(checkout: Path) -> Path:
    """Folder of measured data that is not part of the repository; skips where there is none.

    Looked for in the environment variable PTP_SYMBOLIC_SHARED, else in `../shared` beside the
    checkout.
    """
    named = os.environ.get("PTP_SYMBOLIC_SHARED")
    folder = Path(named) if named else checkout.parent / "shared"
    if not (folder / "fieldlogs").is_dir():
        pytest.skip(f"no field logs in {folder}: set PTP_SYMBOLIC_SHARED to the folder of the data")
    return folder


@pytest.fixture
def printed_in_two_processes() -> Callable[..., set[str]]:
    """Runs a script with arguments under two hash seeds and returns what it printed."""

    def run(script: str, *arguments: str) -> set[str]:
        return {
            subprocess.run(
                [sys.executable, "-c", script, *arguments],
                env={**os.environ, "PYTHONHASHSEED": seed},
                capture_output=True,
                check=True,
                text=True,
            ).stdout
            for seed in ("1", "2")
        }

    return run


def pytest_sessionstart(session: pytest.Session) -> None:
    """Before tests run in several processes, compile all kernels side by side, once: on a new
    machine every process would.
    """
    if getattr(session.config.option, "numprocesses", None):  # that of the session, not of a worker
        from ptp_symbolic.numeric.identify.ahead import FIT, begin_fit

        compile_ahead(*COMPILE)
        begin_fit()
        for kernel in (*COMPILE, FIT):
            wait_until_compiled(kernel)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put tests marked `early` first: the first process has them from the start, and others take
    work from the end of its list. A module that is cut in two makes what it shares twice.
    """
    items.sort(key=lambda item: item.get_closest_marker("early") is None)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add `--figures`."""
    parser.addoption("--figures", action="store_true", help="print the figures that proofs rest on")


@pytest.fixture
def figure(record_property: Callable[[str, object], None]) -> Callable[[str, float], float]:
    """Notes a number under a name, for `--figures`, and returns it: assert figure(...) < bound."""

    def note(what: str, value: float) -> float:
        record_property(what, float(value))
        return value

    return note


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    """Print the figures of all tests that ran, a line each."""
    if not config.getoption("figures"):
        return
    terminalreporter.section("figures")
    for outcome in ("passed", "failed"):
        for report in terminalreporter.stats.get(outcome, []):
            for what, value in report.user_properties:
                name = report.nodeid.rpartition("/")[2]
                terminalreporter.line(f"{value:10.3g}  {what}  ({name}, {outcome})")
