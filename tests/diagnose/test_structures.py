"""An undeclared flexible shaft is found as a structure, in logs that SciPy makes of two masses."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ptp_symbolic.models.structures import structures
from ptp_symbolic.numeric.data import log_files, read_logs
from ptp_symbolic.numeric.diagnose.structures import (
    FittedStructure,
    alternatives,
    begin_structure,
    by_fit,
    is_better,
)
from ptp_symbolic.numeric.identify import evidence
from ptp_symbolic.numeric.identify.windows import cut, parted_like
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.workflows import structure_choice
from ptp_symbolic.workflows.preparation import model_of, problem_for, workers
from ptp_symbolic.workflows.structure_choice import Outcome, chosen_structure, part_as_good
from ptp_symbolic.workflows.structure_fits import Logs

R, L, K_T, J_MOTOR, RATIO = 3.0, 4e-3, 0.06, 4e-6, 100.0
J_LOAD, DRAG, STIFFNESS, DAMPING = 0.1, 0.5, 60.0, 0.3
PERIOD, COUNT = 5e-3, 2.0 * np.pi / 36000

PLATFORM = f"""
[platform]
name = "two_masses"
title = "A motor on a gear, declared rigid"
axes = ["pan"]

[[effects]]
effect = "rigid_bodies"
[[effects]]
effect = "viscous_friction"
axis = "pan"
[[effects]]
effect = "dc_motor"
axis = "pan"

[parameters]
L_pan = {{ value = {L}, unit = "H" }}
R_pan = {{ value = {R}, unit = "ohm" }}
K_t_pan = {{ value = {K_T}, unit = "N m/A" }}
J_motor_pan = {{ value = {J_MOTOR}, unit = "kg m^2" }}
N_pan = {{ value = {RATIO}, unit = "1" }}
J_pan = {{ start = 0.07, unit = "kg m^2", bounds = [0.005, 1.0] }}
b_pan = {{ start = 1.0, unit = "N m s/rad", bounds = [0.0, 50.0] }}

[signals.u_pan]
role = "input"
column = "voltage"
unit = "V"
noise = 0.0

