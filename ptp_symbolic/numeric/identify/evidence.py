"""Stored evidence: what was evaluated, by a key of all that it was evaluated from.

A diagnosis is a deterministic function of few expensive evaluations: fits, and numbers that are
computed from their residuals and Jacobians. Each of them is recorded under a digest of its
arguments. Where all of them are known, the same diagnosis simulates nothing. Fits are recorded
without residuals and Jacobians, which are hundreds of times as large: these are simulated again, at
the values of the fit, where they are needed after all.

The samples that are simulated are counted: a search ends at a number of them that the speed of a
machine does not change.
"""

import hashlib
import struct
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence, Set
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from contextvars import ContextVar, copy_context
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import wraps
from math import inf
from typing import Any, Generic, ParamSpec, TypeVar, overload

import numpy as np

from ptp_symbolic.numeric.identify.constants import KEY_BYTES, WITH_TANGENTS

Result = TypeVar("Result")


@dataclass(eq=False)
class Work:
    """Samples simulated so far, all threads together, or the steps that they took where these were
    more; one with sensitivities counts as three.
    """

    samples: int = 0
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)

    @property
    def evidence_parts(self) -> tuple[()]:
        """Nothing that is evaluated depends on it."""
        return ()

    def add(self, samples: int, tangents: bool = False) -> None:
        """Count the samples or steps of a run, also in every `tallied` part that it belongs to."""
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


# The pools in whose threads the piece of work under way runs, or is waited for.
_BUSY: ContextVar[tuple["Threads", ...]] = ContextVar("busy", default=())


class Threads(ThreadPoolExecutor):
    """Threads in which each piece of work has the context of its caller. What a piece of work hands
    to its own pool is done at once, in its thread: all others may be waiting too.
    """

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> "Future[Result]":
        """Begin a piece of work."""
        if self in _BUSY.get():
            return InTurn().submit(fn, *args, **kwargs)
        context = copy_context()
        context.run(_BUSY.set, (*_BUSY.get(), self))
        return super().submit(context.run, fn, *args, **kwargs)


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

    def pays_for(self, each: int) -> float:
        """How often work of so many samples may begin; 0 once it is over."""
        left = self.samples - (self.work.samples - self.begun)
        return 0.0 if self.is_over else left / max(each, 1)

    def part(self, share: float) -> "Allowance":
        """The first `share` of its samples, until its time is over."""
        return replace(self, samples=share * self.samples)

    def rest(self, least: float) -> "Allowance":
        """What remains of it now, but the share `least` of both limits at least."""
        done, now = self.work.samples, time.monotonic()
        samples = max(self.samples - (done - self.begun), least * self.samples)
        seconds = max(self.seconds - (now - self.since), least * self.seconds)
        return replace(self, samples=samples, seconds=seconds, begun=done, since=now)


Arguments = ParamSpec("Arguments")
Item = TypeVar("Item")


class NotStoredError(Exception):
    """A simulation was needed where only stored evidence may be used; `missing` are the keys of the
    evaluations that needed it, all that were requested side by side.
    """

    def __init__(self, missing: Set[str] = frozenset()) -> None:
        super().__init__(f"{max(len(missing), 1)} evaluations are not stored")
        self.missing = frozenset(missing)


@dataclass(frozen=True)
class Entry:
    """What was recorded of an evaluation, as plain data and arrays, and the `samples` that it
    simulated (see `Work`).
    """

    value: Any
    samples: int


@dataclass(eq=False)
class Evidence:
    """Evaluations by key: those `known` from before, and those made since, `fresh`.

    `work` counts what known ones simulated when they were made. Only known ones may be used where
    it no longer `simulates`. `changed` is called after every fresh one.
    """

    known: Mapping[str, Entry] = field(default_factory=dict)
    fresh: dict[str, Entry] = field(default_factory=dict)
    work: Work = field(default_factory=Work)
    simulates: bool = True
    changed: Callable[[], None] = lambda: None
    used: set[str] = field(default_factory=set)
    _lock: threading.Lock = field(default_factory=threading.Lock, repr=False)

    def look_up(self, key: str) -> Entry | None:
        """The entry of a known evaluation, whose work is counted; None where it is not known."""
        entry = self.known.get(key)
        if entry is not None:
            self.used.add(key)
            self.work.add(entry.samples)
        return entry

    def keep(self, key: str, entry: Entry) -> None:
        """Record a fresh evaluation."""
        with self._lock:
            self.fresh[key] = entry
        self.changed()

    def entries(self) -> dict[str, Entry]:
        """All of them."""
        with self._lock:
            return {**self.known, **self.fresh}


