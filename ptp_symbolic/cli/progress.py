"""What a command that takes long says of itself, on a terminal and in a file alike."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import click

SILENT = 2.0  # s; what takes no longer says nothing


@contextmanager
def progress_line() -> Iterator[Callable[[str], None]]:
    """A function that says on stderr which phase begins, with the time since the command began.

    A file gets the lines too: nothing else tells a long run from one that hangs. What ends within
    `SILENT` s says nothing, so that a refusal is the only line of stderr.
    """
    begun = time.monotonic()
    lock, waiting, ended = threading.Lock(), list[str](), False

    def say_waiting() -> None:
        with lock:
            if not ended:
                for line in waiting:
                    click.echo(line, err=True)
                waiting.clear()

    def show(text: str) -> None:
        elapsed = time.monotonic() - begun
        with lock:
            waiting.append(f"[{elapsed:6.1f} s] {text}")
        if elapsed >= SILENT:
            say_waiting()

    timer = threading.Timer(SILENT, say_waiting)
    timer.daemon = True
    timer.start()
    try:
        yield show
    finally:
        with lock:
            ended = True
        timer.cancel()
