"""What an experiment is worth, against frequency responses, closed forms and Monte Carlo."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ptp_symbolic.numeric.data import Log
from ptp_symbolic.numeric.experiment.machine import (
    Limit,
    Scenario,
    as_it_is,
    information,
    logged,
    play,
    spreads,
)
from ptp_symbolic.numeric.experiment.prediction import compared, precision
from ptp_symbolic.numeric.identify.fit import fit_parameters
from ptp_symbolic.numeric.identify.least_squares import Effort
from ptp_symbolic.numeric.identify.run_preparation import prepare_runs
from tests.diagnose.spring_table import PERIOD
from tests.experiment.table_contender import (
    AMPLITUDE,
    INERTIA,
    NOISE,
    VALUES,
    conditions,
    contender,
    motion,
    table,
)
from tests.identify.curves import Floats


def tone(t: Floats, frequency: float) -> Floats:
    return np.sin(2 * np.pi * frequency * t)[:, None]


@pytest.mark.long
def test_a_stiffness_shows_best_at_resonance(tmp_path: Path) -> None:
    """The derivative of the angle by the stiffness is -G^2 times the torque: largest where the
    amplification is, and its standard deviation that of a sine of that size in white noise.
    """
    platform, model = table(tmp_path)
    spring = contender(model, "spring", ("k1_cable_pan",))
    run = conditions(platform, 60.0)
    stiffness, damping = VALUES["k1_cable_pan"], VALUES["b_pan"]
    resonance = np.sqrt(stiffness / INERTIA - 0.5 * (damping / INERTIA) ** 2) / (2 * np.pi)
    frequencies = resonance * np.array([0.6, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5])
    worth = [precision(spring, ["k1_cable_pan"], run, tone(run.t, f)) for f in frequencies]
    assert int(np.argmax(worth)) == 3
    for frequency in frequencies:
        played = play(spring, run, tone(run.t, frequency))
        assert played is not None
        known = information(spring, logged(spring, run, played), 0.0)
        assert known is not None
        s = 2j * np.pi * frequency
        gain = abs(1.0 / (INERTIA * s**2 + damping * s + stiffness))
        expected = NOISE / (AMPLITUDE * gain**2 * np.sqrt(len(run.t) / 2))
        assert spreads(spring, known)["k1_cable_pan"] == pytest.approx(expected, rel=0.05)


@pytest.mark.long
def test_predicted_deviations_are_those_of_many_fits(tmp_path: Path) -> None:
    """Closed-form motions with noise drawn anew, fitted one by one: 120 fits know a deviation to
    6.5 %.
    """
    platform, model = table(tmp_path)
    names = ("J_pan", "b_pan", "k1_cable_pan")
    spring = contender(model, "spring", names)
    run = conditions(platform, 4.0)
    wave = np.sign(tone(run.t, 0.4)) * 0.9
    played = play(spring, run, wave)
    assert played is not None
    known = information(spring, logged(spring, run, played), 0.0)
    assert known is not None
    expected = spreads(spring, known)
    clean, rng = motion(played.inputs[:, 0]), np.random.default_rng(4)
    fixed = {n: v for n, v in spring.values.items() if n not in names}
    found = []
    for number in range(120):
        noisy = clean + NOISE * rng.normal(size=len(clean))
        log = Log(f"run {number}", run.t, played.inputs, noisy[:, None])
        runs = prepare_runs(model, platform, (log,))
        fit = fit_parameters(model, runs, spring.free, fixed, None, Effort(8, 1e-6))
        found.append([fit.values[name] for name in names])
    scatter = np.std(found, axis=0, ddof=1)
    for name, spread in zip(names, scatter, strict=True):
        assert spread == pytest.approx(expected[name], rel=0.2), name


@pytest.mark.long
def test_separation_is_what_free_parameters_cannot_follow(tmp_path: Path) -> None:
    """A table with a small constant torque against one without: the response to the torque,
    projected off those to inertia, damping, stiffness and start, in closed form.
    """
    platform, model = table(tmp_path)
    names, torque = ("J_pan", "b_pan", "k1_cable_pan"), 2e-4
    pushed = contender(model, "pushed", (*names, "tau0_pan"), tau0_pan=torque)
    plain = contender(model, "plain", names)
    run = conditions(platform, 4.0)
    wave = np.sign(tone(run.t, 0.4))
    found = compared(pushed, plain, run, wave, Scenario(0.0, 0), 6)
    assert found is not None
    inputs = found.run.held_inputs[:, 0]

    def column(**change: float) -> Floats:
        back = {name: -value for name, value in change.items()}
        return (motion(inputs, **change) - motion(inputs, **back)) / NOISE

    follow = [column(J=1e-5), column(b=1e-4), column(k=1e-3), column(angle=1e-4), column(rate=1e-4)]
    away = np.column_stack(follow)
    response = 0.5 * column(tau0=torque)
    rest = response - away @ np.linalg.lstsq(away, response, rcond=None)[0]
    assert np.linalg.norm(rest) > 5.0
    assert np.sqrt(found.more) == pytest.approx(float(np.linalg.norm(rest)), rel=0.03)


def test_what_the_logs_know_holds_a_rival_back(tmp_path: Path) -> None:
    """Logs that leave a rival's parameters no room are as good as known values."""
    platform, model = table(tmp_path)
    names = ("J_pan", "b_pan", "k1_cable_pan")
    pushed = contender(model, "pushed", (*names, "tau0_pan"), tau0_pan=2e-4)
    plain = contender(model, "plain", names)
    after_logs = replace(plain, memory=1e9 * np.eye(3))
    known = contender(model, "known", ())
    run = conditions(platform, 4.0)
    wave = np.sign(tone(run.t, 0.4))
    rivals = (plain, after_logs, known)
    found = [compared(pushed, c, run, wave, Scenario(0.0, 0), 6) for c in rivals]
    free, held, fixed = (0.0 if c is None else c.more for c in found)
    assert held == pytest.approx(fixed, rel=1e-3)
    assert held > 1.05 * free > 0.0


