"""Searches stay where the machine is possible: breakaway never falls below sliding friction."""

import math

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.numeric.identify.coordinates import (
    Allow,
    FreeParameter,
    free_parameter,
    keep_possible,
    nearest_possible,
    to_search,
    to_values,
)
from ptp_symbolic.numeric.identify.fit import fit_parameters
from ptp_symbolic.numeric.identify.intervals import estimates
from ptp_symbolic.numeric.identify.least_squares import Effort, all_values
from ptp_symbolic.numeric.runtime.model import Model
from tests.identify.pan_runs import (
    FLOOR,
    MODEL,
    THREE,
    TRUTH,
    Floats,
    fitted,
    make_runs,
    starts_off,
    unfree,
)
from tests.independent.pan_drive import PanDrive

SLIDING = free_parameter("F_c_pan", 0.24, 0.0, 20.0)
STATIC = free_parameter("F_s_pan", 0.6, 0.0, 30.0)
VISCOUS = free_parameter("F_v_pan", 14.0, 0.0, 50.0)
ALL = (VISCOUS, SLIDING, STATIC)


def keeper(model: Model, free: tuple[FreeParameter, ...], **fixed: float) -> Allow:
    def parameters(phi: Floats) -> Floats:
        return model.parameter_vector({**fixed, **all_values(free, phi)})

    return keep_possible(model, free, parameters)


def stepped(
    begin: dict[str, float], trial: dict[str, float], free: tuple[FreeParameter, ...] = ALL
) -> dict[str, float]:
    """Where a step of the pan drive ends."""
    allow = keeper(MODEL, free, F_c_pan=0.24, F_s_pan=0.6)
    return to_values(free, allow(to_search(free, begin), to_search(free, trial)))


def values(viscous: float, sliding: float, static: float) -> dict[str, float]:
    return {"F_v_pan": viscous, "F_c_pan": sliding, "F_s_pan": static}


def test_a_possible_step_is_taken_as_it_is() -> None:
    trial = values(12.0, 0.5, 0.51)
    assert stepped(values(14.0, 0.24, 0.6), trial) == pytest.approx(trial, rel=1e-12)
    equal = values(12.0, 0.3, 0.3)
    assert stepped(values(14.0, 0.24, 0.6), equal) == pytest.approx(equal, rel=1e-9)


@pytest.mark.parametrize(
    ("begin", "trial", "meet"),
    [
        ((0.2, 0.4), (0.4, 0.2), 10.8 / 29),
        ((0.24, 0.6), (0.5, 0.18), 13.22 / 29),
        ((0.3, 0.3), (0.5, 0.45), 14.3 / 29),
        ((0.3, 0.3), (0.2, 0.125), 5.5 / 29),
    ],
)
def test_both_frictions_meet_on_the_way_and_slide_along_the_edge(
    begin: tuple[float, float], trial: tuple[float, float], meet: float
) -> None:
    """In units of their starts the nearest possible pair to (F_c, F_s) is (25 F_c + 4 F_s) / 29 for
    both, as 0.6 is to 0.24 as 5 to 2: each moves by the square of its unit. Viscous friction goes
    free.
    """
    found = stepped(values(14.0, *begin), values(10.0, *trial))
    assert found == pytest.approx(values(10.0, meet, meet), rel=1e-8)
    assert found["F_s_pan"] >= found["F_c_pan"]


def test_a_free_friction_stops_at_a_known_one() -> None:
    low = stepped({"F_s_pan": 0.6}, {"F_s_pan": 0.1}, (STATIC,))
    assert low["F_s_pan"] == pytest.approx(0.24, rel=1e-9)
    assert low["F_s_pan"] >= 0.24
    high = stepped({"F_c_pan": 0.24}, {"F_c_pan": 3.0}, (SLIDING,))
    assert high["F_c_pan"] == pytest.approx(0.6, rel=1e-9)
    assert high["F_c_pan"] <= 0.6


def test_the_way_back_ends_at_bounds() -> None:
    """Sliding friction wants 10, breakaway may not exceed 2: they meet there and not above. The
    last of the way sliding friction goes alone, a millionth of the 7 N m too far.
    """
    free = (SLIDING, free_parameter("F_s_pan", 0.6, 0.0, 2.0))
    begin, trial = {"F_c_pan": 0.24, "F_s_pan": 0.6}, {"F_c_pan": 10.0, "F_s_pan": 1.9}
    found = stepped(begin, trial, free)
    assert found["F_c_pan"] <= found["F_s_pan"] <= 2.0
    assert found == pytest.approx({"F_c_pan": 2.0, "F_s_pan": 2.0}, abs=1e-5)


def test_tied_frictions_are_never_held() -> None:
    tied = (free_parameter("F_c_pan", 0.24, 0.0, 20.0, None, ("F_s_pan",)),)
    assert stepped({"F_c_pan": 0.24}, {"F_c_pan": 0.05}, tied)["F_c_pan"] == pytest.approx(0.05)


def test_a_relation_broken_from_the_start_is_let_be() -> None:
    trial = values(10.0, 0.7, 0.3)
    assert stepped(values(14.0, 0.6, 0.5), trial) == pytest.approx(trial, rel=1e-12)


