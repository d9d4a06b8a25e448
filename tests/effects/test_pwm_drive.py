"""Pulsed bridge: exact edges, the ripple of a resistive-inductive load, averaged against pulses."""

import math
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

from ptp_symbolic import sensitivity, simulate
from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, step, table
from ptp_symbolic.platform import EffectDeclaration, Platform, read_platform
from ptp_symbolic.platform.writer import platform_text

J, L, R, KT, JM, N = 0.05, 6.9e-3, 12.9, 0.0724, 1.1e-5, 500.0
U, F = 24.0, 6e6 / 512
LOCKED = {"F_c_pan": 900.0, "F_s_pan": 1000.0}


@lru_cache
def driven(kind: str | None, *more: str) -> Model:
    effects = (
        EffectDeclaration("rigid_bodies", None, None),
        EffectDeclaration("dc_motor", "pan", None),
        EffectDeclaration("pwm_drive", "pan", None, kind),
        *(EffectDeclaration(name, "pan", None) for name in more),
    )
    return emission.emit(Platform("driven", "Driven", ("pan",), 9.81, effects, (), ()))


def ripple(duty: float, low: float) -> tuple[float, float]:
    """Least and largest current in A of R and L at U for `duty` of the carrier, `low` after it."""
    a, b = math.exp(-R / L * duty / F), math.exp(-R / L * (1 - duty) / F)
    top = (U * (1 - a) + low * a * (1 - b)) / (R * (1 - a * b))
    return low / R + (top - low / R) * b, top


@pytest.mark.parametrize("method", ["rosenbrock", "runge_kutta"])
@pytest.mark.parametrize(("kind", "low"), [("switching", 0.0), ("bipolar", -U)])
def test_ripple_of_a_locked_motor_is_that_of_the_closed_form(
    kind: str, low: float, method: str
) -> None:
    """After 60 time constants, at both edges of the carrier; the mean is that of the average."""
    model, first = driven(kind, "csvs_friction"), 400
    for volts in (0.7, 6.0, 12.0, 23.4):
        duty = (volts - low) / (U - low)
        instants = [0.0, first / F, (first + duty) / F, (first + 1) / F]
        found = simulate(
            model,
            instants,
            {"u_pan": constant(volts)},
            LOCKED,
            rtol=1e-11,
            atol=1e-12,
            method=method,
        )
        lowest, highest = ripple(duty, low)
        assert found["i_pan"][1:] == pytest.approx([lowest, highest, lowest], abs=1e-9)
        assert found["omega_pan"][-1] == 0.0
        mean = (duty * U + (1 - duty) * low) / R
        assert mean == pytest.approx(volts / R, rel=1e-12)


def test_edges_come_when_the_duty_says() -> None:
    model = driven("switching")
    for volts, sign in ((9.0, 1.0), (-15.0, -1.0)):
        edges = np.sort(
            np.concatenate([np.arange(1, 40) / F, (np.arange(40) + abs(volts) / U) / F])
        )
        times = np.sort(np.concatenate([[0.0], edges - 1e-11, edges]))
        found = simulate(model, times, {"u_pan": constant(volts)})
        before, after = found["bridge_pan"][1:].reshape(-1, 2).T
        assert after == pytest.approx(np.where(np.arange(79) % 2 == 0, 0.0, sign * U))
        assert before[1:] == pytest.approx(after[:-1])


@pytest.mark.parametrize(
    ("kind", "volts", "shown"),
    [
        ("switching", 0.0, 0.0),
        ("switching", 24.0, 24.0),
        ("switching", -30.0, -24.0),
        ("bipolar", -24.0, -24.0),
        ("bipolar", 30.0, 24.0),
    ],
)
def test_without_a_pulse_there_is_no_edge(kind: str, volts: float, shown: float) -> None:
    found = simulate(driven(kind), np.arange(0.0, 2e-3, 7e-6), {"u_pan": constant(volts)})
    assert np.all(found["bridge_pan"] == shown)