_EVIDENCE: ContextVar[Evidence | None] = ContextVar("evidence", default=None)


@contextmanager
def recording(evidence: Evidence) -> Iterator[Evidence]:
    """Record all evaluations as `evidence`, and take those that are known from it."""
    token = _EVIDENCE.set(evidence)
    try:
        yield evidence
    finally:
        _EVIDENCE.reset(token)


def simulates() -> bool:
    """Whether simulations may be made."""
    evidence = _EVIDENCE.get()
    return evidence is None or evidence.simulates


def refuse_unstored() -> None:
    """Raise NotStoredError where no simulation may be made."""
    if not simulates():
        raise NotStoredError


class InTurn(Executor):
    """One piece of work after the other, for stored evidence: where some of it is missing, all that
    was requested side by side is looked up before NotStoredError says which.
    """

    def submit(self, fn: Callable[..., Result], /, *args: Any, **kwargs: Any) -> "Future[Result]":
        """The result of `fn`, or its error."""
        future: Future[Result] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # as other executors do
            future.set_exception(error)
        return future

    def map(self, fn: Callable[..., Result], *iterables: Any, **options: Any) -> Iterator[Result]:
        """The results of `fn`, in order."""
        return iter(in_turn(lambda args: fn(*args), list(zip(*iterables, strict=False))))


def in_turn(work: Callable[[Item], Result], items: Sequence[Item]) -> list[Result]:
    """What `work` makes of every item; raises NotStoredError with all that is missing."""
    found, missing, is_missing = [], set[str](), False
    for item in items:
        try:
            found.append(work(item))
        except NotStoredError as error:
            missing, is_missing = missing | error.missing, True
    if is_missing:
        raise NotStoredError(missing)
    return found


