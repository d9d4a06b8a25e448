"""What is compiled ahead for a fit is what a fit calls, with the types that it calls it with."""

import numpy as np

from ptp_symbolic.models import emission
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify import along_motion, evaluate, weak_form
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
