"""How much of a search is simulated: a limit that the speed of a machine does not move."""

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar, copy_context
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any, TypeVar

from ptp_symbolic.numeric.identify.constants import WITH_TANGENTS

Result = TypeVar("Result")


@dataclass(eq=False)
class Work:
    """Samples simulated so far, all threads together; one with sensitivities counts as three."""

    samples: int = 0
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)

    @property
    def evidence_parts(self) -> tuple[()]:
        """Nothing that is evaluated depends on it."""
        return ()

    def add(self, samples: int, tangents: bool = False) -> None:
        """Count a run that was simulated, also in every `tallied` part that it belongs to."""
        tallies = _TALLIES.get()
        if tallies is None:
            return
        with self._lock:
            for work in (self, *tallies):
                work.samples += samples * (WITH_TANGENTS if tangents else 1)


# The parts of the work that are under way; None: what is simulated does not count.
_TALLIES: ContextVar[tuple[Work, ...] | None] = ContextVar("tallies", default=())


@contextmanager
def tallied() -> Iterator[Work]:
    """What is simulated meanwhile, in this thread and in `Threads` that work for it."""
    own = Work()
    outer = _TALLIES.get()
    token = _TALLIES.set(None if outer is None else (*outer, own))
    try:
        yield own
    finally:
        _TALLIES.reset(token)


@contextmanager
def uncounted() -> Iterator[None]:
    """What is simulated meanwhile does not count."""
    token = _TALLIES.set(None)
    try:
        yield
    finally:
        _TALLIES.reset(token)


class Threads(ThreadPoolExecutor):
    """Threads in which each piece of work has the context of who asked for it."""

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> "Future[Result]":
        """Begin a piece of work."""
        return super().submit(copy_context().run, fn, *args, **kwargs)


@dataclass(frozen=True, eq=False)
class Allowance:
    """What a search may simulate, and as a last stop how long it may take.

    `begun` samples of `work` and the time `since` (s of `time.monotonic`) were when it began;
    `samples` and `seconds` are its limits. The samples are the same on every machine, and so is
    what a search that ends by them has found; what ends by the clock depends on the machine.
    """

    work: Work = field(default_factory=Work)
    samples: float = inf
    seconds: float = inf
    begun: int = 0
    since: float = field(default_factory=time.monotonic)

    @property
    def is_out_of_time(self) -> bool:
        """Whether the clock has stopped it."""
        return time.monotonic() - self.since > self.seconds

    @property
    def is_over(self) -> bool:
        """Whether nothing new may begin."""
        return self.work.samples - self.begun > self.samples or self.is_out_of_time

    def rest(self, least: float) -> "Allowance":
        """What is left of it now, but the share `least` of both limits at least."""
        done, now = self.work.samples, time.monotonic()
        samples = max(self.samples - (done - self.begun), least * self.samples)
        seconds = max(self.seconds - (now - self.since), least * self.seconds)
        return replace(self, samples=samples, seconds=seconds, begun=done, since=now)
