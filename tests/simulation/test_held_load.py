"""A load that friction holds in the gap and that would drive the gear back: both come to rest."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from ptp_symbolic import sensitivity, simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import multisine, step, table
from tests.effects.test_backlash_kinds import (
    DRIVEN,
    GAP,
    GEAR,
    JOINT,
    METHODS,
    REDUCED,
    assert_sound,
    platform,
)

SPRING = 5.0
EDGES, VOLTS = np.array([0.0, 1.0, 1.6, 2.2]), np.array([3.0, 16.0, 8.0, -4.0])
TIMES = np.array([0.0, 0.3, 0.7, 1.1, 1.5, 2.0, 2.15, 3.0])
INPUTS = {"u_pan": table(EDGES, VOLTS, "hold")}
PARAMETERS = {n: v for n, v in DRIVEN.items() if n != "b_pan"} | {"k1_cable_pan": SPRING}
FRICTION = {"F_c_pan": 0.05, "F_s_pan": 0.08, "F_v_pan": 0.01, "v_s_pan": 0.05}


@pytest.fixture(scope="module")
def sprung() -> Model:
    return emission.emit(platform("hysteresis_friction", "cable_spring"))


def with_soft_faces(stiffness: float) -> NDArray[np.float64]:
    """States [k, 4] of bodies with springs as faces, and viscous holding of a joint unless pushed.

    A face pulls a joint that goes on in the direction of its push, as the rigid one does; all of
    it tends to rigid faces and to rest as the stiffness grows.
    """
    holding, damping = 100.0 * math.sqrt(stiffness), 2.0 * math.sqrt(stiffness * REDUCED)
    reach = 0.5 / math.sqrt(stiffness)

    def slope(_: float, x: NDArray[np.float64], voltage: float) -> list[float]:
        joint, joint_rate, gear, gear_rate, current = x
        push, free = 0.0, 0.0
        for side in (1.0, -1.0):
            depth = side * (gear - joint) - 0.5 * GAP
            near = min(max(1.0 + depth / reach, 0.0), 1.0)
            force = stiffness * depth + damping * side * (gear_rate - joint_rate)
            if depth <= 0.0:
                force *= near * min(max(side * joint_rate / 1e-4, 0.0), 1.0)
            push += side * force
            if side * joint_rate > 0.0:
                free = max(free, min(1.0, 2.0 * near))
        load = push - SPRING * joint - holding * joint_rate * (1.0 - free)
        current_rate = (voltage - current - 0.1 * gear_rate) / 1e-3
        return [joint_rate, load / JOINT, gear_rate, (0.1 * current - push) / GEAR, current_rate]

    x, found = np.zeros(5), {}
    for begin, end, voltage in zip(EDGES, [*EDGES[1:], TIMES[-1]], VOLTS, strict=True):
        wanted = np.union1d(TIMES[np.clip(TIMES, begin, end) == TIMES], end)
        run = solve_ivp(
            slope, (begin, end), x, "Radau", wanted, args=(voltage,), rtol=1e-7, atol=1e-10
        )
        found |= dict(zip(run.t, run.y.T, strict=True))
        x = run.y[:, -1]
    return np.array([found[t][:4] for t in TIMES])


@pytest.mark.parametrize("method", METHODS)
def test_rest_and_what_follows_are_the_limit_of_soft_faces(sprung: Model, method: str) -> None:
    found = simulate(sprung, TIMES, INPUTS, PARAMETERS, method=method)
    modes = [event.mode for event in found.events]
    assert modes[:4] == 2 * ["touches the upper face", "leans on the upper face"]
    assert modes[4:] == ["is in the gap", "touches the lower face", "leans on the lower face"]
    assert_sound(simulate(sprung, 3.0, INPUTS, PARAMETERS, method=method))
    errors = [
        np.abs(with_soft_faces(stiffness) - found.x[:, :4])[:, [0, 2]].max()
        for stiffness in (1e4, 1e6)
    ]
    assert errors[1] < 1e-4
    assert errors[1] < errors[0] / 8.0


def test_the_rest_is_complete_and_ends_when_the_motor_outdoes_the_load(sprung: Model) -> None:
    found = simulate(sprung, 3.0, INPUTS, PARAMETERS)
    events = [event.time for event in found.events]
    resting = (found.t > events[1]) & (found.t < events[2])
    assert np.ptp(found["theta_pan"][resting]) == np.ptp(found["theta_gear_pan"][resting]) == 0.0
    assert np.all(found.x[resting][:, [1, 3]] == 0.0)
    ramped = simulate(
        sprung, 4.0, {"u_pan": multisine([30.0], [0.1])}, {**PARAMETERS, "K_t_pan": 0.02}
    )
    starts = [e.time for e in ramped.events if e.mode == "touches the upper face"]
    leans = [e.time for e in ramped.events if e.mode == "leans on the upper face"]
    again = next(t for t in starts if t > leans[0])
    at = np.searchsorted(ramped.t, again) - 1
    assert 0.02 * ramped["i_pan"][at] == pytest.approx(SPRING * ramped["theta_pan"][at], rel=5e-3)


@pytest.mark.parametrize("site", ["joint", "gear"])
@pytest.mark.parametrize("load", ["constant_torque", "cable_spring"])
def test_dry_friction_beside_the_rest(load: str, site: str) -> None:
    """These loads chattered; both methods see the same, and energy is lost alone."""
    model = emission.emit(platform("hysteresis_friction", load, "csvs_friction", site=site))
    force = {"tau0_pan": -0.3} if load == "constant_torque" else {"k1_cable_pan": SPRING}
    parameters = {n: v for n, v in DRIVEN.items() if n != "b_pan"} | FRICTION | force
    for signal in (step(3.0, 0.0, 0.5), multisine([6.0, 3.0], [0.7, 1.9])):
        one, other = (
            simulate(model, 4.0, {"u_pan": signal}, parameters, method=m) for m in METHODS
        )
        assert_sound(one)
        assert one.x[-1, :4] == pytest.approx(other.x[-1, :4], abs=1e-5)
    assert load == "constant_torque" or any("leans" in event.mode for event in one.events)


@pytest.mark.parametrize("method", METHODS)
def test_tangents_through_the_rest(sprung: Model, method: str) -> None:
    names = ["J_pan", "gap_pan", "K_t_pan", "k1_cable_pan"]
    found = sensitivity(
        sprung,
        TIMES,
        INPUTS,
        PARAMETERS,
        by_parameters=names,
        rtol=1e-10,
        atol=1e-11,
        method=method,
    )
    for index, name in enumerate(names):
        h = 1e-5 * PARAMETERS[name]
        above, below = (
            simulate(
                sprung,
                TIMES,
                INPUTS,
                {**PARAMETERS, name: PARAMETERS[name] + s * h},
                rtol=1e-12,
                atol=1e-13,
            ).x[:, [0, 2]]
            for s in (1.0, -1.0)
        )
        difference = (above - below) / (2.0 * h)
        size = np.abs(difference).max()
        assert found.states[:, [0, 2], index] == pytest.approx(difference, abs=2e-6 * size)
