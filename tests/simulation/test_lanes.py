"""Several trajectories per instruction: sines, vectors in machine code, and the motion itself."""

import platform
import re
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from numba import njit, types
from scipy.integrate import solve_ivp

import ptp_symbolic as ptp
from ptp_symbolic.numeric.simulation import inputs
from ptp_symbolic.numeric.simulation.integration import checked_accuracy
from ptp_symbolic.numeric.simulation.lanes import BatchProblem, integrate_batch
from tests.independent import rigid_platform

PAYLOAD = ptp.load("payload")
DURATION = 2.0
TIMES = np.linspace(0.0, DURATION, 41)
# Per kind of input: the signal, and the same by hand.
DRIVES = {
    "jump": (inputs.step(0.1, 0.4, 0.73), lambda t: 0.4 if t >= 0.73 else 0.1),
    "line": (
        inputs.ramp(0.0, 0.5, 0.5, 1.5, 0.1),
        lambda t: 0.5 * (t - 0.5) * (0.5 <= t < 1.5) + 0.1 * (t >= 1.5),
    ),
    "sines": (
        inputs.multisine([0.2, 0.1], [0.7, 2.1], [0.3, -1.0]),
        lambda t: 0.2 * np.sin(2 * np.pi * 0.7 * t + 0.3) + 0.1 * np.sin(2 * np.pi * 2.1 * t - 1.0),
    ),
    "sweep": (
        inputs.sine_sweep(0.3, 0.5, 3.0, 0.4, 1.6),
        lambda t: (
            0.3
            * np.sin(2 * np.pi * (0.5 * (t - 0.4) + 1.25 / 1.2 * (t - 0.4) ** 2))
            * (0.4 <= t < 1.6)
        ),
    ),
}
STOPS = (0.4, 0.5, 0.73, 1.5, 1.6)  # of the signals above


def in_lanes(drives: list, count: int, kinds: np.ndarray, threads: int = 1) -> np.ndarray:
    """States [count, k, 4] from angles and payloads that differ."""
    accuracy = checked_accuracy(PAYLOAD, 1e-11, 1e-12, 1.0)
    problem = BatchProblem(PAYLOAD, TIMES, drives, None, accuracy)
    x, p = np.zeros((count, 4)), np.repeat(PAYLOAD.parameter_vector()[None], count, 0)
    x[:, 1] = 0.3 + 0.01 * np.arange(count)
    p[:, PAYLOAD.parameter_names.index("m_payload")] = 4.0 + 0.05 * np.arange(count)
    p[:, PAYLOAD.parameter_names.index("c_y_payload")] = 0.02
    found = integrate_batch(problem, p, x, kinds, threads)
    assert set(found.reasons) == {""}
    return found.x


@pytest.mark.parametrize("kind", DRIVES)
def test_the_motion_is_that_of_newton_and_euler(kind: str) -> None:
    """Against another derivation, integrated by SciPy from stop to stop."""
    signal, by_hand = DRIVES[kind]
    found = in_lanes([[inputs.constant(0.05), signal]], 20, np.zeros(20, np.int64))
    b = 13
    values = {**PAYLOAD.defaults, "m_payload": 4.0 + 0.05 * b, "c_y_payload": 0.02}
    state, edges = np.array([0.0, 0.3 + 0.01 * b, 0.0, 0.0]), (0.0, *STOPS, DURATION)
    for begin, end in pairwise(edges):

        def rate(t: float, x: np.ndarray, begin: float = begin, end: float = end) -> np.ndarray:
            u = np.array([0.05, by_hand(min(max(t, begin), np.nextafter(end, 0.0)))])
            return np.append(x[2:], rigid_platform.accelerations(x[:2], x[2:], u, values))

        run = solve_ivp(
            rate, (begin, end), state, "DOP853", rtol=1e-10, atol=1e-11, dense_output=True
        )
        inside = (begin <= TIMES) & (end >= TIMES)
        assert np.abs(found[b][inside] - run.sol(TIMES[inside]).T).max() < 1e-8
        state = run.y[:, -1]


def test_neighbours_lanes_and_threads_change_no_bit() -> None:
    drives = [[inputs.constant(0.05), DRIVES[kind][0]] for kind in DRIVES]
    kinds = np.arange(37) % len(drives)
    whole = in_lanes(drives, 37, kinds)
    assert np.array_equal(whole, in_lanes(drives, 37, kinds, threads=3))
    for b in (0, 17, 36):
        alone = in_lanes([drives[kinds[b]]], b + 1, np.zeros(b + 1, np.int64))[b]
        assert np.array_equal(whole[b], alone)


@njit
def sines_and_cosines(sine, cosine, x, s, c):
    for i in range(len(x)):
        s[i], c[i] = sine(x[i]), cosine(x[i])


def test_sine_and_cosine_to_two_units_in_the_last_place() -> None:
    """Against 40 digits, near the zeros of both as well."""
    rng = np.random.default_rng(1)
    near = 0.5 * np.pi * rng.integers(-60_000, 60_000, 300).astype(float)
    x = np.concatenate([rng.uniform(-1e5, 1e5, 400), rng.uniform(-7.0, 7.0, 400), near, [0.0]])
    s, c = np.empty_like(x), np.empty_like(x)
    module = PAYLOAD.module
    sines_and_cosines(module.lane_sin, module.lane_cos, x, s, c)
    with mpmath.workdps(40):
        for exact, values in ((mpmath.sin, s), (mpmath.cos, c)):
            for angle, value in zip(x, values, strict=True):
                truth = exact(mpmath.mpf(float(angle)))
                assert abs(mpmath.mpf(float(value)) - truth) <= 2 * np.spacing(abs(float(truth)))


@pytest.mark.skipif(platform.machine() != "x86_64", reason="reads x86 machine code")
def test_one_instruction_computes_several_states() -> None:
    written = PAYLOAD.module.lane_derivative.py_func
    derivative = njit(error_model="numpy")(written)  # of one from a cache there is no code to read
    derivative.compile((types.float64[::1],))
    code = next(iter(derivative.inspect_asm().values()))
    packed = re.findall(r"\bv?(?:add|sub|mul|div)pd\b", code)
    scalar = re.findall(r"\bv?(?:add|sub|mul|div)sd\b", code)
    assert len(packed) > 50 and scalar == []


def test_lanes_hold_the_states_that_the_prepared_derivative_takes() -> None:
    module, rng = PAYLOAD.module, np.random.default_rng(3)
    lanes, p = module.LANES, PAYLOAD.parameter_vector()
    x, u, c = rng.normal(size=(4, lanes)), rng.normal(size=(2, lanes)), PAYLOAD.prepared(p)
    w = np.concatenate(
        [
            np.zeros((1, lanes)),
            x,
            u,
            np.repeat(p[:, None], lanes, 1),
            np.repeat(c[:, None], lanes, 1),
            np.zeros((4, lanes)),
        ]
    )
    flat = w.reshape(-1)
    module.lane_derivative(flat)
    for lane in range(lanes):
        torques = np.ascontiguousarray(u[:, lane])
        truth = rigid_platform.accelerations(x[:2, lane], x[2:, lane], torques, PAYLOAD.defaults)
        assert np.abs(w[-2:, lane] - truth).max() <= 1e-11 * max(1.0, np.abs(truth).max())