def test_a_rival_that_is_the_machine_is_not_separated(tmp_path: Path) -> None:
    """A push on a spring, and the same push as a changed rest angle of it, are one."""
    platform, model = table(tmp_path)
    pushed = contender(model, "pushed", ("tau0_pan",), tau0_pan=0.01)
    bent = contender(model, "bent", ("theta0_cable_pan",))
    run = conditions(platform, 4.0)
    found = compared(pushed, bent, run, np.sign(tone(run.t, 0.4)), Scenario(0.0, 0), 6)
    assert found is not None
    assert found.more < 0.1


def test_what_noise_of_the_inputs_leaves_tells_nothing(tmp_path: Path) -> None:
    """Where the log of the input is off, the machine's own model leaves as much as a rival."""
    platform, model = table(tmp_path)
    noisy = tuple(replace(s, noise=0.002) if s.role == "input" else s for s in platform.signals)
    spring, again = (contender(model, name, ("k1_cable_pan",)) for name in ("one", "other"))
    run = conditions(replace(platform, signals=noisy), 4.0)
    played = play(spring, run, np.sign(tone(run.t, 0.4)))
    assert played is not None
    own = as_it_is(spring, logged(spring, run, played), 0.0)
    assert own is not None and own.residual @ own.residual > 100.0
    found = compared(spring, again, run, np.sign(tone(run.t, 0.4)), Scenario(0.0, 0), 6)
    assert found is not None
    assert found.more == 0.0


def test_a_run_is_scaled_back_until_it_keeps_its_limits(tmp_path: Path) -> None:
    platform, model = table(tmp_path)
    spring = contender(model, "spring", ("k1_cable_pan",))
    run = conditions(platform, 6.0)
    allowed = {**run.limits, "omega_pan": Limit("omega_pan", -0.05, 0.05)}
    strict = replace(run, limits=allowed)
    wave = tone(run.t, 0.5)
    played, freely = play(spring, strict, wave), play(spring, run, wave)
    assert played is not None and freely is not None
    closed = motion(played.inputs[:, 0])
    rate = np.abs(np.gradient(closed, run.t)).max()
    assert 0.9 * 0.05 < rate <= 0.05
    assert np.abs(np.gradient(motion(freely.inputs[:, 0]), run.t)).max() > 0.1


def test_a_machine_that_runs_on_after_the_end_keeps_its_stroke(tmp_path: Path) -> None:
    """A push that ends with the run: without a spring the table runs on by rate x inertia /
    damping, 0.7 times the rate in s.
    """
    platform, model = table(tmp_path)
    loose = contender(model, "loose", ("b_pan",), k1_cable_pan=0.0)
    run = conditions(platform, 2.0)
    allowed = {**run.limits, "theta_pan": Limit("theta_pan", -0.5, 0.5)}
    played = play(loose, replace(run, limits=allowed), np.ones((len(run.t), 1)))
    assert played is not None
    fastest, lag = played.inputs[0, 0] / VALUES["b_pan"], INERTIA / VALUES["b_pan"]
    last, end = run.t[-1], run.t[-1] + PERIOD

    def pushed(time: float) -> tuple[float, float]:
        rate = fastest * (1.0 - np.exp(-time / lag))
        return fastest * time - lag * rate, rate

    assert played.outputs[-1, 0] == pytest.approx(pushed(last)[0], rel=1e-3)
    angle, rate = pushed(end)
    stops = angle + lag * rate * (1.0 - np.exp(-(last - PERIOD) / lag))
    assert 0.45 < stops <= 0.5
    assert played.reached["theta_pan"][1] == pytest.approx(stops, rel=1e-3)


def test_a_machine_follows_its_own_run(tmp_path: Path) -> None:
    platform, model = table(tmp_path)
    spring = contender(model, "spring", ("k1_cable_pan",))
    run = conditions(platform, 4.0)
    played = play(spring, run, tone(run.t, 0.5))
    assert played is not None
    found = as_it_is(spring, logged(spring, run, played), 0.0)
    assert found is not None
    assert np.max(np.abs(found.residual)) < 0.05
