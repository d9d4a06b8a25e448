"""Gauss-Newton steps over rows: they end before values at which there are no rows."""

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from ptp_symbolic.numeric.identify.coordinates import FreeParameter, free_parameter
from ptp_symbolic.numeric.identify.equation_fit import fit_equations
from ptp_symbolic.numeric.identify.equation_space import EquationSpace
from tests.identify.curves import Floats

TIME = np.linspace(0.0, 9.9, 100)
FREE = free_parameter("a", 1.0, -1e3, 1e3)


def space_of(left: Any) -> EquationSpace:
    """Rows `left(a)` of a model with one parameter."""
    model = SimpleNamespace(parameter_names=("a",), parameter_vector=lambda v: np.array([v["a"]]))
    labels = np.zeros(len(TIME), dtype=np.int64), np.zeros(len(TIME), dtype=np.int64), TIME

    def rows(p: Floats, own: None = None) -> Floats:
        return np.asarray(left(float(p[0])))

    return cast(EquationSpace, SimpleNamespace(model=model, labels=lambda: labels, rows=rows))


def fitted(left: Any, free: FreeParameter = FREE) -> float:
    return fit_equations(space_of(left), (free,), {"a": free.start}, 4)["a"]


def test_rows_that_are_linear_are_fitted() -> None:
    wave = np.sin(TIME)
    assert fitted(lambda a: (a - 3.0) * wave) == pytest.approx(3.0, rel=0.05)


def test_a_drive_that_is_off_for_most_of_a_log_tells_no_scale() -> None:
    """Seven of ten rows leave exactly nothing, whatever the parameter is."""
    wave = np.where(np.arange(len(TIME)) < 30, np.sin(7.0 * TIME), 0.0)
    noise = np.where(wave != 0.0, 0.01 * np.cos(11.0 * TIME), 0.0)
    space = space_of(lambda a: (a - 3.0) * wave + noise)
    assert fit_equations(space, (FREE,), {"a": 1.0}, 12)["a"] == pytest.approx(3.0, rel=0.01)


def test_a_step_to_where_there_are_no_rows_is_not_taken() -> None:
    """The slope at 1 leads to 3; beyond 2 the rows end."""
    wave = np.sin(TIME)
    assert fitted(lambda a: (a - 3.0) * wave if a < 2.0 else np.full(len(TIME), np.nan)) == 1.0
    assert fitted(lambda a: np.full(len(TIME), np.nan)) == 1.0
