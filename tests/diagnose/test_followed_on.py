"""Which structure fits best depends on what is missing beside it: where more than noise remains,
all are compared again beside the effects that were found in the best of them.
"""

from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any, cast

import pytest

from ptp_symbolic.platform import read_platform
from ptp_symbolic.workflows import structure_choice
from ptp_symbolic.workflows.preparation import with_effects
from ptp_symbolic.workflows.structure_choice import Searched

LAG, SHAFT, GAP = "actuator_lag@pan", "shaft_compliance@pan", "backlash@pan"


@dataclass(frozen=True)
class Structure:
    keys: tuple[str, ...]
    provides: frozenset[str] = frozenset()
    fit: str = "alone"


@dataclass
class Fits:
    """Structures in their order, and the effects of the declared one that they were fitted with."""

    order: list[Structure]
    beside: tuple[str, ...] = ()
    quiet: tuple[Structure, ...] = ()

    @property
    def every(self) -> list[Structure]:
        return self.order

    @property
    def declared(self) -> Any:
        effects = [SimpleNamespace(key=key) for key in self.beside]
        return SimpleNamespace(problem=SimpleNamespace(model=SimpleNamespace(effects=effects)))


@dataclass
class Scene:
    """What was called: the effects that structures were fitted beside, and what was searched."""

    monkeypatch: pytest.MonkeyPatch
    finds: str | None = "direction_dependent_friction@pan"
    noise_alone: bool = False
    is_over: bool = False
    fitted_beside: list[str] = field(default_factory=list)
    searched: list[tuple[str, ...]] = field(default_factory=list)

    def outcome(self, structure: Structure) -> Searched:
        found = SimpleNamespace(declared=None, chosen=SimpleNamespace(values={}))
        one = Searched(cast(Any, None), cast(Any, structure), cast(Any, None), cast(Any, found))
        one.__dict__["is_noise_alone"] = self.noise_alone
        return one

    def run(self, fits: Fits, followed: list[Structure], after: Fits) -> tuple[Any, list[Searched]]:
        def again(platform: Any, beside: str, *given: Any) -> Fits:
            self.fitted_beside.append(beside)
            return after

        def search(structure: Structure) -> Searched:
            self.searched.append(structure.keys)
            return self.outcome(structure)

        patch = self.monkeypatch.setattr
        patch(Searched, "is_noise_alone", self.noise_alone)
        patch(structure_choice, "_best_fit", lambda searches: searches[0])
        patch(structure_choice, "_with_found", lambda *given: self.finds)
        patch(structure_choice, "effect_keys", lambda beside: [beside])
        patch(structure_choice, "_fitted_beside", again)
        logs = SimpleNamespace(allowance=SimpleNamespace(is_over=self.is_over))
        outcomes = [self.outcome(s) for s in followed]
        found = structure_choice._followed_on(
            cast(Any, None), cast(Any, fits), outcomes, cast(Any, search), cast(Any, logs)
        )
        return found


BEFORE = Fits([Structure((LAG,)), Structure((SHAFT,)), Structure((GAP,))])
AFTER = Fits([Structure((key,), fit="beside") for key in (SHAFT, LAG, GAP)])