[signals.theta_pan]
role = "output"
column = "angle"
unit = "rad"
counts_per_revolution = 36000
"""


def record(path: Path, seed: int) -> None:
    """Four seconds of held voltages: what a soft shaft between two masses makes of them."""
    rng = np.random.default_rng(seed)
    time = PERIOD * np.arange(801)
    volts = np.round(np.repeat(rng.uniform(-8.0, 8.0, 41), 20)[:801], 3)
    gear_inertia = J_MOTOR * RATIO**2

    def slope(t: float, y: np.ndarray, u: float) -> list[float]:
        load, load_rate, gear, gear_rate, current = y
        shaft = STIFFNESS * (gear - load) + DAMPING * (gear_rate - load_rate)
        return [
            load_rate,
            (shaft - DRAG * load_rate) / J_LOAD,
            gear_rate,
            (RATIO * K_T * current - shaft) / gear_inertia,
            (u - R * current - K_T * RATIO * gear_rate) / L,
        ]

    y, angle = np.zeros(5), [0.0]
    for u in volts[:-1]:
        found = solve_ivp(slope, (0.0, PERIOD), y, "RK45", args=(u,), rtol=1e-8, atol=1e-10)
        y = found.y[:, -1]
        angle.append(y[0])
    shown = COUNT * np.round(np.array(angle) / COUNT)
    rows = "\n".join(f"{t:.3f},{u:.3f},{a:.9f}" for t, u, a in zip(time, volts, shown, strict=True))
    path.write_text(f"time [s],voltage [V],angle [rad]\n{rows}\n", encoding="utf-8")


@pytest.fixture(scope="module")
def declared(tmp_path_factory: pytest.TempPathFactory) -> tuple[Platform, list[Path]]:
    folder = tmp_path_factory.mktemp("two_masses")
    (folder / "platform.toml").write_text(PLATFORM, encoding="utf-8")
    paths = [folder / f"run_{k}.csv" for k in range(3)]
    for seed, path in enumerate(paths):
        record(path, seed)
    return read_platform(folder / "platform.toml"), paths


@pytest.fixture(scope="module")
def fits(declared: tuple[Platform, list[Path]]) -> dict[tuple[str, ...], FittedStructure]:
    """The declared structure, a shaft, and a lag of the encoder, fitted."""
    platform, paths = declared
    logs = read_logs(log_files(paths), platform)
    wanted = [("shaft_compliance@pan",), ("measurement_lag@pan",), ("harmonic_drive@pan",)]
    rebuilt = [s for s in structures(platform)[0] if s.keys in wanted]
    found = {}
    with workers() as executor:
        for there, keys, provides, starts in (
            (platform, (), frozenset[str](), ()),
            *((s.platform, s.keys, s.provides, s.starts) for s in rebuilt),
        ):
            model = model_of(there)
            problem = problem_for(there, model, logs, logs, (), executor, lambda text: None)
            found[keys] = begin_structure(keys, provides, problem, starts, ()).finished()
        yield found


@pytest.mark.early
def test_a_soft_shaft_is_found_by_a_fit_and_predicts_clearly_better(
    fits: dict[tuple[str, ...], FittedStructure],
) -> None:
    rigid, shaft = fits[()], fits["shaft_compliance@pan",]
    assert not rigid.is_noise_alone
    assert shaft.is_noise_alone
    values = shaft.trial.values
    # A motor with a strong back EMF hardly feels the load: its logs tell ratios, not their size.
    for name, true in (("k_shaft_pan", STIFFNESS), ("d_shaft_pan", DAMPING)):
        assert values[name] / values["J_pan"] == pytest.approx(true / J_LOAD, rel=0.01)
        assert values[name] == pytest.approx(true, rel=0.2)
    assert is_better(shaft, rigid)
    assert not is_better(rigid, shaft)


@pytest.mark.early
def test_a_lag_of_the_encoder_does_not_win_over_the_shaft(
    fits: dict[tuple[str, ...], FittedStructure],
) -> None:
    rigid, *others = fits.values()
    order = by_fit(rigid, others)
    assert order[0] is fits["shaft_compliance@pan",], "the harmonic drive has parameters to spare"
    lag = fits["measurement_lag@pan",]
    assert lag not in alternatives(order[0], others)
    assert fits["harmonic_drive@pan",] not in alternatives(order[0], others), "it contains a shaft"
    assert lag not in alternatives(order[0], others, rigid), "it is far from the shaft"


@pytest.mark.early
def test_beside_more_than_noise_what_comes_near_and_beats_the_declared_one_is_not_told_apart(
    fits: dict[tuple[str, ...], FittedStructure], monkeypatch: pytest.MonkeyPatch
) -> None:
    rigid, *others = fits.values()
    shaft, lag = fits["shaft_compliance@pan",], fits["measurement_lag@pan",]
    where = "ptp_symbolic.numeric.diagnose.structures.is_near"
    monkeypatch.setattr(where, lambda one, best, declared: one is lag)
    assert (lag in alternatives(shaft, others, rigid)) is is_better(lag, rigid)


@pytest.mark.early
def test_what_contains_the_shaft_is_not_named_where_the_shaft_predicts_as_well(
    fits: dict[tuple[str, ...], FittedStructure],
) -> None:
    shaft, lag, harmonic = (
        fits[f"{effect}@pan",]
        for effect in ("shaft_compliance", "measurement_lag", "harmonic_drive")
    )

    def ended(structure: FittedStructure) -> Outcome:
        verdict = SimpleNamespace(final=structure.trial)
        return cast(Any, SimpleNamespace(structure=structure, verdict=verdict, found=None))

    more = replace(harmonic, provides=shaft.provides | {"a softening of it"})
    assert part_as_good(ended(more), [ended(more)], [shaft, lag, more]) is shaft
    assert part_as_good(ended(shaft), [ended(shaft)], [shaft, lag, more]) is None
    worse = replace(lag, provides=frozenset())  # as if the shaft contained it
    assert part_as_good(ended(shaft), [ended(shaft)], [worse, more]) is None


@pytest.mark.early
def test_runs_of_one_model_are_parted_as_those_of_another(
    declared: tuple[Platform, list[Path]],
    fits: dict[tuple[str, ...], FittedStructure],
) -> None:
    rigid, shaft = fits[()].problem, fits["shaft_compliance@pan",].problem
    pattern = cut(rigid.model, rigid.whole, 1.0)
    found = parted_like(shaft.model, shaft.whole, pattern)
    assert [run.name for run in found] == [run.name for run in pattern]
    for ours, theirs in zip(found, pattern, strict=True):
        np.testing.assert_array_equal(ours.time, theirs.time)
        np.testing.assert_array_equal(ours.measured, theirs.measured)
        assert len(ours.start) == len(shaft.model.state_names)


def test_a_structure_goes_on_from_the_values_of_one_that_contains_it_and_keeps_what_fits_better(
    declared: tuple[Platform, list[Path]],
) -> None:
    platform, paths = declared
    logs = read_logs(log_files(paths), platform)
    shaft = next(s for s in structures(platform)[0] if s.keys == ("shaft_compliance@pan",))
    stiff = {"k_shaft_pan": 5e4, "d_shaft_pan": 10.0}
    true = {"k_shaft_pan": STIFFNESS, "d_shaft_pan": DAMPING, "J_pan": J_LOAD, "b_pan": DRAG}
    with workers() as executor:
        model = model_of(shaft.platform)
        problem = problem_for(shaft.platform, model, logs, logs, (), executor, lambda text: None)
        begun = begin_structure(shaft.keys, shaft.provides, problem, (stiff,), ())
        led = begun.from_values(true)
        kept = led.from_values(stiff)
        assert led.is_noise_alone
    values = led.trial.values
    assert values["k_shaft_pan"] / values["J_pan"] == pytest.approx(STIFFNESS / J_LOAD, rel=0.01)
    assert kept.trial.fit.cost <= led.trial.fit.cost * (1.0 + 1e-9)


@pytest.mark.long
def test_once_the_time_is_over_a_structure_that_fits_is_named_without_a_search_for_terms(
    declared: tuple[Platform, list[Path]], monkeypatch: pytest.MonkeyPatch
) -> None:
    platform, paths = declared
    *train, validate = read_logs(log_files(paths), platform)
    monkeypatch.setattr(structure_choice, "_is_enough", lambda structure, platform: False)

    def say(text: str) -> None:
        if text.startswith("fitting the better"):
            monkeypatch.setattr(evidence.time, "monotonic", lambda: np.inf)

    with workers() as executor:
        allowance = evidence.Allowance(seconds=1e6)
        logs = Logs(tuple(train), (validate,), executor, say, allowance)
        choice = chosen_structure(platform, logs)
    assert choice.is_cut_short
    assert choice.chosen.keys == ("shaft_compliance@pan",)
    assert all(c.is_declared_value for c in choice.chosen.found.problem.candidates)
