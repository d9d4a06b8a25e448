"""Ctrl-C ends every command with one line and the exit code of a signal."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ptp_symbolic.cli.commands import commands
from ptp_symbolic.cli.interruption import MESSAGE

pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals are sent as POSIX does")
# What makes a command wait until it is interrupted: in Python, in compiled code that no signal
# reaches, in what such code calls back, in a thread that is waited for.
WAITS = {
    "python": "import time; time.sleep(60)",
    "compiled": "from numba import njit; f = njit(nogil=True)(SPIN); say(); f(1)",
    "callback": "import ctypes, time; ctypes.CFUNCTYPE(None)(lambda: time.sleep(60))()",
    "threads": (
        "import time\n    from concurrent.futures import ThreadPoolExecutor\n"
        "    with ThreadPoolExecutor() as pool: pool.submit(time.sleep, 60).result()"
    ),
}
PROGRAM = """import sys
def say():
    print("under way", flush=True)
def SPIN(n):
    total = 0.0
    while n > 0:
        total += 1.0
        if total < 0.0:
            n = 0
    return total
def wait(context):
    {wait}
import click
from ptp_symbolic import cli
from ptp_symbolic.cli import commands
for command in list(commands.commands.commands.values()):
    command.invoke = wait
if {quiet}: say()
sys.argv[0] = "ptp-symbolic"
cli.main()
"""


def interrupted(program: str, *arguments: str, cwd: Path) -> tuple[int, str, float]:
    """Exit code, stderr and the seconds from SIGINT to the end."""
    process = subprocess.Popen(
        [sys.executable, "-c", program, *arguments],
        cwd=cwd,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "under way\n"
    time.sleep(0.3)
    began = time.monotonic()
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=30)
    return process.returncode, err, time.monotonic() - began


@pytest.mark.parametrize("kind", WAITS)
def test_it_ends_wherever_it_is(kind: str, tmp_path: Path) -> None:
    program = PROGRAM.format(wait=WAITS[kind], quiet=kind != "compiled")
    code, err, took = interrupted(program, "models", cwd=tmp_path)
    assert (code, err) == (130, MESSAGE)
    assert MESSAGE.count("\n") == 1
    assert took < 5.0


REAL = """import sys, threading, _thread
from ptp_symbolic import cli, atomic_files
usual = atomic_files._put_in_place
def slowly(*arguments):
    print("under way", flush=True)
    import time
    time.sleep(60)
    usual(*arguments)
atomic_files._put_in_place = slowly
sys.argv[0] = "ptp-symbolic"
cli.main()
"""


def test_nothing_half_written_stays(tmp_path: Path) -> None:
    out = tmp_path / "out"
    command = ["simulate", "--platform", "ideal", "--duration", "0.1", "--out", str(out)]
    code, err, _ = interrupted(REAL, *command, cwd=tmp_path)
    assert (code, err) == (130, MESSAGE)
    assert list(tmp_path.iterdir()) == []


def test_every_command_goes_through_it() -> None:
    """The group is entered by `main` alone, below which no command catches a signal."""
    root = Path(__file__).parents[2] / "ptp_symbolic"
    assert len(commands.commands) > 10
    for path in root.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert "KeyboardInterrupt" not in text, path
        assert "signal.SIGINT" not in text or path.stem == "interruption", path