def test_a_start_with_a_broken_relation_goes_to_the_nearest_possible_one() -> None:
    """In units of their starts, as above; viscous friction stays. A fit ends possible from there:
    its result used to be refused after all the work.
    """
    phi = to_search(ALL, values(14.0, 0.6, 0.2))

    def parameters(phi: Floats) -> Floats:
        return MODEL.parameter_vector(all_values(ALL, phi))

    found = to_values(ALL, nearest_possible(MODEL, ALL, parameters, phi))
    meet = (25 * 0.6 + 4 * 0.2) / 29
    assert found == pytest.approx(values(14.0, meet, meet), rel=1e-5)
    assert found["F_s_pan"] >= found["F_c_pan"]

    made = make_runs(PanDrive(), [profile() for profile in THREE], 10)
    free = (free_parameter("F_c_pan", 0.5, 0.0, 20.0), free_parameter("F_s_pan", 0.3, 0.0, 30.0))
    names = {f.name for f in free}
    fit = fit_parameters(MODEL, made.runs, free, unfree(names) | {**TRUTH}, None, Effort(15, 1e-4))
    MODEL.refuse_impossible(MODEL.parameter_vector(dict(fit.values)))
    assert fit.values["F_s_pan"] == pytest.approx(0.65, rel=0.1)


def test_a_strict_relation_is_kept_strictly() -> None:
    """The screw of the tilt drive would wedge at f = pi d / lead."""
    model = ptp_symbolic.load("tilt_drive")
    diameter, lead = (model.defaults[f"{name}_tilt"] for name in ("d_screw", "lead"))
    free = (free_parameter("f_screw_tilt", 0.1, 0.0, 10.0),)
    allow = keeper(model, free)
    wedged = math.pi * diameter / lead
    trial = to_search(free, {"f_screw_tilt": 1.5 * wedged})
    found = to_values(free, allow(np.zeros(1), trial))["f_screw_tilt"]
    assert found < wedged
    assert found == pytest.approx(wedged, rel=1e-6)
    at_it = to_search(free, {"f_screw_tilt": wedged * (1 + 1e-12)})
    assert to_values(free, allow(np.zeros(1), at_it))["f_screw_tilt"] < wedged


def test_a_model_without_requirements_allows_everything() -> None:
    free = (free_parameter("J_pan", 0.1, 0.0, 1.0),)
    allow = keeper(ptp_symbolic.load("ideal"), free)
    assert np.array_equal(allow(np.zeros(1), np.array([-9.0])), np.array([-9.0]))


@pytest.mark.parametrize(
    ("seed", "sliding", "static", "looked_for"),
    [(3, 0.17, 0.65, False), (1, 0.36, 0.36, False), (3, 0.17, 0.65, True), (2, 0.36, 0.36, True)],
)
def test_a_machine_without_stribeck_effect_is_found_possible(
    seed: int, sliding: float, static: float, looked_for: bool
) -> None:
    """Breakaway and sliding friction are both 0.24 N m: the truth lies on the edge. The search
    starts far inside, or on the edge elsewhere, and has to go along it; the gear starts in the
    middle of its gap, or where it is looked for.
    """
    truth = TRUTH | {"F_s_pan": 0.24}
    del truth["v_s_pan"]  # nothing depends on it
    drive = PanDrive(F_s_forward=0.24, F_s_backward=0.24)
    made = make_runs(drive, [profile() for profile in THREE], seed)
    by_name = {f.name: f for f in starts_off(truth, seed)}
    by_name["F_c_pan"] = free_parameter("F_c_pan", sliding, 0.0, 20.0)
    by_name["F_s_pan"] = free_parameter("F_s_pan", static, 0.0, 30.0)
    z = None if looked_for else [run.guess for run in made.runs]
    fit = fitted(made.runs, tuple(by_name.values()), unfree(truth), z)
    assert fit.values["F_s_pan"] >= fit.values["F_c_pan"]
    MODEL.refuse_impossible(MODEL.parameter_vector(dict(fit.values)))
    assert fit.rms_counts() == pytest.approx(FLOOR, rel=0.15)
    for e in estimates(fit):
        assert abs(e.value - truth[e.name]) < 3.0 * (e.upper - e.lower) / 2, e
    assert fit.values["F_c_pan"] == pytest.approx(0.24, rel=0.1)
    assert fit.values["F_s_pan"] == pytest.approx(0.24, rel=0.1)


def test_a_fit_from_the_edge_comes_off_it() -> None:
    """Started at breakaway = sliding friction where the truth is 0.65 and 0.24."""
    made = make_runs(PanDrive(), [profile() for profile in THREE], 10)
    names = {"F_c_pan": 0.24, "F_s_pan": 0.65}
    free = tuple(free_parameter(name, 0.4, 0.0, 20.0) for name in names)
    fit = fit_parameters(MODEL, made.runs, free, unfree(names) | {**TRUTH}, None, Effort(15, 1e-4))
    for name, value in names.items():
        assert fit.values[name] == pytest.approx(value, rel=0.1)
