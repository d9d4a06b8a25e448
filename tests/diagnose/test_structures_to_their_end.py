"""Which structures are fitted to their end: the better half, or of it those that come near one that
leaves noise alone; and beside which of them terms are searched for.
"""

from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.structures import FittedStructure
from ptp_symbolic.numeric.identify.evidence import Allowance, Work
from ptp_symbolic.workflows import structure_fits


@dataclass(frozen=True)
class Begun:
    """A structure with how many of each it had: a few iterations, and a fit to its end."""

    error: float
    further: int = 0
    ends: int = 0
    keys: tuple[str, ...] = ()
    provides: frozenset[str] = frozenset()

    @property
    def is_noise_alone(self) -> bool:
        return self.error <= 1.0


def finished(
    errors: list[float],
    better: tuple[int, ...],
    monkeypatch: pytest.MonkeyPatch,
    rival: float | None = None,
    allowed: float = np.inf,
) -> list[tuple[int, int]]:
    """How often each structure was led further and to its end; further, one halves its error, and
    an end costs 100 samples. A `rival` without a structure has that error.
    """

    def further(one: Begun) -> Begun:
        return replace(one, further=one.further + 1, error=0.5 * one.error)

    def to_its_end(one: Begun) -> Begun:
        work.samples += 100
        return replace(one, ends=one.ends + 1)

    def is_near(one: Begun, best: Begun, declared: Any) -> bool:
        return one.error <= 2.0 * best.error

    monkeypatch.setattr(FittedStructure, "further", further)
    monkeypatch.setattr(FittedStructure, "finished", to_its_end)

    def comes_near(one: Begun, problem: Any, other: float, declared: Any) -> bool:
        return one.error <= 2.0 * other

    monkeypatch.setattr(structure_fits, "is_near", is_near)
    monkeypatch.setattr(structure_fits, "comes_near", comes_near)
    work, every = Work(), cast(Any, [Begun(e) for e in errors])
    problem = SimpleNamespace(allowance=Allowance(work, samples=allowed))
    search = None if rival is None else cast(Any, SimpleNamespace(problem=None, chosen=rival))
    declared = cast(Any, SimpleNamespace(problem=problem))
    found = cast(Any, structure_fits._finished(every, better, every[0], declared, search))
    return [(one.further, one.ends) for one in found]


def test_beside_noise_alone_those_that_come_near(monkeypatch: pytest.MonkeyPatch) -> None:
    found = finished([9.0, 1.0, 3.0, 7.0], (1, 2, 3), monkeypatch)
    assert found == [(0, 0), (0, 1), (1, 1), (1, 0)]


def test_beside_more_than_noise_all_of_the_better_half(monkeypatch: pytest.MonkeyPatch) -> None:
    found = finished([9.0, 1.5, 3.0, 7.0], (1, 2, 3), monkeypatch)
    assert found == [(0, 0), (0, 1), (0, 1), (0, 1)]


def test_none_but_the_best_where_that_is_far_from_what_terms_explain(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = finished([9.0, 5.0, 6.0, 7.0], (1, 2, 3), monkeypatch, rival=2.0)
    assert found == [(0, 0), (0, 1), (0, 0), (0, 0)]
    found = finished([9.0, 3.0, 6.0, 7.0], (1, 2, 3), monkeypatch, rival=2.0)
    assert found == [(0, 0), (0, 1), (0, 1), (0, 1)]


def test_as_many_as_the_allowance_pays_for(monkeypatch: pytest.MonkeyPatch) -> None:
    found = finished([9.0, 1.5, 3.0, 7.0], (1, 2, 3), monkeypatch, allowed=250.0)
    assert found == [(0, 0), (0, 1), (0, 1), (0, 0)]
    found = finished([9.0, 1.5, 3.0, 7.0], (1, 2, 3), monkeypatch, allowed=50.0)
    assert found == [(0, 0), (0, 1), (0, 0), (0, 0)]


def test_a_part_of_an_allowance_pays_for_its_share() -> None:
    work = Work()
    whole = Allowance(work, samples=400.0)
    half = whole.part(0.5)
    work.samples = 150
    assert (whole.pays_for(100), half.pays_for(100), half.is_over) == (2.5, 0.5, False)
    work.samples = 250
    assert (whole.pays_for(100), half.pays_for(100), half.is_over) == (1.5, 0.0, True)


def test_without_any(monkeypatch: pytest.MonkeyPatch) -> None:
    assert finished([2.0], (), monkeypatch) == [(0, 0)]


def test_of_friction_on_either_side_the_side_that_is_far_behind_is_left(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def is_near(one: Begun, best: Begun, declared: Any) -> bool:
        return one.error <= 2.0 * best.error

    monkeypatch.setattr(structure_fits, "deviance", lambda one, declared: one.error)
    monkeypatch.setattr(structure_fits, "is_near", is_near)
    gear, behind = frozenset({"shaft pan"}), frozenset({"shaft pan before friction"})
    every = [
        Begun(9.0, keys=("shaft@pan",), provides=gear),
        Begun(2.0, keys=("shaft@pan",), provides=behind),
        Begun(3.0, keys=("drive@pan",), provides=gear),
        Begun(5.0, keys=("drive@pan",), provides=behind),
        Begun(6.0, keys=("lag@pan",), provides=frozenset({"change reading"})),
    ]
    found = structure_fits._better_half(cast(Any, every), cast(Any, every[0]))
    assert found == (1, 2), "two of the four that are left; the shaft before friction is none"
    stop = Begun(1.0, keys=("stop@pan",), provides=frozenset({"end stop"}))
    found = structure_fits._better_half(cast(Any, [*every, stop]), cast(Any, every[0]))
    assert found == (5, 1, 2)
    both = Begun(30.0, keys=("gap@pan", "shaft@pan"), provides=behind | {"gap"})
    found = structure_fits._better_half(cast(Any, [*every, both]), cast(Any, every[0]))
    assert found == (1, 2, 3, 5), "with a gap it fits as well as without, at its end"


SHAFT, HARMONIC, GAP, LAG = (
    Begun(error, keys=(key,), provides=frozenset(provides))
    for error, key, *provides in (
        (2.0, "shaft_compliance@pan", "shaft pan"),
        (1.99, "harmonic_drive@pan", "shaft pan"),
        (1.98, "backlash@pan", "shaft pan", "change half_gap_pan"),
        (9.0, "actuator_lag@pan", "change amplifier_voltage_pan"),
    )
)


def followed(order: list[Begun], monkeypatch: pytest.MonkeyPatch) -> list[Begun]:
    """Those that go on into the search for terms, where a tenth less error is better."""
    monkeypatch.setattr(
        structure_fits, "is_better", lambda one, other: one.error < 0.9 * other.error
    )
    fitted = structure_fits.Fitted(*cast(Any, [None] * 2), (), (), {})
    fitted.__dict__["order"] = order
    return cast(Any, fitted.followed)


def test_none_goes_on_that_has_all_of_another_and_predicts_no_better(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert followed([SHAFT, HARMONIC, GAP, LAG], monkeypatch) == [SHAFT, LAG]


def test_one_that_has_more_than_another_goes_on_where_it_predicts_better(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    gap = replace(GAP, error=1.0)
    assert followed([gap, SHAFT, LAG], monkeypatch) == [gap, SHAFT]
    assert followed([SHAFT, gap, LAG], monkeypatch) == [SHAFT, gap]
