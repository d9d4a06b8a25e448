"""Planted and found: every effect that can be searched for, hidden in made logs, comes out by name.

The logs are made by the fixed-step method, which shares neither events nor linear algebra with the
one that fits, and are rounded to encoder counts. An amount that the declared parameters of one
machine take up to the last count is looked for on the next machine, then another amount.
"""

import itertools
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ptp_symbolic.errors import InputError
from ptp_symbolic.models import emission, variants
from ptp_symbolic.numeric.diagnose.verdict import NOTHING_MISSING
from ptp_symbolic.numeric.runtime.model import Model
from ptp_symbolic.numeric.simulation.inputs import constant, table
from ptp_symbolic.numeric.simulation.run import Trajectory, simulate
from ptp_symbolic.platform import Platform, read_platform
from ptp_symbolic.symbolic.derivation.placement import place_effects
from ptp_symbolic.symbolic.effect_interface.effect import Effect
from ptp_symbolic.symbolic.effects import EFFECTS
from ptp_symbolic.workflows.diagnosis import diagnose_platform
from tests.independent import pan_logs, two_axis_logs

PLATFORMS = Path(__file__).parents[1] / "platforms"
MACHINES = ("fieldlog_pan", "fieldlog_pan_dc", "fieldlog_two_axis")
COUNT = 2.0 * math.pi / 7200
PERIOD, STEP = 0.005, 1e-4
HEADER = "time [s],pan_voltage [V],pan_current [A],pan_angle [rad]"
SEARCHED = [effect for effect in EFFECTS if effect.searched]
MOTION = ("theta_pan", "theta_tilt", "omega_pan", "omega_tilt")
SMALL = 2e-3  # in SI, of an effect whose searches begin at zero
CHAOTIC = 1.0  # counts rms by which a voltage written with five decimals changes the motion


def without(platform: Platform, effect: Effect) -> Platform:
    """`platform` without `effect` and its parameters."""
    own = {
        parameter.name
        for other, place in place_effects(platform)
        if other is effect
        for parameter in other.parameters_at(place)
    }
    return replace(
        platform,
        effects=tuple(d for d in platform.effects if d.effect != effect.id),
        parameters=tuple(p for p in platform.parameters if p.name not in own),
    )


def machine_with(effect: Effect, name: str) -> tuple[Platform, Platform] | None:
    """The machine `name` without `effect`, and the same machine with it; None: it has no place."""
    bare = without(read_platform(PLATFORMS / f"{name}.toml"), effect)
    try:
        found = [d for d in variants.candidate_effects(bare) if d.effect == effect.id]
    except InputError:
        return None
    return (bare, replace(bare, effects=(*bare.effects, found[0]))) if found else None


def planted_values(model: Model, platform: Platform, which: int) -> dict[str, float]:
    """The declared values, and the last effect of `platform` at start `which` of its search."""
    planted = platform.effects[-1].effect
    own = {n for e in model.effects if e.key.partition("@")[0] == planted for n in e.parameters}
    values = {p.name: p.starts[which] for p in model.parameters if p.name in own and p.starts}
    if not any(values.values()):
        values = dict.fromkeys(values, SMALL)
    return values | {d.name: d.value for d in platform.parameters}


def outputs_along(
    model: Model, values: dict[str, float], found: Trajectory, voltage: np.ndarray
) -> dict[str, np.ndarray]:
    """What the sensors of a pan axis read along `found`."""
    p, y = model.parameter_vector(values), np.zeros((len(found.t), len(model.output_names)))
    for k, (t, x) in enumerate(zip(found.t, found.x, strict=True)):
        model.module.outputs(t, x, voltage[k : k + 1], p, y[k])
    return dict(zip(model.output_names, y.T, strict=True))


def write_driven_runs(model: Model, values: dict[str, float], folder: Path) -> bool:
    """Logs of a pan axis under voltage profiles; False where no simulation can repeat them."""
    worst = 0.0
    for run, voltage in pan_logs.profiles(np.random.default_rng(11)).items():
        rng = np.random.default_rng(len(run))
        t = PERIOD * np.arange(len(voltage))
        drive = {"u_pan": table(t, np.round(voltage, 5), "hold")}
        found = simulate(model, t, drive, values, method="fixed_step", step=STEP)
        again = simulate(model, t, drive, values)
        worst = max(worst, float(np.std(found["theta_pan"] - again["theta_pan"])) / COUNT)
        measured = outputs_along(model, values, found, voltage)
        reading = np.rint(measured["theta_pan"] / COUNT) * COUNT
        current = measured["i_pan"] + 0.004 * rng.standard_normal(len(t))
        columns = zip(t, voltage, current, reading, strict=True)
        write_log(
            folder / f"{run}.csv",
            HEADER,
            [f"{a:.4f},{b:.5f},{c:.5f},{d:.7f}" for a, b, c, d in columns],
        )
    return worst < CHAOTIC


def write_tracked_runs(model: Model, values: dict[str, float], folder: Path) -> None:
    """Logs of two torque-driven axes that a sampled controller leads along smooth paths."""
    rng = np.random.default_rng(11)
    for run in two_axis_logs.RUNS:
        wanted = two_axis_logs.reference(rng)
        torque_at = two_axis_logs.controller(wanted)
        theta, omega, _ = wanted(0.0)
        state = dict.fromkeys(model.state_names, 0.0)
        state |= dict(zip(MOTION, (*theta, *omega), strict=True))
        torques, angles = [], []
        for k in range(round(two_axis_logs.DURATION / PERIOD)):
            x = np.array([state[name] for name in MOTION])
            torques.append(torque_at(k * PERIOD, x[:2], x[2:]))
            angles.append(x[:2])
            held = {n: constant(v) for n, v in zip(model.input_names, torques[-1], strict=True)}
            found = simulate(
                model, [0.0, PERIOD], held, values, state, method="fixed_step", step=STEP
            )
            state = {name: float(found[name][-1]) for name in model.state_names}
        rows = two_axis_logs.log_rows(np.array(torques), np.array(angles), rng)
        write_log(folder / f"{run}.csv", two_axis_logs.COLUMNS, rows)


def write_log(path: Path, header: str, rows: list[str]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([header, *rows, ""]))


def write_runs(full: Platform, which: int, folder: Path) -> bool:
    """Logs of `full`, train and validation; False where they are no test of a model."""
    model = emission.emit(full)
    values = planted_values(model, full, which)
    if "u_pan" in model.input_names:
        return write_driven_runs(model, values, folder)
    write_tracked_runs(model, values, folder)
    return True


def diagnosed(bare: Platform, folder: Path) -> dict[str, Any]:
    return diagnose_platform(bare, [folder / "train"], [folder / "validate"]).summary


@pytest.mark.long
@pytest.mark.parametrize("effect", SEARCHED, ids=lambda effect: effect.id)
def test_planted_effect_is_found(effect: Effect, tmp_path: Path) -> None:
    for which, name in itertools.product((-1, 0), MACHINES):
        machine, folder = machine_with(effect, name), tmp_path / f"{name}{which}"
        if machine is None or not write_runs(machine[1], which, folder):
            continue
        found = diagnosed(machine[0], folder)
        named = {a["effect"] for a in found["added"]}
        group = {k.partition("@")[0] for a in found["added"] for k in a["confusable_with"]}
        if found["verdict"] != NOTHING_MISSING:
            assert effect.id in named | group, found["summary"]
            return
    pytest.fail("the declared parameters of every machine take the effect up")