@pytest.mark.parametrize("kind", ["switching", "bipolar"])
def test_a_turning_motor_follows_the_exact_pulses(kind: str) -> None:
    """The command changes between carrier starts; every piece is a matrix exponential."""
    times = np.array([0.0, 1.03e-3, 2.51e-3])
    volts, low = np.array([10.0, -20.0, 5.0]), 0.0 if kind == "switching" else -U
    inertia = J + JM * N**2
    a = np.array([[0, 1, 0, 0], [0, 0, KT * N / inertia, 0], [0, -KT * N / L, -R / L, 1 / L]])
    a = np.vstack([a, np.zeros(4)])
    x, seen = np.zeros(3), [np.zeros(3)]
    for k in range(50):
        u = volts[np.searchsorted(times, k / F, "right") - 1]
        duty = abs(u) / U if kind == "switching" else (u + U) / (2 * U)
        high = math.copysign(U, u) if kind == "switching" else U
        for voltage, share in ((high, duty), (low, 1 - duty)):
            x = (expm(a * share / F) @ np.append(x, voltage))[:3]
        seen.append(x)
    found = simulate(
        driven(kind),
        np.arange(51) / F,
        {"u_pan": table(times, volts)},
        {"J_pan": J},
        rtol=1e-12,
        atol=1e-12,
    )
    assert found.x[:, :3] == pytest.approx(np.array(seen), abs=1e-9)
    coarse = simulate(
        driven(kind),
        np.arange(51) / F,
        {"u_pan": table(times, volts)},
        {"J_pan": J},
        method="fixed_step",
        step=2e-6,
    )
    assert coarse.x[:, :3] == pytest.approx(np.array(seen), abs=2e-6)


def test_averaged_is_the_mean_of_the_pulses() -> None:
    """Same command, same duty: pulses lead or lag by less than the whole supply of one period."""
    command, ends = {"u_pan": step(9.0, -4.0, 0.03)}, np.array([0.0, 300 / F, 700 / F])
    mean = simulate(driven(None), ends, command, {"J_pan": J})
    assert driven(None).state_names == driven("averaged").state_names
    for kind in ("switching", "bipolar"):
        pulsed = simulate(driven(kind), ends, command, {"J_pan": J}, rtol=1e-10, atol=1e-11)
        apart = np.abs(pulsed["theta_pan"] - mean["theta_pan"])[1:]
        assert 0.0 < np.max(apart) < U / F / (KT * N)


def test_tangents_move_with_the_edges() -> None:
    model, times = driven("switching"), [0.0, 10.3 / F, 33.4 / F]
    command, values = {"u_pan": constant(9.0)}, {"J_pan": J, "f_pwm_pan": 3e3}
    names, kept = ["u_supply_pan", "f_pwm_pan", "R_pan"], {"rtol": 1e-12, "atol": 1e-12}
    found = sensitivity(model, times, command, values, by_parameters=names, **kept)
    for k, name in enumerate(names):
        base = values.get(name, model.defaults[name])
        ends = [
            simulate(model, times, command, {**values, name: base * (1 + s * 1e-6)}, **kept).x
            for s in (1, -1)
        ]
        slope = ((ends[0] - ends[1]) / (2e-6 * base))[1:, :3]
        size = np.max(np.abs(slope), axis=0)
        assert np.max(np.abs(found.states[1:, :3, k] - slope) / size) < 1e-4, name


def test_energy_in_pulses_is_accounted_for() -> None:
    found = simulate(driven("switching", "viscous_friction"), 0.05, {"u_pan": constant(12.0)})
    left = found.stored - found.stored[0] - found.supplied + found.dissipated
    assert np.max(np.abs(left)) < 1e-6 * found.supplied[-1]


def test_the_kind_is_declared_in_the_platform(tmp_path: Path) -> None:
    base = read_platform("thesis-pan-drive")
    with_kind = replace(
        base, effects=(*base.effects, EffectDeclaration("pwm_drive", "pan", None, "switching"))
    )
    path = tmp_path / "pan.toml"
    path.write_text(platform_text(with_kind))
    assert read_platform(path).effects[-1].kind == "switching"
    assert "bridge_pan" in emission.emit(read_platform(path)).state_names
    path.write_text(path.read_text().replace('"switching"', '"humming"'))
    with pytest.raises(
        InputError, match=r"no kind 'humming'\. Choose one of: averaged, switching,"
    ):
        emission.emit(read_platform(path))


@pytest.mark.long
def test_a_carrier_that_starts_with_a_sample_takes_the_new_command() -> None:
    """The LM629 derives both from one clock: every fourth carrier period starts with a sample."""
    base = read_platform("thesis-pan-servo")
    effects = tuple(
        replace(e, kind="switching") if e.effect == "pwm_drive" else e for e in base.effects
    )
    times = np.arange(900) * 2048 / 6e6
    goal = {"setpoint_pan": step(0.01, 0.01, 1.0)}
    found = simulate(emission.emit(replace(base, effects=effects)), times, goal)
    assert len(np.unique(found["command_pan"])) > 5
    assert found["duty_pan"] == pytest.approx(found["command_pan"] / U, abs=1e-15)
    mean = simulate(emission.emit(base), times, goal)
    assert found["theta_pan"] == pytest.approx(mean["theta_pan"], abs=2 * math.pi / 7200)
