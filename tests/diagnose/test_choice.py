"""How a structure is chosen: which searches go on, beside what structures are fitted, and which of
the outcomes is named; searches and fits are stand-ins.
"""

from types import SimpleNamespace
from typing import Any, cast

import pytest

from ptp_symbolic.numeric.identify.evidence import Allowance
from ptp_symbolic.workflows import structure_choice
from ptp_symbolic.workflows.structure_choice import Searched
from ptp_symbolic.workflows.structure_fits import Logs


def with_terms(*keys: str, is_brief: bool = False) -> Any:
    """What a search ends with: terms, each with a parameter of its name."""
    terms = tuple(SimpleNamespace(key=key, parameters=(f"p_{key}",)) for key in keys)
    model = SimpleNamespace(parameter_names=("p_spring", "p_delay"), input_delays=(-1, 1))
    chosen = SimpleNamespace(candidates=terms, fit=SimpleNamespace(model=model), values={})
    return SimpleNamespace(is_brief=is_brief, is_cut_short=False, chosen=chosen)


@pytest.mark.parametrize("is_noise_alone", [True, False])
def test_a_brief_search_goes_on_where_most_windows_show_noise_alone(
    monkeypatch: pytest.MonkeyPatch, is_noise_alone: bool
) -> None:
    """Once it is whole, this one finds nothing to add, and no structure is fitted."""
    begun: list[Any] = []

    def whole(problem: Any, found: Any) -> Any:
        begun.append(found)
        return with_terms()

    def fitted(*given: Any) -> Any:
        raise RuntimeError("structures are fitted")

    patch = monkeypatch.setattr
    structure = SimpleNamespace(
        keys=("shaft",), provides=frozenset({"shaft"}), platform=None, axes=frozenset({"pan"})
    )
    patch(structure_choice, "structures", lambda platform: ((structure,), {}))
    patch(structure_choice.variants, "that_cannot_stand", lambda platform: {})
    patch(structure_choice, "in_scale", lambda every, platform: every)
    patch(structure_choice, "replace", lambda one, **new: SimpleNamespace(**{**vars(one), **new}))
    brief = with_terms("spring", is_brief=True)
    search = SimpleNamespace(
        structure=None, problem=SimpleNamespace(), found=brief, is_noise_alone=is_noise_alone
    )
    search.decided = "decided"
    patch(structure_choice, "_searched", lambda *given, **options: search)
    patch(structure_choice, "continued", whole)
    patch(structure_choice, "_with_found", lambda *given: None)
    patch(structure_choice, "unaffected_axes", lambda *given: frozenset())
    patch(structure_choice, "fit_structures", fitted)
    allowance = Allowance()
    logs = Logs((), (), cast(Any, None), lambda text: None, allowance)
    platform = cast(Any, SimpleNamespace(parameters=()))
    if is_noise_alone:
        choice = structure_choice.chosen_structure(platform, logs)
        assert begun == [brief]
        assert choice.untried["shaft"].endswith("the declared structure is noise alone")
    else:
        with pytest.raises(RuntimeError, match="structures are fitted"):
            structure_choice.chosen_structure(platform, logs)
        assert not begun


@pytest.mark.parametrize(
    ("terms", "late"),
    [(("spring",), set()), (("spring", "delay"), {"delay"}), ((), set())],
)
def test_delays_are_told_from_other_terms(terms: tuple[str, ...], late: set[str]) -> None:
    found = with_terms(*terms)
    one = Searched(*cast(Any, (None, None, None, found)))
    assert structure_choice._late(one) == late


def test_outcomes_in_other_windows_are_compared_in_those_of_the_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A trial is stood for by its residual in whole runs and in windows."""

    def end(pattern: str, **residuals: float) -> Any:
        return "problem", SimpleNamespace(fit=SimpleNamespace(runs=pattern), residuals=residuals)

    patch = monkeypatch.setattr
    patch(structure_choice, "on_runs_of", lambda problem, trial, runs: trial.residuals[runs])
    patch(structure_choice, "deviances", lambda residuals: residuals)
    whole, windows = end("whole", whole=2.0, windows=0.5), end("windows", whole=3.0, windows=0.4)
    assert structure_choice._least([whole, windows]) == 0
    assert structure_choice._least([windows, whole]) == 0
