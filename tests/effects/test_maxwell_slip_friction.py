"""Maxwell-slip friction: springs before they slip, stop operators, an own integration, energy."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic import sensitivity, simulate
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.run import Trajectory
from ptp_symbolic.platform import EffectDeclaration, Platform

EFFECTS = (
    EffectDeclaration("rigid_bodies", None, None),
    EffectDeclaration("maxwell_slip_friction", "pan", None),
)
PLATFORM = Platform("slipping", "Pan axis on slip elements", ("pan",), 9.81, EFFECTS, (), ())
INERTIA = 0.05
STIFFNESS, SLIP = np.array([900.0, 300.0, 80.0]), np.array([0.12, 0.2, 0.25])
LIMIT = SLIP / STIFFNESS
STATES = ("z_slip1_pan", "z_slip2_pan", "z_slip3_pan")
VALUES = {"J_pan": INERTIA}
VALUES |= {f"k_slip{i + 1}_pan": float(k) for i, k in enumerate(STIFFNESS)}
VALUES |= {f"F_slip{i + 1}_pan": float(f) for i, f in enumerate(SLIP)}
DRIVEN = {"tau_pan": "multisine:0.38@1.3,2.9"}
TIMES = np.linspace(0.0, 3.0, 3001)


def driving(t: float) -> float:
    return 0.38 * (math.sin(2.0 * math.pi * 1.3 * t) + math.sin(2.0 * math.pi * 2.9 * t))


@pytest.fixture(scope="module")
def model() -> Model:
    return emission.emit(PLATFORM)


@pytest.fixture(scope="module")
def driven(model: Model) -> Trajectory:
    return simulate(model, TIMES, DRIVEN, VALUES, rtol=1e-11, atol=1e-13)


def reaches(element: int) -> Callable[[float, np.ndarray], float]:
    """What is zero where an element begins to slip."""
    return lambda _, state: LIMIT[element] - abs(state[2 + element])


def turns(_: float, state: np.ndarray) -> float:
    """What is zero where the rate changes sign."""
    return float(state[1])


def integrated(end: float) -> np.ndarray:
    """State [5] at `end` in s by pieces between reversals and slips, each found by scipy."""
    x, t = np.zeros(5), 0.0
    sticking = np.ones(3, dtype=bool)
    while t < end:
        free = sticking.copy()

        def slope(at: float, x: np.ndarray, free: np.ndarray = free) -> np.ndarray:
            torque = driving(at) - STIFFNESS @ x[2:]
            return np.array([x[1], torque / INERTIA, *np.where(free, x[1], 0.0)])

        watched = [turns, *(reaches(k) for k in range(3) if free[k])]
        kinds = [-1, *(k for k in range(3) if free[k])]
        for event, kind in zip(watched, kinds, strict=True):
            event.terminal = True  # type: ignore[attr-defined]
            event.direction = 0 if kind < 0 else -1  # type: ignore[attr-defined]
        begun = np.array([t, t + 1e-7])
        first = solve_ivp(slope, begun, x, "DOP853", rtol=1e-12, atol=1e-15)
        piece = solve_ivp(
            slope,
            (begun[1], end),
            first.y[:, -1],
            "DOP853",
            None,
            False,
            watched,
            rtol=1e-11,
            atol=1e-14,
        )
        t, x = piece.t[-1], piece.y[:, -1]
        for found, kind in zip(piece.t_events, kinds, strict=True):
            if len(found) and kind < 0:
                sticking[:] = True
            elif len(found):
                sticking[kind] = False
    return x


def test_below_all_slips_it_is_a_spring(model: Model) -> None:
    """Theta = tau / k (1 - cos(sqrt(k / J) t)) with k the sum of the springs."""
    torque, whole = 0.05, float(STIFFNESS.sum())
    found = simulate(model, 0.3, {"tau_pan": f"constant:{torque}"}, VALUES, rtol=1e-11, atol=1e-14)
    expected = torque / whole * (1.0 - np.cos(math.sqrt(whole / INERTIA) * found.t))
    assert found["theta_pan"] == pytest.approx(expected, abs=1e-10)
    assert not found.events


@pytest.mark.parametrize("end", [0.4, 1.1, 2.0])
def test_slips_and_returns_are_those_of_another_integrator(driven: Trajectory, end: float) -> None:
    at = int(np.searchsorted(TIMES, end))
    assert driven.t[at] == pytest.approx(end)
    truth = integrated(end)
    assert driven.x[at, :2] == pytest.approx(truth[:2], abs=1e-7)
    found = [driven[name][at] for name in STATES]
    assert found == pytest.approx(truth[2:], abs=1e-8)


def test_every_element_is_a_stop_operator_of_the_angle(model: Model) -> None:
    """Prandtl: z follows the angle, clipped, step by step between turning points."""
    found = simulate(model, np.linspace(0.0, 3.0, 300_001), DRIVEN, VALUES, rtol=1e-10, atol=1e-12)
    z = np.zeros(3)
    for change in np.diff(found["theta_pan"]):
        z = np.clip(z + change, -LIMIT, LIMIT)
    assert [found[name][-1] for name in STATES] == pytest.approx(z, abs=2e-6)


def test_what_is_lost_is_the_work_of_slips(driven: Trajectory) -> None:
    assert sum(e.mode.startswith("goes on") for e in driven.events) > 20
    left = driven.stored - driven.stored[0] - driven.supplied + driven.dissipated
    assert np.max(np.abs(left)) <= 1e-7 * driven.supplied[-1]
    slipped = [
        np.sum(np.abs(np.diff(driven["theta_pan"]) - np.diff(driven[name]))) for name in STATES
    ]
    assert driven.dissipated[-1] == pytest.approx(float(SLIP @ slipped), rel=1e-3)


def test_sensitivities_pass_through_the_slips(model: Model) -> None:
    names, times = ("F_slip1_pan", "k_slip2_pan"), [0.0, 0.7, 1.5]
    found = sensitivity(model, times, DRIVEN, VALUES, by_parameters=names, rtol=1e-9)
    for column, name in enumerate(names):
        step = 1e-5 * VALUES[name]
        ends = [
            simulate(
                model,
                times,
                DRIVEN,
                VALUES | {name: VALUES[name] + sign * step},
                rtol=1e-12,
                atol=1e-14,
            )["theta_pan"]
            for sign in (1.0, -1.0)
        ]
        quotient = (ends[0] - ends[1]) / (2.0 * step)
        assert found.states[1:, 0, column] == pytest.approx(quotient[1:], rel=2e-4)
