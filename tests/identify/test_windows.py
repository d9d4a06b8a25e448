"""How long a run is simulated freely, and how it is cut: closed forms of simple axes."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import ptp_symbolic
from ptp_symbolic.errors import InputError
from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.identify.evaluate import Tolerance, evaluate, simulated_signals
from ptp_symbolic.numeric.identify.run import Run
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from ptp_symbolic.numeric.identify.windows import (
    cut,
    cut_where_errors_grow,
    input_noise,
    propagated_noise,
    split_run,
    window_length,
)
from ptp_symbolic.numeric.simulation.integration import Accuracy, default_method, integrate
from ptp_symbolic.platform import Platform, SignalDeclaration
from tests.identify.curves import Floats

COUNTS = 7200
COUNT = 2 * math.pi / COUNTS
SIGNALS = tuple(
    SignalDeclaration(f"{what}_{axis}", f"{axis}_{what}", unit, role, counts)
    for what, unit, role, counts in (
        ("tau", "N m", "input", None),
        ("theta", "rad", "output", COUNTS),
    )
    for axis in ("pan", "tilt")
)
PLATFORM = Platform("both", "Both axes", ("pan", "tilt"), 9.81, (), (), SIGNALS)
MODEL = ptp_symbolic.load("payload")
INERTIA = 0.02  # of the pan axis, N m s^2/rad
FREE = {
    "J_pan": INERTIA,
    "J_x_tilt": 1e-9,
    "J_z_tilt": 1e-9,
    "J_y_tilt": 0.01,
    "b_pan": 0.0,
    "b_tilt": 0.0,
    "m_payload": 0.0,
    "J_x_payload": 0.0,
    "J_y_payload": 0.0,
    "J_z_payload": 0.0,
}
NONE = np.zeros(0, dtype=np.int64)


def run_of(
    pan: Floats, tilt: Floats, torque: Floats, period: float, time: Floats | None = None
) -> Run:
    """A run with angles [k] in rad, rounded, and pan torque [k] in N m, sampled with a `period`, or
    at `time` [k], in s.
    """
    time = period * np.arange(len(pan)) if time is None else time
    angles = np.rint(np.column_stack([pan, tilt]) / COUNT) * COUNT
    inputs = np.column_stack([torque, np.zeros(len(pan))])
    (run,) = prepare_runs(MODEL, PLATFORM, [Log("run", time, inputs, angles)])
    return run


def still(duration: float, period: float = 0.01, tilt: float = 0.0) -> Run:
    """A run at rest without torque."""
    k = round(duration / period) + 1
    return run_of(np.zeros(k), np.full(k, tilt), np.zeros(k), period)


def drifts(seconds: float, period: float, paths: int) -> Floats:
    """Angles [paths, k] of a free inertia of 1 under held white noise of rms 1, summed by hand."""
    k = round(seconds / period)
    torque = np.random.default_rng(9).standard_normal((paths, k))
    rate = np.cumsum(np.hstack([np.zeros((paths, 1)), torque[:, :-1]]), axis=1) * period
    return np.cumsum(rate * period + torque * period**2 / 2, axis=1)


@pytest.mark.parametrize("length", [None, 8.0, 4.0, 2.0, 1.0, 0.5])
def test_torque_noise_on_a_free_axis_limits_the_window(length: float | None) -> None:
    """Its angle errs by a part of T^1.5. Noise is chosen to err by half a count, as the median of
    paths, after 1.41 times the expected window (None: after twice the run).
    """
    period, duration = 0.01, 20.0
    limit = 2.0 * duration if length is None else math.sqrt(2.0) * length
    squares = np.median(np.mean(drifts(4.0, period, 1000) ** 2, axis=1)) * (limit / 4.0) ** 3
    of_both_encoders = math.sqrt(squares / 2.0) / INERTIA / COUNT
    noise = (0.5 / of_both_encoders, 0.0)
    runs = [still(duration)] * 15
    assert window_length(MODEL, runs, MODEL.parameter_vector(FREE), noise) == length


def pendulum(growth: float, up: bool) -> tuple[Run, Floats]:
    """A payload above (below) the tilt axis for as long as a small angle takes to grow by cosh."""
    values = {**FREE, "m_payload": 5.0, "c_x_payload": 0.001}
    rate = math.sqrt(5.0 * 9.81 * 0.001 / (0.01 + 5.0 * 0.001**2))
    run = still(math.acosh(growth) / rate, 0.005, -math.pi / 2 if up else math.pi / 2)
    return run, MODEL.parameter_vector(values)


@pytest.mark.parametrize(
    ("growth", "up", "length"),
    [(8.0, True, None), (12.0, True, 1.0), (100.0, True, 1.0), (100.0, False, None)],
)
def test_a_payload_above_the_axis_is_cut_where_errors_grow_tenfold(
    growth: float, up: bool, length: float | None
) -> None:
    run, p = pendulum(growth, up)
    assert run.time[-1] > 1.0
    assert window_length(MODEL, [run], p, (0.0, 0.0)) == length


def test_noise_of_an_input_that_is_not_declared_is_seen_in_its_samples() -> None:
    rng = np.random.default_rng(2)
    t = 0.005 * np.arange(4000)
    smooth = 3.0 * np.sin(2.0 * t)
    smooth[1500:] += 6.0  # a step is no noise
    run = run_of(t, t, smooth + 0.05 * rng.standard_normal(4000), 0.005)
    assert input_noise(run, (None, None)) == pytest.approx([0.05, 0.0], rel=0.05, abs=1e-12)
    assert input_noise(run, (0.2, None)) == pytest.approx([0.2, 0.0], abs=1e-12)


def test_noise_that_a_start_cannot_take_up_is_what_propagates() -> None:
    """Of the angle of a free axis a start takes up value and slope: a straight line."""
    t = 0.01 * np.arange(300)
    runs = [run_of(0.8 * t, 0.0 * t, 0.0 * t, 0.01)] * 151
    z = [np.zeros(len(run.unknowns)) for run in runs]
    names = ["theta_pan", "omega_pan", "theta_tilt", "omega_tilt"]
    assert [u.name for u in runs[0].unknowns] == names
    found = propagated_noise(MODEL, runs, z, MODEL.parameter_vector(FREE), (0.1, 0.0))
    paths = drifts(3.0, 0.01, 2000)
    line = np.column_stack([np.ones_like(t), t])
    left = paths.T - line @ np.linalg.lstsq(line, paths.T)[0]
    square = np.mean(left**2) * (0.1 / INERTIA / COUNT) ** 2
    rounding = 1.0 / math.sqrt(12.0)
    usual = np.sqrt(np.mean(found**2, axis=0)) * rounding
    assert usual == pytest.approx([math.sqrt(square), 0.0], rel=0.25, abs=1e-12)


def test_a_run_that_multiplies_the_noise_of_its_input_is_cut_and_no_other() -> None:
    """Torque noise of 0.1 N m leaves a hundred counts on a free axis in 3 s (see above); where a
    thousand are left, the model lacks something else.
    """
    run = still(3.0)
    p, z = MODEL.parameter_vector(FREE), [np.zeros(len(run.unknowns))]
    hundred = 100.0 * math.sqrt(12.0)
    for noise, left, windows in (
        (0.1, hundred, 3),
        (0.1, 10.0 * hundred, 1),
        (1e-4, 1.0, 1),
    ):
        table = np.array([[left, 0.0]])
        assert len(cut_where_errors_grow(MODEL, [run], z, table, p, (noise, 0.0))) == windows


def wavy(duration: float = 10.0, period: float = 0.005) -> Run:
    """Both axes on the move, resting together now and then; torque with memory."""
    t = period * np.arange(round(duration / period) + 1)
    torque = np.random.default_rng(6).standard_normal(len(t))
    return run_of(0.9 * np.sin(2.1 * t), 0.4 * np.cos(2.1 * t + np.pi / 2), torque, period)


@pytest.mark.parametrize("length", [0.3, 0.5, 1.0, 3.3])
def test_a_cut_run_keeps_every_step_once_with_its_inputs(length: float) -> None:
    """Neighbours share the sample between them: it ends one window and starts the next."""
    run = wavy()
    windows = split_run(MODEL, run, length)
    assert len(windows) == round(10.0 / length)
    for part, following in pairwise(windows):
        assert part.time[-1] == following.time[0]
    times = np.concatenate([w.time[:-1] for w in windows])
    assert np.array_equal(times, run.time[:-1])
    assert windows[-1].time[-1] == run.time[-1]
    for name in ("measured", "held_inputs"):
        parts = [getattr(w, name)[:-1] for w in windows]
        assert np.array_equal(np.concatenate(parts), getattr(run, name)[:-1])
    assert [w.name for w in windows][:2] == ["run#1", "run#2"]
    lengths = np.array([w.time[-1] - w.time[0] for w in windows])
    assert np.all((lengths > 0.45 * length) & (lengths < 1.55 * length))


def test_a_window_is_driven_as_the_whole_run_is() -> None:
    """Started in the state of the whole run, every window goes on like it."""
    run, p, tight = wavy(), MODEL.parameter_vector(FREE), Tolerance(1e-9, 1e-11)
    none = np.zeros(0)
    whole = integrate(
        MODEL,
        default_method(MODEL),
        p,
        run.start,
        run.inputs,
        True,
        run.time,
        run.time,
        Accuracy(tight.relative, tight.absolute(MODEL), 1.0),
    ).x
    along = whole[:, [MODEL.state_names.index(signal) for signal in run.signals]]
    for window in split_run(MODEL, run, 2.0):
        at = int(np.searchsorted(run.time, window.time[0]))
        there = along[at : at + len(window.time)]
        begun = replace(window, start=whole[at], unknowns=(), measured=there)
        part = evaluate(MODEL, begun, p, none, NONE, False, tight)
        assert part.failed is None
        assert simulated_signals(begun, part) == pytest.approx(there, abs=1e-8)


def test_edges_lie_where_every_axis_moves_and_starts_carry_its_speed() -> None:
    """Both axes turn round together, every 1.5 s; no window starts near there."""
    run = wavy()
    states = list(MODEL.state_names)
    for window in split_run(MODEL, run, 1.0)[1:]:
        begin = window.time[0]
        assert abs(math.cos(2.1 * begin)) > 0.6
        assert [u.name for u in window.unknowns] == [
            "theta_pan",
            "omega_pan",
            "theta_tilt",
            "omega_tilt",
        ]
        start = dict(zip(states, window.start, strict=True))
        assert start["theta_pan"] == window.measured[0, 0]
        assert start["omega_pan"] == pytest.approx(1.89 * math.cos(2.1 * begin), abs=0.1)
        assert start["omega_tilt"] == pytest.approx(-0.84 * math.cos(2.1 * begin), abs=0.1)


def test_only_dry_friction_holds_a_window_at_rest() -> None:
    """A joint without it is never quite at rest: its rate stays unknown."""
    assert len(MODEL.friction_rates) == 0
    for window in split_run(MODEL, still(4.0), 1.0):
        names = ["theta_pan", "omega_pan", "theta_tilt", "omega_tilt"]
        assert [u.name for u in window.unknowns] == names
        assert np.all(window.start == 0.0)


def test_noise_moves_no_axis_that_dry_friction_holds() -> None:
    """Noise of three counts is known, so that a rate within it is none; one beyond is."""
    drive, t = ptp_symbolic.load("pan_drive"), 0.005 * np.arange(100)
    rng = np.random.default_rng(5)
    signals = (
        SignalDeclaration("u_pan", "voltage", "V", "input"),
        SignalDeclaration("theta_pan", "angle", "rad", "output", 7200, 3.0 * COUNT),
    )
    noise = 3.0 * COUNT * rng.standard_normal(100)
    for rate, names in ((0.0, []), (0.5, ["omega_pan", "omega_gear_pan"])):
        log = Log("run", t, np.zeros((100, 1)), (rate * t + noise)[:, None])
        (run,) = prepare_runs(drive, replace(PLATFORM, signals=signals), [log])
        unknown = [u.name for u in run.unknowns if u.contact is None]
        assert unknown == ["theta_pan", *names]
        assert run.start[list(drive.state_names).index("omega_pan")] == pytest.approx(rate, abs=0.2)


def test_without_a_length_or_shorter_than_one_runs_stay_whole() -> None:
    runs = (still(4.0), still(2.0))
    assert cut(MODEL, runs, None) == runs
    assert split_run(MODEL, runs[0], 8.0) == (runs[0],)
    assert [r.name for r in cut(MODEL, runs, 2.0)] == ["run#1", "run#2", "run"]
    assert [r.source for r in cut(MODEL, runs, 2.0)] == ["run"] * 3


def test_signals_that_the_model_lacks_or_that_have_no_size_are_refused() -> None:
    t = np.arange(20.0)
    log = Log("run", t, np.zeros((20, 2)), np.zeros((20, 2)))
    lacking = replace(PLATFORM, signals=SIGNALS[1:])
    with pytest.raises(InputError, match="No input signal 'tau_pan' to pair with"):
        prepare_runs(MODEL, lacking, [log])
    odd = replace(SIGNALS[2], signal="theta_roll")
    with pytest.raises(InputError, match="No output signal 'theta_roll' to pair with"):
        prepare_runs(MODEL, replace(PLATFORM, signals=(*SIGNALS[:2], odd)), [log])
    bare = replace(SIGNALS[2], counts_per_revolution=None)
    with pytest.raises(InputError, match="give its noise"):
        prepare_runs(MODEL, replace(PLATFORM, signals=(*SIGNALS[:2], bare, SIGNALS[3])), [log])


@pytest.mark.parametrize("period", [0.005, 0.02])
def test_the_rate_at_the_start_of_a_window_is_as_uncertain_as_it_says(period: float) -> None:
    """A motion whose acceleration oscillates at 3 Hz, its rate by calculus: at 50 Hz a tenth of a
    second has too few samples for noise to tell how far a parabola is off.
    """
    t = period * np.arange(round(6.0 / period) + 1)
    omega = 2.0 * math.pi * 3.0
    run = run_of(np.sin(omega * t) + t, np.zeros(len(t)), np.zeros(len(t)), period)
    off = []
    for window in split_run(MODEL, run, 0.5)[1:]:
        rate = next(u for u in window.unknowns if u.name == "omega_pan")
        true = omega * math.cos(omega * window.time[0]) + 1.0
        off.append((window.start[MODEL.state_names.index("omega_pan")] - true) / rate.sigma)
    assert len(off) == 11
    assert math.sqrt(np.mean(np.square(off))) < 1.5
