"""Ctrl-C: one line and the exit code 130, wherever a command is."""

import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

EXIT_CODE = 130  # 128 + SIGINT, as shells have it
PATIENCE = 1.0  # s to leave files in order; compiled code and threads may not come to an end in it
START_OF_LINE = "\r\x1b[K"  # over the progress that a terminal shows
MESSAGE = "ptp-symbolic: interrupted; what was not finished has not been written.\n"


@contextmanager
def interruptible() -> Iterator[None]:
    """Let SIGINT end the process with `MESSAGE` and `EXIT_CODE`.

    The main thread unwinds, so that temporary files go. While compiled code runs or calls back, or
    threads are waited for, it cannot: a thread of its own, woken by the signal itself, then ends
    the process.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    heard, wakes = socket.socketpair()
    wakes.setblocking(False)
    before = signal.signal(signal.SIGINT, _unwind)
    woken_before = signal.set_wakeup_fd(wakes.fileno(), warn_on_full_buffer=False)
    said = threading.Event()
    threading.Thread(target=_watch, args=(heard, said), daemon=True).start()
    try:
        yield
    except _Interrupted:
        said.wait(PATIENCE)
        raise
    finally:
        signal.set_wakeup_fd(woken_before)
        signal.signal(signal.SIGINT, before)
        wakes.close()


class _Interrupted(SystemExit):
    """Ends the process as `sys.exit` does."""


def _unwind(number: int, frame: FrameType | None) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.unraisablehook = _stay
    raise _Interrupted(EXIT_CODE)


def _stay(unraisable: "sys.UnraisableHookArgs") -> None:
    """Go no further where compiled code called back, which drops exceptions; `_watch` ends it."""
    if isinstance(unraisable.exc_value, _Interrupted):
        threading.Event().wait()
    sys.__unraisablehook__(unraisable)


def _watch(heard: socket.socket, said: threading.Event) -> None:
    """Say that SIGINT came, and end the process if it does not end by itself."""
    with heard:
        while number := heard.recv(1):
            if number[0] == signal.SIGINT:
                line = START_OF_LINE + MESSAGE if os.isatty(2) else MESSAGE
                os.write(2, line.encode())
                said.set()
                time.sleep(PATIENCE)
                os._exit(EXIT_CODE)