def test_the_best_beside_what_was_found_is_followed_too(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene(monkeypatch)
    fits, outcomes = scene.run(BEFORE, [BEFORE.order[0], BEFORE.order[2]], AFTER)
    assert fits is AFTER
    assert scene.fitted_beside == ["direction_dependent_friction@pan"]
    assert scene.searched == [(SHAFT,)]
    assert [cast(Any, s.structure).keys for s in outcomes] == [(LAG,), (GAP,), (SHAFT,)]
    assert [s.structure for s in outcomes[:2]] == cast(Any, AFTER.order[1:]), "as they fit there"


def test_one_that_leaves_noise_alone_beside_them_comes_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = Scene(monkeypatch)
    after = Fits(AFTER.order, quiet=(AFTER.order[2],))
    scene.run(BEFORE, [BEFORE.order[0]], after)
    assert scene.searched == [(GAP,)]


def test_where_one_that_was_followed_cannot_be_fitted_again_all_stays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = Scene(monkeypatch)
    fits, outcomes = scene.run(BEFORE, BEFORE.order, Fits(AFTER.order[:2]))
    assert fits is BEFORE and [s.structure for s in outcomes] == cast(Any, BEFORE.order)


def test_one_that_was_followed_is_not_searched_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene(monkeypatch)
    _, outcomes = scene.run(BEFORE, BEFORE.order[:2], AFTER)
    assert not scene.searched
    assert [s.structure for s in outcomes] == cast(Any, [AFTER.order[1], AFTER.order[0]])


@pytest.mark.parametrize(
    "given", [{"noise_alone": True}, {"finds": None}, {"is_over": True}], ids=str
)
def test_nothing_is_fitted_again_without_need(
    monkeypatch: pytest.MonkeyPatch, given: dict[str, Any]
) -> None:
    scene = Scene(monkeypatch, **given)
    fits, outcomes = scene.run(BEFORE, BEFORE.order[:2], AFTER)
    assert fits is BEFORE and len(outcomes) == 2
    assert not scene.fitted_beside and not scene.searched


def test_structures_that_were_fitted_beside_it_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = Scene(monkeypatch)
    known = Fits(BEFORE.order, beside=("direction_dependent_friction@pan",))
    fits, _ = scene.run(known, known.order[:2], AFTER)
    assert fits is known and not scene.fitted_beside


def test_what_needs_the_structure_is_no_effect_of_the_platform_without_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A gap is found beside a shaft; a rigid gear cannot have it."""

    def candidate(effect: str, parameter: str) -> Any:
        key, own = f"{effect}@pan", (parameter,)
        return SimpleNamespace(
            id=effect, axis="pan", key=key, is_declared_value=False, parameters=own
        )

    gap = candidate("backlash", "gap_pan")
    drag = candidate("quadratic_drag", "c_drag_pan")
    late = candidate("input_delay", "t_delay_pan")
    model = SimpleNamespace(parameter_names=("t_delay_pan",), input_delays=(0,))

    @dataclass
    class Trial:
        candidates: tuple[Any, ...]
        fit: Any

    def found(*candidates: Any) -> Searched:
        trial = Trial(candidates, SimpleNamespace(model=model, runs=()))
        search = SimpleNamespace(chosen=trial, declared=None, problem=None)
        return Searched(cast(Any, None), None, cast(Any, None), cast(Any, search))

    kept = ("rigid_bodies", "dc_motor", "csvs_friction")
    declared = read_platform("thesis-pan-drive")
    own = tuple(e for e in declared.effects if e.effect in kept)
    rigid = replace(declared, effects=own, parameters=(), signals=())
    patch = monkeypatch.setattr
    patch(structure_choice, "on_runs_of", lambda *given: None)
    patch(structure_choice, "gain", lambda *given: SimpleNamespace(is_most=True))
    patch(structure_choice, "with_effects", lambda platform, trial, moves: trial.candidates)
    assert structure_choice._with_found(rigid, found(gap, drag, late)) == (drag,)
    assert structure_choice._with_found(rigid, found(gap, late)) is None


@pytest.mark.parametrize(("moves", "friction"), [(True, 7.5), (False, 4.0)])
def test_what_was_declared_free_starts_as_declared_beside_what_was_found(
    moves: bool, friction: float
) -> None:
    declared = read_platform("thesis-pan-drive")
    parameters = tuple(
        replace(p, value=4.0, free=True) if p.name == "F_v_pan" else p for p in declared.parameters
    )
    platform = replace(declared, parameters=parameters)
    drag = SimpleNamespace(
        id="quadratic_drag", axis="pan", is_declared_value=False, parameters=("c_drag_pan",)
    )
    own = SimpleNamespace(name="c_drag_pan", unit="N m s^2/rad^2", lower=0.0, upper=10.0)
    trial: Any = SimpleNamespace(
        candidates=(drag,),
        values={"F_v_pan": 7.5, "c_drag_pan": 0.3},
        fit=SimpleNamespace(model=SimpleNamespace(parameters=[own])),
    )
    found = {p.name: p for p in with_effects(platform, trial, moves=moves).parameters}
    assert (found["F_v_pan"].value, found["c_drag_pan"].value) == (friction, 0.3)
    assert found["F_v_pan"].free and found["c_drag_pan"].free


def end(error: float) -> Searched:
    """A search that ends with some error."""
    return Searched(*cast(Any, (None, None, None, SimpleNamespace(chosen=error))))


@pytest.mark.parametrize(
    ("errors", "left"),
    [
        ((1.0, 9.0, 1.3), (1.0, 1.3)),  # one that is far behind noise alone is no answer
        ((1.0, 1.0, 9.0), (1.0, 1.0)),
        ((2.0, 9.0), (2.0, 9.0)),  # beside more than noise each may be
        ((9.0,), (9.0,)),
    ],
)
def test_what_is_far_behind_noise_alone_is_not_decided_on(
    monkeypatch: pytest.MonkeyPatch, errors: tuple[float, ...], left: tuple[float, ...]
) -> None:
    def error(one: Searched) -> Any:
        return one.found.chosen

    patch = monkeypatch.setattr
    patch(Searched, "is_noise_alone", property(lambda one: error(one) <= 1.0))
    patch(structure_choice, "_best_fit", lambda ends: min(ends, key=error))
    patch(structure_choice, "_is_far_ahead", lambda one, other: 2.0 * error(one) < error(other))
    found = structure_choice._not_far_behind([end(e) for e in errors])
    assert tuple(error(one) for one in found) == left