def recorded(
    *types: type,
) -> Callable[[Callable[Arguments, Result]], Callable[Arguments, Result]]:
    """Record what a function gives under its name and its arguments: numbers, texts, arrays,
    tuples, lists and dictionaries of such, and dataclasses of the `types`.

    Its result has to follow from its arguments, of which executors and functions do not count.
    """
    by_name = {one.__name__: one for one in types}

    def wrap(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
        @wraps(function)
        def asked(*args: Arguments.args, **kwargs: Arguments.kwargs) -> Result:
            evidence = _EVIDENCE.get()
            if evidence is None:
                return function(*args, **kwargs)
            key = key_of(function.__qualname__, *args, *sorted(kwargs.items()))
            entry = evidence.look_up(key)
            if entry is not None:
                return decoded(entry.value, by_name)
            result, samples = made(key, lambda: function(*args, **kwargs))
            evidence.keep(key, Entry(encoded(result), samples))
            return result

        return asked

    return wrap


@dataclass(frozen=True, eq=False)
class Stored(Generic[Result]):
    """What is recorded of something large, its `light` part, as plain data and arrays; and itself
    where it was `made` now.
    """

    light: Any
    made: Result | None


def stored(key: str, make: Callable[[], Result], light: Callable[[Result], Any]) -> Stored[Result]:
    """Something large under a key, made where nothing is recorded: then its `light` part is."""
    evidence = _EVIDENCE.get()
    assert evidence is not None
    entry = evidence.look_up(key)
    if entry is not None:
        return Stored(decoded(entry.value, {}), None)
    result, samples = made(key, make)
    kept = light(result)
    evidence.keep(key, Entry(encoded(kept), samples))
    return Stored(kept, result)


def made(key: str, make: Callable[[], Result]) -> tuple[Result, int]:
    """What `make` makes, and the samples that it simulated."""
    try:
        with tallied() as tally:
            return make(), tally.samples
    except NotStoredError as error:
        raise NotStoredError(error.missing or {key}) from None


def is_recording() -> bool:
    """Whether evaluations are recorded."""
    return _EVIDENCE.get() is not None


class Deferred(Sequence[Item], Generic[Item]):
    """Items that are known by a `key`, and made where they are first needed; that counts as no
    work. `squares` are what most ask of them, so that they need not be made. Where nothing has to
    `make` them, they are `items`.
    """

    def __init__(
        self,
        key: str,
        size: int,
        make: Callable[[], Sequence[Item]] | None,
        squares: Any = None,
        items: Sequence[Item] = (),
    ) -> None:
        self.evidence_parts = key, size
        self.is_single = False
        self.squares = squares
        self._size, self._make = size, make
        self._items = tuple(items) if make is None else None

    @property
    def items(self) -> tuple[Item, ...]:
        """The items, made now if they have not been. There is no lock: a thread that waited here
        might be one of those that make them.
        """
        if self._items is None and self._make is not None:
            with uncounted():
                self._items = tuple(self._make())
        return self._items or ()

    def as_single(self, convert: Callable[[Sequence[Item]], Sequence[Item]]) -> "Deferred[Item]":
        """The items in single precision, made now if these have been."""
        key = key_of("single", self)
        if self._make is None or self._items is not None:
            single = Deferred(key, self._size, None, self.squares, convert(self.items))
        else:
            make, squares = self.items_made, self.squares
            single = Deferred(key, self._size, lambda: convert(make()), squares)
        single.is_single = True
        return single

    def items_made(self) -> tuple[Item, ...]:
        """The items, made now and not kept."""
        return tuple(self._make()) if self._make is not None else self.items

    def __len__(self) -> int:
        return self._size

    @overload
    def __getitem__(self, index: int) -> Item: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[Item]: ...

    def __getitem__(self, index: int | slice) -> Item | Sequence[Item]:
        return self.items[index]

    def __iter__(self) -> Iterator[Item]:
        return iter(self.items)


def derived(
    name: str, given: Any, make: Callable[[], Sequence[Item]], squares: Any = None
) -> Deferred[Item]:
    """Items that follow from what is `given`, of which their number alone is recorded."""
    key = key_of(name, given)
    found = stored(key, make, len)
    if found.made is None:
        return Deferred(key, found.light, make, squares)
    return Deferred(key, found.light, None, squares, found.made)


def key_of(name: str, *values: Any) -> str:
    """The key of an evaluation of some name, made from `values`."""
    digest = hashlib.blake2b(name.encode(), digest_size=KEY_BYTES)
    _feed(digest.update, values)
    return digest.hexdigest()


def _feed(update: Callable[[bytes], None], value: Any) -> None:
    """Feed a value to a digest: equal values alike, others, and those of other types, not."""
    match value:
        case bool() | int() | str() | None:
            update(f"{type(value).__name__}{len(str(value))}:{value}".encode())
        case float():
            update(b"float" + struct.pack("<d", value))
        case np.generic():
            _feed(update, value.item())
        case np.ndarray():
            update(f"array{value.dtype.str}{value.shape}".encode())
            update(np.ascontiguousarray(value).tobytes())
        case Mapping():
            update(f"map{len(value)}".encode())
            for key in sorted(value):
                _feed(update, key)
                _feed(update, value[key])
        case Set():
            update("".join(sorted(key_of("member", one) for one in value)).encode())
        case _ if hasattr(value, "evidence_parts") or is_dataclass(value):
            update(_digest_of(value).encode())
        case Sequence():
            update(f"list{len(value)}".encode())
            for one in value:
                _feed(update, one)
        case Executor() | Callable():
            update(b"function")
        case _:
            raise TypeError(f"{type(value).__name__} is nothing that evidence is made from")


def _digest_of(value: Any) -> str:
    """The digest of an object by its `evidence_parts`, or else of a dataclass by its fields; kept
    in it if it is frozen.
    """
    kept = vars(value).get("_evidence_digest")
    if kept is not None:
        return str(kept)
    parts = getattr(value, "evidence_parts", None)
    if parts is None:
        parts = [getattr(value, f.name) for f in fields(value)]
    digest = key_of(type(value).__name__, *parts)
    if getattr(value, "__dataclass_params__", None) and value.__dataclass_params__.frozen:
        vars(value)["_evidence_digest"] = digest
    return digest


def encoded(value: Any) -> Any:
    """A value as plain data and arrays: a dataclass as its name and its fields."""
    match value:
        case np.generic():
            return value.item()
        case tuple():
            return {"tuple": [encoded(one) for one in value]}
        case list():
            return [encoded(one) for one in value]
        case Mapping():
            return {"map": [[encoded(k), encoded(v)] for k, v in value.items()]}
        case _ if is_dataclass(value):
            own = {f.name: encoded(getattr(value, f.name)) for f in fields(value)}
            return {"class": type(value).__name__, "fields": own}
        case bool() | int() | float() | str() | None | np.ndarray():
            return value
        case _:
            raise TypeError(f"{type(value).__name__} is nothing that evidence holds")


def decoded(value: Any, types: Mapping[str, type]) -> Any:
    """The value of what `encoded` gave, its dataclasses by their names."""
    match value:
        case {"tuple": items}:
            return tuple(decoded(one, types) for one in items)
        case {"map": pairs}:
            return {decoded(k, types): decoded(v, types) for k, v in pairs}
        case {"class": name, "fields": own}:
            return types[name](**{k: decoded(v, types) for k, v in own.items()})
        case list():
            return [decoded(one, types) for one in value]
        case np.ndarray():
            return value.copy()
        case _:
            return value
