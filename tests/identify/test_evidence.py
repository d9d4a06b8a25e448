"""Stored evidence: equal questions have equal keys, and a known answer is not simulated again."""

from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ptp_symbolic.numeric.identify.evidence import (
    Deferred,
    Entry,
    Evidence,
    InTurn,
    NotStoredError,
    Threads,
    Work,
    key_of,
    recorded,
    recording,
)
from ptp_symbolic.numeric.identify.fit import Fit, fit_parameters
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.numeric.identify.least_squares import Effort
from ptp_symbolic.numeric.identify.windows import estimable
from tests.identify.pan_runs import MODEL, TRUTH, make_runs, sine, stairs, starts_off, unfree
from tests.independent.pan_drive import PanDrive


def test_a_key_tells_what_differs_and_nothing_else() -> None:
    values = np.array([1.0, 2.0])
    alike = [{"a": values, "b": 1.0}, {"b": 1.0, "a": values.copy()}]
    assert key_of("x", alike[0]) == key_of("x", alike[1])
    others = [
        {"a": values, "b": 1},
        {"a": values, "b": np.nextafter(1.0, 2.0)},
        {"a": values[::-1].copy(), "b": 1.0},
        {"a": values[None, :], "b": 1.0},
        {"a": list(values), "b": 1.0},
        {"a": values, "b": 1.0, "c": None},
    ]
    assert len({key_of("x", one) for one in [alike[0], *others]}) == 1 + len(others)
    assert key_of("x", "ab", "c") != key_of("x", "a", "bc")
    assert key_of("x", {"a", "b", "c"}) == key_of("x", frozenset("cba"))


@dataclass(frozen=True)
class Pair:
    """Something that is recorded."""

    first: NDArray[np.float64]
    second: dict[str, float | None]


calls: list[float] = []


@recorded(Pair)
def halves(value: float, executor: Executor, work: Work) -> Pair:
    """Counts as 7 samples, in threads."""
    calls.append(value)
    list(executor.map(lambda samples: work.add(samples), [3, 4]))
    return Pair(np.full(2, 0.5 * value), {"inf": np.inf, "none": None})


def test_what_is_recorded_is_given_again_with_its_work() -> None:
    calls.clear()
    work = Work()
    with Threads(2) as executor, recording(Evidence(work=work)) as first:
        made = halves(3.0, executor, work)
    assert work.samples == 7
    known = Evidence(first.entries(), work=Work())
    with recording(known):
        again = halves(3.0, InTurn(), Work())
        assert calls == [3.0]
        halves(4.0, InTurn(), Work())
    assert known.work.samples == 7 and calls == [3.0, 4.0]
    assert np.array_equal(again.first, made.first) and again.second == made.second
    assert halves(3.0, InTurn(), Work()).first[0] == 1.5 and len(calls) == 3  # nothing recorded


def test_a_known_fit_is_not_simulated_and_leaves_the_same_to_the_last_bit() -> None:
    """Residuals and Jacobians are simulated where they are asked for: at the end of the fit."""
    runs = make_runs(PanDrive(), [stairs(), sine()], 3).runs
    names = {name: TRUTH[name] for name in ("J_pan", "b_pan")}
    first_free, known = starts_off(names, 4), {**unfree(TRUTH), **TRUTH}
    fixed = {name: value for name, value in known.items() if name not in names}

    def pan_fit(earlier: Fit | None = None) -> Fit:
        effort = Effort(2, 1e-3)
        if earlier is None:
            return fit_parameters(MODEL, runs, first_free, fixed, None, effort)
        free = [replace(f, start=earlier.values[f.name]) for f in first_free]
        z = earlier.z
        return fit_parameters(MODEL, runs, free, fixed, z, effort, None, None, earlier)

    plain = pan_fit(pan_fit())
    with recording(Evidence()) as first:
        made = estimable(pan_fit(pan_fit()), (None,))
        intervals = estimates(made)
    assert plain.values == made.values and plain.cost == made.cost
    with recording(Evidence(first.entries(), simulates=False)) as stored:
        known = estimable(pan_fit(pan_fit()), (None,))
        assert estimates(known) == intervals
        with pytest.raises(NotStoredError):
            _ = known.evaluations[0]
    assert not stored.fresh
    assert known.values == made.values and known.cost == made.cost
    before = stored.work.samples
    with recording(Evidence(first.entries(), work=stored.work)):
        for one, other in zip(pan_fit(pan_fit()).evaluations, plain.evaluations, strict=True):
            assert np.array_equal(one.residual, other.residual)
            assert np.array_equal(one.by_parameter, other.by_parameter)
            assert np.array_equal(one.by_start, other.by_start)
    assert stored.work.samples > before  # that of the fits, which count as if they were made


def test_all_that_is_missing_side_by_side_is_told() -> None:
    @recorded()
    def missing(number: int) -> int:
        raise NotStoredError

    known = Entry(5, 0)
    evidence = Evidence({key_of(missing.__qualname__, 1): known}, simulates=False)
    with recording(evidence), pytest.raises(NotStoredError) as told:
        list(InTurn().map(missing, [1, 2, 3, 2]))
    assert len(told.value.missing) == 2


def test_what_is_made_where_it_is_needed_does_not_wait_for_those_who_wait_for_it() -> None:
    """All threads of a pool need the same items, which are made by that pool."""
    with Threads(2) as pool:
        items = Deferred("squares", 4, lambda: list(pool.map(lambda k: k * k, range(4))))

        def ask(k: int) -> int:
            return items[k]

        with Threads(3) as others:
            jobs = [others.submit(lambda: list(pool.map(ask, range(4)))) for _ in range(3)]
            jobs.append(pool.submit(lambda: list(others.map(ask, range(4)))))
            assert [job.result(timeout=20.0) for job in jobs] == 4 * [[0, 1, 4, 9]]
