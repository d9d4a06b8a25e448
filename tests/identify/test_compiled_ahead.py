"""What is compiled ahead for a fit is what a fit calls, with the types that it calls it with."""

import numba
import numpy as np
import pytest

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify import ahead, along_motion, evaluate, weak_form
from ptp_symbolic.numeric.identify.equation_space import prepare_equation_space
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from tests.identify.test_states_along import AXES, PERIOD, PLATFORM


def test_no_function_is_compiled_for_other_types() -> None:
    """An array of another layout would have it compiled again, in the middle of a fit."""
    model = emission.emit(PLATFORM)
    time = PERIOD * np.arange(300)
    outputs = np.zeros((len(time), len(model.output_names)))
    for k, axis in enumerate(AXES):
        angle = 0.1 * np.sin((3.0 + k) * time)
        outputs[:, model.output_names.index(f"theta_{axis}")] = angle
    log = Log("run", time, np.zeros((len(time), 2)), outputs)
    p = model.parameter_vector()
    space = prepare_equation_space(model, prepare_runs(model, PLATFORM, [log]), p, [], p)
    space._torques(0, p, None, space.rows_of[0].part)
    called = []
    for function, types in (*along_motion.AHEAD, *evaluate.AHEAD, *weak_form.AHEAD):
        assert function.signatures in ([], [types]), function.__name__
        called += [function.__name__] if function.signatures else []
    assert {"further_states", "torques_along", "averages"} <= set(called)


def test_what_no_cache_holds_is_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    """A function that was called before, or found on the disk, would hide that it is not."""
    types, noted = (numba.float64,), []
    twice = numba.njit(lambda x: 2.0 * x)
    for module, functions in ((weak_form, ((twice, types),)), (evaluate, ()), (along_motion, ())):
        monkeypatch.setattr(module, "AHEAD", functions)
    monkeypatch.setattr(ahead, "note_compiled", noted.append)
    ahead.compile_all()
    assert twice.signatures == [types]
    assert noted == [ahead.FIT]
