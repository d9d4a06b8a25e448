"""Modules without what vanishes give what the whole modules give, to the last bit."""

import ast
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.identify import evaluate as evaluation
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation import specialised
from ptp_symbolic.numeric.simulation.inputs import stack, table
from ptp_symbolic.numeric.simulation.specialised import Specialised, specialised_text
from ptp_symbolic.platform import read_platform

PLATFORMS = Path(__file__).parents[1] / "platforms"
MACHINES = ("fieldlog_pan.toml", "fieldlog_two_axis.toml")
WITH = ("T_cos_pan", "a_F_c_pan", "k1_cable_pan")
"""Parameters of effects that are on."""


@pytest.fixture(scope="module", params=MACHINES)
def model(request: pytest.FixtureRequest) -> Model:
    return emission.emit(variants.with_candidates(read_platform(PLATFORMS / request.param)))


def parameters(model: Model) -> tuple[np.ndarray, np.ndarray]:
    """Candidates at zero but those WITH; columns of these and of two declared parameters."""
    values = {q.name: q.vanishes for q in model.parameters if q.vanishes is not None}
    on = {q.name: 0.3 * (q.starts or (1.0,))[0] for q in model.parameters if q.name in WITH}
    assert on
    names = [*on, "J_pan", "F_c_pan"]
    columns = np.array(sorted(model.parameter_names.index(name) for name in names))
    return model.parameter_vector(values | on), columns


@pytest.fixture(scope="module")
def lean(model: Model) -> Iterator[Specialised]:
    """What is specialised of the model, with the functions for these parameters."""
    found = Specialised(model.module)
    found.note(found.unneeded(*parameters(model)), specialised.WORTH)
    yield found


def written(module: object, name: str, p: np.ndarray, state: np.random.Generator) -> list[object]:
    """What a function of the module writes at a random state that slides."""
    count = len(module.STATE_NAMES), len(module.INPUT_NAMES), len(module.MODE_NAMES)
    x, u = np.abs(state.normal(size=count[0])), state.normal(size=count[1])  # no time is negative
    modes = state.choice([-1.0, 1.0], size=count[2])
    if name == "mode_derivative":
        out = [np.zeros(count[0])]
    elif name == "guards":
        out = [np.zeros(4 * count[2] + 4)]
    elif name == "linearize":
        rows = 4 * count[2] + 4
        shapes = [(count[0], k) for k in (count[0], count[1], len(p))]
        out = [np.zeros(shape) for shape in [*shapes, (rows, count[0]), (rows, len(p))]]
    elif name == "outputs":
        out = [np.zeros(len(module.OUTPUT_NAMES))]
        getattr(module, name)(0.1, x, u, p, *out)
        return out
    getattr(module, name)(0.1, x, u, p, modes, *out)
    return out


@pytest.mark.parametrize("name", ["mode_derivative", "guards", "linearize", "outputs"])
def test_functions_write_the_same(model: Model, lean: Specialised, name: str) -> None:
    p, columns = parameters(model)
    found = lean._emitted_without(lean.unneeded(p, columns))
    assert found is not None
    for seed in range(20):
        usual = written(model.module, name, p, np.random.default_rng(seed))
        own = written(found, name, p, np.random.default_rng(seed))
        for before, after in zip(usual, own, strict=True):
            asked = columns if before.ndim == 2 and before.shape[1] == len(p) else slice(None)
            np.testing.assert_array_equal(before[..., asked], after[..., asked])
    assert any(np.any(one) for one in usual)


def test_most_of_a_module_goes(model: Model, lean: Specialised, figure) -> None:
    p, columns = parameters(model)
    found = lean._emitted_without(lean.unneeded(p, columns))
    lines = [
        len(ast.unparse(function).splitlines())
        for module in (model.module, found)
        for function in ast.parse(Path(module.__file__).read_text("utf-8")).body
        if isinstance(function, ast.FunctionDef) and function.name == "linearize"
    ]
    assert figure("share of the lines that stay", lines[1] / lines[0]) < 0.5


def test_those_that_leave_out_more_than_may_be_are_not_taken(
    model: Model, lean: Specialised
) -> None:
    p, columns = parameters(model)
    whole = lean.without(0, True)
    off = lean.unneeded(p, columns)
    assert lean.without(off, True) is lean.known[off]
    assert not np.array_equal(lean.known[off].motion, whole.motion)
    p[model.parameter_names.index("c_drag_pan")] = 0.1
    np.testing.assert_array_equal(
        lean.without(lean.unneeded(p, columns), True).motion, whole.motion
    )
    further = np.append(columns, model.parameter_names.index("c_drag_pan"))
    np.testing.assert_array_equal(
        lean.without(lean.unneeded(parameters(model)[0], further), True).motion, whole.motion
    )


def test_a_simulation_is_the_same(
    model: Model, lean: Specialised, monkeypatch: pytest.MonkeyPatch
) -> None:
    p, columns = parameters(model)
    time, inputs = 0.005 * np.arange(401), len(model.input_names)
    given = stack([table(time, 3.0 * np.sin((4.0 + j) * time)) for j in range(inputs)])
    n = len(model.state_names)
    run = Run(
        "run",
        "run",
        time,
        given,
        np.array([3.0 * np.sin((4.0 + j) * time) for j in range(inputs)]).T.copy(),
        np.zeros((len(time), 1)),
        np.zeros(1, dtype=np.int64),
        np.ones(1),
        np.full(1, np.nan),
        ("theta_pan",),
        np.zeros(n),
        (),
    )

    def made(known: Specialised) -> evaluation.Evaluation:
        monkeypatch.setattr(evaluation, "specialised", lambda module: known)
        return evaluate(model, run, p, np.zeros(0), columns, True, Tolerance())

    usual, own = made(Specialised(model.module)), made(lean)
    assert usual.failed is None
    assert np.abs(usual.residual).max() > 0.01
    np.testing.assert_array_equal(usual.residual, own.residual)
    np.testing.assert_array_equal(usual.by_parameter, own.by_parameter)


def test_what_is_written_by_hand() -> None:
    """Constants go on through names, tuples and calls; what decides on nothing goes."""
    text = """
def constants(p):
    a, b = p[0], p[1]
    twice = 2.0 * a
    return (twice, b * a)

def prepared_derivative(t, x, u, p, m, c, dx):
    a, b = p[0], p[1]
    known = c[0] + a * x[0]
    chosen = x[1] if a > 0.0 else (x[2] if x[0] > 0.0 else 0.0)
    dx[0] = known + chosen * b / 1.0 - a
    dx[1] = math.cos(a) * x[1]

def linearize(t, x, u, p, m, fx, fu, fp, gx, gp):
    a, b = p[0], p[1]
    fp[0, 0] = x[0]
    fp[0, 1] = b + a ** 2
"""
    found = specialised_text(text, {0: 0.0}, {0})
    lines = [line.strip() for line in found.splitlines() if line.startswith("    ")]
    assert lines == [
        "return (0.0, 0.0)",
        "b = p[1]",
        "chosen = x[2] if x[0] > 0.0 else 0.0",
        "dx[0] = chosen * b",
        "dx[1] = x[1]",
        "b = p[1]",
        "fp[0, 1] = b",
    ]
