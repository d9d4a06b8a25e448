"""Which structures may be named: what the logs say of their parameters."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from ptp_symbolic.numeric.diagnose.candidates import Candidate
from ptp_symbolic.numeric.diagnose.fitted_model import FittedModel
from ptp_symbolic.numeric.diagnose.structures import (
    is_identifiable,
    is_there,
    terms_beside,
    unaffected_axes,
)
from ptp_symbolic.numeric.identify.coordinates import free_parameter
from tests.identify.straight import finished


@pytest.mark.parametrize(
    ("tells_stiffness", "identifiable", "there"),
    [(0.5, True, True), (0.05, False, True), (0.002, False, False)],
)
def test_a_stiffness_that_the_logs_bound_is_there_though_they_do_not_tell_it(
    tells_stiffness: float, identifiable: bool, there: bool
) -> None:
    """Inertia and stiffness of a resonance show by their ratio, and hardly apart from it."""
    inertia = free_parameter("J", 0.05, 1e-4, 2.0)
    stiffness = free_parameter("k", 500.0, 1e-3, 1e9)
    effect = Candidate("shaft", "pan", "", "", (stiffness,), {})
    rng, time = np.random.default_rng(3), 0.1 * np.arange(400)
    ratio, alone = np.sin(time), tells_stiffness * np.cos(3.0 * time)
    slopes = [np.stack([5.0 * ratio, -5.0 * ratio + alone], axis=1)] * 2
    residuals = [rng.standard_normal(400) for _ in range(2)]
    values = {"J": 0.05, "k": 500.0}
    fit = finished(residuals, slopes, None, (inertia, stiffness), values)
    trial = FittedModel((), fit)
    assert is_identifiable(effect, trial) is identifiable
    assert is_there(effect, trial, quiet=True) is there
    assert is_there(effect, trial, quiet=False) is identifiable


@pytest.mark.parametrize(
    ("pan", "tilt", "terms", "idle"),
    [
        (1.0, 1.0, [("spring", "pan")], {"tilt"}),
        (3.0, 1.0, [], {"tilt"}),
        (3.0, 1.0, [("tilted base", None)], {"tilt"}),
        (3.0, 1.0, [("delay", "tilt")], set()),
        (1.0, 1.0, [("tilted base", None)], set()),
        (3.0, 3.0, [], set()),
    ],
)
def test_an_axis_with_noise_and_no_term_has_no_structure(
    pan: float, tilt: float, terms: list[tuple[str, str | None]], idle: set[str]
) -> None:
    """A term on the platform moves both axes: it hides no structure where more than noise is left
    on one of them, and may be confounded with one where noise alone is left.
    """
    rng = np.random.default_rng(5)
    fit = finished([np.array([pan, tilt]) * rng.standard_normal((400, 2)) for _ in range(3)])
    runs = [replace(run, signals=("theta_pan", "theta_tilt")) for run in fit.runs]
    model: Any = SimpleNamespace(module=SimpleNamespace(AXES=("pan", "tilt")))
    found = tuple(Candidate(name, axis, "", "", (), {}) for name, axis in terms)
    trial = FittedModel(found, replace(fit, runs=tuple(runs), model=model))
    search = SimpleNamespace(chosen=trial, propagated=SimpleNamespace(most=np.zeros(2)))
    assert unaffected_axes(cast(Any, search), pan == tilt == 1.0) == idle


def test_a_search_in_a_structure_begins_with_the_terms_that_it_was_fitted_beside() -> None:
    """Of the forms of a term, that with the parameters which were free; known values stay known."""
    by_name = {
        name: free_parameter(name, 0.0, -1.0, 1.0) for name in ("k", "a_F_c", "a_F_s", "a_v_s")
    }

    def form(key: str, *names: str) -> Candidate:
        return Candidate(key, "pan", "", "", tuple(by_name[n] for n in names), {})

    forms = [form("friction", *names) for names in (("a_F_c",), ("a_F_c", "a_F_s"), tuple(by_name))]
    problem: Any = SimpleNamespace(
        candidates=(*forms, form("drag", "a_F_s")), fixed={"R": 2.0, "a_F_c": 0.0}, free=()
    )
    effects = [SimpleNamespace(key=key) for key in ("shaft@pan", "friction@pan")]
    structure: Any = SimpleNamespace(
        problem=SimpleNamespace(
            free=[by_name["k"], by_name["a_F_c"], by_name["a_F_s"]],
            model=SimpleNamespace(effects=effects),
        ),
        trial=SimpleNamespace(values={"k": 0.5, "a_F_c": -0.27, "a_F_s": -0.2, "R": 1.98}),
    )
    found = terms_beside(structure, problem)
    assert found is not None and found.candidates == (forms[1],)
    assert found.values == {"k": 0.5, "a_F_c": -0.27, "a_F_s": -0.2, "R": 2.0}
    structure.problem.model.effects = effects[:1]
    assert terms_beside(structure, problem) is None
    assert terms_beside(None, problem) is None
